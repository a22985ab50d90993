/*
 * Rings under chains. Once the bits of all chains (edge_chains.h) are set, the patterns that
 * a slot has left may carry more than these: where one side's label tells another's, a
 * wire runs from side to side, through slot after slot, until it comes back. What comes
 * back as its opposite is a contradiction: these bits have no tiling. Where slots have
 * nothing but such wires, they are a system of linear equations modulo 2 with two
 * unknowns each, which union-find solves, and clause learning over labels does not.
 */
#ifndef MESO_CHAIN_RINGS_H
#define MESO_CHAIN_RINGS_H

#include "libcore/tiling/exact/edge_chains.h"

/* At a slot; where more meet, rings are not looked for. */
enum { MESO_CHAIN_RINGS_SLOT_CHAINS = 6 };

/* A slot, its settings the values of the chains that meet it, as bits. */
typedef struct MesoRingSlot {
    uint32_t chain_count;
    uint32_t chain[MESO_CHAIN_RINGS_SLOT_CHAINS];
    uint64_t dead;              /* settings that leave no pattern, or contradict themselves */
} MesoRingSlot;

/* An edge, its cases the settings of both its slots: the first one's are the higher bits. */
typedef struct MesoRingEdge {
    uint32_t slot[2];
    uint32_t first_case;
} MesoRingEdge;

/* Two wires, each 2 * number, or + 1 for its opposite, that are one. */
typedef struct MesoRingJoint {
    uint32_t wire[2];
} MesoRingJoint;

typedef struct MesoChainRings {
    bool possible;              /* false: there are no chains, or too many at a slot, or too many cases */
    uint32_t slot_count, edge_count, wire_count, chain_count;
    MesoRingSlot *slots;        /* [slot_count] */
    MesoRingEdge *edges;        /* [edge_count] */
    uint32_t *case_begin;       /* [cases + 1] into joints */
    MesoRingJoint *joints;
    uint32_t *setting;          /* [slot_count] at the last count */
    uint32_t *parent;           /* [wire_count] of the wires, as disjoint sets with negations */
} MesoChainRings;

typedef struct MesoRingCount {
    uint32_t contradictions;    /* rings, or slots, that contradict themselves */
    uint32_t rings;             /* all of them, those included */
} MesoRingCount;

/*
 * Prepares the wires of all settings for `table`'s initial states and their chains.
 * Arrays live in `arena`. MESO_ERR_MEMORY alone. O(slots * patterns), and O(slots)
 * memory, up to some 300 MB, where two chains meet at most slots.
 */
MesoStatus meso_chain_rings_build(MesoChainRings *rings, MesoArena *arena, MesoLabelPatternTable *table,
                                  const MesoEdgeChains *chains, MesoError *error);

/*
 * Counts rings under values[chain_count]. Where a tiling shows these bits there is no
 * contradiction; the other way round there need not be one. Expected O(edges), 10 ns each.
 */
MesoRingCount meso_chain_rings_count(MesoChainRings *rings, const bool *values);

#endif
