/* Points at which details stand: listed, or of a file. */
#include <math.h>

#include "formats/mesh/point_file.h"
#include "formats/replicate/details_parser.h"
#include "libcore/base/index.h"

static const MesoDetailPoint nowhere = {.size = NAN, .aspect = NAN, .kind = MESO_NO_INDEX};

/* [x, y, z], or an object that says more. */
static void read_point(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailPoint *point)
{
    static const char *const keys[] = {"at", "size", "aspect", "kind", "heading", NULL};
    *point = nowhere;
    if (json_is_array(field->value)) {
        point->position = meso_details_vector(field);
        return;
    }
    if (!json_is_object(field->value)) {
        meso_json_wrong(field, "a point is needed here: [x, y, z], or {\"at\": [x, y, z], ...}");
        return;
    }
    if (!meso_json_object(field, keys))
        return;
    MesoJsonField at = meso_json_key(field, "at"), size = meso_json_key(field, "size");
    MesoJsonField aspect = meso_json_key(field, "aspect"), kind = meso_json_key(field, "kind");
    MesoJsonField heading = meso_json_key(field, "heading");
    meso_json_require(&at);
    point->position = meso_details_vector(&at);
    point->size = meso_json_float_in(&size, 0, 1e18f, true, NAN);
    point->aspect = meso_json_float_in(&aspect, 0.01f, 100, false, NAN);
    point->kind = meso_json_word(&kind, "kind", parser->kind_names, MESO_NO_INDEX);
    point->headed = heading.value != NULL;
    if (point->headed)
        point->direction = meso_details_direction(&heading);
}

static bool claim(MesoDetailsParser *parser, const MesoJsonField *field, uint32_t count)
{
    if (count > MESO_DETAILS_POINTS - parser->point_count)
        meso_json_wrong(field, "over %d points", MESO_DETAILS_POINTS);
    else
        parser->point_count += count;
    return meso_json_good(field);
}

static void read_list(MesoDetailsParser *parser, const MesoJsonField *list, MesoDetailDistribution *out)
{
    uint32_t count = meso_json_count(list, 1, MESO_DETAILS_POINTS);
    if (!meso_json_good(list) || !claim(parser, list, count))
        return;
    MesoDetailPoint *points = MESO_DETAILS_NEW(parser, MesoDetailPoint, count);
    for (uint32_t i = 0; points && i < count && meso_json_good(list); i++) {
        MesoJsonField item = meso_json_item(list, i);
        read_point(parser, &item, &points[i]);
    }
    out->points = points;
    out->point_count = count;
}

static void read_file(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailDistribution *out)
{
    static const char *const keys[] = {"file", NULL};
    MesoJsonField file = meso_json_key(field, "file");
    MesoJsonReader *reader = parser->reader;
    const MesoVec3 *positions;
    uint32_t count;
    const MesoInput *input = meso_json_object(field, keys)
                                 ? meso_json_open(parser->files, &file, meso_details_name(&file)) : NULL;
    if (!input)
        return;
    reader->status = meso_points_read(&positions, &count, reader->arena, input, reader->error);
    if (!meso_json_good(field) || !claim(parser, &file, count))
        return;
    MesoDetailPoint *points = MESO_DETAILS_NEW(parser, MesoDetailPoint, count);
    for (uint32_t i = 0; points && i < count; i++) {
        points[i] = nowhere;
        points[i].position = positions[i];
    }
    out->points = points;
    out->point_count = count;
}

void meso_details_points(MesoDetailsParser *parser, const MesoJsonField *field, MesoDetailDistribution *out)
{
    out->source = MESO_DETAILS_AT_POINTS;
    if (json_is_object(field->value))
        read_file(parser, field, out);
    else
        read_list(parser, field, out);
}
