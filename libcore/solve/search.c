#include "libcore/solve/search.h"

#include "libcore/solve/choice.h"

enum { TICK_INTERVAL = 4096 };  /* observations */

/* Radius of the first ball, and after how many repairs without progress it grows by one. */
enum { FIRST_RADIUS = 2, PATIENCE = 3, MOST_RADIUS = 24 };

/* Slots that an attempt may reopen: so many times their number, and a few more. */
enum { REOPEN_FACTOR = 8, REOPEN_LEAST = 2000 };

typedef struct Attempt {
    uint64_t reopened;
    uint32_t fewest_open;       /* slots with a choice left, at the best moment so far */
    uint32_t failures;          /* repairs since then */
    bool at_root;               /* nothing was chosen yet; what was taken away was refuted */
    bool dead_end_told;
} Attempt;

static MesoStatus observe(MesoSearch *search, uint32_t *slot, uint32_t *variant, MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    *slot = meso_bucket_queue_draw(&propagation->queue, &search->random);
    *variant = meso_choose_variant(propagation, search->constraints, *slot, false, &search->random);
    search->observations++;
    return meso_propagation_assign(propagation, *slot, *variant, error);
}

/* Reopens growing balls around `slot` until one is consistent with what is around it. */
static MesoStatus repair(MesoSearch *search, Attempt *attempt, uint32_t slot, bool *repaired, MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    uint64_t limit = (uint64_t)REOPEN_FACTOR * propagation->graph->slot_count + REOPEN_LEAST;
    uint32_t radius = FIRST_RADIUS + attempt->failures++ / PATIENCE;
    for (; radius <= MOST_RADIUS && attempt->reopened < limit; radius++) {
        uint32_t count;
        if (meso_propagation_reopen(propagation, slot, radius, &count, error))
            return MESO_ERR_MEMORY;
        attempt->reopened += count;
        search->repairs++;
        if (propagation->dead_slot == MESO_NO_INDEX) {
            *repaired = true;
            return MESO_OK;
        }
        if (meso_propagation_undo(propagation, error))
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

/* After a dead end from `variant` at `slot`; sets `outcome` where the attempt is over. */
static MesoStatus retreat(MesoSearch *search, Attempt *attempt, uint32_t slot, uint32_t variant,
                          MesoSearchOutcome *outcome, MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    uint32_t dead_slot = propagation->dead_slot;
    if (search->dead_end && !attempt->dead_end_told) {
        MesoStatus status = search->dead_end(search->context, dead_slot, error);
        if (status)
            return status;
    }
    attempt->dead_end_told = true;
    if (meso_propagation_undo(propagation, error) ||
        meso_propagation_exclude(propagation, slot, variant, error))
        return MESO_ERR_MEMORY;
    if (propagation->dead_slot == MESO_NO_INDEX)
        return MESO_OK;
    if (attempt->at_root) {
        search->impossible_slot = slot;
        *outcome = MESO_SEARCH_IMPOSSIBLE;
        return MESO_OK;
    }
    if (meso_propagation_undo(propagation, error))
        return MESO_ERR_MEMORY;
    bool repaired = false;
    MesoStatus status = repair(search, attempt, dead_slot, &repaired, error);
    if (!repaired)
        *outcome = MESO_SEARCH_STUCK;
    return status;
}

static bool may_go_on(const MesoSearch *search)
{
    if (search->observations >= search->max_observations)
        return false;
    return search->observations % TICK_INTERVAL != 0 || !search->tick || search->tick(search->context);
}

MesoStatus meso_search_attempt(MesoSearch *search, MesoSearchOutcome *outcome, MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    Attempt attempt = {.fewest_open = propagation->queue.count, .at_root = true};
    *outcome = MESO_SEARCH_DONE;
    while (propagation->queue.count && *outcome == MESO_SEARCH_DONE) {
        uint32_t slot, variant;
        if (!may_go_on(search)) {
            *outcome = MESO_SEARCH_STOPPED;
            return MESO_OK;
        }
        if (observe(search, &slot, &variant, error))
            return MESO_ERR_MEMORY;
        if (propagation->dead_slot != MESO_NO_INDEX) {
            MesoStatus status = retreat(search, &attempt, slot, variant, outcome, error);
            if (status)
                return status;
            continue;
        }
        attempt.at_root = false;
        if (propagation->queue.count < attempt.fewest_open) {
            attempt.fewest_open = propagation->queue.count;
            attempt.failures = 0;
        }
    }
    return MESO_OK;
}
