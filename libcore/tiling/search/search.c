#include "libcore/tiling/search/search.h"

#include <assert.h>
#include <string.h>

#include "libcore/tiling/search/variant_choice.h"

enum { TICK_INTERVAL = 4096, PROBE_TICK_INTERVAL = 16 };    /* observations; slots */

/*
 * Radii of balls: from the first on, each after so many repairs without progress; then the first again. Large balls
 * help where structures are long, small ones where tiles are many and few fit: attempts take turns.
 */
enum { FIRST_RADIUS = 2, REPAIRS_AT_RADIUS = 3, LARGE_RADIUS = 24, SMALL_RADIUS = 8 };

/*
 * What an attempt may do: the first one little, for where solutions are many it is enough and where there are
 * none it is lost; later ones more and more.
 */
typedef struct Effort {
    uint32_t jumps;             /* back, without progress, before a repair */
    uint32_t repairs;           /* without progress */
    uint32_t radius;            /* of balls, at most, but where a smaller one is dead at once */
    uint64_t slots;             /* that are reopened, and as many jumps, in all */
} Effort;

enum { FIRST_JUMPS = 1, MOST_JUMPS = 64, FIRST_REPAIRS = 69, MOST_REPAIRS = 8192 };
enum { FIRST_FACTOR = 8, MOST_FACTOR = 256, LEAST_SLOTS = 2000 };

static uint32_t grown(uint32_t first, uint32_t most, uint32_t times, uint32_t bits)
{
    while (times-- > 0 && first < most)
        first <<= bits;
    return first < most ? first : most;
}

/* For a surface of `slot_count` slots, after `before` attempts. */
static Effort effort_for(uint32_t slot_count, uint32_t before)
{
    return (Effort){
        .jumps = grown(FIRST_JUMPS, MOST_JUMPS, before, 2),
        .repairs = grown(FIRST_REPAIRS, MOST_REPAIRS, before, 2),
        .radius = before % 2 ? SMALL_RADIUS : LARGE_RADIUS,
        .slots = (uint64_t)grown(FIRST_FACTOR, MOST_FACTOR, before, 1) * slot_count + LEAST_SLOTS,
    };
}

typedef struct Attempt {
    Effort effort;
    uint64_t reopened, jumped;  /* slots; times */
    uint32_t fewest_open;       /* slots with a choice left, at the best moment so far */
    uint32_t repairs;           /* since then */
    uint32_t jumps;             /* since then, or since a repair */
    bool at_root;               /* nothing was chosen yet; what was taken away was refuted */
    bool dead_end_told;
} Attempt;

static bool is_told_to_stop(const MesoSearch *search)
{
    return search->tick && !search->tick(search->context);
}

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
    uint32_t radii = attempt->effort.radius - FIRST_RADIUS + 1;
    uint32_t radius = FIRST_RADIUS + attempt->repairs / REPAIRS_AT_RADIUS % radii;
    if (attempt->repairs++ == attempt->effort.repairs)
        return MESO_OK;
    for (; attempt->reopened < attempt->effort.slots; radius++) {
        uint32_t count;
        if (meso_propagation_reopen(propagation, slot, radius, &count, error))
            return MESO_ERR_MEMORY;
        attempt->reopened += count;
        search->repairs++;
        if (propagation->dead_slot == MESO_NO_INDEX) {
            attempt->jumps = 0;
            *repaired = true;
            return MESO_OK;
        }
        if (meso_propagation_undo(propagation, error))
            return MESO_ERR_MEMORY;
        if (count > TICK_INTERVAL && is_told_to_stop(search))
            break;
    }
    return MESO_OK;
}

/* Takes `variant`, which led to a dead end, away from `slot`, and notes why; the step that gave it is taken back. */
static MesoStatus exclude(MesoSearch *search, uint32_t slot, uint32_t variant, const MesoConflict *conflict,
                          MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    if (meso_propagation_exclude(propagation, slot, variant, error))
        return MESO_ERR_MEMORY;
    /* The first of the decisions is the one that was taken back. */
    if (conflict->count)
        meso_cause_log_conclude(propagation->causes, conflict->decisions + 1, conflict->count - 1, conflict->whole);
    return MESO_OK;
}

/*
 * After a dead end from an exclusion: back to the latest decision that it hangs on, and on with the
 * exclusion of that, as long as this leads to a dead end too. The states are consistent after it.
 */
static MesoStatus jump_back(MesoSearch *search, Attempt *attempt, MesoSearchOutcome *outcome, bool *jumped,
                            MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    MesoCauseLog *causes = propagation->causes;
    MesoConflict conflict;
    while (propagation->dead_slot != MESO_NO_INDEX) {
        meso_propagation_explain(propagation, &conflict);
        if (conflict.count == 0 && conflict.whole) {
            search->impossible_slot = propagation->dead_slot;
            *outcome = MESO_SEARCH_IMPOSSIBLE;
            return MESO_OK;
        }
        if (conflict.count == 0 || attempt->jumps == attempt->effort.jumps ||
            attempt->jumped == attempt->effort.slots)
            return meso_propagation_undo(propagation, error);
        uint32_t step = meso_cause_log_find(causes, conflict.decisions[0]);
        uint32_t slot = causes->changes[causes->steps[step].first].slot, variant = causes->steps[step].variant;
        attempt->jumps++;
        attempt->jumped++;
        search->jumps++;
        if (meso_propagation_jump(propagation, step, error) || exclude(search, slot, variant, &conflict, error))
            return MESO_ERR_MEMORY;
    }
    *jumped = true;
    return MESO_OK;
}

/* A log of causes costs a little: it begins with the first dead end. It knows nothing of causes beyond the
 * neighbours. */
static MesoStatus begin_cause_log(MesoPropagation *propagation, MesoError *error)
{
    assert(propagation->quotas.count == 0 && !propagation->tracing && !propagation->decided);
    propagation->causes = MESO_NEW(propagation->arena, MesoCauseLog, 1, error);
    if (!propagation->causes)
        return MESO_ERR_MEMORY;
    meso_cause_log_clear(propagation->causes, true);
    return MESO_OK;
}

/* After a dead end from `variant` at `slot`; sets `outcome` where the attempt is over. */
static MesoStatus retreat(MesoSearch *search, Attempt *attempt, uint32_t slot, uint32_t variant,
                          MesoSearchOutcome *outcome, MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    uint32_t dead_slot = propagation->dead_slot;
    MesoConflict conflict;
    if (search->dead_end) {
        MesoStatus status = search->dead_end(search->context, dead_slot, !attempt->dead_end_told, error);
        if (status)
            return status;
    }
    attempt->dead_end_told = true;
    if (!propagation->causes && begin_cause_log(propagation, error))
        return MESO_ERR_MEMORY;
    /* The first attempt jumps so little that it does not pay to know why. */
    conflict.count = 0;
    if (attempt->effort.jumps > FIRST_JUMPS)
        meso_propagation_explain(propagation, &conflict);
    if (meso_propagation_undo(propagation, error) || exclude(search, slot, variant, &conflict, error))
        return MESO_ERR_MEMORY;
    if (propagation->dead_slot == MESO_NO_INDEX)
        return MESO_OK;
    if (attempt->at_root) {
        search->impossible_slot = slot;
        search->impossible_at_once = true;
        *outcome = MESO_SEARCH_IMPOSSIBLE;
        return MESO_OK;
    }
    bool jumped = false, repaired = false;
    MesoStatus status = jump_back(search, attempt, outcome, &jumped, error);
    if (status || jumped || *outcome == MESO_SEARCH_IMPOSSIBLE)
        return status;
    /* Where the trouble came up, whatever the jumps led to. */
    status = repair(search, attempt, dead_slot, &repaired, error);
    if (!repaired)
        *outcome = is_told_to_stop(search) ? MESO_SEARCH_STOPPED : MESO_SEARCH_STUCK;
    return status;
}

static bool may_go_on(const MesoSearch *search)
{
    if (search->observations >= search->max_observations)
        return false;
    return search->observations % TICK_INTERVAL != 0 || !is_told_to_stop(search);
}

MesoStatus meso_search_attempt(MesoSearch *search, MesoSearchOutcome *outcome, MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    Attempt attempt = {.fewest_open = propagation->queue.count, .at_root = true,
                       .effort = effort_for(propagation->graph->slot_count, search->attempts_before)};
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
            attempt.repairs = attempt.jumps = 0;
            if (propagation->queue.count < search->fewest_open)
                search->fewest_open = propagation->queue.count;
        }
    }
    return MESO_OK;
}

/* Whether a variant before `variant` in the state of `slot` shows the same labels, so that it was probed for both. */
static bool probed_before(const MesoPropagation *propagation, uint32_t slot, uint32_t variant)
{
    const uint64_t *bits = meso_domain_bits(&propagation->domains, propagation->state[slot]);
    const uint32_t *codes = propagation->codes + 4 * (size_t)variant;
    for (uint32_t v = 0; v < variant; v++)
        if (meso_bits_test(bits, v) && memcmp(codes, propagation->codes + 4 * (size_t)v, 4 * sizeof *codes) == 0)
            return true;
    return false;
}

/* Takes from `slot` the variants that lead to a dead end; `*impossible` where it has no other. */
static MesoStatus probe_slot(MesoSearch *search, uint32_t slot, uint64_t *work, uint64_t *excluded,
                             bool *impossible, MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    for (uint32_t v = 0; v < propagation->domains.variant_count; v++) {
        uint32_t state = propagation->state[slot];
        if (propagation->domains.domains[state].size == 1)
            return MESO_OK;
        if (!meso_bits_test(meso_domain_bits(&propagation->domains, state), v) ||
            probed_before(propagation, slot, v))
            continue;
        bool dead;
        uint32_t changes;
        if (meso_propagation_try(propagation, slot, v, &dead, &changes, error))
            return MESO_ERR_MEMORY;
        *work += changes;
        if (!dead)
            continue;
        if (meso_propagation_exclude(propagation, slot, v, error))
            return MESO_ERR_MEMORY;
        ++*excluded;
        *impossible = propagation->dead_slot != MESO_NO_INDEX;
        if (*impossible)
            return MESO_OK;
    }
    return MESO_OK;
}

MesoStatus meso_search_probe(MesoSearch *search, uint64_t work_limit, MesoSearchOutcome *outcome,
                             MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    uint64_t work = 0, excluded = 1;
    bool impossible = false;
    *outcome = MESO_SEARCH_STUCK;
    propagation->causes = NULL;    /* steps that are taken back at once need none */
    meso_propagation_restart(propagation);
    while (excluded > 0 && work < work_limit) {
        excluded = 0;
        for (uint32_t s = 0; s < propagation->graph->slot_count && work < work_limit; s++) {
            if (probe_slot(search, s, &work, &excluded, &impossible, error))
                return MESO_ERR_MEMORY;
            if (impossible) {
                search->impossible_slot = s;
                *outcome = MESO_SEARCH_IMPOSSIBLE;
                return MESO_OK;
            }
            if (s % PROBE_TICK_INTERVAL == 0 && search->tick && !search->tick(search->context)) {
                *outcome = MESO_SEARCH_STOPPED;
                return MESO_OK;
            }
        }
    }
    meso_propagation_settle(propagation);
    return MESO_OK;
}
