#include <string.h>

#include "libcore/growth/engine/growth_work.h"

/* ---- branches ---- */

/* A tip with registers of its own, to be active from the next turns on. */
static void enter_tip(MesoGrowthWork *work, uint32_t number, uint32_t shoot, const double *registers)
{
    uint32_t width = work->grammar->local_count;
    double *own = work->registers + (size_t)number * width;
    work->shoots[shoot] = number;
    work->ended[number] = 0;
    if (registers)
        meso_copy_registers(own, registers, width);
    else
        memset(own, 0, width * sizeof *own);
}

bool meso_growth_plant(MesoGrowthWork *work, const MesoGrowthStart *start, uint32_t number)
{
    MesoGrowthTip tip = {.at = start->tip, .seed = start->seed, .rule = MESO_NO_INDEX, .joint = MESO_NO_INDEX,
                         .shape = MESO_NO_INDEX, .branch = work->branch_count, .node = MESO_GROWTH_ROOT | number,
                         .done = true};
    tip.run = meso_growth_begin(work->grammar->seeds[start->seed].entry, start->key);
    tip.foot = meso_growth_foot(work->ground, &tip.at);
    tip.state[MESO_STATE_X] = tip.foot.position[0];
    tip.state[MESO_STATE_Y] = tip.foot.position[1];
    tip.state[MESO_STATE_Z] = tip.foot.position[2];
    if (!meso_growth_make_rooms(work, 0, 1, 1))
        return false;
    work->branch_count++;
    work->tip_count++;
    work->shoot_count++;
    work->branches[tip.branch] = (MesoGrowthBranch){start->key, MESO_NO_INDEX, start->seed, MESO_NO_INDEX};
    work->tips[work->tip_count - 1] = tip;
    enter_tip(work, work->tip_count - 1, work->shoot_count - 1, NULL);
    return true;
}

static void begin_branches(MesoGrowthWork *work, const MesoGrowthWindow *window, const MesoGrowthTip *parent,
                           const MesoGrowthTurn *turn)
{
    const MesoGrowthBatch *batch = turn->batch;
    for (uint32_t i = 0; i < turn->shoot_count; i++) {
        const MesoGrowthShoot *shoot = &batch->shoots[turn->shoot_begin + i];
        uint32_t branch = turn->branch_begin + i, since = branch - window->first_branch;
        MesoGrowthTip *tip = &work->tips[window->first_tip + since];
        memmove(tip, parent, sizeof *tip);  /* by a call: what compilers make of an assignment is slow to begin */
        tip->at = shoot->at;
        meso_growth_restart(&tip->run, shoot->entry, shoot->key);
        tip->state[MESO_STATE_DEPTH]++;
        tip->branch = branch;
        tip->joint = MESO_NO_INDEX;
        tip->arrive = (MesoFour){0, 0, 0, 0};
        tip->raise = 0;
        tip->walks = tip->faces = 0;
        tip->done = true;
        tip->rests_in = 0;
        work->branches[branch] = (MesoGrowthBranch){shoot->key, parent->branch, parent->seed, MESO_NO_INDEX};
        enter_tip(work, window->first_tip + since, window->first_shoot + since,
                  batch->registers + (size_t)(turn->shoot_begin + i) * work->grammar->local_count);
    }
}

/* ---- elements ---- */

static void set_joint(MesoGrowthWork *work, uint32_t number, const MesoGrowthSeat *seat, const MesoTip *at)
{
    work->joints[number] = meso_seat_joint(seat);
    work->points[number] = (MesoMeshPoint){
        at->triangle, {(float)at->weight[0], (float)at->weight[1], (float)at->weight[2]}};
}

static void set_element(MesoGrowthWork *work, uint32_t number, const MesoGrowthTip *tip, const MesoGrowthTurn *turn,
                        MesoSpan span, double length)
{
    MesoGrowthBranch *branch = &work->branches[tip->branch];
    if (branch->element_begin == MESO_NO_INDEX)
        branch->element_begin = number;
    work->elements[number] = (MesoGrowthElement){
        span, turn->command.shape, tip->branch, tip->rule, (uint32_t)tip->state[MESO_STATE_GENERATION],
        (float)turn->command.values[MESO_GROWTH_TINT], (float)length};
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

/* Elements of a step, from the joint `from` to new joints, which begin with `joint`; the last of them. */
static uint32_t set_spans(MesoGrowthWork *work, const MesoGrowthTip *tip, const MesoGrowthTurn *turn, uint32_t from,
                          uint32_t joint)
{
    const MesoGrowthMiddle *middles = turn->batch->middles + turn->middle_begin;
    uint32_t spans = turn->middle_count + 1;
    for (uint32_t i = 0; i < spans; i++, from = joint++) {
        bool last = i + 1 == spans;
        set_joint(work, joint, last ? &turn->to : &middles[i].joint, last ? &turn->end : &middles[i].at);
        set_element(work, turn->element_begin + i, tip, turn, (MesoSpan){from, joint},
                    tip->state[MESO_STATE_LENGTH] + turn->length * (i + 1) / spans);
    }
    return from;
}

static void accept_step(MesoGrowthWork *work, MesoGrowthTip *tip, const MesoGrowthTurn *turn)
{
    uint32_t from = tip->joint, joint = turn->joint_begin;
    if (from != MESO_NO_INDEX) {
        work->joints[from] = meso_seat_joint(&turn->from);
        work->joints[from].width = turn->shares ? turn->from.width : turn->had;
    }
    if (!turn->shares) {
        from = joint++;
        set_joint(work, from, &turn->from, &tip->at);
    }
    tip->joint = set_spans(work, tip, turn, from, joint);
    tip->node = turn->node;
    tip->piece = turn->piece;
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
}

static void accept_place(MesoGrowthWork *work, const MesoGrowthTip *tip, const MesoGrowthTurn *turn)
{
    uint32_t from = turn->joint_begin, to = from + 1;
    set_joint(work, from, &turn->from, &tip->at);
    set_joint(work, to, &turn->to, &turn->end);
    set_element(work, turn->element_begin, tip, turn, (MesoSpan){from, to}, tip->state[MESO_STATE_LENGTH]);
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

static bool rests(const MesoGrowthWork *work, const MesoGrowthTip *tip)
{
    return tip->rests_in == (uint32_t)work->generation + 1;
}

static void begin_rule(const MesoGrowthWork *work, const MesoGrowthBatch *batch, uint32_t number,
                       const MesoGrowthCommand *command)
{
    MesoGrowthTip *tip = &work->tips[number];
    const MesoGrammarRule *rule = &work->grammar->rules[command->rule];
    meso_copy_registers(work->registers + (size_t)number * work->grammar->local_count, command->values,
                        rule->argument_count);
    meso_growth_restart(&tip->run, rule->entry, command->key);
    if (tip->rule != MESO_NO_INDEX)
        tip->state[MESO_STATE_GENERATION]++;
    tip->rule = command->rule;
    tip->walks = tip->faces = 0;
    tip->rests_in = (uint32_t)work->generation + 1;
    batch->runs[command->rule]++;
}

static void end_turn(const MesoGrowthWork *work, const MesoGrowthBatch *batch, uint32_t number,
                     const MesoGrowthCommand *command)
{
    if (command->order == MESO_GROWTH_RULE)
        begin_rule(work, batch, number, command);
    else if (command->order == MESO_GROWTH_END)
        work->ended[number] = 1;
}

static void turn_tip(void *context, double angle)
{
    meso_tip_turn(context, angle);
}

/*
 * The next turn of a branch, as soon as the last is done or it has begun, where all it comes to is the end of the rule:
 * nothing depends on when that is, and so there is no turn to it. Anything else is left to the turn.
 */
static void end_rule_early(const MesoGrowthWork *work, const MesoGrowthBatch *batch, uint32_t number,
                           MesoGrowthCommand *command)
{
    MesoGrowthTip *tip = &work->tips[number];
    uint32_t at = tip->run.stepped && !tip->done ? tip->run.refused : tip->run.at;
    if (!work->ahead || rests(work, tip) || work->ended[number] ||
        (at != MESO_NO_INDEX && work->ahead[at] != MESO_AHEAD_END))
        return;
    double registers[MESO_GRAMMAR_REGISTERS];
    uint32_t width = work->grammar->local_count;
    MesoTip turned = tip->at;
    const MesoGrowthHost host = {.context = &turned, .state = tip->state, .turn = turn_tip};
    MesoGrowthRun run = tip->run;
    meso_copy_registers(registers, work->registers + (size_t)number * width, width);
    meso_growth_resume(command, work->grammar, &run, registers, &host, tip->done);
    if (command->order != MESO_GROWTH_RULE && command->order != MESO_GROWTH_END)
        return;
    tip->at = turned;
    tip->done = true;
    end_turn(work, batch, number, command);
}

/* Branches that a turn has begun, of which nothing is left to do. */
static void end_shoots_early(const MesoGrowthWork *work, const MesoGrowthWindow *window, const MesoGrowthBatch *batch,
                             const MesoGrowthTurn *turn, MesoGrowthCommand *command)
{
    for (uint32_t i = 0; i < turn->shoot_count; i++) {
        uint32_t since = turn->branch_begin + i - window->first_branch, number = window->first_tip + since;
        end_rule_early(work, batch, number, command);
        if (rests(work, &work->tips[number]) || work->ended[number])
            work->shoots[window->first_shoot + since] = MESO_NO_INDEX;
    }
}

static void accept_turn(MesoGrowthWork *work, const MesoGrowthWindow *window, const MesoGrowthBatch *batch,
                        uint32_t number, const MesoGrowthTurn *turn)
{
    MesoGrowthTip *tip = &work->tips[number];
    if (turn->shoot_count)
        begin_branches(work, window, tip, turn);
    if (meso_growth_is_step(turn))
        accept_step(work, tip, turn);
    else if (turn->outcome == MESO_GROWTH_PLACES)
        accept_place(work, tip, turn);
    else if (turn->outcome == MESO_GROWTH_MOVES)
        accept_move(tip, turn);
    else if (turn->outcome == MESO_GROWTH_REFUSED)
        tip->done = false;
    if (turn->outcome == MESO_GROWTH_JOINS)
        work->ended[number] = 1;
    tell(work, tip, turn);
    end_turn(work, batch, number, &turn->command);
}

void meso_growth_accept(MesoGrowthWork *work, const MesoGrowthWindow *window, const MesoGrowthBatch *batch,
                        uint32_t begin, uint32_t end)
{
    MesoGrowthCommand command = {0};
    for (uint32_t i = begin; i < end; i++) {
        uint32_t at = window->begin + i, number = work->active[at];
        accept_turn(work, window, batch, number, &window->turns[i]);
        end_rule_early(work, batch, number, &command);
        end_shoots_early(work, window, batch, &window->turns[i], &command);
        work->goes_on[at] = !rests(work, &work->tips[number]) && !work->ended[number];
    }
}
