/* Commands of meso-tile: one file and one row of the table in meso-tile.c each. */
#ifndef MESO_TILE_COMMAND_H
#define MESO_TILE_COMMAND_H

#include <stdio.h>

#include "cmd/common/tool.h"
#include "libcore/tiling/tile/tile_set_check.h"

/* Each runs one command like a program of its own, argv[0] being the command, and returns the exit
 * code. */
int meso_tile_import(int argc, char **argv);
int meso_tile_check(int argc, char **argv);
int meso_tile_list(int argc, char **argv);

/* meso_tool_start() for a command: the provenance is the whole tool's. */
bool meso_tile_start(MesoTool *tool, const MesoToolInfo *info, const MesoOption *options,
                     int argc, char **argv);

/*
 * Text that a command makes: printed to the stream of `text`, then written to
 * -o or standard output at once. `_finish` frees it in any case; give it the
 * status so far, and it returns the final one.
 */
typedef struct MesoTileText {
    FILE *stream;
    char *bytes;
    size_t size;
} MesoTileText;

MesoStatus meso_tile_text_init(MesoTileText *text, MesoError *error);
MesoStatus meso_tile_text_finish(MesoTileText *text, const char *path, MesoStatus status,
                                 MesoError *error);

/* Says by `report` which inner meshes are not to be found from the folder of `path`. */
MesoStatus meso_tile_find_meshes(const MesoTileSet *set, const char *path, MesoArena *arena,
                                 MesoProblemReport *report, void *context, MesoError *error);

/* True if --json puts the report where the product goes without -o. */
bool meso_tile_streams_clash(const MesoTool *tool);

/* meso_fail() for commands whose product must not be mixed with the report. */
MesoStatus meso_tile_refuse_clash(MesoTool *tool);

/* Adds the set's counts, and `variants` where that is given, to the report of the tool. */
MesoStatus meso_tile_report_counts(MesoTool *tool, const MesoTileSet *set, const uint32_t *variants);

#endif
