/* Names of tiles and interfaces in constraints, and the numbers that they stand for. */
#ifndef MESO_CONSTRAINT_NAMES_H
#define MESO_CONSTRAINT_NAMES_H

#include "formats/json/json_field.h"
#include "libcore/tiling/tile/tile_names.h"

typedef struct MesoConstraintNames {
    const MesoTileSet *set;
    MesoTileNames by_name;
} MesoConstraintNames;

/* Number of the tile `name`; MESO_NO_INDEX, told at `field`, where there is none, or it is to be ignored. */
uint32_t meso_constraint_tile(const MesoConstraintNames *names, const MesoJsonField *field, const char *name);

/* Code (label.h) of the label at `field`, "a" or "a'"; MESO_NO_INDEX, told, where there is none. */
uint32_t meso_constraint_label(const MesoConstraintNames *names, const MesoJsonField *field);

#endif
