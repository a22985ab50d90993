/* Bodies of a scene where they are placed. */
#ifndef MESO_SHAPE_BODIES_H
#define MESO_SHAPE_BODIES_H

#include "libcore/base/arena.h"
#include "libcore/scene/scene.h"

typedef struct MesoShapeBodies {
    const MesoVec3 **positions, **normals;      /* [placed_count] in the world */
    bool *mirrored;                             /* [placed_count] faces run the other way */
} MesoShapeBodies;

/*
 * Into `arena`: those that a frame or a cage places are moved there, 24 bytes a vertex, by `thread_count` threads (0:
 * all cores); others are the scene's. O(their vertices). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_shape_bodies(MesoShapeBodies *bodies, MesoArena *arena, const MesoScene *scene, uint32_t thread_count,
                             MesoError *error);

#endif
