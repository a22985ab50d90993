#include "libcore/math/thin_plate.h"

#include <float.h>
#include <stdbool.h>
#include <string.h>

/* ---- the kernel ---- */

/*
 * log(x) of normal x > 0, by 2 atanh((m - 1) / (m + 1)) with m in [sqrt 1/2, sqrt 2]: within 3e-16 of 1 + |log x|. That
 * of the C library differs from machine to machine in its last bit. Without branches or calls: compilers take several
 * at once.
 */
static inline double logarithm(double x)
{
    static const double LN_2 = 0.69314718055994530942, SQRT_HALF = 0.70710678118654752440;
    const uint64_t half = UINT64_C(0x3fe) << 52, digits = (UINT64_C(1) << 52) - 1;
    const uint64_t whole = UINT64_C(0x433) << 52;   /* 2^52: its last digits count */
    uint64_t bits, exponent_bits;
    double m, exponent;
    memcpy(&bits, &x, sizeof bits);
    exponent_bits = bits >> 52 | whole;
    bits = (bits & digits) | half;
    memcpy(&m, &bits, sizeof m);
    memcpy(&exponent, &exponent_bits, sizeof exponent);
    exponent -= 0x1p52 + 0x3fe;
    bool low = m < SQRT_HALF;
    m = low ? 2 * m : m;
    exponent = low ? exponent - 1 : exponent;
    double z = (m - 1) / (m + 1), q = z * z, sum = 0;
    sum = sum * q + 1.0 / 21;   /* q <= 0.0295: the next term is below 1e-18 */
    sum = sum * q + 1.0 / 19;
    sum = sum * q + 1.0 / 17;
    sum = sum * q + 1.0 / 15;
    sum = sum * q + 1.0 / 13;
    sum = sum * q + 1.0 / 11;
    sum = sum * q + 1.0 / 9;
    sum = sum * q + 1.0 / 7;
    sum = sum * q + 1.0 / 5;
    sum = sum * q + 1.0 / 3;
    sum = sum * q + 1;
    return exponent * LN_2 + 2 * z * sum;
}

enum { CHUNK = 64 };    /* so many kernels at once */

/*
 * r^2 log r from one place to `count` others, in which what bends without limit of its own is least (Green's function
 * of the plate, times 8 pi).
 */
static inline __attribute__((always_inline)) void do_kernels(double *restrict values, double x, double y,
                                                             const double *restrict xs, const double *restrict ys,
                                                             uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        double square = (x - xs[i]) * (x - xs[i]) + (y - ys[i]) * (y - ys[i]);
        double value = 0.5 * square * logarithm(square);
        values[i] = square >= DBL_MIN ? value : 0;
    }
}

/* The same operations, and so the same bytes, on wider registers. */
#ifdef __x86_64__
__attribute__((target("avx2"))) static void kernels_avx2(double *restrict values, double x, double y,
                                                         const double *restrict xs, const double *restrict ys,
                                                         uint32_t count)
{
    do_kernels(values, x, y, xs, ys, count);
}
#endif

static void kernels(double *restrict values, double x, double y, const double *restrict xs, const double *restrict ys,
                    uint32_t count)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) {
        kernels_avx2(values, x, y, xs, ys, count);
        return;
    }
#endif
    do_kernels(values, x, y, xs, ys, count);
}

/* ---- planes: what does not bend ---- */

enum { PLANES = 3 };

/*
 * 1, x, y at the points, and then the longer first, are made a triangle R of `rank` rows by Householder's reflections
 * H_k = I - 2 v v', in turn. Weights w of the kernel must have P'w = 0: so w = H (0, u).
 */
typedef struct Planes {
    uint32_t count, rank;
    double *columns;            /* [PLANES * count] P, and then R */
    double *reflections;        /* [PLANES * count] v, 0 before place k */
    int order[PLANES];          /* columns as they were taken */
} Planes;

/* Points on a line to within what floats tell a few hundred extents away from 0: less than this of their extent. */
static const double LEAST_WIDTH = 1e-5;

static double dot(const double *a, const double *b, uint32_t begin, uint32_t end)
{
    double sum = 0;
    for (uint32_t i = begin; i < end; i++)
        sum += a[i] * b[i];
    return sum;
}

/* x - 2 v (v'x) */
static void reflect(const double *v, double *x, uint32_t begin, uint32_t end)
{
    double twice = 2 * dot(v, x, begin, end);
    for (uint32_t i = begin; i < end; i++)
        x[i] -= twice * v[i];
}

static void swap_columns(Planes *planes, uint32_t a, uint32_t b)
{
    int column = planes->order[a];
    planes->order[a] = planes->order[b];
    planes->order[b] = column;
}

static double *column_of(const Planes *planes, uint32_t k)
{
    return planes->columns + (size_t)planes->order[k] * planes->count;
}

/* Takes 1, then the longest column that is left; false where none is longer than rounding. */
static bool reflect_next(Planes *planes, uint32_t k)
{
    uint32_t n = planes->count, best = k;
    double square = 0;
    for (uint32_t c = k; c < (k ? PLANES : 1); c++) {
        double here = dot(column_of(planes, c), column_of(planes, c), k, n);
        if (here > square) {
            square = here;
            best = c;
        }
    }
    if (!(square > LEAST_WIDTH * LEAST_WIDTH * n))
        return false;
    swap_columns(planes, k, best);
    const double *column = column_of(planes, k);
    double *v = planes->reflections + (size_t)k * n, length = sqrt(square);
    memcpy(v + k, column + k, (n - k) * sizeof *v);
    v[k] += column[k] < 0 ? -length : length;
    double inverse = 1 / sqrt(dot(v, v, k, n));
    for (uint32_t i = k; i < n; i++)
        v[i] *= inverse;
    for (uint32_t c = k; c < PLANES; c++)
        reflect(v, column_of(planes, c), k, n);
    return true;
}

static void find_planes(Planes *planes, const double *places)
{
    uint32_t n = planes->count;
    for (uint32_t i = 0; i < n; i++) {
        planes->columns[i] = 1;
        planes->columns[n + i] = places[i];
        planes->columns[2 * n + i] = places[n + i];
    }
    for (int c = 0; c < PLANES; c++)
        planes->order[c] = c;
    while (planes->rank < PLANES && planes->rank < n && reflect_next(planes, planes->rank))
        planes->rank++;
}

/* ---- dense matrices ---- */

/* K + ridge / repeats on the diagonal, by rows. */
static void fill_kernel(double *matrix, const double *places, const uint32_t *repeats, uint32_t n, double ridge)
{
    const double *xs = places, *ys = places + n;
    for (uint32_t i = 0; i < n; i++) {
        kernels(matrix + (size_t)i * n, xs[i], ys[i], xs, ys, i);
        for (uint32_t j = 0; j < i; j++)
            matrix[(size_t)j * n + i] = matrix[(size_t)i * n + j];
        matrix[(size_t)i * n + i] = ridge / repeats[i];
    }
}

/* H A H for the reflection v: A - v w' - w v' with w = 2 (A v - v (v'A v)). */
static void reflect_matrix(double *matrix, const double *v, double *w, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        w[i] = 2 * dot(matrix + (size_t)i * n, v, 0, n);
    double along = dot(v, w, 0, n);
    for (uint32_t i = 0; i < n; i++)
        w[i] -= along * v[i];
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++)
            matrix[(size_t)i * n + j] -= v[i] * w[j] + w[i] * v[j];
}

/*
 * A = U'U of the block from `begin` on, in its upper triangle, row by row, so that the inner loop runs along rows. False
 * where a pivot is not positive.
 */
static bool factor_block(double *matrix, uint32_t begin, uint32_t n)
{
    for (uint32_t k = begin; k < n; k++) {
        double *restrict row = matrix + (size_t)k * n, pivot = row[k];
        if (!(pivot > 0 && pivot <= DBL_MAX))
            return false;
        double inverse = 1 / sqrt(pivot);
        for (uint32_t j = k; j < n; j++)
            row[j] *= inverse;
        for (uint32_t i = k + 1; i < n; i++) {
            double *restrict lower = matrix + (size_t)i * n, f = row[i];
            for (uint32_t j = i; j < n; j++)
                lower[j] -= f * row[j];
        }
    }
    return true;
}

static void solve_block(const double *matrix, double *x, uint32_t begin, uint32_t n)
{
    for (uint32_t k = begin; k < n; k++) {
        const double *row = matrix + (size_t)k * n;
        x[k] /= row[k];
        for (uint32_t j = k + 1; j < n; j++)
            x[j] -= row[j] * x[k];
    }
    for (uint32_t k = n; k-- > begin;) {
        const double *row = matrix + (size_t)k * n;
        x[k] = (x[k] - dot(row, x, k + 1, n)) / row[k];
    }
}

/* ---- fitting ---- */

typedef struct Fit {
    Planes planes;
    double *values;     /* [3 * count] means of what coincides */
    uint32_t *repeats;  /* [count] how many points one stands for */
    double *matrix;     /* [count^2] H (K + ridge) H; behind `rank`, its factor */
    double *work;       /* [count] */
    double *right;      /* [count] */
    double *weights;    /* [count + PLANES] of one coordinate */
} Fit;

static MesoStatus allocate_matrix(Fit *fit, MesoArena *scratch, uint32_t count, MesoError *error)
{
    fit->planes.count = count;
    if (!(fit->planes.columns = MESO_NEW(scratch, double, PLANES * (size_t)count, error)) ||
        !(fit->planes.reflections = MESO_NEW(scratch, double, PLANES * (size_t)count, error)) ||
        !(fit->matrix = MESO_NEW(scratch, double, (size_t)count * count, error)) ||
        !(fit->work = MESO_NEW(scratch, double, count, error)) ||
        !(fit->right = MESO_NEW(scratch, double, count, error)) ||
        !(fit->weights = MESO_NEW(scratch, double, (size_t)count + PLANES, error)))
        return MESO_ERR_MEMORY;
    return MESO_OK;
}

/*
 * Points at one place are one, with the mean of their values and their smoothing shared: the sum of squares is the same
 * but for a constant, and the equations are regular. `merged` [count]; returns how many are left.
 */
static uint32_t merge_points(MesoVec2 *merged, Fit *fit, uint32_t count, const MesoVec2 *points, const MesoVec3 *values)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = 0;
        while (j < left && (merged[j].x != points[i].x || merged[j].y != points[i].y))
            j++;
        if (j == left)
            merged[left++] = points[i];
        fit->repeats[j]++;
        double value[3] = {values[i].x, values[i].y, values[i].z};
        for (size_t c = 0; c < 3; c++)
            fit->values[3 * (size_t)j + c] += (value[c] - fit->values[3 * (size_t)j + c]) / fit->repeats[j];
    }
    return left;
}

/* The middle and half the larger side of the points' box; 1 where that is 0. */
static void measure(MesoThinPlate *plate)
{
    double low[2] = {DBL_MAX, DBL_MAX}, high[2] = {-DBL_MAX, -DBL_MAX};
    for (uint32_t i = 0; i < plate->count; i++) {
        double here[2] = {plate->points[i].x, plate->points[i].y};
        for (int k = 0; k < 2; k++) {
            low[k] = here[k] < low[k] ? here[k] : low[k];
            high[k] = here[k] > high[k] ? here[k] : high[k];
        }
    }
    plate->scale = 0;
    for (int k = 0; k < 2 && plate->count; k++) {
        plate->centre[k] = 0.5 * (low[k] + high[k]);
        plate->scale = fmax(plate->scale, 0.5 * (high[k] - low[k]));
    }
    if (!(plate->scale > 0))
        plate->scale = 1;
}

static void place(const MesoThinPlate *plate, const MesoVec2 *points, uint32_t count, double *xs, double *ys)
{
    for (uint32_t i = 0; i < count; i++) {
        xs[i] = ((double)points[i].x - plate->centre[0]) / plate->scale;
        ys[i] = ((double)points[i].y - plate->centre[1]) / plate->scale;
    }
}

/*
 * The same along the points' line, and without slope across it: of the two columns the one that was taken is t, the
 * other o = ratio t as far as the points tell, both from their means, which the first row of R has.
 */
static void turn_along_line(const Planes *planes, double slopes[PLANES])
{
    const double *one = column_of(planes, 0), *taken = column_of(planes, 1), *other = column_of(planes, 2);
    double ratio = other[1] / taken[1], part = 1 / (1 + ratio * ratio), slope = slopes[1];
    slopes[1] = slope * part;
    slopes[2] = slope * part * ratio;
    slopes[0] += (slope - slopes[1]) * taken[0] / one[0] - slopes[2] * other[0] / one[0];
}

/*
 * The weights of one coordinate from fit->right, its values: with b = H values, those of the kernel are H (0, u) with
 * B u = b behind `rank`, where B is that block; those of planes solve R a = b - (H (K + ridge) H) (0, u) before it.
 */
static void fit_coordinate(const Fit *fit)
{
    const Planes *planes = &fit->planes;
    double *weights = fit->weights;
    uint32_t n = planes->count, rank = planes->rank;
    double *right = fit->right, slopes[PLANES] = {0};
    for (uint32_t k = 0; k < rank; k++)
        reflect(planes->reflections + (size_t)k * n, right, k, n);
    solve_block(fit->matrix, right, rank, n);
    for (uint32_t k = rank; k-- > 0;) {
        slopes[k] = right[k] - dot(fit->matrix + (size_t)k * n, right, rank, n);
        for (uint32_t c = k + 1; c < rank; c++)
            slopes[k] -= column_of(planes, c)[k] * slopes[c];
        slopes[k] /= column_of(planes, k)[k];
    }
    if (rank == 2)
        turn_along_line(planes, slopes);
    for (uint32_t k = 0; k < PLANES; k++)
        weights[n + (uint32_t)planes->order[k]] = slopes[k];
    memset(right, 0, rank * sizeof *right);
    for (uint32_t k = rank; k-- > 0;)
        reflect(planes->reflections + (size_t)k * n, right, 0, n);
    memcpy(weights, right, n * sizeof *right);
}

/* Against rounding where points nearly coincide, and far below what bends between others. */
static const double LEAST_RIDGE = 1e-10;

static MesoStatus fit_plate(MesoThinPlate *plate, Fit *fit, double smoothing, MesoError *error)
{
    uint32_t n = plate->count;
    place(plate, plate->points, n, plate->places, plate->places + n);
    find_planes(&fit->planes, plate->places);
    double ridge = 8 * MESO_PI * smoothing / (plate->scale * plate->scale);
    fill_kernel(fit->matrix, plate->places, fit->repeats, n, fmax(ridge, LEAST_RIDGE));
    for (uint32_t k = 0; k < fit->planes.rank; k++)
        reflect_matrix(fit->matrix, fit->planes.reflections + (size_t)k * n, fit->work, n);
    if (!factor_block(fit->matrix, fit->planes.rank, n))
        return meso_fail(error, MESO_ERR_INPUT, "no plate goes through %u points of extent %g with smoothing %g", n,
                         plate->scale, smoothing);
    for (size_t c = 0; c < 3; c++) {
        for (uint32_t i = 0; i < n; i++)
            fit->right[i] = fit->values[3 * (size_t)i + c];
        fit_coordinate(fit);
        for (uint32_t i = 0; i < n + PLANES; i++)
            plate->weights[3 * (size_t)i + c] = fit->weights[i];
    }
    return MESO_OK;
}

static MesoStatus check_numbers(uint32_t count, const MesoVec2 *points, const MesoVec3 *values, double smoothing,
                                MesoError *error)
{
    if (!(smoothing >= 0 && smoothing <= DBL_MAX))
        return meso_fail(error, MESO_ERR_INPUT, "the smoothing %g of a plate is not a number from 0 on", smoothing);
    for (uint32_t i = 0; i < count; i++)
        if (!isfinite(points[i].x) || !isfinite(points[i].y) || !meso_vec3_finite(values[i]))
            return meso_fail(error, MESO_ERR_INPUT, "point %u of a plate is not finite", i);
    return MESO_OK;
}

MesoStatus meso_thin_plate_fit(MesoThinPlate *plate, MesoArena *arena, uint32_t count, const MesoVec2 *points,
                               const MesoVec3 *values, double smoothing, MesoError *error)
{
    MesoStatus status = check_numbers(count, points, values, smoothing, error);
    if (status)
        return status;
    *plate = (MesoThinPlate){0};
    MesoVec2 *merged = MESO_NEW(arena, MesoVec2, count, error);
    plate->weights = merged ? MESO_NEW(arena, double, 3 * ((size_t)count + PLANES), error) : NULL;
    plate->places = plate->weights ? MESO_NEW(arena, double, 2 * (size_t)count, error) : NULL;
    if (!plate->places)
        return MESO_ERR_MEMORY;

    Fit fit = {0};
    MesoArenaMark mark = meso_arena_mark(arena);
    fit.values = MESO_NEW(arena, double, 3 * (size_t)count, error);
    fit.repeats = fit.values ? MESO_NEW(arena, uint32_t, count, error) : NULL;
    status = fit.repeats ? MESO_OK : MESO_ERR_MEMORY;
    if (!status) {
        plate->count = merge_points(merged, &fit, count, points, values);
        plate->points = merged;
        measure(plate);
        status = allocate_matrix(&fit, arena, plate->count, error);
    }
    if (!status)
        status = fit_plate(plate, &fit, smoothing, error);
    meso_arena_rewind(arena, mark);
    return status;
}

MesoVec3 meso_thin_plate_at(const MesoThinPlate *plate, MesoVec2 point)
{
    double x, y, values[CHUNK], sum[3];
    place(plate, &point, 1, &x, &y);
    const double *planes = plate->weights + 3 * (size_t)plate->count;
    for (int c = 0; c < 3; c++)
        sum[c] = planes[c] + planes[3 + c] * x + planes[6 + c] * y;
    for (uint32_t begin = 0; begin < plate->count; begin += CHUNK) {
        uint32_t count = plate->count - begin < CHUNK ? plate->count - begin : CHUNK;
        const double *weights = plate->weights + 3 * (size_t)begin;
        kernels(values, x, y, plate->places + begin, plate->places + plate->count + begin, count);
        for (size_t i = 0; i < count; i++)
            for (size_t c = 0; c < 3; c++)
                sum[c] += weights[3 * i + c] * values[i];
    }
    return (MesoVec3){(float)sum[0], (float)sum[1], (float)sum[2]};
}
