/* What has grown, as a scene: bent shapes, with channels of ids and materials. */
#ifndef MESO_GROWTH_SCENE_H
#define MESO_GROWTH_SCENE_H

#include "libcore/growth/engine/growth.h"

typedef struct MesoGrowthShapes {
    uint32_t count;                     /* as many as the grammar has */
    const MesoTerminalShape *shapes;    /* [count] */
    const char *const *names;           /* [count] */
    uint32_t material_count;
    const MesoMaterial *materials;      /* [material_count] */
    const char *const *material_names;
    const uint32_t *material_of;        /* [count] */
} MesoGrowthShapes;

/*
 * A body for each branch and shape, with ids "branch", "rule", "shape" and "generation"; tints become colours of
 * vertices where any is given. Elements that fold are counted in `folds`, which may be NULL. Everything lies in the
 * arena. O(vertices), on `thread_count` threads, the same for any number. MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_growth_show(MesoScene *scene, MesoArena *arena, const MesoGrown *grown, const MesoGrammar *grammar,
                            const MesoGrowthShapes *shapes, uint32_t thread_count, uint32_t *folds, MesoError *error);

#endif
