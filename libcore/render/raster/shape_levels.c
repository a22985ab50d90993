#include "libcore/render/raster/shape_levels.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static bool same_columns(const MesoShapeColumns *a, const MesoShapeColumns *b)
{
    return a->count == b->count && a->side_count == b->side_count && a->closed == b->closed &&
           !a->stand_ins == !b->stand_ins && memcmp(a->kept, b->kept, a->count * sizeof *a->kept) == 0 &&
           memcmp(a->sides, b->sides, a->side_count * sizeof *a->sides) == 0 &&
           (!a->stand_ins || memcmp(a->stand_ins, b->stand_ins, a->count * sizeof *a->stand_ins) == 0);
}

/* Takes a finer level's arrays where they are the same. */
static void share_columns(MesoShapeColumns *columns, const MesoShapeColumns *finer, MesoArena *arena,
                          MesoArenaMark mark)
{
    float reach = columns->reach;
    if (!same_columns(columns, finer))
        return;
    *columns = *finer;
    columns->reach = reach;
    meso_arena_rewind(arena, mark);
}

static uint32_t level_for(float finest, float tolerance)
{
    if (!(tolerance > finest))
        return 0;
    float level = floorf(2 * log2f(tolerance / finest));
    return level < MESO_SHAPE_LEVELS - 1 ? (uint32_t)level : MESO_SHAPE_LEVELS - 1;
}

MesoStatus meso_shape_levels(MesoShapeColumns *levels, MesoArena *arena, const MesoScene *scene, const float *scales,
                             const MesoLevelRange *range, MesoError *error)
{
    uint32_t begin = level_for(range->finest, range->low), end = level_for(range->finest, range->high) + 1;
    for (uint32_t k = 0; k < scene->kind_count; k++)
        for (uint32_t level = begin; level < end; level++) {
            MesoShapeColumns *at = &levels[((size_t)k * MESO_SHAPE_LEVELS + level) * MESO_SHAPE_USES + range->use];
            float tolerance = level == 0 ? 0 : range->finest * exp2f(0.5f * (float)level);
            if (at->kept)
                continue;
            MesoArenaMark mark = meso_arena_mark(arena);
            if (meso_shape_columns(at, arena, scene, &scene->kinds[k], scales[k], tolerance, range->use, error))
                return MESO_ERR_MEMORY;
            if (level > 0 && at[-MESO_SHAPE_USES].kept)
                share_columns(at, at - MESO_SHAPE_USES, arena, mark);
        }
    return MESO_OK;
}

const MesoShapeColumns *meso_shape_level(const MesoShapeColumns *levels, float finest, uint32_t kind, float tolerance,
                                         MesoShapeUse use)
{
    size_t level = (size_t)kind * MESO_SHAPE_LEVELS + level_for(finest, tolerance);
    const MesoShapeColumns *columns = &levels[level * MESO_SHAPE_USES + use];
    assert(columns->kept);
    return columns;
}
