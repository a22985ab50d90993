/* Deformations against what is known of them: areas, lengths, what stays, and every bit at the start. */
#include "libcore/replicate/deform/deform.h"

#include <math.h>

#include "libcore/base/check.h"

enum { SIDE = 33, COUNT = SIDE * SIDE };

static MesoVec3 plane[COUNT], out[COUNT];

static const MesoVec3 x_axis = {1, 0, 0}, z_axis = {0, 0, 1};

/* [0,2] x [0,1], as a grid. */
static void make_plane(void)
{
    for (uint32_t i = 0; i < COUNT; i++)
        plane[i] = (MesoVec3){2 * (float)(i % SIDE) / (SIDE - 1), (float)(i / SIDE) / (SIDE - 1), 0};
}

static double area(const MesoVec3 *p)
{
    double sum = 0;
    for (uint32_t i = 0; i < COUNT - SIDE; i++) {
        if (i % SIDE == SIDE - 1)
            continue;
        MesoVec3 a = meso_vec3_sub(p[i + 1], p[i]), b = meso_vec3_sub(p[i + SIDE + 1], p[i]);
        MesoVec3 c = meso_vec3_sub(p[i + SIDE], p[i]);
        sum += 0.5 * (double)(meso_vec3_length(meso_vec3_cross(a, b)) + meso_vec3_length(meso_vec3_cross(b, c)));
    }
    return sum;
}

static void deform_plane(const MesoDeformStep *step, double time)
{
    MesoError error;
    CHECK(meso_deform(out, plane, COUNT, step, 1, time, 1, &error) == MESO_OK);
}

static bool near(double a, double b, double slack) { return fabs(a - b) <= slack; }

static void test_stretch(void)
{
    MesoDeformStep step = {.kind = MESO_DEFORM_STRETCH, .axis = x_axis, .up = z_axis, .amount = 2};
    deform_plane(&step, 0.5);
    CHECK(near(area(out), 3, 1e-5));
    CHECK(near(out[0].x, -0.5, 1e-6) && near(out[SIDE - 1].x, 2.5, 1e-6));      /* about the middle of the box */
    step.centered = true;
    deform_plane(&step, 1);
    CHECK(near(area(out), 4, 1e-5) && out[0].x == 0);
    step.kind = MESO_DEFORM_SCALE;
    deform_plane(&step, 1);
    CHECK(near(area(out), 8, 1e-5) && near(out[COUNT - 1].y, 2, 1e-6));
}

/* Every share of a bend keeps the lengths along the arc; half a turn brings the ends as far apart as the diameter. */
static void test_bend(void)
{
    MesoDeformStep step = {.kind = MESO_DEFORM_BEND, .axis = x_axis, .up = z_axis, .amount = 3.14159265f};
    for (int k = 1; k <= 10; k++) {
        deform_plane(&step, 0.1 * k);
        double angle = 0.1 * k * 3.14159265, radius = 2 / angle;
        MesoVec3 ends = meso_vec3_sub(out[SIDE - 1], out[0]);
        CHECK(near(meso_vec3_length(ends), 2 * radius * sin(0.5 * angle), 1e-5));
        for (uint32_t i = 0; i < COUNT; i++) {
            double x = out[i].x - 1, z = out[i].z - radius;
            CHECK(near(sqrt(x * x + z * z), radius, 1e-5 * radius) && out[i].y == plane[i].y);
        }
        for (uint32_t i = 1; i < SIDE; i++) {
            double chord = meso_vec3_length(meso_vec3_sub(out[i], out[i - 1]));
            double arc = 2 * radius * asin(0.5 * chord / radius);
            CHECK(near(arc, 2.0 / (SIDE - 1), 2e-6));
        }
        CHECK(out[0].z > 0);        /* towards `up` */
    }
    deform_plane(&step, 1e-9);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK(near(meso_vec3_length(meso_vec3_sub(out[i], plane[i])), 0, 1e-6));
}

/* A rod of square section: lengths to the axis and along it stay, the ends are turned by the angle. */
static void test_twist(void)
{
    MesoVec3 rod[] = {{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}, {5, -1, -1}, {5, 1, -1}, {5, 1, 1}, {5, -1, 1}};
    MesoVec3 turned[8];
    MesoError error;
    const MesoDeformStep step = {.kind = MESO_DEFORM_TWIST, .axis = x_axis, .up = z_axis,
                                 .amount = 0.5f * 3.14159265f};
    CHECK(meso_deform(turned, rod, 8, &step, 1, 1, 2, &error) == MESO_OK);
    for (uint32_t i = 0; i < 8; i++)
        CHECK(turned[i].x == rod[i].x && near(hypot(turned[i].y, turned[i].z), sqrt(2), 1e-6));
    for (uint32_t i = 0; i < 4; i++) {
        double angle = atan2(turned[i + 4].z, turned[i + 4].y) - atan2(turned[i].z, turned[i].y);
        CHECK(near(cos(angle), 0, 1e-6) && sin(angle) > 0);
    }
}

static void test_inflate(void)
{
    MesoDeformStep step = {.kind = MESO_DEFORM_INFLATE, .axis = x_axis, .up = z_axis, .centered = true,
                           .center = {1, 0.5f, -0.25f}, .radius = 0.75f, .amount = 0.5f};
    deform_plane(&step, 1);
    uint32_t middle = COUNT / 2;
    double d = 0.25 / 0.75, rest = 1 - d * d;
    CHECK(near(out[middle].z, 0.5 * rest * rest, 1e-6) && near(out[middle].x, 1, 1e-6));
    CHECK(memcmp(&out[0], &plane[0], sizeof plane[0]) == 0);        /* it is further away than the radius */
    step.center.z = 0;
    deform_plane(&step, 1);
    CHECK(memcmp(&out[middle], &plane[middle], sizeof plane[0]) == 0);      /* the center itself has no direction */
}

static void test_keys(void)
{
    const MesoDeformKey keys[] = {{0.25f, 0}, {0.5f, 1}, {0.75f, 0.5f}};
    MesoDeformStep step = {.kind = MESO_DEFORM_STRETCH, .axis = x_axis, .up = z_axis, .amount = 3,
                           .key_count = 3, .keys = keys};
    static const double times[][2] = {{0, 0}, {0.25, 0}, {0.375, 0.5}, {0.5, 1}, {0.625, 0.75}, {0.75, 0.5}, {1, 0.5}};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++)
        CHECK(near(meso_deform_share(&step, times[i][0]), times[i][1], 1e-12));
    deform_plane(&step, 0.2);
    CHECK(memcmp(out, plane, sizeof plane) == 0);
    deform_plane(&step, 0.5);
    CHECK(near(area(out), 6, 1e-5));
}

/* Steps one after another, and the same bytes for any number of threads. */
static void test_steps(void)
{
    MesoError error;
    MesoDeformStep steps[MESO_DEFORM_KINDS];
    static MesoVec3 other[COUNT];
    for (int k = 0; k < MESO_DEFORM_KINDS; k++)
        steps[k] = meso_deform_usual((MesoDeformKind)k, plane, COUNT);
    CHECK(steps[0].axis.x == 1 && steps[0].up.z == 1 && steps[0].amount == 2);
    CHECK(meso_deform(out, plane, COUNT, steps, MESO_DEFORM_KINDS, 0.7, 1, &error) == MESO_OK);
    CHECK(meso_deform(other, plane, COUNT, steps, MESO_DEFORM_KINDS, 0.7, 7, &error) == MESO_OK);
    CHECK(memcmp(out, other, sizeof out) == 0);
    memcpy(other, plane, sizeof other);
    CHECK(meso_deform(other, other, COUNT, steps, MESO_DEFORM_KINDS, 0.7, 2, &error) == MESO_OK);
    CHECK(memcmp(out, other, sizeof out) == 0);
    CHECK(meso_deform(out, plane, COUNT, steps, MESO_DEFORM_KINDS, 0, 1, &error) == MESO_OK);
    CHECK(memcmp(out, plane, sizeof out) == 0);
    steps[0].amount = 3e38f;
    CHECK(meso_deform(out, plane, COUNT, steps, 1, 1, 1, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "stretch takes vertex 1 beyond the largest coordinate, 1e+18");
    CHECK(meso_deform(out, plane, 0, steps, 1, 1, 1, &error) == MESO_OK);
}

int main(void)
{
    make_plane();
    test_stretch();
    test_bend();
    test_twist();
    test_inflate();
    test_keys();
    test_steps();
    return 0;
}
