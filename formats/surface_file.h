/*
 * Surfaces from mesh files: OBJ, PLY, OFF through OpenMesh, GLB and glTF
 * through tinygltf, so far only to refuse them with the reason. OpenMesh mends
 * what is broken without a word, so the elements of the file are read by
 * ourselves as well, and compared. (A few layouts of PLY that OpenMesh does
 * not know, such as faces before vertices, are read by ourselves alone.)
 */
#ifndef MESO_SURFACE_FILE_H
#define MESO_SURFACE_FILE_H

#include "formats/file/input.h"
#include "formats/surface_groups.h"
#include "libcore/mesh/quad_mesh.h"
#include "libcore/tiling/strand/model.h"

/*
 * Reads a macrosurface by the extension of its name (the content where there
 * is none). Faces keep the order of the file. MESO_ERR_INPUT with file and
 * line or face (counted from 1) for faces that are not quads, indices out of
 * range, coordinates that are not finite, edges with three faces, elements
 * that the library would have dropped or changed, and empty meshes.
 */
MesoStatus meso_surface_read(MesoQuadMesh *mesh, MesoArena *arena, const MesoInput *input,
                             MesoError *error);

/*
 * The same, with what the file says of faces beside their shape, into `arena`
 * too: OBJ and PLY say something, OFF nothing.
 */
MesoStatus meso_surface_read_groups(MesoQuadMesh *mesh, MesoSurfaceGroups *groups, MesoArena *arena,
                                    const MesoInput *input, MesoError *error);

/*
 * Reads any polygon mesh as triangles (fans), for inner meshes; vertices are
 * split where their corners have different normals. Same errors, except that
 * faces may have any number of sides, and edges any number of faces.
 */
MesoStatus meso_triangle_mesh_read(MesoTriangleMesh *mesh, MesoArena *arena, const MesoInput *input,
                                   MesoError *error);

#endif
