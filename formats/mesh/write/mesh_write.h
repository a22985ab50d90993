/*
 * Polygon meshes out: PLY, OBJ and OFF, with faces of any size and what each
 * format holds of the attributes. What our readers read, they get back.
 */
#ifndef MESO_MESH_WRITE_H
#define MESO_MESH_WRITE_H

#include "formats/file/output.h"
#include "formats/product/provenance.h"
#include "libcore/mesh/polygon_mesh.h"

/* Others that hold a mesh of polygons, or of triangles, find their place here and in the table of mesh_write.c. */
typedef enum MesoMeshKind { MESO_MESH_PLY, MESO_MESH_OBJ, MESO_MESH_OFF, MESO_MESH_KINDS } MesoMeshKind;

/* By the extension of a path; MESO_MESH_KINDS for others. "-", standard output, is PLY. */
MesoMeshKind meso_mesh_kind_of(const char *path);

/* "ply, obj, off", for messages. */
const char *meso_mesh_kind_names(void);

/*
 * Whether a file of this kind gets the attribute. PLY: all, but for a second one of the same properties; OBJ: "uv" and
 * "normal" of corners, or else of vertices, "color" of vertices, "group", "object" and "material" of faces; OFF: none.
 */
bool meso_mesh_kind_holds(MesoMeshKind kind, const MesoPolygonMesh *mesh, const MesoAttribute *attribute);

/*
 * Writes a checked mesh to `output`, which stays the caller's to commit, with its provenance (NULL: none) in comments.
 *
 * PLY  binary, little-endian: each number in its own type, by the file's own names, or else nx ny nz, s t, red green
 * blue
 *      alpha, NAME, NAME_x NAME_y NAME_z, NAME_0 and so on. Corners' numbers are lists of faces: texcoord for "uv",
 *      NAME for others; or numbers of vertices, where all corners at each vertex agree. Names are numbers, which comments "NAME NUMBER TEXT" explain. What has no entry is 0, or -1 of names.
 * OBJ  text, with the shortest digits that give the same float: doubles lose some. vt and vn have numbers of their own,
 * so that
 *      seams are kept; those that nobody uses are left out.
 * OFF  text: positions and faces.
 *
 * O(bytes), with little memory beside the mesh. MESO_ERR_OUTPUT, MESO_ERR_MEMORY.
 */
MesoStatus meso_polygon_mesh_write(const MesoPolygonMesh *mesh, MesoMeshKind kind, const MesoProvenance *provenance,
                                   MesoOutput *output, MesoError *error);

#endif
