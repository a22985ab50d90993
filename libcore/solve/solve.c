#include "libcore/solve/solve.h"

#include <assert.h>
#include <string.h>

#include "libcore/solve/counting.h"
#include "libcore/solve/exact.h"
#include "libcore/solve/parity.h"
#include "libcore/solve/search.h"

/* Word operations of the parity prover: a second or two. */
static const uint64_t parity_work = (uint64_t)1 << 32;

/* Conflicts that the exact engine has with random phases, which vary the solutions, before it follows its own. */
enum { PHASED_CONFLICTS = 1000 };

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

static bool told_to_stop(const Search *search)
{
    return search->options->stop && search->options->stop(search->options->stop_context);
}

/* Tells the progress; false where the search is to stop. */
static bool tick(void *context)
{
    const Search *search = context;
    uint32_t total = search->graph->slot_count;
    if (search->options->progress)
        search->options->progress(search->options->progress_context,
                                  total - search->propagation.queue.count, total);
    return !told_to_stop(search);
}

static MesoStatus note_dead_end(void *context, uint32_t slot, MesoError *error)
{
    Search *search = context;
    return record_dead_end(search, slot, search->result->attempts, error);
}

/* Takes variant[slot_count] as the solution, once checked. */
static MesoStatus accept(Search *search, const uint32_t *variant, MesoDecider decider, MesoError *error)
{
    MesoAssignment *assignment = &search->result->assignment;
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
    if (meso_assignment_check(assignment, search->set, search->graph, &finding))
        return meso_fail(error, MESO_ERR_INTERNAL, "the solver's assignment is wrong: %s",
                         finding.message);
    search->result->verdict = MESO_VERDICT_SOLVED;
    search->result->decider = decider;
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
    return accept(search, variant, MESO_DECIDER_SEARCH, error);
}

/* The search's rung: attempts from sub-seeds. */
static MesoStatus search_for(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    const MesoSolveOptions *options = search->options;
    MesoSearch wfc = {.propagation = &search->propagation, .tick = tick, .dead_end = note_dead_end, .context = search,
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
    tick(search);
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

static MesoStatus ask_engine(Search *search, MesoExact *exact, MesoSatAnswer *answer, MesoRandom *random,
                             MesoError *error)
{
    const MesoSolveOptions *options = search->options;
    uint64_t left = options->max_conflicts ? options->max_conflicts : MESO_SOLVE_CONFLICTS;
    uint32_t phased = left < PHASED_CONFLICTS ? (uint32_t)left : PHASED_CONFLICTS;
    MesoStatus status = meso_exact_choose_phases(exact, search->propagation.state, random, error);
    if (!status)
        status = meso_sat_solve(exact->sat, answer, NULL, 0, phased, options->stop,
                                options->stop_context, error);
    left -= phased;
    if (status || *answer != MESO_SAT_UNKNOWN || left == 0 || told_to_stop(search))
        return status;
    status = meso_sat_forget_phases(exact->sat, error);
    if (status)
        return status;
    return meso_sat_solve(exact->sat, answer, NULL, 0, left < INT32_MAX ? (uint32_t)left : INT32_MAX,
                          options->stop, options->stop_context, error);
}

static MesoStatus read_answer(Search *search, MesoExact *exact, MesoSatAnswer answer, MesoRandom *random,
                              MesoError *error)
{
    MesoSolveResult *result = search->result;
    if (answer == MESO_SAT_YES) {
        uint32_t *variant = MESO_NEW(&search->scratch, uint32_t, search->graph->slot_count, error);
        if (!variant)
            return MESO_ERR_MEMORY;
        MesoStatus status = meso_exact_extract(exact, variant, random, error);
        return status ? status : accept(search, variant, MESO_DECIDER_EXACT, error);
    }
    if (answer == MESO_SAT_NO) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->decider = MESO_DECIDER_EXACT;
    } else {
        result->decider = told_to_stop(search) ? MESO_DECIDER_STOP : MESO_DECIDER_CONFLICTS;
    }
    return MESO_OK;
}

static MesoStatus decide_exactly(Search *search, MesoError *error)
{
    MesoExact exact;
    MesoRandom random;
    MesoSatAnswer answer = MESO_SAT_UNKNOWN;
    const MesoExactOptions options = {0};
    meso_random_init(&random, search->options->seed, UINT64_MAX);
    MesoStatus status = meso_exact_init(&exact, &search->scratch, &search->propagation, &options, error);
    if (!status)
        status = ask_engine(search, &exact, &answer, &random, error);
    if (!status)
        status = read_answer(search, &exact, answer, &random, error);
    meso_exact_release(&exact);
    return status;
}

/* Counting, then parity: cheap where they prove something, and hopeless for the exact engine. */
static MesoStatus decide_by_numbers(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    MesoPatternTable table;
    MesoCountingProof proof;
    uint32_t slot;
    if (meso_pattern_table_init(&table, &search->scratch, &search->propagation, NULL, error) ||
        meso_counting_prove(&proof, &search->scratch, &table, error))
        return MESO_ERR_MEMORY;
    if (proof.found) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->decider = MESO_DECIDER_COUNTING;
        result->reason = meso_counting_explain(&proof, search->arena, search->set, error);
        return result->reason ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (meso_parity_prove(&slot, &search->scratch, &table, parity_work, error))
        return MESO_ERR_MEMORY;
    if (slot == MESO_NO_INDEX)
        return MESO_OK;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_PARITY;
    result->reason = meso_arena_print(search->arena, error, "the numbers of labels that the tiles show, "
                                      "odd or even, contradict each other on the piece of the surface "
                                      "around slot %u", slot);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

/* The ladder: each rung leaves the verdict "gave up", or a better one. */
static MesoStatus run(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    MesoEngine engine = search->options->engine;
    MesoStatus status = MESO_OK;

    if (search->propagation.initial_dead_count) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->decider = MESO_DECIDER_PROPAGATION;
        return record_initial_dead_ends(search, error);
    }
    result->verdict = MESO_VERDICT_GAVE_UP;
    result->decider = MESO_DECIDER_ATTEMPTS;
    if (engine != MESO_ENGINE_EXACT)
        status = search_for(search, error);
    if (status || engine == MESO_ENGINE_WFC || result->decider == MESO_DECIDER_STOP)
        return status;
    if (result->verdict == MESO_VERDICT_GAVE_UP)
        status = decide_by_numbers(search, error);
    if (!status && result->verdict == MESO_VERDICT_GAVE_UP)
        status = decide_exactly(search, error);
    return status;
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
    *result = (MesoSolveResult){.label_word_count = meso_bits_words(2 * set->interface_count), .reason = ""};
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
