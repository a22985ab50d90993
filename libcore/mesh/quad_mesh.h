/* Macrosurface: a mesh of quads. Does not change once built. */
#ifndef MESO_QUAD_MESH_H
#define MESO_QUAD_MESH_H

#include "libcore/mesh/surface.h"

/* A shorter mean edge is refused: products of two lengths would lose their digits. */
#define MESO_SHORTEST_EDGE 1e-18f

typedef struct MesoQuadMesh {
    uint32_t vertex_count;
    uint32_t normal_count;
    uint32_t given_normals;     /* of these, the first ones; the others are vertex normals */
    uint32_t lost_normals;      /* vertex normals that vanish, and are +Z */
    uint32_t face_count;
    MesoVec3 *positions;        /* [vertex_count] */
    MesoVec3 *normals;          /* [normal_count] unit length */
    uint32_t *face_vertices;    /* [4 * face_count] corner i of face f at 4 f + i */
    uint32_t *face_normals;     /* [4 * face_count] into normals */
    float mean_edge_length;     /* over all sides of all faces */
} MesoQuadMesh;

/*
 * The same of a surface all of whose faces are quads; it goes on to use the surface's positions and corners,
 * and where every corner has a normal its numbers of these. Normals go to `arena`, as below.
 * MESO_ERR_INPUT for a surface without faces or with edges that are too short.
 */
MesoStatus meso_quad_mesh_view(MesoQuadMesh *mesh, MesoArena *arena, const MesoSurface *surface, MesoError *error);

/*
 * Builds a mesh from arrays that may come from anywhere, and checks them.
 *
 * positions      [vertex_count], finite
 * normals        [normal_count] of any length, or NULL with a count of 0
 * face_vertices  [4 * face_count]
 * face_normals   [4 * face_count] into normals, or MESO_NO_INDEX; NULL if normals is
 *
 * Everything is copied to `arena`. Normals are taken as they are, made unit
 * length; corners without a usable one (no normal, zero length) get the
 * vertex normal, appended: the sum over the faces around the vertex of the cross
 * products of their diagonals (area-weighted), or +Z where that vanishes.
 * O(vertex_count + face_count).
 * MESO_ERR_INPUT names the first face or vertex (counted from 1, as OBJ
 * files do) that is not finite, too large, out of range, or uses a
 * vertex twice, and refuses a mesh without faces or with edges that are too short.
 */
MesoStatus meso_quad_mesh_build(MesoQuadMesh *mesh, MesoArena *arena,
                                uint32_t vertex_count, const MesoVec3 *positions,
                                uint32_t normal_count, const MesoVec3 *normals,
                                uint32_t face_count, const uint32_t *face_vertices,
                                const uint32_t *face_normals, MesoError *error);

#endif
