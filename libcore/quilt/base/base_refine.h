/* Refinement of the surface of a quilt: long edges split, in the middle and on both sides. */
#ifndef MESO_BASE_REFINE_H
#define MESO_BASE_REFINE_H

#include "libcore/mesh/cut/triangulation.h"

/* A mesh that is refined, with where its triangles lie in the one that it came from. */
typedef struct MesoBaseMesh {
    MesoTriangulation mesh;     /* labels 0; walls are borders; no values; owned */
    uint32_t triangle_room;     /* of the two arrays below, which are owned too */
    uint32_t *triangles;        /* [mesh.triangle_count] triangle of the original */
    MesoVec2 *corner_weights;   /* [3 * mesh.triangle_count] weights of its corners 1 and 2 */
} MesoBaseMesh;

/* A copy. MESO_ERR_INPUT where neighbours are wound against each other, MESO_ERR_MEMORY. O(triangles). */
MesoStatus meso_base_mesh_copy(MesoBaseMesh *base, const MesoTriangulation *original, MesoError *error);
void meso_base_mesh_release(MesoBaseMesh *base);

/* Makes room for so many vertices and triangles in all. MESO_ERR_LIMIT, MESO_ERR_MEMORY. */
MesoStatus meso_base_mesh_reserve(MesoBaseMesh *base, uint64_t vertex_count, uint64_t triangle_count,
                                  MesoError *error);

/* Corners of vertices, and walls, after triangles have changed. O(triangles). */
void meso_base_mesh_settle(MesoBaseMesh *base);

/*
 * Splits edges longer than `edge` in passes: all of them in the middle, triangles into two, three or four by how many
 * of their sides are split. The longest edge falls by a quarter or more with each pass. O(what comes out), and one pass
 * over the mesh where nothing is long. MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_base_refine(MesoBaseMesh *base, float edge, MesoError *error);

/* Splits edges that are no border but join two vertices on borders, and triangles that are alone: each triangle has a
 * vertex inside then. O(triangles). MESO_ERR_LIMIT, MESO_ERR_MEMORY. */
MesoStatus meso_base_free_borders(MesoBaseMesh *base, MesoError *error);

#endif
