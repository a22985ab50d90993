#include "libcore/growth/engine/growth_work.h"
#include "libcore/growth/language/grammar_draw.h"

/* Site of the draws of other ways. */
static const uint64_t retry_site = 0x72657472790a17e5u;

/* ---- walks and their pieces ---- */

void meso_growth_collect(void *context, const MesoWalkPiece *piece)
{
    MesoGrowthBatch *batch = context;
    if (piece->ends[0].re == piece->ends[1].re && piece->ends[0].im == piece->ends[1].im)
        return;
    if (!meso_make_room((void **)&batch->linked, &batch->linked_room, (uint64_t)batch->linked_count + 1,
                        sizeof *batch->linked)) {
        batch->failed = true;
        return;
    }
    uint32_t number = batch->linked_count++, last = batch->last[piece->walk];
    batch->linked[number] = (MesoGrowthLinkedPiece){
        {{piece->ends[0], piece->ends[1]}, piece->triangle, piece->turned}, MESO_NO_INDEX};
    if (last == MESO_NO_INDEX)
        batch->first[piece->walk] = number;
    else
        batch->linked[last].next = number;
    batch->last[piece->walk] = number;
    if (batch->space)
        __builtin_prefetch(&batch->space->cells.heads[piece->triangle]);
}

void meso_growth_keep_pieces(MesoGrowthBatch *batch, MesoGrowthTurn *turn, uint32_t walk)
{
    turn->batch = batch;
    turn->piece_begin = batch->piece_count;
    turn->piece_count = 0;
    for (uint32_t i = batch->first[walk]; i != MESO_NO_INDEX; i = batch->linked[i].next) {
        if (!meso_make_room((void **)&batch->pieces, &batch->piece_room, (uint64_t)batch->piece_count + 1,
                            sizeof *batch->pieces)) {
            batch->failed = true;
            return;
        }
        batch->pieces[batch->piece_count++] = batch->linked[i].piece;
        turn->piece_count++;
    }
}

void meso_growth_walk(const MesoGrowthWork *work, MesoGrowthBatch *batch, MesoWalk *walk, MesoGrowthTurn *turn)
{
    MesoWalkOptions options = {MESO_GROWTH_CROSSINGS, turn ? meso_growth_collect : NULL, batch};
    batch->linked_count = 0;
    batch->first[0] = batch->last[0] = MESO_NO_INDEX;
    work->march.walk(work->march.context, walk, 1, &options);
    if (turn)
        meso_growth_keep_pieces(batch, turn, 0);
}

double meso_growth_retry_angle(const MesoGrowthTip *tip, const MesoGrowthTurn *turn, uint32_t try)
{
    uint64_t key = meso_draw_key(tip->run.key, retry_site, (uint64_t)tip->walks << 32 | try);
    return (2 * meso_draw_share(key) - 1) * turn->command.values[MESO_GROWTH_RETRY_ANGLE];
}

static double angle_of_move(const MesoGrowthCommand *command)
{
    return command->values[MESO_GROWTH_ANGLE] + (command->values[MESO_GROWTH_AMOUNT] < 0 ? MESO_PI : 0);
}

void meso_growth_set_walk(MesoWalk *walk, const MesoGrowthTip *tip, const MesoGrowthTurn *turn, uint32_t try)
{
    const MesoGrowthCommand *command = &turn->command;
    double length = command->values[MESO_GROWTH_AMOUNT];
    double angle = command->order == MESO_GROWTH_STEP ? 0.5 * command->values[MESO_GROWTH_ANGLE] :
                   command->order == MESO_GROWTH_MOVE ? angle_of_move(command) : 0;
    if (try > 0)
        angle += meso_growth_retry_angle(tip, turn, try);
    walk->tip = tip->at;
    if (angle != 0)
        meso_tip_turn(&walk->tip, angle);
    walk->length = length > 0 ? length : command->order == MESO_GROWTH_MOVE ? -length : 0;
    walk->crossings = 0;
    walk->stop = MESO_WALK_DONE;
}

static double length_of(const MesoGrowthPiece *piece)
{
    return hypot(piece->ends[1].re - piece->ends[0].re, piece->ends[1].im - piece->ends[0].im);
}

/* ---- judging ---- */

bool meso_growth_collides(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                          const MesoGrowthTurn *turn, uint32_t since)
{
    const double *values = turn->command.values;
    const MesoGrowthPiece *pieces = turn->batch->pieces + turn->piece_begin;
    MesoGrowthAsker asker = meso_growth_asker(tip, since);
    if (values[MESO_GROWTH_CROSS] == 0 && meso_growth_meets(&work->space, &asker, pieces, turn->piece_count, NULL))
        return true;
    return values[MESO_GROWTH_CLEAR] > 0 &&
           !meso_growth_is_clear(&work->space, &batch->seen, &asker, pieces, turn->piece_count,
                                 values[MESO_GROWTH_CLEAR], false);
}

static bool may_be(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                   const double *registers, MesoGrowthTurn *turn, const MesoWalk *walk)
{
    if (walk->stop != MESO_WALK_DONE)
        turn->at_border = walk->stop == MESO_WALK_BORDER;
    if (walk->stop != MESO_WALK_DONE || !(turn->command.values[MESO_GROWTH_AMOUNT] > 0))
        return false;
    if (turn->command.condition != MESO_NO_INDEX && !meso_growth_holds(work, batch, tip, registers, turn))
        return false;
    return !work->uses_space || !meso_growth_collides(work, batch, tip, turn, 0);
}

static void end_step(MesoGrowthTurn *turn, const MesoWalk *walk)
{
    double angle = turn->command.values[MESO_GROWTH_ANGLE];
    turn->end = walk->tip;
    if (angle != 0)
        meso_tip_turn(&turn->end, 0.5 * angle);
}

/* Cuts the way at the strand that it meets first. False where it does not get away from where it begins. */
static bool cut_at(const MesoGrowthWork *work, MesoGrowthBatch *batch, MesoGrowthTurn *turn,
                   const MesoGrowthMeeting *meeting)
{
    MesoGrowthPiece *pieces = batch->pieces + turn->piece_begin, *last = &pieces[meeting->piece];
    MesoComplex heading = meso_complex_unit((MesoComplex){last->ends[1].re - last->ends[0].re,
                                                          last->ends[1].im - last->ends[0].im});
    turn->length = meeting->along;
    for (uint32_t i = 0; i < meeting->piece; i++)
        turn->length += length_of(&pieces[i]);
    last->ends[1] = meeting->at;
    turn->piece_count = meeting->piece + 1;
    turn->end = (MesoTip){.triangle = last->triangle, .turned = last->turned, .heading = heading};
    meso_growth_weigh(&work->ground->walk, last->triangle, meeting->at, turn->end.weight);
    return turn->length > 1e-6 * turn->command.values[MESO_GROWTH_AMOUNT];
}

/* To the strand that a step has met, or come too near to: farther on, by the distance that it must be clear. */
static bool joins(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                  const double *registers, MesoGrowthTurn *turn)
{
    MesoWalk walk;
    MesoGrowthAsker asker = meso_growth_asker(tip, 0);
    MesoGrowthMeeting meeting;
    meso_growth_set_walk(&walk, tip, turn, 0);
    if (!(walk.length > 0))
        return false;
    walk.length += fmax(turn->command.values[MESO_GROWTH_CLEAR], 0);
    turn->try = 0;
    meso_growth_walk(work, batch, &walk, turn);
    return meso_growth_meets(&work->space, &asker, batch->pieces + turn->piece_begin, turn->piece_count, &meeting) &&
           cut_at(work, batch, turn, &meeting) &&
           (turn->command.condition == MESO_NO_INDEX || meso_growth_holds(work, batch, tip, registers, turn));
}

/* Whether a step has a try of that number. */
static bool has_try(const MesoGrowthTurn *turn, uint32_t try)
{
    return try <= fmin(turn->command.values[MESO_GROWTH_RETRIES], 1 << 16);
}

/* No try is left, and `try` would be the next. */
static void give_up(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                    const double *registers, MesoGrowthTurn *turn, uint32_t try)
{
    turn->outcome = turn->command.join && work->uses_space && joins(work, batch, tip, registers, turn)
                        ? MESO_GROWTH_JOINS : MESO_GROWTH_REFUSED;
    turn->try = try;
}

static bool judge_step(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                       const double *registers, MesoGrowthTurn *turn, const MesoWalk *walk, uint32_t try)
{
    turn->try = try;
    if (may_be(work, batch, tip, registers, turn, walk)) {
        turn->outcome = MESO_GROWTH_STEPS;
        end_step(turn, walk);
        return true;
    }
    if (has_try(turn, try + 1))
        return false;
    give_up(work, batch, tip, registers, turn, try + 1);
    return true;
}

static void measure_step(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn)
{
    const double *values = turn->command.values;
    turn->length = values[MESO_GROWTH_AMOUNT] > 0 ? values[MESO_GROWTH_AMOUNT] : 0;
    if (work->looks || work->clears)
        meso_growth_depends(turn, meso_four_vec3(tip->foot.position),
                            turn->length + 2 * fmax(values[MESO_GROWTH_CLEAR], 0));
}

static void judge_move(MesoGrowthTurn *turn, const MesoWalk *walk)
{
    double angle = angle_of_move(&turn->command);
    turn->outcome = MESO_GROWTH_MOVES;
    turn->end = walk->tip;
    turn->length = fabs(turn->command.values[MESO_GROWTH_AMOUNT]) - walk->length;
    turn->at_border = walk->stop == MESO_WALK_BORDER;
    if (angle != 0)
        meso_tip_turn(&turn->end, -angle);
}

static void judge_place(MesoGrowthTurn *turn, const MesoWalk *walk)
{
    turn->length = turn->command.values[MESO_GROWTH_AMOUNT];
    turn->outcome = turn->length > 0 ? MESO_GROWTH_PLACES : MESO_GROWTH_NOTHING;
    turn->end = walk->tip;
    turn->rest = walk->length;
}

bool meso_growth_judge(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                       const double *registers, MesoGrowthTurn *turn, const MesoWalk *walk, uint32_t try)
{
    if (turn->command.order == MESO_GROWTH_STEP) {
        if (try == 0)
            measure_step(work, tip, turn);
        return judge_step(work, batch, tip, registers, turn, walk, try);
    }
    turn->try = 0;
    if (turn->command.order == MESO_GROWTH_MOVE)
        judge_move(turn, walk);
    else
        judge_place(turn, walk);
    return true;
}

void meso_growth_judge_again(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                             const double *registers, MesoGrowthTurn *turn, uint32_t try)
{
    turn->length = fmax(turn->command.values[MESO_GROWTH_AMOUNT], 0);
    for (bool judged = false; !judged; try++) {
        if (!has_try(turn, try)) {
            give_up(work, batch, tip, registers, turn, try);
            return;
        }
        MesoWalk walk;
        meso_growth_set_walk(&walk, tip, turn, try);
        meso_growth_walk(work, batch, &walk, turn);
        judged = judge_step(work, batch, tip, registers, turn, &walk, try);
    }
}
