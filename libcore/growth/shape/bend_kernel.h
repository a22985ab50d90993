/* Four spans at once, a lane each: curves, frames of rings, and vertices, by the formulas of bend.h. */
#ifndef MESO_BEND_KERNEL_H
#define MESO_BEND_KERNEL_H

#include <string.h>

#include "libcore/growth/shape/joint.h"
#include "libcore/math/four.h"

/* Lengths below it have no direction. */
#define MESO_BEND_LEAST 1e-17f

typedef struct MesoBendEnd {
    MesoFour3 tangent, normal;
} MesoBendEnd;

typedef struct MesoBendLanes {
    MesoFour3 p[4];
    MesoFour w[4];
    MesoBendEnd end[2];
} MesoBendLanes;

/* The frame at one t, and its changes with t. */
typedef struct MesoBendRing {
    MesoFour3 origin, tangent, left, normal;
    MesoFour width, widening;
    MesoFour speed;                     /* |B'| */
    MesoFour turn, pitch, twist;        /* about the normal, the left and the tangent */
} MesoBendRing;

MESO_FOUR MesoFour3 meso_bend_gather(const MesoVec3 *a, const MesoVec3 *b, const MesoVec3 *c, const MesoVec3 *d)
{
    return (MesoFour3){{a->x, b->x, c->x, d->x}, {a->y, b->y, c->y, d->y}, {a->z, b->z, c->z, d->z}};
}

/* 1 / sqrt(square), and 0 where that is too small. */
MESO_FOUR MesoFour meso_bend_inverse_root(MesoFour square)
{
    MesoFourBits has = square > MESO_BEND_LEAST * MESO_BEND_LEAST;
    MesoFour root = meso_four_root(meso_four_choose(has, square, meso_four_all(1)));
    return (MesoFour)((MesoFourBits)(1 / root) & has);
}

/* Distance of an inner control point from its end, along the tangent. */
MESO_FOUR MesoFour meso_bend_reach(MesoFour3 tangent, MesoFour3 chord, MesoFour length, MesoFour inverse)
{
    MesoFour cosine = meso_four3_dot(tangent, chord) * inverse;
    return length * (2.0f / 3) / (1 + meso_four_most(cosine, meso_four_all(0)));
}

/* Of the four joints at one end: the control point, the width there, and what the frame needs. */
static inline __attribute__((always_inline)) void meso_bend_load_end(MesoBendLanes *lanes, const MesoJoint *const j[4],
                                                                     uint32_t end, MesoFour *flare)
{
    lanes->p[3 * end] = meso_bend_gather(&j[0]->position, &j[1]->position, &j[2]->position, &j[3]->position);
    lanes->end[end].tangent = meso_bend_gather(&j[0]->tangent, &j[1]->tangent, &j[2]->tangent, &j[3]->tangent);
    lanes->end[end].normal = meso_bend_gather(&j[0]->normal, &j[1]->normal, &j[2]->normal, &j[3]->normal);
    lanes->w[3 * end] = (MesoFour){j[0]->width, j[1]->width, j[2]->width, j[3]->width};
    *flare = (MesoFour){j[0]->flare, j[1]->flare, j[2]->flare, j[3]->flare};
}

MESO_FOUR void meso_bend_load(MesoBendLanes *lanes, const MesoJoint *const from[4], const MesoJoint *const to[4])
{
    MesoFour flare[2], zero = meso_four_all(0);
    meso_bend_load_end(lanes, from, 0, &flare[0]);
    meso_bend_load_end(lanes, to, 1, &flare[1]);
    MesoFour3 chord = meso_four3_sub(lanes->p[3], lanes->p[0]);
    MesoFour square = meso_four3_dot(chord, chord), inverse = meso_bend_inverse_root(square);
    MesoFour length = square * inverse;
    MesoFour first = meso_bend_reach(lanes->end[0].tangent, chord, length, inverse);
    MesoFour last = meso_bend_reach(lanes->end[1].tangent, chord, length, inverse);
    lanes->p[1] = meso_four3_mad(lanes->p[0], first, lanes->end[0].tangent);
    lanes->p[2] = meso_four3_mad(lanes->p[3], -last, lanes->end[1].tangent);
    lanes->w[1] = meso_four_most(lanes->w[0] + first * flare[0], zero);
    lanes->w[2] = meso_four_most(lanes->w[3] - last * flare[1], zero);
}

/* ---- frames ---- */

/* A joint's normal, turned with the tangent to where it is T; and the part to the left of its change. */
typedef struct MesoBendTurned {
    MesoFour3 normal;
    MesoFour factor, factor_change;
} MesoBendTurned;

/*
 * The shortest turn from the joint's tangent T0 to T takes N0 to N0 - k (T0 + T), k = N0.T / (1 + T0.T). Where T is
 * opposite to T0 there is no shortest way, and k is kept small.
 */
MESO_FOUR MesoBendTurned meso_bend_turned(const MesoBendEnd *end, MesoFour3 tangent, MesoFour3 change)
{
    MesoFour sum = 1 + meso_four3_dot(end->tangent, tangent);
    MesoFour inverse = 1 / meso_four_most(sum, meso_four_all(1e-6f));
    MesoFour k = meso_four3_dot(end->normal, tangent) * inverse;
    MesoFour k_change = (meso_four3_dot(end->normal, change) - k * meso_four3_dot(end->tangent, change)) * inverse;
    MesoFour3 normal = meso_four3_mad(end->normal, -k, meso_four3_add(end->tangent, tangent));
    return (MesoBendTurned){normal, k, k_change};
}

MESO_FOUR MesoFour meso_bend_turned_left(const MesoBendEnd *end, const MesoBendTurned *turned, MesoFour3 left, MesoFour turn)
{
    return -(turned->factor_change * meso_four3_dot(end->tangent, left)) - turned->factor * turn;
}

/* Between the joints: N, L and the twist. Opposite normals meet on the left. */
MESO_FOUR void meso_bend_orient(MesoBendRing *ring, const MesoBendLanes *lanes, float t, MesoFour3 change)
{
    float s = t * t * (3 - 2 * t), s_change = 6 * t * (1 - t);
    MesoBendTurned a = meso_bend_turned(&lanes->end[0], ring->tangent, change);
    MesoBendTurned b = meso_bend_turned(&lanes->end[1], ring->tangent, change);
    MesoFour3 apart = meso_four3_sub(b.normal, a.normal);
    MesoFour3 sum = meso_four3_mad(a.normal, meso_four_all(s), apart);
    MesoFourBits meets = meso_four3_dot(sum, sum) > 1e-8f;
    sum = meso_four3_choose(meets, sum, meso_four3_cross(a.normal, ring->tangent));
    MesoFour inverse = meso_bend_inverse_root(meso_four3_dot(sum, sum));
    ring->normal = meso_four3_scale(sum, inverse);
    ring->left = meso_four3_cross(ring->normal, ring->tangent);
    ring->turn = meso_four3_dot(change, ring->left);
    MesoFour to_left = s_change * meso_four3_dot(apart, ring->left);
    to_left += (1 - s) * meso_bend_turned_left(&lanes->end[0], &a, ring->left, ring->turn);
    to_left += s * meso_bend_turned_left(&lanes->end[1], &b, ring->left, ring->turn);
    ring->twist = (MesoFour)((MesoFourBits)(-(to_left * inverse)) & meets);
}

/* b[0] a[0] + ... + b[3] a[3] */
MESO_FOUR MesoFour meso_bend_sum(const float b[4], MesoFour a0, MesoFour a1, MesoFour a2, MesoFour a3)
{
    return (b[0] * a0 + b[1] * a1) + (b[2] * a2 + b[3] * a3);
}

MESO_FOUR MesoFour3 meso_bend_sum3(const float b[4], const MesoFour3 p[4])
{
    return (MesoFour3){meso_bend_sum(b, p[0].x, p[1].x, p[2].x, p[3].x),
                       meso_bend_sum(b, p[0].y, p[1].y, p[2].y, p[3].y),
                       meso_bend_sum(b, p[0].z, p[1].z, p[2].z, p[3].z)};
}

/* At t of 0 and 1 origin, frame and width come from the joint alone: what shares it computes the same floats. */
MESO_FOUR void meso_bend_ring(MesoBendRing *ring, const MesoBendLanes *lanes, float t)
{
    float r = 1 - t;
    const float value[4] = {r * r * r, 3 * r * r * t, 3 * r * t * t, t * t * t};
    const float first[4] = {-3 * r * r, 3 * r * (r - 2 * t), 3 * t * (2 * r - t), 3 * t * t};
    const float second[4] = {6 * r, 6 * (t - 2 * r), 6 * (r - 2 * t), 6 * t};
    bool at_end = t == 0 || t == 1;
    const MesoBendEnd *end = &lanes->end[t > 0.5f];

    MesoFour3 velocity = meso_bend_sum3(first, lanes->p), acceleration = meso_bend_sum3(second, lanes->p);
    MesoFour square = meso_four3_dot(velocity, velocity), inverse = meso_bend_inverse_root(square);
    ring->speed = square * inverse;
    ring->tangent = at_end ? end->tangent : meso_four3_choose(inverse > 0, meso_four3_scale(velocity, inverse), end->tangent);
    MesoFour along = meso_four3_dot(acceleration, ring->tangent);
    MesoFour3 change = meso_four3_scale(meso_four3_mad(acceleration, -along, ring->tangent), inverse);
    ring->widening = meso_bend_sum(first, lanes->w[0], lanes->w[1], lanes->w[2], lanes->w[3]);
    if (at_end) {
        ring->origin = lanes->p[t == 1 ? 3 : 0];
        ring->width = lanes->w[t == 1 ? 3 : 0];
        ring->normal = end->normal;
        ring->left = meso_four3_cross(ring->normal, ring->tangent);
        ring->turn = meso_four3_dot(change, ring->left);
        ring->twist = meso_four_all(0);
    } else {
        ring->origin = meso_bend_sum3(value, lanes->p);
        ring->width = meso_bend_sum(value, lanes->w[0], lanes->w[1], lanes->w[2], lanes->w[3]);
        meso_bend_orient(ring, lanes, t, change);
    }
    ring->pitch = -meso_four3_dot(change, ring->normal);
}

/* ---- vertices ---- */

/* What one ring's vertices have in common. */
typedef struct MesoBendRow {
    MesoBendRing ring;
    MesoFour3 left, normal;     /* times the width */
    MesoFour pitch, turn, twist;
    MesoFour least;             /* that a length along becomes: where shapes fold, normals are still to be had */
    MesoFour width;             /* not 0: so are they at points */
} MesoBendRow;

MESO_FOUR void meso_bend_row(MesoBendRow *row, const MesoBendLanes *lanes, float t)
{
    meso_bend_ring(&row->ring, lanes, t);
    MesoFour width = row->ring.width;
    row->left = meso_four3_scale(row->ring.left, width);
    row->normal = meso_four3_scale(row->ring.normal, width);
    row->pitch = width * row->ring.pitch;
    row->turn = width * row->ring.turn;
    row->twist = width * row->ring.twist;
    row->least = meso_four_most(1e-3f * row->ring.speed, meso_four_all(MESO_BEND_LEAST));
    row->width = meso_four_most(meso_four_most(width, 1e-6f * row->ring.speed), meso_four_all(MESO_BEND_LEAST));
}

MESO_FOUR MesoFour3 meso_bend_in_frame(const MesoBendRing *ring, MesoFour along, MesoFour left, MesoFour up)
{
    return meso_four3_mad(meso_four3_mad(meso_four3_scale(ring->tangent, along), left, ring->left), up, ring->normal);
}

/*
 * In the frame, the columns of the map's derivative are (g, a, b), (0, w, 0) and (0, 0, w), where g = |B'| + pitch z - turn y,
 * a = w' y - twist z, b = w' z + twist y, with turns times w. Its cofactors take (nx, ny, nz) to
 * (w nx - a ny - b nz, g ny, g nz), as far as lengths do not matter.
 */
MESO_FOUR MesoFour3 meso_bend_normal(const MesoBendRow *row, MesoVec3 p, MesoVec3 n, MesoFour g)
{
    MesoFour a = row->ring.widening * p.y - row->twist * p.z, b = row->ring.widening * p.z + row->twist * p.y;
    MesoFour along = (row->width * n.x - a * n.y) - b * n.z, stretch = meso_four_most(g, row->least);
    MesoFour left = stretch * n.y, up = stretch * n.z;
    MesoFour inverse = 1 / meso_four_root(along * along + (left * left + up * up));
    return meso_bend_in_frame(&row->ring, along * inverse, left * inverse, up * inverse);
}

/* A lane to each of the four; the bytes behind a vertex are the next's, which is written then, but for the `last`. */
MESO_FOUR void meso_bend_store(MesoVec3 *const out[4], uint32_t v, MesoFour3 a, bool last)
{
    MesoFour xy_low = MESO_FOUR_SHUFFLE(a.x, a.y, 0, 4, 1, 5), xy_high = MESO_FOUR_SHUFFLE(a.x, a.y, 2, 6, 3, 7);
    MesoFour z_low = MESO_FOUR_SHUFFLE(a.z, a.z, 0, 4, 1, 5), z_high = MESO_FOUR_SHUFFLE(a.z, a.z, 2, 6, 3, 7);
    const MesoFour rows[4] = {
        MESO_FOUR_SHUFFLE(xy_low, z_low, 0, 1, 4, 5), MESO_FOUR_SHUFFLE(xy_low, z_low, 2, 3, 6, 7),
        MESO_FOUR_SHUFFLE(xy_high, z_high, 0, 1, 4, 5), MESO_FOUR_SHUFFLE(xy_high, z_high, 2, 3, 6, 7)};
    for (uint32_t lane = 0; lane < 4; lane++) {
        if (last)
            memcpy(&out[lane][v], &rows[lane], sizeof *out[lane]);
        else
            memcpy(&out[lane][v], &rows[lane], sizeof rows[lane]);
    }
}

#endif
