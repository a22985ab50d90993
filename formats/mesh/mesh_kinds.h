/* The readers of each kind of file, for mesh_read.c. */
#ifndef MESO_MESH_KINDS_H
#define MESO_MESH_KINDS_H

#include "formats/file/input.h"
#include "libcore/mesh/polygon_mesh.h"

/* The most elements of a kind that a mesh may have. */
#define MESO_MESH_LIMIT (UINT32_MAX - 1)

/*
 * Each reads a file into `arena` and fails with MESO_ERR_INPUT, naming file and line (the element in binary files),
 * on whatever is not as the format says: counts, numbers, ends; MESO_ERR_LIMIT past MESO_MESH_LIMIT elements. What
 * they leave to meso_polygon_mesh_check() are faces: their indices, and how many sides they have. Allocates in
 * proportion to the file, whatever counts its header claims. O(size), on `thread_count` threads; the same mesh and the
 * same error for any number of them.
 *
 * OBJ  v with colours, vn, vt, f, g, o, usemtl; lines, points and what says nothing about the shape of faces is passed
 *      over; anything else is refused
 * PLY  ASCII and binary of either byte order, with every number that is not part of a list
 * OFF  ASCII, with normals; colours and texture coordinates are passed over
 */
MesoStatus meso_obj_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                         MesoError *error);
MesoStatus meso_ply_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                         MesoError *error);
MesoStatus meso_off_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                         MesoError *error);

/* As meso_obj_read() but that texture coordinates must be as they should be; there they are left out. */
MesoStatus meso_obj_read_strictly(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                                  uint32_t thread_count, MesoError *error);

/* Line, from 1, of a face of a file that was read: the file is gone through again. 0 where it has none. O(size). */
uint32_t meso_obj_face_line(MesoArena *scratch, const MesoInput *input, uint32_t face);
uint32_t meso_ply_face_line(MesoArena *scratch, const MesoInput *input, uint32_t face);
uint32_t meso_off_face_line(MesoArena *scratch, const MesoInput *input, uint32_t face);

#endif
