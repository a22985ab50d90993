#include "libcore/solve/solve.h"

#include <assert.h>
#include <string.h>

#include "libcore/solve/propagate.h"

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

/* Observes until every slot has one variant, or one has none: then the attempt's dead end is recorded. */
static MesoStatus run_attempt(Search *search, uint32_t attempt, bool *solved, MesoError *error)
{
    MesoPropagation *propagation = &search->propagation;
    MesoRandom random;
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
    if (meso_assignment_check(assignment, search->set, search->graph, &finding))
        return meso_fail(error, MESO_ERR_INTERNAL, "the solver's assignment is wrong: %s",
                         finding.message);
    search->result->verdict = MESO_VERDICT_SOLVED;
    return MESO_OK;
}

static MesoStatus run(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    MesoPropagation *propagation = &search->propagation;

    if (propagation->initial_dead_count) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        return record_initial_dead_ends(search, error);
    }
    bool solved = false;
    while (!solved && result->attempts < search->options->max_attempts) {
        if (meso_propagation_restart(propagation, error) ||
            run_attempt(search, ++result->attempts, &solved, error))
            return MESO_ERR_MEMORY;
    }
    result->verdict = MESO_VERDICT_GAVE_UP;
    return solved ? extract(search, error) : MESO_OK;
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
    *result = (MesoSolveResult){.label_word_count = meso_bits_words(2 * set->interface_count)};
    if (variants->count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "no tile to solve with: the set has none, or ignores all");

    Search search = {.set = set, .variants = variants, .graph = graph,
                     .options = options, .result = result, .arena = arena};
    meso_arena_init(&search.scratch);
    MesoStatus status = meso_propagation_init(&search.propagation, &search.scratch, set, variants,
                                              graph, error);
    if (!status)
        status = allocate_dead_ends(&search, error);
    if (!status)
        status = run(&search, error);
    meso_propagation_release(&search.propagation);
    meso_arena_release(&search.scratch);
    return status;
}
