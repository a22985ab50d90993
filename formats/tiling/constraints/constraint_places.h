/* Places of constraints: the slots that a "where" of meso-constraints(5) selects. */
#ifndef MESO_CONSTRAINT_PLACES_H
#define MESO_CONSTRAINT_PLACES_H

#include "formats/json/json_field.h"
#include "libcore/mesh/polygon_mesh.h"

typedef struct MesoPlaceSelector {
    MesoJsonReader *reader;
    const MesoPolygonMesh *mesh;    /* whose faces are the slots */
    uint32_t slot_count;
    uint64_t total;             /* places so far */
} MesoPlaceSelector;

/*
 * Slots that fulfil every key of `where`, as an array in the reader's arena.
 * NULL where something is wrong, and that is told: no such group, a slot out
 * of range, nothing selected.
 */
uint32_t *meso_places_select(MesoPlaceSelector *selector, const MesoJsonField *where, uint32_t *count);

/* The one slot whose number `slot` is. */
uint32_t *meso_places_of_slot(MesoPlaceSelector *selector, const MesoJsonField *slot, uint32_t *count);

#endif
