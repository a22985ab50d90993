#include "libcore/tiling/exact/fewest_changes.h"

#include <string.h>

#include "libcore/mesh/slot_flood.h"
#include "libcore/tiling/exact/exact_control.h"

/* Conflicts of one question, and assignments that a rule on strands may cut off in all. */
enum { QUESTION_CONFLICTS = 1000, MOST_CUT_ROUNDS = 200 };

typedef struct Keeper {
    MesoPropagation *propagation;
    const MesoVariantSet *variants;
    const MesoConstraints *constraints;
    const MesoFewestChangesOptions *options;
    MesoArena arena;
    MesoExact exact;
    MesoRandom random;
    uint32_t *variant;          /* [slot_count] the caller's: the best so far */
    uint32_t *trial;            /* [slot_count] */
    uint32_t *open;             /* [open_count] slots that may change */
    uint32_t open_count;
    bool *is_open;              /* [slot_count] */
    int32_t *changed;           /* [open_count, rounded up] after sorting: [i] holds where more than i are changed */
    uint32_t cut_rounds;
} Keeper;

static bool is_changed(const Keeper *keeper, uint32_t slot)
{
    uint32_t kept = keeper->constraints->keep[slot];
    return kept != MESO_NO_INDEX && keeper->variant[slot] != kept;
}

/* Changed slots, then the others by their distance from these, as far as there is room. */
static MesoStatus open_slots(Keeper *keeper, MesoError *error)
{
    const MesoSlotGraph *graph = keeper->propagation->graph;
    uint32_t most = graph->slot_count < MESO_FEWEST_CHANGES_OPEN ? graph->slot_count : MESO_FEWEST_CHANGES_OPEN;
    keeper->open = MESO_NEW(&keeper->arena, uint32_t, most, error);
    keeper->is_open = MESO_NEW(&keeper->arena, bool, graph->slot_count, error);
    if (!keeper->open || !keeper->is_open)
        return MESO_ERR_MEMORY;
    MesoSlotFlood flood = {.graph = graph, .slots = keeper->open, .met = keeper->is_open, .most = most};
    for (uint32_t s = 0; s < graph->slot_count; s++)
        if (is_changed(keeper, s))
            meso_slot_flood_meet(&flood, s);
    meso_slot_flood_all(&flood);
    /* Pieces without any change: quotas may still ask for one. */
    for (uint32_t s = 0; s < graph->slot_count; s++)
        meso_slot_flood_meet(&flood, s);
    keeper->open_count = flood.count;
    return MESO_OK;
}

static uint32_t count_changed(const Keeper *keeper)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < keeper->open_count; i++)
        count += is_changed(keeper, keeper->open[i]);
    return count;
}

/* Holds what is not open, and counts the changes of what is. */
static MesoStatus add_changes(Keeper *keeper, MesoError *error)
{
    uint32_t slots = keeper->propagation->graph->slot_count, count = 0;
    keeper->changed = MESO_NEW(&keeper->arena, int32_t, 2 * (size_t)keeper->open_count, error);
    if (!keeper->changed)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < keeper->open_count; i++) {
        uint32_t slot = keeper->open[i], kept = keeper->constraints->keep[slot];
        if (kept != MESO_NO_INDEX)
            keeper->changed[count++] = -meso_exact_literal(&keeper->exact, slot, kept);
    }
    MesoStatus status = MESO_OK;
    for (uint32_t s = 0; s < slots && !status; s++) {
        int32_t literal = meso_exact_literal(&keeper->exact, s, keeper->variant[s]);
        if (!keeper->is_open[s])
            status = meso_exact_add(&keeper->exact, &literal, 1, error);
    }
    const MesoClauses clauses = meso_exact_clauses(&keeper->exact);
    return status ? status : meso_sort_literals(&clauses, keeper->changed, count, error);
}

/* After a yes: takes the assignment for the best, unless it breaks the rule on strands; then that is cut off. */
static MesoStatus take_trial(Keeper *keeper, bool *taken, MesoError *error)
{
    const MesoStrandRule *rule = &keeper->constraints->strands;
    uint32_t slots = keeper->propagation->graph->slot_count, cuts = 0;
    MesoStatus status = meso_exact_extract(&keeper->exact, keeper->trial, &keeper->random, error);
    for (uint32_t s = 0; s < slots && !status; s++)
        if (!keeper->is_open[s])
            keeper->trial[s] = keeper->variant[s];
    if (!status && meso_strand_rule_given(rule))
        status = meso_exact_cut_strands(&keeper->exact, rule, keeper->trial, keeper->variants, &cuts, error);
    *taken = !status && cuts == 0;
    keeper->cut_rounds += cuts > 0;
    if (*taken)
        memcpy(keeper->variant, keeper->trial, slots * sizeof *keeper->trial);
    return status;
}

static uint64_t conflicts_left(const Keeper *keeper)
{
    uint64_t used = meso_sat_conflicts(keeper->exact.sat), most = keeper->options->max_conflicts;
    return used < most ? most - used : 0;
}

/* Asks for at most `most` changes until there is an answer that no rule cuts off. */
static MesoStatus ask(Keeper *keeper, uint32_t most, MesoSatAnswer *answer, MesoError *error)
{
    int32_t few = -keeper->changed[most];
    bool taken = false;
    MesoStatus status = MESO_OK;
    *answer = few == -MESO_LITERAL_TRUE ? MESO_SAT_NO : MESO_SAT_UNKNOWN;
    if (*answer == MESO_SAT_NO)
        return MESO_OK;
    do {
        uint64_t left = conflicts_left(keeper);
        if (left == 0 || keeper->cut_rounds > MOST_CUT_ROUNDS) {
            *answer = MESO_SAT_UNKNOWN;
            return status;
        }
        status = meso_sat_solve(keeper->exact.sat, answer, &few, 1,
                                left < QUESTION_CONFLICTS ? (uint32_t)left : QUESTION_CONFLICTS, keeper->options->stop,
                                keeper->options->stop_context, error);
        if (!status && *answer == MESO_SAT_YES)
            status = take_trial(keeper, &taken, error);
    } while (!status && *answer == MESO_SAT_YES && !taken);
    return status;
}

/* In steps that grow while there are fewer. `*proved`: there are no fewer while what is not open stays. */
static MesoStatus ask_for_fewer(Keeper *keeper, bool *proved, MesoError *error)
{
    uint32_t least = 0, most = count_changed(keeper), step = 1;
    MesoStatus status = MESO_OK;
    while (!status && least < most) {
        MesoSatAnswer answer;
        uint32_t target = most - least > step ? most - step : least;
        status = ask(keeper, target, &answer, error);
        if (status)
            return status;
        if (answer == MESO_SAT_UNKNOWN && step == 1)
            return MESO_OK;
        if (answer == MESO_SAT_NO)
            least = target + 1;
        if (answer == MESO_SAT_YES)
            most = count_changed(keeper);
        step = answer == MESO_SAT_YES ? 2 * step : 1;
    }
    *proved = true;
    return status;
}

/* The engine tries what is to be kept first. */
static MesoStatus choose_phases(Keeper *keeper, MesoError *error)
{
    MesoPropagation *propagation = keeper->propagation;
    const uint32_t *keep = keeper->constraints->keep;
    uint32_t slots = propagation->graph->slot_count;
    uint32_t *states = MESO_NEW(&keeper->arena, uint32_t, slots, error);
    if (!states)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < slots; s++) {
        states[s] = keep[s] == MESO_NO_INDEX ? propagation->initial[s]
                                             : meso_domain_single(&propagation->domains, keep[s], error);
        if (states[s] == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
    }
    return meso_exact_choose_phases(&keeper->exact, states, &keeper->random, error);
}

static MesoStatus keep_more(Keeper *keeper, bool *fewest, MesoError *error)
{
    const MesoConstraints *constraints = keeper->constraints;
    uint32_t slots = keeper->propagation->graph->slot_count;
    MesoExactOptions options = {.constraints = constraints, .grows = meso_strand_rule_given(&constraints->strands)};
    bool complete = true, proved = false;
    keeper->trial = MESO_NEW(&keeper->arena, uint32_t, slots, error);
    if (!keeper->trial || open_slots(keeper, error) ||
        meso_exact_groups(&options.group, &keeper->arena, constraints, keeper->variants->count, error))
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_exact_init(&keeper->exact, &keeper->arena, keeper->propagation, &options, error);
    if (!status)
        status = meso_exact_add_quotas(&keeper->exact, constraints, &complete, error);
    if (!status && complete)
        status = add_changes(keeper, error);
    if (!status && complete)
        status = choose_phases(keeper, error);
    if (!status && complete)
        status = ask_for_fewer(keeper, &proved, error);
    *fewest = proved && keeper->open_count == slots;
    return status == MESO_ERR_LIMIT ? MESO_OK : status;
}

MesoStatus meso_fewest_changes(uint32_t *variant, bool *fewest, uint64_t *conflicts, MesoPropagation *propagation,
                          const MesoVariantSet *variants, const MesoConstraints *constraints,
                          const MesoFewestChangesOptions *options, MesoError *error)
{
    Keeper keeper = {.propagation = propagation, .variants = variants, .constraints = constraints, .options = options,
                     .variant = variant};
    *conflicts = 0;
    *fewest = false;
    if (propagation->graph->slot_count > MESO_FEWEST_CHANGES_SLOTS)
        return MESO_OK;
    meso_random_init(&keeper.random, options->seed, UINT64_MAX - 1);
    meso_arena_init(&keeper.arena);
    MesoStatus status = keep_more(&keeper, fewest, error);
    if (keeper.exact.sat)
        *conflicts = meso_sat_conflicts(keeper.exact.sat);
    meso_exact_release(&keeper.exact);
    meso_arena_release(&keeper.arena);
    return status;
}
