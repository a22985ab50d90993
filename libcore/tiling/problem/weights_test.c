#include "libcore/tiling/problem/weights.h"

#include <math.h>

#include "libcore/tiling/fixture/constraints_fixture.h"

/* Four tiles without a turn that all match each other: any choice anywhere is valid. */
static const int32_t loose[4][4] = {{1, 1, -1, -1}, {1, 1, -1, -1}, {1, 1, -1, -1}, {1, 1, -1, -1}};

static const MesoEngine engines[3] = {MESO_ENGINE_AUTO, MESO_ENGINE_WFC, MESO_ENGINE_EXACT};

/* The weights of a table of tiles: plain ones. */
static MesoWeights weigh(FixtureCase *c, uint32_t table_count, const uint32_t *weights)
{
    MesoWeight of_tiles[8];
    for (uint32_t i = 0; i < table_count * c->set.tile_count; i++)
        of_tiles[i] = (MesoWeight){weights[i], MESO_NO_INDEX};
    return (MesoWeights){.table_count = table_count, .variant_count = c->variants.count,
                         .tables = meso_weights_of_variants(&c->arena, &c->variants, c->set.tile_count, table_count,
                                                            of_tiles, NULL)};
}

enum { MOST_SLOTS = 6, MOST_TILES = 4, RUNS = 1500 };

/*
 * How often each tile stands in each slot over many seeds is as expected [slots * tiles].
 * Chi square with 3 degrees of freedom is above 16.3 once in a thousand times.
 */
static void check_frequencies(FixtureCase *c, MesoEngine engine, const double *expected)
{
    static uint32_t counts[MOST_SLOTS][MOST_TILES];
    uint32_t slots = c->graph.slot_count, tiles = c->set.tile_count;
    CHECK(slots <= MOST_SLOTS && tiles <= MOST_TILES);
    memset(counts, 0, sizeof counts);
    for (uint64_t seed = 0; seed < RUNS; seed++) {
        MesoArenaMark mark = meso_arena_mark(&c->arena);
        MesoSolveResult result = fixture_case_solve(c, engine, seed, 1);
        CHECK(result.verdict == MESO_VERDICT_SOLVED);
        for (uint32_t s = 0; s < slots; s++)
            counts[s][result.assignment.tile[s]]++;
        meso_arena_rewind(&c->arena, mark);
    }
    for (uint32_t s = 0; s < slots; s++) {
        double chi = 0;
        for (uint32_t t = 0; t < tiles; t++) {
            double mean = RUNS * expected[s * tiles + t], off = counts[s][t] - mean;
            CHECK(mean > 0 || counts[s][t] == 0);
            chi += mean > 0 ? off * off / mean : 0;
        }
        CHECK(chi < 16.3);
    }
}

static void test_tiles(void)
{
    static const uint32_t weights[2][4] = {{1, 2, 5, 0}, {0, 0, 0, 0}};
    static const uint32_t tables[1] = {1};
    static const double expected[4] = {0.125, 0.25, 0.625, 0}, even[4] = {0.25, 0.25, 0.25, 0.25};
    for (uint32_t e = 0; e < 3; e++) {
        FixtureCase c;
        fixture_case_begin(&c, loose, 1, 4, 1, 1);
        check_frequencies(&c, engines[e], even);
        c.constraints.weights = weigh(&c, 2, weights[0]);
        check_frequencies(&c, engines[e], expected);
        c.constraints.weights.slot_table = tables;      /* where all weigh 0, all have the same chance */
        check_frequencies(&c, engines[e], even);
        meso_arena_release(&c.arena);
    }
}

/* A quota that always holds makes the exact engine tell its tiles from the others. */
static void test_beside_quotas(void)
{
    static const uint32_t weights[4] = {1, 2, 5, 0};
    static const double expected[4] = {0.125, 0.25, 0.625, 0};
    static const uint64_t t0[1] = {1}, t12[1] = {6};
    static const MesoQuota quotas[2] = {{.name = "quotas[0]", .variants = t0, .most = 1},
                                        {.name = "quotas[1]", .variants = t12, .most = 1}};
    for (uint32_t e = 0; e < 3; e++) {
        FixtureCase c;
        fixture_case_begin(&c, loose, 1, 4, 1, 1);
        c.constraints = (MesoConstraints){.quota_count = 2, .quotas = quotas, .weights = weigh(&c, 1, weights)};
        check_frequencies(&c, engines[e], expected);
        meso_arena_release(&c.arena);
    }
}

/* t0 shows the same however it turns, t1 has four variants: the weights compare the tiles. */
static void test_shares(void)
{
    static const int32_t labels[2][4] = {{1, 1, 1, 1}, {1, 2, 1, 1}};
    static const uint32_t weights[2] = {1, 3};
    static const double expected[2] = {0.25, 0.75};
    for (uint32_t e = 0; e < 3; e++) {
        FixtureCase c;
        fixture_case_begin(&c, labels, 2, 2, 1, 1);
        fixture_case_permit(&c, true, false);
        CHECK(c.variants.count == 5);
        c.constraints.weights = weigh(&c, 1, weights);
        CHECK(meso_weight_at(&c.constraints.weights, 0, 0) == 840);
        CHECK(meso_weight_at(&c.constraints.weights, 0, 4) == 630);
        check_frequencies(&c, engines[e], expected);
        meso_arena_release(&c.arena);
    }
}

/* Weight of a tile with `shares` variants on a ramp at one value. */
static uint64_t ramp_at(const MesoWeightStop *stops, uint32_t stop_count, double value, uint32_t shares)
{
    const MesoWeightRamp ramp = {&value, stop_count, stops};
    const MesoWeight weight = {MESO_WEIGHT_SCALE / shares, 0};
    const MesoWeights weights = {.table_count = 1, .variant_count = 1, .tables = &weight, .ramps = &ramp};
    return meso_weight_at(&weights, 0, 0);
}

/* Linear between stops, constant outside, whole in units of the scale, and finite at any values. */
static void test_ramp_values(void)
{
    static const MesoWeightStop stops[4] = {{-1, 2}, {0, 0}, {10, 5}, {11, 1000000}};
    CHECK(ramp_at(stops, 4, -1, 1) == 2 * 840 && ramp_at(stops, 4, -0.5, 1) == 840 && ramp_at(stops, 4, 0, 1) == 0);
    CHECK(ramp_at(stops, 4, 2, 1) == 840 && ramp_at(stops, 4, 9, 8) == 4 * 105 + 53);   /* 4.5 */
    CHECK(ramp_at(stops, 4, 10, 1) == 5 * 840 && ramp_at(stops, 4, 11, 1) == 840000000);
    CHECK(ramp_at(stops, 4, -7, 1) == 2 * 840 && ramp_at(stops, 4, -INFINITY, 1) == 2 * 840);
    CHECK(ramp_at(stops, 4, 12, 1) == 840000000 && ramp_at(stops, 4, INFINITY, 1) == 840000000);
    CHECK(ramp_at(stops, 1, 3, 1) == 2 * 840);
    static const MesoWeightStop widest[2] = {{-1.7e308, 0}, {1.7e308, 4}};
    CHECK(ramp_at(widest, 2, 0, 1) == 2 * 840 && ramp_at(widest, 2, 1.6999e308, 1) == 3360);
}

/* Slots apart from each other, under one table with two ramps, and under another one. */
static void test_ramps(void)
{
    static const double height[6] = {-1, 0, 1, 2.5, 7, 1}, heat[6] = {0, 1, 0.5, 0, 1, 0.5};
    static const MesoWeightStop rise[3] = {{0, 0}, {2, 4}, {3, 2}}, fall[2] = {{0, 6}, {1, 1}};
    static const MesoWeightRamp ramps[2] = {{height, 3, rise}, {heat, 2, fall}};
    /* By slot: t0 follows the rise 0 0 2 3 2, t1 the fall 6 1 3.5 6 1, t2 weighs 1; the last slot has t0 at 3 alone. */
    static const MesoWeight of_tiles[2][4] = {{{1, 0}, {1, 1}, {1, MESO_NO_INDEX}, {0, MESO_NO_INDEX}},
                                              {{3, MESO_NO_INDEX}, {1, MESO_NO_INDEX}, {0, MESO_NO_INDEX}, {1, 0}}};
    static const uint32_t slot_table[6] = {0, 0, 0, 0, 0, 1};
    static const double weights[6][4] = {{0, 6, 1, 0}, {0, 1, 1, 0}, {2, 3.5, 1, 0},
                                         {3, 6, 1, 0}, {2, 1, 1, 0}, {3, 1, 0, 2}};
    double expected[6][4];
    for (uint32_t s = 0; s < 6; s++)
        for (uint32_t t = 0; t < 4; t++)
            expected[s][t] = weights[s][t] / (weights[s][0] + weights[s][1] + weights[s][2] + weights[s][3]);
    for (uint32_t e = 0; e < 3; e++) {
        FixtureCase c;
        fixture_case_begin(&c, loose, 1, 4, 1, 1);
        c.graph = fixture_graph(&c.arena, 6);
        c.constraints.weights = (MesoWeights){
            .table_count = 2, .variant_count = 4, .slot_table = slot_table, .ramps = ramps,
            .tables = meso_weights_of_variants(&c.arena, &c.variants, 4, 2, of_tiles[0], NULL)};
        check_frequencies(&c, engines[e], expected[0]);
        meso_arena_release(&c.arena);
    }
}

/* Sums beyond 32 bits, and no bias in them. */
static void test_large(void)
{
    static const uint32_t weights[4] = {1000000, 1000000, 1000000, 999999}, list[3] = {0, 1, 3};
    static const uint64_t bits[1] = {15}, also[1] = {6};
    FixtureCase c;
    MesoRandom random;
    uint32_t counts[4] = {0}, listed[4] = {0};
    fixture_case_begin(&c, loose, 1, 4, 1, 1);
    MesoWeights most = weigh(&c, 1, weights);
    MesoWeight *tables = MESO_NEW(&c.arena, MesoWeight, 4, NULL);
    for (uint32_t v = 0; v < 4; v++)
        tables[v] = (MesoWeight){UINT32_MAX - v, MESO_NO_INDEX};
    CHECK(meso_weight_at(&most, 0, 3) == 839999160);
    most.tables = tables;
    meso_random_init(&random, 1, 2);
    for (uint32_t i = 0; i < 4000; i++) {
        counts[meso_weights_draw(&most, 0, bits, NULL, 1, &random)]++;
        listed[meso_weights_draw_listed(&most, 0, list, 3, &random)]++;
        uint32_t one = meso_weights_draw(&most, 0, bits, also, 1, &random);
        CHECK(one == 1 || one == 2);
    }
    for (uint32_t v = 0; v < 4; v++) {
        CHECK(counts[v] > 850 && counts[v] < 1150);
        CHECK(v == 2 ? listed[v] == 0 : listed[v] > 1180 && listed[v] < 1490);
    }
    meso_arena_release(&c.arena);
}

int main(void)
{
    test_tiles();
    test_beside_quotas();
    test_shares();
    test_ramp_values();
    test_ramps();
    test_large();
    return 0;
}
