/*
 * Where a search fails most: how often each slot was left without a variant. A
 * table of bounded size for surfaces of any (Misra and Gries, "Finding repeated
 * elements", 1982): where it is full, every count in it falls by one, so that
 * counts are exact up to 4096 different slots, and otherwise too low by at most
 * one in 4096 of all dead ends.
 */
#ifndef MESO_HOT_SPOTS_H
#define MESO_HOT_SPOTS_H

#include <stdint.h>

#include "libcore/base/arena.h"

enum { MESO_HOT_SPOT_ENTRIES = 4096 };

typedef struct MesoHotSpot {
    uint32_t slot;
    uint64_t dead_ends;
} MesoHotSpot;

typedef struct MesoHotSpots {
    uint64_t total;             /* dead ends counted */
    uint32_t count;             /* entries in use */
    MesoHotSpot *entries;       /* [2 * MESO_HOT_SPOT_ENTRIES] by hash */
    MesoHotSpot *spare;         /* [MESO_HOT_SPOT_ENTRIES] */
} MesoHotSpots;

/* An empty table, in `arena`: 192 KiB. MESO_ERR_MEMORY alone. */
MesoStatus meso_hot_spots_init(MesoHotSpots *spots, MesoArena *arena, MesoError *error);

/* Counts a dead end at `slot`. O(1) amortised. */
void meso_hot_spots_add(MesoHotSpots *spots, uint32_t slot);

/*
 * Writes the slots with most dead ends to `top` [most], the smaller slot first among equals;
 * returns how many. `spots` may be zeroed: none.
 */
uint32_t meso_hot_spots_top(const MesoHotSpots *spots, MesoHotSpot *top, uint32_t most);

#endif
