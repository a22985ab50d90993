#include "libcore/tiling/solve/explain.h"

#include <assert.h>
#include <string.h>

#include "libcore/tiling/propagate/propagate.h"
#include "libcore/tiling/search/strand_places.h"
#include "libcore/tiling/search/strand_search.h"
#include "libcore/tiling/solve/verdict_text.h"

/* Slots that all tries together may go through; a few seconds. */
static const uint64_t work_limit = (uint64_t)1 << 26;
static const uint64_t deep_work_limit = (uint64_t)1 << 18;
enum { LEAST_TRIES = 64, LEAST_DEEP_TRIES = 8, NAMES_IN_TEXT = 8 };

/* Limits of a solve that is a try. */
enum { DEEP_CONFLICTS = 20000, DEEP_ATTEMPTS = 1 };

/* Limits of the core that a proof by numbers may have instead: a cheap one. */
enum { NUMBERS_CORE_SLOTS = 800, NUMBERS_CORE_CONFLICTS = 1000 };

typedef struct Explainer {
    const MesoTilingProblem *problem;
    MesoRestriction *restrictions;      /* [restriction_count] room for a selection */
    MesoQuota *quotas;                  /* [quota_count] the same */
    uint32_t *selected;                 /* [constraint count] the ones that a try has */
    bool deep;
    uint64_t seed;
    uint64_t tries_left;
    MesoStatus status;
    MesoError *error;
} Explainer;

static MesoConstraints select_constraints(Explainer *explainer, const uint32_t *numbers, uint32_t count)
{
    const MesoConstraints *all = explainer->problem->constraints;
    MesoConstraints some = {.restrictions = explainer->restrictions, .quotas = explainer->quotas};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t number = numbers[i];
        if (number < all->restriction_count)
            explainer->restrictions[some.restriction_count++] = all->restrictions[number];
        else if (number < all->restriction_count + all->quota_count)
            explainer->quotas[some.quota_count++] = all->quotas[number - all->restriction_count];
        else
            some.strands = all->strands;
    }
    return some;
}

static MesoStatus try_propagation(Explainer *explainer, const MesoTilingProblem *some, MesoArena *scratch, bool *no)
{
    MesoPropagation propagation;
    MesoStatus status = meso_strand_places_init(&propagation, scratch, some, explainer->error);
    *no = !status && (propagation.initial_dead_count || propagation.broken_quota != MESO_NO_INDEX);
    if (!status && !*no)
        status = meso_strand_search_disproves(no, scratch, &propagation, some->variants, some->constraints,
                                              explainer->error);
    meso_propagation_release(&propagation);
    return status;
}

static MesoStatus try_solve(Explainer *explainer, const MesoTilingProblem *some, MesoArena *scratch, bool *no)
{
    MesoSolveResult result;
    const MesoSolveOptions options = {.seed = explainer->seed, .max_attempts = DEEP_ATTEMPTS,
                                      .max_conflicts = DEEP_CONFLICTS};
    MesoStatus status = meso_solve(&result, scratch, some, &options, explainer->error);
    *no = !status && result.verdict == MESO_VERDICT_UNSOLVABLE;
    return status;
}

/* Whether a try disproves these constraints. */
static bool disproved(Explainer *explainer, const uint32_t *numbers, uint32_t count)
{
    if (explainer->status || explainer->tries_left == 0)
        return false;
    explainer->tries_left--;
    const MesoConstraints selected = select_constraints(explainer, numbers, count);
    MesoTilingProblem some = *explainer->problem;
    some.constraints = &selected;
    MesoArena scratch;
    bool no = false;
    meso_arena_init(&scratch);
    explainer->status = explainer->deep ? try_solve(explainer, &some, &scratch, &no)
                                        : try_propagation(explainer, &some, &scratch, &no);
    meso_arena_release(&scratch);
    return no;
}

/*
 * Leaves in items[0..result) what of items[0..count) is needed beside `base` items that
 * stand in `selected`. `grown`: the base has grown since the last try.
 */
static uint32_t shrink(Explainer *explainer, uint32_t base, bool grown, uint32_t *items, uint32_t count)
{
    if (grown && disproved(explainer, explainer->selected, base))
        return 0;
    if (count <= 1)
        return count;
    uint32_t half = count / 2;
    memcpy(explainer->selected + base, items, half * sizeof *items);
    uint32_t right = shrink(explainer, base + half, true, items + half, count - half);
    memcpy(explainer->selected + base, items + half, right * sizeof *items);
    uint32_t left = shrink(explainer, base + right, right > 0, items, half);
    memmove(items + left, items + half, right * sizeof *items);
    return left + right;
}

/* Whether `restriction` speaks of `slot` or one of its neighbours. */
static bool touches(const MesoRestriction *restriction, const MesoSlotGraph *graph, uint32_t slot)
{
    for (uint32_t i = 0; i < restriction->place_count; i++) {
        uint32_t place = restriction->sided ? restriction->places[i] / 4 : restriction->places[i];
        if (place == slot)
            return true;
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t twin = graph->twin[4 * (size_t)slot + k];
            if (twin != MESO_NO_INDEX && twin / 4 == place)
                return true;
        }
    }
    return false;
}

/* The constraints to shrink: those around `slot`, or all. */
static uint32_t collect(Explainer *explainer, uint32_t *numbers, uint32_t slot)
{
    const MesoConstraints *constraints = explainer->problem->constraints;
    uint32_t count = 0, all = meso_constraint_count(constraints);
    if (slot != MESO_NO_INDEX) {
        for (uint32_t r = 0; r < constraints->restriction_count; r++)
            if (touches(&constraints->restrictions[r], explainer->problem->graph, slot))
                numbers[count++] = r;
        if (disproved(explainer, numbers, count))
            return count;
    }
    for (count = 0; count < all; count++)
        numbers[count] = count;
    return all;
}

static void sort_ascending(uint32_t *numbers, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++)
        for (uint32_t j = i; j > 0 && numbers[j - 1] > numbers[j]; j--) {
            uint32_t number = numbers[j];
            numbers[j] = numbers[j - 1];
            numbers[j - 1] = number;
        }
}

MesoStatus meso_explain_constraints(uint32_t *numbers, uint32_t *count, const MesoTilingProblem *problem,
                                    uint32_t slot, bool deep, uint64_t seed, MesoError *error)
{
    const MesoConstraints *constraints = problem->constraints;
    const MesoSlotGraph *graph = problem->graph;
    MesoArena arena;
    Explainer explainer = {.problem = problem, .deep = deep, .seed = seed, .error = error};
    explainer.tries_left = deep ? LEAST_DEEP_TRIES + deep_work_limit / (graph->slot_count + (uint64_t)1)
                                : LEAST_TRIES + work_limit / (graph->slot_count + (uint64_t)1);
    meso_arena_init(&arena);
    explainer.restrictions = MESO_NEW(&arena, MesoRestriction, constraints->restriction_count, error);
    explainer.quotas = MESO_NEW(&arena, MesoQuota, constraints->quota_count, error);
    explainer.selected = MESO_NEW(&arena, uint32_t, meso_constraint_count(constraints), error);
    if (!explainer.restrictions || !explainer.quotas || !explainer.selected)
        explainer.status = MESO_ERR_MEMORY;
    if (!explainer.status) {
        *count = collect(&explainer, numbers, slot);
        if (!deep || disproved(&explainer, numbers, *count))
            *count = shrink(&explainer, 0, true, numbers, *count);
    }
    /* Halves that were put back stand in their order, unless the tries ran out. */
    if (!explainer.status)
        sort_ascending(numbers, *count);
    meso_arena_release(&arena);
    return explainer.status;
}

/* "pins[0] and quotas[1] 'knots' cannot hold together" */
static const char *constraints_text(MesoArena *arena, const MesoConstraints *constraints,
                                    const uint32_t *numbers, uint32_t count, MesoError *error)
{
    if (count == 0)
        return "tile set and surface cannot go together, whatever the constraints";
    if (count == 1)
        return meso_arena_print(arena, error, "%s cannot hold", meso_constraint_name(constraints, numbers[0]));
    uint32_t named = count < NAMES_IN_TEXT ? count : NAMES_IN_TEXT;
    const char *text = meso_constraint_name(constraints, numbers[0]);
    for (uint32_t i = 1; i < named && text; i++)
        text = meso_arena_print(arena, error, "%s%s %s", text, i + 1 < count ? "," : " and",
                                meso_constraint_name(constraints, numbers[i]));
    if (text && named < count)
        text = meso_arena_print(arena, error, "%s and %u more", text, count - named);
    return text ? meso_arena_print(arena, error, "%s cannot hold together", text) : NULL;
}

/* Whether a core was found that tells more than the reason that there is: of a proof by numbers, a small one. */
static MesoStatus explain_by_core(MesoSolveResult *result, MesoArena *arena, const MesoTilingProblem *problem,
                                  uint32_t near, bool *done, MesoError *error)
{
    bool by_numbers = result->decider == MESO_DECIDER_COUNTING || result->decider == MESO_DECIDER_PARITY;
    const MesoCoreLimits limits = {.slots = by_numbers ? NUMBERS_CORE_SLOTS : 0,
                                   .conflicts = by_numbers ? NUMBERS_CORE_CONFLICTS : 0};
    if (near == MESO_NO_INDEX && result->hot_spot_count > 0)
        near = result->hot_spots[0].slot;
    MesoStatus status = meso_conflict_core_find(&result->core, arena, problem, near, &limits, error);
    *done = !status && result->core.found && (!by_numbers || 2 * result->core.slot_count <= problem->graph->slot_count);
    if (!*done) {
        result->core = (MesoConflictCore){0};
        return status;
    }
    result->reason = meso_core_text(arena, problem, &result->core, error);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus explain_by_constraints(MesoSolveResult *result, MesoArena *arena, const MesoTilingProblem *problem,
                                         uint32_t near, bool deep, uint64_t seed, MesoError *error)
{
    const MesoConstraints *constraints = problem->constraints;
    uint32_t count = 0;
    if (!constraints || meso_constraint_count(constraints) == 0)
        return MESO_OK;
    uint32_t *numbers = MESO_NEW(arena, uint32_t, meso_constraint_count(constraints), error);
    if (!numbers || meso_explain_constraints(numbers, &count, problem, deep ? MESO_NO_INDEX : near, deep, seed, error))
        return MESO_ERR_MEMORY;
    if (deep && count == 0)
        return MESO_OK;
    result->core = (MesoConflictCore){.found = count > 0, .constraint_count = count, .constraints = numbers};
    const char *text = constraints_text(arena, constraints, numbers, count, error);
    if (text && *result->reason)
        text = meso_arena_print(arena, error, "%s: %s", text, result->reason);
    result->reason = text;
    return text ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_explain(MesoSolveResult *result, MesoArena *arena, const MesoTilingProblem *problem, uint64_t seed,
                        MesoError *error)
{
    if (result->verdict != MESO_VERDICT_UNSOLVABLE)
        return MESO_OK;
    uint32_t near = result->conflict_slot;
    bool initial = result->decider == MESO_DECIDER_PROPAGATION, done = false;
    bool quotas = problem->constraints && problem->constraints->quota_count > 0;
    MesoStatus status = MESO_OK;
    /* Where propagation left no slot dead, it disproved a quota or the rule on strands. */
    if (!initial || near != MESO_NO_INDEX || quotas)
        status = explain_by_core(result, arena, problem, near, &done, error);
    if (status || done)
        return status;
    return explain_by_constraints(result, arena, problem, near, !initial, seed, error);
}
