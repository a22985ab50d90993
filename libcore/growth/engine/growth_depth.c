/*
 * Curves that would go below the surface. Where the axis of an element lies deeper than a hundredth of its length, a
 * step whose shape is one all along is divided, with joints on the surface between, and what is still deeper is raised:
 * triangles are flat, but curves follow the smooth normals. Steps are divided no further than to where their shape, at
 * its width, would fold in the turns: at sharp edges it is raised over these instead.
 */
#include "libcore/growth/engine/growth_work.h"

enum { COARSE = 24, SAMPLES = 64 };

/* Of an element's length; below a hundredth, since what lies between the points, or beside the curve, counts too. */
static const float tolerance = 0.005f;

/* What is not deeper than this is raised at once. */
static const float shallow = 0.06f;

/* A point of the way. */
typedef struct Sample {
    MesoFour position;
    float along;
} Sample;

typedef struct Curve {
    MesoFour p[4], normals[2];
    float begin, end;           /* along the way */
} Curve;

static MesoFour point_of(const MesoGrowthGround *ground, uint32_t triangle, MesoComplex at)
{
    double weight[3];
    meso_growth_weigh(&ground->walk, triangle, at, weight);
    return meso_four_of(meso_growth_position(ground, triangle, weight));
}

static float length_of(const MesoGrowthPiece *piece)
{
    float x = (float)(piece->ends[1].re - piece->ends[0].re), y = (float)(piece->ends[1].im - piece->ends[0].im);
    return sqrtf(x * x + y * y);
}

static Sample sample_at(const MesoGrowthWork *work, const MesoGrowthPiece *piece, double share, float along)
{
    MesoComplex a = piece->ends[0], by = {piece->ends[1].re - a.re, piece->ends[1].im - a.im};
    MesoComplex at = {a.re + share * by.re, a.im + share * by.im};
    return (Sample){point_of(work->ground, piece->triangle, at), along + (float)share * length_of(piece)};
}

/* Ends of pieces, or of some, and points between. */
static uint32_t sample_finely(const MesoGrowthWork *work, const MesoGrowthTurn *turn, Sample samples[SAMPLES])
{
    const MesoGrowthPiece *pieces = turn->batch->pieces + turn->piece_begin;
    uint32_t count = 0, stride = turn->piece_count / SAMPLES + 1, parts = SAMPLES / turn->piece_count;
    float along = 0;
    for (uint32_t i = 0; i < turn->piece_count; i++) {
        for (uint32_t k = 1; i % stride == 0 && k <= parts + !parts && count < SAMPLES; k++)
            samples[count++] = sample_at(work, &pieces[i], (double)k / (parts + !parts), along);
        along += length_of(&pieces[i]);
    }
    return count;
}

/* A point of a piece that begins, or ends, at a tip: in the tip's triangle by its frame, which is at hand. */
static Sample sample_from(const MesoGrowthWork *work, const MesoGrowthPiece *piece, uint32_t triangle,
                          const MesoGrowthFooting *foot, uint32_t end, float share, float along)
{
    MesoComplex from = piece->ends[end], to = piece->ends[1 - end];
    if (piece->triangle != triangle)
        return sample_at(work, piece, end ? 1 - share : share, along);
    MesoFour p = meso_four_mad(foot->position, share * (float)(to.re - from.re), foot->x);
    return (Sample){meso_four_mad(p, share * (float)(to.im - from.im), foot->y),
                    along + (end ? 1 - share : share) * length_of(piece)};
}

/* The middles of the first piece and the last, and ends between: in their triangles' frames, where these are all. */
static uint32_t sample_coarsely(const MesoGrowthWork *work, const MesoGrowthTip *tip, const MesoGrowthTurn *turn,
                                Sample samples[COARSE])
{
    const MesoGrowthPiece *pieces = turn->batch->pieces + turn->piece_begin, *first = pieces;
    const MesoGrowthPiece *last = &pieces[turn->piece_count - 1];
    float along = length_of(first);
    uint32_t count = 0, stride = turn->piece_count / (COARSE - 3) + 1;
    samples[count++] = sample_from(work, first, tip->at.triangle, &tip->foot, 0, 0.5f, 0);
    if (turn->piece_count == 1)
        return count;
    samples[count++] = sample_from(work, first, tip->at.triangle, &tip->foot, 0, 1, 0);
    for (uint32_t i = 1; i + 1 < turn->piece_count; i++) {
        if (i % stride == 0)
            samples[count++] = sample_at(work, &pieces[i], 1, along);
        along += length_of(&pieces[i]);
    }
    samples[count++] = sample_from(work, last, turn->end.triangle, &turn->foot, 1, 0.5f, along);
    return count;
}

static Curve curve_between(const MesoGrowthSeat *from, const MesoGrowthSeat *to, float begin, float end)
{
    Curve curve = {.normals = {from->normal, to->normal}, .begin = begin, .end = end};
    meso_four_curve(curve.p, from->position, from->tangent, to->position, to->tangent);
    return curve;
}

static MesoFour curve_point(const Curve *curve, float t)
{
    float r = 1 - t;
    MesoFour p = meso_four_scale(curve->p[0], r * r * r);
    p = meso_four_mad(p, 3 * r * r * t, curve->p[1]);
    p = meso_four_mad(p, 3 * r * t * t, curve->p[2]);
    return meso_four_mad(p, t * t * t, curve->p[3]);
}

/* How deep a curve lies below those of the points that are beside it. */
static float depth_of(const Curve *curve, const Sample *samples, uint32_t count)
{
    float deepest = 0, length = curve->end - curve->begin;
    for (uint32_t i = 0; i < count; i++) {
        float t = length > 0 ? (samples[i].along - curve->begin) / length : 2;
        if (!(t > 0 && t < 1))
            continue;
        MesoFour normal = curve->normals[0] + (curve->normals[1] - curve->normals[0]) * meso_four_all(t);
        MesoFour up = samples[i].position - curve_point(curve, t);
        float square = meso_four_dot(normal, normal);
        float depth = square > 0.01f ? meso_four_dot(up, normal) / sqrtf(square) : 0;
        deepest = depth > deepest ? depth : deepest;
    }
    return deepest;
}

/* ---- joints between ---- */

/* Where the way is at a distance from its begin. */
static MesoTip tip_along(const MesoGrowthWork *work, const MesoGrowthTurn *turn, float along)
{
    const MesoGrowthPiece *pieces = turn->batch->pieces + turn->piece_begin, *piece = pieces;
    for (uint32_t i = 0; i + 1 < turn->piece_count && along > length_of(piece); i++)
        along -= length_of(piece++);
    MesoComplex a = piece->ends[0], by = {piece->ends[1].re - a.re, piece->ends[1].im - a.im};
    double length = length_of(piece), share = length > 0 ? fmin(along / length, 1) : 0;
    MesoTip tip = {.triangle = piece->triangle, .turned = piece->turned, .heading = meso_complex_unit(by)};
    meso_growth_weigh(&work->ground->walk, tip.triangle, (MesoComplex){a.re + share * by.re, a.im + share * by.im},
                      tip.weight);
    return tip;
}

static float mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

/*
 * Tangents of joints between lead from the joint before to the one behind. Across the smooth normals, which may be far
 * from those of triangles, they would cross the chords, and the curves would swing about these.
 */
static void straighten(MesoGrowthTurn *turn)
{
    MesoGrowthMiddle *middles = turn->batch->middles + turn->middle_begin;
    for (uint32_t i = 0; i < turn->middle_count; i++) {
        MesoGrowthSeat *joint = &middles[i].joint;
        MesoFour before = i == 0 ? turn->from.position : middles[i - 1].joint.position;
        MesoFour behind = i + 1 == turn->middle_count ? turn->to.position : middles[i + 1].joint.position;
        MesoFour along = behind - before;
        float square = meso_four_dot(along, along);
        MesoFour tangent = meso_four_scale(along, square > 0 ? 1 / sqrtf(square) : 0);
        MesoFour normal = meso_four_mad(joint->normal, -meso_four_dot(joint->normal, tangent), tangent);
        float size = meso_four_dot(normal, normal);
        if (!(square > 0 && size > 0.01f))
            continue;
        joint->tangent = tangent;
        joint->normal = meso_four_scale(normal, 1 / sqrtf(size));
    }
}

/* Joints of the way at equal distances, `count` of them. */
static bool make_middles(const MesoGrowthWork *work, MesoGrowthTurn *turn, float lift, float roll, uint32_t count)
{
    MesoGrowthBatch *batch = turn->batch;
    batch->middle_count = turn->middle_begin;
    if (!meso_make_room((void **)&batch->middles, &batch->middle_room, (uint64_t)batch->middle_count + count,
                        sizeof *batch->middles)) {
        batch->failed = true;
        return false;
    }
    for (uint32_t k = 1; k <= count; k++) {
        float t = (float)k / (float)(count + 1);
        MesoGrowthMiddle *middle = &batch->middles[batch->middle_count++];
        middle->at = tip_along(work, turn, t * (float)turn->length);
        middle->joint = meso_growth_joint_on(work->ground, &middle->at, mix(turn->from.width, turn->to.width, t),
                                             mix(lift, turn->lift, t), mix(roll, turn->roll, t));
    }
    turn->middle_count = count;
    straighten(turn);
    return true;
}

/* Of all spans, as a share of their length. */
static float depth_of_spans(const MesoGrowthTurn *turn, const Sample *samples, uint32_t count)
{
    const MesoGrowthMiddle *middles = turn->batch->middles + turn->middle_begin;
    uint32_t spans = turn->middle_count + 1;
    float length = (float)turn->length / (float)spans, deepest = 0;
    for (uint32_t i = 0; i < spans; i++) {
        const MesoGrowthSeat *from = i == 0 ? &turn->from : &middles[i - 1].joint;
        const MesoGrowthSeat *to = i + 1 == spans ? &turn->to : &middles[i].joint;
        Curve curve = curve_between(from, to, length * (float)i, length * (float)(i + 1));
        float depth = depth_of(&curve, samples, count) / length;
        deepest = depth > deepest ? depth : deepest;
    }
    return deepest;
}

/* Whether a curve turns about a point that a shape half as high as it is wide, on both sides, reaches. */
static bool is_tight(const Curve *curve, float width)
{
    MesoFour a = curve->p[1] - curve->p[0], b = curve->p[2] - curve->p[1], c = curve->p[3] - curve->p[2];
    for (int i = 0; i <= 4; i++) {
        float t = 0.25f * (float)i, r = 1 - t;
        MesoFour speed = meso_four_scale(a, r * r) + meso_four_scale(b, 2 * r * t) + meso_four_scale(c, t * t);
        MesoFour change = meso_four_scale(b - a, 2 * r) + meso_four_scale(c - b, 2 * t);
        MesoFour turn = meso_four_cross(speed, change);
        float square = meso_four_dot(speed, speed);
        if (0.5f * width * sqrtf(meso_four_dot(turn, turn)) >= square * sqrtf(square))
            return true;
    }
    return false;
}

static bool spans_are_tight(const MesoGrowthTurn *turn)
{
    const MesoGrowthMiddle *middles = turn->batch->middles + turn->middle_begin;
    bool tight = false;
    for (uint32_t i = 0; i <= turn->middle_count && !tight; i++) {
        const MesoGrowthSeat *from = i == 0 ? &turn->from : &middles[i - 1].joint;
        const MesoGrowthSeat *to = i == turn->middle_count ? &turn->to : &middles[i].joint;
        Curve curve = curve_between(from, to, 0, 1);
        tight = is_tight(&curve, from->width > to->width ? from->width : to->width);
    }
    return tight;
}

/* ---- turns ---- */

static void raise_joint(MesoGrowthSeat *joint, float by)
{
    joint->position = meso_four_mad(joint->position, by, joint->normal);
}

static void raise_all(const MesoGrowthTip *tip, MesoGrowthTurn *turn, float by)
{
    MesoGrowthMiddle *middles = turn->batch->middles + turn->middle_begin;
    turn->raise += by;
    if (turn->raise > tip->raise)
        raise_joint(&turn->from, fminf(by, turn->raise - tip->raise));
    for (uint32_t i = 0; i < turn->middle_count; i++)
        raise_joint(&middles[i].joint, by);
    raise_joint(&turn->to, by);
}

/* Raised, a curve may still be deep where only its other end was: so twice. */
static void bring_up(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn, bool divides,
                     float lift, float roll)
{
    Sample samples[SAMPLES];
    uint32_t count = sample_finely(work, turn, samples);
    turn->depth = depth_of_spans(turn, samples, count);
    for (uint32_t spans = 2; divides && turn->depth > tolerance && spans <= MESO_GROWTH_SPANS; spans *= 2) {
        if (!make_middles(work, turn, lift, roll, spans - 1))
            return;
        divides = !spans_are_tight(turn);
        if (!divides && !make_middles(work, turn, lift, roll, spans / 2 - 1))
            return;
        turn->depth = depth_of_spans(turn, samples, count);
    }
    for (int pass = 0; pass < 2 && turn->depth > tolerance; pass++) {
        raise_all(tip, turn, 1.25f * turn->depth * (float)turn->length / (float)(turn->middle_count + 1));
        turn->depth = depth_of_spans(turn, samples, count);
    }
}

void meso_growth_surface(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn, bool divides,
                         float lift, float roll)
{
    Sample samples[COARSE];
    turn->middle_begin = turn->batch->middle_count;
    turn->middle_count = 0;
    turn->raise = turn->depth = 0;
    float flat = meso_four_dot(tip->foot.normal, turn->foot.normal);
    if (turn->piece_count == 0 || (turn->piece_count == 1 && flat > 0.9998f))
        return;
    uint32_t count = sample_coarsely(work, tip, turn, samples);
    turn->depth = depth_of_spans(turn, samples, count);
    if (turn->depth > shallow)
        bring_up(work, tip, turn, divides, lift, roll);
    else if (turn->depth > tolerance) {
        raise_all(tip, turn, 1.5f * turn->depth * (float)turn->length);
        turn->depth = 0;
    }
}
