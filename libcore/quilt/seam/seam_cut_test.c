#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/quilt/seam/seam_cut.h"
#include "libcore/quilt/seam/seam_line.h"

static MesoArena arena;

static MesoSeamGrid cut(uint32_t columns, uint32_t rows, float cell, const uint8_t *states, const uint16_t *costs)
{
    MesoSeamGrid grid = {.columns = columns, .rows = rows, .low = {-1, 2}, .cell = cell};
    CHECK(meso_seam_cut(&grid, &arena, states, costs, NULL) == MESO_OK);
    return grid;
}

static MesoVec2 centre(const MesoSeamGrid *grid, uint32_t i, uint32_t j)
{
    return (MesoVec2){grid->low.x + ((float)i + 0.5f) * grid->cell, grid->low.y + ((float)j + 0.5f) * grid->cell};
}

/* Old on the left, new on the right, free between. */
static void fill_columns(uint8_t *states, uint32_t columns, uint32_t rows, uint32_t old, uint32_t new)
{
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++)
            states[j * columns + i] = i < old ? MESO_SEAM_OLD : i >= columns - new ? MESO_SEAM_NEW : MESO_SEAM_FREE;
}

/* A cheap column takes the seam, straight, and the values are distances from it. */
static void test_cheap_column(void)
{
    enum { N = 16 };
    uint8_t states[N * N];
    uint16_t costs[N * N];
    fill_columns(states, N, N, 1, 1);
    for (int c = 0; c < N * N; c++)
        costs[c] = c % N == 9 || c % N == 10 ? 0 : 60000;
    MesoSeamGrid grid = cut(N, N, 0.25f, states, costs);
    for (uint32_t j = 0; j < N; j++)
        for (uint32_t i = 0; i < N; i++) {
            CHECK(fabsf(grid.values[j * N + i] - 0.25f * ((float)i - 9.5f)) < 1e-5f);
            CHECK(fabsf(meso_seam_at(&grid, centre(&grid, i, j)) - grid.values[j * N + i]) < 1e-5f);
        }
    MesoVec2 far = {100, 2.3f}, between = {centre(&grid, 4, 4).x + 0.1f, centre(&grid, 4, 4).y + 0.07f};
    CHECK(fabsf(meso_seam_at(&grid, far) - 1.375f) < 1e-5f);
    CHECK(fabsf(meso_seam_at(&grid, between) - (grid.values[4 * N + 4] + 0.1f)) < 1e-5f);
}

/* One side alone, and what no side is joined to. */
static void test_one_side(void)
{
    uint8_t states[12];
    uint16_t costs[12] = {0};
    memset(states, MESO_SEAM_FREE, 12);
    MesoSeamGrid grid = cut(4, 3, 0.5f, states, costs);
    for (int c = 0; c < 12; c++)
        CHECK(grid.values[c] == 3.5f);
    states[3] = MESO_SEAM_NEW;
    grid = cut(4, 3, 0.5f, states, costs);
    for (int c = 0; c < 12; c++)
        CHECK(grid.values[c] == 3.5f);
    states[3] = MESO_SEAM_OLD;
    grid = cut(4, 3, 0.5f, states, costs);
    for (int c = 0; c < 12; c++)
        CHECK(grid.values[c] == -3.5f);
    MesoSeamGrid none = {.columns = 0, .rows = 3, .cell = 1};
    CHECK(meso_seam_cut(&none, &arena, states, costs, NULL) == MESO_ERR_INTERNAL);
}

/* Grids of one row or column have a seam, too. */
static void test_thin(void)
{
    const uint8_t states[5] = {MESO_SEAM_OLD, MESO_SEAM_FREE, MESO_SEAM_FREE, MESO_SEAM_FREE, MESO_SEAM_NEW};
    const uint16_t costs[5] = {9, 9, 1, 1, 9};
    MesoSeamGrid row = cut(5, 1, 1, states, costs), column = cut(1, 5, 1, states, costs);
    for (uint32_t i = 0; i < 5; i++)
        CHECK(row.values[i] == (float)i - 2.5f && column.values[i] == (float)i - 2.5f);
    CHECK(meso_seam_at(&row, (MesoVec2){2, 7}) == 0 && meso_seam_at(&column, (MesoVec2){7, 5}) == 0);
}

/* ---- smoothness ---- */

enum { SIDE = 64 };

/* Sides of a grid by a function that is positive on side 1. */
static void fill_sides(uint8_t *sides, double (*f)(double x, double y))
{
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++)
            sides[j * SIDE + i] = f(i, j) > 0;
}

/* The largest angle between two segments that follow each other, and the largest value of |f| on the line. */
static void measure_line(const MesoSeamLine *line, double (*f)(double x, double y), double *turn, double *off)
{
    *turn = *off = 0;
    for (uint32_t i = 0; i < line->count; i++) {
        MesoVec2 p = line->points[i];
        *off = fmax(*off, fabs(f(p.x, p.y)));
        if (line->next[i] == MESO_NO_INDEX || line->previous[i] == MESO_NO_INDEX)
            continue;
        MesoVec2 a = meso_vec2_sub(p, line->points[line->previous[i]]);
        MesoVec2 b = meso_vec2_sub(line->points[line->next[i]], p);
        if (meso_vec2_length(a) > 0.1f && meso_vec2_length(b) > 0.1f)
            *turn = fmax(*turn, fabs(atan2(meso_vec2_cross(a, b), (double)a.x * b.x + (double)a.y * b.y)));
    }
}

static double slope_tenth(double x, double y) { return (0.1 * (x - 32) - (y - 32.2)) / sqrt(1.01); }
static double slope_third(double x, double y) { return (0.31 * (x - 32) - (y - 32.2)) / sqrt(1.0961); }
static double slope_one(double x, double y) { return (x - y - 0.3) / sqrt(2); }
static double circle(double x, double y) { return 20 - sqrt((x - 31.3) * (x - 31.3) + (y - 32.2) * (y - 32.2)); }

static double square_to(MesoVec2 p, MesoVec2 a, MesoVec2 b)
{
    double x = (double)b.x - a.x, y = (double)b.y - a.y, u = (double)p.x - a.x, v = (double)p.y - a.y;
    double square = x * x + y * y, t = square > 0 ? fmin(fmax((u * x + v * y) / square, 0), 1) : 0;
    return (u - t * x) * (u - t * x) + (v - t * y) * (v - t * y);
}

static void check_distances(const MesoSeamLine *line, const float *values, const uint8_t *sides, uint32_t n)
{
    for (uint32_t c = 0; c < n * n; c++) {
        double least = 1e30;
        MesoVec2 p = {(float)(c % n), (float)(c / n)};
        for (uint32_t i = 0; i < line->count; i++)
            if (line->next[i] != MESO_NO_INDEX)
                least = fmin(least, square_to(p, line->points[i], line->points[line->next[i]]));
        double more = fabs((double)values[c]) - sqrt(least);
        CHECK(more > -1e-4 && more < (sqrt(least) < 2 ? 1e-4 : 0.1));
        CHECK(values[c] != 0 && (values[c] > 0) == (sides[c] == 1));
    }
}

/* Straight lines come out straight, circles round. */
static void test_smooth(void)
{
    static const struct {
        double (*f)(double x, double y);
        double turn, off;
    } cases[4] = {{slope_tenth, 0.04, 0.7}, {slope_third, 0.02, 0.5}, {slope_one, 0.02, 0.5}, {circle, 0.15, 0.5}};
    uint8_t sides[SIDE * SIDE];
    static float values[SIDE * SIDE];
    for (int k = 0; k < 4; k++) {
        MesoSeamLine line;
        double turn, off;
        fill_sides(sides, cases[k].f);
        CHECK(meso_seam_line_trace(&line, &arena, sides, SIDE, SIDE, NULL) == MESO_OK);
        measure_line(&line, cases[k].f, &turn, &off);
        CHECK(turn < cases[k].turn && off < cases[k].off);
        CHECK(meso_seam_line_distances(values, &arena, &line, sides, SIDE, SIDE, NULL) == MESO_OK);
        check_distances(&line, values, sides, SIDE);
    }
}

/* ---- random grids ---- */

/* Distances against brute force, on sides without any order: islands, corners that touch, lines that end on the
 * border. */
static void test_distances(void)
{
    enum { N = 24 };
    MesoRandom random;
    uint8_t sides[N * N];
    float values[N * N];
    meso_random_init(&random, 5, 0);
    for (int round = 0; round < 20; round++) {
        MesoSeamLine line;
        MesoArenaMark mark = meso_arena_mark(&arena);
        for (int c = 0; c < N * N; c++)
            sides[c] = meso_random_below(&random, (uint32_t)(2 + round)) == 0;
        CHECK(meso_seam_line_trace(&line, &arena, sides, N, N, NULL) == MESO_OK);
        CHECK(meso_seam_line_distances(values, &arena, &line, sides, N, N, NULL) == MESO_OK);
        check_distances(&line, values, sides, N);
        meso_arena_rewind(&arena, mark);
    }
}

/* What a cut by the signs of `values` costs. */
static double cost_of(const float *values, const uint16_t *costs, int n)
{
    double sum = 0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            for (int k = 0; k < 4; k++) {
                int x = i + (k != 1) - 2 * (k == 3), y = j + (k != 0);
                if (x >= 0 && x < n && y < n && (values[j * n + i] > 0) != (values[y * n + x] > 0))
                    sum += (k < 2 ? 17 : 12) * (1.0 + costs[j * n + i] + costs[y * n + x]);
            }
    return sum;
}

/* No other choice of the free cells costs less: all of them, on tiny grids. Fixed cells keep their sides. */
static void test_least(void)
{
    enum { N = 4, CELLS = N * N };
    MesoRandom random;
    meso_random_init(&random, 9, 0);
    for (int round = 0; round < 60; round++) {
        uint8_t states[CELLS], free_cells[CELLS], free_count = 0;
        uint16_t costs[CELLS];
        float values[CELLS];
        for (uint8_t c = 0; c < CELLS; c++) {
            uint32_t kind = meso_random_below(&random, 7);
            states[c] = (uint8_t)(kind < 2 ? kind : MESO_SEAM_FREE);
            costs[c] = (uint16_t)(meso_random_below(&random, 2) ? meso_random_below(&random, 65536) : 0);
            if (states[c] == MESO_SEAM_FREE)
                free_cells[free_count++] = c;
        }
        if (!memchr(states, MESO_SEAM_OLD, CELLS) || !memchr(states, MESO_SEAM_NEW, CELLS))
            continue;
        MesoSeamGrid grid = cut(N, N, 1, states, costs);
        double found = cost_of(grid.values, costs, N);
        for (uint32_t bits = 0; bits < 1u << free_count; bits++) {
            for (int c = 0; c < CELLS; c++)
                values[c] = states[c] == MESO_SEAM_NEW ? 1 : -1;
            for (int k = 0; k < free_count; k++)
                values[free_cells[k]] = bits >> k & 1 ? 1 : -1;
            CHECK(cost_of(values, costs, N) >= found);
        }
        for (int c = 0; c < CELLS; c++)
            CHECK(states[c] == MESO_SEAM_FREE || (grid.values[c] > 0) == (states[c] == MESO_SEAM_NEW));
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_cheap_column();
    test_one_side();
    test_thin();
    test_smooth();
    test_distances();
    test_least();
    meso_arena_release(&arena);
    return 0;
}
