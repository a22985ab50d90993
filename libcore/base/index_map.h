/*
 * Maps numbers of 32 bits to numbers of 32 bits: open addressing, at most half full. Runs of 8 keys share a line of
 * the cache, so that neighbours in a mesh are found near each other; the runs are scattered by multiplication.
 */
#ifndef MESO_INDEX_MAP_H
#define MESO_INDEX_MAP_H

#include "libcore/base/arena.h"
#include "libcore/base/index.h"

typedef struct MesoIndexEntry {
    uint32_t key_below;     /* key + 1, so that 0 is a free place; keys are below MESO_NO_INDEX */
    uint32_t value;
} MesoIndexEntry;

/* Empty when zero. */
typedef struct MesoIndexMap {
    uint32_t count, room;       /* room: a power of 2, or 0 */
    MesoIndexEntry *entries;    /* [room] */
} MesoIndexMap;

static inline MesoIndexEntry *meso_index_map_place(const MesoIndexMap *map, uint32_t key)
{
    uint32_t mask = map->room - 1;
    uint32_t at = (uint32_t)((key / 8 * UINT64_C(0x9e3779b97f4a7c15)) >> 32 << 3 | key % 8) & mask;
    while (map->entries[at].key_below && map->entries[at].key_below != key + 1)
        at = (at + 1) & mask;
    return &map->entries[at];
}

/* The value of `key`, or MESO_NO_INDEX. */
static inline uint32_t meso_index_map_find(const MesoIndexMap *map, uint32_t key)
{
    const MesoIndexEntry *entry = map->room ? meso_index_map_place(map, key) : NULL;
    return entry && entry->key_below ? entry->value : MESO_NO_INDEX;
}

static inline MesoStatus meso_index_map_enlarge(MesoIndexMap *map, MesoArena *arena, MesoError *error)
{
    if (map->room > UINT32_MAX / 2)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: a map of more than %u numbers", map->count);
    MesoIndexMap larger = {.count = map->count, .room = map->room ? 2 * map->room : 64};
    larger.entries = MESO_NEW(arena, MesoIndexEntry, larger.room, error);
    if (!larger.entries)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < map->room; i++)
        if (map->entries[i].key_below)
            *meso_index_map_place(&larger, map->entries[i].key_below - 1) = map->entries[i];
    *map = larger;
    return MESO_OK;
}

/*
 * Where the value of `key` is held: MESO_NO_INDEX where the key is new. NULL with `error` filled where memory is out.
 * Stands until the next call. What it outgrows stays in the arena. Amortised O(1).
 */
static inline uint32_t *meso_index_map_at(MesoIndexMap *map, MesoArena *arena, uint32_t key, MesoError *error)
{
    if (2 * (uint64_t)map->count >= map->room && meso_index_map_enlarge(map, arena, error))
        return NULL;
    MesoIndexEntry *entry = meso_index_map_place(map, key);
    if (!entry->key_below) {
        *entry = (MesoIndexEntry){key + 1, MESO_NO_INDEX};
        map->count++;
    }
    return &entry->value;
}

#endif
