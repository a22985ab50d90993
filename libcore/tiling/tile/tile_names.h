/* The names of a tile set's tiles and interfaces, for texts that refer to them. */
#ifndef MESO_TILE_NAMES_H
#define MESO_TILE_NAMES_H

#include "libcore/base/names.h"
#include "libcore/tiling/tile/tile_set.h"

typedef struct MesoTileNames {
    MesoNames tiles, interfaces;
} MesoTileNames;

/* Of equal names the first counts. `set` must outlive the names. MESO_ERR_MEMORY alone. */
MesoStatus meso_tile_names_init(MesoTileNames *names, MesoArena *arena, const MesoTileSet *set, MesoError *error);

/* Label "a" or "a'" in the `length` bytes of `text`, or 0 where `interfaces` has no such name. */
int32_t meso_label_find(const MesoNames *interfaces, const char *text, size_t length);

#endif
