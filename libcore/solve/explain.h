/* Explanations: which constraints cannot hold together. */
#ifndef MESO_EXPLAIN_H
#define MESO_EXPLAIN_H

#include "libcore/solve/constraints.h"

/*
 * Finds a set of constraints that is disproved, and none of which can be left
 * out, by trying without them: QuickXplain (Junker, "Preferred explanations and
 * relaxations for over-constrained problems", 2004). A try is the initial
 * propagation alone, or, where `deep`, a solve with small limits and this seed;
 * the first tries are with the constraints that touch `slot` and its neighbours,
 * where that is not MESO_NO_INDEX.
 *
 * numbers  [meso_constraint_count()] gets the constraints, ascending
 * count    their number; 0: the tile set and the surface alone are disproved
 *
 * After a number of tries that falls with the size of the surface the set may
 * be larger than need be; where the limits are too small to disprove all
 * constraints together again, it has all of them. O(tries * slots), or tries
 * solves. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_explain(uint32_t *numbers, uint32_t *count, const MesoTileSet *set,
                        const MesoVariantSet *variants, const MesoSlotGraph *graph,
                        const MesoConstraints *constraints, uint32_t slot, bool deep, uint64_t seed,
                        MesoError *error);

/* "pins[0] and quotas[1] 'knots' cannot hold together", in `arena`; NULL: out of memory. */
const char *meso_explanation_text(MesoArena *arena, const MesoConstraints *constraints,
                                  const uint32_t *numbers, uint32_t count, MesoError *error);

#endif
