/* Chains against every assignment, and the engine split by them against brute force. */
#include <string.h>

#include "libcore/solve/brute_force.h"
#include "libcore/solve/carry.h"
#include "libcore/solve/exact_cubes.h"
#include "libcore/solve/random_case.h"

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
    CHECK(meso_propagation_init(&c->propagation, arena, &c->set, &c->variants, &c->graph, NULL, NULL) == MESO_OK);
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
    MesoPatternTable table;
    MesoCarry carry;
    meso_arena_init(&arena);
    begin(&c, &arena, fixture_set(&arena, 2, 1, cross, true, true, true),
          fixture_grid(&arena, 5, 3, true, true, false));
    CHECK(meso_pattern_table_init(&table, &arena, &c.propagation, NULL, NULL) == MESO_OK);
    CHECK(meso_carry_find(&carry, &arena, &table, NULL) == MESO_OK);
    uint32_t lengths[64] = {0};
    CHECK(carry.chain_count > 0 && carry.chain_count <= 64);
    for (uint32_t i = 0; i < carry.link_count; i++)
        lengths[carry.links[i].chain]++;
    /* Two bits of each of the three and five strips, {a, b} and {a, b'}; of all edges together, {a, a'}, by turns. */
    uint32_t by_length[31] = {0};
    for (uint32_t i = 0; i < carry.chain_count; i++) {
        CHECK(lengths[i] <= 30);
        by_length[lengths[i]]++;
    }
    CHECK(by_length[5] == 2 * 3 && by_length[3] == 2 * 5 && by_length[30] == 1 && carry.chain_count == 17);
    meso_propagation_release(&c.propagation);
    meso_arena_release(&arena);
}

/* The bit of a link's chain under the assignment `variant`. */
static bool link_bit(const Case *c, const MesoCarryLink *link, const uint32_t *variant)
{
    const MesoPropagation *propagation = &c->propagation;
    uint32_t state = propagation->initial[link->edge / 4], twin = c->graph.twin[link->edge], rank = 0;
    const uint64_t *labels = meso_domain_labels(&propagation->domains, propagation->domains.domains[state].allow[link->edge % 4]);
    uint32_t code = propagation->codes[4 * (size_t)variant[twin / 4] + twin % 4];
    CHECK(meso_bits_test(labels, code));
    for (uint32_t i = 0; i < code; i++)
        rank += meso_bits_test(labels, i);
    return (bool)(link->ranks >> rank & 1) != link->negated;
}

static uint32_t chains_met;

/* Every assignment shows one and the same bit on all edges of a chain. */
static void check_chains(MesoArena *arena, const Case *c, MesoPatternTable *table, const BruteForce *force)
{
    MesoCarry carry;
    CHECK(meso_carry_find(&carry, arena, table, NULL) == MESO_OK);
    uint8_t *seen = MESO_NEW(arena, uint8_t, carry.chain_count, NULL);
    for (uint64_t i = 0; i < force->count; i++) {
        uint32_t variant[BRUTE_FORCE_SLOTS];
        uint64_t number = force->numbers[i];
        for (uint32_t s = 0; s < c->graph.slot_count; s++, number /= c->variants.count)
            variant[s] = (uint32_t)(number % c->variants.count);
        memset(seen, 0, carry.chain_count);
        for (uint32_t l = 0; l < carry.link_count; l++)
            seen[carry.links[l].chain] |= (uint8_t)(1 << link_bit(c, &carry.links[l], variant));
        for (uint32_t k = 0; k < carry.chain_count; k++)
            CHECK(seen[k] == 1 || seen[k] == 2);
    }
    chains_met += carry.chain_count;
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

static void check_case(MesoArena *arena, MesoTileSet set, MesoSlotGraph graph, uint64_t seed)
{
    Case c;
    MesoPatternTable table;
    begin(&c, arena, set, graph);
    if (c.propagation.initial_dead_count == 0) {
        BruteForce force = brute_force(arena, &c.set, &c.graph, 500, true);
        CHECK(meso_pattern_table_init(&table, arena, &c.propagation, NULL, NULL) == MESO_OK);
        check_chains(arena, &c, &table, &force);
        check_cubes(arena, &c, &force, seed);
    }
    meso_propagation_release(&c.propagation);
}

/* A crossing, and a turn of both strands to the right: chains everywhere, and an odd corner to get around. */
static const int32_t weave[2][4] = {{1, 2, -1, -2}, {-2, 1, -1, 2}};

static void test_brute_force(void)
{
    MesoArena arena;
    MesoRandom random;
    meso_arena_init(&arena);
    meso_random_init(&random, 3, 0);
    for (uint32_t i = 0; i < 1000; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        check_case(&arena, random_set(&arena, &random), random_graph(&arena, &random), i);
        check_case(&arena, random_set(&arena, &random), fixture_grid(&arena, 2 + i % 2, 2, i & 2, i & 4, i & 8), i);
        check_case(&arena, fixture_set(&arena, 2, 2, weave, true, true, true), random_graph(&arena, &random), i);
        meso_arena_rewind(&arena, mark);
    }
    CHECK(chains_met > 1000 && answers[MESO_SAT_YES] > 100 && answers[MESO_SAT_NO] > 10);
    meso_arena_release(&arena);
}

int main(void)
{
    test_strips();
    test_brute_force();
    return 0;
}
