/* Quilts over another surface than the one that they were grown on. */
#ifndef MESO_QUILT_MOVE_H
#define MESO_QUILT_MOVE_H

#include "formats/quilt/quilt_file.h"

/*
 * The base of `file` becomes `mesh`:
 *
 * - Of the same faces as the surface that it was made of, whose vertices it has elsewhere; or else
 * - of the same texture coordinates, a finer one: the quilt's vertices lie where these are, to the arena.
 *
 * MESO_ERR_INPUT where it has neither, with what differs, and in `face` the face that it is about, or MESO_NO_INDEX: one
 * without texture coordinates, or with those of another. MESO_ERR_LIMIT, MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_move(MesoQuiltFile *file, MesoArena *arena, const MesoPolygonMesh *mesh, uint32_t *face,
                           MesoError *error);

/*
 * The texture coordinates of a mesh of triangles, by corner, in `arena`; those of corners, or else of vertices. NULL
 * where it has none, and with `face`, else MESO_NO_INDEX, where that one has none or none that are finite.
 * MESO_ERR_MEMORY alone.
 */
MesoStatus meso_corner_uvs(MesoVec2 **uvs, MesoArena *arena, const MesoPolygonMesh *mesh, uint32_t *face,
                           MesoError *error);

#endif
