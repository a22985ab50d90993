/* Where the numbers of a PLY go in a mesh: positions, corners, attributes. */
#ifndef MESO_PLY_LAYOUT_H
#define MESO_PLY_LAYOUT_H

#include "formats/mesh/ply/ply_header.h"
#include "libcore/mesh/polygon_mesh.h"

/*
 * Makes the attributes of `mesh`, without room yet: "normal", "uv" and "color" of the properties that go by these
 * names, vectors of NAMEx NAMEy NAMEz or NAME_x and so on, and every other number and list of faces by its own name;
 * each in the type that the file gives it, but for normals of several types, which become floats. O(properties^2).
 * MESO_ERR_MEMORY alone.
 */
MesoStatus meso_ply_plan(MesoPly *ply, MesoPolygonMesh *mesh, MesoArena *arena, MesoError *error);

/*
 * How many numbers lists of faces have for each corner, by property of the element: 0 is not known yet, and
 * MESO_NO_INDEX that it is not the same for all. meso_ply_note_widths() looks at one more face, whose lists have the
 * lengths `counts`, by property; meso_ply_join_widths() adds what is known of others.
 */
void meso_ply_note_widths(uint32_t *widths, const MesoPlyElement *element, const uint32_t *counts);
void meso_ply_join_widths(uint32_t *widths, const uint32_t *others, const MesoPlyElement *element);

/*
 * Room for `count` vertices, or for faces with `corner_count` corners, of which all have `side_count`, or 0; tells
 * the properties of `element` where in it they go. Lists whose `widths` say that they are not of corners have no
 * attribute any more, nor has a texcoord that is not two numbers. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_ply_make_vertices(MesoPlyElement *element, MesoPolygonMesh *mesh, MesoArena *arena,
                                  uint32_t count, MesoError *error);
MesoStatus meso_ply_make_faces(MesoPlyElement *element, MesoPolygonMesh *mesh, MesoArena *arena,
                               uint32_t count, uint32_t corner_count, uint32_t side_count, const uint32_t *widths,
                               MesoError *error);

#endif
