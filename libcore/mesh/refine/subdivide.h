/* Subdivision of polygon meshes, with everything that they carry. */
#ifndef MESO_SUBDIVIDE_H
#define MESO_SUBDIVIDE_H

#include "libcore/mesh/polygon_mesh.h"

typedef enum MesoScheme {
    MESO_CATMULL_CLARK,         /* Catmull and Clark, 1978: polygons of any size become quads */
    MESO_LOOP,                  /* Loop, 1987: a triangle becomes four */
    MESO_LINEAR,                /* the shape stays: triangles become four each where all faces are triangles, else all become quads */
    MESO_LINEAR_QUADS           /* the shape stays, and all become quads */
} MesoScheme;

/* An angle that no edge has: without creases. */
#define MESO_NO_CREASE 181.0

/*
 * Subdivides `level_count` times. Borders follow the rule of cubic B-splines: 1/8 3/4 1/8 for their vertices, middles
 * for their edges. So do creases: edges of `from` whose faces' normals enclose more than `crease` degrees, and what
 * they become. A vertex with three borders or creases, or more, stays where it is; one with a single crease is smooth.
 *
 * Vertices come first, by their old numbers, then one for each edge in order of half-edges, then one for each face that
 * was no triangle of Loop's. Faces come by their old ones, and then by corner, at which they begin, the middle triangle
 * last. Attributes of vertices follow the rule of positions, those of corners are linear in each face, those of faces
 * are copied.
 *
 * O(corners of the result); scratch of some 100 bytes for each of its vertices. MESO_ERR_INPUT for edges with three
 * faces or more, and for Loop's of faces that are no triangles, with the first; MESO_ERR_LIMIT before the counts pass
 * 32 bits; MESO_ERR_MEMORY.
 */
MesoStatus meso_mesh_subdivide(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, MesoScheme scheme,
                               uint32_t level_count, double crease, uint32_t thread_count, MesoError *error);

#endif
