#include "libcore/tiling/propagate/propagate.h"

#include <assert.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/tiling/propagate/initial_states.h"

/* Between collections the table may grow by this many states, or by the slots' quarter. */
enum { COLLECT_STATES = 1 << 16 };

/* The step cache: 2^17 entries are 2 MiB, about a core's second cache; a small graph needs few. */
enum { LEAST_STEPS = 1 << 10, MOST_STEPS = 1 << 17 };

/* Entries of the first trail. */
enum { LEAST_TRAIL = 1024 };

/* In `pending`: the sides, and marks of slots in `touched`, on the trail, in the ball or the conflict at hand. */
enum { ALL_SIDES = 15, TOUCHED = 16, ON_TRAIL = 32, IN_BALL = 64, IN_CONFLICT = 128 };

static void push(MesoPropagation *propagation, uint32_t slot, uint8_t sides)
{
    if (sides && !(propagation->pending[slot] & ALL_SIDES))
        meso_work_list_push(&propagation->list, slot);
    propagation->pending[slot] |= sides & ALL_SIDES;
}

/* Sides on which `next` lets the neighbours show less than `state` did. */
static uint8_t changed_sides(const MesoDomain *state, const MesoDomain *next)
{
    uint32_t sides = 0;
    for (uint32_t k = 0; k < 4; k++)
        sides |= (uint32_t)(state->allow[k] != next->allow[k]) << k;
    return (uint8_t)sides;
}

/* Notes the state of `slot`, which is about to change. */
static MesoStatus note_on(MesoTrail *trail, const MesoPropagation *propagation, uint32_t slot, MesoError *error)
{
    trail->entries = MESO_GROW(propagation->arena, trail->entries, trail->count, trail->room, LEAST_TRAIL, error);
    if (!trail->entries)
        return MESO_ERR_MEMORY;
    trail->entries[trail->count++] = (MesoTrailEntry){slot, propagation->state[slot]};
    return MESO_OK;
}

static MesoStatus note_change(MesoPropagation *propagation, uint32_t slot, MesoError *error)
{
    uint8_t *marks = &propagation->pending[slot];
    if (!(*marks & TOUCHED))
        propagation->touched[propagation->touched_count++] = slot;
    if (!(*marks & ON_TRAIL) && note_on(&propagation->trail, propagation, slot, error))
        return MESO_ERR_MEMORY;
    *marks |= TOUCHED | ON_TRAIL;
    return MESO_OK;
}

/* Tells the quotas that `slot` goes from its state to `next`. */
static void tell_quotas(MesoPropagation *propagation, uint32_t slot, uint32_t next)
{
    if (propagation->quotas.count)
        meso_quota_change(&propagation->quotas,
                          meso_domain_bits(&propagation->domains, propagation->state[slot]),
                          meso_domain_bits(&propagation->domains, next));
}

/* Gives `slot` another state, and moves it in the queue. */
static MesoStatus move_to_state(MesoPropagation *propagation, uint32_t slot, uint32_t next, MesoError *error)
{
    uint32_t before = propagation->domains.domains[propagation->state[slot]].size;
    uint32_t after = propagation->domains.domains[next].size;
    tell_quotas(propagation, slot, next);
    propagation->state[slot] = next;
    if (after == 1 && propagation->decided)
        propagation->decided[propagation->decided_count++] = slot;
    if (propagation->queue_rests)
        return MESO_OK;
    if (before > 1)
        meso_bucket_queue_remove(&propagation->queue, slot, before);
    return after > 1 ? meso_bucket_queue_insert(&propagation->queue, slot, after, error) : MESO_OK;
}

/* Gives `slot` the smaller state `next`, which is not empty, on the news of slot `cause`, or MESO_NO_INDEX. */
static MesoStatus set_state(MesoPropagation *propagation, uint32_t slot, uint32_t next, uint32_t cause,
                            MesoError *error)
{
    const MesoDomain *domains = propagation->domains.domains;
    push(propagation, slot, changed_sides(&domains[propagation->state[slot]], &domains[next]));
    if (!propagation->searching) {
        tell_quotas(propagation, slot, next);
        propagation->state[slot] = next;
        return MESO_OK;
    }
    if (propagation->causes)
        meso_cause_log_change(propagation->causes, slot, propagation->state[slot], cause);
    if (note_change(propagation, slot, error) ||
        (propagation->tracing && note_on(&propagation->history, propagation, slot, error)))
        return MESO_ERR_MEMORY;
    return move_to_state(propagation, slot, next, error);
}

/* Forgets what is still to be told. */
static void clear_list(MesoPropagation *propagation)
{
    while (propagation->list.count)
        propagation->pending[meso_work_list_pop(&propagation->list)] &= (uint8_t)~ALL_SIDES;
}

/* A change of a slot's state needs more of it than the state: on a large surface each is a miss, so at once. */
static inline void fetch_slot(const MesoPropagation *propagation, uint32_t slot)
{
    __builtin_prefetch(&propagation->pending[slot], 1);
    __builtin_prefetch(&propagation->queue.position[slot], 1);
    __builtin_prefetch(&propagation->graph->twin[4 * (size_t)slot]);
}

/* Tells the neighbour of `teller` across half-edge `half_edge` which labels it may still show there. */
static MesoStatus tell_neighbour(MesoPropagation *propagation, uint32_t teller, uint32_t half_edge, uint32_t set,
                                 MesoError *error)
{
    uint32_t slot = half_edge / 4;
    fetch_slot(propagation, slot);
    uint32_t state = propagation->state[slot];
    uint32_t next = meso_domain_step(&propagation->domains, state, half_edge % 4, set, error);
    if (next == state)
        return MESO_OK;
    if (next == MESO_NO_INDEX)
        return MESO_ERR_MEMORY;
    if (next != MESO_DOMAIN_EMPTY)
        return set_state(propagation, slot, next, teller, error);

    propagation->dead_slot = slot;
    propagation->dead_teller = teller;
    if (!propagation->searching) {
        propagation->state[slot] = MESO_DOMAIN_EMPTY;
        propagation->initial_dead_count++;
    }
    return MESO_OK;
}

/* Collapse. The order of the list has no part in the fixed point, only in which slot dies first. */
static MesoStatus run(MesoPropagation *propagation, MesoError *error)
{
    propagation->dead_slot = MESO_NO_INDEX;
    while (propagation->list.count) {
        uint32_t slot = meso_work_list_pop(&propagation->list);
        uint32_t sides = propagation->pending[slot] & ALL_SIDES;
        const uint32_t *twin = propagation->graph->twin + 4 * (size_t)slot;
        propagation->pending[slot] &= (uint8_t)~ALL_SIDES;
        if (propagation->state[slot] == MESO_DOMAIN_EMPTY)
            continue;
        for (uint32_t k = 0; k < 4; k++)
            if (twin[k] != MESO_NO_INDEX)
                __builtin_prefetch(&propagation->state[twin[k] / 4], 1);
        for (; sides; sides &= sides - 1) {
            uint32_t k = (uint32_t)__builtin_ctz(sides);
            if (twin[k] == MESO_NO_INDEX)
                continue;
            /* Read anew: where the slot is glued to itself, or a table has moved. */
            uint32_t set = propagation->domains.domains[propagation->state[slot]].allow[k];
            if (tell_neighbour(propagation, slot, twin[k], set, error))
                return MESO_ERR_MEMORY;
            if (propagation->dead_slot != MESO_NO_INDEX && propagation->searching) {
                clear_list(propagation);
                return MESO_OK;
            }
            if (propagation->state[slot] == MESO_DOMAIN_EMPTY)
                break;
        }
    }
    return MESO_OK;
}

/* Lets `quota`, used up or in need of all, narrow every slot: once in an attempt, for then it is calm. */
static MesoStatus apply_quota(MesoPropagation *propagation, uint32_t quota, MesoQuotaCall call,
                              MesoError *error)
{
    for (uint32_t s = 0; s < propagation->graph->slot_count; s++) {
        const uint64_t *bits = meso_domain_bits(&propagation->domains, propagation->state[s]);
        if (!meso_quota_narrow(&propagation->quotas, quota, call, bits))
            continue;
        uint32_t next = meso_domain_intern(&propagation->domains, propagation->quotas.scratch, error);
        if (next == MESO_NO_INDEX || set_state(propagation, s, next, MESO_NO_INDEX, error))
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

/* Collapse with quotas: on to the fixed point of both. */
static MesoStatus run_with_quotas(MesoPropagation *propagation, MesoError *error)
{
    propagation->broken_quota = MESO_NO_INDEX;
    MesoStatus status = run(propagation, error);
    uint32_t quota = 0;
    while (!status && quota < propagation->quotas.count && propagation->dead_slot == MESO_NO_INDEX) {
        MesoQuotaCall call = meso_quota_call(&propagation->quotas, quota);
        if (call == MESO_QUOTA_BROKEN) {
            propagation->broken_quota = quota;
            return MESO_OK;
        }
        if (call == MESO_QUOTA_CALM) {
            quota++;
            continue;
        }
        status = apply_quota(propagation, quota, call, error);
        if (!status)
            status = run(propagation, error);
        quota = 0;
    }
    return status;
}

/* Counts what the quotas ask for, and carries on what follows; not where slots are dead already. */
static MesoStatus run_initial_quotas(MesoPropagation *propagation, MesoError *error)
{
    propagation->broken_quota = MESO_NO_INDEX;
    if (propagation->initial_dead_count || !propagation->quotas.count)
        return MESO_OK;
    return run_with_quotas(propagation, error);
}

static void count_for_quotas(MesoPropagation *propagation)
{
    for (uint32_t s = 0; propagation->quotas.count && s < propagation->graph->slot_count; s++)
        meso_quota_change(&propagation->quotas, NULL,
                          meso_domain_bits(&propagation->domains, propagation->state[s]));
}

static uint32_t state_size(const void *context, uint32_t slot)
{
    const MesoPropagation *propagation = context;
    return propagation->domains.domains[propagation->state[slot]].size;
}

/* The fixed point before any choice, and the queue of the slots that have one. */
static MesoStatus run_initial(MesoPropagation *propagation, MesoError *error)
{
    uint32_t slot_count = propagation->graph->slot_count;
    for (uint32_t s = 0; s < slot_count; s++)
        push(propagation, s, ALL_SIDES);
    count_for_quotas(propagation);
    if (run(propagation, error) || run_initial_quotas(propagation, error))
        return MESO_ERR_MEMORY;

    meso_bucket_queue_stock(&propagation->queue, state_size, propagation);
    memcpy(propagation->initial, propagation->state, slot_count * sizeof *propagation->initial);
    propagation->searching = true;
    return MESO_OK;
}

static MesoStatus allocate(MesoPropagation *propagation, MesoArena *arena,
                           const MesoVariantSet *variants, const MesoConstraints *constraints,
                           MesoError *error)
{
    uint32_t slot_count = propagation->graph->slot_count;
    propagation->codes = MESO_NEW(arena, uint32_t, 4 * (size_t)variants->count, error);
    propagation->state = MESO_NEW(arena, uint32_t, slot_count, error);
    propagation->initial = MESO_NEW(arena, uint32_t, slot_count, error);
    propagation->touched = MESO_NEW(arena, uint32_t, slot_count, error);
    propagation->pending = MESO_NEW(arena, uint8_t, slot_count, error);
    propagation->list = (MesoWorkList){MESO_NEW(arena, uint32_t, slot_count, error), slot_count, 0, 0};
    if (constraints && meso_strand_rule_given(&constraints->strands) &&
        !(propagation->decided = MESO_NEW(arena, uint32_t, slot_count, error)))
        return MESO_ERR_MEMORY;
    if (!propagation->codes || !propagation->state || !propagation->initial ||
        !propagation->touched || !propagation->pending || !propagation->list.slots)
        return MESO_ERR_MEMORY;
    for (size_t i = 0; i < 4 * (size_t)variants->count; i++)
        propagation->codes[i] = meso_label_code(variants->labels[i]);
    if (meso_quota_track_init(&propagation->quotas, arena, constraints,
                              meso_bits_words(variants->count), error))
        return MESO_ERR_MEMORY;
    return meso_bucket_queue_init(&propagation->queue, arena, slot_count, variants->count, error);
}

static MesoStatus find_initial_states(MesoPropagation *propagation, const MesoTilingProblem *problem, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = meso_initial_states(propagation->state, &propagation->initial_dead_count,
                                            &propagation->domains, &scratch, problem, error);
    meso_arena_release(&scratch);
    return status;
}

static void plan_collection(MesoPropagation *propagation)
{
    uint32_t growth = propagation->graph->slot_count / 4;
    growth = growth > COLLECT_STATES ? growth : COLLECT_STATES;
    propagation->collect_at = propagation->domains.states.count + growth;
}

MesoStatus meso_propagation_init(MesoPropagation *propagation, MesoArena *arena,
                                 const MesoTilingProblem *problem, MesoError *error)
{
    *propagation = (MesoPropagation){.graph = problem->graph, .set = problem->set, .arena = arena};
    uint32_t step_count = LEAST_STEPS;
    while (step_count < MOST_STEPS && step_count < 2 * (uint64_t)problem->graph->slot_count)
        step_count *= 2;

    if (allocate(propagation, arena, problem->variants, problem->constraints, error) ||
        meso_domain_table_init(&propagation->domains, problem->variants->count, propagation->codes,
                               2 * problem->set->interface_count, step_count, error) ||
        find_initial_states(propagation, problem, error) || run_initial(propagation, error))
        return MESO_ERR_MEMORY;
    plan_collection(propagation);
    return MESO_OK;
}

void meso_propagation_release(MesoPropagation *propagation)
{
    meso_domain_table_release(&propagation->domains);
}

void meso_propagation_forget(MesoPropagation *propagation)
{
    propagation->history.count = 0;
    propagation->generation++;
}

static void clear_trail(MesoPropagation *propagation)
{
    while (propagation->trail.count)
        propagation->pending[propagation->trail.entries[--propagation->trail.count].slot] &= (uint8_t)~ON_TRAIL;
}

/* Room for new states, and an empty trail. */
static MesoStatus begin_step(MesoPropagation *propagation, MesoError *error)
{
    clear_trail(propagation);
    if (propagation->domains.states.count < propagation->collect_at)
        return MESO_OK;
    if (meso_domain_collect(&propagation->domains, propagation->graph->slot_count,
                            propagation->state, propagation->initial, error))
        return MESO_ERR_MEMORY;
    plan_collection(propagation);
    meso_propagation_forget(propagation);
    if (propagation->causes)
        meso_cause_log_clear(propagation->causes, true);
    return MESO_OK;
}

MesoStatus meso_propagation_mark(MesoPropagation *propagation, MesoPropagationMark *mark, MesoError *error)
{
    MesoStatus status = begin_step(propagation, error);
    *mark = (MesoPropagationMark){propagation->history.count, propagation->decided_count,
                                  propagation->generation};
    return status;
}

MesoStatus meso_propagation_rewind(MesoPropagation *propagation, MesoPropagationMark mark, bool *done,
                                   MesoError *error)
{
    *done = mark.generation == propagation->generation;
    if (!*done)
        return MESO_OK;
    clear_trail(propagation);
    while (propagation->history.count > mark.history_count) {
        MesoTrailEntry entry = propagation->history.entries[--propagation->history.count];
        if (move_to_state(propagation, entry.slot, entry.state, error))
            return MESO_ERR_MEMORY;
    }
    propagation->decided_count = mark.decided_count;
    return MESO_OK;
}

MesoStatus meso_propagation_assign(MesoPropagation *propagation, uint32_t slot, uint32_t variant,
                                   MesoError *error)
{
    if (begin_step(propagation, error))
        return MESO_ERR_MEMORY;
    if (propagation->causes)
        meso_cause_log_begin(propagation->causes, variant, true);
    uint32_t next = meso_domain_single(&propagation->domains, variant, error);
    if (next == MESO_NO_INDEX || set_state(propagation, slot, next, MESO_NO_INDEX, error))
        return MESO_ERR_MEMORY;
    return run_with_quotas(propagation, error);
}

MesoStatus meso_propagation_exclude(MesoPropagation *propagation, uint32_t slot, uint32_t variant,
                                    MesoError *error)
{
    if (begin_step(propagation, error))
        return MESO_ERR_MEMORY;
    if (propagation->causes)
        meso_cause_log_begin(propagation->causes, variant, false);
    uint32_t next = meso_domain_without(&propagation->domains, propagation->state[slot], variant, error);
    assert(next != MESO_DOMAIN_EMPTY);
    if (next == MESO_NO_INDEX || set_state(propagation, slot, next, MESO_NO_INDEX, error))
        return MESO_ERR_MEMORY;
    return run_with_quotas(propagation, error);
}

MesoStatus meso_propagation_undo(MesoPropagation *propagation, MesoError *error)
{
    if (propagation->causes)
        meso_cause_log_pop(propagation->causes);
    while (propagation->trail.count) {
        MesoTrailEntry entry = propagation->trail.entries[--propagation->trail.count];
        propagation->pending[entry.slot] &= (uint8_t)~ON_TRAIL;
        if (move_to_state(propagation, entry.slot, entry.state, error))
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

MesoStatus meso_propagation_jump(MesoPropagation *propagation, uint32_t step, MesoError *error)
{
    MesoCauseLog *causes = propagation->causes;
    clear_trail(propagation);
    while (causes->step_count > step) {
        uint32_t first = causes->steps[causes->step_count - 1].first;
        while (causes->change_count > first) {
            MesoChange change = causes->changes[--causes->change_count];
            if (move_to_state(propagation, change.slot, change.before, error))
                return MESO_ERR_MEMORY;
        }
        meso_cause_log_pop(causes);
    }
    return MESO_OK;
}

void meso_propagation_explain(const MesoPropagation *propagation, MesoConflict *conflict)
{
    uint32_t dead = propagation->dead_slot;
    assert(dead != MESO_NO_INDEX);
    bool changed = propagation->state[dead] != propagation->initial[dead];
    meso_cause_log_explain(propagation->causes, changed ? dead : MESO_NO_INDEX, propagation->dead_teller,
                         propagation->initial, propagation->pending, IN_CONFLICT, conflict);
}

MesoStatus meso_propagation_try(MesoPropagation *propagation, uint32_t slot, uint32_t variant, bool *dead,
                                uint32_t *changes, MesoError *error)
{
    propagation->queue_rests = true;
    MesoStatus status = meso_propagation_assign(propagation, slot, variant, error);
    *dead = propagation->dead_slot != MESO_NO_INDEX;
    *changes = (uint32_t)propagation->trail.count;
    if (!status)
        status = meso_propagation_undo(propagation, error);
    propagation->queue_rests = false;
    return status;
}

/* Puts the slots up to `radius` edges around `slot` on the list, breadth first, and marks them. */
static void collect_ball(MesoPropagation *propagation, uint32_t slot, uint32_t radius)
{
    const uint32_t *twins = propagation->graph->twin;
    uint32_t begin = 0, end = 1;
    propagation->list.slots[0] = slot;
    propagation->pending[slot] |= IN_BALL;
    for (; radius > 0 && begin < end; radius--) {
        uint32_t ring_end = end;
        for (; begin < ring_end; begin++)
            for (uint32_t k = 0; k < 4; k++) {
                uint32_t twin = twins[4 * (size_t)propagation->list.slots[begin] + k];
                if (twin == MESO_NO_INDEX || propagation->pending[twin / 4] & IN_BALL)
                    continue;
                propagation->pending[twin / 4] |= IN_BALL;
                propagation->list.slots[end++] = twin / 4;
            }
    }
    propagation->list.head = 0;
    propagation->list.count = end;
}

/* The slots on the list have all to tell, and to hear from those around them that are not on it. */
static void push_ball(MesoPropagation *propagation)
{
    const uint32_t *twins = propagation->graph->twin;
    uint32_t count = propagation->list.count;
    for (uint32_t i = 0; i < count; i++)
        propagation->pending[propagation->list.slots[i]] |= ALL_SIDES;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t twin = twins[4 * (size_t)propagation->list.slots[i] + k];
            if (twin != MESO_NO_INDEX && !(propagation->pending[twin / 4] & IN_BALL))
                push(propagation, twin / 4, (uint8_t)(1u << (twin % 4)));
        }
    for (uint32_t i = 0; i < count; i++)
        propagation->pending[propagation->list.slots[i]] &= (uint8_t)~IN_BALL;
}

MesoStatus meso_propagation_reopen(MesoPropagation *propagation, uint32_t slot, uint32_t radius,
                                   uint32_t *reopened, MesoError *error)
{
    if (begin_step(propagation, error))
        return MESO_ERR_MEMORY;
    if (propagation->causes)
        meso_cause_log_clear(propagation->causes, true);
    assert(propagation->list.count == 0);
    collect_ball(propagation, slot, radius);
    *reopened = propagation->list.count;
    for (uint32_t i = 0; i < *reopened; i++) {
        uint32_t inner = propagation->list.slots[i];
        if (propagation->state[inner] == propagation->initial[inner])
            continue;
        if (note_change(propagation, inner, error) ||
            move_to_state(propagation, inner, propagation->initial[inner], error))
            return MESO_ERR_MEMORY;
    }
    push_ball(propagation);
    return run_with_quotas(propagation, error);
}

void meso_propagation_settle(MesoPropagation *propagation)
{
    clear_trail(propagation);
    while (propagation->touched_count) {
        uint32_t slot = propagation->touched[--propagation->touched_count];
        propagation->initial[slot] = propagation->state[slot];
        propagation->pending[slot] &= (uint8_t)~TOUCHED;
    }
    meso_bucket_queue_stock(&propagation->queue, state_size, propagation);
}

void meso_propagation_restart(MesoPropagation *propagation)
{
    const MesoDomain *domains = propagation->domains.domains;
    while (propagation->touched_count) {
        uint32_t slot = propagation->touched[--propagation->touched_count];
        uint32_t before = propagation->state[slot], next = propagation->initial[slot];
        propagation->pending[slot] &= (uint8_t)~(TOUCHED | ON_TRAIL);
        tell_quotas(propagation, slot, next);
        propagation->state[slot] = next;
        meso_bucket_queue_restock(&propagation->queue, slot, domains[before].size, domains[next].size);
    }
    meso_bucket_queue_refill(&propagation->queue);
    propagation->trail.count = 0;
    propagation->decided_count = 0;
    meso_propagation_forget(propagation);
    if (propagation->causes)
        meso_cause_log_clear(propagation->causes, false);
}

const uint64_t *meso_propagation_allowed(const MesoPropagation *propagation, uint32_t slot,
                                         uint32_t side)
{
    uint32_t twin = propagation->graph->twin[4 * (size_t)slot + side];
    assert(twin != MESO_NO_INDEX);
    uint32_t state = propagation->state[twin / 4];
    return meso_domain_labels(&propagation->domains,
                              propagation->domains.domains[state].allow[twin % 4]);
}
