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

/* Takes one from every count, and those out that come to nothing. */
static MesoStatus lower_all(MesoHotSpots *spots, MesoArena *arena, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(arena);
    MesoHotSpot *old = MESO_NEW(arena, MesoHotSpot, PLACES, error);
    if (!old)
        return MESO_ERR_MEMORY;
    memcpy(old, spots->entries, PLACES * sizeof *old);
    memset(spots->entries, 0, PLACES * sizeof *old);
    spots->count = 0;
    for (uint32_t p = 0; p < PLACES; p++)
        if (old[p].dead_ends > 1) {
            *find(spots->entries, old[p].slot) = (MesoHotSpot){old[p].slot, old[p].dead_ends - 1};
            spots->count++;
        }
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

MesoStatus meso_hot_spots_add(MesoHotSpots *spots, MesoArena *arena, uint32_t slot, MesoError *error)
{
    if (!spots->entries && !(spots->entries = MESO_NEW(arena, MesoHotSpot, PLACES, error)))
        return MESO_ERR_MEMORY;
    spots->total++;
    MesoHotSpot *entry = find(spots->entries, slot);
    if (entry->dead_ends) {
        entry->dead_ends++;
        return MESO_OK;
    }
    if (spots->count == MESO_HOT_SPOT_ENTRIES)
        return lower_all(spots, arena, error);
    *entry = (MesoHotSpot){slot, 1};
    spots->count++;
    return MESO_OK;
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
