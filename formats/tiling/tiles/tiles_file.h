/* Tile sets from and to files: ours (.tiles.json) and the prototype's JSON. */
#ifndef MESO_TILES_FILE_H
#define MESO_TILES_FILE_H

#include <jansson.h>

#include "formats/file/input.h"
#include "libcore/tiling/tile/tile_set_check.h"

enum { MESO_TILES_VERSION = 1 };

/*
 * Reads a tile set of either kind, known by its content, into `arena` (names
 * too), and runs meso_tile_set_check() on it. MESO_ERR_INPUT names the file
 * and the place ("tiles[3].sides[1]: unknown interface 'x'"), the line and
 * column where the JSON itself is broken, and a newer version.
 */
MesoStatus meso_tiles_read(MesoTileSet *set, MesoArena *arena, const MesoInput *input, MesoError *error);

/* The same without the check. */
MesoStatus meso_tiles_parse(MesoTileSet *set, MesoArena *arena, const MesoInput *input, MesoError *error);

/*
 * The same for `meso-tile check`, which wants every problem: `report` hears of
 * each one in the fields, by its place, and the reading goes on. MESO_ERR_INPUT
 * with an empty message where it heard of any; other errors as above.
 */
MesoStatus meso_tiles_survey(MesoTileSet *set, MesoArena *arena, const MesoInput *input,
                             MesoProblemReport *report, void *context, MesoError *error);

/* Our form as JSON; NULL when memory is out. meso_tiles_from_json(meso_tiles_to_json(x)) is x. */
json_t *meso_tiles_to_json(const MesoTileSet *set);

/* From parsed JSON of either kind; `path` is for messages. */
MesoStatus meso_tiles_from_json(MesoTileSet *set, MesoArena *arena, const json_t *root,
                                const char *path, MesoError *error);

/* The same; `report` (may be NULL) hears warnings about what our form cannot keep of the prototype's. */
MesoStatus meso_tiles_import(MesoTileSet *set, MesoArena *arena, const json_t *root, const char *path,
                             MesoProblemReport *report, void *context, MesoError *error);

#endif
