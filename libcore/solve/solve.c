#include "libcore/solve/solve.h"

#include <assert.h>
#include <string.h>

#include "libcore/solve/counting.h"
#include "libcore/solve/exact_control.h"
#include "libcore/solve/explain.h"
#include "libcore/solve/guided.h"
#include "libcore/solve/parity.h"
#include "libcore/solve/search.h"

/* Word operations of the parity prover: a second or two. */
static const uint64_t parity_work = (uint64_t)1 << 32;

/* Changes of states that probing may make: half a minute or less. */
static const uint64_t probe_work = (uint64_t)1 << 27;

/* Conflicts that the exact engine has before probing: about a second. */
enum { FIRST_CONFLICTS = 3000 };

/* Conflicts that the exact engine has with random phases, which vary the solutions, before it follows its own. */
enum { PHASED_CONFLICTS = 1000 };

/* Solutions of the exact engine that a rule on strands may cut off: fewer on a large surface. */
enum { LEAST_CUT_ROUNDS = 20, MOST_CUT_ROUNDS = 2000, CUT_SLOTS = 1 << 20 };

typedef struct Search {
    const MesoTileSet *set;
    const MesoVariantSet *variants;
    const MesoSlotGraph *graph;
    const MesoSolveOptions *options;
    MesoSolveResult *result;
    MesoArena *arena;               /* of the result */
    MesoArena scratch;
    MesoPropagation propagation;
    MesoGuidedSearch guided;        /* where constraints call for it */
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
    const MesoConstraints *constraints = search->options->constraints;
    if (meso_assignment_check(assignment, search->set, search->graph, &finding) ||
        (constraints && meso_constraints_check(constraints, assignment, search->set, search->variants,
                                               search->graph, &finding)))
        return meso_fail(error, MESO_ERR_INTERNAL, "the solver's assignment is wrong: %s",
                         finding.message);
    search->result->verdict = MESO_VERDICT_SOLVED;
    search->result->decider = decider;
    search->result->reason = "";
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

/* The states of one variant each where variant[slot_count] says one, and those of the search elsewhere. */
static MesoStatus fill_single_states(Search *search, const uint32_t *variant, uint32_t *states, MesoError *error)
{
    for (uint32_t s = 0; s < search->graph->slot_count; s++) {
        states[s] = variant[s] == MESO_NO_INDEX
                        ? search->propagation.state[s]
                        : meso_domain_single(&search->propagation.domains, variant[s], error);
        if (states[s] == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

/* `hint` [slot_count] has the states that decisions try first; `left` the conflicts that may be met. */
static MesoStatus ask_engine(Search *search, MesoExact *exact, const uint32_t *hint, MesoSatAnswer *answer,
                             MesoRandom *random, uint64_t left, MesoError *error)
{
    const MesoSolveOptions *options = search->options;
    uint32_t phased = left < PHASED_CONFLICTS ? (uint32_t)left : PHASED_CONFLICTS;
    MesoStatus status = meso_exact_choose_phases(exact, hint, random, error);
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

/* Tells the answer; a solution goes to `variant`, unless it breaks the rule on strands: then there are `*cuts`. */
static MesoStatus read_answer(Search *search, MesoExact *exact, MesoSatAnswer answer, uint32_t *variant,
                              uint32_t *cuts, MesoRandom *random, MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    MesoSolveResult *result = search->result;
    if (answer == MESO_SAT_NO) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        if (!*result->reason)
            result->reason = "the exact engine went through all cases";
    }
    result->decider = answer != MESO_SAT_UNKNOWN ? MESO_DECIDER_EXACT
                      : told_to_stop(search)     ? MESO_DECIDER_STOP
                                                 : MESO_DECIDER_CONFLICTS;
    if (answer != MESO_SAT_YES)
        return MESO_OK;
    MesoStatus status = meso_exact_extract(exact, variant, random, error);
    if (!status && constraints && meso_strand_rule_given(&constraints->strands))
        status = meso_exact_cut_strands(exact, &constraints->strands, variant, search->variants, cuts, error);
    return status || *cuts ? status : accept(search, variant, MESO_DECIDER_EXACT, error);
}

/* Asks until there is an answer that no rule on strands cuts off, each time for one like the last. */
static MesoStatus ask_until_kept(Search *search, MesoExact *exact, MesoRandom *random, uint64_t conflicts,
                                 MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    const uint32_t *hint = search->propagation.state;
    uint32_t *variant = MESO_NEW(&search->scratch, uint32_t, search->graph->slot_count, error);
    uint32_t *like_last = MESO_NEW(&search->scratch, uint32_t, search->graph->slot_count, error);
    if (!variant || !like_last)
        return MESO_ERR_MEMORY;
    if (constraints && constraints->keep) {
        if (fill_single_states(search, constraints->keep, like_last, error))
            return MESO_ERR_MEMORY;
        hint = like_last;
    }
    uint32_t rounds = LEAST_CUT_ROUNDS + CUT_SLOTS / search->graph->slot_count;
    rounds = rounds < MOST_CUT_ROUNDS ? rounds : MOST_CUT_ROUNDS;
    for (uint32_t round = 0; round < rounds; round++) {
        MesoSatAnswer answer = MESO_SAT_UNKNOWN;
        uint32_t cuts = 0;
        MesoStatus status = ask_engine(search, exact, hint, &answer, random, conflicts, error);
        if (!status)
            status = read_answer(search, exact, answer, variant, &cuts, random, error);
        if (status || cuts == 0)
            return status;
        if (fill_single_states(search, variant, like_last, error))
            return MESO_ERR_MEMORY;
        hint = like_last;
        if (told_to_stop(search)) {
            search->result->decider = MESO_DECIDER_STOP;
            return MESO_OK;
        }
    }
    search->result->decider = MESO_DECIDER_CONFLICTS;
    return MESO_OK;
}

static MesoStatus decide_exactly(Search *search, uint64_t conflicts, MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    MesoExact exact;
    MesoRandom random;
    MesoExactOptions options = {.proof = search->options->proof, .clause = search->options->clause,
                                .context = search->options->proof_context,
                                .grows = constraints && meso_strand_rule_given(&constraints->strands)};
    bool complete = true;
    meso_random_init(&random, search->options->seed, UINT64_MAX);
    if (search->options->formula)
        search->options->formula(search->options->proof_context);
    if (constraints && meso_exact_groups(&options.group, &search->scratch, constraints, search->variants->count, error))
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_exact_init(&exact, &search->scratch, &search->propagation, &options, error);
    if (!status && constraints)
        status = meso_exact_add_quotas(&exact, constraints, &complete, error);
    /* Where a quota is too large to be counted, what the engine finds need not keep to it. */
    if (!status && complete)
        status = ask_until_kept(search, &exact, &random, conflicts, error);
    meso_exact_release(&exact);
    return status;
}

/* What probing excludes was impossible under all constraints: it stays excluded. */
static MesoStatus probe(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    MesoSearch probing = {.propagation = &search->propagation, .tick = tick, .context = search};
    MesoSearchOutcome outcome;
    MesoStatus status = meso_search_probe(&probing, probe_work, &outcome, error);
    if (status)
        return status;
    if (outcome == MESO_SEARCH_STOPPED)
        result->decider = MESO_DECIDER_STOP;
    if (outcome != MESO_SEARCH_IMPOSSIBLE)
        return MESO_OK;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_PROBING;
    result->reason = meso_arena_print(search->arena, error, "each tile that fits slot %u leads to a slot without any, "
                                      "once what leads there at once is ruled out everywhere",
                                      probing.impossible_slot);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

/* The exact engine, for a while; then, where it did not do, probing, and the engine on what that leaves. */
static MesoStatus decide_at_length(Search *search, bool guided, MesoError *error)
{
    const MesoSolveResult *result = search->result;
    uint64_t conflicts = search->options->max_conflicts ? search->options->max_conflicts : MESO_SOLVE_CONFLICTS;
    uint64_t first = conflicts < FIRST_CONFLICTS || guided ? conflicts : FIRST_CONFLICTS;
    MesoStatus status = decide_exactly(search, first, error);
    if (status || result->decider != MESO_DECIDER_CONFLICTS || conflicts == first)
        return status;
    status = probe(search, error);
    if (status || result->decider != MESO_DECIDER_CONFLICTS)
        return status;
    return decide_exactly(search, conflicts - first, error);
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

/*
 * Which constraints are disproved, in words, before the reason that there is: by
 * the initial fixed point, or where `deep` by more. No news where the fault is not theirs.
 */
static MesoStatus explain(Search *search, bool deep, MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    MesoSolveResult *result = search->result;
    if (!constraints || search->options->unexplained || meso_constraint_count(constraints) == 0)
        return MESO_OK;
    uint32_t count = 0, slot = !deep && result->dead_end_count ? result->dead_ends[0].slot : MESO_NO_INDEX;
    uint32_t *numbers = MESO_NEW(&search->scratch, uint32_t, meso_constraint_count(constraints), error);
    if (!numbers || meso_explain(numbers, &count, search->set, search->variants, search->graph, constraints,
                                 slot, deep, search->options->seed, error))
        return MESO_ERR_MEMORY;
    if (deep && count == 0)
        return MESO_OK;
    const char *text = meso_explanation_text(search->arena, constraints, numbers, count, error);
    if (text && *result->reason)
        text = meso_arena_print(search->arena, error, "%s: %s", text, result->reason);
    result->reason = text;
    return text ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus say_disproved(Search *search, MesoError *error)
{
    search->result->verdict = MESO_VERDICT_UNSOLVABLE;
    search->result->decider = MESO_DECIDER_PROPAGATION;
    MesoStatus status = record_initial_dead_ends(search, error);
    return status ? status : explain(search, false, error);
}

/* After a guided search without a solution: the constraint that it met most often, in words. */
static MesoStatus say_violations(Search *search, MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    MesoSolveResult *result = search->result;
    uint32_t worst = 0, count = meso_constraint_count(constraints);
    if (search->guided.exhausted) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->decider = MESO_DECIDER_SEARCH;
        result->reason = "every choice was tried";
    }
    for (uint32_t i = 0; i < count; i++)
        if (result->violations[i] > result->violations[worst])
            worst = i;
    if (count == 0 || result->violations[worst] == 0)
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
    search->result->violations = violations;
    search->guided.tick = tick;
    search->guided.context = search;
    if (search->options->max_observations)
        search->guided.max_observations = search->options->max_observations;
    return status;
}

/* The search's rung under quotas, rules on strands, or with an assignment to keep. */
static MesoStatus search_guided(Search *search, MesoError *error)
{
    MesoGuidedSearch *guided = &search->guided;
    MesoSolveResult *result = search->result;
    bool solved = false;
    MesoStatus status = MESO_OK;
    while (!status && !solved && !guided->exhausted && !guided->stopped &&
           result->attempts < search->options->max_attempts) {
        MesoRandom random;
        meso_random_init(&random, search->options->seed, ++result->attempts);
        status = meso_propagation_restart(&search->propagation, error);
        if (!status)
            status = meso_guided_attempt(guided, &random, &solved, error);
        /* Where a quota or strands ended the attempt, there is no dead slot to tell of. */
        if (!status && !solved && search->propagation.dead_slot != MESO_NO_INDEX)
            status = record_dead_end(search, search->propagation.dead_slot, result->attempts, error);
    }
    result->observations = guided->observations;
    result->backtracks = guided->backtracks;
    if (status)
        return status;
    if (!tick(search))
        result->decider = MESO_DECIDER_STOP;
    return solved ? accept_states(search, error) : say_violations(search, error);
}

/* The ladder: each rung leaves the verdict "gave up", or a better one. */
static MesoStatus climb(Search *search, bool guided, MesoError *error)
{
    MesoSolveResult *result = search->result;
    MesoEngine engine = search->options->engine;
    MesoStatus status = MESO_OK;
    result->verdict = MESO_VERDICT_GAVE_UP;
    result->decider = MESO_DECIDER_ATTEMPTS;
    if (engine != MESO_ENGINE_EXACT)
        status = guided ? search_guided(search, error) : search_for(search, error);
    if (status || engine == MESO_ENGINE_WFC || result->decider == MESO_DECIDER_STOP)
        return status;
    if (result->verdict == MESO_VERDICT_GAVE_UP)
        status = decide_by_numbers(search, error);
    if (!status && result->verdict == MESO_VERDICT_GAVE_UP)
        status = decide_at_length(search, guided, error);
    return status;
}

static MesoStatus run(Search *search, MesoError *error)
{
    const MesoConstraints *constraints = search->options->constraints;
    bool guided = constraints && meso_constraints_need_guidance(constraints);
    bool disproved = search->propagation.initial_dead_count ||
                     search->propagation.broken_quota != MESO_NO_INDEX;
    MesoStatus status = !disproved && guided ? prepare_guided(search, &disproved, error) : MESO_OK;
    if (!status && disproved)
        return say_disproved(search, error);
    if (!status)
        status = climb(search, guided, error);
    if (!status && search->result->verdict == MESO_VERDICT_UNSOLVABLE)
        status = explain(search, true, error);
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
                                              graph, options->constraints, error);
    if (!status)
        status = allocate_dead_ends(&search, error);
    if (!status)
        status = run(&search, error);
    meso_propagation_release(&search.propagation);
    meso_arena_release(&search.scratch);
    return status;
}
