/* Nanoseconds a slot to solve square tori and grids, best of several runs. */
#include <stdio.h>
#include <sys/resource.h>

#include "libcore/base/clock.h"
#include "libcore/tiling/fixture/solve_fixture.h"

/* A wicker: courses (a) one way, posts (b) the other, both of which may end in c; each in two looks. */
static const int32_t wicker_labels[8][4] = {
    {1, 2, -1, -2}, {1, 2, -1, -3}, {3, 2, -1, -2}, {3, 2, -1, -3},
    {1, 2, -1, -2}, {1, 2, -1, -3}, {3, 2, -1, -2}, {3, 2, -1, -3},
};

/* 60 variants: eight of each tile, but four of the last, which does not rotate by a quarter. */
static MesoTileSet wicker(MesoArena *arena)
{
    MesoTileSet set = fixture_set(arena, 3, 8, wicker_labels, true, true, true);
    set.tiles[7].rotation = false;
    return set;
}

static void bench(uint32_t width, bool torus, uint32_t runs)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoTileSet set = wicker(&arena);
    MesoSlotGraph graph = fixture_grid(&arena, width, width, torus, torus, false);
    double best = 1e30;
    uint32_t attempts = 0;
    uint64_t observations = 0;
    for (uint32_t r = 0; r < runs; r++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        double start = meso_seconds();
        MesoSolveResult result = fixture_solve(&arena, &set, &graph, 0, 20);
        double time = meso_seconds() - start;
        best = time < best ? time : best;
        attempts = result.verdict == MESO_VERDICT_SOLVED ? result.attempts : 0;
        observations = result.observations;
        meso_arena_rewind(&arena, mark);
    }
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    printf("solve %-5s %8u slots, 60 variants: %7.1f ns/slot, %8.2f ms, %u attempts (0: gave up), "
           "%.2f observations/slot, peak so far %ld B/slot\n", torus ? "torus" : "grid",
           graph.slot_count, 1e9 * best / graph.slot_count, 1e3 * best, attempts,
           (double)observations / graph.slot_count, usage.ru_maxrss * 1024 / (long)graph.slot_count);
    meso_arena_release(&arena);
}

int main(void)
{
    bench(100, true, 5);
    bench(316, true, 3);
    bench(1000, true, 3);
    bench(1000, false, 3);
    return 0;
}
