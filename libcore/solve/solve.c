#include "libcore/solve/solve.h"

#include <assert.h>
#include <string.h>

#include "libcore/solve/decide.h"
#include "libcore/solve/explain.h"
#include "libcore/solve/guided.h"
#include "libcore/solve/search.h"

enum { PROGRESS_INTERVAL = 4096 };  /* observations */

typedef struct Search {
    const MesoTileSet *set;
    const MesoVariantSet *variants;
    const MesoSlotGraph *graph;
    const MesoSolveOptions *options;
    MesoSolveResult *result;
    MesoArena *arena;               /* of the result */
    MesoArena scratch;
    MesoPropagation propagation;
    MesoGuidedSearch guided;        /* where there are constraints */
} Search;

/* RecordNeighbors: what a tile for `slot` would have to show. */
static MesoStatus record_dead_end(Search *search, uint32_t slot, uint32_t attempt, MesoError *error)
{
    MesoSolveResult *result = search->result;
    const MesoPropagation *propagation = &search->propagation;
    size_t words = result->label_word_count;

    result->dead_end_total++;
    if (result->dead_end_count == search->options->max_dead_ends)
        return MESO_OK;
    MesoDeadEnd *end = &result->dead_ends[result->dead_end_count++];
    *end = (MesoDeadEnd){.slot = slot, .attempt = attempt, .initial = attempt == 0};
    uint64_t *labels = MESO_NEW(search->arena, uint64_t, 4 * words, error);
    if (!labels)
        return MESO_ERR_MEMORY;

    for (uint32_t k = 0; k < 4; k++) {
        uint32_t twin = search->graph->twin[4 * (size_t)slot + k];
        end->border[k] = twin == MESO_NO_INDEX;
        end->labels[k] = labels + k * words;
        /* A neighbour that is dead, or the slot itself, demands nothing in particular. */
        if (twin == MESO_NO_INDEX || twin / 4 == slot ||
            propagation->state[twin / 4] == MESO_DOMAIN_EMPTY)
            meso_border_labels(search->set, end->border[k], end->labels[k]);
        else
            memcpy(end->labels[k], meso_propagation_allowed(propagation, slot, k), words * sizeof *labels);
    }
    return MESO_OK;
}

static MesoStatus record_initial_dead_ends(Search *search, MesoError *error)
{
    for (uint32_t s = 0; s < search->graph->slot_count; s++)
        if (search->propagation.state[s] == MESO_DOMAIN_EMPTY && record_dead_end(search, s, 0, error))
            return MESO_ERR_MEMORY;
    return MESO_OK;
}

static void tell_progress(const Search *search)
{
    uint32_t total = search->graph->slot_count;
    if (search->options->progress)
        search->options->progress(search->options->progress_context,
                                  total - search->propagation.queue.count, total);
}

static bool told_to_stop(const Search *search)
{
    return search->options->stop && search->options->stop(search->options->stop_context);
}

/* Tells the progress; false where the search is to stop. */
static bool tick(void *context)
{
    const Search *search = context;
    tell_progress(search);
    return !told_to_stop(search);
}

static MesoStatus note_dead_end(void *context, uint32_t slot, MesoError *error)
{
    Search *search = context;
    return record_dead_end(search, slot, search->result->attempts, error);
}

static void tell_guided_progress(void *context)
{
    const Search *search = context;
    if (search->guided.observations % PROGRESS_INTERVAL == 1)
        tell_progress(search);
}

/* An attempt under constraints: where a quota or strands end it, there is no dead slot to record. */
static MesoStatus run_guided_attempt(Search *search, uint32_t attempt, bool *solved, MesoError *error)
{
    MesoRandom random;
    meso_random_init(&random, search->options->seed, attempt);
    MesoStatus status = meso_guided_attempt(&search->guided, &random, solved, error);
    search->result->observations = search->guided.observations;
    search->result->backtracks = search->guided.backtracks;
    uint32_t dead = search->propagation.dead_slot;
    if (!status && !*solved && dead != MESO_NO_INDEX)
        status = record_dead_end(search, dead, attempt, error);
    tell_progress(search);
    return status;
}

/* Takes variant[slot_count] as the solution, once checked. */
static MesoStatus accept(Search *search, const uint32_t *variant, MesoError *error)
{
    MesoAssignment *assignment = &search->result->assignment;
    const MesoConstraints *constraints = search->options->constraints;
    uint32_t count = search->graph->slot_count;

    assignment->tile = MESO_NEW(search->arena, uint32_t, count, error);
    assignment->transform = MESO_NEW(search->arena, MesoTransform, count, error);
    if (!assignment->tile || !assignment->transform)
        return MESO_ERR_MEMORY;
    assignment->slot_count = count;
    for (uint32_t s = 0; s < count; s++) {
        assignment->tile[s] = search->variants->tile[variant[s]];
        assignment->transform[s] = search->variants->transform[variant[s]];
    }
    MesoError finding;
    if (meso_assignment_check(assignment, search->set, search->graph, &finding) ||
        (constraints && meso_constraints_check(constraints, assignment, search->set, search->variants,
                                               search->graph, &finding)))
        return meso_fail(error, MESO_ERR_INTERNAL, "the solver's assignment is wrong: %s",
                         finding.message);
    search->result->verdict = MESO_VERDICT_SOLVED;
    return MESO_OK;
}

static MesoStatus accept_states(Search *search, MesoError *error)
{
    const MesoPropagation *propagation = &search->propagation;
    uint32_t count = search->graph->slot_count;
    uint32_t *variant = MESO_NEW(&search->scratch, uint32_t, count, error);
    if (!variant)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < count; s++)
        variant[s] = meso_domain_variant(&propagation->domains, propagation->state[s], 0);
    search->result->decider = MESO_DECIDER_SEARCH;
    return accept(search, variant, error);
}

/* Which constraints the initial fixed point disproves, in words. */
static MesoStatus explain(Search *search, MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    const MesoSolveResult *result = search->result;
    uint32_t count = 0, slot = result->dead_end_count ? result->dead_ends[0].slot : MESO_NO_INDEX;
    uint32_t *numbers = MESO_NEW(&search->scratch, uint32_t, meso_constraint_count(constraints), error);
    if (!numbers || meso_explain(numbers, &count, search->set, search->variants, search->graph, constraints,
                                 slot, error))
        return MESO_ERR_MEMORY;
    search->result->reason = meso_explanation_text(search->arena, constraints, numbers, count, error);
    return search->result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus say_unsolvable(Search *search, MesoError *error)
{
    search->result->verdict = MESO_VERDICT_UNSOLVABLE;
    search->result->decider = MESO_DECIDER_PROPAGATION;
    MesoStatus status = record_initial_dead_ends(search, error);
    return !status && search->options->constraints ? explain(search, error) : status;
}

/* The constraint that the search met most often, in words. */
static MesoStatus say_violations(Search *search, MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    MesoSolveResult *result = search->result;
    uint32_t worst = 0, count = meso_constraint_count(constraints);
    result->violations = search->guided.violations;
    for (uint32_t i = 0; i < count; i++)
        if (result->violations[i] > result->violations[worst])
            worst = i;
    if (search->guided.exhausted)
        result->reason = "every choice was tried";
    if (result->verdict == MESO_VERDICT_SOLVED || count == 0 || result->violations[worst] == 0)
        return MESO_OK;
    result->reason = meso_arena_print(search->arena, error, "%smost often %s stood in the way: %llu times",
                                      search->guided.exhausted ? "every choice was tried; " : "",
                                      meso_constraint_name(constraints, worst),
                                      (unsigned long long)result->violations[worst]);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus prepare_guided(Search *search, bool *disproved, MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    uint64_t *violations = MESO_NEW(search->arena, uint64_t, meso_constraint_count(constraints), error);
    if (!violations)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_guided_init(&search->guided, &search->scratch, &search->propagation,
                                         search->variants, constraints, violations, disproved, error);
    search->guided.progress = tell_guided_progress;
    search->guided.progress_context = search;
    return status;
}

/* Quotas, strands and variants to keep call for the guided search, and are beyond the exact engine. */
static bool needs_guidance(const MesoConstraints *constraints)
{
    return constraints && (constraints->quota_count || constraints->keep ||
                           meso_strand_rule_given(&constraints->strands));
}

/* The search's rung: attempts from sub-seeds. */
static MesoStatus search_freely(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    const MesoSolveOptions *options = search->options;
    MesoSearch wfc = {.propagation = &search->propagation, .constraints = options->constraints,
                      .tick = tick, .dead_end = note_dead_end, .context = search,
                      .max_observations = options->max_observations ? options->max_observations : UINT64_MAX};
    MesoSearchOutcome outcome = MESO_SEARCH_STUCK;
    MesoStatus status = MESO_OK;
    while (!status && outcome == MESO_SEARCH_STUCK && result->attempts < options->max_attempts) {
        meso_random_init(&wfc.random, options->seed, ++result->attempts);
        status = meso_propagation_restart(&search->propagation, error);
        if (!status)
            status = meso_search_attempt(&wfc, &outcome, error);
    }
    result->observations = wfc.observations;
    result->repairs = wfc.repairs;
    if (status)
        return status;
    if (outcome == MESO_SEARCH_DONE)
        return accept_states(search, error);
    if (outcome == MESO_SEARCH_IMPOSSIBLE) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->decider = MESO_DECIDER_SEARCH;
        result->reason = meso_arena_print(search->arena, error, "each tile that fits slot %u leaves another "
                                          "slot without any", wfc.impossible_slot);
        return result->reason ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (told_to_stop(search))
        result->decider = MESO_DECIDER_STOP;
    return MESO_OK;
}

static MesoStatus search_guided(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    const MesoSolveOptions *options = search->options;
    bool solved = false;
    MesoStatus status = MESO_OK;
    while (!status && !solved && !search->guided.exhausted && !told_to_stop(search) &&
           result->attempts < options->max_attempts &&
           (!options->max_observations || result->observations < options->max_observations)) {
        status = meso_propagation_restart(&search->propagation, error);
        if (!status)
            status = run_guided_attempt(search, ++result->attempts, &solved, error);
    }
    if (status)
        return status;
    if (solved)
        return accept_states(search, error);
    if (search->guided.exhausted) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->decider = MESO_DECIDER_SEARCH;
    } else if (told_to_stop(search)) {
        result->decider = MESO_DECIDER_STOP;
    }
    return MESO_OK;
}

static MesoStatus search_for(Search *search, MesoError *error)
{
    bool guided = needs_guidance(search->options->constraints);
    MesoStatus status = guided ? search_guided(search, error) : search_freely(search, error);
    tell_progress(search);
    return status;
}

/* Proofs hold under every constraint; a solution counts only where it meets those that the engine does not know. */
static MesoStatus decide(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    uint32_t *variant = MESO_NEW(&search->scratch, uint32_t, search->graph->slot_count, error);
    if (!variant)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_decide_by_numbers(result, search->arena, &search->scratch, &search->propagation,
                                               error);
    if (status || result->verdict != MESO_VERDICT_GAVE_UP)
        return status;
    MesoSolveResult exact = *result;
    status = meso_decide_exactly(&exact, variant, &search->scratch, &search->propagation, search->options,
                                 error);
    if (status)
        return status;
    if (exact.verdict == MESO_VERDICT_SOLVED && needs_guidance(search->options->constraints))
        return MESO_OK;
    *result = exact;
    return exact.verdict == MESO_VERDICT_SOLVED ? accept(search, variant, error) : MESO_OK;
}

/* The ladder: each rung leaves the verdict "gave up", or a better one. */
static MesoStatus climb(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    MesoEngine engine = search->options->engine;
    MesoStatus status = MESO_OK;
    result->verdict = MESO_VERDICT_GAVE_UP;
    result->decider = MESO_DECIDER_ATTEMPTS;
    if (engine != MESO_ENGINE_EXACT || needs_guidance(search->options->constraints))
        status = search_for(search, error);
    if (status || result->verdict != MESO_VERDICT_GAVE_UP || engine == MESO_ENGINE_WFC ||
        result->decider == MESO_DECIDER_STOP)
        return status;
    return decide(search, error);
}

static MesoStatus run(Search *search, MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    const MesoPropagation *propagation = &search->propagation;
    bool disproved = propagation->initial_dead_count || propagation->broken_quota != MESO_NO_INDEX;
    MesoStatus status = MESO_OK;
    if (!disproved && constraints)
        status = prepare_guided(search, &disproved, error);
    if (!status && disproved)
        return say_unsolvable(search, error);
    if (!status)
        status = climb(search, error);
    return !status && constraints ? say_violations(search, error) : status;
}

/* Dead ends to make room for: one an attempt, or one a slot met initially. */
static MesoStatus allocate_dead_ends(Search *search, MesoError *error)
{
    uint32_t count = search->propagation.initial_dead_count;
    if (!count)
        count = search->options->max_attempts;
    if (count > search->options->max_dead_ends)
        count = search->options->max_dead_ends;
    search->result->dead_ends = MESO_NEW(search->arena, MesoDeadEnd, count, error);
    return search->result->dead_ends ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_solve(MesoSolveResult *result, MesoArena *arena, const MesoTileSet *set,
                      const MesoVariantSet *variants, const MesoSlotGraph *graph,
                      const MesoSolveOptions *options, MesoError *error)
{
    assert(options->max_attempts >= 1);
    *result = (MesoSolveResult){.label_word_count = meso_bits_words(2 * set->interface_count),
                                .reason = ""};
    if (variants->count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "no tile to solve with: the set has none, or ignores all");

    Search search = {.set = set, .variants = variants, .graph = graph,
                     .options = options, .result = result, .arena = arena};
    meso_arena_init(&search.scratch);
    MesoStatus status = meso_propagation_init(&search.propagation, &search.scratch, set, variants,
                                              graph, options->constraints, error);
    if (!status)
        status = allocate_dead_ends(&search, error);
    if (!status)
        status = run(&search, error);
    meso_propagation_release(&search.propagation);
    meso_arena_release(&search.scratch);
    return status;
}
