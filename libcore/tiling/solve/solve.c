#include "libcore/tiling/solve/solve.h"

#include <assert.h>
#include <string.h>

#include "libcore/tiling/exact/chain_search.h"
#include "libcore/tiling/exact/exact_control.h"
#include "libcore/tiling/exact/exact_cubes.h"
#include "libcore/tiling/exact/fewest_changes.h"
#include "libcore/tiling/proof/counting.h"
#include "libcore/tiling/proof/parity.h"
#include "libcore/tiling/propagate/initial_states.h"
#include "libcore/tiling/search/constrained_search.h"
#include "libcore/tiling/search/search.h"
#include "libcore/tiling/search/strand_places.h"
#include "libcore/tiling/solve/verdict_text.h"

/* Word operations of the parity prover: a second or two. */
static const uint64_t parity_work = (uint64_t)1 << 32;

/* Changes of states that probing may make: half a minute or less. */
static const uint64_t probe_work = (uint64_t)1 << 27;

/* Attempts of the search before provers and the exact engine have a first go; the latter up to so many slots. */
enum { FIRST_ATTEMPTS = 4, FIRST_GO_SLOTS = 1 << 16 };

/* Conflicts that the exact engine has before further attempts, and again before probing: about a second. */
enum { FIRST_CONFLICTS = 3000 };

/* Conflicts that the exact engine has with random phases, which vary the solutions, before it follows its own. */
enum { PHASED_CONFLICTS = 1000 };

/* Conflicts that it then has by cubes (exact_cubes.h), where that gets on. */
enum { CUBE_CONFLICTS = 200000 };

/* Conflicts that it has to change fewer of the variants to keep: some seconds. */
enum { KEEP_CONFLICTS = 20000 };

/* Looks at an edge of the chain search that comes then: some fifteen seconds. */
static const uint64_t chain_work = (uint64_t)1 << 31;

/* Solutions of the exact engine that a rule on strands may cut off: fewer on a large surface. */
enum { LEAST_CUT_ROUNDS = 20, MOST_CUT_ROUNDS = 50000, CUT_SLOTS = 1 << 20 };

typedef struct Search {
    const MesoTilingProblem *problem;
    const MesoSolveOptions *options;
    MesoSolveResult *result;
    MesoArena *arena;               /* of the result */
    MesoArena scratch;
    MesoArena hot_arena;            /* of `hot_spots`, which are there from the first dead end on */
    MesoHotSpots hot_spots;
    MesoPropagation propagation;
    MesoSearch wfc;                 /* the search where no constraint calls for guidance */
    MesoConstrainedSearch guided;        /* where one does */
    uint32_t *best_variant;         /* [slot_count] where the best attempt ended; MESO_NO_INDEX: undecided. NULL: none
                                       failed yet */
    uint32_t best_open;             /* slots that it left undecided */
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
        uint32_t twin = search->problem->graph->twin[4 * (size_t)slot + k];
        end->border[k] = twin == MESO_NO_INDEX;
        end->labels[k] = labels + k * words;
        /* A neighbour that is dead, or the slot itself, demands nothing in particular. */
        if (twin == MESO_NO_INDEX || twin / 4 == slot ||
            propagation->state[twin / 4] == MESO_DOMAIN_EMPTY)
            meso_border_labels(search->problem->set, end->border[k], end->labels[k]);
        else
            memcpy(end->labels[k], meso_propagation_allowed(propagation, slot, k), words * sizeof *labels);
    }
    return MESO_OK;
}

static MesoStatus record_initial_dead_ends(Search *search, MesoError *error)
{
    for (uint32_t s = search->problem->graph->slot_count; s-- > 0;)
        if (search->propagation.state[s] == MESO_DOMAIN_EMPTY)
            search->result->conflict_slot = s;
    for (uint32_t s = 0; s < search->problem->graph->slot_count; s++)
        if (search->propagation.state[s] == MESO_DOMAIN_EMPTY && record_dead_end(search, s, 0, error))
            return MESO_ERR_MEMORY;
    return MESO_OK;
}

static bool told_to_stop(const Search *search)
{
    return search->options->stop && search->options->stop(search->options->stop_context);
}

static void stop(Search *search)
{
    search->result->decider = MESO_DECIDER_STOP;
    search->result->budget = MESO_BUDGET_TIME;
}

/* Tells the progress; false where the search is to stop. */
static bool tick(void *context)
{
    const Search *search = context;
    uint32_t total = search->problem->graph->slot_count;
    if (search->options->progress)
        search->options->progress(search->options->progress_context,
                                  total - search->propagation.queue.count, total);
    return !told_to_stop(search);
}

static MesoStatus note_dead_end(void *context, uint32_t slot, bool first, MesoError *error)
{
    Search *search = context;
    if (meso_hot_spots_reserve_one(&search->hot_spots, &search->hot_arena, error))
        return MESO_ERR_MEMORY;
    meso_hot_spots_add(&search->hot_spots, slot);
    return first ? record_dead_end(search, slot, search->result->attempts, error) : MESO_OK;
}

/* Takes variant[slot_count] as the solution, once checked. */
static MesoStatus accept(Search *search, const uint32_t *variant, MesoDecider decider, MesoError *error)
{
    MesoAssignment *assignment = &search->result->assignment;
    uint32_t count = search->problem->graph->slot_count;

    assignment->tile = MESO_NEW(search->arena, uint32_t, count, error);
    assignment->transform = MESO_NEW(search->arena, MesoTransform, count, error);
    if (!assignment->tile || !assignment->transform)
        return MESO_ERR_MEMORY;
    assignment->slot_count = count;
    for (uint32_t s = 0; s < count; s++) {
        assignment->tile[s] = search->problem->variants->tile[variant[s]];
        assignment->transform[s] = search->problem->variants->transform[variant[s]];
    }
    MesoError finding;
    const MesoConstraints *constraints = search->problem->constraints;
    if (meso_assignment_check(assignment, search->problem->set, search->problem->graph, &finding) ||
        (constraints && meso_constraints_check(constraints, assignment, search->problem->set, search->problem->variants,
                                               search->problem->graph, &finding)))
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
    uint32_t count = search->problem->graph->slot_count;
    uint32_t *variant = MESO_NEW(&search->scratch, uint32_t, count, error);
    if (!variant)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < count; s++)
        variant[s] = meso_domain_variant(&propagation->domains, propagation->state[s], 0);
    return accept(search, variant, MESO_DECIDER_SEARCH, error);
}

/* Keeps where an attempt that failed ended, if none came farther. */
static MesoStatus keep_best(Search *search, MesoError *error)
{
    const MesoPropagation *propagation = &search->propagation;
    uint32_t count = search->problem->graph->slot_count;
    if (search->best_variant && propagation->queue.count >= search->best_open)
        return MESO_OK;
    if (!search->best_variant)
        search->best_variant = MESO_NEW(&search->scratch, uint32_t, count, error);
    if (!search->best_variant)
        return MESO_ERR_MEMORY;
    search->best_open = propagation->queue.count;
    for (uint32_t s = 0; s < count; s++)
        search->best_variant[s] = propagation->domains.domains[propagation->state[s]].size == 1
                                      ? meso_domain_variant(&propagation->domains, propagation->state[s], 0)
                                      : MESO_NO_INDEX;
    return MESO_OK;
}

/* Before the first attempt. */
static void prepare_search(Search *search)
{
    const MesoSolveOptions *options = search->options;
    search->wfc = (MesoSearch){.propagation = &search->propagation, .constraints = search->problem->constraints,
                               .tick = tick, .dead_end = note_dead_end, .context = search,
                               .fewest_open = search->propagation.queue.count,
                               .max_observations = options->max_observations ? options->max_observations : UINT64_MAX};
}

/* A dead end that hangs on no choice. */
static MesoStatus say_impossible(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_SEARCH;
    result->conflict_slot = search->wfc.impossible_slot;
    result->reason = meso_arena_print(search->arena, error, search->wfc.impossible_at_once
                                          ? "each tile that fits slot %u leaves another slot without any"
                                          : "whatever is chosen around slot %u, it leaves a slot without any tile",
                                      result->conflict_slot);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

/* The search's rung: attempts from sub-seeds, up to `last` in all. */
static MesoStatus search_for(Search *search, uint32_t last, MesoError *error)
{
    MesoSolveResult *result = search->result;
    const MesoSolveOptions *options = search->options;
    MesoSearch *wfc = &search->wfc;
    MesoSearchOutcome outcome = MESO_SEARCH_STUCK;
    MesoStatus status = MESO_OK;
    while (!status && outcome == MESO_SEARCH_STUCK && result->attempts < last) {
        wfc->attempts_before = result->attempts++;
        meso_random_init(&wfc->random, options->seed, result->attempts);
        meso_propagation_restart(&search->propagation);
        status = meso_search_attempt(wfc, &outcome, error);
        if (!status && outcome != MESO_SEARCH_DONE)
            status = keep_best(search, error);
    }
    result->observations = wfc->observations;
    result->jumps = wfc->jumps;
    result->repairs = wfc->repairs;
    result->decided_most = search->problem->graph->slot_count - wfc->fewest_open;
    if (status)
        return status;
    tick(search);
    if (outcome == MESO_SEARCH_DONE)
        return accept_states(search, error);
    if (outcome == MESO_SEARCH_IMPOSSIBLE)
        return say_impossible(search, error);
    result->decider = MESO_DECIDER_ATTEMPTS;
    result->budget = outcome == MESO_SEARCH_STOPPED ? MESO_BUDGET_OBSERVATIONS : MESO_BUDGET_ATTEMPTS;
    if (told_to_stop(search))
        stop(search);
    return MESO_OK;
}

/* The states of one variant each where variant[slot_count] says one, and the initial ones elsewhere. */
static MesoStatus fill_single_states(Search *search, const uint32_t *variant, uint32_t *states, MesoError *error)
{
    for (uint32_t s = 0; s < search->problem->graph->slot_count; s++) {
        states[s] = variant[s] == MESO_NO_INDEX
                        ? search->propagation.initial[s]
                        : meso_domain_single(&search->propagation.domains, variant[s], error);
        if (states[s] == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

/*
 * `hint` [slot_count] has the states that decisions try first; `left` are the conflicts that may be
 * met, `cubes` those that may be met beyond them by cubes.
 */
static MesoStatus ask_engine(Search *search, MesoExact *exact, const uint32_t *hint, MesoSatAnswer *answer,
                             MesoRandom *random, uint64_t left, uint64_t cubes, MesoError *error)
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
    if (!status)
        status = meso_sat_solve(exact->sat, answer, NULL, 0, left < INT32_MAX ? (uint32_t)left : INT32_MAX,
                                options->stop, options->stop_context, error);
    if (status || *answer != MESO_SAT_UNKNOWN || cubes == 0 || told_to_stop(search))
        return status;
    uint64_t before = meso_sat_conflicts(exact->sat);
    status = meso_exact_conquer(exact, answer, random, MESO_EXACT_CUBE_CONFLICTS, cubes, options->stop,
                                options->stop_context, error);
    if (status || *answer != MESO_SAT_UNKNOWN || told_to_stop(search))
        return status;
    uint64_t used = meso_sat_conflicts(exact->sat) - before;
    return meso_exact_search_chains(exact, answer, random, chain_work, used < cubes ? cubes - used : 0, options->stop,
                                    options->stop_context, error);
}

/* Tells the answer; a solution goes to `variant`, unless it breaks the rule on strands: then there are `*cuts`. */
static MesoStatus read_answer(Search *search, MesoExact *exact, MesoSatAnswer answer, uint32_t *variant,
                              uint32_t *cuts, MesoRandom *random, MesoError *error)
{
    const MesoConstraints *constraints = search->problem->constraints;
    MesoSolveResult *result = search->result;
    if (answer == MESO_SAT_NO) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->reason = "the exact engine went through all cases";
    }
    result->decider = answer != MESO_SAT_UNKNOWN ? MESO_DECIDER_EXACT : MESO_DECIDER_CONFLICTS;
    result->budget = MESO_BUDGET_CONFLICTS;
    if (answer == MESO_SAT_UNKNOWN && told_to_stop(search))
        stop(search);
    if (answer != MESO_SAT_YES)
        return MESO_OK;
    MesoStatus status = meso_exact_extract(exact, variant, random, error);
    if (!status && constraints && meso_strand_rule_given(&constraints->strands))
        status = meso_exact_cut_strands(exact, &constraints->strands, variant, search->problem->variants, cuts, error);
    return status || *cuts ? status : accept(search, variant, MESO_DECIDER_EXACT, error);
}

/* Asks until there is an answer that no rule on strands cuts off, each time for one like the last. */
static MesoStatus ask_until_kept(Search *search, MesoExact *exact, MesoRandom *random, uint64_t conflicts,
                                 uint64_t cubes, MesoError *error)
{
    const MesoConstraints *constraints = search->problem->constraints;
    const uint32_t *hint = NULL, *like = constraints && constraints->keep ? constraints->keep : search->best_variant;
    uint32_t *variant = MESO_NEW(&search->scratch, uint32_t, search->problem->graph->slot_count, error);
    uint32_t *like_last = MESO_NEW(&search->scratch, uint32_t, search->problem->graph->slot_count, error);
    if (!variant || !like_last)
        return MESO_ERR_MEMORY;
    if (like) {
        if (fill_single_states(search, like, like_last, error))
            return MESO_ERR_MEMORY;
        hint = like_last;
    }
    uint32_t rounds = LEAST_CUT_ROUNDS + CUT_SLOTS / search->problem->graph->slot_count;
    rounds = rounds < MOST_CUT_ROUNDS ? rounds : MOST_CUT_ROUNDS;
    for (uint32_t round = 0; round < rounds; round++) {
        MesoSatAnswer answer = MESO_SAT_UNKNOWN;
        uint32_t cuts = 0;
        MesoStatus status = ask_engine(search, exact, hint, &answer, random, conflicts, cubes, error);
        if (!status)
            status = read_answer(search, exact, answer, variant, &cuts, random, error);
        if (status || cuts == 0)
            return status;
        if (fill_single_states(search, variant, like_last, error))
            return MESO_ERR_MEMORY;
        hint = like_last;
        if (told_to_stop(search)) {
            stop(search);
            return MESO_OK;
        }
    }
    search->result->decider = MESO_DECIDER_CONFLICTS;
    search->result->budget = MESO_BUDGET_CUTS;
    return MESO_OK;
}

/* With chains or without, by `conflicts` at most, and by cubes with `cubes` beyond them. */
static MesoStatus decide_exactly(Search *search, bool chains, uint64_t conflicts, uint64_t cubes, MesoError *error)
{
    const MesoConstraints *constraints = search->problem->constraints;
    MesoExact exact;
    MesoRandom random;
    MesoExactOptions options = {.chains = chains, .constraints = constraints, .proof = search->options->proof,
                                .clause = search->options->clause, .context = search->options->proof_context,
                                .grows = constraints && meso_strand_rule_given(&constraints->strands)};
    MesoArenaMark mark = meso_arena_mark(&search->scratch);
    bool complete = true;
    meso_random_init(&random, search->options->seed, UINT64_MAX);
    if (search->options->formula)
        search->options->formula(search->options->proof_context);
    if (constraints && meso_exact_groups(&options.group, &search->scratch, constraints, search->problem->variants->count, error))
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_exact_init(&exact, &search->scratch, &search->propagation, &options, error);
    if (status == MESO_ERR_LIMIT) {
        meso_exact_release(&exact);
        meso_arena_rewind(&search->scratch, mark);
        search->result->decider = MESO_DECIDER_CONFLICTS;
        search->result->budget = MESO_BUDGET_FORMULA;
        return MESO_OK;
    }
    if (!status && constraints)
        status = meso_exact_add_quotas(&exact, constraints, &complete, error);
    /* Where a quota is too large to be counted, what the engine finds need not keep to it. */
    if (!status && complete)
        status = ask_until_kept(search, &exact, &random, conflicts, cubes, error);
    if (!status && complete)
        search->result->conflicts += meso_sat_conflicts(exact.sat);
    else
        search->result->budget = MESO_BUDGET_COUNTED;
    meso_exact_release(&exact);
    meso_arena_rewind(&search->scratch, mark);
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
        stop(search);
    if (outcome != MESO_SEARCH_IMPOSSIBLE)
        return MESO_OK;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_PROBING;
    result->conflict_slot = probing.impossible_slot;
    result->reason = meso_arena_print(search->arena, error, "each tile that fits slot %u leads to a slot without any, "
                                      "once what leads there at once is ruled out everywhere",
                                      probing.impossible_slot);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

/* Lets the exact engine have its conflicts. */
static void allow_conflicts(Search *search)
{
    uint64_t most = search->options->max_conflicts;
    search->result->conflict_limit = most ? most : MESO_SOLVE_CONFLICTS;
}

/* Of these, `most` or what is left. */
static uint64_t conflicts_left(const Search *search, uint64_t most)
{
    const MesoSolveResult *result = search->result;
    uint64_t left = result->conflict_limit > result->conflicts ? result->conflict_limit - result->conflicts : 0;
    return left < most ? left : most;
}

/*
 * The exact engine, for a while, and by cubes; then, where it did not do, probing, and the engine
 * anew on what that leaves, without chains: where there are many solutions, but few are near, they
 * lead it astray.
 */
static MesoStatus decide_at_length(Search *search, bool guided, MesoError *error)
{
    MesoSolveResult *result = search->result;
    allow_conflicts(search);
    result->decider = MESO_DECIDER_CONFLICTS;
    result->budget = MESO_BUDGET_CONFLICTS;
    if (conflicts_left(search, 1) == 0)
        return MESO_OK;
    if (guided)
        return decide_exactly(search, false, conflicts_left(search, UINT64_MAX), 0, error);
    uint64_t first = conflicts_left(search, FIRST_CONFLICTS);
    uint64_t left = conflicts_left(search, UINT64_MAX) - first;
    MesoStatus status = decide_exactly(search, true, first, left < CUBE_CONFLICTS ? left : CUBE_CONFLICTS, error);
    if (status || result->decider != MESO_DECIDER_CONFLICTS || left == 0)
        return status;
    status = probe(search, error);
    if (status || result->decider != MESO_DECIDER_CONFLICTS)
        return status;
    left = conflicts_left(search, UINT64_MAX);
    return left ? decide_exactly(search, false, left, 0, error) : MESO_OK;
}

/* Counting, then parity: cheap where they prove something, and hopeless for the exact engine. */
static MesoStatus decide_by_numbers(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    MesoLabelPatternTable table;
    MesoCountingProof proof;
    uint32_t slot;
    if (meso_label_pattern_table_init(&table, &search->scratch, &search->propagation, NULL, error) ||
        meso_counting_prove(&proof, &search->scratch, &table, error))
        return MESO_ERR_MEMORY;
    if (proof.found) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->decider = MESO_DECIDER_COUNTING;
        result->reason = meso_counting_explain(&proof, search->arena, search->problem->set, error);
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

static MesoStatus say_disproved(Search *search, MesoError *error)
{
    search->result->verdict = MESO_VERDICT_UNSOLVABLE;
    search->result->decider = MESO_DECIDER_PROPAGATION;
    uint32_t quota = search->propagation.broken_quota;
    if (search->propagation.initial_dead_count || quota == MESO_NO_INDEX)
        return record_initial_dead_ends(search, error);
    search->result->reason = meso_broken_quota_text(search->arena, &search->propagation.quotas, quota, error);
    return search->result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus say_exhausted(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_SEARCH;
    result->reason = meso_violations_text(search->arena, "every choice was tried", result,
                                          search->problem->constraints, error);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus say_gave_up(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    result->reason = meso_gave_up_text(search->arena, result, search->problem, error);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus tell_hot_spots(Search *search, MesoError *error)
{
    MesoSolveResult *result = search->result;
    result->dead_ends_met = search->hot_spots.total;
    if (result->verdict == MESO_VERDICT_SOLVED || search->hot_spots.total == 0)
        return MESO_OK;
    result->hot_spots = MESO_NEW(search->arena, MesoHotSpot, MESO_SOLVE_HOT_SPOTS, error);
    if (!result->hot_spots)
        return MESO_ERR_MEMORY;
    result->hot_spot_count = meso_hot_spots_top(&search->hot_spots, result->hot_spots, MESO_SOLVE_HOT_SPOTS);
    return MESO_OK;
}

static MesoStatus prepare_guided(Search *search, bool *disproved, MesoError *error)
{
    const MesoConstraints *constraints = search->problem->constraints;
    uint64_t *violations = MESO_NEW(search->arena, uint64_t, meso_constraint_count(constraints), error);
    if (!violations)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_constrained_search_init(&search->guided, &search->scratch, &search->propagation,
                                         search->problem->variants, constraints, violations, disproved, error);
    search->result->violations = violations;
    search->guided.tick = tick;
    search->guided.context = search;
    search->guided.fewest_open = search->propagation.queue.count;
    if (search->options->max_observations)
        search->guided.max_observations = search->options->max_observations;
    if (!status)
        status = meso_hot_spots_reserve(&search->hot_spots, &search->hot_arena, error);
    search->guided.hot_spots = &search->hot_spots;
    return status;
}

/* The search's rung under quotas, rules on strands, or with an assignment to keep. */
static MesoStatus search_guided(Search *search, MesoError *error)
{
    MesoConstrainedSearch *guided = &search->guided;
    MesoSolveResult *result = search->result;
    bool solved = false;
    MesoStatus status = MESO_OK;
    while (!status && !solved && !guided->exhausted && !guided->stopped &&
           result->attempts < search->options->max_attempts) {
        MesoRandom random;
        meso_random_init(&random, search->options->seed, ++result->attempts);
        meso_propagation_restart(&search->propagation);
        status = meso_constrained_search_attempt(guided, &random, &solved, error);
        if (!status && !solved)
            status = keep_best(search, error);
        /* Where a quota or strands ended the attempt, there is no dead slot to tell of. */
        if (!status && !solved && search->propagation.dead_slot != MESO_NO_INDEX)
            status = record_dead_end(search, search->propagation.dead_slot, result->attempts, error);
    }
    result->observations = guided->observations;
    result->backtracks = guided->backtracks;
    result->decided_most = search->problem->graph->slot_count - guided->fewest_open;
    if (status)
        return status;
    if (guided->stopped)
        result->budget = MESO_BUDGET_OBSERVATIONS;
    if (!tick(search))
        stop(search);
    if (!solved && !guided->exhausted)
        return MESO_OK;
    return solved ? accept_states(search, error) : say_exhausted(search, error);
}

/* Whether there is a rung left to climb. */
static bool undecided(const Search *search)
{
    return search->result->verdict == MESO_VERDICT_GAVE_UP && search->result->decider != MESO_DECIDER_STOP;
}

/*
 * The ladder without quotas and the like: each rung leaves the verdict "gave up", or a better one. A few attempts of
 * the search; what is cheap and may prove that there is nothing to be found; the other attempts, which
 * have more patience; the exact engine at length.
 */
static MesoStatus climb(Search *search, MesoError *error)
{
    uint32_t attempts = search->options->max_attempts;
    MesoEngine engine = search->options->engine;
    bool searching = engine != MESO_ENGINE_EXACT, proving = engine != MESO_ENGINE_WFC;
    uint32_t first_attempts = proving && attempts > FIRST_ATTEMPTS ? FIRST_ATTEMPTS : attempts;
    MesoStatus status = MESO_OK;
    prepare_search(search);
    if (searching)
        status = search_for(search, first_attempts, error);
    if (!proving)
        return status;
    if (!status && undecided(search))
        status = decide_by_numbers(search, error);
    bool more = searching && first_attempts < attempts && search->result->budget == MESO_BUDGET_ATTEMPTS;
    /* On a large surface the formula alone takes longer, and more memory, than the attempts. */
    if (!status && undecided(search) && more && search->problem->graph->slot_count <= FIRST_GO_SLOTS) {
        allow_conflicts(search);
        status = decide_exactly(search, true, conflicts_left(search, FIRST_CONFLICTS), 0, error);
    }
    if (!status && undecided(search) && more)
        status = search_for(search, attempts, error);
    return !status && undecided(search) ? decide_at_length(search, false, error) : status;
}

/* The ladder with them: the search for their sake has its own ways back. */
static MesoStatus climb_guided(Search *search, MesoError *error)
{
    MesoEngine engine = search->options->engine;
    MesoStatus status = engine != MESO_ENGINE_EXACT ? search_guided(search, error) : MESO_OK;
    if (engine == MESO_ENGINE_WFC)
        return status;
    if (!status && undecided(search))
        status = decide_by_numbers(search, error);
    return !status && undecided(search) ? decide_at_length(search, true, error) : status;
}

/* The assignment that was found, with as few changes as the exact engine finds. */
static MesoStatus keep_more(Search *search, MesoError *error)
{
    const MesoSolveOptions *options = search->options;
    MesoSolveResult *result = search->result;
    const MesoAssignment *found = &result->assignment;
    uint64_t conflicts;
    allow_conflicts(search);
    const MesoFewestChangesOptions keep = {.seed = options->seed, .max_conflicts = conflicts_left(search, KEEP_CONFLICTS),
                                  .stop = options->stop, .stop_context = options->stop_context};
    uint32_t *variant = MESO_NEW(&search->scratch, uint32_t, found->slot_count, error);
    if (!variant)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < found->slot_count; s++)
        variant[s] = meso_variant_find(search->problem->variants, search->problem->set, found->tile[s], found->transform[s]);
    MesoStatus status = meso_fewest_changes(variant, &result->changes_fewest, &conflicts, &search->propagation,
                                       search->problem->variants, search->problem->constraints, &keep, error);
    if (status)
        return status;
    result->conflicts += conflicts;
    return accept(search, variant, result->decider, error);
}

static MesoStatus begin_to_climb(Search *search, bool guided, MesoError *error)
{
    MesoSolveResult *result = search->result;
    result->verdict = MESO_VERDICT_GAVE_UP;
    result->decider = MESO_DECIDER_ATTEMPTS;
    MesoStatus status = guided ? climb_guided(search, error) : climb(search, error);
    const MesoConstraints *constraints = search->problem->constraints;
    if (status || result->verdict != MESO_VERDICT_SOLVED || !constraints || !constraints->keep)
        return status;
    result->changes_fewest = meso_constraints_changed(constraints, &result->assignment, search->problem->variants) == 0;
    return result->changes_fewest || search->options->engine == MESO_ENGINE_WFC ? MESO_OK : keep_more(search, error);
}

static MesoStatus run(Search *search, MesoError *error)
{
    const MesoConstraints *constraints = search->problem->constraints;
    bool guided = constraints && meso_constraints_need_guidance(constraints);
    bool disproved = search->propagation.initial_dead_count ||
                     search->propagation.broken_quota != MESO_NO_INDEX;
    MesoStatus status = !disproved && guided ? prepare_guided(search, &disproved, error) : MESO_OK;
    if (!status)
        status = disproved ? say_disproved(search, error) : begin_to_climb(search, guided, error);
    if (!status)
        status = tell_hot_spots(search, error);
    if (!status && search->result->verdict == MESO_VERDICT_GAVE_UP)
        status = say_gave_up(search, error);
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

MesoStatus meso_solve(MesoSolveResult *result, MesoArena *arena, const MesoTilingProblem *problem,
                      const MesoSolveOptions *options, MesoError *error)
{
    assert(options->max_attempts >= 1);
    *result = (MesoSolveResult){.label_word_count = meso_bits_words(2 * problem->set->interface_count), .reason = "",
                                .conflict_slot = MESO_NO_INDEX};
    if (problem->variants->count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "no tile to solve with: the set has none, or ignores all");

    Search search = {.problem = problem, .options = options, .result = result, .arena = arena};
    meso_arena_init(&search.scratch);
    meso_arena_init(&search.hot_arena);
    MesoStatus status = meso_strand_places_init(&search.propagation, &search.scratch, problem, error);
    if (!status)
        status = allocate_dead_ends(&search, error);
    if (!status)
        status = run(&search, error);
    meso_propagation_release(&search.propagation);
    meso_arena_release(&search.scratch);
    meso_arena_release(&search.hot_arena);
    return status;
}
