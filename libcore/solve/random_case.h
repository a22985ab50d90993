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

#endif
