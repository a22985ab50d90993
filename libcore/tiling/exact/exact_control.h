/*
 * Quotas and rules on strands for the exact engine. Quotas are counted by a
 * sorting network (sorting_network.h) over the slots that may hold one of their
 * variants; rules on strands are left out at first, and each assignment that breaks one is cut off
 * with all others that have the same strand.
 */
#ifndef MESO_EXACT_CONTROL_H
#define MESO_EXACT_CONTROL_H

#include "libcore/sat/sorting_network.h"
#include "libcore/tiling/exact/exact.h"

/*
 * Groups of variants for MesoExactOptions that tell apart what the constraints
 * do, in `arena`: `*group` is NULL where they tell nothing apart.
 */
MesoStatus meso_exact_groups(const uint32_t **group, MesoArena *arena, const MesoConstraints *constraints,
                             uint32_t variant_count, MesoError *error);

/* The formula, for meso_sort_literals(). */
MesoClauses meso_exact_clauses(MesoExact *exact);

/*
 * Adds the quotas. `*complete` becomes false where one is left out, because over
 * 16384 slots may hold one of its variants or not, or there would be too many
 * variables: an assignment may break it then. O(slots * log^2(slots)) for each quota.
 */
MesoStatus meso_exact_add_quotas(MesoExact *exact, const MesoConstraints *constraints, bool *complete,
                                 MesoError *error);

/*
 * Cuts off what in variant[slot_count], a solution that meso_exact_extract()
 * gave under the groups above, breaks the rule on strands; `*count` gets the
 * number of cuts: none where it keeps to it. O(slots * log(slots)).
 */
MesoStatus meso_exact_cut_strands(MesoExact *exact, const MesoStrandRule *rule, const uint32_t *variant,
                                  const MesoVariantSet *variants, uint32_t *count, MesoError *error);

#endif
