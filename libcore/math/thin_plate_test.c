/* Plates against the dense equations, and what they must reproduce. */
#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/math/thin_plate.h"

enum { MOST = 40 };

static float uniform(MesoRandom *random)
{
    return (float)meso_random_below(random, 1u << 24) / (1u << 23) - 1;
}

static void fill(MesoRandom *random, uint32_t count, MesoVec2 *points, MesoVec3 *values)
{
    for (uint32_t i = 0; i < count; i++) {
        points[i] = (MesoVec2){uniform(random), uniform(random)};
        values[i] = (MesoVec3){uniform(random), uniform(random), uniform(random)};
    }
}

static MesoThinPlate fit(MesoArena *arena, uint32_t count, const MesoVec2 *points, const MesoVec3 *values,
                         double smoothing)
{
    MesoThinPlate plate;
    MesoError error;
    CHECK(!meso_thin_plate_fit(&plate, arena, count, points, values, smoothing, &error));
    return plate;
}

static bool near(MesoVec3 a, MesoVec3 b, float tolerance)
{
    return meso_vec3_length(meso_vec3_sub(a, b)) <= tolerance;
}

/* The usual equations, K + 8 pi smoothing and planes in one matrix, as points stand; logarithms by the C library. */
static double phi(MesoVec2 a, MesoVec2 b)
{
    double x = (double)a.x - b.x, y = (double)a.y - b.y, square = x * x + y * y;
    return square > 0 ? 0.5 * square * log(square) : 0;
}

static void fit_dense(uint32_t n, const MesoVec2 *points, const MesoVec3 *values, double smoothing,
                      double x[MOST + 3][3])
{
    static double a[MOST + 3][MOST + 6];
    uint32_t size = n + 3;
    memset(a, 0, sizeof a);
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j < n; j++)
            a[i][j] = phi(points[i], points[j]) + (i == j ? 8 * MESO_PI * smoothing : 0);
        double planes[3] = {1, points[i].x, points[i].y}, value[3] = {values[i].x, values[i].y, values[i].z};
        for (int k = 0; k < 3; k++) {
            a[i][n + (uint32_t)k] = a[n + (uint32_t)k][i] = planes[k];
            a[i][size + (uint32_t)k] = value[k];
        }
    }
    for (uint32_t k = 0; k < size; k++) {
        uint32_t best = k;
        for (uint32_t i = k; i < size; i++)
            best = fabs(a[i][k]) > fabs(a[best][k]) ? i : best;
        for (uint32_t j = 0; j < size + 3; j++) {
            double t = a[k][j];
            a[k][j] = a[best][j];
            a[best][j] = t;
        }
        for (uint32_t i = 0; i < size; i++) {
            double f = i == k ? 0 : a[i][k] / a[k][k];
            for (uint32_t j = k; j < size + 3; j++)
                a[i][j] -= f * a[k][j];
        }
    }
    for (uint32_t k = 0; k < size; k++)
        for (uint32_t c = 0; c < 3; c++)
            x[k][c] = a[k][size + c] / a[k][k];
}

static MesoVec3 dense_at(uint32_t n, const MesoVec2 *points, double x[MOST + 3][3], MesoVec2 at)
{
    double sum[3];
    for (int c = 0; c < 3; c++) {
        sum[c] = x[n][c] + x[n + 1][c] * at.x + x[n + 2][c] * at.y;
        for (uint32_t i = 0; i < n; i++)
            sum[c] += x[i][c] * phi(at, points[i]);
    }
    return (MesoVec3){(float)sum[0], (float)sum[1], (float)sum[2]};
}

static void test_dense(void)
{
    static const double smoothings[] = {0, 1e-4, 0.1, 10};
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t round = 0; round < 300; round++) {
        static double dense[MOST + 3][3];
        MesoVec2 points[MOST];
        MesoVec3 values[MOST];
        MesoArena arena;
        uint32_t count = 4 + meso_random_below(&random, MOST - 3);
        double smoothing = smoothings[round % 4];
        meso_arena_init(&arena);
        fill(&random, count, points, values);
        MesoThinPlate plate = fit(&arena, count, points, values, smoothing);
        MesoThinPlate again = fit(&arena, count, points, values, smoothing);
        CHECK(!memcmp(plate.weights, again.weights, 3 * (count + 3) * sizeof *plate.weights));
        fit_dense(count, points, values, smoothing, dense);
        for (int k = 0; k < 20; k++) {
            MesoVec2 at = {1.5f * uniform(&random), 1.5f * uniform(&random)};
            MesoVec3 expected = dense_at(count, points, dense, at);
            CHECK(near(meso_thin_plate_at(&plate, at), expected, 1e-5f * (1 + meso_vec3_length(expected))));
        }
        for (uint32_t i = 0; i < count && smoothing == 0; i++)
            CHECK(near(meso_thin_plate_at(&plate, points[i]), values[i], 2e-6f));
        meso_arena_release(&arena);
    }
}

/* What does not bend comes out as it went in, everywhere, with any smoothing, at any size and distance. */
static void test_affine(void)
{
    MesoRandom random;
    MesoArena arena;
    meso_random_init(&random, 2, 0);
    meso_arena_init(&arena);
    for (uint32_t round = 0; round < 200; round++) {
        MesoVec2 points[MOST], slopes[3] = {{0, 0}};
        MesoVec3 values[MOST];
        uint32_t count = 3 + meso_random_below(&random, MOST - 2);
        float scale = round % 3 == 0 ? 1 : round % 3 == 1 ? 1e-4f : 1e4f, far = 5 * scale * uniform(&random);
        fill(&random, count, points, values);
        for (int k = 0; k < 3 && round % 2; k++)
            slopes[k] = (MesoVec2){uniform(&random) / scale, uniform(&random) / scale};
        for (uint32_t i = 0; i < count; i++) {
            points[i] = (MesoVec2){points[i].x * scale + far, points[i].y * scale};
            values[i] = (MesoVec3){1 + slopes[0].x * points[i].x + slopes[0].y * points[i].y,
                                   2 + slopes[1].x * points[i].x + slopes[1].y * points[i].y,
                                   3 + slopes[2].x * points[i].x + slopes[2].y * points[i].y};
        }
        MesoThinPlate plate = fit(&arena, count, points, values, round % 5 ? 0 : 0.3 * scale * scale);
        for (int k = 0; k < 20; k++) {
            MesoVec2 at = {far + scale * uniform(&random), scale * uniform(&random)};
            MesoVec3 expected = {1 + slopes[0].x * at.x + slopes[0].y * at.y, 2 + slopes[1].x * at.x + slopes[1].y * at.y,
                                 3 + slopes[2].x * at.x + slopes[2].y * at.y};
            CHECK(near(meso_thin_plate_at(&plate, at), expected, count < 8 ? 1e-3f : 5e-5f));
        }
    }
    meso_arena_release(&arena);
}

/* A size of the plane changes nothing where smoothing follows it. */
static void test_scale(void)
{
    MesoVec2 points[MOST], larger[MOST];
    MesoVec3 values[MOST];
    MesoRandom random;
    MesoArena arena;
    meso_random_init(&random, 3, 0);
    meso_arena_init(&arena);
    fill(&random, MOST, points, values);
    for (uint32_t i = 0; i < MOST; i++)
        larger[i] = (MesoVec2){1024 * points[i].x, 1024 * points[i].y};
    MesoThinPlate a = fit(&arena, MOST, points, values, 0.01), b = fit(&arena, MOST, larger, values, 0.01 * 1024 * 1024);
    CHECK(!memcmp(a.weights, b.weights, 3 * (MOST + 3) * sizeof *a.weights));
    MesoVec3 p = meso_thin_plate_at(&a, (MesoVec2){0.1f, 0.2f}), q = meso_thin_plate_at(&b, (MesoVec2){102.4f, 204.8f});
    CHECK(near(p, q, 1e-6f));
    meso_arena_release(&arena);
}

/* None, one, several in one place, two, and many on a line. */
static void test_few(void)
{
    MesoArena arena;
    MesoVec3 values[MOST] = {{1, 2, 3}, {3, 2, 1}, {5, 5, 5}};
    MesoVec2 points[MOST] = {{0.25f, 4}, {0.25f, 4}, {0.25f, 4}}, far = {-7, 9};
    meso_arena_init(&arena);
    MesoThinPlate plate = fit(&arena, 0, NULL, NULL, 0);
    CHECK(near(meso_thin_plate_at(&plate, far), (MesoVec3){0, 0, 0}, 0));
    plate = fit(&arena, 1, points, values, 0);
    CHECK(near(meso_thin_plate_at(&plate, far), values[0], 1e-6f));
    plate = fit(&arena, 3, points, values, 0);
    CHECK(near(meso_thin_plate_at(&plate, far), (MesoVec3){3, 3, 3}, 1e-5f));

    /* along the line from (1, 1) to (3, 2) values go from 1 to 2, across it they stay */
    points[0] = (MesoVec2){1, 1};
    points[1] = (MesoVec2){3, 2};
    values[0] = (MesoVec3){1, 0, 0};
    values[1] = (MesoVec3){2, 0, 0};
    plate = fit(&arena, 2, points, values, 0);
    CHECK(near(meso_thin_plate_at(&plate, points[0]), values[0], 1e-6f));
    CHECK(near(meso_thin_plate_at(&plate, (MesoVec2){5, 3}), (MesoVec3){3, 0, 0}, 1e-5f));
    CHECK(near(meso_thin_plate_at(&plate, (MesoVec2){5 - 1, 3 + 2}), (MesoVec3){3, 0, 0}, 1e-5f));

    for (uint32_t i = 0; i < MOST; i++) {
        float t = (float)i / MOST;
        points[i] = (MesoVec2){0.3f + 2 * t, 0.7f - 5 * t};
        values[i] = (MesoVec3){sinf(6 * t), t, 1};
    }
    plate = fit(&arena, MOST, points, values, 0);
    for (uint32_t i = 0; i < MOST; i++) {
        CHECK(near(meso_thin_plate_at(&plate, points[i]), values[i], 1e-5f));
        MesoVec2 left = {points[i].x - 0.5f, points[i].y - 0.2f}, right = {points[i].x + 0.5f, points[i].y + 0.2f};
        CHECK(near(meso_thin_plate_at(&plate, left), meso_thin_plate_at(&plate, right), 1e-4f));
    }
    meso_arena_release(&arena);
}

/* Coincident points between others: the mean of their values there, the others met. Hardly apart from a line: met. */
static void test_awkward(void)
{
    MesoRandom random;
    MesoArena arena;
    meso_random_init(&random, 4, 0);
    meso_arena_init(&arena);
    for (uint32_t round = 0; round < 100; round++) {
        MesoVec2 points[MOST];
        MesoVec3 values[MOST];
        fill(&random, MOST, points, values);
        points[7] = points[3];
        MesoVec3 mean = meso_vec3_lerp(values[3], values[7], 0.5f);
        MesoThinPlate plate = fit(&arena, MOST, points, values, 0);
        for (uint32_t i = 0; i < MOST; i++)
            CHECK(near(meso_thin_plate_at(&plate, points[i]), i == 3 || i == 7 ? mean : values[i], 1e-4f));

        float width = powf(10, -(float)(round % 9));
        for (uint32_t i = 0; i < MOST; i++)
            points[i] = (MesoVec2){(float)i / MOST, 0.5f * (float)i / MOST + width * uniform(&random)};
        plate = fit(&arena, MOST, points, values, 0);
        for (uint32_t i = 0; i < MOST; i++)
            CHECK(near(meso_thin_plate_at(&plate, points[i]), values[i], 1e-3f));
    }
    meso_arena_release(&arena);
}

static void test_refused(void)
{
    MesoVec2 point = {NAN, 0};
    MesoVec3 value = {0, 0, 0};
    MesoThinPlate plate;
    MesoArena arena;
    meso_arena_init(&arena);
    CHECK(meso_thin_plate_fit(&plate, &arena, 1, &point, &value, 0, NULL) == MESO_ERR_INPUT);
    point.x = 0;
    CHECK(meso_thin_plate_fit(&plate, &arena, 1, &point, &value, -1, NULL) == MESO_ERR_INPUT);
    value.z = INFINITY;
    CHECK(meso_thin_plate_fit(&plate, &arena, 1, &point, &value, 0, NULL) == MESO_ERR_INPUT);
    meso_arena_release(&arena);
}

int main(void)
{
    test_dense();
    test_affine();
    test_scale();
    test_few();
    test_awkward();
    test_refused();
    return 0;
}
