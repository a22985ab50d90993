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

/* ---- turns that others may have changed ---- */

static inline uint32_t mark_of(uint32_t triangle)
{
    return (triangle * 2654435769u) / (UINT32_MAX / MESO_GROWTH_MARKS + 1);
}

/* Whether the window may have grown in a triangle that a turn's way goes through; where not, the two do not meet. */
static bool may_meet_new(const MesoGrowthWork *work, const MesoGrowthTurn *turn)
{
    const MesoGrowthPiece *pieces = turn->batch->pieces + turn->piece_begin;
    for (uint32_t i = 0; i < turn->piece_count; i++) {
        uint32_t mark = mark_of(pieces[i].triangle);
        if (work->grown_in[mark / 64] >> mark % 64 & 1)
            return true;
    }
    return false;
}

static void mark_new(MesoGrowthWork *work, const MesoGrowthPiece *pieces, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t mark = mark_of(pieces[i].triangle);
        work->grown_in[mark / 64] |= (uint64_t)1 << mark % 64;
    }
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

/* Does again what the window's earlier branches have changed. */
static void bring_up_to_date(MesoGrowthWork *work, MesoGrowthWindow *window, uint32_t number)
{
    MesoGrowthTurn *turn = &window->turns[number];
    MesoGrowthBatch *batch = meso_growth_again(work, window, turn);
    uint32_t active = work->active[window->begin + number];
    MesoGrowthTip *tip = &work->tips[active];
    bool steps = meso_growth_is_step(turn);
    if (turn->looked) {
        if (is_near_new(work, turn))
            meso_growth_try_again(work, window, number);
    } else if (steps || (turn->outcome == MESO_GROWTH_REFUSED && turn->command.join)) {
        bool clears = turn->command.values[MESO_GROWTH_CLEAR] > 0;
        bool may_be_near = clears ? is_near_new(work, turn) : !steps || may_meet_new(work, turn);
        if (!may_be_near || (steps && !meso_growth_collides(work, batch, tip, turn, work->since)))
            return;
        meso_growth_judge_again(work, batch, tip, work->registers + (size_t)active * work->grammar->local_count, turn,
                                turn->try + 1);
        if (meso_growth_is_step(turn))
            meso_growth_join(work, tip, turn);
    }
}

/* Whether there is room for one more element below the limits. */
static bool fits(MesoGrowthWork *work, const MesoGrowthTurn *turn)
{
    bool steps = meso_growth_is_step(turn), grows = steps || turn->outcome == MESO_GROWTH_PLACES;
    if (grows && !(work->element_count + turn->middle_count < work->element_limit))
        return stop_at(work, MESO_GROWTH_ELEMENTS);
    if (steps && work->length + turn->length > work->length_limit)
        return stop_at(work, MESO_GROWTH_LENGTH);
    return true;
}

/* ---- memory ---- */

static const MesoGrowthTurn *turn_at(const MesoGrowthWindow *window, uint32_t number, uint32_t end)
{
    return &window->turns[number < end ? number : end - 1];
}

/*
 * What turns have come to, which other threads may have done, comes from their memory while those before them are
 * admitted: the turns, from those where their pieces are, from these their cells, and from these the newest blocks.
 */
static void fetch_turns(const MesoGrowthWork *work, const MesoGrowthWindow *window, uint32_t number, uint32_t end)
{
    enum { TURNS = 16, PIECES = 10, HEADS = 6, BLOCKS = 3 };
    const char *turn = (const char *)turn_at(window, number + TURNS, end);
    for (uint32_t i = 0; i < MESO_GROWTH_TURN_LINES; i++)
        __builtin_prefetch(turn + i * MESO_GROWTH_TURN_LINE, 1);
    if (!work->uses_space)
        return;
    const MesoGrowthTurn *soon = turn_at(window, number + PIECES, end);
    const char *pieces = (const char *)(soon->batch->pieces + soon->piece_begin);
    if (soon->piece_count) {
        __builtin_prefetch(pieces);
        __builtin_prefetch(pieces + MESO_GROWTH_TURN_LINE);
    }
    soon = turn_at(window, number + HEADS, end);
    meso_growth_cells_fetch_heads(&work->space.cells, soon->batch->pieces + soon->piece_begin, soon->piece_count, true);
    soon = turn_at(window, number + BLOCKS, end);
    meso_growth_cells_fetch_newest(&work->space.cells, soon->batch->pieces + soon->piece_begin, soon->piece_count);
}

/* ---- what has grown, by number ---- */

/* The ball around all of a way: it stays within its length of where it begins. */
static bool add_ball(MesoGrowthWork *work, uint32_t active, double radius)
{
    if (!work->looks && !work->clears)
        return true;
    MesoFour center = work->tips[work->active[active]].foot.position;
    float ball[4] = {center[0], center[1], center[2], (float)(radius * 1.0001)};
    if (!meso_make_room((void **)&work->balls, &work->ball_room, (uint64_t)work->ball_count + 1, sizeof ball))
        return false;
    for (uint32_t i = 0; i < 4; i++)
        work->balls[4 * (size_t)work->ball_count + i] = ball[i];
    work->ball_count++;
    return true;
}

/* Turns that come later see it. */
static bool occupy(MesoGrowthWork *work, uint32_t active, const MesoGrowthTurn *turn)
{
    const MesoGrowthPiece *pieces = turn->batch->pieces + turn->piece_begin;
    MesoGrowthKin kin = turn->kin;
    kin.placed = turn->outcome == MESO_GROWTH_PLACES;
    kin.end = kin.placed ? kin.begin : kin.begin + (float)turn->length;
    mark_new(work, pieces, turn->piece_count);
    return meso_growth_space_add(&work->space, kin, pieces, turn->piece_count) && add_ball(work, active, turn->length);
}

/* Joints that are new: a step that does not go on from the joint that it has begins at one of its own. */
static uint32_t count_joints(const MesoGrowthTurn *turn)
{
    return meso_growth_is_step(turn) ? !turn->shares + turn->middle_count + 1 : 2;
}

static bool number_elements(MesoGrowthWork *work, uint32_t active, MesoGrowthTurn *turn, MesoGrowthRuleCount *counts)
{
    bool steps = meso_growth_is_step(turn);
    turn->joint_begin = work->joint_count;
    turn->element_begin = work->element_count;
    work->joint_count += count_joints(turn);
    work->element_count += steps ? turn->middle_count + 1 : 1;
    work->length += steps ? turn->length : 0;
    work->depth = turn->depth > work->depth ? turn->depth : work->depth;
    work->divided += turn->middle_count > 0;
    work->raised += turn->raise > 0;
    counts->steps += steps;
    counts->placed += !steps;
    if (work->uses_space && !occupy(work, active, turn))
        return fail_memory(work);
    turn->node = work->space.kin_count - 1;
    turn->piece = work->space.cells.piece_count - 1;
    return true;
}

/* Brings a turn up to date, and gives it numbers; false where growth stops before it. */
static bool admit(MesoGrowthWork *work, MesoGrowthWindow *window, uint32_t number)
{
    static MesoGrowthRuleCount none;
    MesoGrowthTurn *turn = &window->turns[number];
    if (work->uses_space && work->space.cells.piece_count > work->since)
        bring_up_to_date(work, window, number);
    if (turn->batch->failed || turn->batch->seen.failed)
        return fail_memory(work);
    if (turn->command.order == MESO_GROWTH_FAULT) {
        work->status = meso_fail(work->error, MESO_ERR_INPUT, "line %u: %s", turn->command.line, turn->command.fault);
        return false;
    }
    if (!fits(work, turn))
        return false;
    MesoGrowthRuleCount *counts = turn->rule == MESO_NO_INDEX ? &none : &work->rules[turn->rule];
    turn->branch_begin = work->branch_count;
    work->branch_count += turn->shoot_count;
    counts->branches += turn->shoot_count;
    counts->at_borders += turn->at_border;
    counts->refused += turn->outcome == MESO_GROWTH_REFUSED;
    return !(meso_growth_is_step(turn) || turn->outcome == MESO_GROWTH_PLACES) ||
           number_elements(work, window->begin + number, turn, counts);
}

void meso_growth_begin_window(MesoGrowthWork *work, MesoGrowthWindow *window)
{
    window->first_branch = work->branch_count;
    window->first_tip = work->tip_count;
    window->first_shoot = work->shoot_count;
    if (work->space.cells.piece_count > work->since)
        memset(work->grown_in, 0, sizeof work->grown_in);
    work->since = work->space.cells.piece_count;
    work->ball_count = 0;
}

uint32_t meso_growth_admit_range(MesoGrowthWork *work, MesoGrowthWindow *window, uint32_t begin, uint32_t end)
{
    uint32_t at = begin;
    do
        fetch_turns(work, window, at, end);
    while (admit(work, window, at) && ++at < end);
    return at;
}

void meso_growth_end_window(MesoGrowthWork *work, const MesoGrowthWindow *window)
{
    uint32_t begun = work->branch_count - window->first_branch;
    work->tip_count += begun;
    work->shoot_count += begun;
}

#define ROOM(array, room, count) \
    ((count) <= work->room || \
     (makes && meso_make_room((void **)&work->array, &work->room, count, sizeof *work->array)))

static bool have_rooms(MesoGrowthWork *work, uint32_t turns, uint32_t branches, uint32_t tips, bool makes)
{
    uint64_t joints = (uint64_t)work->joint_count + (uint64_t)turns * (MESO_GROWTH_SPANS + 1);
    uint64_t elements = (uint64_t)work->element_count + (uint64_t)turns * MESO_GROWTH_SPANS;
    uint64_t all_tips = (uint64_t)work->tip_count + tips;
    return ROOM(joints, joint_room, joints) && ROOM(points, point_room, joints) &&
               ROOM(elements, element_room, elements) &&
               ROOM(branches, branch_room, (uint64_t)work->branch_count + branches) &&
               ROOM(tips, tip_room, all_tips) && ROOM(ended, ended_room, all_tips) &&
               ROOM(registers, register_room, all_tips * work->grammar->local_count + 1) &&
               ROOM(shoots, shoot_room, (uint64_t)work->shoot_count + tips);
}

bool meso_growth_has_rooms(MesoGrowthWork *work, uint32_t turns, uint32_t branches, uint32_t tips)
{
    return have_rooms(work, turns, branches, tips, false);
}

bool meso_growth_make_rooms(MesoGrowthWork *work, uint32_t turns, uint32_t branches, uint32_t tips)
{
    return have_rooms(work, turns, branches, tips, true) || fail_memory(work);
}
