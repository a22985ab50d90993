/* Pair correlation, against distributions whose own is known. */
#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/replicate/statistics/points_fixture.h"

typedef struct Stage {
    MesoArena arena;
    MesoTriangulation mesh;
} Stage;

static MesoPairCorrelation correlate(Stage *s, const MesoMeshPoint *points, const float *marks, uint32_t count,
                                     double radius)
{
    MesoPairCorrelation out;
    MesoPointSet set = {&s->mesh, s->mesh.positions, points, marks, count};
    CHECK(meso_pair_correlation(&out, &s->arena, &set, &(MesoPairOptions){.radius = radius}, NULL) == MESO_OK);
    CHECK(fabs(out.density * out.area - count) <= 1e-6 * count);
    return out;
}

static void end(Stage *s, MesoMeshPoint *points)
{
    free(points);
    meso_triangulation_release(&s->mesh);
    meso_arena_release(&s->arena);
}

/* Strewn freely: 1, on what is flat, curled up and round, near borders and not. */
static void test_free(void)
{
    for (int shape = 0; shape < 4; shape++) {
        Stage s = {.mesh = shape == 0 ? meso_fixture_sheet(10, 10, 0.1f) : shape == 1 ? meso_fixture_tube(40, 20, 3)
                           : shape == 2 ? meso_fixture_ball(24) : meso_fixture_sheet(1, 1, 1)};
        meso_arena_init(&s.arena);
        MesoMeshPoint *points = meso_strew_freely(&s.mesh, 8000, 3);
        double spacing = sqrt(meso_surface_area(&s.mesh, s.mesh.positions) / 8000);
        MesoPairCorrelation c = correlate(&s, points, NULL, 8000, 5 * spacing);
        for (uint32_t b = 2; b < c.bin_count; b++)
            CHECK(fabs(c.g[b] - 1) < 0.12);
        end(&s, points);
    }
}

/* A Thomas process: g(r) = 1 + exp(-r^2 / 4 s^2) / (4 pi s^2 k), k middles an area. */
static void test_groups(void)
{
    enum { COUNT = 40000, SIDE = 20 };
    const double mean = 10, spread = 0.01, middles = COUNT / mean;
    Stage s = {.mesh = meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE)};
    meso_arena_init(&s.arena);
    MesoMeshPoint *points = meso_strew_groups(SIDE, COUNT, mean, spread, 1);
    MesoPairCorrelation c = correlate(&s, points, NULL, COUNT, 0.04);
    for (uint32_t b = 1; b < c.bin_count; b++) {
        double r = (b + 0.5) * c.radius / c.bin_count;
        double g = 1 + exp(-r * r / (4 * spread * spread)) / (4 * MESO_PI * spread * spread * middles);
        CHECK(fabs(c.g[b] - g) < 0.05 * g);
    }
    end(&s, points);
}

/* None nearer than the discs' radius; many just beyond it. Of a grid, none nearer than its cell. */
static void test_discs(void)
{
    Stage s = {.mesh = meso_fixture_ball(16)};
    meso_arena_init(&s.arena);
    uint32_t count = 4000;
    MesoMeshPoint *points = meso_strew_discs(&s.mesh, &count, 0.75, 5);
    CHECK(count == 4000);
    double spacing = sqrt(meso_surface_area(&s.mesh, s.mesh.positions) / count);
    MesoPairCorrelation c = correlate(&s, points, NULL, count, 3 * spacing);
    for (uint32_t b = 0; b < 6; b++)    /* up to 0.75 */
        CHECK(c.g[b] == 0);
    CHECK(c.g[6] > 1.5 && fabs(c.g[c.bin_count - 1] - 1) < 0.05);
    CHECK(meso_pair_difference(&c, &c) == 0);
    free(points);
    points = meso_strew_freely(&s.mesh, count, 5);
    MesoPairCorrelation d = correlate(&s, points, NULL, count, 3 * spacing);
    CHECK(meso_pair_difference(&c, &d) > 0.25);
    end(&s, points);

    s = (Stage){.mesh = meso_fixture_sheet(7, 7, 1 / 7.0f)};
    meso_arena_init(&s.arena);
    points = meso_strew_grid(7, 40, 0, 1);
    c = correlate(&s, points, NULL, 1600, 0.06);
    for (uint32_t b = 0; b < 9; b++)
        CHECK(c.g[b] == 0);
    CHECK(c.g[9] + c.g[10] > 2);
    end(&s, points);
}

/* Two sheets that lie on each other, joined at one side: what is over a point is not near it. */
static MesoVec3 folded(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    float x = (float)column / (float)squares->columns, y = (float)row / (float)squares->rows;
    return x < 0.5f ? (MesoVec3){2 * x, y, 0} : (MesoVec3){2 - 2 * x, y, 0.001f};
}

static void test_fold(void)
{
    Stage s = {.mesh = meso_fixture_squares(&(MesoFixtureSquares){.columns = 40, .rows = 20, .place = folded})};
    meso_arena_init(&s.arena);
    MesoMeshPoint *points = meso_strew_points(2);
    points[0] = (MesoMeshPoint){0, {1, 0, 0}};
    points[1] = (MesoMeshPoint){2 * 39, {0, 1, 0}};    /* over it */
    MesoPairCorrelation c = correlate(&s, points, NULL, 2, 0.2);
    CHECK(c.g[0] == 0);
    end(&s, points);
}

/* Marks that have nothing to do with places: 1. Big ones alone and small ones in pairs: less where they are near. */
static void test_marks(void)
{
    enum { COUNT = 6000 };
    static float marks[COUNT];
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    Stage s = {.mesh = meso_fixture_sheet(10, 10, 0.1f)};
    meso_arena_init(&s.arena);
    MesoMeshPoint *points = meso_strew_freely(&s.mesh, COUNT, 8);
    for (uint32_t i = 0; i < COUNT; i++)
        marks[i] = (float)(1 + meso_fixture_share(&random));
    MesoPairCorrelation c = correlate(&s, points, marks, COUNT, 0.1);
    for (uint32_t b = 4; b < c.bin_count; b++)
        CHECK(fabs(c.marks[b] - 1) < 0.03);
    for (uint32_t i = 0; i < COUNT; i++) {
        marks[i] = i % 3 ? 1 : 3;
        if (i % 3 == 2)
            points[i] = points[i - 1];
    }
    c = correlate(&s, points, marks, COUNT, 0.03);
    CHECK(c.marks[0] < 0.45 && fabs(c.marks[c.bin_count - 1] - 1) < 0.06);
    end(&s, points);
}

static void test_even(void)
{
    enum { COUNT = 3000 };
    static MesoMeshPoint points[COUNT];
    Stage s = {.mesh = meso_fixture_sheet(3, 1, 1)};
    meso_arena_init(&s.arena);
    meso_even_points(points, COUNT, &s.mesh, s.mesh.positions);
    uint32_t counts[6] = {0};
    for (uint32_t i = 0; i < COUNT; i++)
        counts[points[i].triangle]++;
    for (uint32_t t = 0; t < 6; t++)
        CHECK(counts[t] >= COUNT / 6 - 1 && counts[t] <= COUNT / 6 + 1);
    CHECK(correlate(&s, points, NULL, 0, 1).g[0] == 1);
    end(&s, NULL);
}

int main(void)
{
    test_free();
    test_groups();
    test_discs();
    test_fold();
    test_marks();
    test_even();
    return 0;
}
