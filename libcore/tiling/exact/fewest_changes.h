/*
 * Keeps more: from an assignment that changes some of the variants to keep to one that
 * changes fewer, by the exact engine. The changes are counted by a sorting network, and
 * the engine is asked for fewer and fewer, in steps that grow while it finds some, until
 * it says that there are none. On a large surface slots far from every change stay as
 * they are.
 */
#ifndef MESO_FEWEST_CHANGES_H
#define MESO_FEWEST_CHANGES_H

#include "libcore/tiling/exact/exact.h"

/* Slots that may change, those nearest to the changes that there are; surfaces of more than the other are left
 * alone. */
enum { MESO_FEWEST_CHANGES_OPEN = 1 << 12, MESO_FEWEST_CHANGES_SLOTS = 1 << 16 };

typedef struct MesoFewestChangesOptions {
    uint64_t seed;
    uint64_t max_conflicts;     /* of the engine, in all */
    bool (*stop)(void *context);    /* may be NULL */
    void *stop_context;
} MesoFewestChangesOptions;

/*
 * variant     [slot_count] an assignment that holds to `constraints`, of the initial states of
 *             `propagation`; gets one that does too, and changes as many or fewer of constraints->keep
 * conflicts   gets those that the engine met
 *
 * `propagation` may get new states in its table. `*fewest` where no assignment is left that changes fewer. The result
 * depends on the arguments alone, unless `stop` ended the work. O(slots * patterns), and what the engine
 * takes. MESO_ERR_MEMORY, or what CaDiCaL fails with.
 */
MesoStatus meso_fewest_changes(uint32_t *variant, bool *fewest, uint64_t *conflicts, MesoPropagation *propagation,
                          const MesoVariantSet *variants, const MesoConstraints *constraints,
                          const MesoFewestChangesOptions *options, MesoError *error);

#endif
