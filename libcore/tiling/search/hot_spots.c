#include "libcore/tiling/search/hot_spots.h"

#include <stdbool.h>
#include <string.h>

/* Slots of the first table: a power of two. */
enum { FIRST_ENTRIES = 16 };

/* Half full at most, so that runs of taken places stay short. */
static MesoHotSpot *find(const MesoHotSpots *spots, uint32_t slot)
{
    uint32_t mask = 2 * spots->capacity - 1;
    uint32_t place = (uint32_t)((slot * 0x9e3779b97f4a7c15u) >> 32) & mask;
    while (spots->entries[place].dead_ends && spots->entries[place].slot != slot)
        place = (place + 1) & mask;
    return &spots->entries[place];
}

static MesoStatus make_table(MesoHotSpots *spots, MesoArena *arena, uint32_t capacity, MesoError *error)
{
    MesoHotSpots old = *spots;
    if (old.capacity >= capacity)
        return MESO_OK;
    spots->capacity = capacity;
    spots->entries = MESO_NEW(arena, MesoHotSpot, 2 * (size_t)capacity, error);
    spots->spare = MESO_NEW(arena, MesoHotSpot, capacity, error);
    if (!spots->entries || !spots->spare)
        return MESO_ERR_MEMORY;
    for (uint32_t p = 0; p < 2 * old.capacity; p++)
        if (old.entries[p].dead_ends)
            *find(spots, old.entries[p].slot) = old.entries[p];
    return MESO_OK;
}

MesoStatus meso_hot_spots_reserve(MesoHotSpots *spots, MesoArena *arena, MesoError *error)
{
    return make_table(spots, arena, MESO_HOT_SPOT_ENTRIES, error);
}

MesoStatus meso_hot_spots_reserve_one(MesoHotSpots *spots, MesoArena *arena, MesoError *error)
{
    if (spots->count < spots->capacity)
        return MESO_OK;
    return make_table(spots, arena, spots->capacity == 0 ? FIRST_ENTRIES : MESO_HOT_SPOT_ENTRIES, error);
}

/* Takes one from every count, and those out that come to nothing. */
static void lower_all(MesoHotSpots *spots)
{
    uint32_t kept = 0;
    for (uint32_t p = 0; p < 2 * spots->capacity; p++)
        if (spots->entries[p].dead_ends > 1)
            spots->spare[kept++] = (MesoHotSpot){spots->entries[p].slot, spots->entries[p].dead_ends - 1};
    memset(spots->entries, 0, 2 * spots->capacity * sizeof *spots->entries);
    for (spots->count = 0; spots->count < kept; spots->count++)
        *find(spots, spots->spare[spots->count].slot) = spots->spare[spots->count];
}

void meso_hot_spots_add(MesoHotSpots *spots, uint32_t slot)
{
    MesoHotSpot *entry = find(spots, slot);
    spots->total++;
    if (!entry->dead_ends && spots->count == spots->capacity) {
        lower_all(spots);
        return;
    }
    spots->count += entry->dead_ends == 0;
    *entry = (MesoHotSpot){slot, entry->dead_ends + (entry->dead_ends < UINT32_MAX)};
}

static bool hotter(MesoHotSpot a, MesoHotSpot b)
{
    return a.dead_ends != b.dead_ends ? a.dead_ends > b.dead_ends : a.slot < b.slot;
}

uint32_t meso_hot_spots_top(const MesoHotSpots *spots, MesoHotSpot *top, uint32_t most)
{
    uint32_t count = 0;
    for (uint32_t p = 0; p < 2 * spots->capacity; p++) {
        MesoHotSpot entry = spots->entries[p];
        if (entry.dead_ends == 0 || (count == most && !hotter(entry, top[most - 1])))
            continue;
        uint32_t at = count < most ? count++ : most - 1;
        for (; at > 0 && hotter(entry, top[at - 1]); at--)
            top[at] = top[at - 1];
        top[at] = entry;
    }
    return count;
}
