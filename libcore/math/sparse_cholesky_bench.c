/* Times of sparse systems: membranes of two rings (L'L + C) on tubes and grids, three right sides. */
#include <stdio.h>
#include <time.h>

#include "libcore/base/check.h"
#include "libcore/math/sparse_cholesky.h"

/* Processor time: a single thread, on machines that have more to do. */
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

typedef struct Grid {
    uint32_t columns, rows;
    int wraps;      /* the columns close to a tube */
} Grid;

/* A node of a grid of triangles and its six neighbours; returns how many there are. */
static uint32_t ring(Grid grid, uint32_t v, uint32_t nodes[7])
{
    static const int steps[7][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {-1, 0}, {-1, -1}, {0, -1}};
    int columns = (int)grid.columns, rows = (int)grid.rows, column = (int)(v % grid.columns);
    int row = (int)(v / grid.columns);
    uint32_t count = 0;
    for (int k = 0; k < 7; k++) {
        int x = column + steps[k][0], y = row + steps[k][1];
        if (grid.wraps)
            x = (x + columns) % columns;
        if (x >= 0 && x < columns && y >= 0 && y < rows)
            nodes[count++] = (uint32_t)(y * columns + x);
    }
    return count;
}

static size_t make(Grid grid, MesoTriplet *triplets)
{
    size_t count = 0;
    for (uint32_t v = 0; v < grid.columns * grid.rows; v++) {
        uint32_t nodes[7], n = ring(grid, v, nodes);
        for (uint32_t a = 0; a < n; a++)
            for (uint32_t b = 0; b < n; b++)
                if (nodes[b] <= nodes[a])
                    triplets[count++] = (MesoTriplet){nodes[a], nodes[b], (a ? -1.0 / (n - 1) : 1) *
                                                                          (b ? -1.0 / (n - 1) : 1)};
        if (v % 7 == 0)
            triplets[count++] = (MesoTriplet){v, v, 1};
    }
    return count;
}

static void time_grid(const char *name, Grid grid, int rounds)
{
    uint32_t count = grid.columns * grid.rows;
    MesoTriplet *triplets = malloc((size_t)count * 30 * sizeof *triplets);
    double *x = malloc((size_t)count * 3 * sizeof *x), best[3] = {1e9, 1e9, 1e9};
    CHECK(triplets && x);
    size_t triplet_count = make(grid, triplets), entries = 0;
    for (int round = 0; round < rounds; round++) {
        MesoArena arena;
        MesoCholesky factor;
        meso_arena_init(&arena);
        double t[4] = {seconds()};
        CHECK(!meso_cholesky_analyse(&factor, &arena, count, triplets, triplet_count, NULL));
        t[1] = seconds();
        CHECK(!meso_cholesky_factor(&factor, triplets, triplet_count, NULL));
        t[2] = seconds();
        for (uint32_t k = 0; k < 3 * count; k++)
            x[k] = k % 11;
        meso_cholesky_solve(&factor, x, 3);
        t[3] = seconds();
        for (int k = 0; k < 3; k++)
            best[k] = t[k + 1] - t[k] < best[k] ? t[k + 1] - t[k] : best[k];
        entries = factor.column_begins[count];
        meso_arena_release(&arena);
    }
    printf("%s, %u unknowns, %zu entries of L: analyse %.3f, factor %.3f, solve 3 %.3f ms\n", name, count, entries,
           1e3 * best[0], 1e3 * best[1], 1e3 * best[2]);
    free(triplets);
    free(x);
}

int main(int argc, char **argv)
{
    time_grid("tube", (Grid){16, 20, 1}, 40);
    time_grid("tube", (Grid){16, 64, 1}, 40);
    time_grid("tube", (Grid){16, 200, 1}, 20);
    time_grid("grid", (Grid){100, 100, 0}, 5);
    if (argc > 1 && !strcmp(argv[1], "large"))
        time_grid("grid", (Grid){316, 316, 0}, 1);
    return 0;
}
