#include "formats/decor/pattern_parser.h"

#include <math.h>

#include "libcore/mesh/polygon_mesh.h"

void *meso_pattern_allocate(MesoPatternParser *parser, uint64_t count, size_t size)
{
    MesoJsonReader *reader = parser->reader;
    void *array = meso_arena_alloc(reader->arena, count, size, reader->error);
    if (!array && !reader->status)
        reader->status = meso_fail(reader->error, MESO_ERR_MEMORY, "%s: out of memory", reader->path);
    return array;
}

const MesoInput *meso_pattern_open(MesoPatternParser *parser, const MesoJsonField *field)
{
    return meso_json_open(parser->files, field, meso_json_short_text(field, 4096));
}

MesoVec3 meso_pattern_point(const MesoJsonField *field)
{
    float x[3] = {0};
    meso_json_floats(field, 3, x);
    for (int k = 0; k < 3; k++)
        if (!(fabsf(x[k]) <= MESO_COORDINATE_LIMIT) && meso_json_good(field))
            meso_json_wrong(field, "%g lies beyond the largest coordinate, %g", (double)x[k], (double)MESO_COORDINATE_LIMIT);
    return (MesoVec3){x[0], x[1], x[2]};
}
