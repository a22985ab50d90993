/* The rungs of the ladder that search. */
#include <string.h>

#include "libcore/tiling/propagate/initial_states.h"
#include "libcore/tiling/solve/ladder.h"
#include "libcore/tiling/solve/verdict_text.h"

/* RecordNeighbors: what a tile for `slot` would have to show. */
static MesoStatus record_dead_end(MesoLadder *ladder, uint32_t slot, uint32_t attempt, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    const MesoPropagation *propagation = &ladder->propagation;
    size_t words = result->label_word_count;

    result->dead_end_total++;
    if (result->dead_end_count == ladder->options->max_dead_ends)
        return MESO_OK;
    MesoDeadEnd *end = &result->dead_ends[result->dead_end_count++];
    *end = (MesoDeadEnd){.slot = slot, .attempt = attempt, .initial = attempt == 0};
    uint64_t *labels = MESO_NEW(ladder->arena, uint64_t, 4 * words, error);
    if (!labels)
        return MESO_ERR_MEMORY;

    for (uint32_t k = 0; k < 4; k++) {
        uint32_t twin = ladder->problem->graph->twin[4 * (size_t)slot + k];
        end->border[k] = twin == MESO_NO_INDEX;
        end->labels[k] = labels + k * words;
        /* A neighbour that is dead, or the slot itself, demands nothing in particular. */
        if (twin == MESO_NO_INDEX || twin / 4 == slot ||
            propagation->state[twin / 4] == MESO_DOMAIN_EMPTY)
            meso_border_labels(ladder->problem->set, end->border[k], end->labels[k]);
        else
            memcpy(end->labels[k], meso_propagation_allowed(propagation, slot, k), words * sizeof *labels);
    }
    return MESO_OK;
}

MesoStatus meso_rung_initial_dead_ends(MesoLadder *ladder, MesoError *error)
{
    for (uint32_t s = ladder->problem->graph->slot_count; s-- > 0;)
        if (ladder->propagation.state[s] == MESO_DOMAIN_EMPTY)
            ladder->result->conflict_slot = s;
    for (uint32_t s = 0; s < ladder->problem->graph->slot_count; s++)
        if (ladder->propagation.state[s] == MESO_DOMAIN_EMPTY && record_dead_end(ladder, s, 0, error))
            return MESO_ERR_MEMORY;
    return MESO_OK;
}

static MesoStatus note_dead_end(void *context, uint32_t slot, bool first, MesoError *error)
{
    MesoLadder *ladder = context;
    if (meso_hot_spots_reserve_one(&ladder->hot_spots, &ladder->hot_arena, error))
        return MESO_ERR_MEMORY;
    meso_hot_spots_add(&ladder->hot_spots, slot);
    return first ? record_dead_end(ladder, slot, ladder->result->attempts, error) : MESO_OK;
}

static MesoStatus accept_states(MesoLadder *ladder, MesoError *error)
{
    const MesoPropagation *propagation = &ladder->propagation;
    uint32_t count = ladder->problem->graph->slot_count;
    uint32_t *variant = MESO_NEW(&ladder->scratch, uint32_t, count, error);
    if (!variant)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < count; s++)
        variant[s] = meso_domain_variant(&propagation->domains, propagation->state[s], 0);
    return meso_ladder_accept(ladder, variant, MESO_DECIDER_SEARCH, error);
}

/* Keeps where an attempt that failed ended, if none came farther. */
static MesoStatus keep_best(MesoLadder *ladder, MesoError *error)
{
    const MesoPropagation *propagation = &ladder->propagation;
    uint32_t count = ladder->problem->graph->slot_count;
    if (ladder->best_variant && propagation->queue.count >= ladder->best_open)
        return MESO_OK;
    if (!ladder->best_variant)
        ladder->best_variant = MESO_NEW(&ladder->scratch, uint32_t, count, error);
    if (!ladder->best_variant)
        return MESO_ERR_MEMORY;
    ladder->best_open = propagation->queue.count;
    for (uint32_t s = 0; s < count; s++)
        ladder->best_variant[s] = propagation->domains.domains[propagation->state[s]].size == 1
                                      ? meso_domain_variant(&propagation->domains, propagation->state[s], 0)
                                      : MESO_NO_INDEX;
    return MESO_OK;
}

void meso_rung_prepare_search(MesoLadder *ladder)
{
    const MesoSolveOptions *options = ladder->options;
    ladder->plain = (MesoSearch){.propagation = &ladder->propagation, .constraints = ladder->problem->constraints,
                               .tick = meso_ladder_tick, .dead_end = note_dead_end, .context = ladder,
                               .fewest_open = ladder->propagation.queue.count,
                               .max_observations = options->max_observations ? options->max_observations : UINT64_MAX};
}

/* A dead end that hangs on no choice. */
static MesoStatus say_impossible(MesoLadder *ladder, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_SEARCH;
    result->conflict_slot = ladder->plain.impossible_slot;
    result->reason = meso_arena_print(ladder->arena, error, ladder->plain.impossible_at_once
                                          ? "each tile that fits slot %u leaves another slot without any"
                                          : "whatever is chosen around slot %u, it leaves a slot without any tile",
                                      result->conflict_slot);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_rung_search(MesoLadder *ladder, uint32_t last, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    const MesoSolveOptions *options = ladder->options;
    MesoSearch *wfc = &ladder->plain;
    MesoSearchOutcome outcome = MESO_SEARCH_STUCK;
    MesoStatus status = MESO_OK;
    while (!status && outcome == MESO_SEARCH_STUCK && result->attempts < last) {
        wfc->attempts_before = result->attempts++;
        meso_random_init(&wfc->random, options->seed, result->attempts);
        meso_propagation_restart(&ladder->propagation);
        status = meso_search_attempt(wfc, &outcome, error);
        if (!status && outcome != MESO_SEARCH_DONE)
            status = keep_best(ladder, error);
    }
    result->observations = wfc->observations;
    result->jumps = wfc->jumps;
    result->repairs = wfc->repairs;
    result->decided_most = ladder->problem->graph->slot_count - wfc->fewest_open;
    if (status)
        return status;
    meso_ladder_tick(ladder);
    if (outcome == MESO_SEARCH_DONE)
        return accept_states(ladder, error);
    if (outcome == MESO_SEARCH_IMPOSSIBLE)
        return say_impossible(ladder, error);
    result->decider = MESO_DECIDER_ATTEMPTS;
    result->budget = outcome == MESO_SEARCH_STOPPED ? MESO_BUDGET_OBSERVATIONS : MESO_BUDGET_ATTEMPTS;
    if (meso_ladder_told_to_stop(ladder))
        meso_ladder_stop(ladder);
    return MESO_OK;
}

static MesoStatus say_exhausted(MesoLadder *ladder, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_SEARCH;
    result->reason = meso_violations_text(ladder->arena, "every choice was tried", result,
                                          ladder->problem->constraints, error);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_rung_prepare_constrained(MesoLadder *ladder, bool *disproved, MesoError *error)
{
    const MesoConstraints *constraints = ladder->problem->constraints;
    uint64_t *violations = MESO_NEW(ladder->arena, uint64_t, meso_constraint_count(constraints), error);
    if (!violations)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_constrained_search_init(&ladder->constrained, &ladder->scratch, &ladder->propagation,
                                         ladder->problem->variants, constraints, violations, disproved, error);
    ladder->result->violations = violations;
    ladder->constrained.tick = meso_ladder_tick;
    ladder->constrained.context = ladder;
    ladder->constrained.fewest_open = ladder->propagation.queue.count;
    if (ladder->options->max_observations)
        ladder->constrained.max_observations = ladder->options->max_observations;
    if (!status)
        status = meso_hot_spots_reserve(&ladder->hot_spots, &ladder->hot_arena, error);
    ladder->constrained.hot_spots = &ladder->hot_spots;
    return status;
}

MesoStatus meso_rung_constrained(MesoLadder *ladder, MesoError *error)
{
    MesoConstrainedSearch *guided = &ladder->constrained;
    MesoSolveResult *result = ladder->result;
    bool solved = false;
    MesoStatus status = MESO_OK;
    while (!status && !solved && !guided->exhausted && !guided->stopped &&
           result->attempts < ladder->options->max_attempts) {
        MesoRandom random;
        meso_random_init(&random, ladder->options->seed, ++result->attempts);
        meso_propagation_restart(&ladder->propagation);
        status = meso_constrained_search_attempt(guided, &random, &solved, error);
        if (!status && !solved)
            status = keep_best(ladder, error);
        /* Where a quota or strands ended the attempt, there is no dead slot to tell of. */
        if (!status && !solved && ladder->propagation.dead_slot != MESO_NO_INDEX)
            status = record_dead_end(ladder, ladder->propagation.dead_slot, result->attempts, error);
    }
    result->observations = guided->observations;
    result->backtracks = guided->backtracks;
    result->decided_most = ladder->problem->graph->slot_count - guided->fewest_open;
    if (status)
        return status;
    if (guided->stopped)
        result->budget = MESO_BUDGET_OBSERVATIONS;
    if (!meso_ladder_tick(ladder))
        meso_ladder_stop(ladder);
    if (!solved && !guided->exhausted)
        return MESO_OK;
    return solved ? accept_states(ladder, error) : say_exhausted(ladder, error);
}
