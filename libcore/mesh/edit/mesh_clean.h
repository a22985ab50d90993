/* Meshes without what no method can use: what is degenerate, double or unused; and neighbours more than two at an
 * edge. */
#ifndef MESO_MESH_CLEAN_H
#define MESO_MESH_CLEAN_H

#include "libcore/mesh/half_edges.h"

/*
 * A face is flat where the areas of its fan add up to less than this times the square of its longest side:
 * coordinates are floats, and tell no more.
 */
#define MESO_FLAT_FACE 1e-7

typedef struct MesoCleanCounts {
    uint32_t faces_looped;      /* that had a vertex twice; what is left of them is there */
    uint32_t faces_flat, faces_double, vertices_unused;     /* dropped; of double ones, the first stays */
} MesoCleanCounts;

/*
 * Drops what is degenerate: repeated corners, spurs, flat faces; faces with the same vertices in the same order as one
 * before, or in the reverse order; and then vertices that no face uses. Unlike others, takes meshes whose faces have
 * vertices twice, or fewer than three corners. What is left keeps its order. O(corners). `counts` may be NULL.
 * MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_mesh_clean(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                           MesoCleanCounts *counts, MesoError *error);

/* Whether a face is flat, as above. O(sides). */
bool meso_face_is_flat(const MesoPolygonMesh *mesh, uint32_t face);

/*
 * doubles[f] [face_count] is the first face with the vertices of face f in its order or the reverse: f itself where
 * there is none before. O(corners). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_mesh_find_doubles(uint32_t *doubles, const MesoPolygonMesh *mesh, MesoError *error);

/*
 * fans[c] [corner_count] is the first corner of the fan of corner c: the corners of its vertex whose faces are
 * neighbours, one by one, across edges of two faces. O(corners). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_mesh_find_fans(uint32_t *fans, const MesoPolygonMesh *mesh, const MesoHalfEdges *edges,
                               MesoError *error);

/*
 * Gives each fan of faces around a vertex a vertex of its own, where there are several. What met in an edge of three
 * faces, or in a point alone, comes apart; the fan of the first corner keeps the vertex, others are new ones behind
 * all, and `added` (may be NULL) says how many. Edges at which all faces belong to one fan stay as they are.
 * O(corners). MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_mesh_separate(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                              const MesoHalfEdges *edges, uint32_t *added, MesoError *error);

#endif
