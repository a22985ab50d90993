/* Joints for tests of bending, and a vertex with what lies around it. */
#ifndef MESO_BEND_FIXTURE_H
#define MESO_BEND_FIXTURE_H

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/growth/shape/bend.h"

/* Uniform in [-1, 1). */
static inline float meso_test_number(MesoRandom *random)
{
    return (float)meso_random_below(random, 1u << 24) / (1u << 23) - 1;
}

static inline MesoVec3 meso_test_direction(MesoRandom *random)
{
    MesoVec3 a = {0, 0, 0};
    while (!(meso_vec3_length(a) > 0.1f && meso_vec3_length(a) < 1))
        a = (MesoVec3){meso_test_number(random), meso_test_number(random), meso_test_number(random)};
    return meso_vec3_unit(a, a);
}

static inline float meso_test_apart(MesoVec3 a, MesoVec3 b)
{
    return meso_vec3_length(meso_vec3_sub(a, b));
}

/* A strand: joints a step of about 1 apart, that turn, rise, roll and flare at random. */
static inline void meso_test_strand(MesoJoint *joints, uint32_t count, uint64_t seed, float width)
{
    MesoRandom random;
    meso_random_init(&random, seed, 0);
    MesoVec3 at = {0, 0, 0}, heading = {1, 0, 0}, normal = {0, 0, 1};
    for (uint32_t i = 0; i < count; i++) {
        MesoVec3 next = meso_vec3_unit(meso_vec3_mad(heading, 0.6f, meso_test_direction(&random)), heading);
        normal = meso_vec3_mad(normal, 0.3f, meso_test_direction(&random));
        normal = meso_vec3_unit(meso_vec3_mad(normal, -meso_vec3_dot(normal, next), next), normal);
        joints[i] = meso_joint(at, normal, next, next, width * (1 + 0.3f * meso_test_number(&random)), 0);
        at = meso_vec3_add(at, next);
        heading = next;
    }
}

/* Bends one span, to arrays of the shape's size. */
static inline void meso_test_bend(const MesoTerminalShape *shape, MesoJoint from, MesoJoint to, MesoVec3 *positions,
                                  MesoVec3 *normals)
{
    MesoJoint joints[2] = {from, to};
    MesoSpan span = {0, 1};
    MesoBending bending = {shape, joints, 1, &span, positions, normals, NULL, NULL};
    meso_bend(&bending, 1);
}

#endif
