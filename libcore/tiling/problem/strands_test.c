#include "libcore/tiling/problem/strands.h"

#include <string.h>

#include "libcore/tiling/fixture/solve_fixture.h"
#include "libcore/tiling/search/strand_search.h"
#include "libcore/tiling/solve/explain.h"

/*
 * Truchet: both interfaces of a set have one section. t0 joins sides 0 and 1, and 2 and 3; t1 joins
 * 0 and 2, and 1 and 3; t2 joins all four in a star; t3 has no sweep at all.
 */
static MesoTileSet truchet(MesoArena *arena, uint32_t tile_count, bool rotation)
{
    static const int32_t labels[4][4] = {{1, 1, -1, -1}, {1, 1, -1, -1}, {1, 1, -1, -1}, {1, 1, -1, -1}};
    static const uint8_t sides[7][2] = {{0, 1}, {2, 3}, {0, 2}, {1, 3}, {0, 1}, {0, 2}, {0, 3}};
    static const uint32_t begin[5] = {0, 2, 4, 7, 7};
    MesoTileSet set = fixture_set(arena, 1, tile_count, labels, rotation, false, false);
    set.sections = MESO_NEW(arena, MesoSection, 1, NULL);
    set.sweeps = MESO_NEW(arena, MesoSweep, 7, NULL);
    CHECK(set.sections && set.sweeps);
    set.sections[0].name = "s";
    set.section_count = set.interfaces[0].section_count = 1;
    set.sweep_count = 7;
    for (uint32_t i = 0; i < 7; i++)
        set.sweeps[i] = (MesoSweep){.from_side = sides[i][0], .to_side = sides[i][1]};
    for (uint32_t t = 0; t < tile_count; t++) {
        set.tiles[t].sweep_begin = begin[t];
        set.tiles[t].sweep_count = begin[t + 1] - begin[t];
    }
    return set;
}

static MesoStrandStatistics count(const MesoTileSet *set, const MesoSlotGraph *graph, uint32_t *tile,
                                  MesoTransform *transform)
{
    MesoStrandStatistics statistics;
    const MesoAssignment assignment = {graph->slot_count, tile, transform};
    CHECK(meso_strands_count(&statistics, &assignment, set, graph, NULL) == MESO_OK);
    return statistics;
}

static void test_count(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = truchet(&arena, 4, true);
    uint32_t straight[6] = {1, 1, 1, 1, 1, 1}, star[6] = {2, 3, 2, 3, 2, 3};
    MesoTransform as_is[6] = {0};

    /* Three columns, two rows: two strands of three, three of two. */
    MesoSlotGraph graph = fixture_grid(&arena, 3, 2, false, false, false);
    MesoStrandStatistics statistics = count(&set, &graph, straight, as_is);
    CHECK(statistics.strand_count == 5 && statistics.loop_count == 0 && statistics.link_count == 12);
    CHECK(statistics.shortest == 2 && statistics.longest == 3 && statistics.lengths[1] == 5);

    /* Closed rows: two rings. On the torus five. */
    graph = fixture_grid(&arena, 3, 2, true, false, false);
    statistics = count(&set, &graph, straight, as_is);
    CHECK(statistics.strand_count == 5 && statistics.loop_count == 2 && statistics.cyclic_count == 2);
    graph = fixture_grid(&arena, 3, 2, true, true, false);
    statistics = count(&set, &graph, straight, as_is);
    CHECK(statistics.strand_count == 5 && statistics.loop_count == 5);

    /* The Moebius band's rows are one ring. */
    graph = fixture_grid(&arena, 3, 2, true, false, true);
    statistics = count(&set, &graph, straight, as_is);
    CHECK(statistics.strand_count == 4 && statistics.loop_count == 1 && statistics.longest == 6);

    /* Stars of three sweeps apart, and joined: a fork closes no ring. */
    graph = fixture_grid(&arena, 6, 1, false, false, false);
    statistics = count(&set, &graph, star, as_is);
    CHECK(statistics.strand_count == 3 && statistics.longest == 3 && statistics.cyclic_count == 0);
    star[1] = 2;
    graph = fixture_grid(&arena, 2, 1, true, false, false);
    statistics = count(&set, &graph, star, as_is);
    CHECK(statistics.strand_count == 1 && statistics.cyclic_count == 1 && statistics.loop_count == 0);
    meso_arena_release(&arena);
}

/* Four quarter circles about the middle of a 2 x 2 grid make a ring, which only one rule of them minds. */
static void test_check(void)
{
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    MesoTileSet set = truchet(&arena, 4, true);
    MesoSlotGraph graph = fixture_grid(&arena, 2, 2, false, false, false);
    uint32_t tile[4] = {0, 0, 0, 0};
    MesoTransform transform[4] = {0, 1, 1, 0};
    const MesoAssignment assignment = {4, tile, transform};
    MesoStrandStatistics statistics = count(&set, &graph, tile, transform);
    CHECK(statistics.strand_count == 5 && statistics.loop_count == 1 && statistics.longest == 4);

    MesoStrandRule rule = {.no_loops = true};
    CHECK(meso_strands_check(&rule, &assignment, &set, &graph, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "of 4 sweeps through slot 0 is a closed loop"));
    rule = (MesoStrandRule){.acyclic = true};
    CHECK(meso_strands_check(&rule, &assignment, &set, &graph, &error) == MESO_ERR_INPUT);
    rule = (MesoStrandRule){.max_length = 3};
    CHECK(meso_strands_check(&rule, &assignment, &set, &graph, &error) == MESO_ERR_INPUT);
    rule = (MesoStrandRule){.connected = true};
    CHECK(meso_strands_check(&rule, &assignment, &set, &graph, &error) == MESO_ERR_INPUT);
    rule = (MesoStrandRule){.max_length = 4};
    CHECK(meso_strands_check(&rule, &assignment, &set, &graph, &error) == MESO_OK);

    char text[64];
    rule = (MesoStrandRule){.connected = true, .acyclic = true, .no_loops = true, .max_length = 4294967295u};
    CHECK(strcmp(meso_strand_rule_name(&rule, text), "connected, acyclic, no-loops, max-length 4294967295") == 0);
    meso_arena_release(&arena);
}

/* Every rule that the search keeps to holds in the result, by the check's own way. */
static void test_search(void)
{
    static const MesoStrandRule rules[4] = {
        {.no_loops = true}, {.max_length = 6}, {.acyclic = true, .max_length = 9}, {.connected = true}};
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    for (uint32_t r = 0; r < 4; r++)
        for (uint64_t seed = 0; seed < 4; seed++) {
           /* Where all must connect, stars may stand. */
            MesoTileSet set = truchet(&arena, r == 0 ? 2 : 4, true);
            MesoSlotGraph graph = fixture_grid(&arena, r == 3 ? 4 : 12, r == 3 ? 3 : 9, r != 0, false, false);
            MesoVariantSet variants;
            MesoSolveResult result;
            MesoConstraints constraints = {.strands = rules[r]};
            MesoSolveOptions options = {.seed = seed, .engine = seed % 2 ? MESO_ENGINE_EXACT : MESO_ENGINE_WFC,
                                        .max_attempts = 50, .max_dead_ends = 10};
            CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
            CHECK(meso_solve(&result, &arena, &(MesoTilingProblem){&set, &variants, &graph, &constraints},
                             &options, &error) == MESO_OK);
            CHECK(result.verdict == MESO_VERDICT_SOLVED);
            CHECK(meso_strands_check(&rules[r], &result.assignment, &set, &graph, &error) == MESO_OK);
        }
    meso_arena_release(&arena);
}

/* Straight tiles alone on closed rows can only make rings: that is the rule's fault, and said so. */
static void test_explanation(void)
{
    MesoArena arena;
    MesoError error;
    MesoVariantSet variants;
    MesoSolveResult result;
    meso_arena_init(&arena);
    MesoTileSet set = truchet(&arena, 2, false);
    MesoSlotGraph graph = fixture_grid(&arena, 3, 2, true, false, false);
    static const uint32_t row[3] = {0, 1, 2};
    static const uint64_t straight[1] = {2};
    MesoRestriction region = {.name = "regions[0] 'row'", .place_count = 3, .places = row, .allowed = straight};
    MesoConstraints constraints = {.strands = {.no_loops = true}, .restriction_count = 1, .restrictions = &region};
    MesoSolveOptions options = {.max_attempts = 5, .max_dead_ends = 10};
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
    CHECK(meso_solve(&result, &arena, &(MesoTilingProblem){&set, &variants, &graph, &constraints},
                     &options, &error) == MESO_OK);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE);
    CHECK(meso_explain(&result, &arena, &(MesoTilingProblem){&set, &variants, &graph, &constraints},
                       options.seed, &error) == MESO_OK);
    CHECK(strcmp(result.reason, "regions[0] 'row' and the rule on strands cannot hold together") == 0);
    meso_arena_release(&arena);
}

/* Both engines agree with a count of all assignments: four tiles, 2 x 2 slots, closed rows. */
static void test_brute_force(void)
{
    MesoArena arena;
    MesoError error;
    MesoVariantSet variants;
    meso_arena_init(&arena);
    MesoTileSet set = truchet(&arena, 4, true);
    MesoSlotGraph graph = fixture_grid(&arena, 2, 2, true, false, false);
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
    for (uint32_t bits = 1; bits < 128; bits += 3) {
        const MesoStrandRule rule = {.connected = bits & 1, .acyclic = bits & 2, .no_loops = bits & 4,
                                     .max_length = bits >> 3};
        /* All tiles but one of them in each slot, so that some rules cannot be kept. */
        static const uint32_t places[4] = {0, 1, 2, 3};
        uint64_t allowed[1] = {0};
        for (uint32_t v = 0; v < variants.count; v++)
            if (variants.tile[v] == (bits & 32 ? 1u : 2u) || (bits & 16 && variants.tile[v] == 0))
                meso_bits_set(allowed, v);
        MesoRestriction region = {.name = "r", .place_count = 4, .places = places, .allowed = allowed};
        const MesoConstraints constraints = {.strands = rule, .restriction_count = 1, .restrictions = &region};
        bool possible = false;
        uint32_t tile[4];
        MesoTransform transform[4];
        const MesoAssignment assignment = {4, tile, transform};
        uint32_t all = variants.count * variants.count * variants.count * variants.count;
        for (uint32_t code = 0; code < all && !possible; code++) {
            uint32_t rest = code;
            for (uint32_t s = 0; s < 4; s++, rest /= variants.count) {
                tile[s] = variants.tile[rest % variants.count];
                transform[s] = variants.transform[rest % variants.count];
            }
            possible = meso_assignment_check(&assignment, &set, &graph, &error) == MESO_OK &&
                       meso_constraints_check(&constraints, &assignment, &set, &variants, &graph, &error) == MESO_OK;
        }
        for (MesoEngine engine = MESO_ENGINE_WFC; engine <= MESO_ENGINE_EXACT; engine++) {
            MesoSolveResult result;
            MesoSolveOptions options = {.seed = bits, .engine = engine, .max_attempts = 50};
            CHECK(meso_solve(&result, &arena, &(MesoTilingProblem){&set, &variants, &graph, &constraints},
                             &options, &error) == MESO_OK);
            CHECK(result.verdict == (possible ? MESO_VERDICT_SOLVED : MESO_VERDICT_UNSOLVABLE));
        }
    }
    meso_arena_release(&arena);
}

typedef struct Sheet {
    MesoTileSet set;
    MesoSlotGraph graph;
    MesoVariantSet variants;
    uint32_t tile[4];
    MesoTransform transform[4];
    MesoAssignment assignment;
} Sheet;

/* The assignment with this number on four slots. */
static void read_sheet(Sheet *sheet, uint32_t number, uint32_t *variant)
{
    for (uint32_t s = 0; s < 4; s++, number /= sheet->variants.count) {
        variant[s] = number % sheet->variants.count;
        sheet->tile[s] = sheet->variants.tile[variant[s]];
        sheet->transform[s] = sheet->variants.transform[variant[s]];
    }
    sheet->assignment = (MesoAssignment){4, sheet->tile, sheet->transform};
}

/* Whether the assignment matches, and keeps to the rule. */
static bool keeps(Sheet *sheet, const MesoStrandRule *rule, uint32_t number)
{
    uint32_t variant[4];
    const MesoConstraints constraints = {.strands = *rule};
    read_sheet(sheet, number, variant);
    return meso_assignment_check(&sheet->assignment, &sheet->set, &sheet->graph, NULL) == MESO_OK &&
           meso_constraints_check(&constraints, &sheet->assignment, &sheet->set, &sheet->variants, &sheet->graph,
                                  NULL) == MESO_OK;
}

/* No assignment that keeps to the rule has all that a cut forbids to stand together. */
static uint32_t check_cuts(MesoArena *arena, Sheet *sheet, const MesoStrandRule *rule, const bool *good,
                           uint32_t number)
{
    uint32_t variant[4], other[4], all = 1;
    MesoStrandCuts cuts;
    read_sheet(sheet, number, variant);
    CHECK(meso_strands_cuts(&cuts, arena, rule, &sheet->assignment, &sheet->set, &sheet->graph, 100, NULL) == MESO_OK);
    CHECK(cuts.count > 0);
    for (uint32_t s = 0; s < 4; s++)
        all *= sheet->variants.count;
    for (uint32_t n = 0; n < all; n++) {
        if (!good[n])
            continue;
        read_sheet(sheet, n, other);
        for (uint32_t c = 0; c < cuts.count; c++) {
            bool same = true;
            for (uint32_t i = cuts.begin[c]; i < cuts.begin[c + 1]; i++)
                same &= variant[cuts.slots[i]] == other[cuts.slots[i]];
            CHECK(!same);
        }
    }
    return cuts.count;
}

/* With variants to keep, the exact engine changes the fewest that the rule allows, where it says so. */
static uint32_t check_keep(MesoArena *arena, Sheet *sheet, const MesoStrandRule *rule, const bool *good, uint32_t all,
                           uint32_t number)
{
    uint32_t keep[4], variant[4], fewest = MESO_NO_INDEX;
    MesoSolveResult result;
    read_sheet(sheet, number, keep);
    for (uint32_t n = 0; n < all; n++) {
        uint32_t changed = 0;
        read_sheet(sheet, n, variant);
        for (uint32_t s = 0; s < 4; s++)
            changed += variant[s] != keep[s];
        fewest = good[n] && changed < fewest ? changed : fewest;
    }
    const MesoConstraints constraints = {.strands = *rule, .keep = keep};
    const MesoSolveOptions options = {.seed = number, .max_attempts = 5};
    CHECK(meso_solve(&result, arena, &(MesoTilingProblem){&sheet->set, &sheet->variants, &sheet->graph, &constraints},
                     &options, NULL) == MESO_OK);
    CHECK(result.verdict == (fewest == MESO_NO_INDEX ? MESO_VERDICT_UNSOLVABLE : MESO_VERDICT_SOLVED));
    if (result.verdict != MESO_VERDICT_SOLVED)
        return 0;
    uint32_t changed = meso_constraints_changed(&constraints, &result.assignment, &sheet->variants);
    CHECK(changed >= fewest && (!result.changes_fewest || changed == fewest));
    return result.changes_fewest && fewest > 0;
}

static void test_cuts(void)
{
    static const MesoStrandRule rules[6] = {{.connected = true}, {.no_loops = true}, {.acyclic = true},
                                            {.max_length = 3}, {.no_loops = true, .max_length = 5},
                                            {.connected = true, .no_loops = true}};
    MesoArena arena;
    MesoRandom random;
    uint32_t cut_count = 0, fewest_count = 0;
    meso_arena_init(&arena);
    meso_random_init(&random, 9, 0);
    for (uint32_t i = 0; i < 6 * 8; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        Sheet sheet = {.set = truchet(&arena, 3 + i % 2, i & 4)};
        sheet.graph = i & 2 ? fixture_grid(&arena, 4, 1, i & 4, i & 1, false)
                            : fixture_grid(&arena, 2, 2, i & 4, i & 1, false);
        CHECK(meso_variant_set_build(&sheet.variants, &arena, &sheet.set, NULL) == MESO_OK);
        uint32_t all = sheet.variants.count * sheet.variants.count * sheet.variants.count * sheet.variants.count;
        bool *good = MESO_NEW(&arena, bool, all, NULL);
        CHECK(good);
        for (uint32_t n = 0; n < all; n++)
            good[n] = keeps(&sheet, &rules[i / 8], n);
        for (uint32_t tries = 0; tries < 150; tries++) {
            uint32_t n = meso_random_below(&random, all), variant[4];
            read_sheet(&sheet, n, variant);
            bool matches = meso_assignment_check(&sheet.assignment, &sheet.set, &sheet.graph, NULL) == MESO_OK;
            if (matches && !good[n])
                cut_count += check_cuts(&arena, &sheet, &rules[i / 8], good, n);
            if (matches && !good[n] && tries < 15)
                fewest_count += check_keep(&arena, &sheet, &rules[i / 8], good, all, n);
        }
        meso_arena_rewind(&arena, mark);
    }
    CHECK(cut_count > 500 && fewest_count > 100);
    meso_arena_release(&arena);
}

/* What is added and taken back in the opposite order leaves nothing behind. */
static void test_undo(void)
{
    MesoArena arena;
    MesoError error;
    MesoVariantSet variants;
    MesoStrandSearch search, fresh;
    MesoRandom random;
    meso_arena_init(&arena);
    meso_random_init(&random, 5, 0);
    MesoTileSet set = truchet(&arena, 4, true);
    MesoSlotGraph graph = fixture_grid(&arena, 5, 4, true, true, false);
    const MesoStrandRule rule = {.connected = true, .no_loops = true};
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
    CHECK(meso_strand_search_init(&search, &arena, &rule, &set, &variants, &graph, &error) == MESO_OK);
    CHECK(meso_strand_search_init(&fresh, &arena, &rule, &set, &variants, &graph, &error) == MESO_OK);
    size_t marks[21] = {0};
    uint32_t depth = 0;
    for (uint32_t step = 0; step < 2000; step++) {
        bool kept = true;
        if (depth == 20 || (depth > 0 && meso_random_below(&random, 3) == 0)) {
            depth = meso_random_below(&random, depth);
            meso_strand_search_undo(&search, marks[depth]);
        }
        marks[depth] = search.trail_count;
        CHECK(meso_strand_search_add(&search, (7 * depth) % 20, meso_random_below(&random, variants.count), &kept,
                                     &error) == MESO_OK);
        depth++;
    }
    meso_strand_search_undo(&search, 0);
    CHECK(memcmp(search.forest.nodes, fresh.forest.nodes, search.forest.count * sizeof *search.forest.nodes) == 0);
    CHECK(memcmp(search.finished, fresh.finished, search.forest.count) == 0);
    CHECK(search.strand_count[0] == 0 && search.finished_count[0] == 0);
    meso_arena_release(&arena);
}

int main(void)
{
    test_count();
    test_check();
    test_search();
    test_explanation();
    test_brute_force();
    test_cuts();
    test_undo();
    return 0;
}
