/* Reasons of verdicts in words, for the user. */
#ifndef MESO_VERDICT_TEXT_H
#define MESO_VERDICT_TEXT_H

#include "libcore/tiling/propagate/quota.h"
#include "libcore/tiling/solve/solve_result.h"

/*
 * A core that was found: "no tiles fit together on slots 3 and 4, with pins[0],
 * where interface 'rim' may lie on a border only: only 'knot' fits slot 3; each of
 * these is needed". In `arena`; NULL: out of memory.
 */
const char *meso_core_text(MesoArena *arena, const MesoTilingProblem *problem, const MesoConflictCore *core,
                           MesoError *error);

/* Why the quota that the initial propagation broke is out of reach, in numbers. In `arena`; NULL: out of memory. */
const char *meso_broken_quota_text(MesoArena *arena, const MesoQuotaTrack *track, uint32_t quota, MesoError *error);

/*
 * A result that gave up: the budget that ended it, how far it came, where it
 * failed most. In `arena`; NULL: out of memory.
 */
const char *meso_gave_up_text(MesoArena *arena, const MesoSolveResult *result, const MesoTilingProblem *problem,
                              MesoError *error);

/*
 * `text` and, after "; ", the constraint that the search met most often: `text`
 * alone where it met none. In `arena`; NULL: out of memory.
 */
const char *meso_violations_text(MesoArena *arena, const char *text, const MesoSolveResult *result,
                                 const MesoConstraints *constraints, MesoError *error);

#endif
