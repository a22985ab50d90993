/* The sparse factor against a dense one, on random matrices, grids and hard patterns. */
#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/math/minimum_degree.h"
#include "libcore/math/sparse_cholesky.h"

#include <math.h>
#include <stdlib.h>

enum { MOST = 60, ROOM = 4096, WIDTH = 4 };

typedef struct Matrix {
    uint32_t count;
    size_t triplet_count;
    MesoTriplet triplets[ROOM];
    double dense[MOST][MOST];
} Matrix;

static double uniform(MesoRandom *random)
{
    return (double)meso_random_below(random, 1u << 30) / (1u << 29) - 1;
}

static void add(Matrix *matrix, uint32_t row, uint32_t column, double value)
{
    CHECK(matrix->triplet_count < ROOM && column <= row);
    matrix->triplets[matrix->triplet_count++] = (MesoTriplet){row, column, value};
    matrix->dense[row][column] += value;
    if (row != column)
        matrix->dense[column][row] += value;
}

/* Sums of squares of few unknowns: half definite; with the diagonal, definite. */
static void fill(Matrix *matrix, MesoRandom *random, uint32_t count, uint32_t squares)
{
    *matrix = (Matrix){.count = count};
    for (uint32_t s = 0; s < squares; s++) {
        uint32_t v[3];
        double w[3];
        for (int k = 0; k < 3; k++) {
            v[k] = meso_random_below(random, count);
            w[k] = uniform(random);
        }
        for (int a = 0; a < 3; a++)
            for (int b = 0; b <= a; b++) {
                uint32_t low = v[a] < v[b] ? v[a] : v[b], high = v[a] < v[b] ? v[b] : v[a];
                add(matrix, high, low, (a != b && low == high ? 2 : 1) * w[a] * w[b]);
            }
    }
    for (uint32_t k = 0; k < count; k++)
        add(matrix, k, k, 0.05 + fabs(uniform(random)));
}

/* Gauss's elimination with the largest pivots: another route than by symmetry. */
static void solve_dense(const Matrix *matrix, double *x, uint32_t width)
{
    static double a[MOST][MOST];
    uint32_t n = matrix->count;
    memcpy(a, matrix->dense, sizeof a);
    for (uint32_t k = 0; k < n; k++) {
        uint32_t best = k;
        for (uint32_t i = k; i < n; i++)
            best = fabs(a[i][k]) > fabs(a[best][k]) ? i : best;
        for (uint32_t j = 0; j < n; j++) {
            double t = a[k][j];
            a[k][j] = a[best][j];
            a[best][j] = t;
        }
        for (uint32_t c = 0; c < width; c++) {
            double t = x[k * width + c];
            x[k * width + c] = x[best * width + c];
            x[best * width + c] = t;
        }
        for (uint32_t i = 0; i < n; i++) {
            double f = i == k ? 0 : a[i][k] / a[k][k];
            for (uint32_t j = k; j < n; j++)
                a[i][j] -= f * a[k][j];
            for (uint32_t c = 0; c < width; c++)
                x[i * width + c] -= f * x[k * width + c];
        }
    }
    for (uint32_t k = 0; k < n; k++)
        for (uint32_t c = 0; c < width; c++)
            x[k * width + c] /= a[k][k];
}

static void check_solutions(const MesoCholesky *factor, const Matrix *matrix, MesoRandom *random)
{
    for (uint32_t width = 1; width <= WIDTH; width++) {
        double x[MOST * WIDTH], y[MOST * WIDTH];
        for (uint32_t k = 0; k < matrix->count * width; k++)
            x[k] = y[k] = uniform(random);
        meso_cholesky_solve(factor, x, width);
        solve_dense(matrix, y, width);
        for (uint32_t k = 0; k < matrix->count * width; k++)
            CHECK(fabs(x[k] - y[k]) <= 1e-9 * (1 + fabs(y[k])));
    }
}

/* The next number of column `i`, of which the work row loses its part; what the diagonal loses. */
static double take_column(const MesoCholesky *factor, uint32_t i, size_t *end, double *work)
{
    double y = work[factor->order[i]], value = y / factor->pivots[i];
    work[factor->order[i]] = 0;
    for (size_t c = factor->column_begins[i]; c < *end; c++)
        work[factor->column_rows[factor->column_lists[i] + (c - factor->column_begins[i])]] -= factor->values[c] * y;
    CHECK(!memcmp(&value, &factor->values[(*end)++], sizeof value));
    return value * y;
}

/* Row by row, a column of the rows above after the other: the same bytes. */
static void check_by_columns(const MesoCholesky *factor, const MesoTriplet *triplets, size_t triplet_count)
{
    uint32_t count = factor->count;
    double *work = calloc(count, sizeof *work);
    size_t *ends = malloc(count * sizeof *ends);
    CHECK(work && ends);
    memcpy(ends, factor->column_begins, count * sizeof *ends);
    for (uint32_t k = 0; k < count; k++) {
        double diagonal = 0;
        for (size_t t = 0; t < triplet_count; t++) {
            uint32_t a = factor->places[triplets[t].row], b = factor->places[triplets[t].column];
            if ((a > b ? a : b) != k)
                continue;
            if (a == b)
                diagonal += triplets[t].value;
            else
                work[factor->order[a < b ? a : b]] += triplets[t].value;
        }
        for (size_t e = factor->row_begins[k]; e < factor->row_begins[k + 1]; e++)
            for (uint32_t i = factor->row_bunches[e]; i < k && i < factor->bunch_ends[factor->row_bunches[e]]; i++)
                diagonal -= take_column(factor, i, &ends[i], work);
        CHECK(!memcmp(&diagonal, &factor->pivots[k], sizeof diagonal));
    }
    free(work);
    free(ends);
}

static void test_random(void)
{
    static Matrix matrix;
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t round = 0; round < 400; round++) {
        MesoArena arena;
        MesoCholesky factor, again;
        uint32_t count = 1 + meso_random_below(&random, MOST);
        meso_arena_init(&arena);
        fill(&matrix, &random, count, meso_random_below(&random, 3 * count / 2 + 1));
        CHECK(!meso_cholesky_analyse(&factor, &arena, count, matrix.triplets, matrix.triplet_count, NULL));
        CHECK(!meso_cholesky_factor(&factor, matrix.triplets, matrix.triplet_count, NULL));
        check_solutions(&factor, &matrix, &random);
        check_by_columns(&factor, matrix.triplets, matrix.triplet_count);

        /* the same bytes again */
        CHECK(!meso_cholesky_analyse(&again, &arena, count, matrix.triplets, matrix.triplet_count, NULL));
        CHECK(!meso_cholesky_factor(&again, matrix.triplets, matrix.triplet_count, NULL));
        double x[MOST], y[MOST];
        for (uint32_t k = 0; k < count; k++)
            x[k] = y[k] = uniform(&random);
        meso_cholesky_solve(&factor, x, 1);
        meso_cholesky_solve(&again, y, 1);
        CHECK(!memcmp(x, y, count * sizeof *x));

        /* other numbers in the same places */
        for (size_t t = 0; t < matrix.triplet_count; t++)
            matrix.triplets[t].value *= 3;
        for (uint32_t a = 0; a < count; a++)
            for (uint32_t b = 0; b < count; b++)
                matrix.dense[a][b] *= 3;
        CHECK(!meso_cholesky_factor(&factor, matrix.triplets, matrix.triplet_count, NULL));
        check_solutions(&factor, &matrix, &random);
        meso_arena_release(&arena);
    }
}

/* Nothing; one; a star, whose centre must come last; a full matrix. */
static void test_patterns(void)
{
    static Matrix matrix;
    MesoRandom random;
    MesoArena arena;
    MesoCholesky factor;
    meso_random_init(&random, 2, 0);
    meso_arena_init(&arena);
    CHECK(!meso_cholesky_analyse(&factor, &arena, 0, NULL, 0, NULL) && !meso_cholesky_factor(&factor, NULL, 0, NULL));
    meso_cholesky_solve(&factor, NULL, 3);

    matrix = (Matrix){.count = MOST};
    for (uint32_t k = 0; k < MOST; k++)
        add(&matrix, k, k, MOST);
    for (uint32_t k = 1; k < MOST; k++)
        add(&matrix, k, 0, 1);
    CHECK(!meso_cholesky_analyse(&factor, &arena, MOST, matrix.triplets, matrix.triplet_count, NULL));
    CHECK(factor.column_begins[MOST] == MOST - 1);
    CHECK(!meso_cholesky_factor(&factor, matrix.triplets, matrix.triplet_count, NULL));
    check_solutions(&factor, &matrix, &random);

    for (uint32_t k = 0; k < MOST; k++)
        for (uint32_t j = 1; j < k; j++)
            add(&matrix, k, j, 0.5);
    CHECK(!meso_cholesky_analyse(&factor, &arena, MOST, matrix.triplets, matrix.triplet_count, NULL));
    CHECK(factor.column_begins[MOST] == MOST * (MOST - 1) / 2);
    CHECK(!meso_cholesky_factor(&factor, matrix.triplets, matrix.triplet_count, NULL));
    check_solutions(&factor, &matrix, &random);
    meso_arena_release(&arena);
}

static void test_refused(void)
{
    MesoArena arena;
    MesoCholesky factor;
    MesoError error;
    meso_arena_init(&arena);
    MesoTriplet sides[] = {{0, 0, 1}, {1, 1, 2}, {2, 2, 1}, {1, 0, -1}, {2, 1, -1}};    /* constants have no energy */
    CHECK(!meso_cholesky_analyse(&factor, &arena, 3, sides, 5, &error));
    CHECK(meso_cholesky_factor(&factor, sides, 5, &error) == MESO_ERR_INPUT);
    sides[0].value = 1.5;
    CHECK(!meso_cholesky_factor(&factor, sides, 5, &error));
    sides[0].value = NAN;
    CHECK(meso_cholesky_factor(&factor, sides, 5, &error) == MESO_ERR_INPUT);
    sides[0].value = -1;
    CHECK(meso_cholesky_factor(&factor, sides, 5, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a matrix is not positive definite at row 0 of 3");
    MesoTriplet other[] = {{0, 0, 1}, {1, 1, 2}, {2, 2, 1}, {2, 0, 0.5}}, outside = {1, 2, 1};
    CHECK(meso_cholesky_factor(&factor, other, 4, &error) == MESO_ERR_INTERNAL);
    CHECK(meso_cholesky_factor(&factor, other, 6, &error) == MESO_ERR_INTERNAL);
    CHECK(meso_cholesky_analyse(&factor, &arena, 3, &outside, 1, &error) == MESO_ERR_INTERNAL);
    meso_arena_release(&arena);
}

/* All nodes once, and on a grid far fewer entries than in the order of its rows, which has SIDE^3. */
static void test_grid_order(void)
{
    enum { SIDE = 60, COUNT = SIDE * SIDE };
    static MesoTriplet triplets[3 * COUNT];
    static uint8_t met[COUNT];
    size_t triplet_count = 0;
    MesoArena arena;
    MesoCholesky factor;
    for (uint32_t v = 0; v < COUNT; v++) {
        triplets[triplet_count++] = (MesoTriplet){v, v, 4.01};
        if (v % SIDE)
            triplets[triplet_count++] = (MesoTriplet){v, v - 1, -1};
        if (v >= SIDE)
            triplets[triplet_count++] = (MesoTriplet){v, v - SIDE, -1};
    }
    meso_arena_init(&arena);
    CHECK(!meso_cholesky_analyse(&factor, &arena, COUNT, triplets, triplet_count, NULL));
    for (uint32_t k = 0; k < COUNT; k++)
        CHECK(!met[factor.order[k]]++);
    CHECK(factor.column_begins[COUNT] < SIDE * SIDE * SIDE / 3);
    CHECK(!meso_cholesky_factor(&factor, triplets, triplet_count, NULL));
    check_by_columns(&factor, triplets, triplet_count);
    static double x[COUNT], y[COUNT];
    for (uint32_t v = 0; v < COUNT; v++)
        x[v] = sin(v);
    for (size_t t = 0; t < triplet_count; t++) {
        y[triplets[t].row] += triplets[t].value * x[triplets[t].column];
        if (triplets[t].row != triplets[t].column)
            y[triplets[t].column] += triplets[t].value * x[triplets[t].row];
    }
    meso_cholesky_solve(&factor, y, 1);
    for (uint32_t v = 0; v < COUNT; v++)
        CHECK(fabs(x[v] - y[v]) < 1e-11);
    meso_arena_release(&arena);
}

int main(void)
{
    test_random();
    test_patterns();
    test_refused();
    test_grid_order();
    return 0;
}
