#include "formats/tiling/tiles/tiles_room.h"

#include <limits.h>

uint64_t meso_tiles_count_items(const json_t *array, const char *key)
{
    uint64_t count = 0;
    for (size_t i = 0; i < json_array_size(array); i++)
        count += json_array_size(json_object_get(json_array_get(array, i), key));
    return count;
}

uint64_t meso_tiles_count_nodes(const json_t *interfaces, const char *sections_key,
                                const char *shape_key, uint64_t (*count)(const json_t *shape))
{
    uint64_t nodes = 0;
    for (size_t i = 0; i < json_array_size(interfaces); i++) {
        const json_t *sections = json_object_get(json_array_get(interfaces, i), sections_key);
        for (size_t k = 0; k < json_array_size(sections); k++)
            nodes += count(json_object_get(json_array_get(sections, k), shape_key));
    }
    return nodes;
}

bool meso_tiles_reserve(MesoTileSet *set, MesoJsonReader *reader, const MesoTilesRoom *room)
{
    MesoArena *arena = reader->arena;
    MesoError *error = reader->error;
    if (room->interfaces > INT_MAX || room->sections > INT_MAX || room->csg > INT_MAX ||
        room->tiles > INT_MAX || room->sweeps > INT_MAX || room->inners > INT_MAX) {
        reader->status = meso_fail(error, MESO_ERR_LIMIT, "%s: too large a tile set", reader->path);
        return false;
    }
    *set = (MesoTileSet){
        .interfaces = MESO_NEW(arena, MesoInterface, room->interfaces, error),
        .sections = MESO_NEW(arena, MesoSection, room->sections, error),
        .csg = MESO_NEW(arena, MesoCsgNode, room->csg, error),
        .tiles = MESO_NEW(arena, MesoTile, room->tiles, error),
        .sweeps = MESO_NEW(arena, MesoSweep, room->sweeps, error),
        .inners = MESO_NEW(arena, MesoInnerMesh, room->inners, error),
    };
    bool all = set->interfaces && set->sections && set->csg && set->tiles && set->sweeps && set->inners;
    if (!all)
        reader->status = MESO_ERR_MEMORY;
    return all;
}
