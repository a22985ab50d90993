/*
 * Solves the pairs of surface and tile set that the MesoGen prototype was timed
 * on, from a folder with its `surfaces` and `tilesets`, beside its figures:
 *
 *     solve_pairs_bench FOLDER
 */
#include <math.h>
#include <stdio.h>

#include "formats/mesh/surface_read.h"
#include "formats/tiling/result/report_file.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/base/clock.h"

enum { RUNS = 5, ATTEMPTS = 20 };

/* Seed 0, 20 attempts, on two cores. */
static const struct Pair {
    const char *surface, *tiles;
    uint32_t attempts;          /* until solved; 0 where it gave up */
    double milliseconds;
} pairs[] = {
    {"lamp-sub2", "osier2e_color", 1, 2313}, {"ninja", "ninja1", 2, 47},
    {"ninja", "ninja2", 2, 46},              {"lampC-sub1", "lampC2_color", 1, 11},
    {"lampC-sub2", "lampC_color", 0, 343},   {"ring0", "ring1", 1, 2.2},
    {"basket", "wicker4", 1, 2.2},           {"fertility_quad", "wicker4", 0, 43},
    {"tshirt", "z1_color", 0, 489},          {"tshirt", "limitation1", 6, 555},
    {"jewel", "jewel", 0, 0.3},
};

static MesoStatus read_pair(const char *folder, const struct Pair *pair, MesoArena *arena,
                            MesoTileSet *set, MesoVariantSet *variants, MesoSlotGraph *graph,
                            MesoError *error)
{
    MesoInput input;
    MesoQuadSurface quads;
    char *tiles = meso_arena_print(arena, error, "%s/tilesets/%s.json", folder, pair->tiles);
    char *surface = meso_arena_print(arena, error, "%s/surfaces/%s.obj", folder, pair->surface);
    MesoStatus status = tiles && surface ? meso_input_open(&input, tiles, error) : MESO_ERR_MEMORY;
    if (status)
        return status;
    status = meso_tiles_read(set, arena, &input, error);
    meso_input_close(&input);
    if (!status)
        status = meso_input_open(&input, surface, error);
    if (status)
        return status;
    status = meso_quad_surface_read(&quads, arena, &input, 0, error);
    meso_input_close(&input);
    *graph = quads.graph;
    return status ? status : meso_variant_set_build(variants, arena, set, error);
}

/* Best time of some runs, in milliseconds; `result` of the last. */
static MesoStatus time_pair(MesoArena *arena, const MesoTileSet *set, const MesoVariantSet *variants,
                            const MesoSlotGraph *graph, MesoSolveResult *result, double *best,
                            MesoError *error)
{
    const MesoSolveOptions options = {.max_attempts = ATTEMPTS, .max_dead_ends = ATTEMPTS};
    *best = INFINITY;
    for (int run = 0; run < RUNS; run++) {
        double start = 1e3 * meso_seconds();
        MesoStatus status = meso_solve(result, arena, &(MesoTilingProblem){set, variants, graph, NULL},
                                       &options, error);
        double time = 1e3 * meso_seconds() - start;
        if (status)
            return status;
        *best = time < *best ? time : *best;
    }
    return MESO_OK;
}

static MesoStatus bench_pair(const char *folder, const struct Pair *pair, double *factor, MesoError *error)
{
    MesoArena arena;
    MesoTileSet set;
    MesoVariantSet variants;
    MesoSlotGraph graph;
    MesoSolveResult result;
    double best;
    meso_arena_init(&arena);
    MesoStatus status = read_pair(folder, pair, &arena, &set, &variants, &graph, error);
    if (!status)
        status = time_pair(&arena, &set, &variants, &graph, &result, &best, error);
    if (!status) {
        *factor = pair->milliseconds / best;
        printf("solve %-14s %-14s %6u slots %3u variants: %-10s %2u attempts %8.2f ms, prototype %-8s "
               "%7.1f ms, factor %.1f\n", pair->surface, pair->tiles, graph.slot_count, variants.count,
               meso_verdict_name(result.verdict), result.attempts, best,
               pair->attempts ? "solved" : "gave-up", pair->milliseconds, *factor);
    }
    meso_arena_release(&arena);
    return status;
}

int main(int argc, char **argv)
{
    MesoError error;
    double factor, logarithms = 0;
    size_t count = sizeof pairs / sizeof *pairs;
    if (argc != 2) {
        printf("solve_pairs_bench: no folder with the prototype's surfaces and tilesets given\n");
        return 0;
    }
    for (size_t i = 0; i < count; i++) {
        if (bench_pair(argv[1], &pairs[i], &factor, &error)) {
            fprintf(stderr, "solve_pairs_bench: %s\n", error.message);
            return (int)error.status;
        }
        logarithms += log(factor);
    }
    printf("solve, geometric mean of the factors: %.1f\n", exp(logarithms / (double)count));
    return 0;
}
