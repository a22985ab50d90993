/*
 * Hard random tile sets of 24 and 40 tiles over four labels on a torus of 60 x 60, one line
 * each: verdict, what decided it, milliseconds; then how many of each.
 *
 *     solve_hard_bench [COUNT [SECONDS [SEED]]]       sets of each kind (5, the most), limit of each (60)
 *
 * "Four labels" in four ways, each with different tiles whose sides are drawn at random:
 *
 *   wang      four colours an axis: what lies to the right or above shows +, to the left or below -
 *   signed    two interfaces: a, a', b, b' on any side
 *   fixed     four interfaces, a, a' to d, d', on any side
 *   turning   the same, and tiles may turn
 *
 * None has a tile that tiles the plane by itself. Most draws are easy. The numbers of the
 * draws below are those of the first that three attempts of an earlier search, which did not jump back, or two
 * seconds of it, left open; with 40 tiles of the kinds wang, signed and turning it decided all of the
 * first 1000 in milliseconds, and the first five stand for them.
 */
#include <stdio.h>
#include <stdlib.h>

#include "libcore/base/random.h"
#include "libcore/tiling/fixture/solve_fixture.h"
#include "scripts/bench/solve_totals.h"

enum { WIDTH = 60, MOST_TILES = 40, DRAWS = 5 };

typedef enum Kind { WANG, SIGNED, FIXED, TURNING } Kind;

static const char *const kind_names[] = {"wang", "signed", "fixed", "turning"};

/* Of 24 tiles, and of 40. */
static const uint32_t draws[4][2][DRAWS] = {
    [WANG] = {{9, 13, 14, 18, 19}, {0, 1, 2, 3, 4}},
    [SIGNED] = {{6, 15, 21, 23, 26}, {0, 1, 2, 3, 4}},
    [FIXED] = {{14, 25, 88, 90, 125}, {3, 7, 14, 23, 24}},
    [TURNING] = {{0, 1, 2, 3, 5}, {0, 1, 2, 3, 4}},
};

static void draw_tile(Kind kind, MesoRandom *random, int32_t labels[4])
{
    for (uint32_t k = 0; k < 4; k++) {
        int32_t label = 1 + (int32_t)meso_random_below(random, kind == SIGNED ? 2 : 4);
        if (kind == WANG)
            labels[k] = k % 2 ? label + 4 : label;
        else
            labels[k] = label;
        if (kind == WANG ? k >= 2 : meso_random_below(random, 2))
            labels[k] = -labels[k];
    }
}

/* Whether the tile goes on a torus of one slot, or is one of the `count` before it. */
static bool spoils(const int32_t (*labels)[4], uint32_t count)
{
    const int32_t *tile = labels[count];
    bool spoils = tile[0] == -tile[2] && tile[1] == -tile[3];
    for (uint32_t t = 0; t < count && !spoils; t++) {
        spoils = true;
        for (uint32_t k = 0; k < 4; k++)
            spoils &= labels[t][k] == tile[k];
    }
    return spoils;
}

static MesoTileSet draw_set(MesoArena *arena, Kind kind, uint32_t tile_count, uint32_t draw)
{
    int32_t labels[MOST_TILES][4];
    MesoRandom random;
    meso_random_init(&random, draw, 100 * (uint64_t)(kind < FIXED ? kind : FIXED) + tile_count);
    for (uint32_t t = 0; t < tile_count; t++)
        do
            draw_tile(kind, &random, labels[t]);
        while (spoils((const int32_t (*)[4])labels, t));
    return fixture_set(arena, kind == WANG ? 8 : kind == SIGNED ? 2 : 4, tile_count, (const int32_t (*)[4])labels,
                       kind == TURNING, false, false);
}

static void solve(Kind kind, uint32_t tile_count, uint32_t draw, const MesoSlotGraph *graph, double limit,
                  SolveTotals *totals)
{
    MesoArena arena;
    MesoVariantSet variants;
    MesoSolveResult result;
    MesoError error;
    meso_arena_init(&arena);
    MesoTileSet set = draw_set(&arena, kind, tile_count, draw);
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
    double time;
    CHECK(solve_timed(&result, &arena, &set, &variants, graph, limit, &time, totals, &error) == MESO_OK);
    printf("hard %-7s %u tiles, draw %3u: %-10s by %-11s %2u attempts %9.2f ms  %s\n", kind_names[kind], tile_count,
           draw, meso_verdict_name(result.verdict), meso_decider_name(result.decider), result.attempts, 1e3 * time,
           result.reason);
    fflush(stdout);
    meso_arena_release(&arena);
}

int main(int argc, char **argv)
{
    uint32_t count = argc > 1 ? (uint32_t)atoi(argv[1]) : DRAWS;
    double limit = argc > 2 ? atof(argv[2]) : 60;
    MesoArena arena;
    SolveTotals totals = {.seed = argc > 3 ? strtoull(argv[3], NULL, 10) : 0};
    CHECK(count <= DRAWS);
    meso_arena_init(&arena);
    MesoSlotGraph graph = fixture_grid(&arena, WIDTH, WIDTH, true, true, false);
    for (Kind kind = WANG; kind <= TURNING; kind++)
        for (uint32_t more = 0; more < 2; more++)
            for (uint32_t i = 0; i < count; i++)
                solve(kind, more ? 40 : 24, draws[kind][more][i], &graph, limit, &totals);
    solve_print_totals(&totals, "hard sets");
    meso_arena_release(&arena);
    return 0;
}
