#include "libcore/tiling/solve/ladder.h"

bool meso_ladder_told_to_stop(const MesoLadder *ladder)
{
    return ladder->options->stop && ladder->options->stop(ladder->options->stop_context);
}

void meso_ladder_stop(MesoLadder *ladder)
{
    ladder->result->decider = MESO_DECIDER_STOP;
    ladder->result->budget = MESO_BUDGET_TIME;
}

bool meso_ladder_tick(void *context)
{
    const MesoLadder *ladder = context;
    uint32_t total = ladder->problem->graph->slot_count;
    if (ladder->options->progress)
        ladder->options->progress(ladder->options->progress_context,
                                  total - ladder->propagation.queue.count, total);
    return !meso_ladder_told_to_stop(ladder);
}

MesoStatus meso_ladder_accept(MesoLadder *ladder, const uint32_t *variant, MesoDecider decider, MesoError *error)
{
    MesoAssignment *assignment = &ladder->result->assignment;
    uint32_t count = ladder->problem->graph->slot_count;

    assignment->tile = MESO_NEW(ladder->arena, uint32_t, count, error);
    assignment->transform = MESO_NEW(ladder->arena, MesoTransform, count, error);
    if (!assignment->tile || !assignment->transform)
        return MESO_ERR_MEMORY;
    assignment->slot_count = count;
    for (uint32_t s = 0; s < count; s++) {
        assignment->tile[s] = ladder->problem->variants->tile[variant[s]];
        assignment->transform[s] = ladder->problem->variants->transform[variant[s]];
    }
    MesoError finding;
    const MesoConstraints *constraints = ladder->problem->constraints;
    if (meso_assignment_check(assignment, ladder->problem->set, ladder->problem->graph, &finding) ||
        (constraints && meso_constraints_check(constraints, assignment, ladder->problem->set, ladder->problem->variants,
                                               ladder->problem->graph, &finding)))
        return meso_fail(error, MESO_ERR_INTERNAL, "the solver's assignment is wrong: %s",
                         finding.message);
    ladder->result->verdict = MESO_VERDICT_SOLVED;
    ladder->result->decider = decider;
    ladder->result->reason = "";
    return MESO_OK;
}

void meso_ladder_allow_conflicts(MesoLadder *ladder)
{
    uint64_t most = ladder->options->max_conflicts;
    ladder->result->conflict_limit = most ? most : MESO_SOLVE_CONFLICTS;
}

uint64_t meso_ladder_conflicts_left(const MesoLadder *ladder, uint64_t most)
{
    const MesoSolveResult *result = ladder->result;
    uint64_t left = result->conflict_limit > result->conflicts ? result->conflict_limit - result->conflicts : 0;
    return left < most ? left : most;
}

bool meso_ladder_undecided(const MesoLadder *ladder)
{
    return ladder->result->verdict == MESO_VERDICT_GAVE_UP && ladder->result->decider != MESO_DECIDER_STOP;
}
