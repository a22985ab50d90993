/* Where the numbers of a PLY go in a mesh: positions, corners, attributes. */
#ifndef MESO_PLY_LAYOUT_H
#define MESO_PLY_LAYOUT_H

#include "formats/mesh/ply/ply_header.h"
#include "libcore/mesh/polygon_mesh.h"

/*
 * Makes the attributes of `mesh`, without room yet: "normal", "uv" and "color" of the properties that go by these
 * names, vectors of NAMEx NAMEy NAMEz or NAME_x and so on, and every other number by its own name; each in the type
 * that the file gives it, but for normals of several types, which become floats. O(properties^2). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_ply_plan(MesoPly *ply, MesoPolygonMesh *mesh, MesoArena *arena, MesoError *error);

/*
 * Room for `count` vertices, or for faces with `corner_count` corners, of which all have `side_count`, or 0; tells
 * the properties of `element` where in it they go. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_ply_make_vertices(MesoPlyElement *element, MesoPolygonMesh *mesh, MesoArena *arena,
                                  uint32_t count, MesoError *error);
MesoStatus meso_ply_make_faces(MesoPlyElement *element, MesoPolygonMesh *mesh, MesoArena *arena,
                               uint32_t count, uint32_t corner_count, uint32_t side_count, MesoError *error);

/* Takes out the texture coordinates of corners: a face has not two for each. */
void meso_ply_drop_texcoord(MesoPolygonMesh *mesh);

#endif
