/* Room for a tile set that is being read from JSON: what the two readers share. */
#ifndef MESO_TILES_ROOM_H
#define MESO_TILES_ROOM_H

#include "formats/json/json_field.h"
#include "libcore/tiling/tile/tile_set.h"

enum { MESO_TILES_ITEMS = 1 << 20 };    /* the most items of a list */

/* Materials that a file does not give; a cross-section's albedo is its interface's colour. */
#define MESO_DEFAULT_ALBEDO 0.8f
#define MESO_DEFAULT_ROUGHNESS 0.5f

/* The most that each array of the set will hold. */
typedef struct MesoTilesRoom {
    uint64_t interfaces, sections, csg, tiles, sweeps, inners;
} MesoTilesRoom;

/* Items of the lists `key` of all objects of `array`; what is no list has none. */
uint64_t meso_tiles_count_items(const json_t *array, const char *key);

/*
 * Nodes of all drawings: in `interfaces` the lists `sections_key`, in their
 * items the drawing `shape_key`, which `count` counts.
 */
uint64_t meso_tiles_count_nodes(const json_t *interfaces, const char *sections_key,
                                const char *shape_key, uint64_t (*count)(const json_t *shape));

/* Empties `set` and gives it arrays of that size; false, with the reader's error filled, on failure. */
bool meso_tiles_reserve(MesoTileSet *set, MesoJsonReader *reader, const MesoTilesRoom *room);

#endif
