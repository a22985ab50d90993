#include "libcore/tiling/solve/solve.h"

#include <assert.h>

#include "libcore/tiling/proof/counting.h"
#include "libcore/tiling/proof/parity.h"
#include "libcore/tiling/search/strand_places.h"
#include "libcore/tiling/solve/ladder.h"
#include "libcore/tiling/solve/verdict_text.h"

/* Word operations of the parity prover: a second or two. */
static const uint64_t parity_work = (uint64_t)1 << 32;

/* Attempts of the search before provers and the exact engine have a first go; the latter up to so many slots. */
enum { FIRST_ATTEMPTS = 4, FIRST_GO_SLOTS = 1 << 16 };

/* Counting, then parity: cheap where they prove something, and hopeless for the exact engine. */
static MesoStatus decide_by_numbers(MesoLadder *ladder, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    MesoLabelPatternTable table;
    MesoCountingProof proof;
    uint32_t slot;
    if (meso_label_pattern_table_init(&table, &ladder->scratch, &ladder->propagation, NULL, error) ||
        meso_counting_prove(&proof, &ladder->scratch, &table, error))
        return MESO_ERR_MEMORY;
    if (proof.found) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->decider = MESO_DECIDER_COUNTING;
        result->reason = meso_counting_explain(&proof, ladder->arena, ladder->problem->set, error);
        return result->reason ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (meso_parity_prove(&slot, &ladder->scratch, &table, parity_work, error))
        return MESO_ERR_MEMORY;
    if (slot == MESO_NO_INDEX)
        return MESO_OK;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_PARITY;
    result->reason = meso_arena_print(ladder->arena, error, "the numbers of labels that the tiles show, "
                                      "odd or even, contradict each other on the piece of the surface "
                                      "around slot %u", slot);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus say_disproved(MesoLadder *ladder, MesoError *error)
{
    ladder->result->verdict = MESO_VERDICT_UNSOLVABLE;
    ladder->result->decider = MESO_DECIDER_PROPAGATION;
    uint32_t quota = ladder->propagation.broken_quota;
    if (ladder->propagation.initial_dead_count || quota == MESO_NO_INDEX)
        return meso_rung_initial_dead_ends(ladder, error);
    ladder->result->reason = meso_broken_quota_text(ladder->arena, &ladder->propagation.quotas, quota, error);
    return ladder->result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus say_gave_up(MesoLadder *ladder, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    result->reason = meso_gave_up_text(ladder->arena, result, ladder->problem, error);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus tell_hot_spots(MesoLadder *ladder, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    result->dead_ends_met = ladder->hot_spots.total;
    if (result->verdict == MESO_VERDICT_SOLVED || ladder->hot_spots.total == 0)
        return MESO_OK;
    result->hot_spots = MESO_NEW(ladder->arena, MesoHotSpot, MESO_SOLVE_HOT_SPOTS, error);
    if (!result->hot_spots)
        return MESO_ERR_MEMORY;
    result->hot_spot_count = meso_hot_spots_top(&ladder->hot_spots, result->hot_spots, MESO_SOLVE_HOT_SPOTS);
    return MESO_OK;
}

/*
 * The ladder without quotas and the like: each rung leaves the verdict "gave up", or a better one. A few attempts of
 * the search; what is cheap and may prove that there is nothing to be found; the other attempts, which
 * have more patience; the exact engine at length.
 */
static MesoStatus climb(MesoLadder *ladder, MesoError *error)
{
    uint32_t attempts = ladder->options->max_attempts;
    MesoEngine engine = ladder->options->engine;
    bool searching = engine != MESO_ENGINE_EXACT, proving = engine != MESO_ENGINE_WFC;
    uint32_t first_attempts = proving && attempts > FIRST_ATTEMPTS ? FIRST_ATTEMPTS : attempts;
    MesoStatus status = MESO_OK;
    meso_rung_prepare_search(ladder);
    if (searching)
        status = meso_rung_search(ladder, first_attempts, error);
    if (!proving)
        return status;
    if (!status && meso_ladder_undecided(ladder))
        status = decide_by_numbers(ladder, error);
    bool more = searching && first_attempts < attempts && ladder->result->budget == MESO_BUDGET_ATTEMPTS;
    /* On a large surface the formula alone takes longer, and more memory, than the attempts. */
    if (!status && meso_ladder_undecided(ladder) && more && ladder->problem->graph->slot_count <= FIRST_GO_SLOTS) {
        meso_ladder_allow_conflicts(ladder);
        status = meso_rung_exact(ladder, true, meso_ladder_conflicts_left(ladder, MESO_LADDER_FIRST_CONFLICTS), 0,
                                 error);
    }
    if (!status && meso_ladder_undecided(ladder) && more)
        status = meso_rung_search(ladder, attempts, error);
    return !status && meso_ladder_undecided(ladder) ? meso_rung_exact_at_length(ladder, false, error) : status;
}

/* The ladder with them: the search for their sake has its own ways back. */
static MesoStatus climb_guided(MesoLadder *ladder, MesoError *error)
{
    MesoEngine engine = ladder->options->engine;
    MesoStatus status = engine != MESO_ENGINE_EXACT ? meso_rung_constrained(ladder, error) : MESO_OK;
    if (engine == MESO_ENGINE_WFC)
        return status;
    if (!status && meso_ladder_undecided(ladder))
        status = decide_by_numbers(ladder, error);
    return !status && meso_ladder_undecided(ladder) ? meso_rung_exact_at_length(ladder, true, error) : status;
}

static MesoStatus begin_to_climb(MesoLadder *ladder, bool guided, MesoError *error)
{
    MesoSolveResult *result = ladder->result;
    result->verdict = MESO_VERDICT_GAVE_UP;
    result->decider = MESO_DECIDER_ATTEMPTS;
    MesoStatus status = guided ? climb_guided(ladder, error) : climb(ladder, error);
    const MesoConstraints *constraints = ladder->problem->constraints;
    if (status || result->verdict != MESO_VERDICT_SOLVED || !constraints || !constraints->keep)
        return status;
    result->changes_fewest = meso_constraints_changed(constraints, &result->assignment, ladder->problem->variants) == 0;
    return result->changes_fewest || ladder->options->engine == MESO_ENGINE_WFC ? MESO_OK : meso_rung_fewest_changes(ladder, error);
}

static MesoStatus run(MesoLadder *ladder, MesoError *error)
{
    const MesoConstraints *constraints = ladder->problem->constraints;
    bool guided = constraints && meso_constraints_need_guidance(constraints);
    bool disproved = ladder->propagation.initial_dead_count ||
                     ladder->propagation.broken_quota != MESO_NO_INDEX;
    MesoStatus status = !disproved && guided ? meso_rung_prepare_constrained(ladder, &disproved, error) : MESO_OK;
    if (!status)
        status = disproved ? say_disproved(ladder, error) : begin_to_climb(ladder, guided, error);
    if (!status)
        status = tell_hot_spots(ladder, error);
    if (!status && ladder->result->verdict == MESO_VERDICT_GAVE_UP)
        status = say_gave_up(ladder, error);
    return status;
}

/* Dead ends to make room for: one an attempt, or one a slot met initially. */
static MesoStatus allocate_dead_ends(MesoLadder *ladder, MesoError *error)
{
    uint32_t count = ladder->propagation.initial_dead_count;
    if (!count)
        count = ladder->options->max_attempts;
    if (count > ladder->options->max_dead_ends)
        count = ladder->options->max_dead_ends;
    ladder->result->dead_ends = MESO_NEW(ladder->arena, MesoDeadEnd, count, error);
    return ladder->result->dead_ends ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_solve(MesoSolveResult *result, MesoArena *arena, const MesoTilingProblem *problem,
                      const MesoSolveOptions *options, MesoError *error)
{
    assert(options->max_attempts >= 1);
    *result = (MesoSolveResult){.label_word_count = meso_bits_words(2 * problem->set->interface_count), .reason = "",
                                .conflict_slot = MESO_NO_INDEX};
    if (problem->variants->count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "no tile to solve with: the set has none, or ignores all");

    MesoLadder ladder = {.problem = problem, .options = options, .result = result, .arena = arena};
    meso_arena_init(&ladder.scratch);
    meso_arena_init(&ladder.hot_arena);
    MesoStatus status = meso_strand_places_init(&ladder.propagation, &ladder.scratch, problem, error);
    if (!status)
        status = allocate_dead_ends(&ladder, error);
    if (!status)
        status = run(&ladder, error);
    meso_propagation_release(&ladder.propagation);
    meso_arena_release(&ladder.scratch);
    meso_arena_release(&ladder.hot_arena);
    return status;
}
