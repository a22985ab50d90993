#include <string.h>

#include "libcore/growth/engine/growth_work.h"

static bool fail_memory(MesoGrowthWork *work)
{
    work->status = meso_fail(work->error, MESO_ERR_MEMORY, "out of memory: %u elements and %u branches have grown",
                             work->element_count, work->branch_count);
    return false;
}

static bool stop_at(MesoGrowthWork *work, MesoGrowthEnd end)
{
    work->stops = true;
    work->end = end;
    return false;
}

/* ---- branches ---- */

static MesoGrowthRuleCount *counts_of(MesoGrowthWork *work, const MesoGrowthTip *tip)
{
    static MesoGrowthRuleCount none;
    return tip->rule == MESO_NO_INDEX ? &none : &work->rules[tip->rule];
}

/* A tip with registers of its own, to be active from the next turns on. */
static bool add_tip(MesoGrowthWork *work, const MesoGrowthTip *tip, const double *registers)
{
    uint32_t width = work->grammar->local_count;
    uint64_t count = (uint64_t)work->tip_count + 1;
    if (!meso_make_room((void **)&work->tips, &work->tip_room, count, sizeof *tip) ||
        !meso_make_room((void **)&work->registers, &work->register_room, count * width + 1, sizeof *registers) ||
        !meso_make_room((void **)&work->shoots, &work->shoot_room, (uint64_t)work->shoot_count + 1,
                        sizeof *work->shoots))
        return fail_memory(work);
    work->tips[work->tip_count] = *tip;
    double *own = work->registers + (size_t)work->tip_count * width;
    if (registers)
        meso_copy_registers(own, registers, width);
    else
        memset(own, 0, width * sizeof *own);
    work->shoots[work->shoot_count++] = work->tip_count++;
    return true;
}

static bool add_branch(MesoGrowthWork *work, uint64_t key, uint32_t parent, uint32_t seed)
{
    if (!meso_make_room((void **)&work->branches, &work->branch_room, (uint64_t)work->branch_count + 1,
                        sizeof *work->branches))
        return fail_memory(work);
    work->branches[work->branch_count++] = (MesoGrowthBranch){key, parent, seed, MESO_NO_INDEX};
    return true;
}

bool meso_growth_plant(MesoGrowthWork *work, const MesoGrowthStart *start, uint32_t number)
{
    MesoGrowthTip tip = {.at = start->tip, .rule = MESO_NO_INDEX, .joint = MESO_NO_INDEX, .shape = MESO_NO_INDEX,
                         .branch = work->branch_count, .node = MESO_GROWTH_ROOT | number, .done = true};
    tip.run = meso_growth_begin(work->grammar->seeds[start->seed].entry, start->key);
    tip.foot = meso_growth_foot(work->ground, &tip.at);
    tip.state[MESO_STATE_X] = tip.foot.position[0];
    tip.state[MESO_STATE_Y] = tip.foot.position[1];
    tip.state[MESO_STATE_Z] = tip.foot.position[2];
    return add_branch(work, start->key, MESO_NO_INDEX, start->seed) && add_tip(work, &tip, NULL);
}

static bool begin_branches(MesoGrowthWork *work, uint32_t number, const MesoGrowthTurn *turn)
{
    const MesoGrowthBatch *batch = turn->batch;
    if (!turn->shoot_count)
        return true;
    const MesoGrowthTip parent = work->tips[number];    /* tips may move */
    for (uint32_t i = turn->shoot_begin; i < turn->shoot_begin + turn->shoot_count; i++) {
        const MesoGrowthShoot *shoot = &batch->shoots[i];
        MesoGrowthTip tip = parent;
        tip.at = shoot->at;
        tip.run = meso_growth_begin(shoot->entry, shoot->key);
        tip.state[MESO_STATE_DEPTH]++;
        tip.branch = work->branch_count;
        tip.joint = MESO_NO_INDEX;
        tip.arrive = (MesoFour){0, 0, 0, 0};
        tip.raise = 0;
        tip.walks = tip.faces = 0;
        tip.done = true;
        tip.rests = tip.ended = false;
        if (!add_branch(work, shoot->key, parent.branch, work->branches[parent.branch].seed) ||
            !add_tip(work, &tip, batch->registers + (size_t)i * work->grammar->local_count))
            return false;
    }
    counts_of(work, &parent)->branches += turn->shoot_count;
    return true;
}

/* ---- elements ---- */

static uint32_t add_joint(MesoGrowthWork *work, const MesoGrowthSeat *seat, const MesoTip *at)
{
    uint64_t count = (uint64_t)work->joint_count + 1;
    if (!meso_make_room((void **)&work->joints, &work->joint_room, count, sizeof *work->joints) ||
        !meso_make_room((void **)&work->points, &work->point_room, count, sizeof *work->points))
        return MESO_NO_INDEX;
    work->joints[work->joint_count] = meso_seat_joint(seat);
    work->points[work->joint_count] = (MesoMeshPoint){
        at->triangle, {(float)at->weight[0], (float)at->weight[1], (float)at->weight[2]}};
    return work->joint_count++;
}

/* The ball around all of a way: it stays within its length of where it begins. */
static bool add_ball(MesoGrowthWork *work, MesoFour center, double radius)
{
    float ball[4] = {center[0], center[1], center[2], (float)(radius * 1.0001)};
    if (!work->looks && !work->clears)
        return true;
    if (!meso_make_room((void **)&work->balls, &work->ball_room, (uint64_t)work->ball_count + 1, sizeof ball))
        return false;
    memcpy(work->balls + 4 * (size_t)work->ball_count++, ball, sizeof ball);
    return true;
}

static bool occupy(MesoGrowthWork *work, const MesoGrowthTip *tip, const MesoGrowthTurn *turn)
{
    bool placed = turn->outcome == MESO_GROWTH_PLACES;
    float begin = (float)tip->state[MESO_STATE_LENGTH];
    MesoGrowthKin kin = {tip->node, tip->moved, placed, begin, placed ? begin : begin + (float)turn->length};
    if (!work->uses_space)
        return true;
    return meso_growth_space_add(&work->space, kin, turn->batch->pieces + turn->piece_begin, turn->piece_count) &&
           add_ball(work, tip->foot.position, turn->length);
}

static bool add_element(MesoGrowthWork *work, const MesoGrowthTip *tip, const MesoGrowthTurn *turn, MesoSpan span,
                        double length)
{
    if (!meso_make_room((void **)&work->elements, &work->element_room, (uint64_t)work->element_count + 1,
                        sizeof *work->elements))
        return false;
    MesoGrowthBranch *branch = &work->branches[tip->branch];
    if (branch->element_begin == MESO_NO_INDEX)
        branch->element_begin = work->element_count;
    work->elements[work->element_count++] = (MesoGrowthElement){
        span, turn->command.shape, tip->branch, tip->rule, (uint32_t)tip->state[MESO_STATE_GENERATION],
        (float)turn->command.values[MESO_GROWTH_TINT], (float)length};
    return true;
}

static void go_to(MesoGrowthTip *tip, const MesoGrowthTurn *turn)
{
    tip->at = turn->end;
    tip->foot = turn->foot;
    tip->state[MESO_STATE_LENGTH] += turn->length;
    tip->state[MESO_STATE_X] = turn->foot.position[0];
    tip->state[MESO_STATE_Y] = turn->foot.position[1];
    tip->state[MESO_STATE_Z] = turn->foot.position[2];
}

static void note_depth(MesoGrowthWork *work, const MesoGrowthTurn *turn)
{
    work->depth = turn->depth > work->depth ? turn->depth : work->depth;
    work->divided += turn->middle_count > 0;
    work->raised += turn->raise > 0;
}

/* Elements from joint to joint of a step, which begins at the joint `from`; the last joint, or MESO_NO_INDEX. */
static uint32_t add_spans(MesoGrowthWork *work, const MesoGrowthTip *tip, const MesoGrowthTurn *turn, uint32_t from)
{
    const MesoGrowthMiddle *middles = turn->batch->middles + turn->middle_begin;
    uint32_t spans = turn->middle_count + 1;
    for (uint32_t i = 0; i < spans && from != MESO_NO_INDEX; i++) {
        bool last = i + 1 == spans;
        uint32_t to = add_joint(work, last ? &turn->to : &middles[i].joint, last ? &turn->end : &middles[i].at);
        double length = tip->state[MESO_STATE_LENGTH] + turn->length * (i + 1) / spans;
        from = to != MESO_NO_INDEX && add_element(work, tip, turn, (MesoSpan){from, to}, length) ? to : MESO_NO_INDEX;
    }
    return from;
}

static bool accept_step(MesoGrowthWork *work, MesoGrowthTip *tip, const MesoGrowthTurn *turn)
{
    uint32_t from = tip->joint;
    if (from != MESO_NO_INDEX) {
        work->joints[from] = meso_seat_joint(&turn->from);
        work->joints[from].width = turn->shares ? turn->from.width : turn->had;
    }
    if (!turn->shares)
        from = add_joint(work, &turn->from, &tip->at);
    uint32_t to = add_spans(work, tip, turn, from);
    if (to == MESO_NO_INDEX || !occupy(work, tip, turn))
        return fail_memory(work);
    note_depth(work, turn);
    counts_of(work, tip)->steps++;
    work->length += turn->length;
    tip->node = work->space.kin_count - 1;
    tip->joint = to;
    tip->shape = turn->command.shape;
    tip->arrive = turn->arrive;
    tip->state[MESO_STATE_WIDTH] = turn->to.width;
    tip->bow = turn->bow;
    tip->lift = turn->lift;
    tip->roll = turn->roll;
    tip->raise = turn->raise;
    tip->open = !(turn->command.given >> MESO_GROWTH_END_WIDTH & 1);
    tip->moved = false;
    go_to(tip, turn);
    tip->ended = turn->outcome == MESO_GROWTH_JOINS;
    return true;
}

static bool accept_place(MesoGrowthWork *work, const MesoGrowthTip *tip, const MesoGrowthTurn *turn)
{
    uint32_t from = add_joint(work, &turn->from, &tip->at);
    uint32_t to = from == MESO_NO_INDEX ? MESO_NO_INDEX : add_joint(work, &turn->to, &turn->end);
    if (to == MESO_NO_INDEX || !occupy(work, tip, turn) ||
        !add_element(work, tip, turn, (MesoSpan){from, to}, tip->state[MESO_STATE_LENGTH]))
        return fail_memory(work);
    note_depth(work, turn);
    counts_of(work, tip)->placed++;
    return true;
}

static void accept_move(MesoGrowthTip *tip, const MesoGrowthTurn *turn)
{
    go_to(tip, turn);
    tip->joint = MESO_NO_INDEX;
    tip->arrive = (MesoFour){0, 0, 0, 0};
    tip->raise = 0;
    tip->moved |= turn->length > 0;
}

/* ---- turns ---- */

static void tell(const MesoGrowthWork *work, const MesoGrowthTip *tip, const MesoGrowthTurn *turn)
{
    if (!work->options->event)
        return;
    MesoGrowthEvent event = {work->branches[tip->branch].key, tip->rule, (uint32_t)tip->state[MESO_STATE_GENERATION],
                             &turn->command, tip->at, turn->outcome != MESO_GROWTH_REFUSED};
    work->options->event(work->options->context, &event);
}

static void begin_rule(MesoGrowthWork *work, uint32_t number, const MesoGrowthCommand *command)
{
    MesoGrowthTip *tip = &work->tips[number];
    double *registers = work->registers + (size_t)number * work->grammar->local_count;
    uint32_t count = work->grammar->rules[command->rule].argument_count;
    meso_copy_registers(registers, command->values, count);
    tip->run = meso_growth_begin(work->grammar->rules[command->rule].entry, command->key);
    if (tip->rule != MESO_NO_INDEX)
        tip->state[MESO_STATE_GENERATION]++;
    tip->rule = command->rule;
    tip->walks = tip->faces = 0;
    tip->rests = true;
}

/* Whether what the window has grown lies where a turn looked. */
static bool is_near_new(const MesoGrowthWork *work, const MesoGrowthTurn *turn)
{
    const float *b = turn->ball;
    bool near = false;
    for (uint32_t i = 0; i < work->ball_count; i++) {
        const float *a = work->balls + 4 * (size_t)i;
        float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2], reach = a[3] + b[3];
        near |= x * x + y * y + z * z <= reach * reach;
    }
    return near && b[3] >= 0;
}

static bool is_step(const MesoGrowthTurn *turn)
{
    return turn->outcome == MESO_GROWTH_STEPS || turn->outcome == MESO_GROWTH_JOINS;
}

/* Does again what the window's earlier branches have changed. */
static void bring_up_to_date(MesoGrowthWork *work, uint32_t number)
{
    MesoGrowthTurn *turn = &work->turns[number];
    MesoGrowthBatch *batch = &work->batches[work->batch_count];
    uint32_t active = work->active[work->window_begin + number];
    MesoGrowthTip *tip = &work->tips[active];
    if (turn->looked) {
        if (is_near_new(work, turn))
            meso_growth_try_again(work, batch, number);
    } else if (is_step(turn) || (turn->outcome == MESO_GROWTH_REFUSED && turn->command.join)) {
        bool may_be_near = !(turn->command.values[MESO_GROWTH_CLEAR] > 0) || is_near_new(work, turn);
        if (!may_be_near || (is_step(turn) && !meso_growth_collides(work, batch, tip, turn, work->since)))
            return;
        meso_growth_judge_again(work, batch, tip, work->registers + (size_t)active * work->grammar->local_count, turn,
                                turn->try + 1);
        if (is_step(turn))
            meso_growth_join(work, tip, turn);
    }
}

/* Whether there is room for one more element below the limits. */
static bool fits(MesoGrowthWork *work, const MesoGrowthTurn *turn)
{
    bool grows = is_step(turn) || turn->outcome == MESO_GROWTH_PLACES;
    if (grows && !(work->element_count + turn->middle_count < work->element_limit))
        return stop_at(work, MESO_GROWTH_ELEMENTS);
    if (is_step(turn) && work->length + turn->length > work->length_limit)
        return stop_at(work, MESO_GROWTH_LENGTH);
    return true;
}

static bool accept_walk(MesoGrowthWork *work, MesoGrowthTip *tip, const MesoGrowthTurn *turn)
{
    counts_of(work, tip)->at_borders += turn->at_border;
    if (turn->outcome == MESO_GROWTH_REFUSED) {
        counts_of(work, tip)->refused++;
        tip->done = false;
    }
    if (is_step(turn) && !accept_step(work, tip, turn))
        return false;
    if (turn->outcome == MESO_GROWTH_PLACES && !accept_place(work, tip, turn))
        return false;
    if (turn->outcome == MESO_GROWTH_MOVES)
        accept_move(tip, turn);
    return true;
}

bool meso_growth_accept(MesoGrowthWork *work, uint32_t number)
{
    MesoGrowthTurn *turn = &work->turns[number];
    uint32_t active = work->active[work->window_begin + number];
    if (work->uses_space && work->space.kin_count > work->since)
        bring_up_to_date(work, number);
    const MesoGrowthCommand *command = &turn->command;
    if (turn->batch->failed || turn->batch->seen.failed)
        return fail_memory(work);
    if (command->order == MESO_GROWTH_FAULT) {
        work->status = meso_fail(work->error, MESO_ERR_INPUT, "line %u: %s", command->line, command->fault);
        return false;
    }
    if (!fits(work, turn) || !begin_branches(work, active, turn))
        return false;
    MesoGrowthTip *tip = &work->tips[active];
    if (!accept_walk(work, tip, turn))
        return false;
    tell(work, tip, turn);
    if (command->order == MESO_GROWTH_RULE)
        begin_rule(work, active, command);
    else if (command->order == MESO_GROWTH_END)
        tip->ended = true;
    return true;
}
