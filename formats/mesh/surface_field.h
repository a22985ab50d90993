/* Directions on a surface that its file carries: vector attributes, texture coordinates. */
#ifndef MESO_SURFACE_FIELD_H
#define MESO_SURFACE_FIELD_H

#include "formats/mesh/surface_read.h"

/*
 * One direction for each face of `surface`, which was read from `input`: the
 * vector attribute `attribute` (a PLY gives it as three scalar properties NAMEx NAMEy NAMEz
 * or NAME_x NAME_y NAME_z) of faces, or else of vertices, whose vectors are added
 * up over the face's corners. They may be of any length, zero or not finite.
 *
 * directions  gets [face_count] in `arena`, by the file's order of corners
 *
 * MESO_ERR_INPUT where the file has no such attribute. O(faces).
 */
MesoStatus meso_surface_attribute_field(MesoVec3 **directions, MesoArena *arena, const MesoQuadSurface *surface,
                                        const MesoInput *input, const char *attribute, MesoError *error);

/*
 * The same from texture coordinates: the direction in which the first one, u,
 * grows. Zero for faces with a corner that has none. `surface` must not have been turned.
 */
MesoStatus meso_surface_texture_field(MesoVec3 **directions, MesoArena *arena, const MesoQuadSurface *surface,
                                      const MesoInput *input, MesoError *error);

#endif
