#include "cmd/common/input_kind.h"

#include <string.h>

enum { TILE_SETS = MESO_FILE_TILES | MESO_FILE_PROTOTYPE | MESO_FILE_JSON };

const MesoInputPlace MESO_PLACE_TILES = {"TILES", "a tile set", "tiles", TILE_SETS};
const MesoInputPlace MESO_PLACE_TILE_FILE = {"FILE", "a tile set", "tiles", TILE_SETS};
const MesoInputPlace MESO_PLACE_SURFACE = {
    "SURFACE", "a surface (OBJ, PLY, OFF, glTF or Draco)", "surface",
    MESO_FILE_OBJ | MESO_FILE_PLY | MESO_FILE_OFF | MESO_FILE_GLB | MESO_FILE_GLTF | MESO_FILE_DRC};
const MesoInputPlace MESO_PLACE_SLOTS = {"SLOTS", "an assignment (.slots)", "slots",
                                         MESO_FILE_SLOTS | MESO_FILE_LISTING | MESO_FILE_CSV};
const MesoInputPlace MESO_PLACE_KEEP = {"--keep", "an assignment (.slots)", "keep",
                                        MESO_FILE_SLOTS | MESO_FILE_LISTING | MESO_FILE_CSV};
const MesoInputPlace MESO_PLACE_MODEL = {
    "MODEL", "a model (.meso), a quilt or a mesh (OBJ, PLY, OFF, glTF or Draco)", "model",
    MESO_FILE_MODEL | MESO_FILE_QUILT | MESO_FILE_OBJ | MESO_FILE_PLY | MESO_FILE_OFF | MESO_FILE_GLB | MESO_FILE_GLTF | MESO_FILE_DRC};
const MesoInputPlace MESO_PLACE_REPORT = {"REPORT", "a report of meso-solve", "report",
                                          MESO_FILE_REPORT | MESO_FILE_JSON};
const MesoInputPlace MESO_PLACE_CONSTRAINTS = {"--constraints", "a file of constraints", "constraints",
                                               MESO_FILE_CONSTRAINTS | MESO_FILE_JSON};

/* The line of the synopsis that has the place's name; NULL where none has, for an option. */
static const char *synopsis_line(const MesoToolInfo *info, const char *name, int *length)
{
    const char *at = strstr(info->synopsis, name), *begin = at;
    while (begin && begin > info->synopsis && begin[-1] != '\n')
        begin--;
    *length = begin ? (int)strcspn(begin, "\n") : 0;
    return begin;
}

static MesoStatus refuse(MesoTool *tool, const MesoInput *input, const MesoInputPlace *place, MesoFileKind kind)
{
    int length;
    const char *line = synopsis_line(tool->info, place->name, &length);
    return meso_fail(&tool->error, MESO_ERR_INPUT, "%s: '%s' is %s; %s is wanted there%s%.*s", place->name, input->path,
                     meso_file_kind_phrase(kind), place->wanted, line ? ": " : "", length, line ? line : "");
}

MesoStatus meso_tool_open_place(MesoTool *tool, MesoInput *input, const char *path, const MesoInputPlace *place)
{
    MesoStatus status = meso_tool_open_input(tool, input, path, place->role);
    if (status)
        return status;
    MesoFileKind kind = meso_file_kind(input);
    bool json = (place->kinds & ~(uint32_t)MESO_FILES_OF_JSON) == 0;
    if (kind == MESO_FILE_UNKNOWN ? json : !(kind & place->kinds)) {
        status = refuse(tool, input, place, kind);
        meso_input_close(input);
    }
    return status;
}
