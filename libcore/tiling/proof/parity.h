/*
 * Parity prover: for each slot, the sums modulo 2 of "this side shows this label"
 * that come out the same for all its patterns, as linear equations over the
 * edges; Gaussian elimination shows whether they contradict each other. Clause
 * learning needs exponential time for such contradictions (Urquhart, "Hard
 * Examples for Resolution", 1987).
 *
 * Slots are visited breadth first; what is known is kept as equations over the
 * edges between slots that were visited and slots that were not, and an edge's
 * unknowns are eliminated when its second slot comes.
 */
#ifndef MESO_PARITY_H
#define MESO_PARITY_H

#include "libcore/tiling/propagate/label_pattern.h"

/*
 * Sets `slot` to the one whose equations brought the contradiction, or to
 * MESO_NO_INDEX where there is none, or the effort is over `work_limit` word
 * operations, or memory over 1 GiB. Scratch lives in `arena`. MESO_ERR_MEMORY
 * alone. O(slots * w^2) for w unknowns on the longest front, over 64.
 */
MesoStatus meso_parity_prove(uint32_t *slot, MesoArena *arena, MesoLabelPatternTable *table,
                             uint64_t work_limit, MesoError *error);

#endif
