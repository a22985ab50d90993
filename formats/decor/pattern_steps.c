#include "formats/decor/pattern_steps.h"

#include <string.h>

#include "formats/decor/pattern_after.h"
#include "formats/decor/pattern_field.h"
#include "formats/decor/pattern_macros.h"
#include "formats/decor/pattern_seeds.h"
#include "formats/decor/pattern_selector.h"

enum { MOST_LINES = 1 << 16, MOST_RULES = 1 << 10, MOST_ROUNDS = 64, MOST_CYCLE = 1 << 16 };

/* ---- operators ---- */

static void read_contour(MesoPatternParser *parser, const MesoJsonField *field, MesoStep *step)
{
    static const char *const keys[] = {"dist", "blend", "noise", "at", "count", "every", "unit", NULL};
    if (!meso_json_object(field, keys))
        return;
    meso_pattern_field(parser, field, &step->field);
    meso_pattern_levels(parser, field, &step->levels);
}

static void read_stream(MesoPatternParser *parser, const MesoJsonField *field, MesoStep *step)
{
    static const char *const keys[] = {"dist", "blend", "noise", "lines", NULL};
    MesoJsonField lines = meso_json_key(field, "lines");
    if (!meso_json_object(field, keys))
        return;
    meso_pattern_field(parser, field, &step->field);
    step->line_count = (uint32_t)meso_json_whole(&lines, 1, MOST_LINES, 12);
}

/* Seeds alone, or an object with their distance. */
static void read_voronoi(MesoPatternParser *parser, const MesoJsonField *field, MesoStep *step)
{
    static const char *const keys[] = {"dist", "noise", NULL};
    MesoJsonField dist = meso_json_key(field, "dist");
    if (!json_is_object(field->value) || meso_pattern_is_seed(field->value)) {
        meso_pattern_seeds(parser, field, &step->field.from);
    } else if (meso_json_object(field, keys)) {
        meso_json_require(&dist);
        meso_pattern_field(parser, field, &step->field);
    }
}

static void read_polyline(MesoPatternParser *parser, const MesoJsonField *field, MesoStep *step)
{
    static const char *const keys[] = {"points", "closed", NULL};
    MesoJsonField points = meso_json_key(field, "points"), closed = meso_json_key(field, "closed");
    if (!meso_json_object(field, keys))
        return;
    step->closed = meso_json_bool(&closed, false);
    step->points = meso_pattern_row(parser, &points, step->closed ? 3 : 2, &step->point_count);
}

/* ---- macros and growth ---- */

static void read_macro(MesoPatternParser *parser, const MesoJsonField *field, MesoMacro *macro)
{
    MesoMacroCall call;
    meso_macro_begin(&call, parser, field);
    macro->name = call.name;
    if (!call.steps)
        return;
    meso_pattern_steps(parser, &call.list, &macro->steps, &macro->step_count);
    meso_macro_end(&call, parser);
}

/* Steps without a name, in the region as their scope. */
static void read_group(MesoPatternParser *parser, const MesoJsonField *field, MesoMacro *macro)
{
    macro->name = "steps";
    if (parser->call_count == MESO_PATTERN_NESTING) {
        meso_json_wrong(field, "steps in more than %d steps and macros", MESO_PATTERN_NESTING);
        return;
    }
    parser->calls[parser->call_count++] = "";
    meso_pattern_steps(parser, field, &macro->steps, &macro->step_count);
    parser->call_count--;
}

static void read_rule(MesoPatternParser *parser, const MesoJsonField *field, MesoRule *rule)
{
    MesoJsonField on = meso_json_key(field, "on"), weight = meso_json_key(field, "weight");
    MesoJsonField most = meso_json_key(field, "most");
    if (!meso_json_object(field, NULL))
        return;
    meso_pattern_rule_selector(parser, &on, &rule->where);
    rule->weight = meso_json_float_in(&weight, 0, INFINITY, false, 1);
    rule->most = (uint32_t)meso_json_whole(&most, 1, UINT32_MAX, 0);
    read_macro(parser, field, &rule->macro);
}

static void check_weights(const MesoJsonField *field, const MesoGrowth *growth)
{
    double sum = (double)growth->rest;
    for (uint32_t i = 0; i < growth->rule_count; i++)
        sum += (double)growth->rules[i].weight;
    if (sum == 0)
        meso_json_wrong(field, "no rule has a weight above 0");
}

static void read_grow(MesoPatternParser *parser, const MesoJsonField *field, MesoGrowth *growth)
{
    static const char *const keys[] = {"rules", "depth", "smallest", "group", "cycle", "rest", NULL};
    static const char *const groups[] = {"none", "type", "shape", "cyclic", NULL};
    MesoJsonField list = meso_json_key(field, "rules"), depth = meso_json_key(field, "depth");
    MesoJsonField smallest = meso_json_key(field, "smallest"), group = meso_json_key(field, "group");
    MesoJsonField cycle = meso_json_key(field, "cycle"), rest = meso_json_key(field, "rest");
    if (!meso_json_object(field, keys))
        return;
    uint32_t count = meso_json_count(&list, 1, MOST_RULES);
    MesoRule *rules = MESO_PATTERN_NEW(parser, MesoRule, count);
    for (uint32_t i = 0; rules && i < count && meso_json_good(field); i++) {
        MesoJsonField item = meso_json_item(&list, i);
        read_rule(parser, &item, &rules[i]);
    }
    growth->rules = rules;
    growth->rule_count = rules ? count : 0;
    growth->depth = (uint32_t)meso_json_whole(&depth, 1, MOST_ROUNDS, 3);
    growth->smallest = meso_json_float_in(&smallest, 0, 1, false, 0.001f);
    growth->grouping = (MesoGrouping)meso_json_word(&group, "grouping", groups, MESO_GROUP_TYPE);
    growth->cycle = (uint32_t)meso_json_whole(&cycle, 1, MOST_CYCLE, 2);
    if (cycle.value && growth->grouping != MESO_GROUP_CYCLIC)
        meso_json_wrong(&cycle, "it goes with \"group\": \"cyclic\"");
    growth->rest = meso_json_float_in(&rest, 0, INFINITY, false, 0);
    check_weights(field, growth);
}

/* ---- steps ---- */

/* What a step can be, by the key that says so. */
typedef enum Does { CONTOUR, STREAM, VORONOI, POLYLINE, MACRO, GROUP, GROW, PAINT, DISPLACE, DOES_COUNT } Does;

static const char *const does_keys[] = {"contour", "stream", "voronoi", "polyline", "macro", "steps", "grow", "paint",
                                        "displace", NULL};

/* The first of its keys that says what it is: those of what regions get come last. */
static Does find_out(const MesoJsonField *field)
{
    uint32_t does = 0;
    while (does < DOES_COUNT && !meso_pattern_has(field, does_keys[does]))
        does++;
    return (Does)does;
}

/* Its first key that could be what it does is told of with the nearest there is. */
static void refuse_nothing(const MesoJsonField *field)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)field->value, key, value)
        if (strcmp(key, "on") != 0 && strcmp(key, "names") != 0 && !meso_json_is_note(key))
            meso_json_refuse(field, "step", key, does_keys);
    meso_json_wrong(field, "a step does something; there are \"contour\", \"stream\", \"voronoi\", \"polyline\", "
                    "\"paint\", \"displace\", \"macro\", \"steps\" and \"grow\"");
}

static bool check_keys(const MesoJsonField *field, Does does)
{
    static const char *const rule_keys[] = {"weight", "most"};
    static const char *const split[] = {"on", "paint", "displace", "names", NULL};
    const char *keys[6] = {does_keys[does], "on"};
    for (uint32_t i = 0; does == MACRO && i < 2; i++)
        if (meso_pattern_has(field, rule_keys[i]))
            meso_json_wrong(field, "\"%s\" is a key of rules of growth", rule_keys[i]);
    if (does == MACRO)
        return meso_json_good(field);
    if (does <= POLYLINE)
        memcpy(keys + 1, split, sizeof split);
    return meso_json_object(field, keys);
}

static void read_kind(MesoPatternParser *parser, const MesoJsonField *field, Does does, MesoStep *step)
{
    static const char *const contour_tags[] = {"band", "inside", "dot", "background", "stripe", NULL};
    static const char *const stream_tags[] = {"stripe", NULL}, *const voronoi_tags[] = {"cell", NULL};
    static const char *const polyline_tags[] = {"cell", NULL}, *const closed_tags[] = {"inside", "background", NULL};
    static const MesoStepKind kinds[] = {MESO_STEP_CONTOUR, MESO_STEP_STREAM, MESO_STEP_VORONOI,
                                         MESO_STEP_POLYLINE, MESO_STEP_MACRO, MESO_STEP_MACRO,
                                         MESO_STEP_GROW, MESO_STEP_PAINT, MESO_STEP_DISPLACE};
    const char *const *tags = NULL;
    MesoJsonField body = meso_json_key(field, does_keys[does]);
    step->kind = kinds[does];
    switch (does) {
    case CONTOUR:
        read_contour(parser, &body, step);
        tags = contour_tags;
        break;
    case STREAM:
        read_stream(parser, &body, step);
        tags = stream_tags;
        break;
    case VORONOI:
        read_voronoi(parser, &body, step);
        tags = voronoi_tags;
        break;
    case POLYLINE:
        read_polyline(parser, &body, step);
        tags = step->closed ? closed_tags : polyline_tags;
        break;
    case MACRO:
        read_macro(parser, field, &step->macro);
        break;
    case GROUP:
        read_group(parser, &body, &step->macro);
        break;
    case GROW:
        read_grow(parser, &body, &step->growth);
        break;
    default:
        meso_pattern_after_alone(parser, field, &step->after, &step->after_count);
    }
    if (tags)
        meso_pattern_after_split(parser, field, tags, &step->after, &step->after_count);
}

static void read_step(MesoPatternParser *parser, const MesoJsonField *field, MesoStep *step)
{
    MesoJsonField on = meso_json_key(field, "on");
    char place[160];
    meso_json_place(field, place, sizeof place);
    step->place = meso_arena_copy_text(parser->reader->arena, place, parser->reader->error);
    if (!step->place)
        parser->reader->status = MESO_ERR_MEMORY;
    if (!meso_json_object(field, NULL))
        return;
    Does does = find_out(field);
    if (does == DOES_COUNT) {
        refuse_nothing(field);
        return;
    }
    if (!check_keys(field, does))
        return;
    meso_pattern_selector(parser, &on, &step->on);
    read_kind(parser, field, does, step);
}

void meso_pattern_steps(MesoPatternParser *parser, const MesoJsonField *list, const MesoStep **steps, uint32_t *count)
{
    uint32_t size = meso_json_count(list, 1, MESO_PATTERN_STEPS);
    if (size > MESO_PATTERN_STEPS - parser->step_count)
        meso_json_wrong(list, "more than %d steps, with those of macros", MESO_PATTERN_STEPS);
    if (!meso_json_good(list))
        return;
    parser->step_count += size;
    MesoStep *array = MESO_PATTERN_NEW(parser, MesoStep, size);
    for (uint32_t i = 0; array && i < size && meso_json_good(list); i++) {
        MesoJsonField item = meso_json_item(list, i);
        read_step(parser, &item, &array[i]);
    }
    *steps = array;
    *count = array ? size : 0;
}
