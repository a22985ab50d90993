/*
 * Strands: what the sweeps of an assignment form together. Each cross-section
 * on an edge of the slot graph is a joint, shared by the slots on both sides;
 * so is each on the top or bottom of a slot, of its own. Each sweep is a link
 * between two joints. A strand is a connected set of links: two sweeps in one
 * tile that do not touch belong to two. Joints without a sweep are no strand.
 */
#ifndef MESO_STRANDS_H
#define MESO_STRANDS_H

#include "libcore/tiling/problem/assignment.h"

typedef struct MesoStrandRule {
    bool connected;             /* one strand on each piece of the surface */
    bool acyclic;               /* no strand has a cycle */
    bool no_loops;              /* no strand is a closed ring; branched ones may have cycles */
    uint32_t max_length;        /* most links of a strand; 0: any number */
} MesoStrandRule;

static inline bool meso_strand_rule_given(const MesoStrandRule *rule)
{
    return rule->connected || rule->acyclic || rule->no_loops || rule->max_length;
}

/* Strands by length: bucket b counts those of 2^b to 2^(b+1) - 1 links. */
enum { MESO_STRAND_BUCKETS = 32 };

typedef struct MesoStrandStatistics {
    uint64_t strand_count;
    uint64_t loop_count;        /* closed rings: every joint has two links */
    uint64_t cyclic_count;      /* strands with a cycle; closed rings too */
    uint64_t link_count;        /* sweeps */
    uint64_t shortest, longest; /* links of a strand; 0 where there is none */
    uint64_t lengths[MESO_STRAND_BUCKETS];
} MesoStrandStatistics;

/*
 * Counts the strands of a checked assignment. O(sweeps * log(sweeps)).
 * MESO_ERR_MEMORY, or MESO_ERR_LIMIT for 2^32 - 1 joints and more.
 */
MesoStatus meso_strands_count(MesoStrandStatistics *statistics, const MesoAssignment *assignment,
                              const MesoTileSet *set, const MesoSlotGraph *graph, MesoError *error);

/*
 * Whether the strands of a checked assignment keep to `rule`: MESO_OK, or
 * MESO_ERR_INPUT with what is wrong and a slot where. Otherwise as above.
 */
MesoStatus meso_strands_check(const MesoStrandRule *rule, const MesoAssignment *assignment,
                              const MesoTileSet *set, const MesoSlotGraph *graph, MesoError *error);

/* Sets of slots that break a rule as long as each of them keeps its variant. */
typedef struct MesoStrandCuts {
    uint32_t count;
    uint32_t *begin;            /* [count + 1] into slots */
    uint32_t *slots;            /* each slot once in a set */
} MesoStrandCuts;

/*
 * What breaks `rule` in a checked assignment: the slots of pieces of strands
 * that have a cycle or are too long already; those that each ring runs through;
 * where strands should be connected, those of two strands on each piece of the
 * surface. At most `most` sets. None exactly where meso_strands_check() is
 * content. O(sweeps * log(sweeps)). Errors as meso_strands_count().
 */
MesoStatus meso_strands_cuts(MesoStrandCuts *cuts, MesoArena *arena, const MesoStrandRule *rule,
                             const MesoAssignment *assignment, const MesoTileSet *set,
                             const MesoSlotGraph *graph, uint32_t most, MesoError *error);

/* "no-loops", or several, "connected, max-length 12". */
const char *meso_strand_rule_name(const MesoStrandRule *rule, char text[64]);

#endif
