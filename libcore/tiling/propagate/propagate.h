/*
 * Propagation: the states of all slots, kept consistent across every edge, as
 * Collapse and InitialConstraints of MesoGen (Algorithms 1 and 2), with a work
 * list in the place of the recursion.
 */
#ifndef MESO_PROPAGATE_H
#define MESO_PROPAGATE_H

#include "libcore/tiling/problem/tiling_problem.h"
#include "libcore/tiling/propagate/bucket_queue.h"
#include "libcore/tiling/propagate/cause_log.h"
#include "libcore/tiling/propagate/domain.h"
#include "libcore/tiling/propagate/quota.h"
#include "libcore/tiling/propagate/work_list.h"

typedef struct MesoTrailEntry {
    uint32_t slot, state;       /* that it had before */
} MesoTrailEntry;

typedef struct MesoTrail {
    MesoTrailEntry *entries;    /* [room] */
    size_t count, room;
} MesoTrail;

typedef struct MesoPropagation {
    const MesoSlotGraph *graph;
    const MesoTileSet *set;
    MesoArena *arena;           /* of trail and history, which grow */

    /* What slots hold. */
    MesoDomainTable domains;
    uint32_t *codes;            /* [4 * variant_count] label codes */
    uint32_t *state;            /* [slot_count] */
    uint32_t *initial;          /* [slot_count] the fixed point before any choice */
    uint32_t initial_dead_count;    /* slots that hold the empty state from the start */
    uint32_t collect_at;        /* number of states that calls for a collection */
    MesoBucketQueue queue;      /* slots with a choice left */
    bool searching;             /* the initial fixed point is reached */
    bool queue_rests;           /* while a step is made that is taken back at once */

    /* What is to be told. */
    MesoWorkList list;          /* slots with pending sides */
    uint8_t *pending;           /* [slot_count] sides whose news the neighbour has not got, and marks */

    /* What the last call met. */
    uint32_t dead_slot;         /* or MESO_NO_INDEX */
    uint32_t dead_teller;       /* its neighbour whose news left it nothing */
    uint32_t broken_quota;      /* or MESO_NO_INDEX */

    /* What may have to be taken back. */
    MesoTrail trail;            /* what the last step changed, each slot once */
    uint32_t *touched;          /* [slot_count] slots whose state is not the initial one */
    uint32_t touched_count;
    bool tracing;               /* keep a history, for meso_propagation_rewind() */
    MesoTrail history;          /* every change since the last restart, or the last collection */
    uint32_t generation;        /* of the history: marks of an earlier one are void */
    MesoCauseLog *causes;       /* of the steps, where the search keeps one; or NULL */

    /* What constraints ask for. */
    MesoQuotaTrack quotas;      /* none without constraints */
    uint32_t *decided;          /* [slot_count] slots that came to a single variant since the initial
                                   fixed point, in order; NULL where no rule on strands asks for it */
    uint32_t decided_count;
} MesoPropagation;

/*
 * Gives every slot the variants that border rules and constraints
 * allow there, and propagates to the fixed point. A slot that this empties is
 * proved dead: it counts in `initial_dead_count`, and propagation goes on
 * around it as if it were not there, so that all of them are found. Where there
 * is none, quotas join the propagation; `broken_quota` is one that proves to be
 * out of reach. What `propagation` points to must outlive it; arrays live in
 * `arena`. MESO_ERR_MEMORY alone; meso_propagation_release() is due in any case. O(slots) for a set at hand.
 */
MesoStatus meso_propagation_init(MesoPropagation *propagation, MesoArena *arena,
                                 const MesoTilingProblem *problem, MesoError *error);

void meso_propagation_release(MesoPropagation *propagation);

/*
 * A step: reduces `slot` to `variant` of its state and propagates to the fixed
 * point, or until a slot has nothing left: `dead_slot`, which then keeps the
 * state it had before; or until a quota cannot be met any more: `broken_quota`.
 * After either, undo, reopen, rewind or restart.
 */
MesoStatus meso_propagation_assign(MesoPropagation *propagation, uint32_t slot, uint32_t variant,
                                   MesoError *error);

/* As meso_propagation_assign(), a step that takes `variant` away; it must leave another. */
MesoStatus meso_propagation_exclude(MesoPropagation *propagation, uint32_t slot, uint32_t variant,
                                    MesoError *error);

/* Takes the last step back, and what followed from it. O(slots that it changed). */
MesoStatus meso_propagation_undo(MesoPropagation *propagation, MesoError *error);

/*
 * Takes back the steps in the log from steps[step] on. Where a step was left at a dead
 * slot, in the place of meso_propagation_undo(). Not with quotas, nor where tracing.
 * O(changes). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_propagation_jump(MesoPropagation *propagation, uint32_t step, MesoError *error);

/* The decisions that the dead slot at hand hangs on. With a log of causes, and without quotas. */
void meso_propagation_explain(const MesoPropagation *propagation, MesoConflict *conflict);

/*
 * Makes the step meso_propagation_assign() and takes it back, not where tracing: whether it meets a
 * dead slot, and how many slots it changes.
 */
MesoStatus meso_propagation_try(MesoPropagation *propagation, uint32_t slot, uint32_t variant, bool *dead,
                                uint32_t *changes, MesoError *error);

/*
 * A step that gives the slots up to `radius` edges around `slot` their initial
 * states again, as far as the slots around them allow. `reopened` gets their
 * number. The states must be consistent.
 */
MesoStatus meso_propagation_reopen(MesoPropagation *propagation, uint32_t slot, uint32_t radius,
                                   uint32_t *reopened, MesoError *error);

/* A place in the history of a propagation that is `tracing`: for more than the last step. */
typedef struct MesoPropagationMark {
    size_t history_count;
    uint32_t decided_count, generation;
} MesoPropagationMark;

/* Marks the present place, for the call that follows. MESO_ERR_MEMORY alone. */
MesoStatus meso_propagation_mark(MesoPropagation *propagation, MesoPropagationMark *mark, MesoError *error);

/*
 * Takes back what was done since `mark`. `*done` is false, and nothing is, where a restart or a
 * collection of states has voided the mark. O(changes). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_propagation_rewind(MesoPropagation *propagation, MesoPropagationMark mark, bool *done,
                                   MesoError *error);

/* Forgets the history: what was done so far is there to stay, and marks are void. */
void meso_propagation_forget(MesoPropagation *propagation);

/*
 * Takes the present states, which must be consistent, for the initial ones: what
 * was excluded so far was proved to be impossible. Not where tracing. O(slots).
 */
void meso_propagation_settle(MesoPropagation *propagation);

/* Back to the initial fixed point. O(slots touched). */
void meso_propagation_restart(MesoPropagation *propagation);

/* Labels that the neighbour across side `side` of `slot` lets it show there. */
const uint64_t *meso_propagation_allowed(const MesoPropagation *propagation, uint32_t slot,
                                         uint32_t side);

/* Labels that the far side of `half_edge` may show, as far as the initial state of its own slot says. */
static inline const uint64_t *meso_propagation_labels(const MesoPropagation *propagation, uint32_t half_edge)
{
    const MesoDomain *domain = &propagation->domains.domains[propagation->initial[half_edge / 4]];
    return meso_domain_labels(&propagation->domains, domain->allow[half_edge % 4]);
}

static inline uint32_t meso_propagation_label_count(const MesoPropagation *propagation, uint32_t half_edge)
{
    return meso_bits_count(meso_propagation_labels(propagation, half_edge), propagation->domains.sets.word_count);
}

#endif
