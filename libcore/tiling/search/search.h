/*
 * Search: observes slots until all have one variant (Algorithm 1 of MesoGen). A
 * dead end is repaired in four steps, each where the one before does not help:
 * the variant that led to it is taken away from its slot; the search jumps back to the
 * latest decision that the dead end hangs on (conflict-directed backjumping), again and
 * again; a ball of slots around the dead one is reopened, growing while the search does not
 * get further; the attempt ends.
 */
#ifndef MESO_SEARCH_H
#define MESO_SEARCH_H

#include "libcore/tiling/propagate/propagate.h"

typedef enum MesoSearchOutcome {
    MESO_SEARCH_DONE,           /* every slot has one variant */
    MESO_SEARCH_STUCK,          /* the attempt's effort is spent */
    MESO_SEARCH_IMPOSSIBLE,     /* proved: there is a dead end that hangs on no decision */
    MESO_SEARCH_STOPPED         /* out of observations, or told to stop */
} MesoSearchOutcome;

typedef struct MesoSearch {
    MesoPropagation *propagation;
    const MesoConstraints *constraints;     /* of which the weights guide the choice; NULL: none */
    MesoRandom random;
    uint32_t attempts_before;   /* more of them, more patience */
    uint64_t observations;      /* made, over all attempts */
    uint64_t max_observations;
    uint64_t jumps;             /* back to decisions that a dead end hangs on, over all attempts */
    uint64_t repairs;           /* balls reopened, over all attempts */
    uint32_t impossible_slot;   /* a dead end that hangs on no decision */
    bool impossible_at_once;    /* each variant of the slot leads to a dead end before any other choice, given what
                                   was refuted like this before */
    uint32_t fewest_open;       /* lowered to the slots with a choice left at the best moment */
    bool (*tick)(void *context);    /* called now and then; false stops the search; may be NULL */
    MesoStatus (*dead_end)(void *context, uint32_t slot, bool first, MesoError *error); /* each that an
                                   observation leads to; the first of an attempt; may be NULL */
    void *context;
} MesoSearch;

/*
 * One attempt from the states as they are: the initial ones, for a proof of
 * MESO_SEARCH_IMPOSSIBLE to hold. Takes `random` further. MESO_ERR_MEMORY, or what
 * `dead_end` returns. `attempts_before` says how much effort is made: that many times the
 * slots, from 8 to 256, and a few more, are reopened at most, and as many jumps made.
 */
MesoStatus meso_search_attempt(MesoSearch *search, MesoSearchOutcome *outcome, MesoError *error);

/*
 * Probes each variant of each slot, from the initial states, and takes those for
 * good from the initial states that lead to a dead end at once; again, until none
 * does or `work_limit` changes of states are made. `outcome` is
 * MESO_SEARCH_STUCK where no slot is left without a variant. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_search_probe(MesoSearch *search, uint64_t work_limit, MesoSearchOutcome *outcome,
                             MesoError *error);

#endif
