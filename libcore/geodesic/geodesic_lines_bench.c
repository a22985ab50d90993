/* Lines and points on a sphere of a million triangles. */
#include <time.h>

#include "libcore/base/clock.h"
#include "libcore/base/parallel.h"
#include "libcore/geodesic/cells/voronoi.h"
#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/geodesic/geodesic_samples.h"
#include "libcore/geodesic/isoline.h"
#include "libcore/geodesic/streamline.h"

enum { DIVISIONS = 224, ROUNDS = 5, LEVELS = 100 };

/* Of the process: other work on the machine does not count. */
static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static float *distances_from(const MesoTriangulation *mesh, MesoVec3 pole)
{
    float *field = malloc(mesh->vertex_count * sizeof *field);
    CHECK(field);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        field[v] = acosf(fminf(1, fmaxf(-1, meso_vec3_dot(mesh->positions[v], pole))));
    return field;
}

static void bench_isolines(const MesoTriangulation *mesh)
{
    float *field = distances_from(mesh, (MesoVec3){0.48f, 0.6f, 0.64f}), levels[LEVELS];
    MesoIsolineQuery query = {NULL, field, levels, LEVELS};
    double best = 1e9;
    uint32_t segment_count = 0;
    for (uint32_t l = 0; l < LEVELS; l++)
        levels[l] = (float)MESO_PI * ((float)l + 0.5f) / LEVELS;
    for (int i = 0; i < ROUNDS; i++) {
        MesoArena arena;
        MesoCutLines lines = {0};
        meso_arena_init(&arena);
        double start = cpu_seconds();
        CHECK(meso_isolines_trace(&lines, &arena, mesh, &query, NULL) == MESO_OK);
        best = fmin(best, cpu_seconds() - start);
        segment_count = lines.segment_count;
        meso_arena_release(&arena);
    }
    printf("isolines, %d levels on %u triangles: %.1f ms (%u segments)\n", LEVELS, mesh->triangle_count, 1e3 * best,
           segment_count);
    free(field);
}

static void bench_cells(const MesoTriangulation *mesh, MesoGeodesicSolver *solver, uint32_t seed_count,
                        uint32_t threads)
{
    MesoRandom random;
    MesoMeshPoint *seeds = malloc(seed_count * sizeof *seeds);
    MesoVoronoiQuery query = {.seed_count = seed_count, .seeds = seeds, .threads = threads};
    double best = 1e9, best_wall = 1e9;
    CHECK(seeds);
    meso_random_init(&random, 1, 0);
    for (uint32_t i = 0; i < seed_count; i++)
        seeds[i] = (MesoMeshPoint){meso_random_below(&random, mesh->triangle_count), {0.25f, 0.25f, 0.5f}};
    for (int i = 0; i < ROUNDS; i++) {
        MesoArena arena;
        MesoCutLines lines = {0};
        meso_arena_init(&arena);
        double start = cpu_seconds(), start_wall = meso_seconds();
        CHECK(meso_voronoi_trace(&lines, NULL, NULL, &arena, mesh, solver, &query, NULL) == MESO_OK);
        best = fmin(best, cpu_seconds() - start);
        best_wall = fmin(best_wall, meso_seconds() - start_wall);
        meso_arena_release(&arena);
    }
    printf("Voronoi cells, %u on %u triangles: %.1f ms by %u threads, %.1f ms of processors\n", seed_count,
           mesh->triangle_count, 1e3 * best_wall, threads ? threads : meso_parallel_cores(), 1e3 * best);
    free(seeds);
}

static void bench_samples(const MesoTriangulation *mesh, MesoGeodesicSolver *solver, uint32_t count)
{
    float *distance = malloc(mesh->vertex_count * sizeof *distance);
    MesoSampleQuery query = {.start = MESO_NO_INDEX, .count = count};
    double best = 1e9;
    CHECK(distance);
    for (int i = 0; i < ROUNDS; i++) {
        MesoArena arena;
        MesoSamples samples;
        meso_arena_init(&arena);
        double start = cpu_seconds();
        CHECK(meso_geodesic_sample(&samples, distance, &arena, mesh, solver, &query, NULL) == MESO_OK);
        best = fmin(best, cpu_seconds() - start);
        meso_arena_release(&arena);
    }
    printf("farthest points, %u on %u triangles: %.1f ms\n", count, mesh->triangle_count, 1e3 * best);
    free(distance);
}

static void bench_streams(const MesoTriangulation *mesh)
{
    enum { STREAMS = 1000 };
    float *field = distances_from(mesh, (MesoVec3){0.48f, 0.6f, 0.64f});
    MesoMeshPoint starts[STREAMS];
    MesoStreamQuery query = {.field = field, .start_count = 0, .starts = starts};
    double best = 1e9;
    uint32_t segment_count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count && query.start_count < STREAMS; t++)
        if (field[mesh->corners[3 * t]] < 0.2f)
            starts[query.start_count++] = (MesoMeshPoint){t, {0.3f, 0.3f, 0.4f}};
    for (int i = 0; i < ROUNDS; i++) {
        MesoArena arena;
        MesoStreamReport report;
        MesoCutLines lines = {0};
        meso_arena_init(&arena);
        double start = cpu_seconds();
        CHECK(meso_streamlines_trace(&lines, &report, &arena, mesh, &query, NULL) == MESO_OK);
        best = fmin(best, cpu_seconds() - start);
        segment_count = lines.segment_count;
        meso_arena_release(&arena);
    }
    printf("streamlines, %u on %u triangles: %.1f ms (%u segments)\n", query.start_count, mesh->triangle_count,
           1e3 * best, segment_count);
    free(field);
}

int main(void)
{
    MesoTriangulation mesh = meso_fixture_sphere(DIVISIONS, 0.3f, 7);
    MesoGeodesicSolver *solver;
    CHECK(meso_geodesic_init(&solver, &mesh, MESO_GEODESIC_FRONTS, NULL) == MESO_OK);
    bench_isolines(&mesh);
    bench_streams(&mesh);
    for (uint32_t count = 10; count <= 10000; count *= 10)
        bench_samples(&mesh, solver, count);
    for (uint32_t count = 10; count <= 100000; count *= 10)
        for (uint32_t threads = 0; threads < 2; threads++)
            bench_cells(&mesh, solver, count, threads);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
    return 0;
}
