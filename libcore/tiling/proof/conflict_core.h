/*
 * Conflict cores: a least set of slots, border rules, restrictions and quotas found
 * that cannot hold together, whatever the rest of the surface does. From the
 * assumptions of core_formula.h that fail, on balls of slots that grow until one
 * contradicts itself; then items are left out one by one, as long as what is left
 * still does (deletion, as in Marques-Silva, "Minimal unsatisfiability: models,
 * algorithms and applications", 2010).
 */
#ifndef MESO_CONFLICT_CORE_H
#define MESO_CONFLICT_CORE_H

#include "libcore/tiling/proof/core_formula.h"

typedef struct MesoCoreRule {
    uint32_t interface;
    bool only;                  /* may lie on a border only; else must not lie on one */
} MesoCoreRule;

typedef struct MesoConflictCore {
    bool found;
    bool minimal;               /* without any one of these there is no conflict among the rest */
    uint32_t slot_count, rule_count, constraint_count, tile_count;
    uint32_t *slots;            /* [slot_count] ascending; none: it is not said which have a part */
    MesoCoreRule *rules;        /* [rule_count] by interface */
    uint32_t *constraints;      /* [constraint_count] by number, ascending */
    uint32_t *tiles;            /* [tile_count] that the rules and constraints allow on one of the slots */
} MesoConflictCore;

/* Effort, counted so that the result does not depend on the clock. Zero is the default: a second or two. */
typedef struct MesoCoreLimits {
    uint32_t slots;             /* of the largest ball */
    uint32_t conflicts;         /* in all; fewer where formulas are large */
} MesoCoreLimits;

/*
 * Looks for a core around slot `near`, or on the whole surface where that is
 * MESO_NO_INDEX and the surface is within the limits. `core->found` is false where
 * there is none within reach, or none found that is either minimal or small: that
 * says nothing. Restrictions are left out of it where there is a conflict without
 * them in the same ball, and quotas too. The rule on strands is not looked at. The
 * arrays of `core` go to `arena`. The result depends on the arguments alone. MESO_ERR_MEMORY or MESO_ERR_INTERNAL.
 */
MesoStatus meso_conflict_core_find(MesoConflictCore *core, MesoArena *arena, const MesoTilingProblem *problem,
                                   uint32_t near, const MesoCoreLimits *limits, MesoError *error);

/* Whether rules and constraints of `core` let `variant` stand at `slot`, whatever its neighbours. */
bool meso_conflict_core_admits(const MesoConflictCore *core, const MesoTilingProblem *problem, uint32_t slot,
                               uint32_t variant);

#endif
