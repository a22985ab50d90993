#include "libcore/shell/shell_stretch.h"

#include "libcore/base/check.h"
#include "libcore/base/random.h"

static const MesoVec3d corner[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static void map(MesoVec3d to[4], const MesoVec3d from[4], const MesoVec3d columns[3])
{
    for (uint32_t k = 0; k < 4; k++) {
        to[k] = meso_vec3d_scale(columns[0], from[k].x);
        to[k] = meso_vec3d_mad(to[k], from[k].y, columns[1]);
        to[k] = meso_vec3d_mad(to[k], from[k].z, columns[2]);
        to[k] = meso_vec3d_add(to[k], (MesoVec3d){0.3, -2, 7});
    }
}

static double uniform(MesoRandom *random)
{
    return (double)(meso_random_next(random) >> 11) / 9007199254740992.0 * 2 - 1;
}

static MesoVec3d any(MesoRandom *random)
{
    double x = uniform(random), y = uniform(random);
    return (MesoVec3d){x, y, uniform(random)};
}

/* By hand: x is sheared by 1 over z, so J has the squares 1, 1 and 1 + 1; its inverse the same. */
static void test_shear(void)
{
    const MesoVec3d shear[3] = {{1, 0, 0}, {0, 1, 0}, {1, 0, 1}};
    MesoVec3d to[4];
    MesoShellStretch there = {0}, back = {0};
    map(to, corner, shear);
    CHECK(fabs(meso_tetrahedron_det(to) - 1) < 1e-12);
    CHECK(fabs(meso_tetrahedron_stretch(corner, to) - 4.0 / 3) < 1e-12);
    CHECK(fabs(meso_tetrahedron_stretch(to, corner) - 4.0 / 3) < 1e-12);
    meso_shell_stretch_add(&there, corner, to);
    meso_shell_stretch_sample(&back, shear, 1.0 / 6, true);
    CHECK(fabs(meso_shell_stretch(&there) - sqrt(4.0 / 3)) < 1e-12);
    CHECK(fabs(meso_shell_stretch(&back) - sqrt(4.0 / 3)) < 1e-12);
}

/* Lengths along the axes by 2, 3 and 4: squares 4 + 9 + 16, and back. */
static void test_axes(void)
{
    const MesoVec3d axes[3] = {{2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
    MesoVec3d to[4];
    MesoShellStretch there = {0}, back = {0};
    map(to, corner, axes);
    CHECK(fabs(meso_tetrahedron_stretch(corner, to) - 29.0 / 3) < 1e-12);
    CHECK(fabs(meso_tetrahedron_stretch(to, corner) - (1 / 4.0 + 1 / 9.0 + 1 / 16.0) / 3) < 1e-12);
    meso_shell_stretch_add(&there, corner, to);
    meso_shell_stretch_add(&back, to, corner);
    CHECK(fabs(meso_shell_stretch(&there) - sqrt(29.0 / 3) / cbrt(24)) < 1e-12);
    CHECK(fabs(meso_shell_stretch(&back) - sqrt((1 / 4.0 + 1 / 9.0 + 1 / 16.0) / 3) * cbrt(24)) < 1e-12);
}

/* Tetrahedra of any shape against samples of the same linear map; 1 is the least; a scale has it. */
static void test_any(void)
{
    MesoRandom random;
    meso_random_init(&random, 5, 0);
    for (uint32_t i = 0; i < 1000; i++) {
        MesoVec3d from[4], to[4], columns[3];
        for (uint32_t k = 0; k < 4; k++)
            from[k] = any(&random);
        for (uint32_t k = 0; k < 3; k++)
            columns[k] = any(&random);
        if (meso_vec3d_det(columns[0], columns[1], columns[2]) < 0)
            columns[0] = meso_vec3d_scale(columns[0], -1);
        map(to, from, columns);
        MesoShellStretch sums[4] = {0};
        meso_shell_stretch_add(&sums[0], from, to);
        meso_shell_stretch_sample(&sums[1], columns, 0.7, false);
        meso_shell_stretch_add(&sums[2], to, from);
        meso_shell_stretch_sample(&sums[3], columns, 0.7, true);
        for (uint32_t k = 0; k < 4; k += 2) {
            double stretch = meso_shell_stretch(&sums[k]);
            CHECK(stretch > 1 && fabs(meso_shell_stretch(&sums[k + 1]) / stretch - 1) < 1e-6);
        }
        MesoShellStretch scaled = {0};
        for (uint32_t k = 0; k < 4; k++)
            to[k] = meso_vec3d_scale(from[k], 0.01 + i);
        meso_shell_stretch_add(&scaled, from, to);
        CHECK(fabs(meso_shell_stretch(&scaled) - 1) < 1e-9);
    }
}

/* Equation 9 weighs by volumes of the side that is measured from. */
static void test_sum(void)
{
    const MesoVec3d half[3] = {{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}, turned[3] = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    MesoVec3d small[4], same[4];
    map(small, corner, half);
    map(same, corner, turned);
    MesoShellStretch there = {0}, back = {0};
    meso_shell_stretch_add(&there, corner, small);
    meso_shell_stretch_add(&there, corner, same);
    meso_shell_stretch_add(&back, small, corner);
    meso_shell_stretch_add(&back, same, corner);
    CHECK(fabs(meso_shell_stretch(&there) - sqrt((0.25 + 1) / 2) * cbrt(2 / 1.125)) < 1e-12);
    CHECK(fabs(meso_shell_stretch(&back) - sqrt((4 * 0.125 + 1) / 1.125) * cbrt(1.125 / 2)) < 1e-12);
    MesoVec3d mirrored[4] = {small[1], small[0], small[2], small[3]};
    meso_shell_stretch_add(&there, corner, mirrored);
    CHECK(there.inverted_count == 1 && fabs(there.from_volume - 2.0 / 6) < 1e-12);
    CHECK(meso_shell_stretch(&(MesoShellStretch){0}) == 1);
    const MesoVec3d flat[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    CHECK(meso_tetrahedron_stretch(flat, corner) == INFINITY);
}

int main(void)
{
    test_shear();
    test_axes();
    test_any();
    test_sum();
    return 0;
}
