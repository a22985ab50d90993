/* Polygons of a mesh file to the triangles that tiles carry along. */
#ifndef MESO_MESH_TRIANGLES_H
#define MESO_MESH_TRIANGLES_H

#include "formats/mesh_scan.h"
#include "libcore/tiling/strand/model.h"

/*
 * Cuts every face of a checked scan into the fan around its first corner. A
 * vertex is split where its corners have different normals; corners without a
 * usable one share the vertex normal: the sum over the faces around it of the
 * faces' areas times their normals, or +Z where that vanishes. Vertices
 * without faces are left out; the others come by vertex of the file, then by
 * first corner. `mesh` goes to `arena`, scratch to the scan's own. O(corners).
 * MESO_ERR_INPUT for coordinates beyond MESO_COORDINATE_LIMIT.
 */
MesoStatus meso_mesh_scan_triangulate(MesoTriangleMesh *mesh, MesoArena *arena, const MesoMeshScan *scan,
                                      MesoError *error);

#endif
