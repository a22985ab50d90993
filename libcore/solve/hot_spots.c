#include "libcore/solve/hot_spots.h"

#include <stdbool.h>
#include <string.h>

/* Half full at most, so that runs of taken places stay short. */
enum { PLACES = 2 * MESO_HOT_SPOT_ENTRIES };

static MesoHotSpot *find(MesoHotSpot *entries, uint32_t slot)
{
    uint32_t place = (uint32_t)((slot * 0x9e3779b97f4a7c15u) >> 32) % PLACES;
    while (entries[place].dead_ends && entries[place].slot != slot)
        place = (place + 1) % PLACES;
    return &entries[place];
}

MesoStatus meso_hot_spots_init(MesoHotSpots *spots, MesoArena *arena, MesoError *error)
{
    *spots = (MesoHotSpots){.entries = MESO_NEW(arena, MesoHotSpot, PLACES, error),
                            .spare = MESO_NEW(arena, MesoHotSpot, MESO_HOT_SPOT_ENTRIES, error)};
    return spots->entries && spots->spare ? MESO_OK : MESO_ERR_MEMORY;
}

/* Takes one from every count, and those out that come to nothing. */
static void lower_all(MesoHotSpots *spots)
{
    uint32_t kept = 0;
    for (uint32_t p = 0; p < PLACES; p++)
        if (spots->entries[p].dead_ends > 1)
            spots->spare[kept++] = (MesoHotSpot){spots->entries[p].slot, spots->entries[p].dead_ends - 1};
    memset(spots->entries, 0, PLACES * sizeof *spots->entries);
    for (spots->count = 0; spots->count < kept; spots->count++)
        *find(spots->entries, spots->spare[spots->count].slot) = spots->spare[spots->count];
}

void meso_hot_spots_add(MesoHotSpots *spots, uint32_t slot)
{
    MesoHotSpot *entry = find(spots->entries, slot);
    spots->total++;
    if (!entry->dead_ends && spots->count == MESO_HOT_SPOT_ENTRIES) {
        lower_all(spots);
        return;
    }
    spots->count += entry->dead_ends == 0;
    *entry = (MesoHotSpot){slot, entry->dead_ends + 1};
}

static bool hotter(MesoHotSpot a, MesoHotSpot b)
{
    return a.dead_ends != b.dead_ends ? a.dead_ends > b.dead_ends : a.slot < b.slot;
}

uint32_t meso_hot_spots_top(const MesoHotSpots *spots, MesoHotSpot *top, uint32_t most)
{
    uint32_t count = 0;
    for (uint32_t p = 0; spots->entries && p < PLACES; p++) {
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
