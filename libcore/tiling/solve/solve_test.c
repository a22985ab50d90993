/* Solver: verdicts against brute force, borders, gluings, dead ends, determinism. */
#include <string.h>

#include "libcore/tiling/fixture/brute_force.h"
#include "libcore/tiling/fixture/random_case.h"
#include "libcore/tiling/search/search.h"

static uint32_t verdict_counts[3][2];

/* The search alone may give up, but never lies. */
static void compare_search(MesoArena *arena, const MesoTileSet *set, const MesoSlotGraph *graph,
                           uint64_t seed, bool tiling)
{
    MesoSolveResult result = fixture_solve(arena, set, graph, seed, 5);
    verdict_counts[result.verdict][tiling]++;
    switch (result.verdict) {
    case MESO_VERDICT_SOLVED:
        CHECK(tiling && result.decider == MESO_DECIDER_SEARCH);
        CHECK(meso_assignment_check(&result.assignment, set, graph, NULL) == MESO_OK);
        CHECK(result.dead_end_total == result.attempts || result.dead_end_total == result.attempts - 1);
        break;
    case MESO_VERDICT_UNSOLVABLE:
        CHECK(!tiling && result.dead_end_total >= 1);
        if (result.decider == MESO_DECIDER_PROPAGATION)
            CHECK(result.attempts == 0 && result.dead_ends[0].initial && result.dead_ends[0].attempt == 0);
        else
            CHECK(result.decider == MESO_DECIDER_SEARCH && result.attempts >= 1 && *result.reason);
        break;
    case MESO_VERDICT_GAVE_UP:
        CHECK(result.decider == MESO_DECIDER_ATTEMPTS && result.attempts == 5);
        CHECK(result.dead_end_total == 5 && result.dead_end_count == 5);
        CHECK(!result.dead_ends[4].initial && result.dead_ends[4].attempt == 5);
        break;
    }
}

static uint32_t probing_proofs;

/* Probing proves nothing wrong, and leaves the search what it needs. */
static void compare_probing(MesoArena *arena, const MesoTileSet *set, const MesoSlotGraph *graph,
                            uint64_t seed, bool tiling)
{
    MesoVariantSet variants;
    MesoPropagation propagation;
    MesoSearchOutcome outcome;
    CHECK(meso_variant_set_build(&variants, arena, set, NULL) == MESO_OK);
    CHECK(meso_propagation_init(&propagation, arena, &(MesoTilingProblem){set, &variants, graph, NULL},
                                NULL) == MESO_OK);
    if (propagation.initial_dead_count == 0) {
        MesoSearch search = {.propagation = &propagation, .max_observations = UINT64_MAX};
        meso_random_init(&search.random, seed, 1);
        CHECK(meso_search_probe(&search, UINT64_MAX, &outcome, NULL) == MESO_OK);
        CHECK(outcome == MESO_SEARCH_STUCK || (outcome == MESO_SEARCH_IMPOSSIBLE && !tiling));
        probing_proofs += outcome == MESO_SEARCH_IMPOSSIBLE;
        for (uint32_t i = 0; outcome == MESO_SEARCH_STUCK && tiling && i < 20; i++) {
            meso_propagation_restart(&propagation);
            CHECK(meso_search_attempt(&search, &outcome, NULL) == MESO_OK);
        }
        CHECK(!tiling || outcome == MESO_SEARCH_DONE);
    }
    meso_propagation_release(&propagation);
}

static void compare_with_brute_force(MesoArena *arena, const MesoTileSet *set,
                                     const MesoSlotGraph *graph, uint64_t seed)
{
    bool tiling = brute_force(arena, set, graph, 1, false).count > 0;
    compare_search(arena, set, graph, seed, tiling);
    compare_probing(arena, set, graph, seed, tiling);
    MesoVerdict expected = tiling ? MESO_VERDICT_SOLVED : MESO_VERDICT_UNSOLVABLE;
    CHECK(fixture_solve_by(MESO_ENGINE_EXACT, arena, set, graph, seed, 1).verdict == expected);
    CHECK(fixture_solve_by(MESO_ENGINE_AUTO, arena, set, graph, seed, 1).verdict == expected);
}

static void test_brute_force(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoRandom random;
    meso_random_init(&random, 7, 0);
    for (uint32_t i = 0; i < 2000; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        MesoTileSet set = random_set(&arena, &random);
        MesoSlotGraph graph = random_graph(&arena, &random);
        compare_with_brute_force(&arena, &set, &graph, i);
        for (uint32_t shape = 0; shape < 4; shape++) {
            graph = fixture_grid(&arena, 2 + i % 2, 2, shape >= 1, shape == 2, shape == 3);
            compare_with_brute_force(&arena, &set, &graph, i);
        }
        meso_arena_rewind(&arena, mark);
    }
    /* Every kind of case was met; on such small graphs giving up means almost surely that there is none. */
    CHECK(verdict_counts[MESO_VERDICT_SOLVED][true] > 1000);
    CHECK(probing_proofs > 10);
    CHECK(verdict_counts[MESO_VERDICT_UNSOLVABLE][false] > 1000);
    CHECK(verdict_counts[MESO_VERDICT_GAVE_UP][true] * 10 <= verdict_counts[MESO_VERDICT_GAVE_UP][false]);
    meso_arena_release(&arena);
}

/* A side glued to another of the same slot wants opposite labels within one variant. */
static void test_self_glued(void)
{
    static const int32_t same[1][4] = {{1, 1, 2, 2}}, opposite[2][4] = {{1, 1, 2, 2}, {1, -1, 2, -2}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoSlotGraph graph = fixture_graph(&arena, 1);
    fixture_glue(&graph, 0, 0, 0, 1);

    MesoTileSet set = fixture_set(&arena, 2, 1, same, true, false, false);
    MesoSolveResult result = fixture_solve(&arena, &set, &graph, 0, 5);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE && result.dead_end_count == 1);
    CHECK(result.dead_ends[0].labels[0][0] == 0xf && !result.dead_ends[0].border[0]);
    CHECK(result.dead_ends[0].border[2] && result.dead_ends[0].border[3]);

    set = fixture_set(&arena, 2, 2, opposite, true, false, false);
    result = fixture_solve(&arena, &set, &graph, 0, 5);
    CHECK(result.verdict == MESO_VERDICT_SOLVED && result.assignment.tile[0] == 1);
    meso_arena_release(&arena);
}

/* On the 3 x 3 grid every border side must show b and no inner side may: nine slots, nine tiles. */
static void test_borders(void)
{
    static const int32_t labels[3][4] = {{1, 1, 1, 1}, {2, 1, 1, 1}, {2, 2, 1, 1}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 3, labels, true, true, false);
    set.interfaces[0].border_exempt = true;
    set.interfaces[1].border_only = true;
    MesoSlotGraph graph = fixture_grid(&arena, 3, 3, false, false, false);
    MesoSolveResult result = fixture_solve(&arena, &set, &graph, 3, 100);
    CHECK(result.verdict == MESO_VERDICT_SOLVED && result.assignment.slot_count == 9);
    for (uint32_t s = 0; s < 9; s++) {
        uint32_t borders = (uint32_t)(s % 3 != 1) + (uint32_t)(s / 3 != 1);
        CHECK(result.assignment.tile[s] == borders);
    }
    meso_arena_release(&arena);
}

/*
 *     [0][1][2]    c may lie on a border alone, and nothing may turn
 *
 * Only t0 = (b a c a) fits slot 0, only t1 = (c a a a) slot 2; slot 1 would have
 * to show b' on its left and a' on its right.
 */
static void test_dead_end_content(void)
{
    static const int32_t labels[2][4] = {{2, 1, 3, 1}, {3, 1, 1, 1}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 2, labels, false, false, false);
    set.interfaces[2].border_only = true;
    MesoSlotGraph graph = fixture_grid(&arena, 3, 1, false, false, false);
    MesoSolveResult result = fixture_solve(&arena, &set, &graph, 0, 5);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE);
    CHECK(result.dead_end_total == 1 && result.dead_end_count == 1);
    const MesoDeadEnd *end = &result.dead_ends[0];
    CHECK(end->slot == 1 && end->initial && result.label_word_count == 1);
    CHECK(!end->border[0] && end->border[1] && !end->border[2] && end->border[3]);
    CHECK(end->labels[0][0] == (uint64_t)1 << meso_label_code(-1));
    CHECK(end->labels[2][0] == (uint64_t)1 << meso_label_code(-2));
    CHECK(end->labels[1][0] == 0x3f && end->labels[3][0] == 0x3f);

    /* Fewer are kept than were met. */
    set.interfaces[0].border_exempt = true;
    MesoVariantSet variants;
    MesoSolveOptions options = {.max_attempts = 1, .max_dead_ends = 2};
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    CHECK(meso_solve(&result, &arena, &(MesoTilingProblem){&set, &variants, &graph, NULL},
                     &options, NULL) == MESO_OK);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE);
    CHECK(result.dead_end_total == 3 && result.dead_end_count == 2 && result.dead_ends[1].slot == 1);
    CHECK(result.dead_ends[0].labels[0][0] == 0xf);
    meso_arena_release(&arena);
}

static const int32_t osier[4][4] = {{1, 2, -1, -2}, {1, 2, -1, -3}, {3, 2, -1, -2}, {3, 2, -1, -3}};

static void test_determinism(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 4, osier, true, true, true);
    MesoSlotGraph graph = fixture_grid(&arena, 40, 30, true, false, true);
    MesoSolveResult a = fixture_solve(&arena, &set, &graph, 5, 20);
    MesoSolveResult b = fixture_solve(&arena, &set, &graph, 5, 20);
    MesoSolveResult c = fixture_solve(&arena, &set, &graph, 6, 20);
    CHECK(a.verdict == MESO_VERDICT_SOLVED && c.verdict == MESO_VERDICT_SOLVED);
    CHECK(a.observations == b.observations && a.attempts == b.attempts);
    CHECK(memcmp(a.assignment.tile, b.assignment.tile, 1200 * sizeof *a.assignment.tile) == 0);
    CHECK(memcmp(a.assignment.transform, b.assignment.transform, 1200) == 0);
    CHECK(memcmp(a.assignment.tile, c.assignment.tile, 1200 * sizeof *a.assignment.tile) != 0);
    meso_arena_release(&arena);
}

/* Over many seeds, a slot without neighbours takes each variant about as often as any other. */
static void test_choice(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 4, osier, false, false, false);
    MesoSlotGraph graph = fixture_graph(&arena, 1);
    uint32_t counts[4] = {0};
    for (uint64_t seed = 0; seed < 4000; seed++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        counts[fixture_solve(&arena, &set, &graph, seed, 1).assignment.tile[0]]++;
        meso_arena_rewind(&arena, mark);
    }
    for (uint32_t t = 0; t < 4; t++)
        CHECK(counts[t] > 880 && counts[t] < 1120);
    meso_arena_release(&arena);
}

static void count_call(void *context, uint64_t done, uint64_t total)
{
    uint64_t *calls = context;
    CHECK(done <= total && total == 10000);
    (*calls)++;
}

static void test_limits(void)
{
    MesoArena arena;
    MesoError error;
    MesoSolveResult result;
    MesoVariantSet variants;
    uint64_t calls = 0;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 4, osier, true, true, true);
    MesoSlotGraph graph = fixture_grid(&arena, 100, 100, true, true, false);
    MesoSolveOptions options = {.max_attempts = 1, .progress = count_call, .progress_context = &calls};
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
    CHECK(variants.count == 32);
    CHECK(meso_solve(&result, &arena, &(MesoTilingProblem){&set, &variants, &graph, NULL},
                     &options, &error) == MESO_OK);
    CHECK(result.verdict == MESO_VERDICT_SOLVED && calls >= 2);

    variants.count = 0;
    CHECK(meso_solve(&result, &arena, &(MesoTilingProblem){&set, &variants, &graph, NULL},
                     &options, &error) == MESO_ERR_INPUT);
    meso_arena_release(&arena);
}

/* A collection in the middle of a search changes numbers, but nothing that can be seen. */
static void test_collection(void)
{
    MesoArena arena;
    MesoVariantSet variants;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 4, osier, true, true, true);
    MesoSlotGraph graph = fixture_grid(&arena, 20, 20, true, true, false);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);

    MesoPropagation often, never;
    CHECK(meso_propagation_init(&often, &arena, &(MesoTilingProblem){&set, &variants, &graph, NULL},
                                NULL) == MESO_OK);
    CHECK(meso_propagation_init(&never, &arena, &(MesoTilingProblem){&set, &variants, &graph, NULL},
                                NULL) == MESO_OK);
    MesoRandom random, same_random;
    meso_random_init(&random, 1, 1);
    same_random = random;
    while (never.queue.count) {
        uint32_t slot = meso_bucket_queue_draw(&never.queue, &random);
        CHECK(meso_bucket_queue_draw(&often.queue, &same_random) == slot);
        uint32_t variant = meso_domain_variant(&never.domains, never.state[slot], 0);
        CHECK(meso_domain_variant(&often.domains, often.state[slot], 0) == variant);
        often.collect_at = 0;
        CHECK(meso_propagation_assign(&often, slot, variant, NULL) == MESO_OK);
        CHECK(meso_propagation_assign(&never, slot, variant, NULL) == MESO_OK);
        CHECK(often.dead_slot == never.dead_slot && often.queue.count == never.queue.count);
        if (never.dead_slot != MESO_NO_INDEX) {
            meso_propagation_restart(&often);
            meso_propagation_restart(&never);
        }
    }
    meso_propagation_release(&often);
    meso_propagation_release(&never);
    meso_arena_release(&arena);
}

int main(void)
{
    test_brute_force();
    test_self_glued();
    test_borders();
    test_dead_end_content();
    test_determinism();
    test_choice();
    test_limits();
    test_collection();
    return 0;
}
