/*
 * Times of layers of bumpy sheets: directions by normals and for least stretch, and the map over an atlas; with the
 * stretch before and after. Of the process, of one core, the best of some.
 *
 *   shell_bench
 */
#include <stdio.h>
#include <time.h>

#include "libcore/shell/shell_fixture.h"
#include "libcore/shell/shell_map.h"

enum { ROUNDS = 3 };

static double cpu_milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static void time_layer(uint32_t columns, float height)
{
    MesoTriangulation mesh = meso_fixture_bumpy(columns, columns, 0.3f);
    MesoVec3 *directions = malloc(mesh.vertex_count * sizeof *directions);
    MesoPrismReport report = {0};
    MesoArena arena;
    double best[2] = {INFINITY, INFINITY};
    CHECK(directions);
    meso_arena_init(&arena);
    for (uint32_t round = 0; round < 2 * ROUNDS; round++) {
        double start = cpu_milliseconds();
        MesoPrismOptions options = {0, height, round % 2, 0};
        CHECK(meso_prisms_build(directions, &report, &arena, &mesh, &options, NULL) == MESO_OK);
        best[round % 2] = fmin(best[round % 2], cpu_milliseconds() - start);
    }
    printf("%6u triangles, height %.2f edges: normals %.1f ms, least stretch %.1f ms, %.4f to %.4f, %u lowered\n",
           mesh.triangle_count, 10 * (double)height, best[0], best[1], report.stretch_before, report.stretch_after,
           report.limited_count);
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
    free(directions);
}

static void time_map(uint32_t columns, float height)
{
    MesoTriangulation mesh = meso_fixture_bumpy(columns, columns, 0.3f);
    MesoVec3 *directions = malloc(mesh.vertex_count * sizeof *directions);
    MesoArena arena;
    MesoAtlas atlas;
    MesoShellMap map;
    MesoShellMapReport report = {0};
    double best[2] = {INFINITY, INFINITY};
    CHECK(directions);
    meso_arena_init(&arena);
    CHECK(meso_atlas_build(&atlas, &arena, &mesh, &(MesoChartOptions){0, 4, 4}, NULL) == MESO_OK);
    CHECK(meso_prisms_build(directions, NULL, &arena, &mesh, &(MesoPrismOptions){0, height, false, 0}, NULL) == MESO_OK);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        double start = cpu_milliseconds();
        CHECK(meso_shell_map_build(&map, &report, &arena, &mesh, &atlas, directions,
                                   &(MesoShellMapOptions){.high = height}, NULL) == MESO_OK);
        best[0] = fmin(best[0], cpu_milliseconds() - start);
        start = cpu_milliseconds();
        for (uint32_t t = 0; t < mesh.triangle_count; t++)
            CHECK(meso_vec3_finite(meso_shell_map_point(&map, t, 0.2f, 0.5f, 0.7f * height)));
        best[1] = fmin(best[1], cpu_milliseconds() - start);
    }
    printf("%6u triangles, height %.2f edges, %u charts: map %.1f ms, %.4f to %.4f; a point %.2f us\n",
           mesh.triangle_count, 10 * (double)height, atlas.chart_count, best[0], report.stretch_before,
           report.stretch_after, 1e3 * best[1] / mesh.triangle_count);
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
    free(directions);
}

int main(void)
{
    const uint32_t columns[] = {22, 50, 158};
    for (uint32_t i = 0; i < 3; i++)
        for (float height = 0.1f; height < 0.5f; height *= 2)
            time_layer(columns[i], height);
    for (uint32_t i = 0; i < 3; i++)
        time_map(columns[i], 0.2f);
    return 0;
}
