/*
 * A part of a tiling problem as a propositional formula in which every demand
 * can be left out. Items are the demands: that a slot has one of its tiles,
 * that an interface keeps to its border rule, that a restriction or a quota holds.
 * Each has a literal to assume; without it the item has no clauses that matter. That
 * sides match across an edge is no item: it asks nothing of a slot without a tile.
 * To a quota such a slot, as well as one outside the part, may count or not.
 *
 * The domains are not propagated: what follows from what is left to the solver,
 * so that the assumptions that fail are all that a contradiction needs. Compare
 * exact.h, whose formula starts from the fixed point.
 */
#ifndef MESO_CORE_FORMULA_H
#define MESO_CORE_FORMULA_H

#include "libcore/sat/cadical_adapter.h"
#include "libcore/tiling/problem/tiling_problem.h"

/* Items by number: all slots of the graph, two border rules for each interface, restrictions and then quotas. */
static inline uint32_t meso_core_rule_item(const MesoTilingProblem *problem, uint32_t interface, bool only)
{
    return problem->graph->slot_count + 2 * interface + only;
}

static inline uint32_t meso_core_constraint_item(const MesoTilingProblem *problem, uint32_t constraint)
{
    return problem->graph->slot_count + 2 * problem->set->interface_count + constraint;
}

typedef struct MesoCoreFormula {
    const MesoTilingProblem *problem;
    MesoSat *sat;
    uint32_t slot_count;
    const uint32_t *slots;      /* [slot_count] of the graph */
    uint32_t *rank;             /* [slots of the graph] index into `slots`, or MESO_NO_INDEX; the caller's */
    uint64_t size;              /* literals of all clauses */
} MesoCoreFormula;

/*
 * Builds the formula for `slots` [slot_count]; a side towards any other slot may
 * show everything that border rules allow on an inner side.
 *
 * rank  [slots of the graph] all MESO_NO_INDEX; so again after the release
 *
 * What `problem` and `slots` point to must outlive it. meso_core_formula_release()
 * is due in any case. O(slots * variants + places), and
 * O(slots * log^2(slots)) for each quota that the part alone can break. Quotas are
 * left out where that adds up to much: as if they were never assumed. MESO_ERR_MEMORY or MESO_ERR_INTERNAL.
 */
MesoStatus meso_core_formula_init(MesoCoreFormula *formula, const MesoTilingProblem *problem,
                                  const uint32_t *slots, uint32_t slot_count, uint32_t *rank,
                                  MesoError *error);

void meso_core_formula_release(MesoCoreFormula *formula);

/* The literal to assume for `item`; a slot must be one of the formula's. */
int32_t meso_core_formula_literal(const MesoCoreFormula *formula, uint32_t item);

/* Whether `variant` may stand at `slot` as far as `restriction` goes, which has `place` there: a slot or half-edge. */
bool meso_core_allows(const MesoTilingProblem *problem, const MesoRestriction *restriction, uint32_t place,
                      uint32_t variant);

#endif
