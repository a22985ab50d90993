/* Tile sets and slot graphs made by hand, for the tests and benchmarks of this folder. */
#ifndef MESO_SOLVE_FIXTURE_H
#define MESO_SOLVE_FIXTURE_H

#include <stdbool.h>

#include "libcore/base/check.h"
#include "libcore/solve/solve.h"

/*
 * A set of `interface_count` interfaces without drawings (named "a", "b", ...) and
 * `tile_count` tiles "t0", "t1", ... of the given labels, all with the same
 * permissions. Tiles with `solid` keep variants apart that show the same labels.
 */
static inline MesoTileSet fixture_set(MesoArena *arena, uint32_t interface_count,
                                      uint32_t tile_count, const int32_t (*labels)[4],
                                      bool rotation, bool flips, bool solid)
{
    MesoTileSet set = {.interface_count = interface_count, .tile_count = tile_count,
                       .default_rotation = rotation, .default_flip_x = flips,
                       .default_flip_y = flips, .inner_count = solid ? tile_count : 0};
    set.interfaces = MESO_NEW(arena, MesoInterface, interface_count, NULL);
    set.tiles = MESO_NEW(arena, MesoTile, tile_count, NULL);
    set.inners = MESO_NEW(arena, MesoInnerMesh, set.inner_count, NULL);
    CHECK(set.interfaces && set.tiles && set.inners && interface_count <= 26);
    for (uint32_t i = 0; i < interface_count; i++)
        set.interfaces[i].name = meso_arena_print(arena, NULL, "%c", (char)('a' + i));
    for (uint32_t t = 0; t < tile_count; t++) {
        MesoTile *tile = &set.tiles[t];
        *tile = (MesoTile){.name = meso_arena_print(arena, NULL, "t%u", t), .side_count = 4,
                           .rotation = rotation, .flip_x = flips, .flip_y = flips};
        for (uint32_t k = 0; k < 4; k++)
            tile->labels[k] = labels[t][k];
        if (solid) {
            tile->inner_begin = t;
            tile->inner_count = 1;
            set.inners[t].file = "";
        }
    }
    return set;
}

/* Slots with all sides free. */
static inline MesoSlotGraph fixture_graph(MesoArena *arena, uint32_t slot_count)
{
    MesoSlotGraph graph = {.slot_count = slot_count, .edge_count = 4 * slot_count,
                           .border_count = 4 * slot_count};
    graph.twin = MESO_NEW(arena, uint32_t, 4 * (size_t)slot_count, NULL);
    CHECK(graph.twin);
    for (size_t h = 0; h < 4 * (size_t)slot_count; h++)
        graph.twin[h] = MESO_NO_INDEX;
    return graph;
}

/* Glues side k of slot s to side l of slot t. */
static inline void fixture_glue(MesoSlotGraph *graph, uint32_t s, uint32_t k, uint32_t t, uint32_t l)
{
    graph->twin[4 * s + k] = 4 * t + l;
    graph->twin[4 * t + l] = 4 * s + k;
    graph->border_count -= 2;
    graph->edge_count--;
}

/*
 * Slot y * width + x at column x, row y; side 0 towards x + 1, side 1 towards y + 1.
 * `wrap_x` closes the rows, `wrap_y` the columns, `twist` turns the last column
 * upside down before the rows are closed: a Moebius band.
 */
static inline MesoSlotGraph fixture_grid(MesoArena *arena, uint32_t width, uint32_t height,
                                         bool wrap_x, bool wrap_y, bool twist)
{
    MesoSlotGraph graph = fixture_graph(arena, width * height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint32_t slot = y * width + x;
            if (x + 1 < width)
                fixture_glue(&graph, slot, 0, slot + 1, 2);
            else if (wrap_x)
                fixture_glue(&graph, slot, 0, (twist ? height - 1 - y : y) * width, 2);
            if (y + 1 < height)
                fixture_glue(&graph, slot, 1, slot + width, 3);
            else if (wrap_y)
                fixture_glue(&graph, slot, 1, x, 3);
        }
    return graph;
}

/* Solves with one of the engines and the fixture's usual options. */
static inline MesoSolveResult fixture_solve_by(MesoEngine engine, MesoArena *arena, const MesoTileSet *set,
                                               const MesoSlotGraph *graph, uint64_t seed,
                                               uint32_t attempts)
{
    MesoVariantSet variants;
    MesoSolveResult result;
    MesoError error;
    MesoSolveOptions options = {.engine = engine, .seed = seed, .max_attempts = attempts,
                                .max_dead_ends = 100};
    CHECK(meso_variant_set_build(&variants, arena, set, &error) == MESO_OK);
    CHECK(meso_solve(&result, arena, &(MesoTilingProblem){set, &variants, graph, NULL}, &options, &error) == MESO_OK);
    return result;
}

/* Solves by the search alone. */
static inline MesoSolveResult fixture_solve(MesoArena *arena, const MesoTileSet *set,
                                            const MesoSlotGraph *graph, uint64_t seed,
                                            uint32_t attempts)
{
    return fixture_solve_by(MESO_ENGINE_WFC, arena, set, graph, seed, attempts);
}

#endif
