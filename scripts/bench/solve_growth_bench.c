/*
 * One solve of a growing surface, in a process of its own, so that its peak of
 * memory is its own too:
 *
 *     solve_growth_bench grid|torus|SURFACE SLOTS VARIANTS
 *
 * A grid or a torus is square, of about SLOTS slots; SURFACE is a file, whose
 * faces are quartered until there are SLOTS of them. VARIANTS is 60 and more,
 * in steps of 32. Prints the best of some runs.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "formats/mesh/surface_read.h"
#include "formats/tiling/result/report_file.h"
#include "libcore/base/clock.h"
#include "libcore/tiling/fixture/solve_fixture.h"

/* A wicker: courses (a) one way, posts (b) the other, both of which may end in c; each in several looks. */
static const int32_t wicker_labels[8][4] = {
    {1, 2, -1, -2}, {1, 2, -1, -3}, {3, 2, -1, -2}, {3, 2, -1, -3},
    {1, 3, -3, -2}, {3, 3, -1, -3}, {2, 3, -1, -3}, {3, 2, -3, -1},
};

/* Eight variants of each tile, but four of the last, which does not rotate by a quarter. */
static MesoTileSet wicker(MesoArena *arena, uint32_t variant_count)
{
    uint32_t tile_count = (variant_count + 4) / 8;
    int32_t (*labels)[4] = (int32_t (*)[4])MESO_NEW(arena, int32_t, 4 * (size_t)tile_count, NULL);
    CHECK(labels);
    for (uint32_t t = 0; t < tile_count; t++)
        memcpy(labels[t], wicker_labels[t % 8], sizeof labels[t]);
    MesoTileSet set = fixture_set(arena, 3, tile_count, (const int32_t (*)[4])labels, true, true, true);
    set.tiles[tile_count - 1].rotation = false;
    return set;
}

/*
 * Quarters each slot: part 4 s + i lies at corner i of slot s and starts there.
 * Its side 0 is the first half of side i, side 3 the second half of side i - 1;
 * across sides 1 and 2 lie the parts at the next and the last corner. Sides
 * of slots must be joined with opposite directions.
 */
static MesoSlotGraph quarter(MesoArena *arena, const MesoSlotGraph *coarse)
{
    MesoSlotGraph fine = fixture_graph(arena, 4 * coarse->slot_count);
    for (uint32_t h = 0; h < 4 * coarse->slot_count; h++) {
        uint32_t next = (h & ~3u) | ((h + 1) & 3u), twin = coarse->twin[h];
        fixture_glue(&fine, h, 1, next, 2);
        if (twin != MESO_NO_INDEX)
            fixture_glue(&fine, h, 0, (twin & ~3u) | ((twin + 1) & 3u), 3);
    }
    return fine;
}

static MesoSlotGraph read_surface(MesoArena *arena, const char *path, uint32_t slot_count)
{
    MesoInput input;
    MesoQuadSurface surface;
    MesoError error;
    if (meso_input_open(&input, path, &error) || meso_quad_surface_read(&surface, arena, &input, 0, &error)) {
        fprintf(stderr, "solve_growth_bench: %s\n", error.message);
        exit((int)error.status);
    }
    meso_input_close(&input);
    MesoSlotGraph graph = surface.graph;
    CHECK(graph.reversed_count == 0);
    while (graph.slot_count < slot_count)
        graph = quarter(arena, &graph);
    return graph;
}

static double peak_bytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * (double)usage.ru_maxrss;
}

static void bench(MesoArena *arena, const char *shape, const MesoTileSet *set, const MesoVariantSet *variants,
                  const MesoSlotGraph *graph)
{
    uint32_t runs = graph->slot_count < 300000 ? 2 + 1000000 / graph->slot_count : 2;
    const MesoSolveOptions options = {.max_attempts = 20, .max_dead_ends = 20};
    MesoSolveResult result;
    MesoError error;
    double best = INFINITY, before = peak_bytes(), slots = graph->slot_count;
    for (uint32_t r = 0; r < runs; r++) {
        MesoArenaMark mark = meso_arena_mark(arena);
        double start = meso_seconds();
        CHECK(meso_solve(&result, arena, &(MesoTilingProblem){set, variants, graph, NULL},
                         &options, &error) == MESO_OK);
        double time = meso_seconds() - start;
        best = time < best ? time : best;
        meso_arena_rewind(arena, mark);
    }
    double peak = peak_bytes();
    printf("growth %-18s %9u slots %3u variants: %-7s %-7s %2u attempts %9.2f ms %6.1f ns/slot %6.1f B/slot, %6.1f with "
           "the graph\n", shape, graph->slot_count, variants->count, meso_verdict_name(result.verdict),
           meso_decider_name(result.decider), result.attempts, 1e3 * best, 1e9 * best / slots, (peak - before) / slots,
           peak / slots);
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        printf("solve_growth_bench: no shape, slots and variants given\n");
        return 0;
    }
    uint32_t slot_count = (uint32_t)strtoul(argv[2], NULL, 10);
    uint32_t variant_count = (uint32_t)strtoul(argv[3], NULL, 10), width = (uint32_t)lround(sqrt(slot_count));
    MesoArena arena;
    MesoVariantSet variants;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(variant_count >= 60 && variant_count <= 1000 && slot_count >= 4 && slot_count <= 100000000);
    MesoTileSet set = wicker(&arena, variant_count);
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
    bool grid = strcmp(argv[1], "grid") == 0, torus = strcmp(argv[1], "torus") == 0;
    MesoSlotGraph graph = grid || torus ? fixture_grid(&arena, width, width, torus, torus, false)
                                        : read_surface(&arena, argv[1], slot_count);
    const char *slash = strrchr(argv[1], '/');
    bench(&arena, slash ? slash + 1 : argv[1], &set, &variants, &graph);
    meso_arena_release(&arena);
    return 0;
}
