/* Points of space, brought to the surface. */
#ifndef MESO_GROWTH_SNAP_H
#define MESO_GROWTH_SNAP_H

#include "libcore/growth/ground/growth_ground.h"

/*
 * The nearest points of a surface that has triangles.
 *
 * points  [count] finite
 * out     [count]
 *
 * O(triangles * points). On `thread_count` threads (0: all cores), the same for any number. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_growth_snap(const MesoGrowthGround *ground, MesoArena *scratch, const MesoVec3 *points, uint32_t count,
                            MesoMeshPoint *out, uint32_t thread_count, MesoError *error);

#endif
