/* The readers of each kind of file, for mesh_read.c. */
#ifndef MESO_MESH_KINDS_H
#define MESO_MESH_KINDS_H

#include "formats/file/input.h"
#include "libcore/mesh/polygon_mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

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
 * PLY  ASCII and binary of either byte order, with every number that is not part of a list; "comment tile 2 ribbon"
 * names
 *      the number 2 of the faces' property "tile" (see ply_names.h)
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

/* The most corners of a mesh for each byte of the file and of the buffers that it names: nodes may repeat meshes. */
enum { MESO_GLTF_CORNERS_A_BYTE = 64 };

/*
 * All triangles (strips and fans among them) of a .glb, or of a .gltf if its bytes do not begin like a .glb, in the
 * order of the nodes of its scene, where these place them; a mesh that several nodes show comes as often. Points and
 * lines are passed over. Vertices are those of the file, primitive by primitive: exporters split them at seams.
 *
 *     "normal"    NORMAL, turned with the node         "uv", "uv1" ...    TEXCOORD_0, TEXCOORD_1 ...
 *     "color"     COLOR_0, without the material's
 *     "name"      _NAME: floats, or whole numbers; two of 16 bits are the halves of one of 32, low first. Whole numbers
 *                 that all corners of each face agree on are of faces
 *     "object"    names of nodes, or else of meshes     "material"    names of materials, one for each of the file's
 *     "albedo", "roughness", "metallic"     the factors of the material
 *
 * Where the asset's extras have a list "tiles" that names all numbers of _TILE, and _TILE is of faces, "tile" has the
 * names, and so has any other.
 *
 * Sparse, strided and quantized accessors, KHR_draco_mesh_compression, data URIs, and buffers in files beside a .gltf
 * are read; images are not. MESO_ERR_INPUT says what is broken, or not known and required; MESO_ERR_LIMIT past
 * MESO_GLTF_CORNERS_A_BYTE. Memory in proportion to the mesh, some 100 bytes a corner.
 */
MesoStatus meso_gltf_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                          MesoError *error);

/*
 * Paths of the files beside `input` that it names as buffers, each once, in its order; none where that cannot be told.
 * [count] in `arena`. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_gltf_buffers(const char *const **paths, uint32_t *count, MesoArena *arena, const MesoInput *input,
                             MesoError *error);

/*
 * The mesh of a .drc: positions, normals, texture coordinates, colours, and generic attributes by the name in their
 * metadata; numbers of faces have names as in glTF where the metadata of the mesh has "tiles" as JSON.
 */
MesoStatus meso_draco_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                           MesoError *error);

#ifdef __cplusplus
}
#endif

#endif
