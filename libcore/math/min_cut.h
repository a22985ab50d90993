/*
 * The least cut of a graph between a source and a sink, by whole numbers
 * (Goldberg and Tarjan, "A New Approach to the Maximum-Flow Problem", 1988).
 */
#ifndef MESO_MIN_CUT_H
#define MESO_MIN_CUT_H

#include <stdint.h>

#include "libcore/base/arena.h"

/* An edge costs its capacity where its ends come to lie on different sides, whichever is which. */
typedef struct MesoCutEdge {
    uint32_t a, b;
    uint32_t capacity;
} MesoCutEdge;

/* A terminal capacity that may not be cut. */
#define MESO_CUT_FIXED UINT32_MAX

/*
 * Parts the nodes so that the sum of what is cut is least: capacities of edges between the sides, source[v] of nodes
 * with the sink, sink[v] of nodes with the source.
 *
 * sink_side       [node_count] 1 where the node is with the sink. Of all least cuts, the one with the fewest such
 *                 nodes: what could be on either side is with the source
 * value           the sum; may be NULL
 * source, sink    [node_count] what it costs to cut a node from them, or MESO_CUT_FIXED
 * edges           [edge_count] in any order; may be repeated, and may join a node to itself
 *
 * MESO_ERR_INPUT where a node is fixed to both, MESO_ERR_INTERNAL for edges to nodes that are not there,
 * MESO_ERR_MEMORY. On grids and the like about O(nodes^1.5); 32 bytes an edge of scratch.
 */
MesoStatus meso_min_cut(uint8_t *sink_side, uint64_t *value, MesoArena *scratch, uint32_t node_count,
                        const uint32_t *source, const uint32_t *sink, const MesoCutEdge *edges, uint32_t edge_count,
                        MesoError *error);

#endif
