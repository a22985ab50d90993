/* Names of tiles and interfaces in constraints, and the numbers that they stand for. */
#ifndef MESO_CONSTRAINT_NAMES_H
#define MESO_CONSTRAINT_NAMES_H

#include "formats/json_field.h"
#include "libcore/tile/tile_set.h"

typedef struct MesoConstraintNames {
    const MesoTileSet *set;
    json_t *tiles, *interfaces;     /* numbers by name */
} MesoConstraintNames;

/* Of equal names the first counts. MESO_ERR_MEMORY; meso_constraint_names_release() is due in any case. */
MesoStatus meso_constraint_names_init(MesoConstraintNames *names, const MesoTileSet *set, MesoError *error);
void meso_constraint_names_release(MesoConstraintNames *names);

/* Number of the tile `name`; MESO_NO_INDEX, told at `field`, where there is none, or it is to be ignored. */
uint32_t meso_constraint_tile(const MesoConstraintNames *names, const MesoJsonField *field, const char *name);

/* Code (label.h) of the label at `field`, "a" or "a'"; MESO_NO_INDEX, told, where there is none. */
uint32_t meso_constraint_label(const MesoConstraintNames *names, const MesoJsonField *field);

#endif
