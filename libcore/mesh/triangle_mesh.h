/* Triangles with a normal a vertex: what is drawn, and what tiles carry along. */
#ifndef MESO_TRIANGLE_MESH_H
#define MESO_TRIANGLE_MESH_H

#include "libcore/mesh/polygon_mesh.h"

typedef struct MesoTriangleMesh {
    uint32_t vertex_count, triangle_count;
    MesoVec3 *positions;    /* [vertex_count] */
    MesoVec3 *normals;      /* [vertex_count] unit length */
    uint32_t *triangles;    /* [3 * triangle_count] */
} MesoTriangleMesh;

/*
 * Cuts every face of a checked mesh into the fan around its first corner. A
 * vertex is split where its corners have different normals; corners without a
 * usable one share the vertex normal: the sum over the faces around it of the
 * faces' areas times their normals, or +Z where that vanishes. Vertices
 * without faces are left out; the others come by vertex of the mesh, then by
 * first corner. Connectivity is the polygons' to know, not the triangles'. `mesh` goes to `arena`.
 * O(corners). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_polygon_triangulate(MesoTriangleMesh *mesh, MesoArena *arena, const MesoPolygonMesh *polygons,
                                    MesoError *error);

#endif
