/* Times of cuts on the triangles of a grid, three in five of them free, with weights as random as they come. */
#include <stdio.h>
#include <time.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/math/min_cut.h"

/* Processor time: a single thread, on machines that have more to do. */
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Two triangles a cell: nodes 2c below the diagonal and 2c + 1 above. The first and last fifth of columns are fixed. */
static void time_cut(uint32_t columns, uint32_t rows, int rounds)
{
    uint32_t count = 2 * columns * rows, edge_count = 0;
    uint32_t *source = calloc(count, sizeof *source), *sink = calloc(count, sizeof *sink);
    uint8_t *sides = malloc(count);
    MesoCutEdge *edges = malloc(3 * (size_t)columns * rows * sizeof *edges);
    MesoRandom random;
    uint64_t value = 0;
    double best = 1e9;
    CHECK(source && sink && sides && edges);
    meso_random_init(&random, 1, 0);
    for (uint32_t cell = 0; cell < columns * rows; cell++) {
        uint32_t column = cell % columns, row = cell / columns;
        for (uint32_t v = 2 * cell; v < 2 * cell + 2; v++) {
            source[v] = column < columns / 5 ? MESO_CUT_FIXED : 0;
            sink[v] = column >= columns - columns / 5 ? MESO_CUT_FIXED : 0;
        }
        edges[edge_count++] = (MesoCutEdge){2 * cell, 2 * cell + 1, 1 + meso_random_below(&random, 1000)};
        if (column + 1 < columns)
            edges[edge_count++] = (MesoCutEdge){2 * cell, 2 * (cell + 1) + 1, 1 + meso_random_below(&random, 1000)};
        if (row + 1 < rows)
            edges[edge_count++] = (MesoCutEdge){2 * cell + 1, 2 * (cell + columns), 1 + meso_random_below(&random, 1000)};
    }
    for (int round = 0; round < rounds; round++) {
        MesoArena arena;
        meso_arena_init(&arena);
        double begin = seconds();
        CHECK(!meso_min_cut(sides, &value, &arena, count, source, sink, edges, edge_count, NULL));
        double took = seconds() - begin;
        best = took < best ? took : best;
        meso_arena_release(&arena);
    }
    printf("cut of %u triangles: %.2f ms, value %llu\n", count, 1e3 * best, (unsigned long long)value);
    free(source);
    free(sink);
    free(sides);
    free(edges);
}

int main(void)
{
    time_cut(32, 16, 40);
    time_cut(100, 50, 20);
    time_cut(250, 100, 5);
    time_cut(500, 250, 2);
    return 0;
}
