/* Inputs of a tool, refused in plain words where they are of another kind than their place wants. */
#ifndef MESO_INPUT_KIND_H
#define MESO_INPUT_KIND_H

#include "cmd/common/tool.h"
#include "formats/product/file_kind.h"

/* A place of the command line that takes a file. */
typedef struct MesoInputPlace {
    const char *name;           /* as in the synopsis: "TILES"; "--constraints" */
    const char *wanted;         /* "a tile set" */
    const char *role;           /* in the provenance */
    uint32_t kinds;             /* mask of MesoFileKind */
} MesoInputPlace;

extern const MesoInputPlace MESO_PLACE_TILES, MESO_PLACE_TILE_FILE, MESO_PLACE_SURFACE, MESO_PLACE_SLOTS,
    MESO_PLACE_KEEP, MESO_PLACE_MODEL, MESO_PLACE_REPORT, MESO_PLACE_CONSTRAINTS;

/*
 * meso_tool_open_input() in the place's role. MESO_ERR_INPUT too where the file is
 * plainly of another kind, with what it is, what is wanted, and the line of the
 * synopsis that says so. A file of no known kind is left to its reader, but for JSON,
 * whose parser would only complain about the first letter.
 */
MesoStatus meso_tool_open_place(MesoTool *tool, MesoInput *input, const char *path, const MesoInputPlace *place);

#endif
