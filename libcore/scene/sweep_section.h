/* Sections along a sweep, each in the plane of its ring: blended, turned and creased, by the formulas of scene.h. */
#ifndef MESO_SWEEP_SECTION_H
#define MESO_SWEEP_SECTION_H

#include "libcore/scene/sweep_plane.h"

/* An angle, by its cosine and sine. */
typedef struct MesoSweepAngle {
    float c, s;
} MesoSweepAngle;

static inline MesoSweepAngle meso_sweep_angle(float angle)
{
    return angle == 0 ? (MesoSweepAngle){1, 0} : (MesoSweepAngle){cosf(angle), sinf(angle)};
}

static inline MesoVec2 meso_sweep_turned(MesoVec2 p, MesoSweepAngle angle)
{
    return (MesoVec2){angle.c * p.x - angle.s * p.y, angle.s * p.x + angle.c * p.y};
}

/* How far the columns of a kind lie from the trajectory at its ends, in units of the profiles. O(columns). */
typedef struct MesoKindReach {
    float start, end;
} MesoKindReach;
MesoKindReach meso_sweep_kind_reach(const MesoScene *scene, const MesoSweptKind *kind);

/* How far the sections of a sweep lie from its trajectory, whose kind reaches so far: section_scale R. */
static inline float meso_sweep_reach(const MesoScene *scene, const MesoSweepInstance *sweep, MesoKindReach reach)
{
    return scene->section_scale * fmaxf(sweep->size[0] * reach.start, sweep->size[1] * reach.end);
}

/* What the sections of one sweep share. */
typedef struct MesoSweepTrack {
    const MesoSweptKind *kind;
    const MesoSweepInstance *sweep;
    MesoSweepFrames frames;
    MesoSweepAngle back;    /* R(-turn) */
    MesoVec2 middle[2];     /* a', b' */
    float reach;            /* section_scale R, where there is a crease */
} MesoSweepTrack;

MesoSweepTrack meso_sweep_track(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep);

/* The section at v: how far it is blended, turned, and creased. */
typedef struct MesoSweepBlend {
    float v, w;
    bool turns;
    MesoSweepAngle turn, twist;
    MesoVec2 inwards;       /* the direction of b, */
    float kept;             /* and what is kept along it; 1: all */
} MesoSweepBlend;

/* Without a crease. */
static inline MesoSweepBlend meso_sweep_blend(const MesoSweepTrack *track, float v)
{
    MesoSweepBlend blend = {.v = v, .w = v * v * (3 - 2 * v), .kept = 1};
    blend.turns = (track->kind->turn != 0 || track->sweep->twist != 0) && v > 0 && v < 1;
    if (blend.turns) {
        blend.turn = meso_sweep_angle(track->kind->turn * blend.w);
        blend.twist = meso_sweep_angle(track->sweep->twist * blend.w);
    }
    return blend;
}

/* Gives it the crease of its sweep, which has one, whose ring bends by `bend`. */
void meso_sweep_crease(MesoSweepBlend *blend, const MesoSweepTrack *track, MesoVec2 bend);

/* A column at the ends of one sweep: a, b, and their normals, on a ring whose section turns or not. */
typedef struct MesoSweepLine {
    MesoVec2 start, end, start_normal, end_normal;
} MesoSweepLine;

static inline MesoSweepLine meso_sweep_line(const MesoSweepInstance *sweep, const MesoSweepColumn *column, bool turns)
{
    const float *size = sweep->size;
    bool own = turns && column->own;
    return (MesoSweepLine){meso_vec2_scale(column->start, size[0]), meso_vec2_scale(column->end, size[1]),
                           meso_vec2_scale(own ? column->own_normals[0] : column->start_normal, size[0]),
                           meso_vec2_scale(own ? column->own_normals[1] : column->end_normal, size[1])};
}

/* Where a section meets a column: s, n, and dot(n, s') without w', all without a crease. */
typedef struct MesoSweepMeeting {
    MesoVec2 at, normal;
    float slope;
} MesoSweepMeeting;

static inline MesoSweepMeeting meso_sweep_meet_straight(const MesoSweepBlend *blend, const MesoSweepLine *line)
{
    MesoVec2 start = line->start, end = line->end, change = meso_vec2_sub(end, start);
    MesoVec2 at = blend->v == 0 ? start : blend->v == 1 ? end : meso_vec2_lerp(start, end, blend->w);
    MesoVec2 n = meso_vec2_lerp(line->start_normal, line->end_normal, blend->w);
    return (MesoSweepMeeting){at, n, change.x * n.x + change.y * n.y};
}

MesoSweepMeeting meso_sweep_meet_turned(const MesoSweepTrack *track, const MesoSweepBlend *blend,
                                        const MesoSweepLine *line);

static inline MesoSweepMeeting meso_sweep_meet(const MesoSweepTrack *track, const MesoSweepBlend *blend,
                                               const MesoSweepLine *line)
{
    return blend->turns ? meso_sweep_meet_turned(track, blend, line) : meso_sweep_meet_straight(blend, line);
}

/* s alone. */
static inline MesoVec2 meso_sweep_place_on(const MesoSweepTrack *track, const MesoSweepBlend *blend, MesoVec2 start,
                                           MesoVec2 end)
{
    const MesoVec2 *middle = track->middle;
    if (!blend->turns)
        return blend->v == 0 ? start : blend->v == 1 ? end : meso_vec2_lerp(start, end, blend->w);
    MesoVec2 q0 = meso_vec2_sub(start, middle[0]);
    MesoVec2 q1 = meso_sweep_turned(meso_vec2_sub(end, middle[1]), track->back);
    MesoVec2 q = meso_sweep_turned(meso_vec2_lerp(q0, q1, blend->w), blend->turn);
    return meso_sweep_turned(meso_vec2_add(meso_vec2_lerp(middle[0], middle[1], blend->w), q), blend->twist);
}

static inline bool meso_sweep_is_creased_at(const MesoSweepBlend *blend, MesoVec2 s)
{
    return blend->kept != 1 && s.x * blend->inwards.x + s.y * blend->inwards.y > 0;
}

/* C(s). */
static inline MesoVec2 meso_sweep_creased(const MesoSweepBlend *blend, MesoVec2 s)
{
    MesoVec2 b = blend->inwards;
    if (!meso_sweep_is_creased_at(blend, s))
        return s;
    return meso_vec2_add(s, meso_vec2_scale(b, (blend->kept - 1) * (s.x * b.x + s.y * b.y)));
}

#endif
