/* A decorated surface as a scene: one body a leaf. */
#ifndef MESO_DECOR_SCENE_H
#define MESO_DECOR_SCENE_H

#include "libcore/decor/decor.h"
#include "libcore/scene/scene.h"

/* Where a vertex's or a corner's values have what a scene shows; MESO_NO_INDEX: nowhere. */
typedef struct MesoDecorValues {
    uint32_t vertex_uv, corner_uv;      /* two numbers */
    uint32_t vertex_color;              /* three, linear */
} MesoDecorValues;

#define MESO_DECOR_NO_VALUES {MESO_NO_INDEX, MESO_NO_INDEX, MESO_NO_INDEX}

/*
 * Bodies by the tree's order of leaves, with the channels "region" (their paths) and "tag", and the pattern's
 * materials; ramps add materials of their own. Normals are smooth over all of the surface, but where regions meet at
 * more than 30 degrees, each side has its own. A vertex comes once for each region, and within one for each texture
 * coordinate that it has there; all copies have the same floats, but for those normals. Where nothing is painted, tags
 * have looks of their own. To `arena`; bodies do not point into the mesh. O(vertices +
 * triangles). MESO_ERR_LIMIT beyond 65535 leaves, MESO_ERR_MEMORY.
 */
MesoStatus meso_decor_scene(MesoScene *scene, MesoArena *arena, const MesoDecor *decor, const MesoPattern *pattern,
                            const MesoDecorValues *values, MesoError *error);

#endif
