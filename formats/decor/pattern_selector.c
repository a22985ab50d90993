#include "formats/decor/pattern_selector.h"

#include <string.h>

enum { MOST_TAGS = 64, MOST_COLORS = 16, PATH_LENGTH = 1000 };

const char *const meso_pattern_tags[] = {"surface", "band", "inside", "dot", "background", "stripe", "cell", NULL};

static const MesoRange any = {-INFINITY, INFINITY};

static const char *const selector_keys[] = {"path", "tag", "level", "borders", "corners", "aspect", "area",
                                            "area_share", "point", "checkered", "colors", "color", "share", "every",
                                            "from", "largest", NULL};
static const char *const rule_keys[] = {"path", "tag", "borders", "corners", "aspect", "area", "area_share", NULL};

/* Names and numbers with '/' between, "*" and "**"; or "." alone. */
static void check_path(const MesoJsonField *field, const char *path)
{
    if (strcmp(path, ".") == 0)
        return;
    for (const char *name = path;; name++) {
        size_t length = strcspn(name, "/");
        size_t stars = strspn(name, "*");
        if (length == 0)
            meso_json_wrong(field, "'%.80s' has an empty name; names have one '/' between them", path);
        else if (memchr(name, '*', length) && (stars != length || stars > 2))
            meso_json_wrong(field, "'%.*s' is no name; '*' is any region, '**' any number of them",
                            (int)(length < 80 ? length : 80), name);
        name += length;
        if (!*name)
            return;
    }
}

static const char *read_path(const MesoJsonField *field)
{
    if (!field->value)
        return NULL;
    const char *path = meso_json_short_text(field, PATH_LENGTH);
    if (meso_json_good(field))
        check_path(field, path);
    return path;
}

static const char *read_tag(const MesoJsonField *field)
{
    return meso_pattern_tags[meso_json_word(field, "tag", meso_pattern_tags, 0)];
}

static void read_tags(MesoPatternParser *parser, const MesoJsonField *field, MesoSelector *selector)
{
    if (!field->value)
        return;
    bool one = !json_is_array(field->value);
    uint32_t count = one ? 1 : meso_json_count(field, 1, MOST_TAGS);
    const char **tags = MESO_PATTERN_NEW(parser, const char *, count);
    for (uint32_t i = 0; tags && i < count; i++) {
        MesoJsonField item = meso_json_item(field, i);
        tags[i] = read_tag(one ? field : &item);
    }
    selector->tags = tags;
    selector->tag_count = tags ? count : 0;
}

/* null: no end on this side. */
static float read_end(const MesoJsonField *field, float open)
{
    return json_is_null(field->value) ? open : meso_json_float(field, open);
}

static MesoRange read_range(const MesoJsonField *object, const char *key)
{
    MesoJsonField field = meso_json_key(object, key);
    if (!field.value)
        return any;
    if (json_is_number(field.value)) {
        float number = meso_json_float(&field, 0);
        return (MesoRange){number, number};
    }
    if (!json_is_array(field.value)) {
        meso_json_wrong(&field, "a number or a range, [lowest, highest], is needed here");
        return any;
    }
    if (meso_json_count(&field, 2, 2) != 2)
        return any;
    MesoJsonField low = meso_json_item(&field, 0), high = meso_json_item(&field, 1);
    MesoRange range = {read_end(&low, any.low), read_end(&high, any.high)};
    if (range.low > range.high) {
        meso_json_wrong(&field, "the lower end is above the upper one");
        return any;
    }
    return range;
}

static void read_shape(MesoPatternParser *parser, const MesoJsonField *object, MesoSelector *selector)
{
    MesoJsonField tag = meso_json_key(object, "tag");
    read_tags(parser, &tag, selector);
    selector->borders = read_range(object, "borders");
    selector->corners = read_range(object, "corners");
    selector->aspect = read_range(object, "aspect");
    selector->area = read_range(object, "area");
    selector->area_share = read_range(object, "area_share");
}

/* "checkered": K is short for "colors": 2, "color": K. */
static void read_colors(const MesoJsonField *object, MesoSelector *selector)
{
    MesoJsonField colors = meso_json_key(object, "colors"), color = meso_json_key(object, "color");
    MesoJsonField checkered = meso_json_key(object, "checkered");
    if (checkered.value) {
        if (colors.value || color.value)
            meso_json_wrong(object, "either \"checkered\" or \"colors\" and \"color\" is possible");
        selector->colors = 2;
        selector->color = (uint32_t)meso_json_whole(&checkered, 0, 1, 0);
        return;
    }
    if (color.value && !colors.value)
        meso_json_wrong(object, "\"color\" goes with \"colors\", how many there are");
    if (!colors.value)
        return;
    selector->colors = (uint32_t)meso_json_whole(&colors, 2, MOST_COLORS, 2);
    selector->color = (uint32_t)meso_json_whole(&color, 0, selector->colors - 1, 0);
}

static void read_numbers(const MesoJsonField *object, MesoSelector *selector)
{
    MesoJsonField share = meso_json_key(object, "share"), largest = meso_json_key(object, "largest");
    MesoJsonField every = meso_json_key(object, "every"), from = meso_json_key(object, "from");
    read_colors(object, selector);
    selector->share = meso_json_float_in(&share, 0, 1, false, 1);
    selector->every = (uint32_t)meso_json_whole(&every, 1, UINT32_MAX, 1);
    selector->from = (uint32_t)meso_json_whole(&from, 0, UINT32_MAX - 1, 0);
    selector->largest = (uint32_t)meso_json_whole(&largest, 1, UINT32_MAX, 0);
}

static void read_object(MesoPatternParser *parser, const MesoJsonField *object, MesoSelector *selector)
{
    static const char *const levels[] = {"default", "leaves", "nodes", NULL};
    MesoJsonField path = meso_json_key(object, "path"), level = meso_json_key(object, "level");
    MesoJsonField point = meso_json_key(object, "point");
    selector->path = read_path(&path);
    selector->level = (MesoSelectLevel)meso_json_word(&level, "level", levels, MESO_SELECT_DEFAULT);
    read_shape(parser, object, selector);
    selector->has_point = point.value != NULL;
    selector->point = meso_pattern_point(&point);
    read_numbers(object, selector);
}

static void read_selector(MesoPatternParser *parser, const MesoJsonField *field, const char *const *keys,
                          MesoSelector *selector)
{
    *selector = (MesoSelector){.borders = any, .corners = any, .aspect = any, .area = any, .area_share = any,
                               .share = 1, .every = 1};
    if (!field->value)
        return;
    if (json_is_string(field->value))
        selector->path = read_path(field);
    else if (!json_is_object(field->value))
        meso_json_wrong(field, "a path or an object is needed here");
    else if (meso_json_object(field, keys))
        read_object(parser, field, selector);
}

void meso_pattern_selector(MesoPatternParser *parser, const MesoJsonField *field, MesoSelector *selector)
{
    read_selector(parser, field, selector_keys, selector);
}

void meso_pattern_rule_selector(MesoPatternParser *parser, const MesoJsonField *field, MesoSelector *selector)
{
    read_selector(parser, field, rule_keys, selector);
}
