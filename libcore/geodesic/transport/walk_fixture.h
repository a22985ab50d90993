/* Surfaces with their ground, and tips on them, for tests of walks. */
#ifndef MESO_WALK_FIXTURE_H
#define MESO_WALK_FIXTURE_H

#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/geodesic/transport/straight_walk.h"

typedef struct MesoWalkScene {
    MesoArena arena;
    MesoTriangulation mesh;
    MesoWalkGround ground;
} MesoWalkScene;

/* Of a mesh that goes with it. */
static inline void meso_walk_scene_init(MesoWalkScene *scene, MesoTriangulation mesh)
{
    scene->mesh = mesh;
    meso_arena_init(&scene->arena);
    CHECK(meso_walk_ground_build(&scene->ground, &scene->arena, &scene->mesh, NULL, 1, NULL) == MESO_OK);
}

static inline void meso_walk_scene_release(MesoWalkScene *scene)
{
    meso_arena_release(&scene->arena);
    meso_triangulation_release(&scene->mesh);
}

static inline double meso_fixture_uniform(MesoRandom *random)
{
    return (double)(meso_random_next(random) >> 11) / 9007199254740992.0;
}

static inline MesoTip meso_fixture_tip(const MesoWalkGround *ground, MesoRandom *random)
{
    double angle = 2 * MESO_PI * meso_fixture_uniform(random);
    double a = meso_fixture_uniform(random), b = meso_fixture_uniform(random);
    if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
    }
    return (MesoTip){meso_random_below(random, ground->triangle_count), false, {1 - a - b, a, b},
                     {cos(angle), sin(angle)}};
}

static inline MesoTip meso_fixture_back(MesoTip tip)
{
    tip.heading = (MesoComplex){-tip.heading.re, -tip.heading.im};
    return tip;
}

/* Walks, and checks what every walk holds to. */
static inline MesoWalk meso_fixture_walk(const MesoWalkGround *ground, MesoTip tip, double length,
                                         const MesoWalkOptions *options)
{
    MesoWalk walk = {.tip = tip, .length = length};
    meso_walks(ground, &walk, 1, options);
    CHECK(walk.tip.triangle < ground->triangle_count);
    CHECK(fabs(walk.tip.weight[0] + walk.tip.weight[1] + walk.tip.weight[2] - 1) < 1e-14);
    for (uint32_t k = 0; k < 3; k++)
        CHECK(walk.tip.weight[k] >= 0 && walk.tip.weight[k] <= 1);
    CHECK(fabs(hypot(walk.tip.heading.re, walk.tip.heading.im) - 1) < 1e-14);
    CHECK(walk.length >= 0 && walk.length <= length && (walk.length == 0 || walk.stop != MESO_WALK_DONE));
    return walk;
}

static inline void meso_fixture_place(const MesoTriangulation *mesh, const MesoTip *tip, double position[3],
                                      double heading[3])
{
    meso_tip_position(mesh, tip, position);
    meso_walk_direction(mesh, tip->triangle, tip->heading, heading);
}

static inline double meso_fixture_apart(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* A torus with bumps, whose vertices are off their grid: half of them are saddles, and no two triangles alike. */
static inline MesoTriangulation meso_fixture_bumpy_torus(uint32_t columns, uint32_t rows)
{
    MesoTriangulation mesh = meso_fixture_torus(columns, rows, 0.4f);
    MesoRandom random;
    meso_random_init(&random, 5, 0);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        MesoVec3 *p = &mesh.positions[v];
        float bump = 1 + 0.05f * sinf(11 * p->x) * cosf(13 * p->y) * sinf(9 * p->z);
        for (float *x = &p->x; x <= &p->z; x++)
            *x = *x * bump + 1.2f / (float)columns * meso_fixture_signed(&random);
    }
    return mesh;
}

static inline MesoVec3 meso_fixture_on_band(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    double a = 2 * MESO_PI * column / squares->columns, w = 0.6 * ((double)row / squares->rows - 0.5);
    double r = 1 + w * cos(a / 2);
    return (MesoVec3){(float)(r * cos(a)), (float)(r * sin(a)), (float)(w * sin(a / 2))};
}

static inline MesoTriangulation meso_fixture_moebius(void)
{
    return meso_fixture_squares(&(MesoFixtureSquares){60, 8, MESO_SEAM_TWISTED, false, {0, 0}, meso_fixture_on_band});
}

#endif
