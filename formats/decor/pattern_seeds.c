#include "formats/decor/pattern_seeds.h"

#include <string.h>

#include "formats/mesh/point_file.h"
#include "libcore/base/grow.h"

static const char *const units[] = {"scene", "size", NULL};
static const char *const words[] = {"borders", "outer", "inner", NULL};
static const char *const kinds[] = {"side", "loop", "point", "points", "face", "along", "poisson", "file", NULL};

typedef enum Kind { SIDE, LOOP, POINT, POINTS, FACE, ALONG, POISSON, FILE_OF_POINTS, NO_KIND } Kind;

/* A side may name its loop as well, which is why it comes first. */
static Kind kind_of(const json_t *value)
{
    uint32_t kind = 0;
    while (kind < NO_KIND && !json_object_get(value, kinds[kind]))
        kind++;
    return (Kind)kind;
}

bool meso_pattern_is_seed(const json_t *value)
{
    return kind_of(value) != NO_KIND;
}

/* ---- borders ---- */

static void read_word(const MesoJsonField *field, MesoSeedSpec *spec)
{
    spec->kind = (MesoSeedKind)meso_json_word(field, "seed", words, 0);
}

static void read_loop(const MesoJsonField *field, MesoSeedSpec *spec)
{
    MesoJsonField loop = meso_json_key(field, "loop");
    spec->loop = (uint32_t)meso_json_whole(&loop, 0, UINT32_MAX - 1, 0);
}

static void read_side(const MesoJsonField *field, MesoSeedSpec *spec)
{
    static const char *const keys[] = {"side", "loop", NULL};
    MesoJsonField side = meso_json_key(field, "side");
    spec->kind = MESO_SEED_SIDE;
    if (!meso_json_object(field, keys) || meso_json_count(&side, 2, 2) != 2)
        return;
    for (uint32_t i = 0; i < 2; i++) {
        MesoJsonField corner = meso_json_item(&side, i);
        spec->corners[i] = (uint32_t)meso_json_whole(&corner, 0, UINT32_MAX - 1, 0);
    }
    read_loop(field, spec);
}

static void read_border(const MesoJsonField *field, MesoSeedSpec *spec)
{
    static const char *const keys[] = {"loop", NULL};
    Kind kind = kind_of(field->value);
    if (json_is_string(field->value)) {
        read_word(field, spec);
    } else if (kind == SIDE) {
        read_side(field, spec);
    } else if (kind == LOOP) {
        spec->kind = MESO_SEED_LOOP;
        if (meso_json_object(field, keys))
            read_loop(field, spec);
    } else {
        meso_json_wrong(field, "a border is needed here: \"borders\", \"outer\", \"inner\", {\"loop\": N} or "
                        "{\"side\": [A, B]}");
    }
}

/* ---- points ---- */

/* Weights are made to sum up to 1. */
static void read_face(const MesoJsonField *field, MesoSeedSpec *spec)
{
    static const char *const keys[] = {"face", "weights", NULL};
    MesoJsonField face = meso_json_key(field, "face"), weights = meso_json_key(field, "weights");
    spec->kind = MESO_SEED_FACE;
    if (!meso_json_object(field, keys))
        return;
    float w[3] = {1, 1, 1};
    spec->face = (uint32_t)meso_json_whole(&face, 0, UINT32_MAX - 1, 0);
    meso_json_floats(&weights, 3, w);
    double sum = (double)w[0] + (double)w[1] + (double)w[2];
    if (!(w[0] >= 0 && w[1] >= 0 && w[2] >= 0 && sum > 0)) {
        meso_json_wrong(&weights, "weights must not be negative, nor all 0");
        sum = 1;
    }
    for (uint32_t i = 0; i < 3; i++)
        spec->weight[i] = (float)((double)w[i] / sum);
}

static void read_point(const MesoJsonField *field, MesoSeedSpec *spec)
{
    static const char *const keys[] = {"point", NULL};
    MesoJsonField point = meso_json_key(field, "point");
    spec->kind = MESO_SEED_POINT;
    if (meso_json_object(field, keys))
        spec->point = meso_pattern_point(&point);
}

/* ---- samples ---- */

static void read_spacing(const MesoJsonField *object, const char *key, MesoSeedSpec *spec)
{
    MesoJsonField spacing = meso_json_key(object, key), unit = meso_json_key(object, "unit");
    spec->spacing = meso_json_float_in(&spacing, 0, INFINITY, true, 0);
    spec->relative = spacing.value && meso_json_word(&unit, "unit", units, 1) == 1;
    if (unit.value && !spacing.value)
        meso_json_wrong(object, "\"unit\" goes with \"%s\"", key);
}

static void read_count(const MesoJsonField *field, MesoSeedSpec *spec)
{
    spec->count = (uint32_t)meso_json_whole(field, 1, MESO_PATTERN_SEEDS, 0);
}

static void read_along(const MesoJsonField *field, MesoSeedSpec *spec)
{
    static const char *const keys[] = {"along", "count", "spacing", "unit", NULL};
    MesoJsonField along = meso_json_key(field, "along"), count = meso_json_key(field, "count");
    MesoJsonField spacing = meso_json_key(field, "spacing");
    if (!meso_json_object(field, keys))
        return;
    read_border(&along, spec);
    spec->of = spec->kind;
    spec->kind = MESO_SEED_ALONG;
    if (!count.value == !spacing.value)
        meso_json_wrong(field, "either \"count\" or \"spacing\" is needed");
    read_count(&count, spec);
    read_spacing(field, "spacing", spec);
}

/* A number is the count. */
static void read_poisson(const MesoJsonField *field, MesoSeedSpec *spec)
{
    static const char *const own[] = {"poisson", NULL};
    static const char *const keys[] = {"count", "radius", "unit", "on", "start", "border", NULL};
    static const char *const places[] = {"region", "border", NULL}, *const starts[] = {"border", "any", NULL};
    MesoJsonField object = meso_json_key(field, "poisson");
    spec->kind = MESO_SEED_POISSON;
    spec->from_border = true;
    if (!meso_json_object(field, own))
        return;
    if (json_is_number(object.value)) {
        read_count(&object, spec);
        return;
    }
    if (!meso_json_object(&object, keys))
        return;
    MesoJsonField count = meso_json_key(&object, "count"), radius = meso_json_key(&object, "radius");
    MesoJsonField on = meso_json_key(&object, "on"), start = meso_json_key(&object, "start");
    MesoJsonField border = meso_json_key(&object, "border");
    read_count(&count, spec);
    read_spacing(&object, "radius", spec);
    if (!count.value && !radius.value)
        meso_json_wrong(&object, "\"count\" or \"radius\" is needed");
    spec->on_border = meso_json_word(&on, "place", places, 0) == 1;
    spec->from_border = meso_json_word(&start, "start", starts, spec->on_border) == 0;
    if (spec->on_border && spec->from_border)
        meso_json_wrong(&start, "samples of the border cannot start away from it; \"any\" is possible");
    spec->border_slack = 1 - meso_json_float_in(&border, 0, 1, false, 1);
    if (border.value && !spec->from_border)
        meso_json_wrong(&border, "only samples that start at the border keep away from it");
}

/* ---- files ---- */

static const MesoPatternPoints *read_file(MesoPatternParser *parser, const MesoJsonField *field)
{
    const char *name = meso_json_short_text(field, 4096);
    for (uint32_t i = 0; i < parser->point_file_count; i++)
        if (strcmp(parser->points[i].name, name) == 0)
            return &parser->points[i];
    MesoJsonReader *reader = parser->reader;
    MesoPatternPoints points = {.name = name};
    const MesoInput *input = meso_pattern_open(parser, field);
    if (!input)
        return NULL;
    MesoStatus status = meso_points_read(&points.points, &points.count, reader->arena, input, reader->error);
    MesoPatternPoints *grown = MESO_GROW(reader->arena, parser->points, parser->point_file_count,
                                         parser->point_file_room, 4, reader->error);
    if (status || !grown) {
        reader->status = status ? status : MESO_ERR_MEMORY;
        return NULL;
    }
    parser->points = grown;
    grown[parser->point_file_count] = points;
    return &grown[parser->point_file_count++];
}

static const MesoPatternPoints *file_of_seed(MesoPatternParser *parser, const MesoJsonField *field)
{
    static const char *const keys[] = {"file", NULL};
    MesoJsonField file = meso_json_key(field, "file");
    return meso_json_object(field, keys) ? read_file(parser, &file) : NULL;
}

/* ---- sets ---- */

/* How many seeds stand at `field`. */
static uint32_t count_seeds(MesoPatternParser *parser, const MesoJsonField *field)
{
    static const char *const keys[] = {"points", NULL};
    Kind kind = kind_of(field->value);
    if (kind == POINTS) {
        MesoJsonField points = meso_json_key(field, "points");
        return meso_json_object(field, keys) ? meso_json_count(&points, 1, MESO_PATTERN_SEEDS) : 0;
    }
    if (kind == FILE_OF_POINTS) {
        const MesoPatternPoints *file = file_of_seed(parser, field);
        return file ? file->count : 0;
    }
    return 1;
}

static void read_list_of_points(const MesoJsonField *field, MesoSeedSpec *specs, uint32_t count)
{
    MesoJsonField list = meso_json_key(field, "points");
    for (uint32_t i = 0; i < count; i++) {
        MesoJsonField item = meso_json_item(&list, i);
        specs[i].kind = MESO_SEED_POINT;
        specs[i].point = meso_pattern_point(&item);
    }
}

static void read_file_of_points(MesoPatternParser *parser, const MesoJsonField *field, MesoSeedSpec *specs,
                                uint32_t count)
{
    const MesoPatternPoints *file = file_of_seed(parser, field);
    for (uint32_t i = 0; file && i < count; i++) {
        specs[i].kind = MESO_SEED_POINT;
        specs[i].point = file->points[i];
    }
}

static void refuse_object(const MesoJsonField *field)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)field->value, key, value)
        if (!meso_json_is_note(key))
            meso_json_refuse(field, "seed", key, kinds);
    meso_json_wrong(field, "a seed is needed here: \"borders\", \"outer\", \"inner\" or an object with one of "
                    "\"side\", \"loop\", \"point\", \"points\", \"face\", \"along\", \"poisson\", \"file\"");
}

/* `count` seeds of an object. */
static void read_object(MesoPatternParser *parser, const MesoJsonField *field, MesoSeedSpec *specs, uint32_t count)
{
    switch (kind_of(field->value)) {
    case SIDE:
    case LOOP:
        read_border(field, specs);
        return;
    case POINT:
        read_point(field, specs);
        return;
    case POINTS:
        read_list_of_points(field, specs, count);
        return;
    case FACE:
        read_face(field, specs);
        return;
    case ALONG:
        read_along(field, specs);
        return;
    case POISSON:
        read_poisson(field, specs);
        return;
    case FILE_OF_POINTS:
        read_file_of_points(parser, field, specs, count);
        return;
    case NO_KIND:
        refuse_object(field);
    }
}

static void read_entry(MesoPatternParser *parser, const MesoJsonField *field, MesoSeedSpec *specs, uint32_t count)
{
    if (json_is_string(field->value))
        read_word(field, specs);
    else if (json_is_object(field->value))
        read_object(parser, field, specs, count);
    else
        meso_json_wrong(field, "a seed is needed here: \"borders\", \"outer\", \"inner\" or an object");
}

static uint32_t count_list(MesoPatternParser *parser, const MesoJsonField *list)
{
    uint64_t total = 0;
    uint32_t count = meso_json_count(list, 1, MESO_PATTERN_SEEDS);
    for (uint32_t i = 0; i < count && meso_json_good(list); i++) {
        MesoJsonField item = meso_json_item(list, i);
        total += count_seeds(parser, &item);
    }
    return total > MESO_PATTERN_SEEDS ? MESO_PATTERN_SEEDS + 1 : (uint32_t)total;
}

static MesoSeedSpec *new_seeds(MesoPatternParser *parser, const MesoJsonField *field, uint32_t count)
{
    if (!meso_json_good(field))
        return NULL;
    if (count > MESO_PATTERN_SEEDS - parser->seed_count) {
        meso_json_wrong(field, "too many seeds: over %d in the whole pattern", MESO_PATTERN_SEEDS);
        return NULL;
    }
    parser->seed_count += count;
    return MESO_PATTERN_NEW(parser, MesoSeedSpec, count);
}

void meso_pattern_seeds(MesoPatternParser *parser, const MesoJsonField *field, MesoSeedSet *seeds)
{
    static const MesoSeedSpec borders = {.kind = MESO_SEED_BORDERS};
    if (!field->value) {
        *seeds = (MesoSeedSet){&borders, 1};
        return;
    }
    bool list = json_is_array(field->value);
    uint32_t count = list ? count_list(parser, field) : count_seeds(parser, field), done = 0;
    MesoSeedSpec *specs = new_seeds(parser, field, count);
    if (!specs)
        return;
    for (size_t i = 0; done < count && meso_json_good(field); i++) {
        MesoJsonField item = meso_json_item(field, i);
        const MesoJsonField *entry = list ? &item : field;
        uint32_t own = count_seeds(parser, entry);
        read_entry(parser, entry, specs + done, own);
        done += own;
    }
    *seeds = (MesoSeedSet){specs, done};
}

static void read_row_entry(MesoPatternParser *parser, const MesoJsonField *field, MesoSeedSpec *specs, uint32_t count)
{
    Kind kind = kind_of(field->value);
    if (json_is_array(field->value)) {
        specs->kind = MESO_SEED_POINT;
        specs->point = meso_pattern_point(field);
    } else if (kind == POINT || kind == POINTS || kind == FACE || kind == FILE_OF_POINTS) {
        read_entry(parser, field, specs, count);
    } else {
        meso_json_wrong(field, "a point is needed here: [x, y, z], {\"point\": ...}, {\"face\": ...} or "
                        "{\"file\": ...}");
    }
}

const MesoSeedSpec *meso_pattern_row(MesoPatternParser *parser, const MesoJsonField *field, uint32_t least,
                                     uint32_t *count)
{
    meso_json_require(field);
    uint32_t total = count_list(parser, field), done = 0;
    MesoSeedSpec *specs = new_seeds(parser, field, total);
    if (!specs)
        return NULL;
    for (size_t i = 0; done < total && meso_json_good(field); i++) {
        MesoJsonField item = meso_json_item(field, i);
        uint32_t own = count_seeds(parser, &item);
        read_row_entry(parser, &item, specs + done, own);
        done += own;
    }
    if (done < least)
        meso_json_wrong(field, "%u points; %u or more are needed", done, least);
    *count = done;
    return specs;
}
