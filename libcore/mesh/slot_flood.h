/* Breadth first over a slot graph: slots in the order of their distance from those met first. */
#ifndef MESO_SLOT_FLOOD_H
#define MESO_SLOT_FLOOD_H

#include <stdbool.h>

#include "libcore/mesh/slot_graph.h"

typedef struct MesoSlotFlood {
    const MesoSlotGraph *graph;
    uint32_t *slots;            /* [most] the caller's; `count` of them met */
    bool *met;                  /* [graph->slot_count] the caller's: where a slot is not met again */
    uint32_t most, count;
    uint32_t followed;          /* of `slots`: those whose neighbours have been met */
} MesoSlotFlood;

/* Meets `slot`, if it has not been and there is room. */
static inline void meso_slot_flood_meet(MesoSlotFlood *flood, uint32_t slot)
{
    if (flood->met[slot] || flood->count == flood->most)
        return;
    flood->met[slot] = true;
    flood->slots[flood->count++] = slot;
}

/* Meets the neighbours of all slots met until now, slot by slot, by side: one step further. */
static inline void meso_slot_flood_step(MesoSlotFlood *flood)
{
    for (uint32_t end = flood->count; flood->followed < end; flood->followed++)
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t twin = flood->graph->twin[4 * (size_t)flood->slots[flood->followed] + k];
            if (twin != MESO_NO_INDEX)
                meso_slot_flood_meet(flood, twin / 4);
        }
}

/* Meets all slots that hang together with those met until now. O(those). */
static inline void meso_slot_flood_all(MesoSlotFlood *flood)
{
    while (flood->followed < flood->count)
        meso_slot_flood_step(flood);
}

#endif
