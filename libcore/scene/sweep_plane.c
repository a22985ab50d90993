#include "libcore/scene/sweep_plane.h"

#include <math.h>

#include "libcore/math/bezier.h"

/* To both sides, for differences: short against a bend, long against the rounding of directions. */
static const float CHANGE_STEP = 1.0f / 128;

/* Of the angle between directions: below it there is no plane to turn in. */
static const float LEAST_SINE = 1e-4f;

/*
 * X and Y span the plane across `tangent`. Where the up direction lies along
 * the tangent there is no such plane; any one across it will do.
 */
MesoSweepPlane meso_sweep_plane_across(MesoVec3 origin, MesoVec3 up, MesoVec3 tangent, float speed)
{
    MesoVec3 axis = fabsf(tangent.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 fallback = meso_vec3_unit(meso_vec3_cross(axis, tangent), axis);
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(up, tangent), fallback);
    return (MesoSweepPlane){origin, x, meso_vec3_cross(tangent, x), tangent, speed};
}

/* ---- mitres ---- */

static float speed_at(const MesoSweepInstance *sweep, float v)
{
    return meso_vec3_length(meso_bezier_derivative(sweep->p, v));
}

/* How long the trajectory is up to v, by three places of Gauss's. */
static float length_to(const MesoSweepInstance *sweep, float v)
{
    const float outer = 5.0f / 18, middle = 8.0f / 18;
    return v * (outer * speed_at(sweep, v * 0.11270167f) + middle * speed_at(sweep, v * 0.5f) +
                outer * speed_at(sweep, v * 0.88729833f));
}

/* From one direction to another, by a part of the angle between. */
static MesoVec3 turn_to(MesoVec3 from, MesoVec3 to, float part)
{
    float sine = meso_vec3_length(meso_vec3_cross(from, to)), angle = atan2f(sine, meso_vec3_dot(from, to));
    if (!(sine > LEAST_SINE))
        return meso_vec3_unit(meso_vec3_lerp(from, to, part), from);
    return meso_vec3_unit(meso_vec3_mad(meso_vec3_scale(from, sinf((1 - part) * angle)), sinf(part * angle), to), from);
}

/* Up to which part of the length E turns to p[3] - p[0], where it goes by way of that; 0: it does not. */
static float way_of(const MesoSweepInstance *sweep, MesoVec3 across)
{
    const MesoVec3 *ends = sweep->direction, *p = sweep->p;
    bool apart = meso_vec3_dot(ends[0], ends[1]) <= -0.5f;
    if (sweep->mitre < MESO_CREASED)
        return apart ? 0.5f : 0;
    if (!apart && meso_vec3_dot(across, ends[0]) >= 0 && meso_vec3_dot(across, ends[1]) >= 0)
        return 0;
    float start = meso_vec3_length(meso_vec3_sub(p[1], p[0])), end = meso_vec3_length(meso_vec3_sub(p[3], p[2]));
    return start + end > 0 ? fminf(fmaxf(start / (start + end), 0.1f), 0.9f) : 0.5f;
}

/* E. */
static MesoVec3 even_direction(const MesoSweepFrames *frames, float v)
{
    const MesoSweepInstance *sweep = frames->sweep;
    const MesoVec3 *ends = sweep->direction;
    MesoVec3 across = meso_vec3_unit(meso_vec3_sub(sweep->p[3], sweep->p[0]), ends[0]);
    float t = frames->length > 0 ? length_to(sweep, v) / frames->length : v, way = way_of(sweep, across);
    if (way == 0)
        return turn_to(ends[0], ends[1], t);
    return t < way ? turn_to(ends[0], across, t / way) : turn_to(across, ends[1], (t - way) / (1 - way));
}

/* u. */
static float eased(const MesoSweepFrames *frames, float v)
{
    float w = v * v * (3 - 2 * v);
    return frames->ease > 1 ? w * w * (3 - 2 * w) : v + frames->ease * (w - v);
}

/* T. */
static MesoVec3 ring_tangent(const MesoSweepFrames *frames, float v)
{
    const MesoSweepInstance *sweep = frames->sweep;
    float u = eased(frames, v);
    MesoVec3 end = sweep->direction[u > 0.5f], tangent = meso_vec3_unit(meso_bezier_derivative(sweep->p, u), end);
    if (frames->lean > 0)
        tangent = meso_vec3_unit(meso_vec3_lerp(tangent, even_direction(frames, u), frames->lean), tangent);
    return v == 0 || v == 1 ? end : tangent;
}

/* ---- frames that turn least ---- */

/* The mirror image of `a` in the plane across `axis`. */
static MesoVec3 reflect(MesoVec3 a, MesoVec3 axis)
{
    float square = meso_vec3_dot(axis, axis);
    return square > 0 ? meso_vec3_mad(a, -2 * meso_vec3_dot(axis, a) / square, axis) : a;
}

static MesoVec3 tangent_at(const MesoSweepInstance *sweep, float v)
{
    if (v == 0 || v == 1)
        return sweep->direction[v == 1];
    return meso_vec3_unit(meso_bezier_derivative(sweep->p, v), sweep->direction[v > 0.5f]);
}

/* Double reflection: in the plane between both points, then in the one that takes the tangent there. */
static MesoSweepStation step_along(const MesoSweepStation *from, const MesoSweepInstance *sweep, float v)
{
    MesoSweepStation to = {.point = meso_bezier_point(sweep->p, v), .tangent = tangent_at(sweep, v)};
    MesoVec3 between = meso_vec3_sub(to.point, from->point);
    MesoVec3 x = reflect(from->x, between), tangent = reflect(from->tangent, between);
    x = reflect(x, meso_vec3_sub(to.tangent, tangent));
    to.x = meso_vec3_unit(meso_vec3_mad(x, -meso_vec3_dot(x, to.tangent), to.tangent), from->x);
    return to;
}

/* The same where T is not the trajectory's: straight from one T to the next. */
static MesoSweepStation step_turned(const MesoSweepStation *from, const MesoSweepFrames *frames, float v)
{
    MesoSweepStation to = {.tangent = ring_tangent(frames, v)};
    MesoVec3 x = reflect(from->x, meso_vec3_add(from->tangent, to.tangent));
    to.x = meso_vec3_unit(meso_vec3_mad(x, -meso_vec3_dot(x, to.tangent), to.tangent), from->x);
    return to;
}

static MesoSweepStation step_to(const MesoSweepFrames *frames, const MesoSweepStation *from, float v)
{
    return frames->sweep->mitre < MESO_CREASED ? step_along(from, frames->sweep, v) : step_turned(from, frames, v);
}

static void make_stations(MesoSweepFrames *frames)
{
    const MesoSweepInstance *sweep = frames->sweep;
    MesoSweepPlane start = meso_sweep_plane_across(sweep->p[0], sweep->up[0], sweep->direction[0], 0);
    frames->stations[0] = (MesoSweepStation){start.origin, start.x, start.tangent};
    for (uint32_t i = 0; i < MESO_FRAME_STEPS; i++)
        frames->stations[i + 1] = step_to(frames, &frames->stations[i], (float)(i + 1) / MESO_FRAME_STEPS);
}

float meso_sweep_frames_twist(const MesoSweepFrames *frames)
{
    const MesoSweepInstance *sweep = frames->sweep;
    const MesoSweepStation *last = &frames->stations[MESO_FRAME_STEPS];
    MesoSweepPlane end = meso_sweep_plane_across(sweep->p[3], sweep->up[1], sweep->direction[1], 0);
    MesoVec3 y = meso_vec3_cross(last->tangent, last->x);
    return atan2f(meso_vec3_dot(end.x, y), meso_vec3_dot(end.x, last->x));
}

float meso_sweep_twist(const MesoSweepInstance *sweep)
{
    MesoSweepFrames frames = meso_sweep_frames(MESO_FRAME_MINIMAL, sweep);
    return meso_sweep_frames_twist(&frames);
}

static MesoVec3 least_turned_x(const MesoSweepFrames *frames, float v)
{
    uint32_t before = (uint32_t)(v * MESO_FRAME_STEPS);
    return step_to(frames, &frames->stations[before], v).x;
}

/* ---- planes along a trajectory ---- */

MesoSweepFrames meso_sweep_frames(MesoFrameRule rule, const MesoSweepInstance *sweep)
{
    bool creased = sweep->mitre >= MESO_CREASED;
    float k = floorf(sweep->mitre / MESO_CREASED);
    MesoSweepFrames frames = {.sweep = sweep, .rule = creased ? MESO_FRAME_MINIMAL : rule,
                              .lean = sweep->mitre - MESO_CREASED * k,
                              .ease = !creased ? 0 : k < MESO_CREASE_EASES ? exp2f(1 - k) : 2};
    if (sweep->mitre > 0)
        frames.length = length_to(sweep, 1);
    if (frames.rule == MESO_FRAME_MINIMAL)
        make_stations(&frames);
    return frames;
}

/* At the ends all comes from the ports alone: the neighbour computes the same floats. */
MesoSweepPlane meso_sweep_plane(const MesoSweepFrames *frames, float v)
{
    const MesoSweepInstance *sweep = frames->sweep;
    if (v == 0 || v == 1) {
        uint32_t end = v == 1;
        float speed = 3 * meso_vec3_length(meso_vec3_sub(sweep->p[end ? 3 : 1], sweep->p[end ? 2 : 0]));
        return meso_sweep_plane_across(sweep->p[end ? 3 : 0], sweep->up[end], sweep->direction[end], speed);
    }
    MesoVec3 derivative = meso_bezier_derivative(sweep->p, v), point = meso_bezier_point(sweep->p, v);
    MesoVec3 tangent = ring_tangent(frames, v);
    float speed = meso_vec3_length(derivative);
    if (frames->rule == MESO_FRAME_PAPER)
        return meso_sweep_plane_across(point, meso_vec3_lerp(sweep->up[0], sweep->up[1], v), tangent, speed);
    MesoVec3 x = least_turned_x(frames, v);
    if (sweep->mitre > 0)
        x = meso_vec3_unit(meso_vec3_mad(x, -meso_vec3_dot(x, tangent), tangent), x);
    return (MesoSweepPlane){point, x, meso_vec3_cross(tangent, x), tangent, speed};
}

MesoSweepBeside meso_sweep_beside(const MesoSweepFrames *frames, float v)
{
    float low = fmaxf(v - CHANGE_STEP, 0), high = fminf(v + CHANGE_STEP, 1);
    return (MesoSweepBeside){{low, high}, {meso_sweep_plane(frames, low), meso_sweep_plane(frames, high)}};
}

MesoSweepPlaneChange meso_sweep_plane_change(const MesoSweepFrames *frames, const MesoSweepBeside *beside, float v)
{
    const MesoSweepPlane *planes = beside->planes;
    float scale = 1 / (beside->v[1] - beside->v[0]);
    return (MesoSweepPlaneChange){meso_bezier_derivative(frames->sweep->p, v),
                                  meso_vec3_scale(meso_vec3_sub(planes[1].x, planes[0].x), scale),
                                  meso_vec3_scale(meso_vec3_sub(planes[1].y, planes[0].y), scale)};
}

/* How slow a ring is taken to be at least, in parts of the trajectory's speed: one that runs backwards has no b. */
static const float LEAST_AHEAD = 0.01f;

/* `turn` is by how much T changes within `wide`. */
static MesoVec2 bend_of(const MesoSweepFrames *frames, const MesoSweepPlane *plane, float v, MesoVec3 turn, float wide)
{
    float ahead = meso_vec3_dot(meso_bezier_derivative(frames->sweep->p, v), plane->tangent);
    float scale = 1 / (wide * fmaxf(ahead, LEAST_AHEAD * plane->speed));
    return (MesoVec2){scale * meso_vec3_dot(turn, plane->x), scale * meso_vec3_dot(turn, plane->y)};
}

MesoVec2 meso_sweep_bend(const MesoSweepFrames *frames, const MesoSweepPlane *plane, float v)
{
    if (frames->sweep->mitre < MESO_CREASED || v == 0 || v == 1)
        return (MesoVec2){0, 0};
    float low = fmaxf(v - CHANGE_STEP, 0), high = fminf(v + CHANGE_STEP, 1);
    MesoVec3 turn = meso_vec3_sub(ring_tangent(frames, high), ring_tangent(frames, low));
    return bend_of(frames, plane, v, turn, high - low);
}

MesoVec2 meso_sweep_bend_between(const MesoSweepFrames *frames, const MesoSweepPlane *plane,
                                 const MesoSweepBeside *beside, float v)
{
    MesoVec3 turn = meso_vec3_sub(beside->planes[1].tangent, beside->planes[0].tangent);
    return bend_of(frames, plane, v, turn, beside->v[1] - beside->v[0]);
}
