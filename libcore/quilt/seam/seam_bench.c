/* Times of a seam on a grid, milliseconds of the process, the best of some: between old and new a wide free band whose
 * costs are noise, all of it and its parts.
 *
 *   seam_bench [SIDE...]
 */
#include <stdio.h>
#include <time.h>

#include "libcore/base/check.h"
#include "libcore/math/noise.h"
#include "libcore/quilt/seam/seam_cut.h"
#include "libcore/quilt/seam/seam_line.h"

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double least(double a, double b)
{
    return a < b ? a : b;
}

/* New in a disk in the middle, old at the rim. */
static void fill(uint8_t *states, uint16_t *costs, uint32_t side)
{
    for (uint32_t c = 0; c < side * side; c++) {
        float x = (float)(c % side) / (float)side, y = (float)(c / side) / (float)side;
        float r = sqrtf((x - 0.5f) * (x - 0.5f) + (y - 0.5f) * (y - 0.5f));
        states[c] = r < 0.2f ? MESO_SEAM_NEW : r > 0.45f ? MESO_SEAM_OLD : MESO_SEAM_FREE;
        costs[c] = (uint16_t)(30000 + 29000 * meso_noise((MesoVec3){9 * x, 9 * y, 0.5f}, 3));
    }
}

static void measure(uint32_t side)
{
    MesoArena arena;
    meso_arena_init(&arena);
    uint8_t *states = MESO_NEW(&arena, uint8_t, side * side, NULL);
    uint8_t *sides = MESO_NEW(&arena, uint8_t, side * side, NULL);
    uint16_t *costs = MESO_NEW(&arena, uint16_t, side * side, NULL);
    CHECK(states && sides && costs);
    fill(states, costs, side);
    double all = 1e9, traced = 1e9, measured = 1e9;
    uint32_t count = 0;
    for (int round = 0; round < 15; round++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        MesoSeamGrid grid = {.columns = side, .rows = side, .cell = 1};
        MesoSeamLine line;
        double start = cpu_seconds();
        CHECK(meso_seam_cut(&grid, &arena, states, costs, NULL) == MESO_OK);
        all = least(all, cpu_seconds() - start);
        for (uint32_t c = 0; c < side * side; c++)
            sides[c] = grid.values[c] > 0;
        start = cpu_seconds();
        CHECK(meso_seam_line_trace(&line, &arena, sides, side, side, NULL) == MESO_OK);
        traced = least(traced, cpu_seconds() - start);
        start = cpu_seconds();
        CHECK(meso_seam_line_distances(grid.values, &arena, &line, sides, side, side, NULL) == MESO_OK);
        measured = least(measured, cpu_seconds() - start);
        count = line.count;
        meso_arena_rewind(&arena, mark);
    }
    printf("seam on %u x %u cells, %u points: %.2f ms; line %.2f ms, distances %.2f ms\n", side, side, count, 1e3 * all,
           1e3 * traced, 1e3 * measured);
    meso_arena_release(&arena);
}

int main(int argc, char **argv)
{
    const uint32_t sides[3] = {40, 64, 128};
    for (int i = 1; i < argc; i++)
        measure((uint32_t)atoi(argv[i]));
    for (int i = 0; i < 3 && argc == 1; i++)
        measure(sides[i]);
    return 0;
}
