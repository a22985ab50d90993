/* Exact engine and all of the ladder on every small case: verdicts, and that every assignment is reached. */
#include <stdlib.h>
#include <string.h>

#include "libcore/solve/brute_force.h"
#include "libcore/solve/exact.h"

/* The `number`-th tile over one interface: bit k says that side k shows a', not a. */
static void tile_labels(uint32_t number, int32_t labels[4])
{
    for (uint32_t k = 0; k < 4; k++)
        labels[k] = (number >> k) & 1 ? -1 : 1;
}

/* All sets of one to three of the 16 tiles, each with no transforms, with rotations, with all. */
enum { TILE_SETS = (16 + 16 * 15 / 2 + 16 * 15 * 14 / 6) * 3 };

static MesoTileSet small_set(MesoArena *arena, uint32_t number)
{
    int32_t labels[3][4];
    uint32_t permissions = number % 3, left = number / 3, mask = 1;
    while (__builtin_popcount(mask) > 3 || left > 0) {
        left -= __builtin_popcount(mask) <= 3;
        mask++;
    }
    uint32_t count = 0;
    for (; mask; mask &= mask - 1)
        tile_labels((uint32_t)__builtin_ctz(mask), labels[count++]);
    return fixture_set(arena, 1, count, (const int32_t (*)[4])labels, permissions >= 1, permissions == 2,
                       false);
}

static void check_case(MesoArena *arena, const MesoTileSet *set, const MesoSlotGraph *graph, uint64_t seed)
{
    MesoArenaMark mark = meso_arena_mark(arena);
    MesoVerdict expected = brute_force(arena, set, graph, 1, false).count ? MESO_VERDICT_SOLVED
                                                                           : MESO_VERDICT_UNSOLVABLE;
    CHECK(fixture_solve_by(MESO_ENGINE_EXACT, arena, set, graph, seed, 1).verdict == expected);
    CHECK(fixture_solve_by(MESO_ENGINE_AUTO, arena, set, graph, seed, 1).verdict == expected);
    meso_arena_rewind(arena, mark);
}

static uint32_t glued_cases;

/* Every way to glue the sides from `side` on, with one another or not at all; each with a few tile sets. */
static void check_gluings(MesoArena *arena, MesoSlotGraph *graph, uint32_t side)
{
    while (side < 4 * graph->slot_count && graph->twin[side] != MESO_NO_INDEX)
        side++;
    if (side == 4 * graph->slot_count) {
        for (uint32_t i = 0; i < 4; i++) {
            MesoArenaMark mark = meso_arena_mark(arena);
            MesoTileSet set = small_set(arena, (glued_cases++ * 389) % TILE_SETS);
            check_case(arena, &set, graph, glued_cases);
            meso_arena_rewind(arena, mark);
        }
        return;
    }
    check_gluings(arena, graph, side + 1);
    for (uint32_t other = side + 1; other < 4 * graph->slot_count; other++) {
        if (graph->twin[other] != MESO_NO_INDEX)
            continue;
        graph->twin[side] = other;
        graph->twin[other] = side;
        check_gluings(arena, graph, side + 1);
        graph->twin[side] = graph->twin[other] = MESO_NO_INDEX;
    }
}

/* One and two slots glued in all ways: two faces that share up to four edges, and faces glued to themselves. */
static void test_gluings(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    for (uint32_t count = 1; count <= 2; count++) {
        MesoSlotGraph graph = fixture_graph(&arena, count);
        check_gluings(&arena, &graph, 0);
    }
    CHECK(glued_cases == 4 * (10 + 764));
    meso_arena_release(&arena);
}

/* All small sets on a strip, a sheet, a ring, a Moebius band and a torus of up to six slots. */
static void test_grids(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoSlotGraph graphs[] = {
        fixture_grid(&arena, 3, 1, true, false, false), fixture_grid(&arena, 3, 2, false, false, false),
        fixture_grid(&arena, 3, 2, true, false, true),  fixture_grid(&arena, 3, 2, true, true, false),
        fixture_grid(&arena, 5, 1, true, true, false),
    };
    for (uint32_t i = 0; i < TILE_SETS; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        MesoTileSet set = small_set(&arena, i);
        for (uint32_t g = 0; g < sizeof graphs / sizeof *graphs; g++)
            check_case(&arena, &set, &graphs[g], i);
        meso_arena_rewind(&arena, mark);
    }
    meso_arena_release(&arena);
}

static int compare_numbers(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Over many seeds the engine finds every assignment that there is. */
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
        CHECK(result.verdict == MESO_VERDICT_SOLVED);
        uint64_t number = brute_force_find(&force, &result.assignment);
        const uint64_t *found = bsearch(&number, force.numbers, force.count, sizeof number, compare_numbers);
        CHECK(found);
        unmet -= met[found - force.numbers]++ == 0;
        meso_arena_rewind(&arena, mark);
    }
    meso_arena_release(&arena);
}

static void test_reach(void)
{
    static const int32_t corner[1][4] = {{1, 1, -1, -1}}, mixed[2][4] = {{1, 2, -1, -2}, {1, 2, 2, -1}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet sets[] = {fixture_set(&arena, 1, 1, corner, true, true, true),
                          fixture_set(&arena, 2, 2, mixed, true, true, false)};
    MesoSlotGraph graphs[] = {fixture_grid(&arena, 2, 2, true, true, false),
                              fixture_grid(&arena, 2, 1, true, false, true)};
    for (uint32_t i = 0; i < 4; i++)
        for (MesoEngine engine = MESO_ENGINE_AUTO; engine <= MESO_ENGINE_EXACT; engine++)
            check_reach(engine, &sets[i / 2], &graphs[i % 2], 2);
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
    CHECK(meso_propagation_init(&propagation, &arena, &set, &variants, &graph, NULL, NULL) == MESO_OK);
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
    test_gluings();
    test_grids();
    test_reach();
    test_own_clauses();
    test_determinism();
    return 0;
}
