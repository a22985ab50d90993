#include "formats/tiling/constraints/constraint_names.h"

#include <string.h>

uint32_t meso_constraint_tile(const MesoConstraintNames *names, const MesoJsonField *field, const char *name)
{
    uint32_t tile = meso_names_find(&names->by_name.tiles, name, strlen(name));
    if (tile == MESO_NO_INDEX)
        meso_json_wrong(field, "unknown tile '%.80s'; the tile set has no such one", name);
    else if (names->set->tiles[tile].ignored)
        meso_json_wrong(field, "tile '%.80s' is marked as ignored", name);
    else
        return tile;
    return MESO_NO_INDEX;
}

uint32_t meso_constraint_label(const MesoConstraintNames *names, const MesoJsonField *field)
{
    const char *name = meso_json_text(field);
    if (!meso_json_good(field))
        return MESO_NO_INDEX;
    int32_t label = meso_label_find(&names->by_name.interfaces, name, strlen(name));
    if (label)
        return meso_label_code(label);
    meso_json_wrong(field, "unknown interface '%.80s'; the tile set has no such one", name);
    return MESO_NO_INDEX;
}
