#include "formats/replicate/details_parser.h"

#include <math.h>
#include <string.h>

#include "libcore/mesh/polygon_mesh.h"

void *meso_details_allocate(MesoDetailsParser *parser, uint64_t count, size_t size)
{
    MesoJsonReader *reader = parser->reader;
    void *array = meso_arena_alloc(reader->arena, count, size, reader->error);
    if (!array && !reader->status)
        reader->status = meso_fail(reader->error, MESO_ERR_MEMORY, "%s: out of memory", reader->path);
    return array;
}

const char *meso_details_name(const MesoJsonField *field)
{
    meso_json_require(field);
    return meso_json_short_text(field, 4096);
}

MesoVec3 meso_details_vector(const MesoJsonField *field)
{
    float x[3] = {0};
    meso_json_floats(field, 3, x);
    for (int k = 0; k < 3; k++)
        if (!(fabsf(x[k]) <= MESO_COORDINATE_LIMIT) && meso_json_good(field))
            meso_json_wrong(field, "%g lies beyond the largest coordinate, %g", (double)x[k],
                            (double)MESO_COORDINATE_LIMIT);
    return (MesoVec3){x[0], x[1], x[2]};
}

MesoVec3 meso_details_direction(const MesoJsonField *field)
{
    MesoVec3 v = meso_details_vector(field);
    if (v.x == 0 && v.y == 0 && v.z == 0)
        meso_json_wrong(field, "[0, 0, 0] is no direction");
    return v;
}

const char **meso_details_keys(MesoDetailsParser *parser, const MesoJsonField *field, uint32_t least, uint32_t most,
                               uint32_t *count)
{
    if (!meso_json_object(field, NULL))
        return NULL;
    size_t size = json_object_size(field->value);
    if (size < least || size > most) {
        meso_json_wrong(field, "%zu of them; from %u to %u are possible", size, least, most);
        return NULL;
    }
    const char **names = MESO_DETAILS_NEW(parser, const char *, size + 1), *key;
    json_t *value;
    uint32_t i = 0;
    json_object_foreach((json_t *)field->value, key, value) {
        MesoJsonField item = meso_json_key(field, key);
        if (!names || !meso_json_good(field))
            return NULL;
        if (!*key || strlen(key) > 200)
            meso_json_wrong(&item, "a name of %zu characters; from 1 to 200 are possible", strlen(key));
        names[i] = meso_arena_copy_text(parser->reader->arena, key, parser->reader->error);
        if (!names[i++])
            parser->reader->status = MESO_ERR_MEMORY;
    }
    *count = (uint32_t)size;
    return meso_json_good(field) ? names : NULL;
}
