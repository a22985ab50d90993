/*
 * Sweeps against formulas: volumes of a straight tube, a quarter of a torus and boxes that turn, sections that keep
 * their width, normals against differences, ends to the bit, frames through an S that stands up, and mitres where tubes
 * would fold back on themselves.
 */
#include "libcore/scene/sweep_fixture.h"
#include "libcore/scene/sweep_plane.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/math/bezier.h"

static double volume6(MesoVec3 a, MesoVec3 b, MesoVec3 c)
{
    return (double)meso_vec3_dot(a, meso_vec3_cross(b, c));
}

/* Under all faces and a fan at each end. */
static double volume(void)
{
    double sum = 0;
    uint32_t width = tube.kind.column_count, rings = tube.kind.division_count;
    const MesoMeshVertex *v = tube.vertices, *last = v + (rings - 1) * width;
    MesoMeshFace *faces = calloc((size_t)width * rings, sizeof *faces);
    CHECK(faces);
    meso_sweep_faces(&tube.scene, &tube.kind, &tube.sweep, 0, faces);
    for (uint32_t f = 0; f < tube.kind.joint_count * (rings - 1); f++)
        for (uint32_t k = 2; k < 4; k++)
            sum += volume6(v[faces[f].v[0]].position, v[faces[f].v[k - 1]].position, v[faces[f].v[k]].position);
    for (uint32_t c = 1; c + 1 < width - 1; c++)
        sum += volume6(v[0].position, v[c].position, v[c + 1].position) -
               volume6(last[0].position, last[c].position, last[c + 1].position);
    free(faces);
    return sum / 6;
}

static bool near(double a, double b, double part)
{
    return fabs(a - b) <= part * fabs(b);
}

static double polygon_area(uint32_t count, double radius)
{
    return count * radius * radius * sin(2 * MESO_PI / count) / 2;
}

static void test_straight(void)
{
    MesoVec2 disc[64];
    make_tube(disc, make_disc(disc, 64, 0.1f), 0, 5);
    sweep();
    CHECK(near(volume(), polygon_area(64, 0.1), 1e-5));
}

/* Guldin: the area times the way of its middle. The cubic is within 3e-4 of the circle. */
static void test_quarter(void)
{
    MesoVec2 disc[64];
    const float k = (float)(4 * (sqrt(2) - 1) / 3);
    make_tube(disc, make_disc(disc, 64, 0.2f), 0, 128);
    tube.sweep = (MesoSweepInstance){{{1, 0, 0}, {1, k, 0}, {k, 1, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, 1}},
                                     {{0, 1, 0}, {-1, 0, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}};
    for (uint32_t rule = 0; rule < 2; rule++) {
        tube.scene.frame_rule = (MesoFrameRule)rule;
        tube.sweep.twist = rule ? meso_sweep_twist(&tube.sweep) : 0;
        CHECK(fabsf(tube.sweep.twist) < 1e-5f);
        sweep();
        CHECK(near(volume(), polygon_area(64, 0.2) * MESO_PI / 2, 1e-3));
    }
}

/* Half a turn pairs opposite points, and once blended them straight: the middle was a point. */
static void test_turned_box(void)
{
    static const double turns[] = {0.5, -0.5, 1, 2.5};
    MesoVec2 box[64];
    for (uint32_t i = 0; i < 4; i++) {
        bool half = fabs(turns[i] - floor(turns[i])) > 0.1;
        uint32_t count = make_box(box, 16, 0.3f, 0.1f);
        make_tube(box, count, half ? count / 2 : 0, MOST_RINGS);
        tube.kind.turn = (float)(2 * MESO_PI * turns[i]);
        sweep();
        CHECK(near(volume(), 0.03, 2e-3));
        for (uint32_t c = 0; c < count; c++) {
            MesoVec3 first = tube.vertices[c].position;
            MesoVec3 last = tube.vertices[(MOST_RINGS - 1) * (count + 1) + c].position;
            MesoVec2 start = tube.columns[c].start, end = tube.columns[c].end;
            CHECK(first.x == 0 && fabsf(first.y) == fabsf(start.x) && first.z == start.y);
            CHECK(last.x == 1 && fabsf(last.y) == fabsf(end.x) && last.z == end.y);
        }
    }
    tube.kind.turn = 0;     /* as it was: nothing is left in the middle */
    sweep();
    CHECK(volume() < 0.02);
}

/* About its own middle, beside the trajectory; sizes scale both. */
static void test_middle(void)
{
    MesoVec2 box[64];
    uint32_t count = make_box(box, 16, 0.2f, 0.1f);
    for (uint32_t i = 0; i < count; i++)
        box[i].y += 0.5f;
    make_tube(box, count, count / 2, 257);
    tube.kind.turn = (float)MESO_PI;
    tube.kind.middle[0] = tube.kind.middle[1] = (MesoVec2){0, 0.5f};
    tube.sweep.size[1] = 3;
    sweep();
    const MesoMeshVertex *middle = tube.vertices + 128 * (count + 1);
    for (uint32_t c = 0; c < count; c++) {      /* at v 1/2 twice as large, a quarter turned */
        MesoVec3 p = middle[c].position;
        CHECK(fabsf(fabsf(p.z - 1) - 2 * fabsf(box[c].x)) < 1e-5f);
        CHECK(fabsf(fabsf(p.y) - 2 * fabsf(box[c].y - 0.5f)) < 1e-5f);
    }
    CHECK(tube.vertices[256 * (count + 1)].position.z == 3 * tube.columns[0].end.y);
}

static MesoVec3 point_at(float column, float v)
{
    uint32_t c = (uint32_t)column;
    const MesoSweepColumn *a = &tube.columns[c], *b = &tube.columns[c + 1];
    MesoSweepColumn between = *a;
    between.start = meso_vec2_lerp(a->start, b->start, column - (float)c);
    between.end = meso_vec2_lerp(a->end, b->end, column - (float)c);
    return meso_sweep_point(&tube.scene, &tube.kind, &tube.sweep, &between, v);
}

/* In the middle of the sides of a box, on a straight trajectory: normals are those of the surface. */
static void test_normals(void)
{
    MesoVec2 box[64];
    uint32_t count = make_box(box, 8, 0.2f, 0.1f);
    make_tube(box, count, count / 2, 9);
    tube.kind.turn = (float)(3 * MESO_PI);
    tube.kind.middle[0] = (MesoVec2){0.1f, 0};
    tube.sweep.size[1] = 0.5f;
    tube.sweep.twist = 0.7f;
    sweep();
    for (uint32_t ring = 1; ring < 8; ring++)
        for (uint32_t c = 4; c < count; c += 8) {
            float v = (float)ring / 8, h = 1e-3f;
            MesoVec3 along = meso_vec3_sub(point_at((float)c, v + h), point_at((float)c, v - h));
            MesoVec3 around = meso_vec3_sub(point_at((float)c + 0.5f, v), point_at((float)c - 0.5f, v));
            MesoVec3 n = meso_vec3_unit(meso_vec3_cross(along, around), along);
            CHECK(meso_vec3_dot(n, tube.vertices[ring * (count + 1) + c].normal) > 0.9998f);
        }
}

/* The angle by which the section turns about the trajectory between rings, at most. */
static float largest_step(void)
{
    float most = 0;
    uint32_t width = tube.kind.column_count;
    sweep();
    for (uint32_t r = 0; r + 1 < tube.kind.division_count; r++) {
        const MesoMeshVertex *a = tube.vertices + r * width, *b = a + width;
        MesoVec3 x = meso_vec3_sub(a[0].position, a[width / 2].position);
        MesoVec3 y = meso_vec3_sub(b[0].position, b[width / 2].position);
        most = fmaxf(most, acosf(fminf(1, meso_vec3_dot(meso_vec3_direction(x, x), meso_vec3_direction(y, y)))));
    }
    return most;
}

/*
 * An S that stands up: its tangent passes the paper's up vector, whose frame flips there. The other rule turns with
 * the trajectory only, and ends in the end's own frame whatever that is.
 */
static void test_frames(void)
{
    MesoVec2 disc[32];
    make_tube(disc, make_disc(disc, 32, 0.05f), 0, 129);
    const MesoVec3 ups[2][2] = {{{0, 0, 1}, {0, 0, 1}}, {{0, 0, 1}, {0, 1, 0.2f}}};
    for (uint32_t i = 0; i < 2; i++) {
        tube.sweep = (MesoSweepInstance){{{0, 0, 0}, {1.5f, 0, 0}, {-0.5f, 0.05f, 1}, {1, 0.05f, 1}},
                                         {ups[i][0], ups[i][1]}, {{1, 0, 0}, {1, 0, 0}}, 0, {1, 1}, 0, 0, 0,
                                         {{0}, {0}}};
        tube.scene.frame_rule = MESO_FRAME_PAPER;
        CHECK(i == 1 || largest_step() > 0.5f);
        tube.scene.frame_rule = MESO_FRAME_MINIMAL;
        tube.sweep.twist = meso_sweep_twist(&tube.sweep);
        CHECK(fabsf(tube.sweep.twist) < (i ? 2.0f : 0.2f));
        CHECK(largest_step() < 0.12f);
    }
}

/* Of the vertices' triangles: those that are wound against the normals of all their corners. */
static uint32_t count_folded(void)
{
    static MesoMeshFace faces[MOST_COLUMNS * MOST_RINGS];
    uint32_t folded = 0;
    meso_sweep_faces(&tube.scene, &tube.kind, &tube.sweep, 0, faces);
    for (uint32_t f = 0; f < tube.kind.joint_count * (tube.kind.division_count - 1); f++)
        for (uint32_t half = 0; half < 2; half++) {
            const MesoMeshVertex *a = &tube.vertices[faces[f].v[0]], *b = &tube.vertices[faces[f].v[1 + half]];
            const MesoMeshVertex *c = &tube.vertices[faces[f].v[2 + half]];
            MesoVec3 area = meso_vec3_cross(meso_vec3_sub(b->position, a->position),
                                            meso_vec3_sub(c->position, a->position));
            folded += meso_vec3_dot(area, a->normal) < 0 && meso_vec3_dot(area, b->normal) < 0 &&
                      meso_vec3_dot(area, c->normal) < 0;
        }
    return folded;
}

/* The normals between the ends are those of the surface, by differences. */
static bool has_true_normals(void)
{
    bool good = true;
    for (uint32_t ring = 4; ring + 4 < tube.kind.division_count; ring += 4)
        for (uint32_t c = 1; c + 1 < tube.kind.column_count; c += 3) {
            float v = (float)ring / (float)(tube.kind.division_count - 1), h = 1e-3f;
            MesoVec3 along = meso_vec3_sub(point_at((float)c, v + h), point_at((float)c, v - h));
            MesoVec3 around = meso_vec3_sub(point_at((float)c + 0.5f, v), point_at((float)c - 0.5f, v));
            MesoVec3 n = meso_vec3_unit(meso_vec3_cross(along, around), along);
            good &= meso_vec3_dot(n, tube.vertices[ring * tube.kind.column_count + c].normal) > 0.99f;
        }
    return good;
}

/*
 * A bend around a corner near by, an S between ends that lie apart, and a turn to where it came from; the last, twice
 * as wide, has ends that lie within each other. All fold without a mitre, but for wide bends, and these have none.
 */
static void test_mitres(void)
{
    static const MesoSweepInstance bends[4] = {
        {{{0, 0, 0}, {0.25f, 0, 0}, {0.3f, 0.05f, 0}, {0.3f, 0.3f, 0}}, {{0, 0, 1}, {0, 0, 1}},
         {{1, 0, 0}, {0, 1, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}},
        {{{0, 0, 0}, {0.3f, 0, 0}, {0, 0.4f, 0}, {0.3f, 0.4f, 0}}, {{0, 0, 1}, {0, 0, 1}},
         {{1, 0, 0}, {1, 0, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}},
        {{{0, 0, 0}, {0.3f, 0, 0}, {0.3f, 0.6f, 0}, {0, 0.6f, 0}}, {{0, 0, 1}, {0, 0, 1}},
         {{1, 0, 0}, {-1, 0, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}},
        {{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {2, 2, 0}}, {{0, 0, 1}, {0, 0, 1}}, {{1, 0, 0}, {0, 1, 0}}, 0, {1, 1},
         0, 0, 0, {{0}, {0}}}};
    MesoVec2 disc[64];
    static MesoMeshVertex ends[2][65];
    uint32_t width = make_disc(disc, 64, 0.24f) + 1;
    for (uint32_t i = 0; i < 8; i++) {
        make_tube(disc, width - 1, 0, 33);
        tube.scene.frame_rule = i % 2 ? MESO_FRAME_MINIMAL : MESO_FRAME_PAPER;
        tube.sweep = bends[i / 2];
        sweep();
        CHECK((count_folded() > 20) == (i < 6));
        memcpy(ends[0], tube.vertices, sizeof ends[0]);
        memcpy(ends[1], tube.vertices + 32 * width, sizeof ends[1]);
        add_mitre();
        CHECK((tube.sweep.mitre > 0) == (i < 6));
        sweep();
        CHECK(count_folded() == 0 && (i >= 6 || has_true_normals()));
        CHECK(memcmp(ends[0], tube.vertices, sizeof ends[0]) == 0);
        CHECK(memcmp(ends[1], tube.vertices + 32 * width, sizeof ends[1]) == 0);
    }
}

static MesoVec3 random_direction(MesoRandom *random)
{
    float c[3];
    for (uint32_t i = 0; i < 3; i++)
        c[i] = (float)meso_random_below(random, 2001) / 1000 - 1;
    return (MesoVec3){c[0], c[1], c[2]};
}

/* From 0 to 1 along x, both handles off by so much. */
static MesoSweepInstance make_wild_sweep(MesoRandom *random, float off)
{
    MesoSweepInstance sweep = {.p = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, .size = {1, 1},
                               .up = {{0, 0, 1}, {0, 0, 1}}};
    for (uint32_t k = 0; k < 2; k++)
        sweep.p[1 + k] = meso_vec3_mad((MesoVec3){(float)(1 + k) / 3, 0, 0}, off, random_direction(random));
    for (uint32_t end = 0; end < 2; end++)
        sweep.direction[end] = meso_vec3_direction(meso_vec3_sub(sweep.p[1 + 2 * end], sweep.p[2 * end]),
                                                   (MesoVec3){0, 0, 0});
    return sweep;
}

/* The smallest radius of a trajectory's bends, and the place in the plane there, inwards. */
static double narrowest_bend(const MesoSweepInstance *sweep, float *v)
{
    double narrowest = INFINITY;
    for (uint32_t i = 0; i <= 4096; i++) {
        MesoVec3 first = meso_bezier_derivative(sweep->p, (float)i / 4096);
        MesoVec3 across = meso_vec3_cross(first, meso_bezier_second_derivative(sweep->p, (float)i / 4096));
        double radius = pow((double)meso_vec3_length(first), 3) / (double)meso_vec3_length(across);
        if (radius < narrowest) {
            narrowest = radius;
            *v = (float)i / 4096;
        }
    }
    return narrowest;
}

/*
 * Sections that reach a little beyond where rings meet at the narrowest place of a bend, wherever that is: a mitre
 * keeps them from folding; those that reach nearly as far have none. Also of one column of many.
 */
static void test_narrowest_places(void)
{
    MesoVec2 profile[MOST_COLUMNS];
    MesoRandom random;
    uint32_t count = 100, folded = 0;
    meso_random_init(&random, 5, 0);
    for (uint32_t i = 0; i < 400; i++) {
        float v = 0, reach = i % 2 ? 1.03f : 0.97f;
        MesoSweepInstance wild = make_wild_sweep(&random, 0.25f);
        double radius = narrowest_bend(&wild, &v);
        make_disc(profile, count, (float)radius * (i & 2 ? 0.3f : reach));
        if (i & 2) {        /* the one that points inwards there */
            MesoSweepFrames frames = meso_sweep_frames(MESO_FRAME_MINIMAL, &wild);
            MesoSweepPlane plane = meso_sweep_plane(&frames, v);
            MesoVec3 bend = meso_bezier_second_derivative(wild.p, v);
            double angle = atan2((double)meso_vec3_dot(bend, plane.y), (double)meso_vec3_dot(bend, plane.x));
            uint32_t at = (uint32_t)lround(count * (1 - angle / (2 * MESO_PI))) % count;
            profile[at] = (MesoVec2){reach * (float)(radius * cos(angle)), reach * (float)(radius * sin(angle))};
        }
        make_tube(profile, count, 0, 257);
        tube.scene.frame_rule = MESO_FRAME_MINIMAL;
        tube.sweep = wild;
        sweep();
        folded += count_folded() > 0;
        add_mitre();
        CHECK((tube.sweep.mitre > 0) == (i % 2 == 1));
        sweep();
        CHECK(count_folded() == 0);
    }
    CHECK(folded > 100);
}

/*
 * Where no mitre is enough, a crease is: around a corner that is nearer than the section is wide, to where it came from
 * and to an end behind the start, sections turning or not; and where the paper's frame flips, though nothing is narrow.
 * Ends and their normals stay what they are, to the bit, and next to them all goes on smoothly.
 */
static void test_creases(void)
{
    static const MesoSweepInstance bends[4] = {
        {{{0, 0, 0}, {0.15f, 0, 0}, {0.2f, 0.05f, 0}, {0.2f, 0.2f, 0}}, {{0, 0, 1}, {0, 0, 1}},
         {{1, 0, 0}, {0, 1, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}},
        {{{0, 0, 0}, {0.2f, 0, 0}, {0.2f, 0.35f, 0}, {0, 0.35f, 0}}, {{0, 0, 1}, {0, 0, 1}},
         {{1, 0, 0}, {-1, 0, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}},
        {{{0, 0, 0}, {0.3f, 0, 0}, {0, 0.3f, 0}, {-0.2f, 0.3f, 0.2f}}, {{0, 0, 1}, {0, 1, 1}},
         {{1, 0, 0}, {-0.7071068f, 0, 0.7071068f}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}},
        {{{0, 0, 0}, {1.5f, 0, 0}, {-0.5f, 0.05f, 1}, {1, 0.05f, 1}}, {{0, 0, 1}, {0, 0, 1}},
         {{1, 0, 0}, {1, 0, 0}}, 0, {0.1f, 0.1f}, 0, 0, 0, {{0}, {0}}}};
    MesoVec2 disc[64];
    static MesoMeshVertex ends[2][65];
    uint32_t width = make_disc(disc, 64, 0.24f) + 1;
    for (uint32_t i = 0; i < 16; i++) {
        make_tube(disc, width - 1, 0, i % 2 ? 9 : 65);
        tube.kind.turn = i & 2 && i < 12 ? 1 : 0;
        tube.sweep = bends[i / 4];
        sweep();
        CHECK(i >= 12 || count_folded() > 5);
        size_t last = (size_t)(tube.kind.division_count - 1) * width;
        memcpy(ends[0], tube.vertices, sizeof ends[0]);
        memcpy(ends[1], tube.vertices + last, sizeof ends[1]);
        add_mitre();
        CHECK(tube.sweep.mitre >= MESO_CREASED);
        sweep();
        CHECK(count_folded() == 0);
        CHECK(memcmp(ends[0], tube.vertices, sizeof ends[0]) == 0);
        CHECK(memcmp(ends[1], tube.vertices + last, sizeof ends[1]) == 0);
        CHECK(largest_step() < 0.6f || i % 2 || i < 12);
    }
}

/* Sections of creases go on into those of the ends, whether rings turn there or not. */
static void test_crease_ends(void)
{
    MesoVec2 disc[32];
    uint32_t width = make_disc(disc, 32, 0.24f) + 1;
    for (uint32_t k = 1; k <= MESO_CREASE_EASES; k++) {
        make_tube(disc, width - 1, 0, 401);
        tube.sweep = (MesoSweepInstance){{{0, 0, 0}, {0.2f, 0, 0}, {0.3f, 0.05f, 0}, {0.3f, 0.25f, 0}},
                                         {{0, 0, 1}, {0, 0, 1}}, {{1, 0, 0}, {0, 1, 0}}, 0, {1, 1}, 0,
                                         MESO_CREASED * (float)k + 0.5f, 0, {{0}, {0}}};
        sweep();
        for (uint32_t c = 0; c < width; c++)
            for (uint32_t r = 0; r < 400; r += 399) {
                MesoVec3 here = tube.vertices[r * width + c].position;
                CHECK(meso_vec3_length(meso_vec3_sub(tube.vertices[(r + 1) * width + c].position, here)) < 0.02f);
            }
    }
}

/*
 * Hundreds of sweeps, of which most ends lie within each other: creases leave no more than a few faces against their
 * normals, on few rings as on many, and of the sweeps of nine rings those are looked at that files have.
 */
static void test_wild_creases(void)
{
    static const float off[2] = {0.6f, 0.7f}, radii[2] = {0.24f, 0.15f};
    MesoVec2 disc[32];
    for (uint32_t i = 0; i < 2; i++) {
        MesoRandom random;
        uint32_t creased = 0, folded = 0, count = i == 0 ? 400 : 200, width = make_disc(disc, 32, radii[i]);
        meso_random_init(&random, 11, 0);
        for (uint32_t k = 0; k < count; k++) {
            make_tube(disc, width, 0, i == 0 ? 9 : 33);
            tube.sweep = make_wild_sweep(&random, off[i]);
            for (uint32_t end = 0; end < 2; end++)
                tube.sweep.up[end] = meso_vec3_mad((MesoVec3){0, 0, 1}, 0.5f, random_direction(&random));
            add_mitre();
            sweep();
            creased += tube.sweep.mitre >= MESO_CREASED;
            folded += count_folded();
            CHECK(count_folded() <= meso_sweep_against(&tube.scene, &tube.kind, &tube.sweep, UINT32_MAX));
        }
        CHECK(creased > count / 2 && folded < count / 20);
    }
}

/* The largest angle that the paper's X turns by from one sixteenth to the next, in radians. */
static double largest_turn(const MesoSweepInstance *sweep)
{
    double largest = 0;
    MesoVec3 before = {0, 0, 0};
    for (uint32_t i = 0; i <= 16; i++) {
        float v = (float)i / 16;
        MesoVec3 up = meso_vec3_lerp(sweep->up[0], sweep->up[1], v);
        MesoVec3 x = meso_vec3_direction(meso_vec3_cross(up, meso_bezier_derivative(sweep->p, v)), (MesoVec3){0, 0, 0});
        double sine = (double)meso_vec3_length(meso_vec3_cross(before, x)), cosine = (double)meso_vec3_dot(before, x);
        largest = i ? fmax(largest, atan2(sine, cosine)) : 0;
        before = x;
    }
    return largest;
}

/* A thread, whose bends are wide, has a crease where its frame turns by over 30 degrees a sixteenth, else nothing. */
static void test_flips(void)
{
    MesoVec2 disc[8];
    MesoRandom random;
    uint32_t flips = 0, width = make_disc(disc, 8, 1e-5f), trials = 20000;
    meso_random_init(&random, 3, 0);
    make_tube(disc, width, 0, 9);
    for (uint32_t i = 0; i < trials; i++) {
        MesoSweepInstance *sweep = &tube.sweep;
        for (uint32_t k = 0; k < 2; k++) {
            sweep->p[1 + k] = meso_vec3_mad((MesoVec3){(float)(1 + k) / 3, 0, 0}, 0.1f, random_direction(&random));
            sweep->up[k] = random_direction(&random);
        }
        for (uint32_t end = 0; end < 2; end++)
            sweep->direction[end] = meso_vec3_direction(meso_vec3_sub(sweep->p[1 + 2 * end], sweep->p[2 * end]),
                                                        (MesoVec3){0, 0, 0});
        double turn = largest_turn(sweep) * 180 / MESO_PI;
        if (fabs(turn - 30) < 0.1)
            continue;   /* either */
        add_mitre();
        CHECK(turn > 30 ? sweep->mitre >= MESO_CREASED : sweep->mitre == 0);
        flips += turn > 30;
    }
    CHECK(flips > trials / 20 && flips < trials / 2);
}

/* On a quarter of a circle chords of the same number are half as far off, on both sides; the ends stay. */
static void test_bowed(void)
{
    const float k = (float)(4 * (sqrt(2) - 1) / 3);
    MesoVec2 point[3] = {{0, 0}, {0, 0}, {0, 0}};
    MesoMeshVertex plain[9];
    make_tube(point, 3, 0, 9);
    tube.sweep = (MesoSweepInstance){{{1, 0, 0}, {1, k, 0}, {k, 1, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, 1}},
                                     {{0, 1, 0}, {-1, 0, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}};
    sweep();
    for (uint32_t r = 0; r < 9; r++)
        plain[r] = tube.vertices[r * tube.kind.column_count];
    tube.kind.bowed = true;
    sweep();
    CHECK(memcmp(&tube.vertices[0], &plain[0], sizeof *plain) == 0);
    CHECK(memcmp(&tube.vertices[8 * tube.kind.column_count], &plain[8], sizeof *plain) == 0);
    float out = 0, in = 0, before = 0;
    for (uint32_t r = 0; r < 8; r++) {
        MesoVec3 here = tube.vertices[r * tube.kind.column_count].position;
        MesoVec3 next = tube.vertices[(r + 1) * tube.kind.column_count].position;
        out = fmaxf(out, meso_vec3_length(here) - 1);
        in = fmaxf(in, 1 - meso_vec3_length(meso_vec3_lerp(here, next, 0.5f)));
        before = fmaxf(before, 1 - meso_vec3_length(meso_vec3_lerp(plain[r].position, plain[r + 1].position, 0.5f)));
    }
    CHECK(out > 0.4f * before && out < 0.65f * before && in > 0.4f * before && in < 0.65f * before);
}

/* What is straight stays, however unlike the steps beside a ring are. */
static void test_bowed_at_a_pace(void)
{
    MesoVec2 box[64];
    uint32_t count = make_box(box, 4, 0.2f, 0.1f);
    make_tube(box, count, 0, 9);
    for (uint32_t i = 0; i + 1 < MESO_PACE_PARTS; i++)
        tube.sweep.steps.pace[i] = (uint16_t)(200 * (i + 1) * (i + 1));
    tube.kind.bowed = true;
    sweep();
    for (uint32_t v = 0; v < 9 * tube.kind.column_count; v++)
        CHECK(fabsf(tube.vertices[v].position.x - tube.vertices[v].uv.y) < 1e-6f);
}

/* Quads whose bits are set are split from their second corner, and no others. */
static void test_leans(void)
{
    MesoVec2 box[64];
    uint32_t count = make_box(box, 4, 0.2f, 0.1f), leaning = 0;
    make_tube(box, count, 0, 9);
    uint32_t joints = tube.kind.joint_count, rows = tube.kind.division_count - 1, width = tube.kind.column_count;
    MesoMeshFace *straight = calloc((size_t)joints * rows, sizeof *straight);
    MesoMeshFace *leant = calloc((size_t)joints * rows, sizeof *leant);
    CHECK(straight && leant);
    meso_sweep_faces(&tube.scene, &tube.kind, &tube.sweep, 0, straight);
    for (uint32_t i = 0; i < MESO_LEAN_WORDS; i++)
        tube.sweep.steps.leans[i] = 0x9249249249249249u >> i;
    meso_sweep_faces(&tube.scene, &tube.kind, &tube.sweep, 0, leant);
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t joint = 0; joint < joints; joint++) {
            const uint32_t *a = straight[row * joints + joint].v, *b = leant[row * joints + joint].v;
            bool leans = meso_sweep_leans(&tube.sweep, meso_sweep_lean_bit(joint, joints, row, rows));
            leaning += leans;
            CHECK(a[0] / width == row);
            for (uint32_t k = 0; k < 4; k++)
                CHECK(b[k] == a[(k + leans) % 4]);
        }
    CHECK(leaning > 0 && leaning < rows * joints);
    for (uint32_t bit, joint = 0; joint < 300; joint++) {    /* of many, a few have one together */
        bit = meso_sweep_lean_bit(joint, 300, 39, 40);
        CHECK(bit < MESO_LEAN_BITS && bit == joint * MESO_LEAN_BITS / 300);
    }
    CHECK(meso_sweep_lean_bit(2, 3, 39, 40) == 3 * MESO_LEAN_PARTS - 1);
    free(straight);
    free(leant);
}

/* Rings lie as a pace says: all of the steps but one part in the first tenth. */
static void test_pace(void)
{
    MesoSweptKind kind = {.division_count = 2 * MESO_PACE_PARTS + 1};
    MesoSweepInstance hasty = {.size = {1, 1}};
    for (uint32_t i = 0; i + 1 < MESO_PACE_PARTS; i++)
        hasty.steps.pace[i] = (uint16_t)(6553 * (i + 1) / (MESO_PACE_PARTS - 1));
    float before = 0;
    for (uint32_t r = 1; r < kind.division_count; r++) {
        float v = meso_sweep_place(&kind, &hasty, r);
        CHECK(v > before && (v <= 0.1f) == (r <= kind.division_count - 3));
        before = v;
    }
    CHECK(before == 1 && meso_sweep_place(&kind, &hasty, 0) == 0);
}

/* Vertices that are wanted are as those of all; others are not touched, but where all are bent. */
static void test_wanted(void)
{
    static MesoMeshVertex some[MOST_COLUMNS * MOST_RINGS];
    uint8_t wanted[64 * 9] = {0};
    MesoVec2 box[64];
    uint32_t count = make_box(box, 16, 0.2f, 0.1f);
    make_tube(box, count, count / 2, 33);
    MesoSweepGrid grid = {.column_count = count, .ring_count = 9};
    meso_sweep_grid(&tube.scene, &tube.kind, &tube.sweep, &grid, tube.vertices);
    for (uint32_t v = 0; v < count * 9; v++) {
        wanted[v] = v % 7 == 3 && v / count != 4;
        some[v].uv.x = -1;
    }
    grid.wanted = wanted;
    meso_sweep_grid(&tube.scene, &tube.kind, &tube.sweep, &grid, some);
    for (uint32_t v = 0; v < count * 9; v++)
        CHECK(wanted[v] ? memcmp(&some[v], &tube.vertices[v], sizeof *some) == 0 : some[v].uv.x == -1);
}

int main(void)
{
    test_straight();
    test_quarter();
    test_turned_box();
    test_middle();
    test_normals();
    test_frames();
    test_mitres();
    test_narrowest_places();
    test_creases();
    test_crease_ends();
    test_wild_creases();
    test_flips();
    test_bowed();
    test_bowed_at_a_pace();
    test_leans();
    test_pace();
    test_wanted();
    return 0;
}
