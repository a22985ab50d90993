/* Texture coordinates that the surface's file has. */
#ifndef MESO_GROW_UVS_H
#define MESO_GROW_UVS_H

#include "libcore/mesh/cut/triangulation.h"
#include "libcore/mesh/polygon_mesh.h"

/*
 * [3 * triangle_count] by corner of `mesh`, whose faces are those of `polygons`, triangles. MESO_ERR_INPUT, with words
 * that go on after "... needs ", where a corner has none or such that are not finite; MESO_ERR_MEMORY.
 */
MesoStatus meso_grow_uvs(MesoVec2 **uvs, MesoArena *arena, const MesoPolygonMesh *polygons,
                         const MesoTriangulation *mesh, MesoError *error);

#endif
