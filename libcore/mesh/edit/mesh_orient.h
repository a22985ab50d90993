/* Windings: neighbours run opposite ways along the edge between them. */
#ifndef MESO_MESH_ORIENT_H
#define MESO_MESH_ORIENT_H

#include "libcore/mesh/half_edges.h"

typedef struct MesoOrientCounts {
    uint32_t faces_turned;
    uint32_t pieces_turned;     /* closed pieces that were inside out, all of whose faces are among these */
    uint32_t disagreeing;       /* edges that still disagree: their surface has one side only */
    uint32_t one_sided;         /* a face of the first such piece, or MESO_NO_INDEX */
} MesoOrientCounts;

/*
 * Turns faces so that neighbours agree, piece by piece; faces are neighbours across edges of two faces. Which way a
 * piece runs is told, where it is closed, by the volume that it encloses, which becomes positive: outward; else by
 * the most of its faces, in doubt the first. A turned face keeps its first corner. Normals of corners, and of vertices,
 * that then look into a face, or into the sum of the faces around, are turned too. Pieces that have one side
 * only are given the windings that a breadth-first search finds. O(corners). `counts` may be NULL. MESO_ERR_MEMORY
 * alone.
 */
MesoStatus meso_mesh_orient(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                            const MesoHalfEdges *edges, MesoOrientCounts *counts, MesoError *error);

#endif
