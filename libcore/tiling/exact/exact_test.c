/* Exact engine: that every assignment is reached, by the other engines too; clauses of callers, determinism. */
#include <stdlib.h>
#include <string.h>

#include "libcore/tiling/exact/exact.h"
#include "libcore/tiling/fixture/brute_force.h"

static int compare_numbers(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Over many seeds the engine finds every assignment that there is; the search alone may give up now and then. */
static void check_reach(MesoEngine engine, const MesoTileSet *set, const MesoSlotGraph *graph, uint64_t least)
{
    MesoArena arena;
    meso_arena_init(&arena);
    BruteForce force = brute_force(&arena, set, graph, 3000, true);
    uint32_t *met = MESO_NEW(&arena, uint32_t, force.count, NULL);
    CHECK(met && force.count >= least && force.count < 3000);
    qsort(force.numbers, force.count, sizeof *force.numbers, compare_numbers);
    uint64_t unmet = force.count;
    for (uint64_t seed = 0; unmet > 0; seed++) {
        CHECK(seed < 1000 * force.count);
        MesoArenaMark mark = meso_arena_mark(&arena);
        MesoSolveResult result = fixture_solve_by(engine, &arena, set, graph, seed, 10);
        CHECK(result.verdict == MESO_VERDICT_SOLVED ||
              (engine == MESO_ENGINE_WFC && result.verdict == MESO_VERDICT_GAVE_UP));
        if (result.verdict == MESO_VERDICT_SOLVED) {
            uint64_t number = brute_force_find(&force, &result.assignment);
            const uint64_t *found = bsearch(&number, force.numbers, force.count, sizeof number, compare_numbers);
            CHECK(found);
            unmet -= met[found - force.numbers]++ == 0;
        }
        meso_arena_rewind(&arena, mark);
    }
    meso_arena_release(&arena);
}

/* A face glued to itself, two faces that share two edges, a Moebius band, a torus, a sheet. */
static void test_reach(void)
{
    static const int32_t corner[1][4] = {{1, 1, -1, -1}}, mixed[2][4] = {{1, 2, -1, -2}, {1, 2, 2, -1}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoSlotGraph self = fixture_graph(&arena, 1), pair = fixture_graph(&arena, 2);
    fixture_glue(&self, 0, 0, 0, 2);
    fixture_glue(&pair, 0, 0, 1, 2);
    fixture_glue(&pair, 0, 1, 1, 1);
    MesoTileSet sets[] = {fixture_set(&arena, 1, 1, corner, true, true, true),
                          fixture_set(&arena, 2, 2, mixed, true, true, false),
                          fixture_set(&arena, 1, 1, corner, true, true, false),
                          fixture_set(&arena, 2, 2, mixed, true, false, false)};
    MesoSlotGraph graphs[] = {self, pair, fixture_grid(&arena, 2, 1, true, false, true),
                              fixture_grid(&arena, 3, 1, true, true, true),
                              fixture_grid(&arena, 2, 2, true, true, false),
                              fixture_grid(&arena, 3, 2, false, false, false)};
    /* With the variants of the first two, a sheet of six has thousands of assignments. */
    for (uint32_t s = 0; s < 4; s++)
        for (uint32_t g = s < 2 ? 0 : 5; g < (s < 2 ? 5 : 6); g++)
            for (MesoEngine engine = MESO_ENGINE_AUTO; engine <= MESO_ENGINE_EXACT; engine++)
                check_reach(engine, &sets[s], &graphs[g], 2);
    meso_arena_release(&arena);
}

/* Clauses of the caller's own: with the literal of a variant at a slot taken away, another is found, to the last. */
static void test_own_clauses(void)
{
    static const int32_t labels[3][4] = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, -1, 1}};
    static const uint32_t group[3] = {0, 1, 2};
    MesoArena arena;
    MesoVariantSet variants;
    MesoPropagation propagation;
    MesoExact exact;
    MesoRandom random;
    MesoSatAnswer answer;
    uint32_t found = 0;
    const MesoExactOptions options = {.group = group};
    meso_arena_init(&arena);
    meso_random_init(&random, 1, 1);
    MesoTileSet set = fixture_set(&arena, 1, 3, labels, false, false, true);
    MesoSlotGraph graph = fixture_graph(&arena, 1);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK && variants.count == 3);
    CHECK(meso_propagation_init(&propagation, &arena, &(MesoTilingProblem){&set, &variants, &graph, NULL},
                                NULL) == MESO_OK);
    CHECK(meso_exact_init(&exact, &arena, &propagation, &options, NULL) == MESO_OK);
    while (meso_sat_solve(exact.sat, &answer, NULL, 0, 1000, NULL, NULL, NULL) == MESO_OK &&
           answer == MESO_SAT_YES) {
        uint32_t variant;
        CHECK(meso_exact_extract(&exact, &variant, &random, NULL) == MESO_OK && variant < 3);
        CHECK(!(found & 1u << variant));
        found |= 1u << variant;
        int32_t other = -meso_exact_literal(&exact, 0, variant);
        CHECK(meso_exact_add(&exact, &other, 1, NULL) == MESO_OK);
    }
    CHECK(answer == MESO_SAT_NO && found == 7);
    meso_exact_release(&exact);
    meso_propagation_release(&propagation);
    meso_arena_release(&arena);
}

/* Same arguments, same assignment; another seed, another one. */
static void test_determinism(void)
{
    static const int32_t labels[3][4] = {{1, 2, -1, -2}, {1, 2, 2, -1}, {1, 1, 2, 2}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 3, labels, true, true, false);
    MesoSlotGraph graph = fixture_grid(&arena, 12, 12, true, true, false);
    MesoSolveResult a = fixture_solve_by(MESO_ENGINE_EXACT, &arena, &set, &graph, 5, 1);
    MesoSolveResult b = fixture_solve_by(MESO_ENGINE_EXACT, &arena, &set, &graph, 5, 1);
    MesoSolveResult c = fixture_solve_by(MESO_ENGINE_EXACT, &arena, &set, &graph, 6, 1);
    CHECK(a.verdict == MESO_VERDICT_SOLVED && a.decider == MESO_DECIDER_EXACT);
    CHECK(memcmp(a.assignment.tile, b.assignment.tile, 144 * sizeof *a.assignment.tile) == 0);
    CHECK(memcmp(a.assignment.transform, b.assignment.transform, 144) == 0);
    CHECK(memcmp(a.assignment.transform, c.assignment.transform, 144) != 0);
    meso_arena_release(&arena);
}

int main(void)
{
    test_reach();
    test_own_clauses();
    test_determinism();
    return 0;
}
