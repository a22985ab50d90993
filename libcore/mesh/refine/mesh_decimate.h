/* Fewer triangles for the same shape. */
#ifndef MESO_MESH_DECIMATE_H
#define MESO_MESH_DECIMATE_H

#include "libcore/mesh/polygon_mesh.h"

/*
 * Cuts faces into triangles as meso_mesh_cut_faces() does, and lets edges collapse until `target` triangles are left,
 * or none can go without folding the surface; see openmesh_decimate_adapter.h. Vertices that are left stay where they
 * are, with their attributes; faces keep theirs; a corner has those of its face's old corner where that is at the same
 * vertex, else those of a first corner there, so that seams of textures may smear. Vertices that no face uses are
 * dropped. O(n log n).
 *
 * MESO_ERR_INPUT for edges of three faces or more, neighbours wound alike and fans that meet in a point alone.
 * MESO_ERR_LIMIT beyond 2^28 triangles, for OpenMesh counts half-edges in an int.
 */
MesoStatus meso_mesh_decimate(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, uint32_t target,
                              uint32_t thread_count, MesoError *error);

#endif
