#include "libcore/render/raster/shape_levels.h"

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

MesoShapeColumns *meso_shape_levels(MesoArena *arena, const MesoScene *scene, const MesoKindDetail *details,
                                    float finest, MesoError *error)
{
    size_t count = (size_t)scene->kind_count * MESO_SHAPE_LEVELS;
    MesoShapeColumns *levels = MESO_NEW(arena, MesoShapeColumns, count * MESO_SHAPE_USES, error);
    for (uint32_t k = 0; k < scene->kind_count && levels; k++) {
        const MesoSweptKind *kind = &scene->kinds[k];
        float scale = scene->section_scale * meso_scene_kind_size(scene, kind) * details[k].stretch.most;
        for (uint32_t i = 0; i < MESO_SHAPE_LEVELS * MESO_SHAPE_USES; i++) {
            uint32_t level = i / MESO_SHAPE_USES;
            float tolerance = level == 0 ? 0 : finest * exp2f(0.5f * (float)level);
            MesoShapeColumns *at = &levels[(size_t)k * MESO_SHAPE_LEVELS * MESO_SHAPE_USES + i];
            MesoArenaMark mark = meso_arena_mark(arena);
            if (meso_shape_columns(at, arena, scene, kind, scale, tolerance, i % MESO_SHAPE_USES, error) != MESO_OK)
                return NULL;
            if (level > 0)
                share_columns(at, at - MESO_SHAPE_USES, arena, mark);
        }
    }
    return levels;
}

static uint32_t level_for(float finest, float tolerance)
{
    if (!(tolerance > finest))
        return 0;
    float level = floorf(2 * log2f(tolerance / finest));
    return level < MESO_SHAPE_LEVELS - 1 ? (uint32_t)level : MESO_SHAPE_LEVELS - 1;
}

const MesoShapeColumns *meso_shape_level(const MesoShapeColumns *levels, float finest, uint32_t kind, float tolerance,
                                         MesoShapeUse use)
{
    size_t level = (size_t)kind * MESO_SHAPE_LEVELS + level_for(finest, tolerance);
    return &levels[level * MESO_SHAPE_USES + use];
}
