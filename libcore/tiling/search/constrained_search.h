/*
 * Guided search: attempts under constraints. Weights and quotas guide the
 * choice; where there are quotas, a rule on strands, or an assignment to keep,
 * a choice that comes to a dead end is taken back and excluded (chronological
 * backtracking), up to a limit for each attempt.
 */
#ifndef MESO_CONSTRAINED_SEARCH_H
#define MESO_CONSTRAINED_SEARCH_H

#include "libcore/tiling/search/hot_spots.h"
#include "libcore/tiling/search/strand_search.h"
#include "libcore/tiling/search/variant_choice.h"

typedef struct MesoConstrainedChoice {
    MesoPropagationMark mark;
    size_t strand_mark;
    uint32_t slot, variant;
} MesoConstrainedChoice;

typedef struct MesoConstrainedSearch {
    MesoPropagation *propagation;
    const MesoConstraints *constraints;
    MesoArena *arena;
    MesoStrandSearch strands;
    size_t strand_base;         /* trail of the strands after the initial slots */
    uint32_t strands_seen;      /* decided slots that the strands have got */
    MesoConstrainedChoice *choices;
    uint32_t choice_count, choice_capacity;
    bool strands_broken;        /* by the last step */
    uint32_t generation;        /* of the propagation's history when the attempt's choices began */
    bool exhausted;             /* the last attempt took back all of its choices, and none was left: there
                                   is no assignment */
    uint8_t *released;          /* [slot_count] not to be kept any more; NULL where nothing is */
    uint32_t failures;          /* attempts that failed while variants were to be kept */
    uint64_t observations, backtracks;
    uint64_t *violations;       /* [meso_constraint_count()] the caller's; counted up */
    uint64_t max_observations;
    uint32_t fewest_open;       /* lowered to the slots with a choice left at the best moment */
    MesoHotSpots *hot_spots;    /* gets the dead slots; may be NULL */
    bool stopped;               /* the last attempt: out of observations, or told to stop */
    bool (*tick)(void *context);    /* called now and then; false stops the attempt; may be NULL */
    void *context;
} MesoConstrainedSearch;

/*
 * Prepares for attempts on `propagation`, which is at its initial fixed point
 * without dead slots or broken quotas. `*disproved` where slots decided there
 * violate the rule on strands. Arrays live in `arena`.
 */
MesoStatus meso_constrained_search_init(MesoConstrainedSearch *search, MesoArena *arena, MesoPropagation *propagation,
                            const MesoVariantSet *variants, const MesoConstraints *constraints,
                            uint64_t *violations, bool *disproved, MesoError *error);

/*
 * One attempt, from the initial fixed point: until all slots are decided
 * (`*solved`), or to a dead end that backtracking does not get out of: then
 * `dead_slot` of the propagation is the slot left with nothing, unless the
 * last of the conflicts was with a constraint. After a failure, the next
 * attempt keeps nothing in a ball around the place of the failure, twice as
 * wide each time.
 */
MesoStatus meso_constrained_search_attempt(MesoConstrainedSearch *search, MesoRandom *random, bool *solved,
                                           MesoError *error);

#endif
