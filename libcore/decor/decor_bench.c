/*
 * An editing sequence as long as the longest of the paper (figure 13: 655 operations, 1810 regions, depth 21): one
 * operation at a time, each on the region at a point drawn over the surface.
 */
#include <stdlib.h>
#include <sys/resource.h>

#include "libcore/base/clock.h"
#include "libcore/base/random.h"
#include "libcore/decor/decor.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

enum { OPERATIONS = 655, KINDS = 6 };

static const MesoSeedSpec BORDERS = {.kind = MESO_SEED_BORDERS}, OUTER = {.kind = MESO_SEED_OUTER};
static const MesoSeedSpec INNER = {.kind = MESO_SEED_INNER};
static const MesoSeedSpec SPREAD = {.kind = MESO_SEED_POISSON, .count = 3, .from_border = true};
static const MesoSeedSpec FEW = {.kind = MESO_SEED_POISSON, .count = 2, .from_border = true};
static const float HALF[] = {0.5f}, EDGE[] = {0.2f};

static const MesoStep STEPS[KINDS] = {
    {.kind = MESO_STEP_CONTOUR, .field = {.from = {&BORDERS, 1}}, .levels = {EDGE, 1, .unit = MESO_LEVEL_SHARE}},
    {.kind = MESO_STEP_CONTOUR, .field = {.from = {&SPREAD, 1}}, .levels = {EDGE, 1, .unit = MESO_LEVEL_SHARE}},
    {.kind = MESO_STEP_VORONOI, .field = {.from = {&FEW, 1}}},
    {.kind = MESO_STEP_CONTOUR, .field = {.from = {&FEW, 1}, .to = {&BORDERS, 1}, .blend = true}, .levels = {HALF, 1}},
    {.kind = MESO_STEP_STREAM, .field = {.from = {&INNER, 1}, .to = {&OUTER, 1}, .blend = true}, .line_count = 2},
    {.kind = MESO_STEP_CONTOUR, .field = {.from = {&BORDERS, 1}}, .levels = {.count = 1}},
};

/* A point of the torus that the fixture makes. */
static MesoVec3 random_point(MesoRandom *random)
{
    float a = 6.2831853e-6f * (float)meso_random_below(random, 1000000);
    float b = 6.2831853e-6f * (float)meso_random_below(random, 1000000);
    float r = 1 + 0.4f * cosf(b);
    return (MesoVec3){r * cosf(a), r * sinf(a), 0.4f * sinf(b)};
}

static void write_steps(MesoStep *steps)
{
    const MesoRange any = {-INFINITY, INFINITY};
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t i = 0; i < OPERATIONS; i++) {
        steps[i] = STEPS[i < 2 ? 2 : meso_random_below(&random, KINDS)];
        steps[i].place = "step";
        steps[i].on = (MesoSelector){.borders = any, .corners = any, .aspect = any, .area = any, .area_share = any,
                                     .share = 1, .has_point = true, .point = random_point(&random)};
    }
}

static void run(uint32_t columns, uint32_t rows)
{
    static MesoStep steps[OPERATIONS];
    MesoArena arena;
    MesoError error;
    struct rusage before, after;
    const MesoPattern pattern = {.steps = steps, .step_count = OPERATIONS};
    const MesoDecorOptions options = {.seed = 1, .region_limit = 1 << 20, .triangle_limit = 1 << 28};
    meso_arena_init(&arena);
    write_steps(steps);
    getrusage(RUSAGE_SELF, &before);
    MesoDecor decor = {.mesh = meso_fixture_torus(columns, rows, 0.4f)};
    uint32_t begun = decor.mesh.triangle_count, leaves = 0, depth = 0;
    double start = meso_seconds();
    if (meso_decor_run(&decor, &arena, &pattern, &options, &error))
        fprintf(stderr, "%s\n", error.message);
    double seconds = meso_seconds() - start;
    getrusage(RUSAGE_SELF, &after);
    for (uint32_t r = 0; r < decor.tree.region_count; r++) {
        leaves += decor.tree.regions[r].child_count == 0;
        depth = decor.tree.regions[r].depth > depth ? decor.tree.regions[r].depth : depth;
    }
    printf("%.2f M triangles: %u operations, %u regions, depth %u, %.2f M triangles in the end: %.1f ms an operation, "
           "%.0f MB at most\n", (double)begun / 1e6, decor.operation_count, leaves, depth,
           (double)decor.mesh.triangle_count / 1e6, 1e3 * seconds / decor.operation_count,
           (double)after.ru_maxrss / 1024);
    meso_triangulation_release(&decor.mesh);
    meso_arena_release(&arena);
}

int main(void)
{
    run(708, 354);
    run(1416, 707);
    return 0;
}
