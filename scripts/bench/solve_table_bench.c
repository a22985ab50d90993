/*
 * Solves every combination of the surfaces (FOLDER/surfaces/ *.obj) and tile sets
 * (FOLDER/tilesets/ *.json, FOLDER/table2/ *.json) of a folder, one line each: verdict,
 * what decided it, milliseconds; then how many of each.
 *
 *     solve_table_bench FOLDER [SURFACE [TILES [SEED]]]
 *
 * SURFACE and TILES, file names without what follows the dot, choose some of
 * them; "" stands for all.
 */
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/mesh/surface_read.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "scripts/bench/solve_totals.h"

enum { SECONDS = 60 };

/* The file name of `path` without folder and extension. */
static const char *base_name(MesoArena *arena, const char *path)
{
    const char *slash = strrchr(path, '/');
    char *name = meso_arena_copy_text(arena, slash ? slash + 1 : path, NULL);
    char *dot = name ? strrchr(name, '.') : NULL;
    if (dot)
        *dot = 0;
    return name ? name : path;
}

static MesoStatus read_surface(const char *path, MesoArena *arena, MesoSlotGraph *graph, MesoError *error)
{
    MesoInput input;
    MesoQuadSurface surface;
    MesoStatus status = meso_input_open(&input, path, error);
    if (status)
        return status;
    status = meso_quad_surface_read(&surface, arena, &input, 0, error);
    meso_input_close(&input);
    *graph = surface.graph;
    return status;
}

static MesoStatus read_tiles(const char *path, MesoArena *arena, MesoTileSet *set, MesoVariantSet *variants,
                             MesoError *error)
{
    MesoInput input;
    MesoStatus status = meso_input_open(&input, path, error);
    if (status)
        return status;
    status = meso_tiles_read(set, arena, &input, error);
    meso_input_close(&input);
    return status ? status : meso_variant_set_build(variants, arena, set, error);
}

static void solve(const char *surface, const MesoSlotGraph *graph, const char *tiles_path, SolveTotals *totals)
{
    MesoArena arena;
    MesoTileSet set;
    MesoVariantSet variants;
    MesoSolveResult result;
    MesoError error;
    meso_arena_init(&arena);
    const char *tiles = base_name(&arena, tiles_path);
    MesoStatus status = read_tiles(tiles_path, &arena, &set, &variants, &error);
    double time = 0;
    if (!status)
        status = solve_timed(&result, &arena, &set, &variants, graph, SECONDS, &time, totals, &error);
    if (status) {
        printf("%-14s %-14s %s\n", surface, tiles, error.message);
    } else {
        printf("%-14s %-14s %6u slots %3u variants: %-10s by %-11s %2u attempts %9.2f ms  %s\n", surface, tiles,
               graph->slot_count, variants.count, meso_verdict_name(result.verdict),
               meso_decider_name(result.decider), result.attempts, 1e3 * time, result.reason);
    }
    fflush(stdout);
    meso_arena_release(&arena);
}

static void solve_all(const char *path, const glob_t *tiles, const char *wanted, SolveTotals *totals)
{
    MesoArena arena;
    MesoSlotGraph graph;
    MesoError error;
    meso_arena_init(&arena);
    const char *surface = base_name(&arena, path);
    if (read_surface(path, &arena, &graph, &error)) {
        printf("%-14s left out: %s\n", surface, error.message);
    } else {
        for (size_t t = 0; t < tiles->gl_pathc; t++) {
            const char *name = base_name(&arena, tiles->gl_pathv[t]);
            if (!*wanted || strcmp(name, wanted) == 0)
                solve(surface, &graph, tiles->gl_pathv[t], totals);
        }
    }
    meso_arena_release(&arena);
}

int main(int argc, char **argv)
{
    glob_t surfaces = {0}, tiles = {0};
    MesoArena arena;
    SolveTotals totals = {.seed = argc > 4 ? strtoull(argv[4], NULL, 10) : 0};
    meso_arena_init(&arena);
    if (argc < 2) {
        printf("solve_table_bench: no folder with surfaces, tilesets and table2 given\n");
        return 0;
    }
    glob(meso_arena_print(&arena, NULL, "%s/surfaces/*.obj", argv[1]), 0, NULL, &surfaces);
    glob(meso_arena_print(&arena, NULL, "%s/tilesets/*.json", argv[1]), 0, NULL, &tiles);
    glob(meso_arena_print(&arena, NULL, "%s/table2/*.json", argv[1]), GLOB_APPEND, NULL, &tiles);
    for (size_t s = 0; s < surfaces.gl_pathc; s++)
        if (argc < 3 || !*argv[2] || strcmp(base_name(&arena, surfaces.gl_pathv[s]), argv[2]) == 0)
            solve_all(surfaces.gl_pathv[s], &tiles, argc > 3 ? argv[3] : "", &totals);
    solve_print_totals(&totals, "table");
    globfree(&surfaces);
    globfree(&tiles);
    meso_arena_release(&arena);
    return 0;
}
