/*
 * What a user demands of an assignment beyond matching sides: which variants
 * or labels may stand where, how often tiles may be used, how likely they
 * are, what strands may do, and which variants are to be kept. Names are
 * resolved: formats/tiling/constraints/constraints_file.h reads them from a file.
 */
#ifndef MESO_CONSTRAINTS_H
#define MESO_CONSTRAINTS_H

#include "libcore/base/bits.h"
#include "libcore/tiling/problem/assignment.h"
#include "libcore/tiling/problem/strands.h"
#include "libcore/tiling/problem/weights.h"

/* Pins, regions and border rules: at each place one of the allowed. */
typedef struct MesoRestriction {
    const char *name;           /* as messages name it: "pins[2] 'knob'" */
    bool sided;
    uint32_t place_count;
    const uint32_t *places;     /* [place_count] slots; half-edges (slot_graph.h) where `sided` */
    const uint64_t *allowed;    /* bit set of variants; of label codes (solve.h) where `sided` */
} MesoRestriction;

/* How many slots may hold one of some variants. */
typedef struct MesoQuota {
    const char *name;
    const uint64_t *variants;   /* bit set */
    uint32_t least, most;
} MesoQuota;

typedef struct MesoConstraints {
    uint32_t restriction_count, quota_count;
    const MesoRestriction *restrictions;
    const MesoQuota *quotas;
    MesoWeights weights;
    MesoStrandRule strands;
    const uint32_t *keep;       /* [slot_count] variant to keep, or MESO_NO_INDEX; NULL: none */
} MesoConstraints;

/* Constraints by number: restrictions first, then quotas, then the rule on strands. */
static inline uint32_t meso_constraint_count(const MesoConstraints *constraints)
{
    return constraints->restriction_count + constraints->quota_count +
           meso_strand_rule_given(&constraints->strands);
}

/* Whether they ask for more than domains and weights: for constrained_search.h. */
static inline bool meso_constraints_need_guidance(const MesoConstraints *constraints)
{
    return constraints->quota_count || constraints->keep || meso_strand_rule_given(&constraints->strands);
}

const char *meso_constraint_name(const MesoConstraints *constraints, uint32_t number);

/* What all restrictions together allow at each slot. */
typedef struct MesoSlotMasks {
    uint32_t mask_count;
    const uint64_t *masks;      /* [mask_count * words] bit sets of variants; the first has all */
    uint32_t *slot_mask;        /* [slot_count] */
} MesoSlotMasks;

/* Masks of `constraints`. O(slots + places * variants), less where places are alike. */
MesoStatus meso_slot_masks_build(MesoSlotMasks *masks, MesoArena *arena,
                                 const MesoConstraints *constraints,
                                 const MesoVariantSet *variants, uint32_t slot_count,
                                 MesoError *error);

/*
 * Checks an assignment that meso_assignment_check() has passed against every
 * constraint (not weights, nor what is to be kept), without any solver code.
 * MESO_ERR_INPUT names the first constraint that does not hold, with the slot.
 */
MesoStatus meso_constraints_check(const MesoConstraints *constraints,
                                  const MesoAssignment *assignment, const MesoTileSet *set,
                                  const MesoVariantSet *variants, const MesoSlotGraph *graph,
                                  MesoError *error);

/* Slots whose variant is not the one to keep, among those that have one. */
uint32_t meso_constraints_changed(const MesoConstraints *constraints,
                                  const MesoAssignment *assignment,
                                  const MesoVariantSet *variants);

#endif
