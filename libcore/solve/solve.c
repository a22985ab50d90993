#include "libcore/solve/solve.h"

#include <assert.h>
#include <string.h>

#include "libcore/solve/explain.h"
#include "libcore/solve/guided.h"

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

/* Observe: a random variant for a random slot of those with the fewest variants above one. */
static MesoStatus observe(Search *search, MesoRandom *random, MesoError *error)
{
    MesoPropagation *propagation = &search->propagation;
    uint32_t slot = meso_bucket_queue_draw(&propagation->queue, random);
    uint32_t state = propagation->state[slot];
    uint32_t rank = meso_random_below(random, propagation->domains.domains[state].size);
    uint32_t variant = meso_domain_variant(&propagation->domains, state, rank);

    if (search->result->observations++ % PROGRESS_INTERVAL == 0)
        tell_progress(search);
    return meso_propagation_assign(propagation, slot, variant, error);
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

/* Observes until every slot has one variant, or one has none: then the attempt's dead end is recorded. */
static MesoStatus run_attempt(Search *search, uint32_t attempt, bool *solved, MesoError *error)
{
    MesoPropagation *propagation = &search->propagation;
    MesoRandom random;
    if (search->options->constraints)
        return run_guided_attempt(search, attempt, solved, error);
    meso_random_init(&random, search->options->seed, attempt);

    while (propagation->queue.count) {
        if (observe(search, &random, error))
            return MESO_ERR_MEMORY;
        if (propagation->dead_slot != MESO_NO_INDEX)
            return record_dead_end(search, propagation->dead_slot, attempt, error);
    }
    *solved = true;
    tell_progress(search);
    return MESO_OK;
}

static MesoStatus extract(Search *search, MesoError *error)
{
    MesoPropagation *propagation = &search->propagation;
    MesoAssignment *assignment = &search->result->assignment;
    uint32_t count = search->graph->slot_count;

    assignment->tile = MESO_NEW(search->arena, uint32_t, count, error);
    assignment->transform = MESO_NEW(search->arena, MesoTransform, count, error);
    if (!assignment->tile || !assignment->transform)
        return MESO_ERR_MEMORY;
    assignment->slot_count = count;
    for (uint32_t s = 0; s < count; s++) {
        uint32_t variant = meso_domain_variant(&propagation->domains, propagation->state[s], 0);
        assignment->tile[s] = search->variants->tile[variant];
        assignment->transform[s] = search->variants->transform[variant];
    }
    MesoError finding;
    const MesoConstraints *constraints = search->options->constraints;
    if (meso_assignment_check(assignment, search->set, search->graph, &finding) ||
        (constraints && meso_constraints_check(constraints, assignment, search->set, search->variants,
                                               search->graph, &finding)))
        return meso_fail(error, MESO_ERR_INTERNAL, "the solver's assignment is wrong: %s",
                         finding.message);
    search->result->verdict = MESO_VERDICT_SOLVED;
    return MESO_OK;
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

static MesoStatus run(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    MesoPropagation *propagation = &search->propagation;
    bool solved = false, disproved = propagation->initial_dead_count ||
                                     propagation->broken_quota != MESO_NO_INDEX;
    MesoStatus status = MESO_OK;
    if (!disproved && search->options->constraints)
        status = prepare_guided(search, &disproved, error);
    if (!status && disproved)
        return say_unsolvable(search, error);

    while (!status && !solved && !search->guided.exhausted &&
           result->attempts < search->options->max_attempts) {
        status = meso_propagation_restart(propagation, error);
        if (!status)
            status = run_attempt(search, ++result->attempts, &solved, error);
    }
    result->verdict = search->guided.exhausted ? MESO_VERDICT_UNSOLVABLE : MESO_VERDICT_GAVE_UP;
    if (!status && solved)
        status = extract(search, error);
    return !status && search->options->constraints ? say_violations(search, error) : status;
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
