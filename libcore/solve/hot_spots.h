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
    MesoHotSpot *entries;       /* [2 * MESO_HOT_SPOT_ENTRIES] by hash; NULL before the first dead end */
} MesoHotSpots;

/* Counts a dead end at `slot`; the table, which starts zeroed, lives in `arena`. MESO_ERR_MEMORY alone. O(1) amortised. */
MesoStatus meso_hot_spots_add(MesoHotSpots *spots, MesoArena *arena, uint32_t slot, MesoError *error);

/* Writes the slots with most dead ends to `top` [most], the smaller slot first among equals; returns how many. */
uint32_t meso_hot_spots_top(const MesoHotSpots *spots, MesoHotSpot *top, uint32_t most);

#endif
