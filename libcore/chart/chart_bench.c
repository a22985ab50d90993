/*
 * Times of charts around many triangles of a bumpy sheet: growth, conformal map and rigid steps, by the triangles of a
 * chart; and of an atlas of all. Of the process, of one core, the best of some.
 *
 *   chart_bench
 */
#include <stdio.h>
#include <time.h>

#include "libcore/chart/atlas.h"
#include "libcore/chart/chart_fixture.h"

enum { SEEDS = 40, ROUNDS = 5 };

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Charts of about `wanted` triangles: of seeds spread over the sheet, all in one time. */
static void time_charts(MesoChartMaker *maker, uint32_t wanted, uint32_t relaxations, bool unfold)
{
    MesoChartOptions options = {0.158f * sqrtf((float)wanted / 6.2831853f), 4, relaxations};
    maker->unfolds = unfold;
    double best = INFINITY, triangles = 0, ratio = 1, shrunk = 0;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        MesoArena arena;
        meso_arena_init(&arena);
        double start = cpu_seconds();
        triangles = shrunk = 0;
        for (uint32_t i = 0; i < SEEDS; i++) {
            MesoChart chart;
            uint32_t seed = (uint32_t)((uint64_t)maker->mesh->triangle_count * (2 * i + 1) / (2 * SEEDS));
            CHECK(meso_chart_grow(&chart, &arena, maker, seed, &options, NULL) == MESO_OK);
            triangles += chart.triangle_count;
            shrunk += chart.radius < options.radius;
            ratio = fmax(ratio, chart.area_ratio);
        }
        best = fmin(best, cpu_seconds() - start);
        meso_arena_release(&arena);
    }
    printf("%4u triangles wanted, %u rigid steps%s: %6.0f triangles, %.3f ms a chart, %.0f of %d shrunk, "
           "ratio to %.2f\n", wanted, relaxations, unfold ? " from triangles unfolded" : "", triangles / SEEDS, 1e3 * best / SEEDS, shrunk,
           (int)SEEDS, ratio);
}

static void time_atlas(const MesoTriangulation *mesh)
{
    MesoArena arena;
    MesoAtlas atlas;
    MesoChartOptions options = {0, 4, 4};
    meso_arena_init(&arena);
    double start = cpu_seconds();
    CHECK(meso_atlas_build(&atlas, &arena, mesh, &options, NULL) == MESO_OK);
    printf("atlas of %u triangles: %u charts, ratio %.2f, %.2f s\n", mesh->triangle_count, atlas.chart_count,
           (double)atlas.largest_ratio, cpu_seconds() - start);
    meso_arena_release(&arena);
}

int main(void)
{
    const uint32_t wanted[] = {1, 150, 300, 600, 1000, 2000, 4000};
    MesoTriangulation mesh = meso_fixture_bumpy(160, 160, 0.3f);
    MesoChartMaker maker;
    CHECK(meso_chart_maker_init(&maker, &mesh, NULL) == MESO_OK);
    for (uint32_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
        for (uint32_t way = 0; way < 3; way++)
            time_charts(&maker, wanted[i], way ? 4 : 0, way == 2);
    meso_chart_maker_release(&maker);
    time_atlas(&mesh);
    meso_triangulation_release(&mesh);
    return 0;
}
