#include "libcore/tiling/search/constrained_search.h"

#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/slot_flood.h"

/* Choices that an attempt may take back: so many, and a part of the slots. */
enum { LEAST_BACKTRACKS = 1000, BACKTRACK_PART = 4 };

enum { TICK_INTERVAL = 4096 };  /* observations */

MesoStatus meso_constrained_search_init(MesoConstrainedSearch *search, MesoArena *arena, MesoPropagation *propagation,
                            const MesoVariantSet *variants, const MesoConstraints *constraints,
                            uint64_t *violations, bool *disproved, MesoError *error)
{
    *search = (MesoConstrainedSearch){.propagation = propagation, .constraints = constraints, .arena = arena,
                                 .violations = violations, .max_observations = UINT64_MAX};
    *disproved = false;
    bool strands = meso_strand_rule_given(&constraints->strands), kept = true;
    propagation->tracing = constraints->quota_count || strands || constraints->keep;
    if (constraints->keep &&
        !(search->released = MESO_NEW(arena, uint8_t, propagation->graph->slot_count, error)))
        return MESO_ERR_MEMORY;
    if (!strands)
        return MESO_OK;
    MesoStatus status = meso_strand_search_init(&search->strands, arena, &constraints->strands, propagation->set,
                                                variants, propagation->graph, error);
    if (!status)
        status = meso_strand_search_add_initial(&search->strands, propagation, &kept, error);
    search->strand_base = search->strands.trail_count;
    *disproved = !kept;
    return status;
}

/* Tells the strands of the slots that the last step decided. */
static MesoStatus follow_strands(MesoConstrainedSearch *search, MesoError *error)
{
    const MesoPropagation *propagation = search->propagation;
    bool kept = true;
    search->strands_broken = false;
    if (!propagation->decided || propagation->dead_slot != MESO_NO_INDEX)
        return MESO_OK;
    while (kept && search->strands_seen < propagation->decided_count) {
        uint32_t slot = propagation->decided[search->strands_seen++];
        uint32_t variant = meso_domain_variant(&propagation->domains, propagation->state[slot], 0);
        if (meso_strand_search_add(&search->strands, slot, variant, &kept, error))
            return MESO_ERR_MEMORY;
    }
    search->strands_broken = !kept;
    return MESO_OK;
}

/* True where the last step met a dead end of any kind; counts it for its constraint. */
static bool in_conflict(MesoConstrainedSearch *search)
{
    const MesoPropagation *propagation = search->propagation;
    const MesoConstraints *constraints = search->constraints;
    if (propagation->broken_quota != MESO_NO_INDEX)
        search->violations[constraints->restriction_count + propagation->broken_quota]++;
    else if (search->strands_broken)
        search->violations[constraints->restriction_count + constraints->quota_count]++;
    if (search->hot_spots && propagation->dead_slot != MESO_NO_INDEX)
        meso_hot_spots_add(search->hot_spots, propagation->dead_slot);
    return propagation->broken_quota != MESO_NO_INDEX || search->strands_broken ||
           propagation->dead_slot != MESO_NO_INDEX;
}

static MesoStatus push_choice(MesoConstrainedSearch *search, uint32_t slot, uint32_t variant, MesoError *error)
{
    search->choices = MESO_GROW(search->arena, search->choices, search->choice_count, search->choice_capacity, 256,
                                error);
    if (!search->choices)
        return MESO_ERR_MEMORY;
    MesoConstrainedChoice *choice = &search->choices[search->choice_count++];
    *choice = (MesoConstrainedChoice){.strand_mark = search->strands.trail_count, .slot = slot, .variant = variant};
    return meso_propagation_mark(search->propagation, &choice->mark, error);
}

/* Takes the last choice back; `*done` is false where there is none, or none that can be. */
static MesoStatus pop_choice(MesoConstrainedSearch *search, MesoConstrainedChoice *choice, bool *done, MesoError *error)
{
    *done = false;
    if (search->choice_count == 0) {
        /* What was excluded so far was excluded for good, unless slots were kept that need not be. */
        search->exhausted = !search->constraints->keep &&
                            search->generation == search->propagation->generation;
        return MESO_OK;
    }
    *choice = search->choices[--search->choice_count];
    MesoStatus status = meso_propagation_rewind(search->propagation, choice->mark, done, error);
    if (status || !*done)
        return status;
    if (search->propagation->decided) {
        meso_strand_search_undo(&search->strands, choice->strand_mark);
        search->strands_seen = search->propagation->decided_count;
    }
    return MESO_OK;
}

static MesoStatus assign(MesoConstrainedSearch *search, uint32_t slot, uint32_t variant, MesoError *error)
{
    MesoStatus status = meso_propagation_assign(search->propagation, slot, variant, error);
    return status ? status : follow_strands(search, error);
}

/* Takes choices back, and excludes them, until there is no conflict. `*done`: there is none any more. */
static MesoStatus backtrack(MesoConstrainedSearch *search, uint64_t *left, bool *done, MesoError *error)
{
    MesoConstrainedChoice choice;
    *done = !in_conflict(search);
    while (!*done) {
        if (!search->propagation->tracing || *left == 0)
            return MESO_OK;
        MesoStatus status = pop_choice(search, &choice, done, error);
        if (status || !*done)
            return status;
        --*left;
        search->backtracks++;
        status = meso_propagation_exclude(search->propagation, choice.slot, choice.variant, error);
        if (!status)
            status = follow_strands(search, error);
        if (status)
            return status;
        *done = !in_conflict(search);
    }
    return MESO_OK;
}

/*
 * Gives every slot its variant to keep, as far as it goes: one that leads to a
 * conflict at once is taken back, and left to the search. Marks are void after.
 */
static MesoStatus keep_variants(MesoConstrainedSearch *search, MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    const uint32_t *keep = search->constraints->keep;
    for (uint32_t s = 0; s < propagation->graph->slot_count; s++) {
        uint32_t state = propagation->state[s];
        if (keep[s] == MESO_NO_INDEX || search->released[s] ||
            propagation->domains.domains[state].size == 1 ||
            !meso_bits_test(meso_domain_bits(&propagation->domains, state), keep[s]))
            continue;
        MesoConstrainedChoice choice;
        bool done = true;
        MesoStatus status = push_choice(search, s, keep[s], error);
        if (!status)
            status = assign(search, s, keep[s], error);
        if (!status && in_conflict(search))
            status = pop_choice(search, &choice, &done, error);
        if (status || !done)
            return status;
        search->choice_count = 0;
        meso_propagation_forget(propagation);
    }
    propagation->dead_slot = propagation->broken_quota = MESO_NO_INDEX;
    search->strands_broken = false;
    return MESO_OK;
}

/* Releases the slots up to `radius` steps from `centre`. */
static MesoStatus release_ball(MesoConstrainedSearch *search, uint32_t centre, uint32_t radius, MesoError *error)
{
    const MesoSlotGraph *graph = search->propagation->graph;
    MesoArenaMark mark = meso_arena_mark(search->arena);
    MesoSlotFlood flood = {
        .graph = graph, .most = graph->slot_count,
        .slots = MESO_NEW(search->arena, uint32_t, graph->slot_count, error),
        .met = MESO_NEW(search->arena, bool, graph->slot_count, error),
    };
    if (!flood.slots || !flood.met)
        return MESO_ERR_MEMORY;
    meso_slot_flood_meet(&flood, centre);
    for (uint32_t distance = 0; distance < radius && flood.followed < flood.count; distance++)
        meso_slot_flood_step(&flood);
    for (uint32_t i = 0; i < flood.count; i++)
        search->released[flood.slots[i]] = 1;
    meso_arena_rewind(search->arena, mark);
    return MESO_OK;
}

static MesoStatus release_after_failure(MesoConstrainedSearch *search, uint32_t last_slot, MesoError *error)
{
    uint32_t dead = search->propagation->dead_slot;
    uint32_t radius = search->failures < 30 ? 1u << search->failures : UINT32_MAX;
    search->failures++;
    return release_ball(search, dead != MESO_NO_INDEX ? dead : last_slot, radius, error);
}

static MesoStatus begin_attempt(MesoConstrainedSearch *search, MesoError *error)
{
    search->choice_count = 0;
    search->strands_seen = 0;
    search->strands_broken = search->exhausted = false;
    search->generation = search->propagation->generation;
    if (search->propagation->decided)
        meso_strand_search_undo(&search->strands, search->strand_base);
    return search->constraints->keep ? keep_variants(search, error) : MESO_OK;
}

static bool may_go_on(const MesoConstrainedSearch *search)
{
    if (search->observations >= search->max_observations)
        return false;
    return search->observations % TICK_INTERVAL != 0 || !search->tick || search->tick(search->context);
}

MesoStatus meso_constrained_search_attempt(MesoConstrainedSearch *search, MesoRandom *random, bool *solved,
                                           MesoError *error)
{
    MesoPropagation *propagation = search->propagation;
    uint64_t left = LEAST_BACKTRACKS + propagation->graph->slot_count / BACKTRACK_PART;
    uint32_t slot = 0;
    bool going = true;
    MesoStatus status = begin_attempt(search, error);
    while (!status && going && propagation->queue.count) {
        if (!may_go_on(search)) {
            search->stopped = true;
            break;
        }
        slot = meso_bucket_queue_draw(&propagation->queue, random);
        uint32_t variant = meso_choose_variant(propagation, search->constraints, slot,
                                               !search->released || !search->released[slot], random);
        search->observations++;
        if (propagation->tracing)
            status = push_choice(search, slot, variant, error);
        if (!status)
            status = assign(search, slot, variant, error);
        if (!status)
            status = backtrack(search, &left, &going, error);
        if (going && propagation->queue.count < search->fewest_open)
            search->fewest_open = propagation->queue.count;
    }
    *solved = going && !search->stopped;
    if (!status && !going && search->released)
        status = release_after_failure(search, slot, error);
    return status;
}
