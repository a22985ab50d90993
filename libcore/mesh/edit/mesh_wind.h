/*
 * One side for a surface whose faces disagree about it: faces that are wound against their neighbours are turned over,
 * and a piece that has one side only, like a Moebius band, is cut open. Pieces that agree stay as they are, inside
 * out or not, which is what meso_mesh_orient() would mend.
 */
#ifndef MESO_MESH_WIND_H
#define MESO_MESH_WIND_H

#include "libcore/mesh/half_edges.h"

typedef struct MesoWindCounts {
    uint32_t faces_turned, turned_face;     /* of pieces that have two sides, and the first of them */
    uint32_t edges_cut, cut_faces[2];       /* and the two faces of the first of them */
} MesoWindCounts;

/*
 * Which faces are to be turned over: over[face_count] 0 or 1. Of the two ways that a piece can go, that which most of
 * its normals look along, where the mesh has some; else that which encloses a positive volume, where the piece is
 * closed; else that of most faces, in doubt of the first. O(corners). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_mesh_find_windings(uint8_t *over, const MesoPolygonMesh *mesh, const MesoHalfEdges *edges,
                                   MesoError *error);

/*
 * The mesh with the faces of `over` turned over, each about its first corner, and cut open along the edges that still
 * disagree: vertices on a cut are there once for each side of it, the copies behind the others. Normals that look
 * into a face are turned in pieces where windings disagreed. `from` must outlive `mesh`. O(corners).
 * MESO_ERR_MEMORY, or MESO_ERR_LIMIT for too many vertices.
 */
MesoStatus meso_mesh_wind(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                          const MesoHalfEdges *edges, const uint8_t *over, MesoWindCounts *counts, MesoError *error);

#endif
