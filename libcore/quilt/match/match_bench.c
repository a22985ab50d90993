/* Rates of tables of costs: building, searching, pairs; of the process, the best of some rounds.
 *
 *   match_bench [THREADS]
 */
#include <stdio.h>
#include <time.h>

#include "libcore/base/clock.h"
#include "libcore/quilt/match/match_fixture.h"
#include "libcore/quilt/match/match_search.h"

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static MesoArena arena;

static void time_build(MesoMatchField *field, const MesoSwatch *swatch, float voxel, uint32_t threads)
{
    double best = 1e9, wall = 1e9;
    MesoArenaMark mark = meso_arena_mark(&arena);
    for (int round = 0; round < 5; round++) {
        meso_arena_rewind(&arena, mark);
        double start = cpu_seconds(), clock = meso_seconds();
        CHECK(meso_match_field_build(field, &arena, swatch, 1 / swatch->mean_edge, voxel, threads, NULL) == MESO_OK);
        best = cpu_seconds() - start < best ? cpu_seconds() - start : best;
        wall = meso_seconds() - clock < wall ? meso_seconds() - clock : wall;
    }
    printf("table of %u x %u x %u x %u for %u faces: %.0f ms of the process, %.0f ms by the clock\n", field->count[0],
           field->count[1], field->count[2], field->bins, swatch->triangle_count, 1e3 * best, 1e3 * wall);
}

/* Points of another weave in a window of the tile. */
static uint32_t pick_points(MesoMatchPoint *points, uint32_t count, const MesoSwatch *from, float low, float high)
{
    MesoRandom random;
    uint32_t kept = 0;
    meso_random_init(&random, 3, 0);
    for (uint32_t tries = 0; kept < count && tries < 1000 * count; tries++) {
        uint32_t v = meso_random_below(&random, from->vertex_count);
        MesoVec3 p = from->positions[v];
        if (p.x >= low && p.x <= high && p.y >= low && p.y <= high)
            points[kept++] = (MesoMatchPoint){p, from->normals[v]};
    }
    return kept;
}

static void time_search(const MesoMatchField *field, const MesoSwatch *from, uint32_t shifts)
{
    enum { POINTS = 1000 };
    static MesoMatchPoint points[POINTS];
    float side = field->swatch->size.x - (float)(shifts - 1) * field->voxel;
    uint32_t count = pick_points(points, POINTS, from, 0, side), found = 0;
    MesoMatch matches[8];
    double best = 1e9;
    for (int round = 0; round < 20; round++) {
        double start = cpu_seconds();
        CHECK(meso_match_search(matches, &found, 8, 2 * field->voxel, field, &arena, points, NULL, count,
                                (MesoVec2){0, 0}, (MesoVec2){side, side}, 0, 1, NULL) == MESO_OK);
        best = cpu_seconds() - start < best ? cpu_seconds() - start : best;
    }
    double start = cpu_seconds();
    meso_match_refine(matches, found, 1, field, points, NULL, count, 1);
    double refined = cpu_seconds() - start;
    printf("search of %u points by %u shifts: %.3f ms, best of 8 by faces %.1f ms: %g at %g, %g\n", count,
           shifts * shifts, 1e3 * best, 1e3 * refined, (double)matches[0].cost, (double)matches[0].shift.x, (double)matches[0].shift.y);
}

static void time_pairs(const MesoMatchField *field, const MesoSwatch *from)
{
    double best = 1e9, exact = 0, sampled = 0;
    volatile float kept = 0;
    uint32_t sample = 0;
    for (int round = 0; round < 5; round++) {
        double start = cpu_seconds();
        for (uint32_t v = 0; v < from->vertex_count; v++)
            kept = meso_match_at(field, (MesoMatchPoint){from->positions[v], from->normals[v]}, NULL);
        best = cpu_seconds() - start < best ? cpu_seconds() - start : best;
    }
    (void)kept;
    for (uint32_t v = 0; v < from->vertex_count; v += 37, sample++) {
        MesoMatchPoint point = {from->positions[v], from->normals[v]};
        exact += (double)meso_match_exact(field->swatch, field->lambda, point, NULL);
        sampled += (double)meso_match_at(field, point, NULL);
    }
    printf("pairs: %.2f M/s; mean D %.4f, exact %.4f\n", 1e-6 * from->vertex_count / best, sampled / sample,
           exact / sample);
}

int main(int argc, char **argv)
{
    uint32_t threads = argc > 1 ? (uint32_t)atoi(argv[1]) : 1;
    MesoSwatch swatch, other;
    MesoMatchField field;
    meso_arena_init(&arena);
    meso_fixture_weave(&swatch, &arena, 5, 64, 12, 0.06f, 1);
    meso_fixture_weave(&other, &arena, 5, 64, 12, 0.06f, 2);
    time_build(&field, &swatch, 5.0f / 80, threads);
    time_search(&field, &other, 11);
    time_search(&field, &other, 40);
    time_pairs(&field, &other);
    meso_arena_release(&arena);
    return 0;
}
