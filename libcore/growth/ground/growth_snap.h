/* Points of space, brought to a surface. */
#ifndef MESO_GROWTH_SNAP_H
#define MESO_GROWTH_SNAP_H

#include "libcore/base/arena.h"
#include "libcore/mesh/cut/triangulation.h"

/*
 * The nearest points of a mesh that has triangles; of equal ones, in the first triangle.
 *
 * mesh    its positions and corners are all that is looked at
 * points  [count] finite
 * out     [count]
 *
 * On `thread_count` threads (0: all cores), the same for any number. About O((triangles + points) log triangles) for
 * points that are near. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_growth_snap(const MesoTriangulation *mesh, MesoArena *scratch, const MesoVec3 *points, uint32_t count,
                            MesoMeshPoint *out, uint32_t thread_count, MesoError *error);

#endif
