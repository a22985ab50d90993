/* Counting and parity provers: what they must find, and that they never prove what is wrong. */
#include <string.h>

#include "libcore/tiling/fixture/brute_force.h"
#include "libcore/tiling/proof/counting.h"
#include "libcore/tiling/proof/parity.h"

typedef struct Found {
    bool dead;              /* by the initial propagation, so that there is nothing to count */
    MesoCountingProof counting;
    bool parity;
    const char *words;
} Found;

static Found prove(MesoArena *arena, const MesoTileSet *set, const MesoSlotGraph *graph)
{
    Found found = {0};
    MesoVariantSet variants;
    MesoPropagation propagation;
    MesoLabelPatternTable table;
    uint32_t slot;
    bool holds;
    CHECK(meso_variant_set_build(&variants, arena, set, NULL) == MESO_OK);
    CHECK(meso_propagation_init(&propagation, arena, &(MesoTilingProblem){set, &variants, graph, NULL},
                                NULL) == MESO_OK);
    found.dead = propagation.initial_dead_count > 0;
    if (!found.dead) {
        CHECK(meso_label_pattern_table_init(&table, arena, &propagation, NULL, NULL) == MESO_OK);
        CHECK(meso_counting_prove(&found.counting, arena, &table, NULL) == MESO_OK);
        CHECK(meso_counting_check(&found.counting, &holds, arena, &table, NULL) == MESO_OK);
        CHECK(holds == found.counting.found);
        found.words = meso_counting_explain(&found.counting, arena, set, NULL);
        CHECK(found.words);
        CHECK(meso_parity_prove(&slot, arena, &table, UINT64_MAX, NULL) == MESO_OK);
        found.parity = slot != MESO_NO_INDEX;
        CHECK(!found.parity || slot < graph->slot_count);
        /* An effort of nothing proves nothing. */
        CHECK(meso_parity_prove(&slot, arena, &table, 0, NULL) == MESO_OK && slot == MESO_NO_INDEX);
    }
    meso_propagation_release(&propagation);
    return found;
}

/* Each tile shows a once: there must be an even number of slots on a closed surface. */
static void test_parity(void)
{
    static const int32_t labels[2][4] = {{1, 2, -2, 2}, {1, 2, 2, 2}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 2, labels, true, true, false);
    for (uint32_t width = 3; width < 9; width++) {
        MesoSlotGraph graph = fixture_grid(&arena, width, 5, true, true, false);
        Found found = prove(&arena, &set, &graph);
        CHECK(found.counting.found == (width % 2 == 1) && found.parity == found.counting.found);
        if (!found.counting.found)
            continue;
        CHECK(found.counting.parity && found.counting.slot_count == 5 * width);
        CHECK(strstr(found.words, "slot 0 ") && strstr(found.words, "'a'"));
        MesoSolveResult result = fixture_solve_by(MESO_ENGINE_AUTO, &arena, &set, &graph, 1, 2);
        CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE && result.decider == MESO_DECIDER_COUNTING);
        CHECK(strcmp(result.reason, found.words) == 0);
    }
    meso_arena_release(&arena);
}

/* A pair of slots, and a ring of three, whose upper and lower sides are glued: the ring is the odd piece. */
static void test_piece(void)
{
    static const int32_t labels[1][4] = {{1, 1, 1, 2}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 1, labels, true, true, false);
    MesoSlotGraph graph = fixture_graph(&arena, 5);
    fixture_glue(&graph, 0, 0, 1, 0);
    CHECK(!prove(&arena, &set, &graph).counting.found);
    for (uint32_t s = 2; s < 5; s++) {
        fixture_glue(&graph, s, 0, s == 4 ? 2 : s + 1, 2);
        fixture_glue(&graph, s, 1, s == 4 ? 2 : s + 1, 3);
    }
    Found found = prove(&arena, &set, &graph);
    CHECK(!found.dead && found.parity && found.counting.found && found.counting.parity);
    CHECK(found.counting.first_slot == 2 && found.counting.slot_count == 3);
    meso_arena_release(&arena);
}

/* More a than a' on each tile, twice or four times: no closed surface has that. */
static void test_balance(void)
{
    static const int32_t labels[2][4] = {{1, 1, 1, -1}, {1, 1, 1, 1}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 1, 2, labels, true, false, false);
    MesoSlotGraph graph = fixture_grid(&arena, 6, 6, true, true, false);
    Found found = prove(&arena, &set, &graph);
    CHECK(found.counting.found && !found.counting.parity && found.counting.weights[0] == 1);
    CHECK(strstr(found.words, "show 'a' more often"));
    MesoSolveResult result = fixture_solve_by(MESO_ENGINE_EXACT, &arena, &set, &graph, 1, 1);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE && result.decider == MESO_DECIDER_COUNTING);

    /* With a border there is a place for what is left over. */
    graph = fixture_grid(&arena, 1, 4, false, true, false);
    CHECK(!prove(&arena, &set, &graph).counting.found);
    meso_arena_release(&arena);
}

/*
 * Tiles show a once, or three times; b elsewhere. Slots that lie on the border show
 * that side as they like, so that counting over all is in vain, but an odd sheet
 * whose border must show b, by its rules, has no tiling.
 */
static void test_border_rules(void)
{
    static const int32_t labels[2][4] = {{1, 2, 2, -2}, {1, 1, -1, 2}};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 2, labels, true, true, false);
    MesoSlotGraph graph = fixture_grid(&arena, 5, 5, false, false, false);
    Found found = prove(&arena, &set, &graph);
    CHECK(!found.dead && !found.counting.found && !found.parity);
    set.interfaces[0].border_exempt = true;
    found = prove(&arena, &set, &graph);
    CHECK(!found.dead && found.counting.found && found.counting.parity && found.parity);
    meso_arena_release(&arena);
}

/* On small cases of all kinds, nothing that has an assignment is ruled out; parity finds all that its counting does. */
static void test_soundness(void)
{
    MesoArena arena;
    MesoRandom random;
    uint32_t by_counting = 0, by_parity = 0;
    meso_arena_init(&arena);
    meso_random_init(&random, 3, 3);
    for (uint32_t i = 0; i < 1500; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        int32_t labels[3][4];
        uint32_t interfaces = 1 + meso_random_below(&random, 3);
        for (uint32_t l = 0; l < 12; l++) {
            int32_t label = 1 + (int32_t)meso_random_below(&random, interfaces);
            labels[l / 4][l % 4] = meso_random_below(&random, 2) ? label : -label;
        }
        MesoTileSet set = fixture_set(&arena, interfaces, 1 + meso_random_below(&random, 3),
                                      (const int32_t (*)[4])labels, meso_random_below(&random, 2),
                                      meso_random_below(&random, 2), false);
        MesoSlotGraph graph = fixture_grid(&arena, 1 + i % 3, 1 + i / 3 % 3, i & 16, i & 32, i & 64);
        Found found = prove(&arena, &set, &graph);
        bool tiling = brute_force(&arena, &set, &graph, 1, false).count > 0;
        CHECK(!tiling || !(found.dead || found.counting.found || found.parity));
        CHECK(!found.counting.found || !found.counting.parity || found.parity);
        by_counting += found.counting.found;
        by_parity += found.parity;
        meso_arena_rewind(&arena, mark);
    }
    CHECK(by_counting > 20 && by_parity > 20);
    meso_arena_release(&arena);
}

int main(void)
{
    test_parity();
    test_piece();
    test_balance();
    test_border_rules();
    test_soundness();
    return 0;
}
