/* Sweeps over seeds: as one solve each, for any number of threads and any split; ends on failure. */
#include <stdatomic.h>
#include <string.h>

#include "libcore/tiling/fixture/solve_fixture.h"
#include "libcore/tiling/solve/many_seeds.h"

enum { SEEDS = 24, SLOTS = 9 * 7 };

typedef struct Taken {
    MesoVerdict verdict[SEEDS];
    uint64_t observations[SEEDS];
    uint32_t attempts[SEEDS], times[SEEDS];
    uint32_t tile[SEEDS][SLOTS];
    MesoTransform transform[SEEDS][SLOTS];
    uint32_t base;              /* of the shard */
    atomic_uint calls;
    uint32_t fail_at;           /* call, from 1; 0: none */
} Taken;

/* Four colours on a side; by two attempts of plain search some seeds do not get through. */
static const int32_t labels[7][4] = {{1, 2, -1, -2}, {1, 3, -2, -1}, {2, 1, -3, -3}, {3, 3, -1, -2},
                                     {2, 4, -4, -1}, {4, 2, -3, -4}, {1, -2, 4, 3}};

static MesoStatus take(void *context, uint32_t index, const MesoSolveResult *result, MesoError *error)
{
    Taken *taken = context;
    uint32_t i = taken->base + index;
    if (atomic_fetch_add(&taken->calls, 1) + 1 == taken->fail_at)
        return meso_fail(error, MESO_ERR_OUTPUT, "no room");
    taken->times[i]++;
    taken->verdict[i] = result->verdict;
    taken->attempts[i] = result->attempts;
    taken->observations[i] = result->observations;
    if (result->verdict == MESO_VERDICT_SOLVED) {
        memcpy(taken->tile[i], result->assignment.tile, sizeof taken->tile[i]);
        memcpy(taken->transform[i], result->assignment.transform, sizeof taken->transform[i]);
    }
    return MESO_OK;
}

static MesoManySeeds make_sweep(MesoArena *arena, const uint64_t *seeds)
{
    static MesoTileSet set;
    static MesoVariantSet variants;
    static MesoSlotGraph graph;
    static const MesoTilingProblem problem = {&set, &variants, &graph, NULL};
    MesoError error;
    set = fixture_set(arena, 4, 7, labels, true, false, false);
    graph = fixture_grid(arena, 9, 7, false, false, false);
    CHECK(meso_variant_set_build(&variants, arena, &set, &error) == MESO_OK);
    return (MesoManySeeds){.problem = &problem, .take = take,
                           .options = {.max_attempts = 2, .max_dead_ends = 5}, .seeds = seeds,
                           .seed_count = SEEDS};
}

static void check_same(const Taken *a, const Taken *b)
{
    for (uint32_t i = 0; i < SEEDS; i++)
        CHECK(a->times[i] == 1 && b->times[i] == 1);
    CHECK(memcmp(a->verdict, b->verdict, sizeof a->verdict) == 0);
    CHECK(memcmp(a->attempts, b->attempts, sizeof a->attempts) == 0);
    CHECK(memcmp(a->observations, b->observations, sizeof a->observations) == 0);
    CHECK(memcmp(a->tile, b->tile, sizeof a->tile) == 0);
    CHECK(memcmp(a->transform, b->transform, sizeof a->transform) == 0);
}

int main(void)
{
    static Taken alone, other;
    MesoArena arena;
    MesoError error = {0};
    uint64_t seeds[SEEDS];
    meso_arena_init(&arena);
    for (uint32_t i = 0; i < SEEDS; i++)
        seeds[i] = 1000 + 7 * i;
    MesoManySeeds sweep = make_sweep(&arena, seeds);

    /* One by one: what a solve of the seed gives. */
    for (uint32_t i = 0; i < SEEDS; i++) {
        MesoSolveResult result;
        MesoSolveOptions options = sweep.options;
        options.seed = seeds[i];
        CHECK(meso_solve(&result, &arena, sweep.problem, &options, &error) == MESO_OK);
        CHECK(take(&alone, i, &result, &error) == MESO_OK);
    }
    uint32_t solved = 0;
    for (uint32_t i = 0; i < SEEDS; i++)
        solved += alone.verdict[i] == MESO_VERDICT_SOLVED;
    CHECK(solved > 0);

    static const uint32_t threads[] = {1, 2, 7};
    for (uint32_t t = 0; t < 3; t++) {
        memset(&other, 0, sizeof other);
        sweep.context = &other;
        sweep.thread_count = threads[t];
        CHECK(meso_many_seeds(&sweep, &error) == MESO_OK);
        check_same(&alone, &other);
    }
    memset(&other, 0, sizeof other);
    for (other.base = 0; other.base < SEEDS; other.base += 6) {
        sweep.seeds = seeds + other.base;
        sweep.seed_count = 6;
        CHECK(meso_many_seeds(&sweep, &error) == MESO_OK);
    }
    check_same(&alone, &other);

    memset(&other, 0, sizeof other);
    sweep.seeds = seeds;
    sweep.seed_count = SEEDS;
    sweep.thread_count = 1;
    other.fail_at = 4;
    CHECK(meso_many_seeds(&sweep, &error) == MESO_ERR_OUTPUT);
    CHECK(strcmp(error.message, "no room") == 0 && other.calls == 4);
    sweep.seed_count = 0;
    CHECK(meso_many_seeds(&sweep, &error) == MESO_OK);
    meso_arena_release(&arena);
    return 0;
}
