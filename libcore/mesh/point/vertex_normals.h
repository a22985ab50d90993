/* Smooth normals of a triangulation. */
#ifndef MESO_VERTEX_NORMALS_H
#define MESO_VERTEX_NORMALS_H

#include "libcore/mesh/cut/triangulation.h"

/* normals[vertex_count]: sums of the area vectors around each vertex, made unit length; +Z where they vanish. */
void meso_vertex_normals(MesoVec3 *normals, const MesoTriangulation *mesh);

/* Adds the area vector of one triangle to the sums of its three corners. */
void meso_vertex_normals_add(MesoVec3 *sums, const MesoTriangulation *mesh, uint32_t triangle);

#endif
