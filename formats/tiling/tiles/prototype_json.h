/* Tile sets of the MesoGen prototype, from its JSON. */
#ifndef MESO_PROTOTYPE_JSON_H
#define MESO_PROTOTYPE_JSON_H

#include "formats/json/json_field.h"
#include "libcore/tiling/tile/tile_set_check.h"

/* True if `root` looks like one: it has "tileTypes" and "edgeTypes". */
bool meso_prototype_recognise(const json_t *root);

/*
 * Reads a tile set into `reader->arena`. Things get names: interfaces "a" to
 * "z", then "i27" and so on, cross-sections "1", "2", ... within each, tiles "t1",
 * "t2", ... What our form cannot express is left out, and `report` (may be
 * NULL) hears a warning about it; so are tiles with a wall that shows nothing. Older
 * layouts are read too: discs with a radius, flat tiles' parts of sides as discs. Colours are taken as linear; where an
 * old file has none, a cross-section gets its interface's. Numbers are not
 * checked, see meso_tile_set_check(). Errors go to `reader`. O(size of the JSON).
 */
void meso_prototype_parse(MesoTileSet *set, MesoJsonReader *reader, const json_t *root,
                          MesoProblemReport *report, void *context);

#endif
