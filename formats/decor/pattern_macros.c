#include "formats/decor/pattern_macros.h"

#include <string.h>

#include "formats/json/json_text.h"
#include "libcore/base/grow.h"

enum {
    MOST_DEPTH = 512,       /* of JSON, as in texts */
    NAME_LENGTH = 200
};

static void fail_memory(MesoPatternParser *parser)
{
    MesoJsonReader *reader = parser->reader;
    if (!reader->status)
        reader->status = meso_fail(reader->error, MESO_ERR_MEMORY, "%s: out of memory", reader->path);
}

/* ---- the table ---- */

bool meso_macro_is_own_key(const char *key)
{
    static const char *const own[] = {"macro", "on", "weight", "most"};
    for (uint32_t i = 0; i < 4; i++)
        if (strcmp(key, own[i]) == 0)
            return true;
    return meso_json_is_note(key);
}

static void check_macro(const MesoJsonField *macro)
{
    static const char *const keys[] = {"parameters", "steps", NULL};
    MesoJsonField parameters = meso_json_key(macro, "parameters"), steps = meso_json_key(macro, "steps");
    const char *key;
    json_t *value;
    if (!meso_json_object(macro, keys))
        return;
    if (!*macro->key || strlen(macro->key) > NAME_LENGTH)
        meso_json_wrong(macro, "a name of %zu characters; from 1 to %d are possible", strlen(macro->key), NAME_LENGTH);
    meso_json_count(&steps, 1, MESO_PATTERN_STEPS);
    if (!parameters.value || !meso_json_object(&parameters, NULL))
        return;
    json_object_foreach((json_t *)parameters.value, key, value)
        if (meso_macro_is_own_key(key) && !meso_json_is_note(key))
            meso_json_wrong(&parameters, "\"%s\" is a key of calls, and cannot be a parameter", key);
}

/* The names point into the JSON. */
static void add_macro(MesoPatternParser *parser, const char *name, const json_t *value)
{
    MesoJsonReader *reader = parser->reader;
    MesoMacroTable *table = &parser->macros;
    uint32_t number = meso_names_add(&table->numbers, reader->arena, name, strlen(name), table->count, reader->error);
    if (number == table->count) {
        const json_t **values = table->values;
        uint32_t room = table->room;
        values = MESO_GROW(reader->arena, values, table->count, room, 16, reader->error);
        table->names = MESO_GROW(reader->arena, table->names, table->count, table->room, 16, reader->error);
        table->values = values;
        table->count++;
    }
    if (number == MESO_NO_INDEX || !table->names || !table->values) {
        table->count = 0;
        fail_memory(parser);
        return;
    }
    table->names[number] = name;
    table->values[number] = value;
}

void meso_macros_add(MesoPatternParser *parser, const MesoJsonField *table)
{
    const char *key;
    json_t *value;
    if (!table->value || !meso_json_object(table, NULL))
        return;
    json_object_foreach((json_t *)table->value, key, value) {
        MesoJsonField macro = meso_json_key(table, key);
        check_macro(&macro);
        if (!meso_json_good(table))
            return;
        add_macro(parser, key, value);
    }
}

/* ---- files ---- */

static bool keep_root(MesoPatternParser *parser, json_t *root)
{
    MesoMacroTable *table = &parser->macros;
    json_t **roots = MESO_GROW(parser->reader->arena, table->roots, table->root_count, table->root_room, 4,
                               parser->reader->error);
    if (!roots) {
        json_decref(root);
        fail_memory(parser);
        return false;
    }
    table->roots = roots;
    roots[table->root_count++] = root;
    return true;
}

/* A file has a reader of its own, which names it in messages. */
void meso_macros_add_file(MesoPatternParser *parser, const MesoInput *input)
{
    static const char *const keys[] = {"format", "version", "provenance", "macros", NULL};
    MesoJsonReader *outer = parser->reader, inner = {.path = input->path, .arena = outer->arena, .error = outer->error};
    json_t *root = NULL;
    if (outer->status)
        return;
    inner.status = meso_json_parse(&root, input, outer->error);
    if (inner.status || !keep_root(parser, root)) {
        outer->status = inner.status ? inner.status : outer->status;
        return;
    }
    parser->reader = &inner;
    inner.status = meso_json_check_format(root, input->path, "meso-macros", MESO_MACROS_VERSION, outer->error);
    MesoJsonField field = meso_json_root(&inner, root), table = meso_json_key(&field, "macros");
    if (!inner.status && meso_json_object(&field, keys)) {
        meso_json_require(&table);
        meso_macros_add(parser, &table);
    }
    parser->reader = outer;
    outer->status = inner.status;
}

void meso_macros_release(MesoPatternParser *parser)
{
    for (uint32_t i = 0; i < parser->macros.root_count; i++)
        json_decref(parser->macros.roots[i]);
    parser->macros.root_count = 0;
}

/* ---- writing out ---- */

typedef struct Expansion {
    MesoPatternParser *parser;
    const MesoJsonField *call;
    const char *macro;
    const json_t *parameters;   /* with their defaults; NULL: none */
} Expansion;

/* Counts what is written out; false, told at `field`, where that is too much. */
static bool spend(const Expansion *e, const MesoJsonField *field, const json_t *value, uint32_t depth)
{
    uint64_t cost = 1 + json_string_length(value) / 64;
    if (depth > MOST_DEPTH)
        meso_json_wrong(field, "more than %d levels", MOST_DEPTH);
    else if (cost > MESO_PATTERN_VALUES - e->parser->value_count)
        meso_json_wrong(field, "macros write out more than %d values", MESO_PATTERN_VALUES);
    else
        e->parser->value_count += (uint32_t)cost;
    return meso_json_good(field);
}

/* Counts a parameter's value, which is not copied. */
static bool spend_all(const Expansion *e, const MesoJsonField *field, const json_t *value, uint32_t depth)
{
    const char *key;
    json_t *item;
    size_t i;
    if (!spend(e, field, value, depth))
        return false;
    json_object_foreach((json_t *)value, key, item)
        if (!spend_all(e, field, item, depth + 1))
            return false;
    json_array_foreach(value, i, item)
        if (!spend_all(e, field, item, depth + 1))
            return false;
    return true;
}

/* NULL where it has none. */
static const char *nearest_parameter(const Expansion *e, const char *name)
{
    MesoNearest nearest = meso_nearest(name, strlen(name));
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)e->parameters, key, value)
        if (!meso_json_is_note(key))
            meso_nearest_try(&nearest, key);
    return nearest.best;
}

/* The value of "$name"; NULL for one that leaves out its place. */
static json_t *parameter(const Expansion *e, const MesoJsonField *field, const char *name, uint32_t depth)
{
    json_t *value = json_object_get(e->parameters, name), *given = json_object_get(e->call->value, name);
    if (!value) {
        const char *nearest = nearest_parameter(e, name);
        if (nearest)
            meso_json_wrong(field, "no parameter '%.40s'; did you mean '$%.40s'?", name, nearest);
        else
            meso_json_wrong(field, "no parameter '%.40s'; \"$$\" begins a text with '$'", name);
        return NULL;
    }
    value = given ? given : value;
    return json_is_null(value) || !spend_all(e, field, value, depth) ? NULL : json_incref(value);
}

static json_t *write_out(const Expansion *e, const MesoJsonField *field, uint32_t depth);

static json_t *write_object(const Expansion *e, const MesoJsonField *field, uint32_t depth)
{
    json_t *copy = json_object(), *value;
    const char *key;
    bool full = copy != NULL;
    json_object_foreach((json_t *)field->value, key, value) {
        MesoJsonField item = meso_json_key(field, key);
        json_t *own = meso_json_is_note(key) ? NULL : write_out(e, &item, depth + 1);
        full = full && (!own || json_object_set_new_nocheck(copy, key, own) == 0);
        if (!meso_json_good(field) || !full)
            break;
    }
    if (!full)
        fail_memory(e->parser);
    return copy;
}

static json_t *write_array(const Expansion *e, const MesoJsonField *field, uint32_t depth)
{
    json_t *copy = json_array();
    bool full = copy != NULL;
    for (size_t i = 0; full && i < json_array_size(field->value) && meso_json_good(field); i++) {
        MesoJsonField item = meso_json_item(field, i);
        json_t *own = write_out(e, &item, depth + 1);
        full = !own || json_array_append_new(copy, own) == 0;
    }
    if (!full)
        fail_memory(e->parser);
    return copy;
}

/* A new value, or NULL for one that is left out or wrong. */
static json_t *write_out(const Expansion *e, const MesoJsonField *field, uint32_t depth)
{
    const char *text = json_string_value(field->value);
    if (!spend(e, field, field->value, depth))
        return NULL;
    if (json_is_object(field->value))
        return write_object(e, field, depth);
    if (json_is_array(field->value))
        return write_array(e, field, depth);
    if (!text || text[0] != '$')
        return json_incref((json_t *)field->value);
    if (text[1] != '$')
        return parameter(e, field, text + 1, depth);
    json_t *plain = json_string_nocheck(text + 1);
    if (!plain)
        fail_memory(e->parser);
    return plain;
}

/* True for a step that says only where it is. */
static bool is_nothing(const json_t *step)
{
    return json_object_size(step) == (json_object_get(step, "on") ? 1 : 0);
}

/* The steps; without those whose only thing to do is a parameter that is null. */
static json_t *write_steps(const Expansion *e, const MesoJsonField *list)
{
    json_t *copy = write_array(e, list, 0);
    for (size_t i = json_array_size(copy); i > 0; i--) {
        const json_t *step = json_array_get(copy, i - 1);
        if (json_is_object(step) && is_nothing(step))
            json_array_remove(copy, i - 1);
    }
    return copy;
}

/* ---- calls ---- */

static void check_arguments(const Expansion *e)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)e->call->value, key, value) {
        if (meso_macro_is_own_key(key) || json_object_get(e->parameters, key))
            continue;
        const char *nearest = nearest_parameter(e, key);
        if (nearest)
            meso_json_wrong(e->call, "macro '%.80s' has no parameter '%.40s'; did you mean '%.40s'?", e->macro, key,
                            nearest);
        else
            meso_json_wrong(e->call, "macro '%.80s' has no parameter '%.40s'", e->macro, key);
    }
}

static uint32_t find_macro(const MesoPatternParser *parser, const MesoJsonField *field)
{
    const MesoMacroTable *table = &parser->macros;
    const char *name = json_string_value(field->value);
    meso_json_require(field);
    if (!name)
        meso_json_wrong(field, "the name of a macro is needed here");
    if (!meso_json_good(field))
        return MESO_NO_INDEX;
    uint32_t number = meso_names_find(&table->numbers, name, strlen(name));
    if (number != MESO_NO_INDEX)
        return number;
    MesoNearest nearest = meso_nearest(name, strlen(name));
    for (uint32_t i = 0; i < table->count; i++)
        meso_nearest_try(&nearest, table->names[i]);
    if (nearest.best)
        meso_json_wrong(field, "no macro '%.80s'; did you mean '%.80s'?", name, nearest.best);
    else
        meso_json_wrong(field, "no macro '%.80s'", name);
    return MESO_NO_INDEX;
}

/* Nothing ends a macro that calls itself: steps have no conditions. */
static void check_calls(const MesoPatternParser *parser, const MesoJsonField *field, const char *name)
{
    for (uint32_t i = 0; i < parser->call_count; i++)
        if (strcmp(parser->calls[i], name) == 0)
            meso_json_wrong(field, "macro '%.80s' calls itself", name);
    if (parser->call_count == MESO_PATTERN_NESTING)
        meso_json_wrong(field, "macros in more than %d macros", MESO_PATTERN_NESTING);
}

void meso_macro_begin(MesoMacroCall *call, MesoPatternParser *parser, const MesoJsonField *field)
{
    MesoJsonReader *reader = parser->reader;
    MesoJsonField name_field = meso_json_key(field, "macro");
    uint32_t number = find_macro(parser, &name_field);
    *call = (MesoMacroCall){.name = ""};
    if (number == MESO_NO_INDEX)
        return;
    const json_t *macro = parser->macros.values[number];
    const char *name = meso_arena_copy_text(reader->arena, parser->macros.names[number], reader->error);
    const char *key = meso_arena_print(reader->arena, reader->error, "macro %.60s", parser->macros.names[number]);
    if (!name || !key) {
        fail_memory(parser);
        return;
    }
    const Expansion e = {parser, field, name, json_object_get(macro, "parameters")};
    call->name = name;
    call->scope = (MesoJsonField){.reader = reader, .parent = field, .key = key, .value = macro};
    call->list = meso_json_key(&call->scope, "steps");
    check_calls(parser, field, name);
    check_arguments(&e);
    json_t *steps = meso_json_good(field) ? write_steps(&e, &call->list) : NULL;
    if (!meso_json_good(field)) {
        json_decref(steps);
        return;
    }
    call->steps = steps;
    call->list.value = steps;
    parser->calls[parser->call_count++] = name;
}

void meso_macro_end(MesoMacroCall *call, MesoPatternParser *parser)
{
    parser->call_count--;
    json_decref(call->steps);
    call->steps = NULL;
}
