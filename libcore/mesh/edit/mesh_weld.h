/* Welding: vertices in one place become one. */
#ifndef MESO_MESH_WELD_H
#define MESO_MESH_WELD_H

#include "libcore/mesh/polygon_mesh.h"

typedef struct MesoWeldCounts {
    uint32_t vertices_gone;     /* that are part of another one now */
    uint32_t faces_gone;        /* that had no three corners left */
    uint32_t attributes_moved;  /* from vertices to corners */
} MesoWeldCounts;

/*
 * first[v] [vertex_count] is the first vertex that v is one with: those within `distance`, >= 0 and finite, of each
 * other are, and so are all along a chain of such. 0 asks for equal positions. O(vertices) as long as few lie
 * within `distance`, for which it is meant; quadratic in those that do not join, though thousands lie as near as three
 * times that. Scratch of some 40 bytes a vertex. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_mesh_weld_map(uint32_t *first, const MesoPolygonMesh *mesh, double distance, MesoError *error);

/*
 * `from` with its vertices welded; each stays where the first of its vertices is. Faces lose corners that have become
 * one with their neighbours, and fall apart where they meet a vertex again. An attribute of vertices in which some
 * that are one now differ goes to the corners, with an entry for each old value, so that seams of textures and hard
 * edges are kept; unless corners have one of its name. Cost as above, and O(corners). `counts` may be NULL.
 */
MesoStatus meso_mesh_weld(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, double distance,
                          MesoWeldCounts *counts, MesoError *error);

#endif
