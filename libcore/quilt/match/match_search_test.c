#include "libcore/quilt/match/match_fixture.h"
#include "libcore/quilt/match/match_search.h"
#include "libcore/quilt/match/triangle_distance.h"

static MesoArena arena;

/* A small weave and its table. */
static MesoSwatch swatch;
static MesoMatchField field;

enum { MOST_POINTS = 24, TILE = 2, SPAN = 6 };

/* ---- points ---- */

static MesoVec3 random_direction(MesoRandom *random)
{
    float x = meso_fixture_float(random, -1, 1), y = meso_fixture_float(random, -1, 1);
    MesoVec3 n = {x, y, meso_fixture_float(random, -1, 1)};
    return meso_vec3_unit(n, (MesoVec3){0, 0, 1});
}

/* Vertices of `from` in a square from `corner`, as seen from there, moved and bent by up to `noise`. */
static uint32_t pick_points(MesoMatchPoint *points, uint32_t count, MesoRandom *random, const MesoSwatch *from,
                            MesoVec2 corner, float side, float noise)
{
    uint32_t kept = 0;
    while (kept < count) {
        uint32_t v = meso_random_below(random, from->vertex_count);
        MesoVec3 p = meso_vec3_sub(from->positions[v], (MesoVec3){corner.x, corner.y, 0});
        if (p.x < 0 || p.x > side || p.y < 0 || p.y > side)
            continue;
        MesoVec3 n = meso_vec3_mad(from->normals[v], 2 * noise, random_direction(random));
        p = meso_vec3_mad(p, noise * meso_fixture_float(random, 0, 1), random_direction(random));
        points[kept++] = (MesoMatchPoint){p, meso_vec3_unit(n, from->normals[v])};
    }
    return kept;
}

/* Equation 3 by all faces. */
static double exact_cost(const MesoMatchPoint *points, uint32_t count, MesoVec2 shift, uint32_t turn, uint32_t turns)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += (double)meso_match_exact(&swatch, field.lambda, meso_match_placed(points[i], shift, turn, turns), NULL);
    return sum / count - 1;
}

static MesoVec2 shift_of(uint32_t x, uint32_t y)
{
    return (MesoVec2){field.voxel * (float)x, field.voxel * (float)y};
}

/* ---- the table ---- */

/* What is in the table is a face's own cost, and no less than the least: mostly just that, and 2 % more on average. */
static void test_table(void)
{
    MesoRandom random;
    size_t voxels = (size_t)field.count[0] * field.count[1] * field.count[2], exact = 0, tried = 2000;
    double ratio = 0;
    meso_random_init(&random, 8, 0);
    for (size_t i = 0; i < tried; i++) {
        uint32_t bin = meso_random_below(&random, field.bins), v = meso_random_below(&random, (uint32_t)voxels), face;
        uint32_t at[3] = {v % field.count[0], v / field.count[0] % field.count[1], v / field.count[0] / field.count[1]};
        MesoMatchPoint point = {{field.low.x + ((float)at[0] + 0.5f) * field.voxel,
                                 field.low.y + ((float)at[1] + 0.5f) * field.voxel,
                                 field.low.z + ((float)at[2] + 0.5f) * field.voxel},
                                meso_match_direction(bin)};
        float least = meso_match_exact(&swatch, field.lambda, point, &face);
        float cost = 1 + meso_match_excess(field.costs[bin * voxels + v]);
        CHECK(cost >= least * (1 - 1e-5f) && cost < least * 1.6f);
        CHECK(meso_match_face(&field, bin * voxels + v) < swatch.triangle_count);
        exact += cost < least * (1 + 1e-3f);
        ratio += (double)(cost / least);
    }
    CHECK(exact > tried * 6 / 10 && ratio < 1.02 * (double)tried);
}

/* Sixteen bits of a cost: no less than it, by less than one part in 2048. */
static void test_codes(void)
{
    MesoRandom random;
    meso_random_init(&random, 12, 0);
    for (int i = 0; i < 10000; i++) {
        float excess = ldexpf(meso_fixture_float(&random, 1, 2), (int)meso_random_below(&random, 31) - 16);
        float kept = meso_match_excess(meso_match_excess_code(excess));
        CHECK(kept >= excess && kept <= excess * (1 + 1.0f / 2048));
    }
    CHECK(meso_match_excess(meso_match_excess_code(0)) < 1e-4f);
    CHECK(meso_match_excess(meso_match_excess_code(INFINITY)) > 6e4f);
}

/* Pairs are exact for the face that is given; returns how much more they cost than the best of all, as a part of it. */
static double excess_of_pairs(const MesoMatchPoint *points, uint32_t count)
{
    double sum = 0, least_sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t face, best;
        float cost = meso_match_at(&field, points[i], &face);
        float least = meso_match_exact(&swatch, field.lambda, points[i], &best);
        CHECK(face < swatch.triangle_count && cost >= least * (1 - 1e-5f));
        CHECK(face != best || cost <= least * (1 + 1e-5f));
        sum += (double)cost;
        least_sum += (double)least;
    }
    return sum / least_sum - 1;
}

/* Near the surface they are the best; of points anywhere, in the table and beyond it, with normals at random, not far
 * from it. */
static void test_pairs(void)
{
    enum { COUNT = 2000 };
    static MesoMatchPoint near[COUNT], anywhere[COUNT];
    MesoRandom random;
    meso_random_init(&random, 9, 0);
    for (uint32_t i = 0; i < COUNT; i++) {
        float x = meso_fixture_float(&random, -0.5f, TILE + 0.5f), y = meso_fixture_float(&random, -0.5f, TILE + 0.5f);
        anywhere[i] = (MesoMatchPoint){{x, y, meso_fixture_float(&random, -0.5f, 1.3f)}, random_direction(&random)};
        pick_points(near + i, 1, &random, &swatch, (MesoVec2){0, 0}, TILE, 0.1f);
    }
    CHECK(excess_of_pairs(near, COUNT) < 0.001);
    CHECK(excess_of_pairs(anywhere, COUNT) < 0.02);
    CHECK(meso_match_at(&field, (MesoMatchPoint){{NAN, 0, 0}, {0, 0, 1}}, NULL) == INFINITY);
}

/* The same table from any number of threads. */
static void test_threads(void)
{
    size_t cells = (size_t)field.bins * field.count[0] * field.count[1] * field.count[2];
    for (uint32_t threads = 2; threads < 8; threads += 5) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        MesoMatchField again;
        CHECK(meso_match_field_build(&again, &arena, &swatch, field.lambda, field.voxel, threads, NULL) == MESO_OK);
        CHECK(memcmp(again.costs, field.costs, cells * sizeof *field.costs) == 0);
        CHECK(memcmp(again.faces, field.faces, cells * sizeof *field.faces) == 0);
        meso_arena_rewind(&arena, mark);
    }
}

static void test_bad_tables(void)
{
    MesoMatchField none;
    MesoSwatch empty = {0};
    CHECK(meso_match_field_build(&none, &arena, &empty, 1, 0.1f, 1, NULL) == MESO_ERR_INPUT);
    CHECK(meso_match_field_build(&none, &arena, &swatch, 1, 0, 1, NULL) == MESO_ERR_INPUT);
    CHECK(meso_match_field_build(&none, &arena, &swatch, NAN, 0.1f, 1, NULL) == MESO_ERR_INPUT);
    CHECK(meso_match_field_build(&none, &arena, &swatch, 1, 1e-6f, 1, NULL) == MESO_ERR_LIMIT);
}

/* A direction is within its three bins: the blend of their directions points the same way. */
static void test_bins(void)
{
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    for (int i = 0; i < 2000; i++) {
        MesoVec3 n = random_direction(&random), sum = {0, 0, 0};
        MesoMatchBlend blend = meso_match_blend(n);
        for (int k = 0; k < 3; k++) {
            CHECK(blend.weights[k] >= 0 && blend.bins[k] < MESO_MATCH_BINS);
            sum = meso_vec3_mad(sum, blend.weights[k], meso_match_direction(blend.bins[k]));
        }
        CHECK(meso_vec3_length(meso_vec3_sub(meso_vec3_unit(sum, n), n)) < 1e-5f);
        CHECK(meso_vec3_dot(meso_match_direction(meso_match_nearest_bin(n)), n) > 0.88f);
    }
    for (uint32_t bin = 0; bin < MESO_MATCH_BINS; bin++)
        CHECK(meso_match_nearest_bin(meso_match_direction(bin)) == bin);
}

/* ---- the search ---- */

/* Least cost over all shifts, by all faces. */
static double least_cost(const MesoMatchPoint *points, uint32_t count)
{
    double least = 1e30;
    for (uint32_t y = 0; y < SPAN; y++)
        for (uint32_t x = 0; x < SPAN; x++)
            least = fmin(least, exact_cost(points, count, shift_of(x, y), 0, 1));
    return least;
}

/*
 * Random cases, half of them pieces of the weave itself. What the table alone finds costs little more than the
 * best, and the best of its first 16 by their faces within a hundredth of it.
 */
static void test_against_all_faces(void)
{
    enum { ROUNDS = 60 };
    MesoRandom random;
    MesoSwatch other;
    double excess = 0;
    float side = TILE - (SPAN - 1) * field.voxel;
    meso_random_init(&random, 21, 0);
    meso_fixture_weave(&other, &arena, TILE, 13, 6, 0.1f, 77);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        MesoMatchPoint points[MOST_POINTS];
        MesoMatch matches[16];
        uint32_t found;
        MesoVec2 corner = {meso_fixture_float(&random, 0, TILE - side), meso_fixture_float(&random, 0, TILE - side)};
        uint32_t count = pick_points(points, MOST_POINTS, &random, round & 1 ? &other : &swatch, corner, side,
                                     0.02f * (float)(round / 2 % 4));
        CHECK(meso_match_search(matches, &found, 16, 0, &field, &arena, points, NULL, count, (MesoVec2){0, 0},
                                (MesoVec2){side, side}, 0, 1, NULL) == MESO_OK);
        CHECK(found == 16);
        double least = least_cost(points, count);
        excess += exact_cost(points, count, matches[0].shift, 0, 1) / least - 1;
        CHECK(meso_match_refine(matches, found, 2, &field, points, NULL, count, 1) == 2);
        double refined = exact_cost(points, count, matches[0].shift, 0, 1);
        CHECK(refined <= 1.01 * least);
        CHECK(matches[0].cost <= matches[1].cost && fabs((double)matches[0].cost - refined) < 0.02 * refined);
    }
    CHECK(excess / ROUNDS < 0.05);
}

/* Pieces of the weave at whole voxels are found where they were, turned ones by their turn. */
static void test_found_again(void)
{
    MesoRandom random;
    float side = TILE - (SPAN - 1) * field.voxel;
    meso_random_init(&random, 4, 0);
    for (uint32_t round = 0; round < 40; round++) {
        MesoMatchPoint points[MOST_POINTS];
        MesoMatch match;
        uint32_t found, x = meso_random_below(&random, SPAN), y = meso_random_below(&random, SPAN), turn = round % 4;
        uint32_t count = pick_points(points, MOST_POINTS, &random, &swatch, shift_of(x, y), side, 0);
        MesoVec2 low = {0, 0}, high = {side, side};
        for (uint32_t i = 0; i < count; i++)
            points[i] = meso_match_placed(points[i], (MesoVec2){0, 0}, 4 - turn, 4);
        if (turn == 1 || turn == 2)
            low.x = -side, high.x = 0;
        if (turn == 2 || turn == 3)
            low.y = -side, high.y = 0;
        CHECK(meso_match_search(&match, &found, 1, 0, &field, &arena, points, NULL, count, low, high, 0, 4, NULL) ==
              MESO_OK);
        CHECK(found == 1 && match.turn == turn);
        CHECK(fabsf(match.shift.x - shift_of(x, y).x) < 1e-5f && fabsf(match.shift.y - shift_of(x, y).y) < 1e-5f);
    }
}

/* Places that are found lie in the tile, off its sides, and apart; in order of cost; none where there is no room. */
static void test_places(void)
{
    MesoRandom random;
    MesoMatchPoint points[MOST_POINTS];
    MesoMatch matches[100];
    uint32_t found;
    meso_random_init(&random, 6, 0);
    uint32_t count = pick_points(points, MOST_POINTS, &random, &swatch, (MesoVec2){0.3f, 0.4f}, 0.8f, 0.02f);
    MesoVec2 low = {-0.1f, -0.2f}, high = {0.8f, 0.9f};
    CHECK(meso_match_search(matches, &found, 100, 0.15f, &field, &arena, points, NULL, count, low, high, 0.1f, 6,
                            NULL) == MESO_OK);
    CHECK(found > 10);
    for (uint32_t i = 0; i < found; i++) {
        CHECK(i == 0 || matches[i].cost >= matches[i - 1].cost);
        for (uint32_t k = 0; k < 4; k++) {
            MesoMatchPoint p = {{k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, 0}, {0, 0, 1}};
            p = meso_match_placed(p, matches[i].shift, matches[i].turn, 6);
            CHECK(p.position.x > 0.0999f && p.position.x < TILE - 0.0999f);
            CHECK(p.position.y > 0.0999f && p.position.y < TILE - 0.0999f);
        }
        for (uint32_t j = 0; j < i; j++)
            CHECK(matches[i].turn != matches[j].turn ||
                  meso_vec2_length(meso_vec2_sub(matches[i].shift, matches[j].shift)) > 0.15f);
    }
    CHECK(meso_match_search(matches, &found, 100, 0, &field, &arena, points, NULL, count, low, high, 0.7f, 6, NULL) ==
              MESO_OK && found == 0);
    CHECK(meso_match_search(matches, &found, 1, 0, &field, &arena, points, NULL, 0, low, high, 0, 1, NULL) == MESO_OK);
    CHECK(found == 1 && matches[0].cost == 0);
}

/* A point of weight 2 is two points, one of weight 0 none. */
static void test_weights(void)
{
    MesoRandom random;
    MesoMatchPoint points[MOST_POINTS], doubled[2 * MOST_POINTS];
    float weights[MOST_POINTS], side = 1.4f;
    uint32_t found, doubled_count = 0;
    meso_random_init(&random, 7, 0);
    uint32_t count = pick_points(points, MOST_POINTS, &random, &swatch, (MesoVec2){0.3f, 0.4f}, side, 0.02f);
    for (uint32_t i = 0; i < count; i++) {
        weights[i] = (float)(i % 3);
        for (uint32_t k = 0; k < i % 3; k++)
            doubled[doubled_count++] = points[i];
    }
    MesoMatch a[4], b[4];
    MesoVec2 low = {0, 0}, high = {side, side};
    CHECK(meso_match_search(a, &found, 4, 0, &field, &arena, points, weights, count, low, high, 0, 1, NULL) == MESO_OK);
    CHECK(meso_match_search(b, &found, 4, 0, &field, &arena, doubled, NULL, doubled_count, low, high, 0, 1, NULL) ==
          MESO_OK);
    for (uint32_t i = 0; i < 4; i++) {
        CHECK(a[i].shift.x == b[i].shift.x && a[i].shift.y == b[i].shift.y && fabsf(a[i].cost - b[i].cost) < 1e-4f);
        float cost = meso_match_cost(&field, points, weights, count, a[i].shift, 0, 1);
        CHECK(fabsf(cost - meso_match_cost(&field, doubled, NULL, doubled_count, a[i].shift, 0, 1)) < 1e-5f);
    }
}

/* Whole coordinates now and then: triangles without area, points on sides and corners. */
static float random_coordinate(MesoRandom *random, bool whole)
{
    return whole ? (float)meso_random_below(random, 3) : meso_fixture_float(random, -2, 2);
}

static void test_rows_of_triangles(void)
{
    MesoRandom random;
    meso_random_init(&random, 12, 0);
    for (int round = 0; round < 500; round++) {
        MesoTriangleRow row;
        float squares[MESO_TRIANGLE_ROW], (*places[4])[MESO_TRIANGLE_ROW] = {row.p, row.a, row.b, row.c};
        for (size_t i = 0; i < MESO_TRIANGLE_ROW; i++) {
            bool whole = meso_random_below(&random, 2);
            for (size_t k = 0; k < 12; k++)
                places[k / 3][k % 3][i] = random_coordinate(&random, whole);
        }
        meso_triangle_squares(squares, &row);
        for (size_t i = 0; i < MESO_TRIANGLE_ROW; i++) {
            MesoVec3 v[4];
            for (size_t k = 0; k < 4; k++)
                v[k] = (MesoVec3){places[k][0][i], places[k][1][i], places[k][2][i]};
            CHECK(squares[i] == meso_triangle_square(v[0], v[1], v[2], v[3]));
        }
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_rows_of_triangles();
    meso_fixture_weave(&swatch, &arena, TILE, 13, 6, 0.1f, 5);
    CHECK(meso_match_field_build(&field, &arena, &swatch, 1 / swatch.mean_edge, 0.1f, 1, NULL) == MESO_OK);
    test_bins();
    test_codes();
    test_table();
    test_pairs();
    test_threads();
    test_bad_tables();
    test_found_again();
    test_places();
    test_weights();
    test_against_all_faces();
    meso_arena_release(&arena);
    return 0;
}
