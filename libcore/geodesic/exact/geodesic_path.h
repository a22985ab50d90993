/*
 * Geodesic paths as lines to cut along: straight across every side, and with
 * no less than half a turn on either side of every vertex that they go
 * through. They are the shortest of all paths nearby; whether of all is for
 * exact distances to say.
 */
#ifndef MESO_GEODESIC_PATH_H
#define MESO_GEODESIC_PATH_H

#include "libcore/base/arena.h"
#include "libcore/mesh/cut/cut_lines.h"

typedef struct MesoGeodesicPath {
    double length;
    bool straight;      /* whether it has become a geodesic; not always where sides have no length */
} MesoGeodesicPath;

/*
 * A geodesic between two nodes, in the domain: made of the way through its triangles that is shortest from middle to
 * middle of their sides.
 *
 * domain  NULL: all of the mesh; the path goes along its border where it must
 * line    of the segments
 * lines   gets nodes and segments, from `from` to `to`; nodes nearer to a vertex than 1e-6 of their edge are at it
 *
 * O(n log n) of the triangles that are nearer than the detour is long. MESO_ERR_NO where the domain does not join the
 * nodes, MESO_ERR_MEMORY.
 */
MesoStatus meso_geodesic_path(const MesoTriangulation *mesh, const MesoDomain *domain, MesoCutNode from, MesoCutNode to,
                              uint32_t line, MesoArena *arena, MesoCutLines *lines, MesoGeodesicPath *path,
                              MesoError *error);

/*
 * The same from a path of edges, open or closed, that is pulled tight over the surface: never longer, and on the same
 * side of handles and holes.
 *
 * vertices  [count] each joined to the next by an edge of the domain; of a closed path the last to the first
 *
 * A closed one is pulled from points of its own in turn, until that shortens it by less than 1e-10; its last node lies
 * where its first does. MESO_ERR_NO where it contracts to a point, where vertices are not joined, or where the
 * domain is pinched at one; MESO_ERR_MEMORY.
 */
MesoStatus meso_geodesic_shorten(const MesoTriangulation *mesh, const MesoDomain *domain, const uint32_t *vertices,
                                 uint32_t count, bool closed, uint32_t line, MesoArena *arena, MesoCutLines *lines,
                                 MesoGeodesicPath *path, MesoError *error);

#endif
