#include "formats/tiling/constraints/constraints_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_field.h"
#include "formats/json/json_text.h"
#include "formats/tiling/constraints/constraint_names.h"
#include "formats/tiling/constraints/constraint_places.h"
#include "formats/tiling/constraints/constraint_weights.h"
#include "libcore/tiling/solve/solve.h"

typedef struct Parser {
    const MesoConstraintScope *scope;
    MesoJsonReader *reader;
    MesoConstraintNames names;
    MesoPlaceSelector selector;
    MesoWeightReader weights;
    MesoRestriction *restrictions;
    uint32_t restriction_count;
    MesoQuota *quotas;
} Parser;

static void out_of_memory(Parser *parser)
{
    MesoJsonReader *reader = parser->reader;
    if (!reader->status)
        reader->status = meso_fail(reader->error, MESO_ERR_MEMORY, "%s: out of memory", reader->path);
}

/* `count` zeroed elements, or NULL with the reader's status set. */
static void *allocate(Parser *parser, uint64_t count, size_t size)
{
    void *array = meso_arena_alloc(parser->reader->arena, count, size, parser->reader->error);
    if (!array)
        out_of_memory(parser);
    return array;
}

static uint32_t read_tile(Parser *parser, const MesoJsonField *field)
{
    const char *name = meso_json_text(field);
    return meso_json_good(field) ? meso_constraint_tile(&parser->names, field, name) : MESO_NO_INDEX;
}

/* "pins[2]", or "pins[2] 'knob'" for one with a name. */
static const char *name_constraint(Parser *parser, const MesoJsonField *item, const char *list)
{
    MesoJsonField field = meso_json_key(item, "name");
    const char *given = field.value ? meso_json_text(&field) : NULL;
    const char *name = given ? meso_arena_print(parser->reader->arena, parser->reader->error, "%s[%zu] '%.80s'", list,
                                                item->index, given)
                             : meso_arena_print(parser->reader->arena, parser->reader->error, "%s[%zu]", list,
                                                item->index);
    if (!name)
        out_of_memory(parser);
    return name ? name : "";
}

static uint64_t *new_variants(Parser *parser)
{
    return allocate(parser, meso_bits_words(parser->scope->variants->count), sizeof(uint64_t));
}

static void add_tile(Parser *parser, uint64_t *variants, uint32_t tile)
{
    for (uint32_t v = 0; v < parser->scope->variants->count; v++)
        if (parser->scope->variants->tile[v] == tile)
            meso_bits_set(variants, v);
}

/* --- pins --- */

/* Variants of `tile` under the transforms that "turn" and "flip" leave. */
static void read_transforms(Parser *parser, const MesoJsonField *pin, uint32_t tile, uint64_t *variants)
{
    const MesoConstraintScope *scope = parser->scope;
    MesoJsonField turn = meso_json_key(pin, "turn"), flip = meso_json_key(pin, "flip");
    int64_t quarters = meso_json_whole(&turn, 0, 3, -1);
    bool flips = meso_json_bool(&flip, false), any = false;
    for (uint32_t t = 0; t < MESO_TRANSFORM_COUNT; t++) {
        MesoTransform transform = (MesoTransform)t;
        if ((turn.value && (transform & 3) != quarters) || (flip.value && meso_transform_flips(transform) != flips) ||
            !meso_tile_allows(&scope->set->tiles[tile], transform))
            continue;
        uint32_t variant = meso_variant_find(scope->variants, scope->set, tile, transform);
        if (variant != MESO_NO_INDEX)
            meso_bits_set(variants, variant);
        any |= variant != MESO_NO_INDEX;
    }
    if (!any)
        meso_json_wrong(pin, "tile '%.80s' does not allow this transform", scope->set->tiles[tile].name);
}

/* Variants that show label `code` on any side. */
static void add_showing(Parser *parser, uint64_t *variants, uint32_t code)
{
    for (uint32_t v = 0; v < parser->scope->variants->count; v++)
        for (uint32_t k = 0; k < 4; k++)
            if (meso_label_code(parser->scope->variants->labels[4 * (size_t)v + k]) == code)
                meso_bits_set(variants, v);
}

/* Slots become the half-edges on their side `side`. */
static void turn_to_sides(MesoRestriction *restriction, uint32_t *places, uint32_t side)
{
    restriction->sided = true;
    for (uint32_t i = 0; i < restriction->place_count; i++)
        places[i] = 4 * places[i] + side;
}

static void read_pin_interface(Parser *parser, const MesoJsonField *pin, const MesoJsonField *interface,
                               MesoRestriction *restriction, uint32_t *places)
{
    MesoJsonField side = meso_json_key(pin, "side");
    uint32_t code = meso_constraint_label(&parser->names, interface);
    uint32_t words = meso_bits_words(2 * parser->scope->set->interface_count);
    int64_t k = meso_json_whole(&side, 0, 3, 0);
    uint64_t *allowed = side.value ? allocate(parser, words, sizeof *allowed) : new_variants(parser);
    if (!allowed || code == MESO_NO_INDEX)
        return;
    restriction->allowed = allowed;
    if (!side.value) {
        add_showing(parser, allowed, code);
        return;
    }
    meso_bits_set(allowed, code);
    turn_to_sides(restriction, places, (uint32_t)k);
}

static void read_pin(Parser *parser, const MesoJsonField *pin)
{
    static const char *const keys[] = {"name", "slot", "where", "tile", "turn", "flip", "interface", "side", NULL};
    if (!meso_json_object(pin, keys))
        return;
    MesoJsonField tile = meso_json_key(pin, "tile"), interface = meso_json_key(pin, "interface");
    MesoJsonField slot = meso_json_key(pin, "slot"), where = meso_json_key(pin, "where");
    bool transformed = json_object_get(pin->value, "turn") || json_object_get(pin->value, "flip");
    if (!tile.value == !interface.value)
        meso_json_wrong(pin, "either \"tile\" or \"interface\" is needed");
    else if (!slot.value == !where.value)
        meso_json_wrong(pin, "either \"slot\" or \"where\" is needed");
    else if (interface.value && transformed)
        meso_json_wrong(pin, "\"turn\" and \"flip\" go with \"tile\"");
    else if (tile.value && json_object_get(pin->value, "side"))
        meso_json_wrong(pin, "\"side\" goes with \"interface\"");

    MesoRestriction *restriction = &parser->restrictions[parser->restriction_count++];
    restriction->name = name_constraint(parser, pin, "pins");
    uint32_t *places = slot.value ? meso_places_of_slot(&parser->selector, &slot, &restriction->place_count)
                                  : meso_places_select(&parser->selector, &where, &restriction->place_count);
    restriction->places = places;
    if (!meso_json_good(pin))
        return;
    if (interface.value) {
        read_pin_interface(parser, pin, &interface, restriction, places);
        return;
    }
    uint64_t *variants = new_variants(parser);
    uint32_t number = read_tile(parser, &tile);
    restriction->allowed = variants;
    if (variants && number != MESO_NO_INDEX)
        read_transforms(parser, pin, number, variants);
}

/* --- regions --- */

/* Variants of the tiles that a list names. */
static uint64_t *read_tile_list(Parser *parser, const MesoJsonField *list)
{
    uint64_t *variants = new_variants(parser);
    uint32_t count = meso_json_count(list, 1, MESO_CONSTRAINTS_ITEMS);
    for (uint32_t i = 0; variants && i < count && meso_json_good(list); i++) {
        MesoJsonField item = meso_json_item(list, i);
        uint32_t tile = read_tile(parser, &item);
        if (tile != MESO_NO_INDEX)
            add_tile(parser, variants, tile);
    }
    return variants;
}

static void read_region(Parser *parser, const MesoJsonField *region)
{
    static const char *const keys[] = {"name", "where", "tiles", "weights", NULL};
    if (!meso_json_object(region, keys))
        return;
    MesoJsonField where = meso_json_key(region, "where"), tiles = meso_json_key(region, "tiles");
    MesoJsonField weights = meso_json_key(region, "weights");
    uint32_t count = 0;
    meso_json_require(&where);
    if (!tiles.value && !weights.value)
        meso_json_wrong(region, "\"tiles\" or \"weights\" is needed");
    const char *name = name_constraint(parser, region, "regions");
    uint32_t *places = meso_places_select(&parser->selector, &where, &count);
    if (!meso_json_good(region))
        return;
    if (tiles.value)
        parser->restrictions[parser->restriction_count++] = (MesoRestriction){
            .name = name, .place_count = count, .places = places, .allowed = read_tile_list(parser, &tiles)};
    meso_weight_reader_add(&parser->weights, &weights, places, count);
}

/* --- borders and quotas --- */

static void read_border(Parser *parser, const MesoJsonField *border)
{
    static const char *const keys[] = {"name", "loop", "interfaces", NULL};
    if (!meso_json_object(border, keys))
        return;
    const MesoBoundary *boundary = parser->scope->boundary;
    MesoJsonField loop = meso_json_key(border, "loop"), interfaces = meso_json_key(border, "interfaces");
    uint32_t begin = 0, end = boundary->loop_count ? boundary->loop_begin[boundary->loop_count] : 0;
    meso_json_require(&loop);
    bool all = json_is_string(loop.value) && strcmp(json_string_value(loop.value), "all") == 0;
    if (loop.value && !all && !json_is_integer(loop.value))
        meso_json_wrong(&loop, "the number of a boundary loop, or \"all\", is needed here");
    else if (boundary->loop_count == 0)
        meso_json_wrong(&loop, "the surface has no border");
    else if (!all) {
        uint32_t number = (uint32_t)meso_json_whole(&loop, 0, (int64_t)boundary->loop_count - 1, 0);
        begin = boundary->loop_begin[number];
        end = boundary->loop_begin[number + 1];
    }
    uint64_t *labels = allocate(parser, meso_bits_words(2 * parser->scope->set->interface_count), sizeof *labels);
    uint32_t count = meso_json_count(&interfaces, 1, MESO_CONSTRAINTS_ITEMS);
    for (uint32_t i = 0; labels && i < count && meso_json_good(border); i++) {
        MesoJsonField item = meso_json_item(&interfaces, i);
        uint32_t code = meso_constraint_label(&parser->names, &item);
        if (code != MESO_NO_INDEX)
            meso_bits_set(labels, code);
    }
    parser->restrictions[parser->restriction_count++] = (MesoRestriction){
        .name = name_constraint(parser, border, "borders"), .sided = true, .place_count = end - begin,
        .places = boundary->half_edges + begin, .allowed = labels};
}

/* A count of slots, or the `share` of all; a share means the whole numbers of slots within it. */
static uint32_t read_bound(Parser *parser, const MesoJsonField *quota, const char *count_key, const char *share_key,
                           bool least)
{
    double slots = parser->scope->graph->slot_count;
    MesoJsonField count = meso_json_key(quota, count_key), share = meso_json_key(quota, share_key);
    if (count.value && share.value)
        meso_json_wrong(quota, "\"%s\" and \"%s\" exclude each other", count_key, share_key);
    if (!share.value)
        return (uint32_t)meso_json_whole(&count, 0, UINT32_MAX - 1, least ? 0 : UINT32_MAX - 1);
    double part = (double)meso_json_float(&share, 0);
    if (!(part >= 0 && part <= 1)) {
        meso_json_wrong(&share, "%g; a share is from 0 to 1", part);
        return 0;
    }
    /* A share like 0.1 has an error of its own, of 1e-7 of it: that much is let pass. */
    double exact = part * slots, slack = 1e-7 * exact;
    return (uint32_t)(least ? ceil(exact - slack) : floor(exact + slack));
}

static void read_quota(Parser *parser, const MesoJsonField *field, MesoQuota *quota)
{
    static const char *const keys[] = {"name", "tile", "tiles", "least", "most", "least_share", "most_share", NULL};
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField tile = meso_json_key(field, "tile"), tiles = meso_json_key(field, "tiles");
    if (!tile.value == !tiles.value)
        meso_json_wrong(field, "either \"tile\" or \"tiles\" is needed");
    quota->name = name_constraint(parser, field, "quotas");
    quota->least = read_bound(parser, field, "least", "least_share", true);
    quota->most = read_bound(parser, field, "most", "most_share", false);
    if (quota->least > quota->most)
        meso_json_wrong(field, "at least %u and at most %u exclude each other", quota->least, quota->most);
    if (!meso_json_good(field))
        return;
    uint64_t *variants = tile.value ? new_variants(parser) : read_tile_list(parser, &tiles);
    uint32_t number = tile.value ? read_tile(parser, &tile) : MESO_NO_INDEX;
    if (variants && number != MESO_NO_INDEX)
        add_tile(parser, variants, number);
    quota->variants = variants;
}

static void read_strands(const MesoJsonField *field, MesoStrandRule *rule)
{
    static const char *const keys[] = {"connected", "acyclic", "no_loops", "max_length", NULL};
    if (!field->value || !meso_json_object(field, keys))
        return;
    MesoJsonField connected = meso_json_key(field, "connected"), acyclic = meso_json_key(field, "acyclic");
    MesoJsonField no_loops = meso_json_key(field, "no_loops"), length = meso_json_key(field, "max_length");
    rule->connected = meso_json_bool(&connected, false);
    rule->acyclic = meso_json_bool(&acyclic, false);
    rule->no_loops = meso_json_bool(&no_loops, false);
    rule->max_length = (uint32_t)meso_json_whole(&length, 1, UINT32_MAX, 0);
}

/* --- the file --- */

typedef void ReadItem(Parser *parser, const MesoJsonField *item);

static void read_list(Parser *parser, const MesoJsonField *root, const char *key, ReadItem *read)
{
    MesoJsonField list = meso_json_key(root, key);
    uint32_t count = meso_json_count(&list, 0, MESO_CONSTRAINTS_ITEMS);
    for (uint32_t i = 0; i < count && meso_json_good(root); i++) {
        MesoJsonField item = meso_json_item(&list, i);
        read(parser, &item);
    }
}

static void read_quotas(Parser *parser, const MesoJsonField *root, MesoConstraints *constraints)
{
    MesoJsonField list = meso_json_key(root, "quotas");
    uint32_t count = meso_json_count(&list, 0, MESO_CONSTRAINTS_ITEMS);
    parser->quotas = allocate(parser, count, sizeof *parser->quotas);
    for (uint32_t i = 0; parser->quotas && i < count && meso_json_good(root); i++) {
        MesoJsonField item = meso_json_item(&list, i);
        read_quota(parser, &item, &parser->quotas[i]);
    }
    constraints->quotas = parser->quotas;
    constraints->quota_count = count;
}

static const char *const root_keys[] = {"format", "version", "provenance", "weights", "pins", "regions", "borders",
                                        "quotas", "strands", NULL};

static void read_all(Parser *parser, const MesoJsonField *root, MesoConstraints *constraints)
{
    if (!meso_json_object(root, root_keys))
        return;
    uint64_t most = json_array_size(json_object_get(root->value, "pins")) +
                    json_array_size(json_object_get(root->value, "regions")) +
                    json_array_size(json_object_get(root->value, "borders"));
    parser->restrictions = allocate(parser, most, sizeof *parser->restrictions);
    meso_weight_reader_begin(&parser->weights);
    if (!meso_json_good(root))
        return;
    MesoJsonField weights = meso_json_key(root, "weights"), strands = meso_json_key(root, "strands");
    meso_weight_reader_add(&parser->weights, &weights, NULL, 0);
    read_list(parser, root, "pins", read_pin);
    read_list(parser, root, "regions", read_region);
    read_list(parser, root, "borders", read_border);
    read_quotas(parser, root, constraints);
    read_strands(&strands, &constraints->strands);
    constraints->restrictions = parser->restrictions;
    constraints->restriction_count = parser->restriction_count;
}

static void read_root(Parser *parser, const json_t *json, MesoConstraints *constraints)
{
    const MesoConstraintScope *scope = parser->scope;
    MesoJsonField root = meso_json_root(parser->reader, json);
    parser->selector = (MesoPlaceSelector){.reader = parser->reader, .mesh = scope->mesh,
                                           .slot_count = scope->graph->slot_count};
    parser->weights = (MesoWeightReader){.reader = parser->reader, .names = &parser->names,
                                         .variants = scope->variants, .mesh = scope->mesh,
                                         .slot_count = scope->graph->slot_count};
    parser->names.set = scope->set;
    parser->reader->status = meso_tile_names_init(&parser->names.by_name, parser->reader->arena, scope->set,
                                                  parser->reader->error);
    if (!parser->reader->status)
        read_all(parser, &root, constraints);
    constraints->weights = meso_weight_reader_finish(&parser->weights);
}

MesoStatus meso_constraints_read(MesoConstraints *constraints, MesoArena *arena, const MesoInput *input,
                                 const MesoConstraintScope *scope, MesoError *error)
{
    json_t *json;
    *constraints = (MesoConstraints){0};
    MesoStatus status = meso_json_parse(&json, input, error);
    if (!status)
        status = meso_json_check_format(json, input->path, "meso-constraints", MESO_CONSTRAINTS_VERSION, error);
    if (!status) {
        MesoJsonReader reader = {.path = input->path, .arena = arena, .error = error};
        Parser parser = {.scope = scope, .reader = &reader};
        read_root(&parser, json, constraints);
        status = reader.status;
    }
    json_decref(json);
    return status;
}

static uint32_t count_items(const MesoJsonField *root, const char *key)
{
    MesoJsonField list = meso_json_key(root, key);
    return meso_json_count(&list, 0, MESO_CONSTRAINTS_ITEMS);
}

MesoStatus meso_constraints_outline(MesoConstraintOutline *outline, MesoArena *arena, const json_t *root,
                                    const char *path, MesoError *error)
{
    MesoStatus status = meso_json_check_format(root, path, "meso-constraints", MESO_CONSTRAINTS_VERSION, error);
    if (status)
        return status;
    MesoJsonReader reader = {.path = path, .arena = arena, .error = error};
    MesoJsonField field = meso_json_root(&reader, root), weights = meso_json_key(&field, "weights");
    MesoStrandRule rule = {0};
    meso_json_object(&field, root_keys);
    if (weights.value)
        meso_json_object(&weights, NULL);
    *outline = (MesoConstraintOutline){
        .weight_count = (uint32_t)json_object_size(weights.value), .pin_count = count_items(&field, "pins"),
        .region_count = count_items(&field, "regions"), .border_count = count_items(&field, "borders"),
        .quota_count = count_items(&field, "quotas"),
    };
    MesoJsonField strands = meso_json_key(&field, "strands");
    read_strands(&strands, &rule);
    return reader.status;
}

static bool parse_strand_word(MesoStrandRule *rule, const char *word, size_t size)
{
    static const char longest[] = "max-length=";
    if (size == strlen("connected") && memcmp(word, "connected", size) == 0)
        rule->connected = true;
    else if (size == strlen("acyclic") && memcmp(word, "acyclic", size) == 0)
        rule->acyclic = true;
    else if (size == strlen("no-loops") && memcmp(word, "no-loops", size) == 0)
        rule->no_loops = true;
    else if (size >= sizeof longest && size < sizeof longest + 10 && memcmp(word, longest, sizeof longest - 1) == 0) {
        uint64_t length = 0;
        for (size_t i = sizeof longest - 1; i < size; i++) {
            if (word[i] < '0' || word[i] > '9')
                return false;
            length = 10 * length + (uint64_t)(word[i] - '0');
        }
        if (length == 0 || length > UINT32_MAX)
            return false;
        rule->max_length = (uint32_t)length;
    } else
        return false;
    return true;
}

MesoStatus meso_strand_rule_parse(MesoStrandRule *rule, const char *text, MesoError *error)
{
    for (const char *word = text;; word++) {
        size_t size = strcspn(word, ",");
        if (!parse_strand_word(rule, word, size))
            return meso_fail(error, MESO_ERR_USAGE,
                             "'%.*s' is no rule on strands; 'connected', 'acyclic', 'no-loops' and "
                             "'max-length=N' are, with commas between several", (int)(size < 60 ? size : 60), word);
        word += size;
        if (!*word)
            return MESO_OK;
    }
}
