/*
 * Slot graph: the dual of a quad mesh. Slot s is face s; its side k runs from
 * corner k to corner k + 1; half-edge h = 4 s + k stands for side k of slot s.
 */
#ifndef MESO_SLOT_GRAPH_H
#define MESO_SLOT_GRAPH_H

#include "libcore/base/arena.h"
#include "libcore/mesh/quad_mesh.h"

typedef struct MesoSlotGraph {
    uint32_t slot_count;
    uint32_t edge_count;        /* edges of the mesh, borders included */
    uint32_t border_count;      /* edges with one face */
    uint32_t reversed_count;    /* edges whose two faces run along them the same way */
    uint32_t *twin;             /* [4 * slot_count] half-edge across, or MESO_NO_INDEX */
} MesoSlotGraph;

/* That of a surface all of whose faces are quads, whose twins it goes on to use. Errors as below. */
MesoStatus meso_slot_graph_view(MesoSlotGraph *graph, const MesoSurface *surface, MesoError *error);

/*
 * Joins the sides of faces that share two vertices. `mesh` is only read.
 * O(face_count). MESO_ERR_INPUT names the three faces (counted from 1) where
 * an edge joins more than two.
 */
MesoStatus meso_slot_graph_build(MesoSlotGraph *graph, MesoArena *arena,
                                 const MesoQuadMesh *mesh, MesoError *error);

/* Number of connected pieces; component[slot_count] gets each slot's. O(slot_count). */
uint32_t meso_slot_graph_components(const MesoSlotGraph *graph, uint32_t *component);

#endif
