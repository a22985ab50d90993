/*
 * Solver: Algorithms 1 and 2 of MesoGen (section 3.3), wave function collapse
 * on label domains. A slot's domain is a bit set of variants; what passes
 * across a side is the set of signed labels that the domain shows there. What
 * that does not decide goes to counting arguments (counting.h, parity.h) and
 * then to the exact engine (exact.h).
 */
#ifndef MESO_SOLVE_H
#define MESO_SOLVE_H

#include "libcore/tiling/solve/solve_result.h"

/*
 * Assigns variants to slots. The result depends on the arguments alone, unless
 * `stop` ended the work. A solved assignment has passed meso_assignment_check() and
 * meso_constraints_check(). Returns MESO_OK for every verdict; MESO_ERR_MEMORY, or
 * MESO_ERR_INPUT for a set without variants. Memory O(slots * (words of variants + words of labels)).
 */
MesoStatus meso_solve(MesoSolveResult *result, MesoArena *arena, const MesoTilingProblem *problem,
                      const MesoSolveOptions *options, MesoError *error);

#endif
