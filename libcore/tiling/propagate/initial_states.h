/* What slots may hold before anything is propagated: Algorithm 2 of MesoGen before its Collapse. */
#ifndef MESO_INITIAL_STATES_H
#define MESO_INITIAL_STATES_H

#include "libcore/tiling/problem/tiling_problem.h"
#include "libcore/tiling/propagate/domain.h"

/* Label codes that border rules allow on a side; `labels` [label words], zeroed. */
void meso_border_labels(const MesoTileSet *set, bool border, uint64_t *labels);

/*
 * The variants that border rules and constraints allow at each slot, whatever its neighbours hold.
 * Slots alike in borders and constraints share a state.
 *
 * state       [slot_count] result
 * dead_count  result: slots that nothing fits
 *
 * MESO_ERR_MEMORY alone. O(slots + kinds of slots * variants).
 */
MesoStatus meso_initial_states(uint32_t *state, uint32_t *dead_count, MesoDomainTable *domains, MesoArena *scratch,
                               const MesoTilingProblem *problem, MesoError *error);

#endif
