#include "formats/constraint_names.h"

#include <string.h>

static const char *tile_name(const MesoTileSet *set, uint32_t i)
{
    return set->tiles[i].name;
}

static const char *interface_name(const MesoTileSet *set, uint32_t i)
{
    return set->interfaces[i].name;
}

static json_t *map_names(const MesoTileSet *set, uint32_t count, const char *(*name)(const MesoTileSet *, uint32_t))
{
    json_t *map = json_object();
    bool failed = !map;
    for (uint32_t i = count; i-- > 0 && !failed;)
        failed = json_object_set_new_nocheck(map, name(set, i), json_integer(i)) != 0;
    if (!failed)
        return map;
    json_decref(map);
    return NULL;
}

MesoStatus meso_constraint_names_init(MesoConstraintNames *names, const MesoTileSet *set, MesoError *error)
{
    *names = (MesoConstraintNames){.set = set, .tiles = map_names(set, set->tile_count, tile_name),
                                   .interfaces = map_names(set, set->interface_count, interface_name)};
    if (!names->tiles || !names->interfaces)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the names of tiles");
    return MESO_OK;
}

void meso_constraint_names_release(MesoConstraintNames *names)
{
    json_decref(names->tiles);
    json_decref(names->interfaces);
}

uint32_t meso_constraint_tile(const MesoConstraintNames *names, const MesoJsonField *field, const char *name)
{
    const json_t *number = json_object_get(names->tiles, name);
    uint32_t tile = number ? (uint32_t)json_integer_value(number) : MESO_NO_INDEX;
    if (!number)
        meso_json_wrong(field, "unknown tile '%.80s'; the tile set has no such one", name);
    else if (names->set->tiles[tile].ignored)
        meso_json_wrong(field, "tile '%.80s' is marked as ignored", name);
    else
        return tile;
    return MESO_NO_INDEX;
}

uint32_t meso_constraint_label(const MesoConstraintNames *names, const MesoJsonField *field)
{
    MesoJsonReader *reader = field->reader;
    const char *name = meso_json_text(field);
    size_t length = strlen(name);
    if (!meso_json_good(field))
        return MESO_NO_INDEX;
    bool flipped = length > 0 && name[length - 1] == '\'';
    const char *bare = meso_arena_print(reader->arena, reader->error, "%.*s", (int)(length - flipped), name);
    if (!bare) {
        reader->status = meso_fail(reader->error, MESO_ERR_MEMORY, "%s: out of memory", reader->path);
        return MESO_NO_INDEX;
    }
    const json_t *number = json_object_get(names->interfaces, bare);
    if (number)
        return 2 * (uint32_t)json_integer_value(number) + flipped;
    meso_json_wrong(field, "unknown interface '%.80s'; the tile set has no such one", name);
    return MESO_NO_INDEX;
}
