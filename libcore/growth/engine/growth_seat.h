/*
 * Joints and points of the surface while a turn is under way: vectors of four floats, the last of them 0, which are kept
 * in registers, and read from memory as they were written.
 */
#ifndef MESO_GROWTH_SEAT_H
#define MESO_GROWTH_SEAT_H

#include "libcore/growth/shape/joint.h"
#include "libcore/math/four.h"

/* A point of the surface in space. */
typedef struct MesoGrowthFooting {
    MesoFour position, normal;
    MesoFour x, y;              /* the frame of its triangle */
} MesoGrowthFooting;

/* A joint without flare. */
typedef struct MesoGrowthSeat {
    MesoFour position, tangent, normal;
    float width;
} MesoGrowthSeat;

MESO_FOUR MesoFour meso_four_of(MesoVec3 a)
{
    return (MesoFour){a.x, a.y, a.z, 0};
}

MESO_FOUR MesoVec3 meso_four_vec3(MesoFour a)
{
    return (MesoVec3){a[0], a[1], a[2]};
}

/* Of the first three, in the order of meso_vec3_dot(). */
MESO_FOUR float meso_four_dot(MesoFour a, MesoFour b)
{
    MesoFour products = a * b;
    return products[0] + products[1] + products[2];
}

/* a + s * b */
MESO_FOUR MesoFour meso_four_mad(MesoFour a, float s, MesoFour b)
{
    return a + meso_four_all(s) * b;
}

MESO_FOUR MesoFour meso_four_scale(MesoFour a, float s)
{
    return a * meso_four_all(s);
}

MESO_FOUR MesoFour meso_four_cross(MesoFour a, MesoFour b)
{
    return MESO_FOUR_SHUFFLE(a, a, 1, 2, 0, 3) * MESO_FOUR_SHUFFLE(b, b, 2, 0, 1, 3) -
           MESO_FOUR_SHUFFLE(a, a, 2, 0, 1, 3) * MESO_FOUR_SHUFFLE(b, b, 1, 2, 0, 3);
}

/* Control points of the curve between two joints, as bend.h has it. */
MESO_FOUR void meso_four_curve(MesoFour p[4], MesoFour from, MesoFour from_tangent, MesoFour to, MesoFour to_tangent)
{
    MesoFour chord = to - from;
    float length = sqrtf(meso_four_dot(chord, chord)), inverse = length > 0 ? 1 / length : 0;
    float first = meso_four_dot(from_tangent, chord) * inverse, last = meso_four_dot(to_tangent, chord) * inverse;
    float reach = length * (2.0f / 3);
    float a = reach / (1 + (first > 0 ? first : 0)), b = reach / (1 + (last > 0 ? last : 0));
    p[0] = from;
    p[1] = meso_four_mad(from, a, from_tangent);
    p[2] = meso_four_mad(to, -b, to_tangent);
    p[3] = to;
}

MESO_FOUR MesoJoint meso_seat_joint(const MesoGrowthSeat *seat)
{
    return (MesoJoint){meso_four_vec3(seat->position), meso_four_vec3(seat->tangent), meso_four_vec3(seat->normal),
                       seat->width, 0};
}

MESO_FOUR MesoGrowthSeat meso_seat_of(MesoJoint joint)
{
    return (MesoGrowthSeat){meso_four_of(joint.position), meso_four_of(joint.tangent), meso_four_of(joint.normal),
                            joint.width};
}

#endif
