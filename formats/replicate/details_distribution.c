/* Distributions: where details stand, how large they are, where they head, and of which kind they are. */
#include <string.h>

#include "formats/replicate/details_parser.h"

static const float degree = 0.017453292519943295f;

/* ---- where ---- */

/* A number is the radius. */
static void read_poisson(const MesoJsonField *field, MesoDetailDistribution *out)
{
    static const char *const keys[] = {"radius", "count", NULL};
    out->source = MESO_DETAILS_POISSON;
    if (json_is_number(field->value)) {
        out->radius = meso_json_float_in(field, 0, 1e18f, true, 1);
        return;
    }
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField radius = meso_json_key(field, "radius"), count = meso_json_key(field, "count");
    if (!radius.value == !count.value)
        meso_json_wrong(field, "either \"radius\" or \"count\" is needed");
    out->radius = meso_json_float_in(&radius, 0, 1e18f, true, 0);
    out->count = (uint32_t)meso_json_whole(&count, 1, MESO_DETAILS_POINTS, 0);
}

/* A number is how many. */
static void read_scatter(const MesoJsonField *field, MesoDetailDistribution *out)
{
    static const char *const keys[] = {"count", NULL};
    MesoJsonField count = *field;
    out->source = MESO_DETAILS_SCATTERED;
    if (json_is_object(field->value)) {
        if (!meso_json_object(field, keys))
            return;
        count = meso_json_key(field, "count");
        if (!count.value)
            meso_json_wrong(field, "\"count\" is needed");
    }
    out->count = (uint32_t)meso_json_whole(&count, 1, MESO_DETAILS_POINTS, 1);
}

/* A text is the file. */
static void read_scene(const MesoJsonField *field, MesoDetailDistribution *out)
{
    static const char *const keys[] = {"file", "channel", NULL};
    out->source = MESO_DETAILS_OF_SCENE;
    if (json_is_string(field->value)) {
        out->scene = meso_details_name(field);
        return;
    }
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField file = meso_json_key(field, "file"), channel = meso_json_key(field, "channel");
    out->scene = meso_details_name(&file);
    out->channel = channel.value ? meso_details_name(&channel) : NULL;
}

static void read_source(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailDistribution *out)
{
    MesoJsonField points = meso_json_key(field, "points"), poisson = meso_json_key(field, "poisson");
    MesoJsonField scene = meso_json_key(field, "scene"), scatter = meso_json_key(field, "scatter");
    if (!!points.value + !!poisson.value + !!scene.value + !!scatter.value != 1)
        meso_json_wrong(field, "one of \"points\", \"poisson\", \"scatter\" and \"scene\" is needed");
    else if (points.value)
        meso_details_points(parser, &points, out);
    else if (poisson.value)
        read_poisson(&poisson, out);
    else if (scatter.value)
        read_scatter(&scatter, out);
    else
        read_scene(&scene, out);
}

/* ---- maps ---- */

static void read_map(const MesoJsonField *field, MesoDetailMap *map)
{
    static const char *const keys[] = {"attribute", "image", "channel", "low", "high", NULL};
    *map = (MesoDetailMap){.given = field->value != NULL, .high = 1};
    if (!map->given || !meso_json_object(field, keys))
        return;
    MesoJsonField attribute = meso_json_key(field, "attribute"), image = meso_json_key(field, "image");
    MesoJsonField channel = meso_json_key(field, "channel"), low = meso_json_key(field, "low");
    MesoJsonField high = meso_json_key(field, "high");
    if (!attribute.value == !image.value)
        meso_json_wrong(field, "either \"attribute\" or \"image\" is needed");
    map->attribute = attribute.value ? meso_details_name(&attribute) : NULL;
    map->image = image.value ? meso_details_name(&image) : NULL;
    map->channel = (uint32_t)meso_json_whole(&channel, 0, 15, 0);
    map->low = meso_json_float(&low, 0);
    map->high = meso_json_float(&high, 1);
    if (map->low == map->high)
        meso_json_wrong(field, "\"low\" and \"high\" are the same, %g", (double)map->low);
}

/* ---- how large ---- */

/* A number, or [low, high]. */
static void read_range(const MesoJsonField *field, float low, float high, bool open, float range[2])
{
    if (!json_is_array(field->value)) {
        range[0] = range[1] = meso_json_float_in(field, low, high, open, range[0]);
        return;
    }
    uint32_t count = meso_json_count(field, 2, 2);
    for (uint32_t i = 0; i < count; i++) {
        MesoJsonField item = meso_json_item(field, i);
        range[i] = meso_json_float_in(&item, low, high, open, range[i]);
    }
    if (range[0] > range[1])
        meso_json_wrong(field, "from %g to %g is no range", (double)range[0], (double)range[1]);
}

static void read_sizes(const MesoJsonField *field, MesoDetailDistribution *out)
{
    MesoJsonField size = meso_json_key(field, "size"), aspect = meso_json_key(field, "aspect");
    MesoJsonField map = meso_json_key(field, "size_map");
    for (uint32_t i = 0; i < 2; i++)
        out->size[i] = out->aspect[i] = 1;
    out->sized = size.value != NULL;
    read_range(&size, 0, 1e18f, true, out->size);
    read_range(&aspect, 0.01f, 100, false, out->aspect);
    read_map(&map, &out->size_map);
    if (map.value && !json_is_array(size.value))
        meso_json_wrong(&map, "it goes from one size to another: \"size\": [low, high] is needed");
}

/* ---- where to ---- */

static void read_spread(const MesoJsonField *field, MesoDetailHeading *heading)
{
    MesoJsonField spread = meso_json_key(field, "spread");
    heading->spread = degree * meso_json_float_in(&spread, 0, 180, false, 0);
}

/* "random", "scene", [x, y, z], or an object with a direction or an attribute. */
static void read_heading(const MesoJsonField *field, MesoDetailDistribution *out)
{
    static const char *const words[] = {"random", "scene", NULL};
    static const char *const keys[] = {"direction", "attribute", "spread", NULL};
    MesoDetailHeading *heading = &out->heading;
    bool of_scene = out->source == MESO_DETAILS_OF_SCENE;
    heading->source = of_scene ? MESO_HEADING_SCENE : MESO_HEADING_RANDOM;
    if (!field->value)
        return;
    if (json_is_string(field->value)) {
        bool as_scene = meso_json_word(field, "heading", words, 0) == 1;
        heading->source = as_scene ? MESO_HEADING_SCENE : MESO_HEADING_RANDOM;
        if (as_scene && !of_scene)
            meso_json_wrong(field, "\"scene\" goes with details of a scene");
    } else if (json_is_array(field->value)) {
        heading->source = MESO_HEADING_DIRECTION;
        heading->direction = meso_details_direction(field);
    } else if (meso_json_object(field, keys)) {
        MesoJsonField direction = meso_json_key(field, "direction"), attribute = meso_json_key(field, "attribute");
        if (!direction.value == !attribute.value)
            meso_json_wrong(field, "either \"direction\" or \"attribute\" is needed");
        heading->source = direction.value ? MESO_HEADING_DIRECTION : MESO_HEADING_ATTRIBUTE;
        if (direction.value)
            heading->direction = meso_details_direction(&direction);
        else if (attribute.value)
            heading->attribute = meso_details_name(&attribute);
        read_spread(field, heading);
    }
}

/* ---- which kind ---- */

static uint32_t kind_of(MesoDetailsParser *parser, const char *name)
{
    uint32_t i = 0;
    while (parser->kind_names[i] && strcmp(parser->kind_names[i], name) != 0)
        i++;
    return i;
}

static void read_shares(MesoDetailsParser *parser, const MesoJsonField *field, float *shares)
{
    const char *key;
    json_t *value;
    double sum = 0;
    json_object_foreach((json_t *)field->value, key, value) {
        MesoJsonField item = meso_json_key(field, key);
        uint32_t kind = kind_of(parser, key);
        if (!parser->kind_names[kind]) {
            meso_json_refuse(field, "kind", key, parser->kind_names);
            return;
        }
        shares[kind] = meso_json_float_in(&item, 0, 1e6f, false, 0);
        sum += (double)shares[kind];
    }
    if (!(sum > 0))
        meso_json_wrong(field, "no kind has a share above 0");
    for (uint32_t i = 0; sum > 0 && i < parser->kind_count; i++)
        shares[i] = (float)((double)shares[i] / sum);
}

/* A name, or {name: share}; the first kind where nothing is said. */
static void read_kinds(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailDistribution *out)
{
    float *shares = MESO_DETAILS_NEW(parser, float, parser->kind_count);
    if (!shares || !meso_json_good(field))
        return;
    if (json_is_object(field->value))
        read_shares(parser, field, shares);
    else
        shares[meso_json_word(field, "kind", parser->kind_names, 0)] = 1;
    out->shares = shares;
}

void meso_details_distribution(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailDistribution *out)
{
    static const char *const keys[] = {"points", "poisson", "scatter", "scene", "density", "size", "size_map", "aspect",
                                       "heading", "kind", NULL};
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField density = meso_json_key(field, "density"), heading = meso_json_key(field, "heading");
    MesoJsonField kind = meso_json_key(field, "kind");
    read_source(parser, field, out);
    read_map(&density, &out->density);
    read_sizes(field, out);
    read_heading(&heading, out);
    read_kinds(parser, &kind, out);
}
