/* Small random tile sets and slot graphs, for the tests of this folder. */
#ifndef MESO_RANDOM_CASE_H
#define MESO_RANDOM_CASE_H

#include "libcore/base/random.h"
#include "libcore/solve/solve_fixture.h"

/* Up to five slots, their sides glued to each other or to themselves, or free. */
static inline MesoSlotGraph random_graph(MesoArena *arena, MesoRandom *random)
{
    MesoSlotGraph graph = fixture_graph(arena, 1 + meso_random_below(random, 5));
    uint32_t sides = 4 * graph.slot_count;
    for (uint32_t i = meso_random_below(random, sides); i-- > 0;) {
        uint32_t g = meso_random_below(random, sides), h = meso_random_below(random, sides);
        if (g != h && graph.twin[g] == MESO_NO_INDEX && graph.twin[h] == MESO_NO_INDEX)
            fixture_glue(&graph, g / 4, g % 4, h / 4, h % 4);
    }
    return graph;
}

/* Up to four tiles of up to three interfaces, with some border rules. */
static inline MesoTileSet random_set(MesoArena *arena, MesoRandom *random)
{
    int32_t labels[4][4];
    uint32_t interfaces = 1 + meso_random_below(random, 3);
    for (uint32_t i = 0; i < 16; i++) {
        int32_t label = 1 + (int32_t)meso_random_below(random, interfaces);
        labels[i / 4][i % 4] = meso_random_below(random, 2) ? label : -label;
    }
    MesoTileSet set = fixture_set(arena, interfaces, 1 + meso_random_below(random, 4),
                                  (const int32_t (*)[4])labels, meso_random_below(random, 2),
                                  meso_random_below(random, 2), meso_random_below(random, 4) == 0);
    for (uint32_t i = 0; i < interfaces; i++) {
        set.interfaces[i].border_exempt = meso_random_below(random, 4) == 0;
        set.interfaces[i].border_only = meso_random_below(random, 4) == 0;
    }
    return set;
}

/* An end of a sweep: one of the cross-sections that the tile shows, which must be one at least. */
static inline void random_sweep_end(const MesoTileSet *set, const MesoTile *tile, MesoRandom *random, uint32_t *side,
                                    uint32_t *section)
{
    const MesoInterface *interface;
    do {
        *side = meso_random_below(random, tile->side_count);
        interface = tile->labels[*side] ? &set->interfaces[meso_label_interface(tile->labels[*side])] : NULL;
    } while (!interface || interface->section_count == 0);
    *section = interface->section_begin + meso_random_below(random, interface->section_count);
}

static inline MesoSweep random_sweep(const MesoTileSet *set, const MesoTile *tile, MesoRandom *random)
{
    MesoSweep sweep = {.half_turn = meso_random_below(random, 4) == 0};
    random_sweep_end(set, tile, random, &sweep.from_side, &sweep.from_section);
    bool back = meso_random_below(random, 3) == 0;
    do
        random_sweep_end(set, tile, random, &sweep.to_side, &sweep.to_section);
    while (back && sweep.to_side != sweep.from_side);
    return sweep;
}

/*
 * A random set with up to two cross-sections an interface, with tops and bottoms, and with up to four sweeps a tile:
 * from any cross-section to any, on the same side and the same one too, and several to one.
 */
static inline MesoTileSet random_strand_set(MesoArena *arena, MesoRandom *random)
{
    MesoTileSet set = random_set(arena, random);
    set.sections = MESO_NEW(arena, MesoSection, 2 * (size_t)set.interface_count, NULL);
    set.sweeps = MESO_NEW(arena, MesoSweep, 4 * (size_t)set.tile_count, NULL);
    CHECK(set.sections && set.sweeps);
    for (uint32_t i = 0; i < set.interface_count; i++) {
        set.interfaces[i].section_begin = set.section_count;
        set.interfaces[i].section_count = meso_random_below(random, 3);
        for (uint32_t c = 0; c < set.interfaces[i].section_count; c++)
            set.sections[set.section_count++] = (MesoSection){.name = c ? "y" : "x", .interface = i};
    }
    for (uint32_t t = 0; t < set.tile_count; t++) {
        MesoTile *tile = &set.tiles[t];
        uint32_t shown = 0;
        tile->side_count = meso_random_below(random, 4) ? 4 : 6;
        for (uint32_t k = 0; k < tile->side_count; k++) {
            if (k >= 4)
                tile->labels[k] = (int32_t)meso_random_below(random, set.interface_count + 1);
            shown += tile->labels[k] ? set.interfaces[meso_label_interface(tile->labels[k])].section_count : 0;
        }
        tile->sweep_begin = set.sweep_count;
        tile->sweep_count = shown ? meso_random_below(random, 5) : 0;
        for (uint32_t i = 0; i < tile->sweep_count; i++)
            set.sweeps[set.sweep_count++] = random_sweep(&set, tile, random);
    }
    return set;
}

#endif
