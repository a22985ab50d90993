/* Chains and rings against every assignment, and what the engine makes of them against brute force. */
#include <string.h>

#include "libcore/tiling/exact/chain_rings.h"
#include "libcore/tiling/exact/chain_search.h"
#include "libcore/tiling/exact/exact_cubes.h"
#include "libcore/tiling/fixture/brute_force.h"
#include "libcore/tiling/fixture/random_case.h"

typedef struct Case {
    MesoTileSet set;
    MesoSlotGraph graph;
    MesoVariantSet variants;
    MesoPropagation propagation;
} Case;

static void begin(Case *c, MesoArena *arena, MesoTileSet set, MesoSlotGraph graph)
{
    *c = (Case){.set = set, .graph = graph};
    CHECK(meso_variant_set_build(&c->variants, arena, &c->set, NULL) == MESO_OK);
    CHECK(meso_propagation_init(&c->propagation, arena, &(MesoTilingProblem){&c->set, &c->variants, &c->graph, NULL},
                                NULL) == MESO_OK);
}

/*
 * Straight strands a and b that cross: opposite sides show opposite labels, so that each
 * strip of slots has the same on all of its edges, and either a or b runs along it.
 */
static void test_strips(void)
{
    static const int32_t cross[1][4] = {{1, 2, -1, -2}};
    MesoArena arena;
    Case c;
    MesoLabelPatternTable table;
    MesoEdgeChains chains;
    meso_arena_init(&arena);
    begin(&c, &arena, fixture_set(&arena, 2, 1, cross, true, true, true),
          fixture_grid(&arena, 5, 3, true, true, false));
    CHECK(meso_label_pattern_table_init(&table, &arena, &c.propagation, NULL, NULL) == MESO_OK);
    CHECK(meso_edge_chains_find(&chains, &arena, &table, NULL) == MESO_OK);
    uint32_t lengths[64] = {0};
    CHECK(chains.chain_count > 0 && chains.chain_count <= 64);
    for (uint32_t i = 0; i < chains.link_count; i++)
        lengths[chains.links[i].chain]++;
    /* Two bits of each of the three and five strips, {a, b} and {a, b'}; of all edges together, {a, a'}, by turns. */
    uint32_t by_length[31] = {0};
    for (uint32_t i = 0; i < chains.chain_count; i++) {
        CHECK(lengths[i] <= 30);
        by_length[lengths[i]]++;
    }
    CHECK(by_length[5] == 2 * 3 && by_length[3] == 2 * 5 && by_length[30] == 1 && chains.chain_count == 17);
    meso_propagation_release(&c.propagation);
    meso_arena_release(&arena);
}

/* The bit of a link's chain under the assignment `variant`. */
static bool link_bit(const Case *c, const MesoChainLink *link, const uint32_t *variant)
{
    uint32_t twin = c->graph.twin[link->edge];
    const uint64_t *labels = meso_propagation_labels(&c->propagation, link->edge);
    uint32_t code = c->propagation.codes[4 * (size_t)variant[twin / 4] + twin % 4];
    CHECK(meso_bits_test(labels, code));
    return (bool)(link->ranks >> meso_bits_rank(labels, code) & 1) != link->negated;
}

static uint32_t chains_met, rings_met;

/*
 * Every assignment shows one and the same bit on all edges of a chain, and no ring contradicts these.
 * Up to TABLE_CHAINS chains, `shown` [2 to the power of them] tells which bits the assignments show.
 */
enum { TABLE_CHAINS = 12 };

static void check_chains(MesoArena *arena, const Case *c, const MesoEdgeChains *chains, MesoChainRings *rings,
                         const BruteForce *force, bool *shown)
{
    uint8_t *seen = MESO_NEW(arena, uint8_t, chains->chain_count, NULL);
    bool *values = MESO_NEW(arena, bool, chains->chain_count, NULL);
    for (uint64_t i = 0; i < force->count; i++) {
        uint32_t variant[BRUTE_FORCE_SLOTS], index = 0;
        uint64_t number = force->numbers[i];
        for (uint32_t s = 0; s < c->graph.slot_count; s++, number /= c->variants.count)
            variant[s] = (uint32_t)(number % c->variants.count);
        memset(seen, 0, chains->chain_count);
        for (uint32_t l = 0; l < chains->link_count; l++)
            seen[chains->links[l].chain] |= (uint8_t)(1 << link_bit(c, &chains->links[l], variant));
        for (uint32_t k = 0; k < chains->chain_count; k++) {
            CHECK(seen[k] == 1 || seen[k] == 2);
            values[k] = seen[k] == 2;
            index |= k < TABLE_CHAINS ? (uint32_t)values[k] << k : 0;
        }
        if (rings->possible) {
            MesoRingCount count = meso_chain_rings_count(rings, values);
            CHECK(count.contradictions == 0);
            rings_met += count.rings;
        }
        if (chains->chain_count <= TABLE_CHAINS)
            shown[index] = true;
    }
    chains_met += chains->chain_count;
}

static uint32_t tables_met, wrong_bits_met, wrong_bits_missed;

/*
 * Where rings are all that there is, bits that no assignment shows meet a contradiction: all but a few, where
 * what one slot has left takes something from its neighbours, which rings do not look at.
 */
static void check_all_bits(MesoArena *arena, MesoChainRings *rings, const bool *shown)
{
    bool *values = MESO_NEW(arena, bool, rings->chain_count, NULL);
    if (!rings->possible || rings->chain_count > TABLE_CHAINS)
        return;
    for (uint32_t bits = 0; bits < 1u << rings->chain_count; bits++) {
        for (uint32_t k = 0; k < rings->chain_count; k++)
            values[k] = bits >> k & 1;
        bool contradiction = meso_chain_rings_count(rings, values).contradictions > 0;
        CHECK(!contradiction || !shown[bits]);
        wrong_bits_met += !shown[bits];
        wrong_bits_missed += !shown[bits] && !contradiction;
    }
    tables_met++;
}

static uint32_t found, not_found;

/* The search finds an assignment; none where there is none, or, where there is more than rings, now and then. */
static void check_search(MesoArena *arena, const Case *c, const BruteForce *force, uint64_t seed, bool only_rings)
{
    MesoExact exact;
    MesoRandom random;
    MesoSatAnswer answer;
    const MesoExactOptions options = {.chains = true};
    meso_random_init(&random, seed, 2);
    CHECK(meso_exact_init(&exact, arena, &c->propagation, &options, NULL) == MESO_OK);
    CHECK(meso_exact_search_chains(&exact, &answer, &random, 100000, 20000, NULL, NULL, NULL) == MESO_OK);
    CHECK(answer != MESO_SAT_NO && (answer != MESO_SAT_YES || force->count > 0));
    CHECK(exact.chain_count || answer == MESO_SAT_UNKNOWN);
    CHECK(!only_rings || exact.chain_count == 0 || (answer == MESO_SAT_YES) == (force->count > 0));
    found += answer == MESO_SAT_YES;
    not_found += answer != MESO_SAT_YES && force->count > 0 && exact.chain_count > 0;
    meso_exact_release(&exact);
}

static uint32_t answers[3];

/* With hardly a conflict for each cube all of the answer comes from splitting. */
static void check_cubes(MesoArena *arena, const Case *c, const BruteForce *force, uint64_t seed)
{
    MesoExact exact;
    MesoRandom random;
    MesoSatAnswer answer;
    const MesoExactOptions options = {.chains = true};
    meso_random_init(&random, seed, 1);
    CHECK(meso_exact_init(&exact, arena, &c->propagation, &options, NULL) == MESO_OK);
    CHECK(meso_exact_conquer(&exact, &answer, &random, 1, 1000000, NULL, NULL, NULL) == MESO_OK);
    answers[answer]++;
    CHECK(exact.chain_count ? answer == (force->count ? MESO_SAT_YES : MESO_SAT_NO) : answer == MESO_SAT_UNKNOWN);
    if (answer == MESO_SAT_YES) {
        uint32_t variant[BRUTE_FORCE_SLOTS];
        CHECK(meso_exact_extract(&exact, variant, &random, NULL) == MESO_OK);
        uint64_t number = brute_force_number(force, variant), i = 0;
        while (i < force->count && force->numbers[i] != number)
            i++;
        CHECK(i < force->count || force->count == force->most);
    }
    meso_exact_release(&exact);
}

static void check_case(MesoArena *arena, MesoTileSet set, MesoSlotGraph graph, uint64_t seed, bool only_rings)
{
    Case c;
    MesoLabelPatternTable table;
    MesoEdgeChains chains;
    MesoChainRings rings;
    begin(&c, arena, set, graph);
    if (c.propagation.initial_dead_count == 0) {
        bool shown[1 << TABLE_CHAINS] = {false};
        BruteForce force = brute_force(arena, &c.set, &c.graph, only_rings ? 100000 : 500, true);
        CHECK(meso_label_pattern_table_init(&table, arena, &c.propagation, NULL, NULL) == MESO_OK);
        CHECK(meso_edge_chains_find(&chains, arena, &table, NULL) == MESO_OK);
        CHECK(meso_chain_rings_build(&rings, arena, &table, &chains, NULL) == MESO_OK);
        check_chains(arena, &c, &chains, &rings, &force, shown);
        if (only_rings && force.count < force.most)
            check_all_bits(arena, &rings, shown);
        check_cubes(arena, &c, &force, seed);
        check_search(arena, &c, &force, seed, only_rings);
    }
    meso_propagation_release(&c.propagation);
}

/* A crossing, and a turn of both strands to the right: chains everywhere, and an odd corner to get around. */
static const int32_t weave[2][4] = {{1, 2, -1, -2}, {-2, 1, -1, 2}};

/*
 * Two strands that cross, either way round, and turns of both ends of each. Opposite sides show one of {a, b'}
 * and one of {a', b}; once it is said which, two pairs of neighbouring sides say a or b together.
 */
static const int32_t turns[4][4] = {{1, 2, -1, -2}, {1, -2, -1, 2}, {2, 1, 1, 2}, {-1, -1, -2, -2}};

static void test_brute_force(void)
{
    MesoArena arena;
    MesoRandom random;
    meso_arena_init(&arena);
    meso_random_init(&random, 3, 0);
    for (uint32_t i = 0; i < 1000; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        check_case(&arena, random_set(&arena, &random), random_graph(&arena, &random), i, false);
        check_case(&arena, random_set(&arena, &random), fixture_grid(&arena, 2 + i % 2, 2, i & 2, i & 4, i & 8), i,
                   false);
        check_case(&arena, fixture_set(&arena, 2, 2, weave, true, true, true), random_graph(&arena, &random), i, false);
        check_case(&arena, fixture_set(&arena, 2, 4, turns, true, false, false), random_graph(&arena, &random), i,
                   true);
        check_case(&arena, fixture_set(&arena, 2, 4, turns, true, false, false),
                   fixture_grid(&arena, 2 + i % 2, 2, i & 2, i & 4, i & 8), i, true);
        meso_arena_rewind(&arena, mark);
    }
    CHECK(chains_met > 1000 && answers[MESO_SAT_YES] > 100 && answers[MESO_SAT_NO] > 10);
    CHECK(rings_met > 1000 && tables_met > 100 && wrong_bits_met > 100 && 10 * wrong_bits_missed < wrong_bits_met);
    CHECK(found > 500 && not_found < found / 50);
    meso_arena_release(&arena);
}

int main(void)
{
    test_strips();
    test_brute_force();
    return 0;
}
