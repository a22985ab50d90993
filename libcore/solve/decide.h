/* The ladder's last rungs: verdicts without a search of our own. */
#ifndef MESO_DECIDE_H
#define MESO_DECIDE_H

#include "libcore/solve/exact.h"
#include "libcore/solve/solve.h"

/*
 * Counting, then parity (counting.h, parity.h), on the initial states: cheap where
 * they prove something, and often hopeless for the exact engine. Sets verdict, decider
 * and reason of `result` where they do; the reason lives in `arena`. MESO_ERR_MEMORY
 * alone.
 */
MesoStatus meso_decide_by_numbers(MesoSolveResult *result, MesoArena *arena, MesoArena *scratch,
                                  const MesoPropagation *propagation, MesoError *error);

/*
 * The exact engine on the initial states, with phases from the present ones. Sets
 * verdict and decider of `result`; where solved, variant[slot_count] is the solution.
 * Quotas, rules on strands and variants to keep are not known to it.
 */
MesoStatus meso_decide_exactly(MesoSolveResult *result, uint32_t *variant, MesoArena *scratch,
                               const MesoPropagation *propagation, const MesoSolveOptions *options,
                               MesoError *error);

#endif
