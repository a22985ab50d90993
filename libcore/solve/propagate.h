/*
 * Propagation: the states of all slots, kept consistent across every edge, as
 * Collapse and InitialConstraints of MesoGen (Algorithms 1 and 2), with a work
 * list in the place of the recursion.
 */
#ifndef MESO_PROPAGATE_H
#define MESO_PROPAGATE_H

#include "libcore/solve/bucket_queue.h"
#include "libcore/solve/domain.h"
#include "libcore/surface/slot_graph.h"

typedef struct MesoTrailEntry {
    uint32_t slot, state;       /* that it had before */
} MesoTrailEntry;

typedef struct MesoPropagation {
    const MesoSlotGraph *graph;
    const MesoTileSet *set;
    MesoDomainTable domains;
    MesoBucketQueue queue;      /* slots with a choice left */
    uint32_t *codes;            /* [4 * variant_count] label codes */
    uint32_t *state;            /* [slot_count] */
    uint32_t *initial;          /* [slot_count] the fixed point before any choice */
    uint32_t *touched;          /* [slot_count] slots whose state is not the initial one */
    uint8_t *pending;           /* [slot_count] sides whose news the neighbour has not got, and marks */
    uint32_t *list;             /* [slot_count] ring of the slots with pending sides */
    MesoArena *arena;           /* of the trail, which grows */
    MesoTrailEntry *trail;        /* [trail_capacity] what the last step changed, each slot once */
    uint32_t trail_count, trail_capacity;
    uint32_t touched_count;
    uint32_t list_head, list_count;
    uint32_t dead_slot;         /* met by the last call, or MESO_NO_INDEX */
    uint32_t initial_dead_count;    /* slots that hold the empty state from the start */
    uint32_t collect_at;        /* number of states that calls for a collection */
    bool searching;             /* the initial fixed point is reached */
} MesoPropagation;

/* Label codes that border rules allow on a side; `labels` [label words]. */
void meso_border_labels(const MesoTileSet *set, bool border, uint64_t *labels);

/*
 * Gives every slot the variants that border rules allow there, and propagates
 * to the fixed point. A slot that this empties is proved dead: it counts in
 * `initial_dead_count`, and propagation goes on around it as if it were not
 * there, so that all of them are found. What `propagation` points to must
 * outlive it; arrays live in `arena`. MESO_ERR_MEMORY alone;
 * meso_propagation_release() is due in any case. O(slots) for a set at hand.
 */
MesoStatus meso_propagation_init(MesoPropagation *propagation, MesoArena *arena,
                                 const MesoTileSet *set, const MesoVariantSet *variants,
                                 const MesoSlotGraph *graph, MesoError *error);

void meso_propagation_release(MesoPropagation *propagation);

/*
 * A step: reduces `slot` to `variant` of its state and propagates to the fixed
 * point, or until a slot has nothing left: `dead_slot`, which then keeps the
 * state it had before. After a dead slot, undo, reopen or restart.
 */
MesoStatus meso_propagation_assign(MesoPropagation *propagation, uint32_t slot, uint32_t variant,
                                   MesoError *error);

/* As meso_propagation_assign(), a step that takes `variant` away; it must leave another. */
MesoStatus meso_propagation_exclude(MesoPropagation *propagation, uint32_t slot, uint32_t variant,
                                    MesoError *error);

/* Takes the last step back, and what followed from it. O(slots that it changed). */
MesoStatus meso_propagation_undo(MesoPropagation *propagation, MesoError *error);

/*
 * A step that gives the slots up to `radius` edges around `slot` their initial
 * states again, as far as the slots around them allow. `reopened` gets their
 * number. The states must be consistent.
 */
MesoStatus meso_propagation_reopen(MesoPropagation *propagation, uint32_t slot, uint32_t radius,
                                   uint32_t *reopened, MesoError *error);

/* Back to the initial fixed point. O(slots touched). MESO_ERR_MEMORY alone. */
MesoStatus meso_propagation_restart(MesoPropagation *propagation, MesoError *error);

/* Labels that the neighbour across side `side` of `slot` lets it show there. */
const uint64_t *meso_propagation_allowed(const MesoPropagation *propagation, uint32_t slot,
                                         uint32_t side);

#endif
