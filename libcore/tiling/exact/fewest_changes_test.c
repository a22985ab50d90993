/* Assignments that change the fewest of the variants to keep, against every assignment. */
#include "libcore/tiling/exact/fewest_changes.h"

#include "libcore/tiling/fixture/brute_force.h"
#include "libcore/tiling/fixture/random_case.h"
#include "libcore/tiling/solve/solve.h"

enum { MOST = 20000 };

typedef struct Case {
    MesoTileSet set;
    MesoVariantSet variants;
    MesoSlotGraph graph;
    MesoConstraints constraints;
    uint32_t keep[BRUTE_FORCE_SLOTS];
} Case;

static void read_number(const Case *c, uint64_t number, uint32_t *variant)
{
    for (uint32_t s = 0; s < c->graph.slot_count; s++, number /= c->variants.count)
        variant[s] = (uint32_t)(number % c->variants.count);
}

static bool holds(const Case *c, const uint32_t *variant)
{
    uint32_t tile[BRUTE_FORCE_SLOTS];
    MesoTransform transform[BRUTE_FORCE_SLOTS];
    for (uint32_t s = 0; s < c->graph.slot_count; s++) {
        tile[s] = c->variants.tile[variant[s]];
        transform[s] = c->variants.transform[variant[s]];
    }
    const MesoAssignment assignment = {c->graph.slot_count, tile, transform};
    return meso_constraints_check(&c->constraints, &assignment, &c->set, &c->variants, &c->graph, NULL) == MESO_OK;
}

static uint32_t changes(const Case *c, const uint32_t *variant)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < c->graph.slot_count; s++)
        count += c->keep[s] != MESO_NO_INDEX && c->keep[s] != variant[s];
    return count;
}

/* The fewest changes of all assignments that hold to the constraints; MESO_NO_INDEX: there are none. */
static uint32_t fewest_changes(const Case *c, const BruteForce *force)
{
    uint32_t fewest = MESO_NO_INDEX, variant[BRUTE_FORCE_SLOTS];
    for (uint64_t i = 0; i < force->count; i++) {
        read_number(c, force->numbers[i], variant);
        uint32_t count = changes(c, variant);
        if (count < fewest && holds(c, variant))
            fewest = count;
    }
    return fewest;
}

/* An assignment of the graph with some variants drawn anew, and some slots without any to keep. */
static void draw_keep(Case *c, const BruteForce *force, MesoRandom *random)
{
    uint32_t count = force->count ? (uint32_t)force->count : 1;
    read_number(c, force->count ? force->numbers[meso_random_below(random, count)] : 0, c->keep);
    for (uint32_t s = 0; s < c->graph.slot_count; s++) {
        uint32_t draw = meso_random_below(random, 4);
        if (draw == 0)
            c->keep[s] = meso_random_below(random, c->variants.count);
        else if (draw == 1 && meso_random_below(random, 3) == 0)
            c->keep[s] = MESO_NO_INDEX;
    }
    c->constraints.keep = c->keep;
}

static uint32_t cases, changed_cases, ruled_cases;

/* Every engine that proves things finds the fewest, and says so. */
static void check_case(MesoArena *arena, Case *c, MesoRandom *random)
{
    CHECK(meso_variant_set_build(&c->variants, arena, &c->set, NULL) == MESO_OK);
    BruteForce force = brute_force(arena, &c->set, &c->graph, MOST, true);
    if (force.count == MOST)
        return;
    uint64_t counted[1] = {meso_random_next(random) & (((uint64_t)1 << c->variants.count) - 1)};
    uint32_t least = meso_random_below(random, c->graph.slot_count + 1);
    const MesoQuota quota = {"quotas[0]", counted, least, least + 1};
    c->constraints = (MesoConstraints){.quotas = &quota, .quota_count = meso_random_below(random, 3) == 0};
    CHECK(c->variants.count < 64);
    draw_keep(c, &force, random);
    uint32_t fewest = fewest_changes(c, &force);
    for (MesoEngine engine = MESO_ENGINE_AUTO; engine <= MESO_ENGINE_EXACT; engine++) {
        MesoSolveResult result;
        const MesoSolveOptions options = {.engine = engine, .seed = cases, .max_attempts = 5};
        CHECK(meso_solve(&result, arena, &(MesoTilingProblem){&c->set, &c->variants, &c->graph, &c->constraints},
                         &options, NULL) == MESO_OK);
        if (engine == MESO_ENGINE_WFC) {
            CHECK(result.verdict != MESO_VERDICT_SOLVED || fewest != MESO_NO_INDEX);
            continue;
        }
        CHECK(result.verdict == (fewest == MESO_NO_INDEX ? MESO_VERDICT_UNSOLVABLE : MESO_VERDICT_SOLVED));
        if (result.verdict != MESO_VERDICT_SOLVED)
            continue;
        CHECK(result.changes_fewest);
        CHECK(meso_constraints_changed(&c->constraints, &result.assignment, &c->variants) == fewest);
        changed_cases += fewest > 0;
        ruled_cases += c->constraints.quota_count;
    }
    cases++;
}

static void test_brute_force(void)
{
    MesoArena arena;
    MesoRandom random;
    meso_arena_init(&arena);
    meso_random_init(&random, 11, 0);
    for (uint32_t i = 0; i < 1200; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        Case c = {.set = random_set(&arena, &random)};
        c.graph = i % 2 ? random_graph(&arena, &random) : fixture_grid(&arena, 2 + i % 3, 2, i & 4, i & 8, false);
        check_case(&arena, &c, &random);
        meso_arena_rewind(&arena, mark);
    }
    CHECK(cases > 500 && changed_cases > 200 && ruled_cases > 50);
    meso_arena_release(&arena);
}

/* A row of 6000 slots where a change runs on to the nearest of two ends: more slots than may change at once. */
static void test_long_row(void)
{
    static const int32_t labels[3][4] = {{1, 3, -1, -3}, {2, 3, -2, -3}, {2, 3, -1, -3}};
    enum { SLOTS = 6000, PINNED = 40 };
    static const uint32_t place[1] = {PINNED};
    static const uint64_t second[1] = {2};
    static uint32_t keep[SLOTS], variant[SLOTS];
    MesoArena arena;
    MesoVariantSet variants;
    MesoPropagation propagation;
    bool fewest;
    uint64_t conflicts;
    meso_arena_init(&arena);
    /* In place 0 to 2: all a, all b, and from a on the left to b on the right; there is no way back. */
    MesoTileSet set = fixture_set(&arena, 3, 3, labels, false, false, false);
    MesoSlotGraph graph = fixture_grid(&arena, SLOTS, 1, false, false, false);
    CHECK(meso_variant_set_build(&variants, &arena, &set, NULL) == MESO_OK);
    const MesoRestriction pin = {"pins[0]", false, 1, place, second};
    const MesoConstraints constraints = {.restriction_count = 1, .restrictions = &pin, .keep = keep};
    CHECK(meso_propagation_init(&propagation, &arena, &(MesoTilingProblem){&set, &variants, &graph, &constraints},
                                NULL) == MESO_OK);
    for (uint32_t s = 0; s < SLOTS; s++) {
        keep[s] = s < 50 ? 0 : s == 50 ? 2 : 1;
        variant[s] = s < 7 ? 0 : s == 7 ? 2 : 1;
    }
    const MesoFewestChangesOptions options = {.max_conflicts = 10000};
    CHECK(meso_fewest_changes(variant, &fewest, &conflicts, &propagation, &variants, &constraints, &options, NULL) ==
          MESO_OK);
    /* The slots from 39, which turns, to 50 are others now; that it is the fewest is known of those nearby alone. */
    for (uint32_t s = 0; s < SLOTS; s++)
        CHECK(variant[s] == (s < 39 ? 0 : s == 39 ? 2 : 1));
    CHECK(!fewest);
    meso_propagation_release(&propagation);
    meso_arena_release(&arena);
}

int main(void)
{
    test_brute_force();
    test_long_row();
    return 0;
}
