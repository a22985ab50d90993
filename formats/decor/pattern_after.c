#include "formats/decor/pattern_after.h"

#include <string.h>

enum { MOST_MATERIALS = 1 << 16, NAME_LENGTH = 200 };

/* ---- painting ---- */

static uint32_t read_material(MesoPatternParser *parser, const MesoJsonField *field)
{
    const char *name = json_string_value(field->value);
    if (!meso_json_good(field))
        return 0;
    if (!name) {
        meso_json_wrong(field, "the name of a material is needed here");
        return 0;
    }
    uint32_t number = meso_names_find(&parser->material_numbers, name, strlen(name));
    if (number != MESO_NO_INDEX)
        return number;
    meso_json_refuse(field, "material", name, parser->material_names);
    return 0;
}

/* A name, or a list of them. */
static void read_materials(MesoPatternParser *parser, const MesoJsonField *field, MesoAfterSplit *after)
{
    bool one = !json_is_array(field->value);
    uint32_t count = one ? 1 : meso_json_count(field, 1, MOST_MATERIALS);
    uint32_t *materials = MESO_PATTERN_NEW(parser, uint32_t, count);
    for (uint32_t i = 0; materials && i < count; i++) {
        MesoJsonField item = meso_json_item(field, i);
        materials[i] = read_material(parser, one ? field : &item);
    }
    after->materials = materials;
    after->material_count = materials ? count : 0;
    after->by = count > 1 ? MESO_PAINT_CYCLE : MESO_PAINT_ALL;
}

static void read_paint(MesoPatternParser *parser, const MesoJsonField *field, MesoAfterSplit *after)
{
    static const char *const keys[] = {"by", "materials", NULL};
    static const char *const ways[] = {"all", "cycle", "random", "ramp", NULL};
    after->painted = true;
    if (!json_is_object(field->value)) {
        read_materials(parser, field, after);
        return;
    }
    MesoJsonField by = meso_json_key(field, "by"), materials = meso_json_key(field, "materials");
    if (!meso_json_object(field, keys))
        return;
    meso_json_require(&materials);
    read_materials(parser, &materials, after);
    after->by = (MesoPaintBy)meso_json_word(&by, "way to paint", ways, after->by);
    if (after->by == MESO_PAINT_RAMP && after->material_count < 2)
        meso_json_wrong(&materials, "a ramp is between two materials or more");
}

/* ---- displacement ---- */

/* A number is the height. */
static void read_displacement(MesoPatternParser *parser, const MesoJsonField *field, MesoAfterSplit *after)
{
    static const char *const keys[] = {"height", "unit", "bias", "gain", "jitter", NULL};
    static const char *const units[] = {"scene", "share", NULL};
    MesoDisplacement *d = &after->displacement;
    (void)parser;
    after->displaced = true;
    *d = (MesoDisplacement){.relative = true, .bias = 0.5f, .gain = 0.5f};
    if (json_is_number(field->value)) {
        d->height = meso_json_float(field, 0);
        return;
    }
    MesoJsonField height = meso_json_key(field, "height"), unit = meso_json_key(field, "unit");
    MesoJsonField bias = meso_json_key(field, "bias"), gain = meso_json_key(field, "gain");
    MesoJsonField jitter = meso_json_key(field, "jitter");
    if (!meso_json_object(field, keys))
        return;
    meso_json_require(&height);
    d->height = meso_json_float(&height, 0);
    d->relative = meso_json_word(&unit, "unit", units, 1) == 1;
    d->bias = meso_json_float_in(&bias, 0, 1, true, 0.5f);
    d->gain = meso_json_float_in(&gain, 0, 1, true, 0.5f);
    d->jitter = meso_json_float_in(&jitter, 0, 1, false, 0);
}

/* ---- names ---- */

/* What paths could not say is no name. */
static void read_name(MesoPatternParser *parser, const MesoJsonField *field, MesoAfterSplit *after)
{
    (void)parser;
    after->name = meso_json_short_text(field, NAME_LENGTH);
    if (meso_json_good(field) && after->name[strcspn(after->name, "/*.")])
        meso_json_wrong(field, "'%.80s' is no name: '/', '*' and '.' are for paths", after->name);
}

/* ---- by tag ---- */

typedef struct Part {
    const char *key;
    const char *const *own_keys;    /* an object with one of these is no table of tags; NULL: objects are tables */
    void (*read)(MesoPatternParser *parser, const MesoJsonField *field, MesoAfterSplit *after);
} Part;

enum { PART_COUNT = 3 };

static const char *const paint_keys[] = {"by", "materials", NULL};
static const char *const displacement_keys[] = {"height", "unit", "bias", "gain", "jitter", NULL};
static const Part parts[PART_COUNT] = {
    {"paint", paint_keys, read_paint}, {"displace", displacement_keys, read_displacement}, {"names", NULL, read_name}};

static bool is_table(const Part *part, const json_t *value)
{
    const char *const *key = part->own_keys;
    while (key && *key && !json_object_get(value, *key))
        key++;
    return json_is_object(value) && !(key && *key);
}

/* "*" in a table is for the tags that it does not name. */
static void check_tags(const MesoJsonField *table, const char *const *tags)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)table->value, key, value) {
        const char *const *tag = tags;
        while (*tag && strcmp(*tag, key) != 0)
            tag++;
        if (!*tag && strcmp(key, "*") != 0 && !meso_json_is_note(key))
            meso_json_refuse(table, "tag", key, tags);
    }
}

static bool has_table(const MesoJsonField *step)
{
    bool any = false;
    for (uint32_t p = 0; p < PART_COUNT; p++)
        any |= is_table(&parts[p], json_object_get(step->value, parts[p].key));
    return any;
}

/* What the step says of `tag`, or of all where that is NULL; false if that is nothing. */
static bool read_for_tag(MesoPatternParser *parser, const MesoJsonField *step, const char *tag, MesoAfterSplit *after)
{
    bool any = false;
    *after = (MesoAfterSplit){.tag = tag};
    for (uint32_t p = 0; p < PART_COUNT; p++) {
        MesoJsonField part = meso_json_key(step, parts[p].key);
        bool table = is_table(&parts[p], part.value);
        MesoJsonField named = meso_json_key(&part, tag ? tag : "*"), others = meso_json_key(&part, "*");
        const MesoJsonField *field = !table ? &part : named.value ? &named : &others;
        if (field->value)
            parts[p].read(parser, field, after);
        any |= field->value != NULL;
    }
    return any;
}

/* One entry for all, or where tags differ one for each tag: no child is told of twice. */
void meso_pattern_after_split(MesoPatternParser *parser, const MesoJsonField *step, const char *const *tags,
                              const MesoAfterSplit **after, uint32_t *count)
{
    uint32_t tag_count = 0, done = 0;
    while (tags[tag_count])
        tag_count++;
    MesoAfterSplit *entries = MESO_PATTERN_NEW(parser, MesoAfterSplit, tag_count);
    for (uint32_t p = 0; p < PART_COUNT; p++) {
        MesoJsonField part = meso_json_key(step, parts[p].key);
        if (is_table(&parts[p], part.value))
            check_tags(&part, tags);
    }
    if (entries && !has_table(step))
        done = read_for_tag(parser, step, NULL, entries);
    else
        for (uint32_t i = 0; entries && i < tag_count; i++)
            done += read_for_tag(parser, step, tags[i], &entries[done]);
    *after = entries;
    *count = done;
}

void meso_pattern_after_alone(MesoPatternParser *parser, const MesoJsonField *step, const MesoAfterSplit **after,
                              uint32_t *count)
{
    MesoAfterSplit *entry = MESO_PATTERN_NEW(parser, MesoAfterSplit, 1);
    for (uint32_t p = 0; entry && p < PART_COUNT; p++) {
        MesoJsonField part = meso_json_key(step, parts[p].key);
        if (part.value)
            parts[p].read(parser, &part, entry);
    }
    *after = entry;
    *count = entry ? 1 : 0;
}
