#include "libcore/tiling/tile/tile_names.h"

#include <string.h>

MesoStatus meso_tile_names_init(MesoTileNames *names, MesoArena *arena, const MesoTileSet *set, MesoError *error)
{
    *names = (MesoTileNames){0};
    for (uint32_t t = 0; t < set->tile_count; t++)
        if (meso_names_add(&names->tiles, arena, set->tiles[t].name, strlen(set->tiles[t].name), t, error) ==
            MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < set->interface_count; i++)
        if (meso_names_add(&names->interfaces, arena, set->interfaces[i].name, strlen(set->interfaces[i].name), i,
                           error) == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
    return MESO_OK;
}

int32_t meso_label_find(const MesoNames *interfaces, const char *text, size_t length)
{
    int flipped = length > 0 && text[length - 1] == '\'';
    uint32_t interface = meso_names_find(interfaces, text, length - (size_t)flipped);
    if (interface == MESO_NO_INDEX)
        return 0;
    return flipped ? -(int32_t)interface - 1 : (int32_t)interface + 1;
}
