/* Steps along sweeps: as many as a tolerance asks for, by how each sweep bends, turns and changes its shape. */
#ifndef MESO_STEPS_H
#define MESO_STEPS_H

#include "libcore/scene/scene.h"
#include "libcore/tiling/strand/profile_set.h"

/* The vertices along a sweep are at most this many. */
enum { MESO_MOST_DIVISIONS = MESO_MOST_BOWED };

/*
 * Cuts the scene's kinds up so that each has instances which need about as many vertices along, and sets that number
 * and how they lie: the quads are within `tolerance` (scene units) of the surface. What columns are off already is left
 * out of it. It is estimated from differences of the surface at nine places along some columns of each sweep, or more
 * where it turns.
 *
 * origins   [kind_count] of the scene's kinds; replaced like the kinds
 *
 * Sweeps are reordered within their kinds. The ends of a sweep do not depend on its steps. O(sweeps + kinds).
 */
MesoStatus meso_scene_choose_steps(MesoScene *scene, MesoKindOrigin **origins, MesoArena *arena, float tolerance,
                                   uint32_t thread_count, MesoError *error);

#endif
