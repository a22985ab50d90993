/*
 * Walks on irregular tori, by the time of the process, one core:
 *
 *   straight_walk_bench [STEPS]     random steps, in millions; 10 without
 */
#include <stdio.h>
#include <time.h>

#include "libcore/geodesic/transport/walk_fixture.h"

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void strew(MesoWalk *walks, uint32_t count, const MesoWalkGround *ground, double length)
{
    MesoRandom random;
    meso_random_init(&random, 5, 0);
    for (uint32_t i = 0; i < count; i++) {
        double angle = 2 * MESO_PI * meso_fixture_uniform(&random);
        walks[i] = (MesoWalk){.tip = {meso_random_below(&random, ground->triangle_count), false,
                                      {1 / 3.0, 1 / 3.0, 1 / 3.0}, {cos(angle), sin(angle)}}, .length = length};
    }
}

static void measure(uint32_t columns, uint32_t rows, uint32_t step_millions)
{
    enum { LONG = 4096, SHORT = 65536 };
    MesoArena arena;
    MesoTriangulation mesh = meso_fixture_bumpy_torus(columns, rows);
    MesoWalkGround ground;
    MesoRandom random;
    meso_random_init(&random, 9, 0);
    meso_arena_init(&arena);
    double start = cpu_seconds();
    CHECK(meso_walk_ground_build(&ground, &arena, &mesh, NULL, 1, NULL) == MESO_OK);
    printf("%7u triangles: ground %.3f s", mesh.triangle_count, cpu_seconds() - start);

    MesoWalk *walks = MESO_NEW(&arena, MesoWalk, SHORT, NULL);
    CHECK(walks);
    double best = 0;
    for (int round = 0; round < 3; round++) {
        uint64_t crossings = 0;
        strew(walks, LONG, &ground, 10);
        start = cpu_seconds();
        meso_walks(&ground, walks, LONG, NULL);
        double seconds = cpu_seconds() - start;
        for (uint32_t i = 0; i < LONG; i++)
            crossings += walks[i].crossings;
        best = fmax(best, 1e-6 * (double)crossings / seconds);
    }
    printf(", long walks %.1f M crossings/s", best);

    strew(walks, SHORT, &ground, 0.01);
    uint64_t steps = 0, crossings = 0;
    double seconds = 0;
    while (steps < (uint64_t)step_millions * 1000000) {
        for (uint32_t i = 0; i < SHORT; i++) {
            meso_tip_turn(&walks[i].tip, meso_fixture_uniform(&random) - 0.5);
            walks[i].length = 0.01;
        }
        start = cpu_seconds();
        meso_walks(&ground, walks, SHORT, NULL);
        seconds += cpu_seconds() - start;
        for (uint32_t i = 0; i < SHORT; i++) {
            CHECK(walks[i].stop == MESO_WALK_DONE);
            crossings += walks[i].crossings;
        }
        steps += SHORT;
    }
    printf(", steps of 0.01 %.2f M/s of %.1f crossings\n", 1e-6 * (double)steps / seconds,
           (double)crossings / (double)steps);
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
}

/* How far from where they began walks end that should return. */
static void print_errors(const char *what, const MesoTriangulation *mesh, double length, bool back)
{
    enum { COUNT = 2000 };
    MesoArena arena;
    MesoWalkGround ground;
    MesoRandom random;
    double mean = 0, worst = 0;
    meso_arena_init(&arena);
    meso_random_init(&random, 3, 0);
    CHECK(meso_walk_ground_build(&ground, &arena, mesh, NULL, 1, NULL) == MESO_OK);
    for (uint32_t i = 0; i < COUNT; i++) {
        MesoTip tip = meso_fixture_tip(&ground, &random);
        double from[3], to[3];
        meso_tip_position(mesh, &tip, from);
        MesoWalk walk = meso_fixture_walk(&ground, tip, length, NULL);
        if (back)
            walk = meso_fixture_walk(&ground, meso_fixture_back(walk.tip), length, NULL);
        CHECK(walk.stop == MESO_WALK_DONE);
        meso_tip_position(mesh, &walk.tip, to);
        mean += meso_fixture_apart(from, to) / COUNT;
        worst = fmax(worst, meso_fixture_apart(from, to));
    }
    printf("%7u triangles: %s: error %.1e, at most %.1e\n", mesh->triangle_count, what, mean, worst);
    meso_arena_release(&arena);
}

static void measure_errors(uint32_t columns, uint32_t rows, uint32_t divisions)
{
    MesoTriangulation torus = meso_fixture_bumpy_torus(columns, rows), ball = meso_fixture_sphere(divisions, 0, 0);
    print_errors("there and back over 1", &torus, 1, true);
    print_errors("great circles of a unit sphere", &ball, 2 * MESO_PI, false);
    meso_triangulation_release(&torus);
    meso_triangulation_release(&ball);
}

int main(int argc, char **argv)
{
    uint32_t step_millions = argc > 1 ? (uint32_t)atoi(argv[1]) : 10;
    measure(320, 128, step_millions);
    measure(1280, 512, step_millions);
    measure_errors(320, 128, 64);
    measure_errors(1280, 512, 256);
    return 0;
}
