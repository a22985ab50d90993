/*
 * Carried values: where every pattern of a slot that shows a label of one set on
 * one side shows a label of a matching set on another, and no other does, the
 * slot carries this bit from side to side, and edges that are far apart on the
 * surface know the same one. Such chains of edges (strips of slots, mostly) are
 * seen by no local consistency: an engine that decides label by label has to
 * find them again for every strip. They are the sums modulo 2 with two terms
 * that hold in a slot, those of parity.h with the fewest.
 */
#ifndef MESO_EDGE_CHAINS_H
#define MESO_EDGE_CHAINS_H

#include "libcore/tiling/propagate/label_pattern.h"

/* Values of one pair of sides of which all sums are tried; of more, each value alone. */
enum { MESO_EDGE_CHAINS_SUMMED = 4 };

/* One edge of a chain: the chain's bit tells whether the edge's label is one of a set. */
typedef struct MesoChainLink {
    uint32_t edge;              /* its lower half-edge (slot_graph.h) */
    uint32_t chain;
    uint64_t ranks;             /* the set: ranks among the labels that the far side may show, ascending */
    bool negated;               /* the bit tells whether it is none of them */
} MesoChainLink;

typedef struct MesoEdgeChains {
    uint32_t link_count, chain_count;
    MesoChainLink *links;       /* [link_count] in no order */
} MesoEdgeChains;

/*
 * Chains of the initial states of `table`'s propagation, none of which may be
 * empty; those of at least two edges of which one label alone is not the bit.
 * Edges with over 64 labels have none. Arrays live in `arena`. Expected
 * O(slots * labels). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_edge_chains_find(MesoEdgeChains *chains, MesoArena *arena, MesoLabelPatternTable *table,
                                 MesoError *error);

#endif
