/* Eight spans at once, a lane each: curves, frames of rings, and vertices, by the formulas of bend.h. */
#ifndef MESO_BEND_KERNEL_H
#define MESO_BEND_KERNEL_H

#include <string.h>

#include "libcore/growth/shape/joint.h"
#include "libcore/growth/shape/terminal_shape.h"
#include "libcore/math/four.h"
#include "libcore/math/lanes.h"

/* Lengths below it have no direction. */
#define MESO_BEND_LEAST 1e-17f

typedef struct MesoBendEnd {
    MesoLanes3 tangent, normal;
} MesoBendEnd;

typedef struct MesoBendLanes {
    MesoLanes3 p[4];
    MesoLanes w[4];
    MesoBendEnd end[2];
} MesoBendLanes;

/* The frame at one t, and its changes with t. */
typedef struct MesoBendRing {
    MesoLanes3 origin, tangent, left, normal;
    MesoLanes width, widening;
    MesoLanes speed;                     /* |B'| */
    MesoLanes turn, pitch, twist;        /* about the normal, the left and the tangent */
} MesoBendRing;

/* 1 / sqrt(square), and 0 where that is too small. */
MESO_LANES_INLINE MesoLanes meso_bend_inverse_root(MesoLanes square)
{
    MesoLaneBits has = square > MESO_BEND_LEAST * MESO_BEND_LEAST;
    MesoLanes root = meso_lanes_root(meso_lanes_choose(has, square, meso_lanes_all(1)));
    return (MesoLanes)((MesoLaneBits)(1 / root) & has);
}

/* Distance of an inner control point from its end, along the tangent. */
MESO_LANES_INLINE MesoLanes meso_bend_reach(MesoLanes3 tangent, MesoLanes3 chord, MesoLanes length, MesoLanes inverse)
{
    MesoLanes cosine = meso_lanes3_dot(tangent, chord) * inverse;
    return length * (2.0f / 3) / (1 + meso_lanes_most(cosine, meso_lanes_all(0)));
}

MESO_LANES_INLINE void meso_bend_set(MesoLanes3 *a, uint32_t lane, MesoVec3 value)
{
    a->x[lane] = value.x;
    a->y[lane] = value.y;
    a->z[lane] = value.z;
}

/* Of the joints at one end: the control point, the width there, and what the frame needs. */
MESO_LANES_INLINE void meso_bend_load_end(MesoBendLanes *lanes, const MesoJoint *const joints[MESO_LANES], uint32_t end,
                                          MesoLanes *flare)
{
    for (uint32_t lane = 0; lane < MESO_LANES; lane++) {
        const MesoJoint *joint = joints[lane];
        meso_bend_set(&lanes->p[3 * end], lane, joint->position);
        meso_bend_set(&lanes->end[end].tangent, lane, joint->tangent);
        meso_bend_set(&lanes->end[end].normal, lane, joint->normal);
        lanes->w[3 * end][lane] = joint->width;
        (*flare)[lane] = joint->flare;
    }
}

MESO_LANES_INLINE void meso_bend_load(MesoBendLanes *lanes, const MesoJoint *const from[MESO_LANES],
                                      const MesoJoint *const to[MESO_LANES])
{
    MesoLanes flare[2], zero = meso_lanes_all(0);
    meso_bend_load_end(lanes, from, 0, &flare[0]);
    meso_bend_load_end(lanes, to, 1, &flare[1]);
    MesoLanes3 chord = meso_lanes3_sub(lanes->p[3], lanes->p[0]);
    MesoLanes square = meso_lanes3_dot(chord, chord), inverse = meso_bend_inverse_root(square);
    MesoLanes length = square * inverse;
    MesoLanes first = meso_bend_reach(lanes->end[0].tangent, chord, length, inverse);
    MesoLanes last = meso_bend_reach(lanes->end[1].tangent, chord, length, inverse);
    lanes->p[1] = meso_lanes3_mad(lanes->p[0], first, lanes->end[0].tangent);
    lanes->p[2] = meso_lanes3_mad(lanes->p[3], -last, lanes->end[1].tangent);
    lanes->w[1] = meso_lanes_most(lanes->w[0] + first * flare[0], zero);
    lanes->w[2] = meso_lanes_most(lanes->w[3] - last * flare[1], zero);
}

/* ---- frames ---- */

/* A joint's normal, turned with the tangent to where it is T; and the part to the left of its change. */
typedef struct MesoBendTurned {
    MesoLanes3 normal;
    MesoLanes factor, factor_change;
} MesoBendTurned;

/*
 * The shortest turn from the joint's tangent T0 to T takes N0 to N0 - k (T0 + T), k = N0.T / (1 + T0.T). Where T is
 * opposite to T0 there is no shortest way, and k is kept small.
 */
MESO_LANES_INLINE MesoBendTurned meso_bend_turned(const MesoBendEnd *end, MesoLanes3 tangent, MesoLanes3 change)
{
    MesoLanes sum = 1 + meso_lanes3_dot(end->tangent, tangent);
    MesoLanes inverse = 1 / meso_lanes_most(sum, meso_lanes_all(1e-6f));
    MesoLanes k = meso_lanes3_dot(end->normal, tangent) * inverse;
    MesoLanes k_change = (meso_lanes3_dot(end->normal, change) - k * meso_lanes3_dot(end->tangent, change)) * inverse;
    MesoLanes3 normal = meso_lanes3_mad(end->normal, -k, meso_lanes3_add(end->tangent, tangent));
    return (MesoBendTurned){normal, k, k_change};
}

MESO_LANES_INLINE MesoLanes meso_bend_turned_left(const MesoBendEnd *end, const MesoBendTurned *turned,
                                                  MesoLanes3 left, MesoLanes turn)
{
    return -(turned->factor_change * meso_lanes3_dot(end->tangent, left)) - turned->factor * turn;
}

/* Between the joints: N, L and the twist. Opposite normals meet on the left. */
MESO_LANES_INLINE void meso_bend_orient(MesoBendRing *ring, const MesoBendLanes *lanes, float t, MesoLanes3 change)
{
    float s = t * t * (3 - 2 * t), s_change = 6 * t * (1 - t);
    MesoBendTurned a = meso_bend_turned(&lanes->end[0], ring->tangent, change);
    MesoBendTurned b = meso_bend_turned(&lanes->end[1], ring->tangent, change);
    MesoLanes3 apart = meso_lanes3_sub(b.normal, a.normal);
    MesoLanes3 sum = meso_lanes3_mad(a.normal, meso_lanes_all(s), apart);
    MesoLaneBits meets = meso_lanes3_dot(sum, sum) > 1e-8f;
    sum = meso_lanes3_choose(meets, sum, meso_lanes3_cross(a.normal, ring->tangent));
    MesoLanes inverse = meso_bend_inverse_root(meso_lanes3_dot(sum, sum));
    ring->normal = meso_lanes3_scale(sum, inverse);
    ring->left = meso_lanes3_cross(ring->normal, ring->tangent);
    ring->turn = meso_lanes3_dot(change, ring->left);
    MesoLanes to_left = s_change * meso_lanes3_dot(apart, ring->left);
    to_left += (1 - s) * meso_bend_turned_left(&lanes->end[0], &a, ring->left, ring->turn);
    to_left += s * meso_bend_turned_left(&lanes->end[1], &b, ring->left, ring->turn);
    ring->twist = (MesoLanes)((MesoLaneBits)(-(to_left * inverse)) & meets);
}

/* b[0] a[0] + ... + b[3] a[3] */
MESO_LANES_INLINE MesoLanes meso_bend_sum(const float b[4], MesoLanes a0, MesoLanes a1, MesoLanes a2, MesoLanes a3)
{
    return (b[0] * a0 + b[1] * a1) + (b[2] * a2 + b[3] * a3);
}

MESO_LANES_INLINE MesoLanes3 meso_bend_sum3(const float b[4], const MesoLanes3 p[4])
{
    return (MesoLanes3){meso_bend_sum(b, p[0].x, p[1].x, p[2].x, p[3].x),
                       meso_bend_sum(b, p[0].y, p[1].y, p[2].y, p[3].y),
                       meso_bend_sum(b, p[0].z, p[1].z, p[2].z, p[3].z)};
}

/* At t of 0 and 1 origin, frame and width come from the joint alone: what shares it computes the same floats. */
MESO_LANES_INLINE void meso_bend_ring(MesoBendRing *ring, const MesoBendLanes *lanes, float t)
{
    float r = 1 - t;
    const float value[4] = {r * r * r, 3 * r * r * t, 3 * r * t * t, t * t * t};
    const float first[4] = {-3 * r * r, 3 * r * (r - 2 * t), 3 * t * (2 * r - t), 3 * t * t};
    const float second[4] = {6 * r, 6 * (t - 2 * r), 6 * (r - 2 * t), 6 * t};
    bool at_end = t == 0 || t == 1;
    const MesoBendEnd *end = &lanes->end[t > 0.5f];

    MesoLanes3 velocity = meso_bend_sum3(first, lanes->p), acceleration = meso_bend_sum3(second, lanes->p);
    MesoLanes square = meso_lanes3_dot(velocity, velocity), inverse = meso_bend_inverse_root(square);
    ring->speed = square * inverse;
    MesoLaneBits moves = at_end ? (MesoLaneBits){0} : inverse > 0;
    ring->tangent = meso_lanes3_choose(moves, meso_lanes3_scale(velocity, inverse), end->tangent);
    MesoLanes along = meso_lanes3_dot(acceleration, ring->tangent);
    MesoLanes3 change = meso_lanes3_scale(meso_lanes3_mad(acceleration, -along, ring->tangent), inverse);
    ring->widening = meso_bend_sum(first, lanes->w[0], lanes->w[1], lanes->w[2], lanes->w[3]);
    if (at_end) {
        ring->origin = lanes->p[t == 1 ? 3 : 0];
        ring->width = lanes->w[t == 1 ? 3 : 0];
        ring->normal = end->normal;
        ring->left = meso_lanes3_cross(ring->normal, ring->tangent);
        ring->turn = meso_lanes3_dot(change, ring->left);
        ring->twist = meso_lanes_all(0);
    } else {
        ring->origin = meso_bend_sum3(value, lanes->p);
        ring->width = meso_bend_sum(value, lanes->w[0], lanes->w[1], lanes->w[2], lanes->w[3]);
        meso_bend_orient(ring, lanes, t, change);
    }
    ring->pitch = -meso_lanes3_dot(change, ring->normal);
}

/* ---- vertices ---- */

/* What one ring's vertices have in common. */
typedef struct MesoBendRow {
    MesoBendRing ring;
    MesoLanes3 left, normal;     /* times the width */
    MesoLanes pitch, turn, twist;
    MesoLanes least;             /* that a length along becomes: where shapes fold, normals are still to be had */
    MesoLanes width;             /* not 0: so are they at points */
} MesoBendRow;

MESO_LANES_INLINE void meso_bend_row(MesoBendRow *row, const MesoBendLanes *lanes, float t)
{
    meso_bend_ring(&row->ring, lanes, t);
    MesoLanes width = row->ring.width;
    row->left = meso_lanes3_scale(row->ring.left, width);
    row->normal = meso_lanes3_scale(row->ring.normal, width);
    row->pitch = width * row->ring.pitch;
    row->turn = width * row->ring.turn;
    row->twist = width * row->ring.twist;
    row->least = meso_lanes_most(1e-3f * row->ring.speed, meso_lanes_all(MESO_BEND_LEAST));
    row->width = meso_lanes_most(meso_lanes_most(width, 1e-6f * row->ring.speed), meso_lanes_all(MESO_BEND_LEAST));
}

MESO_LANES_INLINE MesoLanes3 meso_bend_in_frame(const MesoBendRing *ring, MesoLanes along, MesoLanes left, MesoLanes up)
{
    MesoLanes3 flat = meso_lanes3_mad(meso_lanes3_scale(ring->tangent, along), left, ring->left);
    return meso_lanes3_mad(flat, up, ring->normal);
}

/*
 * In the frame, the columns of the map's derivative are (g, a, b), (0, w, 0) and (0, 0, w), where
 * g = |B'| + pitch z - turn y, a = w' y - twist z, b = w' z + twist y, with the turns times w. Its cofactors take
 * (nx, ny, nz) to (w nx - a ny - b nz, g ny, g nz), as far as lengths do not matter.
 */
MESO_LANES_INLINE MesoLanes3 meso_bend_normal(const MesoBendRow *row, MesoVec3 p, MesoVec3 n, MesoLanes g)
{
    MesoLanes a = row->ring.widening * p.y - row->twist * p.z, b = row->ring.widening * p.z + row->twist * p.y;
    MesoLanes along = (row->width * n.x - a * n.y) - b * n.z, stretch = meso_lanes_most(g, row->least);
    MesoLanes left = stretch * n.y, up = stretch * n.z;
    MesoLanes inverse = 1 / meso_lanes_root(along * along + (left * left + up * up));
    return meso_bend_in_frame(&row->ring, along * inverse, left * inverse, up * inverse);
}

/* A lane to each; the bytes behind a vertex are the next's, which is written then, but for the `last`. */
MESO_FOUR void meso_bend_store_four(MesoVec3 *const out[4], uint32_t v, MesoFour x, MesoFour y, MesoFour z, bool last)
{
    MesoFour xy_low = MESO_FOUR_SHUFFLE(x, y, 0, 4, 1, 5), xy_high = MESO_FOUR_SHUFFLE(x, y, 2, 6, 3, 7);
    MesoFour z_low = MESO_FOUR_SHUFFLE(z, z, 0, 4, 1, 5), z_high = MESO_FOUR_SHUFFLE(z, z, 2, 6, 3, 7);
    MesoFour a = MESO_FOUR_SHUFFLE(xy_low, z_low, 0, 1, 4, 5), b = MESO_FOUR_SHUFFLE(xy_low, z_low, 2, 3, 6, 7);
    MesoFour c = MESO_FOUR_SHUFFLE(xy_high, z_high, 0, 1, 4, 5), d = MESO_FOUR_SHUFFLE(xy_high, z_high, 2, 3, 6, 7);
    if (last) {
        memcpy(&out[0][v], &a, sizeof(MesoVec3));
        memcpy(&out[1][v], &b, sizeof(MesoVec3));
        memcpy(&out[2][v], &c, sizeof(MesoVec3));
        memcpy(&out[3][v], &d, sizeof(MesoVec3));
        return;
    }
    memcpy(&out[0][v], &a, sizeof a);
    memcpy(&out[1][v], &b, sizeof b);
    memcpy(&out[2][v], &c, sizeof c);
    memcpy(&out[3][v], &d, sizeof d);
}

MESO_LANES_INLINE void meso_bend_store(MesoVec3 *const out[MESO_LANES], uint32_t v, MesoLanes3 p, bool last)
{
    MesoFour x[2], y[2], z[2];
    memcpy(x, &p.x, sizeof x);
    memcpy(y, &p.y, sizeof y);
    memcpy(z, &p.z, sizeof z);
    meso_bend_store_four(out, v, x[0], y[0], z[0], last);
    meso_bend_store_four(out + 4, v, x[1], y[1], z[1], last);
}

/* Eight spans: what they go between, and where their vertices go. */
typedef struct MesoBendGroup {
    const MesoJoint *from[MESO_LANES], *to[MESO_LANES];
    MesoVec3 *positions[MESO_LANES], *normals[MESO_LANES];
    MesoLaneBits folds;
    MesoLanes3 low, high;       /* of positions of all groups so far, by lane */
} MesoBendGroup;

MESO_LANES_INLINE MesoLanes3 meso_bend_least(MesoLanes3 a, MesoLanes3 b)
{
    return (MesoLanes3){meso_lanes_choose(a.x < b.x, a.x, b.x), meso_lanes_choose(a.y < b.y, a.y, b.y),
                        meso_lanes_choose(a.z < b.z, a.z, b.z)};
}

MESO_LANES_INLINE MesoLanes3 meso_bend_most(MesoLanes3 a, MesoLanes3 b)
{
    return (MesoLanes3){meso_lanes_most(a.x, b.x), meso_lanes_most(a.y, b.y), meso_lanes_most(a.z, b.z)};
}

MESO_LANES_INLINE void meso_bend_group(const MesoTerminalShape *shape, MesoBendGroup *group)
{
    uint32_t last = shape->body.vertex_count - 1;
    MesoBendLanes lanes;
    MesoLaneBits folds = {0};
    MesoLanes3 low = group->low, high = group->high;
    meso_bend_load(&lanes, group->from, group->to);
    for (uint32_t r = 0; r < shape->ring_count; r++) {
        MesoBendRow row;
        meso_bend_row(&row, &lanes, shape->along[r]);
        for (uint32_t v = shape->ring_begin[r]; v < shape->ring_begin[r + 1]; v++) {
            MesoVec3 p = shape->body.positions[v], n = shape->body.normals[v];
            MesoLanes g = row.ring.speed + (row.pitch * p.z - row.turn * p.y);
            MesoLanes3 at = meso_lanes3_mad(meso_lanes3_mad(row.ring.origin, meso_lanes_all(p.y), row.left),
                                            meso_lanes_all(p.z), row.normal);
            folds |= g < 0;
            low = meso_bend_least(at, low);
            high = meso_bend_most(at, high);
            meso_bend_store(group->positions, v, at, v == last);
            meso_bend_store(group->normals, v, meso_bend_normal(&row, p, n, g), v == last);
        }
    }
    group->folds = folds;
    group->low = low;
    group->high = high;
}

#endif
