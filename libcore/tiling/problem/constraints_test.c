#include "libcore/tiling/problem/constraints.h"

#include "libcore/tiling/fixture/constraints_fixture.h"

/* Four tiles without a turn that all match each other: any choice anywhere is valid. */
static const int32_t loose[4][4] = {{1, 1, -1, -1}, {1, 1, -1, -1}, {1, 1, -1, -1}, {1, 1, -1, -1}};

static MesoSolveResult solve(FixtureCase *c, uint64_t seed, uint32_t attempts)
{
    return fixture_case_solve(c, MESO_ENGINE_WFC, seed, attempts);
}

/*
 *     [0][1][2]    t0 = a a a' a', t1 = b on the right, t2 = b' on the left
 */
static const int32_t chain[3][4] = {{1, 1, -1, -1}, {2, 1, -1, -1}, {1, 1, -2, -1}};

static void test_restrictions(void)
{
    static const uint32_t slots[1] = {2}, sides[2] = {0, 4 * 1 + 2};
    static const uint64_t only_t2[1] = {4}, b_or_back[1] = {1 << 2 | 1 << 3};
    FixtureCase c;
    fixture_case_begin(&c, chain, 2, 3, 3, 1);
    MesoRestriction pin = {.name = "pins[0]", .place_count = 1, .places = slots, .allowed = only_t2};
    c.constraints.restriction_count = 1;
    c.constraints.restrictions = &pin;
    for (uint64_t seed = 0; seed < 20; seed++) {
        MesoSolveResult result = solve(&c, seed, 5);
        CHECK(result.verdict == MESO_VERDICT_SOLVED && result.assignment.tile[2] == 2);
        CHECK(result.assignment.tile[1] == 1);
    }
    /* Both sides of the left edge want b: t1 beside t2. */
    pin = (MesoRestriction){.name = "pins[0]", .sided = true, .place_count = 2, .places = sides,
                            .allowed = b_or_back};
    for (uint64_t seed = 0; seed < 20; seed++) {
        MesoSolveResult result = solve(&c, seed, 5);
        CHECK(result.assignment.tile[0] == 1 && result.assignment.tile[1] == 2);
    }
    meso_arena_release(&c.arena);
}

/* What does not hold is found, by name. */
static void test_check(void)
{
    static const uint32_t slots[1] = {1}, sides[1] = {4};
    static const uint64_t not_t0[1] = {6}, b[1] = {1 << 2};
    uint32_t tile[3] = {0};
    MesoTransform transform[3] = {0};
    MesoAssignment assignment = {3, tile, transform};
    MesoError error;
    FixtureCase c;
    fixture_case_begin(&c, chain, 2, 3, 3, 1);
    MesoRestriction pins[1] = {{.name = "pins[7]", .place_count = 1, .places = slots, .allowed = not_t0}};
    MesoQuota quota = {.name = "quotas[3]", .variants = not_t0, .least = 1, .most = 2};
    c.constraints = (MesoConstraints){.restriction_count = 1, .restrictions = pins};
    CHECK(meso_constraints_check(&c.constraints, &assignment, &c.set, &c.variants, &c.graph, &error) ==
          MESO_ERR_INPUT);
    CHECK(strstr(error.message, "pins[7] does not hold: slot 1 has tile 't0'"));
    pins[0] = (MesoRestriction){.name = "pins[8]", .sided = true, .place_count = 1, .places = sides, .allowed = b};
    CHECK(meso_constraints_check(&c.constraints, &assignment, &c.set, &c.variants, &c.graph, &error) ==
          MESO_ERR_INPUT);
    CHECK(strstr(error.message, "pins[8] does not hold: slot 1, side 0 shows 'a'"));
    c.constraints = (MesoConstraints){.quota_count = 1, .quotas = &quota};
    CHECK(meso_constraints_check(&c.constraints, &assignment, &c.set, &c.variants, &c.graph, &error) ==
          MESO_ERR_INPUT);
    CHECK(strstr(error.message, "quotas[3] does not hold: used in 0 slots, not 1 to 2"));
    tile[0] = 1;
    CHECK(meso_constraints_check(&c.constraints, &assignment, &c.set, &c.variants, &c.graph, &error) == MESO_OK);
    meso_arena_release(&c.arena);
}

/* Slot 0 is pinned to t1, slot 2 to t0 and slot 1 to t0: 0 and 1 cannot go together; 2 has no part in it. */
static void test_explanation(void)
{
    static const uint32_t places[4] = {0, 1, 2, 3};
    static const uint64_t t0[1] = {1}, t1[1] = {2}, none[1] = {0};
    FixtureCase c;
    fixture_case_begin(&c, chain, 2, 3, 4, 1);
    MesoRestriction pins[4] = {
        {.name = "pins[0] 'far'", .place_count = 1, .places = places + 3, .allowed = t0},
        {.name = "pins[1]", .place_count = 1, .places = places, .allowed = t1},
        {.name = "pins[2]", .place_count = 1, .places = places + 2, .allowed = t0},
        {.name = "regions[0]", .place_count = 2, .places = places + 1, .allowed = t0},
    };
    c.constraints.restriction_count = 4;
    c.constraints.restrictions = pins;
    MesoSolveResult result = solve(&c, 0, 5);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE && result.attempts == 0);
    CHECK(strcmp(result.reason, "no tiles fit together on slots 0 and 1, with pins[1] and regions[0]: only 't1' fits slot "
                 "0, only 't0' fits slot 1; each of these is needed") == 0);
    CHECK(result.core.found && result.core.minimal && result.core.slot_count == 2 && result.core.constraint_count == 2);

    pins[0].allowed = none;
    pins[3].allowed = t1;
    pins[3].place_count = 0;
    result = solve(&c, 0, 5);
    CHECK(strcmp(result.reason, "no tile fits slot 3, with pins[0] 'far'") == 0);
    meso_arena_release(&c.arena);

    /* Not the constraints' fault. */
    static const int32_t alone[1][4] = {{1, 1, 1, 1}};
    fixture_case_begin(&c, alone, 1, 1, 2, 1);
    c.constraints.restriction_count = 1;
    c.constraints.restrictions = pins;
    result = solve(&c, 0, 5);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE && strstr(result.reason, "whatever the constraints"));
    meso_arena_release(&c.arena);
}

static void test_quotas(void)
{
    static const uint64_t t0[1] = {1}, t1[1] = {2}, t23[1] = {12};
    FixtureCase c;
    fixture_case_begin(&c, loose, 1, 4, 12, 10);
    MesoQuota quotas[3] = {{.name = "quotas[0]", .variants = t0, .least = 0, .most = 7},
                           {.name = "quotas[1]", .variants = t1, .least = 90, .most = 120},
                           {.name = "quotas[2]", .variants = t23, .least = 20, .most = 21}};
    c.constraints.quota_count = 3;
    c.constraints.quotas = quotas;
    for (uint64_t seed = 0; seed < 30; seed++) {
        MesoSolveResult result = solve(&c, seed, 2);
        CHECK(result.verdict == MESO_VERDICT_SOLVED);
        CHECK(fixture_uses(&result.assignment, 0) <= 7 && fixture_uses(&result.assignment, 1) >= 90);
        result = fixture_case_solve(&c, MESO_ENGINE_EXACT, seed, 1);
        CHECK(result.verdict == MESO_VERDICT_SOLVED && fixture_uses(&result.assignment, 1) >= 90);
    }
    /* Exactly all of them: nothing is left to choose. */
    quotas[2].least = quotas[2].most = 30;
    quotas[0].most = 0;
    MesoSolveResult result = solve(&c, 1, 2);
    CHECK(result.verdict == MESO_VERDICT_SOLVED && fixture_uses(&result.assignment, 1) == 90);

    /* More than there are slots; two that need the same slots. */
    quotas[1].least = 121;
    result = solve(&c, 1, 2);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE && result.dead_end_total == 0);
    CHECK(strcmp(result.reason, "quotas[1] cannot hold on a surface of 120 slots") == 0);
    meso_arena_release(&c.arena);
}

/* Every tile over three labels on a torus of 193600 slots: more variables than the exact engine takes. */
static void test_formula_too_large(void)
{
    static const uint64_t t0[2] = {1, 0};
    int32_t labels[81][4];
    MesoArena arena;
    MesoVariantSet variants;
    MesoSolveResult result;
    for (uint32_t i = 0; i < 81; i++) {
        const int32_t tile[4] = {1 + (int32_t)(i % 3), 1 + (int32_t)(i / 3 % 3), -1 - (int32_t)(i / 9 % 3),
                                 -1 - (int32_t)(i / 27)};
        memcpy(labels[i], tile, sizeof tile);
    }
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 81, (const int32_t (*)[4])labels, false, false, false);
    MesoSlotGraph graph = fixture_grid(&arena, 440, 440, true, true, false);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    const MesoQuota quota = {"quotas[0]", t0, 1, 193600};
    const MesoConstraints constraints = {.quota_count = 1, .quotas = &quota};
    const MesoSolveOptions options = {.engine = MESO_ENGINE_EXACT, .max_attempts = 1};
    CHECK(meso_solve(&result, &arena, &(MesoTilingProblem){&set, &variants, &graph, &constraints},
                     &options, NULL) == MESO_OK);
    CHECK(result.verdict == MESO_VERDICT_GAVE_UP && result.budget == MESO_BUDGET_FORMULA);
    CHECK(strcmp(result.reason, "so many slots with so many tiles are beyond the exact engine") == 0);
    meso_arena_release(&arena);
}

/* On a chain, at most one t1 starts a b and at most none t2 ends it: both quotas and a pin speak. */
static void test_quota_explanation(void)
{
    static const uint32_t place[1] = {0};
    static const uint64_t t1[1] = {2}, t2[1] = {4};
    FixtureCase c;
    fixture_case_begin(&c, chain, 2, 3, 5, 1);
    MesoRestriction pin = {.name = "pins[0]", .place_count = 1, .places = place, .allowed = t1};
    MesoQuota quotas[2] = {{.name = "quotas[0]", .variants = t1, .least = 0, .most = 5},
                           {.name = "quotas[1]", .variants = t2, .least = 0, .most = 0}};
    c.constraints = (MesoConstraints){.restriction_count = 1, .restrictions = &pin, .quota_count = 2,
                                      .quotas = quotas};
    MesoSolveResult result = solve(&c, 0, 5);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE);
    CHECK(strstr(result.reason, "pins[0] and quotas[1] cannot hold together on slots 0 and 1: ") == result.reason);
    meso_arena_release(&c.arena);
}

/* Closed rows hold as many t1 as t2: no propagation sees it, the search meets it, and says which. */
static void test_quota_gives_up(void)
{
    static const int32_t pairs[3][4] = {{1, 1, -1, -1}, {2, 1, -1, -1}, {1, 1, -2, -1}};
    static const uint64_t t1[1] = {2}, t2[1] = {4};
    FixtureCase c;
    fixture_case_begin(&c, pairs, 2, 3, 8, 8);
    c.graph = fixture_grid(&c.arena, 8, 8, true, false, false);
    MesoQuota quotas[2] = {{.name = "quotas[0]", .variants = t1, .least = 5, .most = 64},
                           {.name = "quotas[1]", .variants = t2, .least = 0, .most = 4}};
    c.constraints = (MesoConstraints){.quota_count = 2, .quotas = quotas};
    MesoSolveResult result = solve(&c, 0, 2);
    CHECK(result.verdict != MESO_VERDICT_SOLVED && result.backtracks > 0);
    CHECK(result.violations[0] + result.violations[1] > 0 && strstr(result.reason, "quotas["));
    result = fixture_case_solve(&c, MESO_ENGINE_AUTO, 0, 1);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE);
    CHECK(strstr(result.reason, "quotas[0] and quotas[1] cannot hold together: ") == result.reason);
    quotas[1].most = 5;
    result = solve(&c, 0, 20);
    CHECK(result.verdict == MESO_VERDICT_SOLVED && fixture_uses(&result.assignment, 1) >= 5);
    meso_arena_release(&c.arena);
}

static const int32_t osier[4][4] = {{1, 2, -1, -2}, {1, 2, -1, -3}, {3, 2, -1, -2}, {3, 2, -1, -3}};

/* Kept whole where it is valid; changed about a slot that is pinned to another tile. */
static void test_keep(void)
{
    FixtureCase c;
    fixture_case_begin(&c, osier, 3, 4, 30, 30);
    fixture_case_permit(&c, true, true);
    MesoSolveResult old = solve(&c, 3, 20);
    CHECK(old.verdict == MESO_VERDICT_SOLVED);
    uint32_t *keep = MESO_NEW(&c.arena, uint32_t, 900, NULL);
    for (uint32_t s = 0; s < 900; s++)
        keep[s] = meso_variant_find(&c.variants, &c.set, old.assignment.tile[s], old.assignment.transform[s]);
    c.constraints.keep = keep;
    MesoSolveResult result = solve(&c, 77, 20);
    CHECK(result.verdict == MESO_VERDICT_SOLVED);
    CHECK(meso_constraints_changed(&c.constraints, &result.assignment, &c.variants) == 0);

    static const uint32_t place[1] = {435};
    uint64_t other[1] = {0};
    for (uint32_t v = 0; v < c.variants.count; v++)
        if (c.variants.tile[v] != old.assignment.tile[435])
            meso_bits_set(other, v);
    MesoRestriction pin = {.name = "pins[0]", .place_count = 1, .places = place, .allowed = other};
    c.constraints.restriction_count = 1;
    c.constraints.restrictions = &pin;
    for (MesoEngine engine = MESO_ENGINE_WFC; engine <= MESO_ENGINE_EXACT; engine++) {
        result = fixture_case_solve(&c, engine, 77, 20);
        CHECK(result.verdict == MESO_VERDICT_SOLVED);
        uint32_t changed = meso_constraints_changed(&c.constraints, &result.assignment, &c.variants);
        CHECK(changed >= 1 && changed < 60);
    }
    meso_arena_release(&c.arena);
}

static const MesoEngine engines[3] = {MESO_ENGINE_AUTO, MESO_ENGINE_WFC, MESO_ENGINE_EXACT};

/* Slots whose variant is not the one to keep, when all engines have slot 2 of 8 in a row pinned to t1. */
static void check_changes(const int32_t (*labels)[4], uint32_t interfaces, uint32_t tiles, uint32_t expected)
{
    static const uint32_t place[1] = {2}, keep[8] = {0, 0, 0, 0, 0, 0, 0, MESO_NO_INDEX};
    static const uint64_t t1[1] = {2};
    MesoRestriction pin = {.name = "pins[0]", .place_count = 1, .places = place, .allowed = t1};
    FixtureCase c;
    fixture_case_begin(&c, labels, interfaces, tiles, 8, 1);
    c.constraints.keep = keep;
    for (uint32_t e = 0; e < 3; e++)
        for (uint64_t seed = 0; seed < 20; seed++) {
            c.constraints.restriction_count = 0;
            MesoSolveResult result = fixture_case_solve(&c, engines[e], seed, 5);
            CHECK(result.verdict == MESO_VERDICT_SOLVED && fixture_uses(&result.assignment, 0) >= 7);
            CHECK(meso_constraints_changed(&c.constraints, &result.assignment, &c.variants) == 0);
            c.constraints.restriction_count = 1;
            c.constraints.restrictions = &pin;
            result = fixture_case_solve(&c, engines[e], seed, 5);
            CHECK(result.verdict == MESO_VERDICT_SOLVED && result.assignment.tile[2] == 1);
            CHECK(meso_constraints_changed(&c.constraints, &result.assignment, &c.variants) == expected);
        }
    meso_arena_release(&c.arena);
}

/* Where any tile goes beside any other, the pinned slot alone changes; on the chain the next one has to. */
static void test_fewest_changes(void)
{
    check_changes(loose, 1, 4, 1);
    check_changes(chain, 2, 3, 2);
}

/*
 * Against brute force: the search under a quota, with backtracking, finds an
 * assignment where there is one, and proves that there is none by trying all.
 */
static void test_exhaustion(void)
{
    static const int32_t pairs[3][4] = {{1, 1, -1, -1}, {2, 1, -1, -1}, {1, 1, -2, -1}};
    static const uint64_t t0[1] = {1};
    for (uint32_t most = 0; most <= 9; most++)
        for (uint32_t least = 0; least <= most; least++) {
            FixtureCase c;
            fixture_case_begin(&c, pairs, 2, 3, 3, 3);
            c.graph = fixture_grid(&c.arena, 3, 3, true, false, false);
            MesoQuota quota = {.name = "quotas[0]", .variants = t0, .least = least, .most = most};
            c.constraints = (MesoConstraints){.quota_count = 1, .quotas = &quota};
            /* A closed row of three holds one t0 beside a pair, or three: 3, 5, 7 or 9 in all. */
            bool possible = false;
            for (uint32_t n = 3; n <= 9; n += 2)
                possible |= n >= least && n <= most;
            MesoSolveResult result = solve(&c, most, 3);
            CHECK(result.verdict == (possible ? MESO_VERDICT_SOLVED : MESO_VERDICT_UNSOLVABLE));
            CHECK(possible || strstr(result.reason, "quotas[0]") || strstr(result.reason, "every choice"));
            result = fixture_case_solve(&c, MESO_ENGINE_EXACT, most, 1);
            CHECK(result.verdict == (possible ? MESO_VERDICT_SOLVED : MESO_VERDICT_UNSOLVABLE));
            meso_arena_release(&c.arena);
        }
}

int main(void)
{
    test_exhaustion();
    test_restrictions();
    test_check();
    test_explanation();
    test_quotas();
    test_formula_too_large();
    test_quota_explanation();
    test_quota_gives_up();
    test_keep();
    test_fewest_changes();
    return 0;
}
