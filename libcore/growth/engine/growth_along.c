/*
 * Conditions that hold all along steps. The way of a step is straight, and its curve is beside it, where the joints'
 * tangents are turned from it: where images are asked, by less than a pixel, or it is asked along the curve.
 */
#include <string.h>

#include "libcore/growth/engine/growth_work.h"
#include "libcore/growth/language/grammar_operation.h"

/* Of a step at least, and of a piece of it or a curve at most. */
enum { PLACES = 8, MOST_PLACES = 10000 };

/* Of pixels: curves that are not farther from the way need not be asked. */
static const double beside = 0.25;

typedef struct Along {
    const MesoGrowthWork *work;
    MesoGrowthBatch *batch;
    const MesoGrowthTip *tip;
    MesoGrowthTurn *turn;
    double registers[MESO_GRAMMAR_REGISTERS];
} Along;

static bool holds_at(Along *along, const MesoTip *at, double length)
{
    const MesoGrowthGround *ground = along->work->ground;
    double state[MESO_STATE_COUNT];
    memcpy(state, along->tip->state, sizeof state);
    MesoVec3 position = meso_growth_position(ground, at->triangle, at->weight);
    state[MESO_STATE_LENGTH] += length;
    state[MESO_STATE_X] = position.x;
    state[MESO_STATE_Y] = position.y;
    state[MESO_STATE_Z] = position.z;
    MesoGrowthAsking asking = {along->work, along->batch, along->tip, along->turn, at};
    const MesoGrowthHost host = {.context = &asking, .state = state, .look = meso_growth_look};
    return meso_growth_value(along->work->grammar, &along->tip->run, along->turn->command.condition, along->registers,
                             &host) != 0;
}

/* ---- ways ---- */

static double length_of(const MesoGrowthPiece *piece)
{
    return hypot(piece->ends[1].re - piece->ends[0].re, piece->ends[1].im - piece->ends[0].im);
}

/* Pixels of the images that the condition reads, along a piece: of the image that has most. */
static double pixels_along(const Along *along, const MesoGrowthPiece *piece)
{
    const MesoGrammarInstruction *code = along->work->grammar->code + along->turn->command.condition;
    const MesoGrowthContexts *contexts = along->work->options->contexts;
    double from[3], to[3], most = 0;
    meso_growth_weigh(&along->work->ground->walk, piece->triangle, piece->ends[0], from);
    meso_growth_weigh(&along->work->ground->walk, piece->triangle, piece->ends[1], to);
    for (; code->operation != MESO_OP_RESULT; code++)
        if (code->operation == MESO_OP_LOOK && code->more < contexts->map_count)
            most = fmax(most, meso_map_pixels(&contexts->maps[code->more], piece->triangle, from, to));
    return most;
}

static bool holds_on(Along *along, const MesoGrowthPiece *piece, double first, double count, double length)
{
    MesoComplex from = piece->ends[0], by = {piece->ends[1].re - from.re, piece->ends[1].im - from.im};
    MesoTip at = {.triangle = piece->triangle, .turned = piece->turned, .heading = meso_complex_unit(by)};
    double size = length_of(piece);
    for (double k = first; k <= count; k++) {
        MesoComplex point = {from.re + k / count * by.re, from.im + k / count * by.im};
        meso_growth_weigh(&along->work->ground->walk, at.triangle, point, at.weight);
        if (!holds_at(along, &at, length + size * k / count))
            return false;
    }
    return true;
}

/* ---- curves ---- */

/* A point of a curve over a way of length 1 along x, whose ends turn from it by these angles; as bend.h has it. */
static MesoComplex curve_point(double begin, double end, double t)
{
    double a = 2.0 / (3 * (1 + fmax(cos(begin), 0))), b = 2.0 / (3 * (1 + fmax(cos(end), 0))), r = 1 - t;
    double first = 3 * r * r * t, second = 3 * r * t * t;
    return (MesoComplex){first * a * cos(begin) + second * (1 - b * cos(end)) + t * t * t,
                         first * a * sin(begin) - second * b * sin(end)};
}

/* How far a curve comes from a way of length 1, at most. */
static double curve_height(double begin, double end)
{
    return 0.3 * (fabs(sin(begin)) / (1 + fmax(cos(begin), 0)) + fabs(sin(end)) / (1 + fmax(cos(end), 0)));
}

/* Of a curve over the way that begins at a tip. `pixels` lie along a unit of it. */
static bool holds_on_curve(Along *along, const MesoTip *tip, const MesoGrowthBow *bow, double pixels)
{
    const MesoWalkOptions options = {.crossing_limit = MESO_GROWTH_CROSSINGS};
    double length = (double)bow->length, begin = (double)bow->begin, end = (double)bow->end;
    if (curve_height(begin, end) * length * pixels <= beside)
        return true;
    double count = fmin(fmax(ceil(1.5 * length * pixels), PLACES), MOST_PLACES);
    for (double k = 1; k < count; k++) {
        MesoComplex point = curve_point(begin, end, k / count);
        MesoWalk walk = {.tip = *tip, .length = length * hypot(point.re, point.im)};
        meso_tip_turn(&walk.tip, atan2(point.im, point.re));
        meso_walks(&along->work->ground->walk, &walk, 1, &options);
        if (walk.stop != MESO_WALK_DONE || !holds_at(along, &walk.tip, length * k / count))
            return false;
    }
    return true;
}

/* By how much a branch has turned since its last step ended, to the left. */
static double turned_since(const MesoGrowthTip *tip)
{
    const MesoGrowthFooting *foot = &tip->foot;
    MesoComplex came = {(double)meso_four_dot(tip->arrive, foot->x), (double)meso_four_dot(tip->arrive, foot->y)};
    MesoComplex goes = tip->at.heading;
    double angle = atan2(came.re * goes.im - came.im * goes.re, came.re * goes.re + came.im * goes.im);
    return tip->at.turned ? -angle : angle;
}

static double within_half_turn(double angle)
{
    return angle - 2 * MESO_PI * round(angle / (2 * MESO_PI));
}

static bool hold_curves(Along *along, double length, double pixels)
{
    const MesoGrowthTip *tip = along->tip;
    MesoGrowthTurn *turn = along->turn;
    double angle = turn->command.values[MESO_GROWTH_ANGLE];
    double retry = turn->try > 0 ? meso_growth_retry_angle(tip, turn, turn->try) : 0;
    bool goes_on = tip->joint != MESO_NO_INDEX;
    double turns = goes_on ? within_half_turn(turned_since(tip) + retry) : 0;
    turn->bow = (MesoGrowthBow){(float)length, (float)(-0.5 * angle - 0.5 * turns), (float)(0.5 * angle)};
    MesoWalk begin;
    meso_growth_set_walk(&begin, tip, turn, turn->try);
    if (!holds_on_curve(along, &begin.tip, &turn->bow, pixels))
        return false;
    if (!goes_on || tip->bow.length == 0)
        return true;
    /* the last one, seen from its end */
    MesoGrowthBow last = {tip->bow.length, tip->bow.end + (float)(0.5 * turns), tip->bow.begin};
    MesoTip back = tip->at;
    meso_tip_turn(&back, -turned_since(tip) - (double)tip->bow.end + MESO_PI);
    return holds_on_curve(along, &back, &last, pixels);
}

bool meso_growth_holds(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                       const double *registers, MesoGrowthTurn *turn)
{
    Along along = {work, batch, tip, turn, {0}};
    double length = 0, all = 0, interval = turn->command.values[MESO_GROWTH_AMOUNT] / PLACES;
    memcpy(along.registers, registers, work->grammar->local_count * sizeof *registers);
    for (uint32_t i = 0; i < turn->piece_count; i++) {
        MesoGrowthPiece piece = batch->pieces[turn->piece_begin + i];
        double size = length_of(&piece), pixels = pixels_along(&along, &piece);
        double count = fmin(fmax(ceil(fmax(size / interval, pixels)), 1), MOST_PLACES);
        if (!holds_on(&along, &piece, i == 0 ? 0 : 1, count, length))
            return false;
        length += size;
        all += pixels;
    }
    return !(all > 0 && length > 0) || hold_curves(&along, length, all / length);
}
