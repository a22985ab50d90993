/* Polygon meshes from files: OBJ, PLY and OFF, each read by ourselves, on all cores. */
#ifndef MESO_MESH_READ_H
#define MESO_MESH_READ_H

#include "formats/file/input.h"
#include "libcore/mesh/polygon_mesh.h"

/*
 * Reads a mesh by the extension of its name (the content where there is none) into `arena`, with all that the file
 * says of it, and checks it (meso_polygon_mesh_check()). Elements keep the order of the file. On `thread_count` threads
 * (0: all cores), with the same mesh and the same first error for any number of them.
 * MESO_ERR_INPUT with file and line or element (counted from 1) for what is not as the format says, coordinates that
 * are not finite, faces that cannot be, and meshes without faces; glTF is not read yet. O(size).
 */
MesoStatus meso_polygon_mesh_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                                  uint32_t thread_count, MesoError *error);

/*
 * The same for meshes that are to be mended: a face that comes back to a vertex falls into the loops between, and what
 * has fewer than three corners goes, as meso_mesh_cut_loops() says. `looped` is the number of such faces.
 */
MesoStatus meso_polygon_mesh_read_loops(MesoPolygonMesh *mesh, uint32_t *looped, MesoArena *arena,
                                        const MesoInput *input, uint32_t thread_count, MesoError *error);

/* The same for files of which the vertices matter: there may be no faces. */
MesoStatus meso_polygon_mesh_read_vertices(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                                           uint32_t thread_count, MesoError *error);

/*
 * Puts "PATH:LINE: ", or "PATH: " where a face has no line, before the message of `error`, which is about `face` (from
 * 0; MESO_NO_INDEX: about none) of a mesh that was read from `input`. Returns its status. O(size).
 */
MesoStatus meso_mesh_fail_at_face(const MesoInput *input, uint32_t face, MesoError *error);

/*
 * Why a file that was read has no attribute "uv" though it may seem to: MESO_ERR_INPUT with the first texture
 * coordinate of an OBJ that is not as it should be; else MESO_OK. O(size).
 */
MesoStatus meso_mesh_texture_problem(const MesoInput *input, uint32_t thread_count, MesoError *error);

#endif
