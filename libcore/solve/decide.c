#include "libcore/solve/decide.h"

#include "libcore/solve/counting.h"
#include "libcore/solve/parity.h"

/* Word operations of the parity prover: a second or two. */
static const uint64_t parity_work = (uint64_t)1 << 32;

/* Conflicts that the exact engine has with random phases, which vary the solutions, before it follows its own. */
enum { PHASED_CONFLICTS = 1000 };

MesoStatus meso_decide_by_numbers(MesoSolveResult *result, MesoArena *arena, MesoArena *scratch,
                                  const MesoPropagation *propagation, MesoError *error)
{
    MesoPatternTable table;
    MesoCountingProof proof;
    uint32_t slot;
    if (meso_pattern_table_init(&table, scratch, propagation, NULL, error) ||
        meso_counting_prove(&proof, scratch, &table, error))
        return MESO_ERR_MEMORY;
    if (proof.found) {
        result->verdict = MESO_VERDICT_UNSOLVABLE;
        result->decider = MESO_DECIDER_COUNTING;
        result->reason = meso_counting_explain(&proof, arena, propagation->set, error);
        return result->reason ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (meso_parity_prove(&slot, scratch, &table, parity_work, error))
        return MESO_ERR_MEMORY;
    if (slot == MESO_NO_INDEX)
        return MESO_OK;
    result->verdict = MESO_VERDICT_UNSOLVABLE;
    result->decider = MESO_DECIDER_PARITY;
    result->reason = meso_arena_print(arena, error, "the numbers of sides with each label, odd or even, that the "
                                      "tiles call for contradict each other on the piece of the surface with "
                                      "slot %u", slot);
    return result->reason ? MESO_OK : MESO_ERR_MEMORY;
}

static bool told_to_stop(const MesoSolveOptions *options)
{
    return options->stop && options->stop(options->stop_context);
}

static MesoStatus ask(MesoExact *exact, MesoSatAnswer *answer, MesoRandom *random,
                      const MesoSolveOptions *options, MesoError *error)
{
    uint64_t left = options->max_conflicts ? options->max_conflicts : MESO_SOLVE_CONFLICTS;
    uint32_t phased = left < PHASED_CONFLICTS ? (uint32_t)left : PHASED_CONFLICTS;
    MesoStatus status = meso_exact_choose_phases(exact, exact->propagation->state, random, error);
    if (!status)
        status = meso_sat_solve(exact->sat, answer, NULL, 0, phased, options->stop,
                                options->stop_context, error);
    left -= phased;
    if (status || *answer != MESO_SAT_UNKNOWN || left == 0 || told_to_stop(options))
        return status;
    status = meso_sat_forget_phases(exact->sat, error);
    if (status)
        return status;
    return meso_sat_solve(exact->sat, answer, NULL, 0, left < INT32_MAX ? (uint32_t)left : INT32_MAX,
                          options->stop, options->stop_context, error);
}

MesoStatus meso_decide_exactly(MesoSolveResult *result, uint32_t *variant, MesoArena *scratch,
                               const MesoPropagation *propagation, const MesoSolveOptions *options,
                               MesoError *error)
{
    MesoExact exact;
    MesoRandom random;
    MesoSatAnswer answer = MESO_SAT_UNKNOWN;
    const MesoExactOptions exact_options = {.proof = options->proof, .clause = options->clause,
                                            .context = options->proof_context};
    meso_random_init(&random, options->seed, UINT64_MAX);
    MesoStatus status = meso_exact_init(&exact, scratch, propagation, &exact_options, error);
    if (!status)
        status = ask(&exact, &answer, &random, options, error);
    if (!status && answer == MESO_SAT_YES)
        status = meso_exact_extract(&exact, variant, &random, error);
    meso_exact_release(&exact);
    result->decider = MESO_DECIDER_EXACT;
    if (answer == MESO_SAT_UNKNOWN)
        result->decider = told_to_stop(options) ? MESO_DECIDER_STOP : MESO_DECIDER_CONFLICTS;
    else
        result->verdict = answer == MESO_SAT_YES ? MESO_VERDICT_SOLVED : MESO_VERDICT_UNSOLVABLE;
    if (answer == MESO_SAT_NO)
        result->reason = "the exact engine went through all cases";
    return status;
}
