/* Directions on a surface that its file carries: vector attributes, texture coordinates. */
#ifndef MESO_SURFACE_FIELD_H
#define MESO_SURFACE_FIELD_H

#include "formats/file/input.h"
#include "libcore/mesh/quad_mesh.h"

/*
 * One direction for each face of `mesh`, which was read from `input`: the
 * attribute `attribute` of a PLY file, three scalar properties NAMEx NAMEy NAMEz
 * or NAME_x NAME_y NAME_z of faces, or else of vertices, whose vectors are added
 * up over the face's corners. They may be of any length, zero or not finite.
 *
 * directions  gets [face_count] in `arena`
 *
 * MESO_ERR_INPUT where the file has no such attribute, or is not a PLY.
 * O(size of the file).
 */
MesoStatus meso_surface_attribute_read(MesoVec3 **directions, MesoArena *arena, const MesoQuadMesh *mesh,
                                       const MesoInput *input, const char *attribute, MesoError *error);

/*
 * The same from texture coordinates: the direction in which the first one, u,
 * grows; of OBJ the corners' vt, of PLY the vertices' s, u or texture_u. Zero
 * for faces with a corner that has none.
 */
MesoStatus meso_surface_texture_read(MesoVec3 **directions, MesoArena *arena, const MesoQuadMesh *mesh,
                                     const MesoInput *input, MesoError *error);

#endif
