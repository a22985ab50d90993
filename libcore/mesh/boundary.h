/* Boundary loops: the closed chains of sides without a neighbour. */
#ifndef MESO_BOUNDARY_H
#define MESO_BOUNDARY_H

#include "libcore/mesh/slot_graph.h"

typedef struct MesoBoundary {
    uint32_t loop_count;
    uint32_t *loop_begin;       /* [loop_count + 1] into half_edges */
    uint32_t *half_edges;       /* [border_count] in the order in which the loop runs */
} MesoBoundary;

/*
 * Traces the loops, ordered by their smallest half-edge; each starts with that
 * one. From the end of a border side the loop goes on around that corner's
 * vertex, through the faces that follow each other there, to the next border
 * side; so a vertex where only corners touch parts the loops. Sides of faces
 * that are turned over (Möbius bands) are run through backwards. `graph` is
 * the graph of `mesh`. O(face_count). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_boundary_build(MesoBoundary *boundary, MesoArena *arena, const MesoQuadMesh *mesh,
                               const MesoSlotGraph *graph, MesoError *error);

#endif
