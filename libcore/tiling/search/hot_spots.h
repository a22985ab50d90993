/*
 * Where a search fails most: how often each slot was left without a variant. A
 * table of bounded size for surfaces of any (Misra and Gries, "Finding repeated
 * elements", 1982): where it is full, every count in it falls by one, so that
 * counts are exact up to 2048 different slots, and otherwise too low by at most
 * one in 2048 of all dead ends.
 */
#ifndef MESO_HOT_SPOTS_H
#define MESO_HOT_SPOTS_H

#include <stdint.h>

#include "libcore/base/arena.h"

enum { MESO_HOT_SPOT_ENTRIES = 2048 };

typedef struct MesoHotSpot {
    uint32_t slot, dead_ends;   /* at most UINT32_MAX are counted */
} MesoHotSpot;

typedef struct MesoHotSpots {
    uint64_t total;             /* dead ends counted */
    uint32_t count, capacity;   /* entries in use, and at most */
    MesoHotSpot *entries;       /* [2 * capacity] by hash */
    MesoHotSpot *spare;         /* [capacity] */
} MesoHotSpots;

/*
 * Makes room, in `arena`, for as many slots as there may be: 48 KiB. `spots`
 * starts zeroed. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_hot_spots_reserve(MesoHotSpots *spots, MesoArena *arena, MesoError *error);

/* As above, but for one slot more than there are now: little for the searches that meet few. */
MesoStatus meso_hot_spots_reserve_one(MesoHotSpots *spots, MesoArena *arena, MesoError *error);

/* Counts a dead end at `slot`, where something was reserved. O(1) amortised. */
void meso_hot_spots_add(MesoHotSpots *spots, uint32_t slot);

/*
 * Writes the slots with most dead ends to `top` [most], the smaller slot first among equals;
 * returns how many. `spots` may be zeroed: none.
 */
uint32_t meso_hot_spots_top(const MesoHotSpots *spots, MesoHotSpot *top, uint32_t most);

#endif
