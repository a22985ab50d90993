/* Explanations of unsolvable problems: what cannot hold together. */
#ifndef MESO_EXPLAIN_H
#define MESO_EXPLAIN_H

#include "libcore/tiling/solve/solve.h"

/*
 * Finds what a proof of meso_solve() needs, and puts it into `core` and, in words, into
 * `reason`: a conflict core (conflict_core.h) around `conflict_slot`, the slot with most
 * dead ends, or anywhere; where there is none within reach, or the rule on strands
 * has a part in it, constraints alone; else nothing changes. A proof
 * by numbers keeps its reason unless there is a core of at most half the surface.
 * Results that are not unsolvable stay as they are.
 *
 * problem  that of `result`
 * seed     of the solves that are tried
 *
 * A second or two, or tries of whole solves under constraints; the result depends
 * on the arguments alone. MESO_ERR_MEMORY or MESO_ERR_INTERNAL.
 */
MesoStatus meso_explain(MesoSolveResult *result, MesoArena *arena, const MesoTilingProblem *problem, uint64_t seed,
                        MesoError *error);

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
MesoStatus meso_explain_constraints(uint32_t *numbers, uint32_t *count, const MesoTilingProblem *problem,
                                    uint32_t slot, bool deep, uint64_t seed, MesoError *error);

#endif
