/* The rungs of the ladder that ask the exact engine. */
#include "libcore/tiling/exact/chain_search.h"
#include "libcore/tiling/exact/exact_control.h"
#include "libcore/tiling/exact/exact_cubes.h"
#include "libcore/tiling/exact/fewest_changes.h"
#include "libcore/tiling/solve/ladder.h"

/* Changes of states that probing may make: half a minute or less. */
static const uint64_t probe_work = (uint64_t)1 << 27;

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

/* The states of one variant each where variant[slot_count] says one, and the initial ones elsewhere. */
static MesoStatus fill_single_states(MesoLadder *ladder, const uint32_t *variant, uint32_t *states, MesoError *error)
{
    for (uint32_t s = 0; s < ladder->problem->graph->slot_count; s++) {
        states[s] = variant[s] == MESO_NO_INDEX
                        ? ladder->propagation.initial[s]
                        : meso_domain_single(&ladder->propagation.domains, variant[s], error);
        if (states[s] == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

/*
 * `hint` [slot_count] has the states that decisions try first; `left` are the conflicts that may be
 * met, `cubes` those that may be met beyond them by cubes.
 */
static MesoStatus ask_engine(MesoLadder *ladder, MesoExact *exact, const uint32_t *hint, MesoSatAnswer *answer,
                             MesoRandom *random, uint64_t left, uint64_t cubes, MesoError *error)
{
    const MesoSolveOptions *options = ladder->options;
    uint32_t phased = left < PHASED_CONFLICTS ? (uint32_t)left : PHASED_CONFLICTS;
    MesoStatus status = meso_exact_choose_phases(exact, hint, random, error);
    if (!status)
        status = meso_sat_solve(exact->sat, answer, NULL, 0, phased, options->stop,
                                options->stop_context, error);
    left -= phased;
    if (status || *answer != MESO_SAT_UNKNOWN || left == 0 || meso_ladder_told_to_stop(ladder))
        return status;
    status = meso_sat_forget_phases(exact->sat, error);
    if (!status)
        status = meso_sat_solve(exact->sat, answer, NULL, 0, left < INT32_MAX ? (uint32_t)left : INT32_MAX,
                                options->stop, options->stop_context, error);
    if (status || *answer != MESO_SAT_UNKNOWN || cubes == 0 || meso_ladder_told_to_stop(ladder))
        return status;
    uint64_t before = meso_sat_conflicts(exact->sat);
    status = meso_exact_conquer(exact, answer, random, MESO_EXACT_CUBE_CONFLICTS, cubes, options->stop,
                                options->stop_context, error);
    if (status || *answer != MESO_SAT_UNKNOWN || meso_ladder_told_to_stop(ladder))
        return status;
    uint64_t used = meso_sat_conflicts(exact->sat) - before;
    return meso_exact_search_chains(exact, answer, random, chain_work, used < cubes ? cubes - used : 0, options->stop,
                                    options->stop_context, error);
}

/* Tells the answer; a solution goes to `variant`, unless it breaks the rule on strands: then there are `*cuts`. */
static MesoStatus read_answer(MesoLadder *ladder, MesoExact *exact, MesoSatAnswer answer, uint32_t *variant,
                              uint32_t *cuts, MesoRandom *random, MesoError *error)
{
    const MesoConstraints *constraints = ladder->problem->constraints;
    MesoSolveResult *result = ladder->result;
    if (answer == MESO_SAT_NO) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->reason = "the exact engine went through all cases";
    }
    result->decider = answer != MESO_SAT_UNKNOWN ? MESO_DECIDER_EXACT : MESO_DECIDER_CONFLICTS;
    result->budget = MESO_BUDGET_CONFLICTS;
    if (answer == MESO_SAT_UNKNOWN && meso_ladder_told_to_stop(ladder))
        meso_ladder_stop(ladder);
    if (answer != MESO_SAT_YES)
        return MESO_OK;
    MesoStatus status = meso_exact_extract(exact, variant, random, error);
    if (!status && constraints && meso_strand_rule_given(&constraints->strands))
        status = meso_exact_cut_strands(exact, &constraints->strands, variant, ladder->problem->variants, cuts, error);
    return status || *cuts ? status : meso_ladder_accept(ladder, variant, MESO_DECIDER_EXACT, error);
}

/* Asks until there is an answer that no rule on strands cuts off, each time for one like the last. */
static MesoStatus ask_until_kept(MesoLadder *ladder, MesoExact *exact, MesoRandom *random, uint64_t conflicts,
                                 uint64_t cubes, MesoError *error)
{
    const MesoConstraints *constraints = ladder->problem->constraints;
    const uint32_t *hint = NULL, *like = constraints && constraints->keep ? constraints->keep : ladder->best_variant;
    uint32_t *variant = MESO_NEW(&ladder->scratch, uint32_t, ladder->problem->graph->slot_count, error);
    uint32_t *like_last = MESO_NEW(&ladder->scratch, uint32_t, ladder->problem->graph->slot_count, error);
    if (!variant || !like_last)
        return MESO_ERR_MEMORY;
    if (like) {
        if (fill_single_states(ladder, like, like_last, error))
            return MESO_ERR_MEMORY;
        hint = like_last;
    }
    uint32_t rounds = LEAST_CUT_ROUNDS + CUT_SLOTS / ladder->problem->graph->slot_count;
    rounds = rounds < MOST_CUT_ROUNDS ? rounds : MOST_CUT_ROUNDS;
    for (uint32_t round = 0; round < rounds; round++) {
        MesoSatAnswer answer = MESO_SAT_UNKNOWN;
        uint32_t cuts = 0;
        MesoStatus status = ask_engine(ladder, exact, hint, &answer, random, conflicts, cubes, error);
        if (!status)
            status = read_answer(ladder, exact, answer, variant, &cuts, random, error);
        if (status || cuts == 0)
            return status;
        if (fill_single_states(ladder, variant, like_last, error))
            return MESO_ERR_MEMORY;
        hint = like_last;
        if (meso_ladder_told_to_stop(ladder)) {
            meso_ladder_stop(ladder);
            return MESO_OK;
        }
    }
    ladder->result->decider = MESO_DECIDER_CONFLICTS;
    ladder->result->budget = MESO_BUDGET_CUTS;
    return MESO_OK;
}

MesoStatus meso_rung_exact(MesoLadder *ladder, bool chains, uint64_t conflicts, uint64_t cubes, MesoError *error)
{
    const MesoConstraints *constraints = ladder->problem->constraints;
    MesoExact exact;
    MesoRandom random;
    MesoExactOptions options = {.chains = chains, .constraints = constraints, .proof = ladder->options->proof,
                                .clause = ladder->options->clause, .context = ladder->options->proof_context,
                                .grows = constraints && meso_strand_rule_given(&constraints->strands)};
    MesoArenaMark mark = meso_arena_mark(&ladder->scratch);
    bool complete = true;
    meso_random_init(&random, ladder->options->seed, UINT64_MAX);
    if (ladder->options->formula)
        ladder->options->formula(ladder->options->proof_context);
    if (constraints && meso_exact_groups(&options.group, &ladder->scratch, constraints,
                                         ladder->problem->variants->count, error))
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_exact_init(&exact, &ladder->scratch, &ladder->propagation, &options, error);
    if (status == MESO_ERR_LIMIT) {
        meso_exact_release(&exact);
        meso_arena_rewind(&ladder->scratch, mark);
        ladder->result->decider = MESO_DECIDER_CONFLICTS;
        ladder->result->budget = MESO_BUDGET_FORMULA;
        return MESO_OK;
    }
    if (!status && constraints)
        status = meso_exact_add_quotas(&exact, constraints, &complete, error);
    /* Where a quota is too large to be counted, what the engine finds need not keep to it. */
    if (!status && complete)
        status = ask_until_kept(ladder, &exact, &random, conflicts, cubes, error);
    if (!status && complete)
        ladder->result->conflicts += meso_sat_conflicts(exact.sat);
    else
        ladder->result->budget = MESO_BUDGET_COUNTED;
    meso_exact_release(&exact);
    meso_arena_rewind(&ladder->scratch, mark);
    return status;
}

/* What probing excludes was impossible under all constraints: it stays excluded. */
static MesoStatus probe(MesoLadder *ladder, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    MesoSearch probing = {.propagation = &ladder->propagation, .tick = meso_ladder_tick, .context = ladder};
    MesoSearchOutcome outcome;
    MesoStatus status = meso_search_probe(&probing, probe_work, &outcome, error);
    if (status)
        return status;
    if (outcome == MESO_SEARCH_STOPPED)
        meso_ladder_stop(ladder);
    if (outcome != MESO_SEARCH_IMPOSSIBLE)
        return MESO_OK;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_PROBING;
    result->conflict_slot = probing.impossible_slot;
    result->reason = meso_arena_print(ladder->arena, error, "each tile that fits slot %u leads to a slot without any, "
                                      "once what leads there at once is ruled out everywhere",
                                      probing.impossible_slot);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_rung_exact_at_length(MesoLadder *ladder, bool guided, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    meso_ladder_allow_conflicts(ladder);
    result->decider = MESO_DECIDER_CONFLICTS;
    result->budget = MESO_BUDGET_CONFLICTS;
    if (meso_ladder_conflicts_left(ladder, 1) == 0)
        return MESO_OK;
    if (guided)
        return meso_rung_exact(ladder, false, meso_ladder_conflicts_left(ladder, UINT64_MAX), 0, error);
    uint64_t first = meso_ladder_conflicts_left(ladder, MESO_LADDER_FIRST_CONFLICTS);
    uint64_t left = meso_ladder_conflicts_left(ladder, UINT64_MAX) - first;
    MesoStatus status = meso_rung_exact(ladder, true, first, left < CUBE_CONFLICTS ? left : CUBE_CONFLICTS, error);
    if (status || result->decider != MESO_DECIDER_CONFLICTS || left == 0)
        return status;
    status = probe(ladder, error);
    if (status || result->decider != MESO_DECIDER_CONFLICTS)
        return status;
    left = meso_ladder_conflicts_left(ladder, UINT64_MAX);
    return left ? meso_rung_exact(ladder, false, left, 0, error) : MESO_OK;
}

MesoStatus meso_rung_fewest_changes(MesoLadder *ladder, MesoError *error)
{
    const MesoSolveOptions *options = ladder->options;
    MesoSolveResult *result = ladder->result;
    const MesoAssignment *found = &result->assignment;
    uint64_t conflicts;
    meso_ladder_allow_conflicts(ladder);
    const MesoFewestChangesOptions keep = {.seed = options->seed,
                                           .max_conflicts = meso_ladder_conflicts_left(ladder, KEEP_CONFLICTS),
                                  .stop = options->stop, .stop_context = options->stop_context};
    uint32_t *variant = MESO_NEW(&ladder->scratch, uint32_t, found->slot_count, error);
    if (!variant)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < found->slot_count; s++)
        variant[s] = meso_variant_find(ladder->problem->variants, ladder->problem->set, found->tile[s],
                                       found->transform[s]);
    MesoStatus status = meso_fewest_changes(variant, &result->changes_fewest, &conflicts, &ladder->propagation,
                                       ladder->problem->variants, ladder->problem->constraints, &keep, error);
    if (status)
        return status;
    result->conflicts += conflicts;
    return meso_ladder_accept(ladder, variant, result->decider, error);
}
