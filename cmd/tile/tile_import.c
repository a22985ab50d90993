/* meso-tile import: any tile set that we can read, as .tiles.json. */
#include <string.h>

#include "cmd/common/input_kind.h"
#include "cmd/common/mesh_path.h"
#include "cmd/tile/tile_command.h"
#include "formats/json/json_field.h"
#include "formats/json/json_text.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/tiling/tile/tile_set_check.h"

static const MesoToolInfo info = {
    .name = "meso-tile import",
    .synopsis = "meso-tile import [-o OUT.tiles.json] FILE",
    .purpose = "Writes FILE, a tile set of the MesoGen prototype or of ours, as .tiles.json.",
    .examples = "meso-tile import -o basket.tiles.json basket.json",
    .words = "1 .json\n"
             "--output .tiles.json\n"
             "--json .json",
    .operands_low = 1,
    .operands_high = 1,
};

static void say_problem(void *context, const char *severity, const char *where, const char *message)
{
    const MesoTool *tool = context;
    meso_tool_say_of(tool, tool->operands[0], "%s: %s: %s", severity, where, message);
}

static void say_error(void *context, const char *severity, const char *where, const char *message)
{
    if (strcmp(severity, "error") == 0)
        say_problem(context, severity, where, message);
}

/* Notes on the whole set, of ours; those on parts of it have no place in what was read. */
static int keep_notes(json_t *notes, const json_t *root)
{
    const char *key;
    json_t *value;
    int failed = 0;
    json_object_foreach((json_t *)root, key, value)
        if (meso_json_is_note(key))
            failed |= json_object_set(notes, key, value);
    return failed;
}

static MesoStatus read_set(MesoTool *tool, MesoTileSet *set, json_t *notes)
{
    MesoError *error = &tool->error;
    MesoInput input;
    json_t *root = NULL;
    MesoStatus status = meso_tool_open_place(tool, &input, tool->operands[0], &MESO_PLACE_TILE_FILE);
    if (status)
        return status;
    status = meso_json_parse(&root, &input, error);
    if (!status)
        status = meso_tiles_import(set, &tool->arena, root, input.path, say_problem, tool, error);
    if (!status && keep_notes(notes, root) != 0)
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    json_decref(root);
    meso_input_close(&input);
    if (status)
        return status;

    uint32_t errors;
    status = meso_tile_set_check(&errors, set, say_error, tool, error);
    if (status)
        return status;
    if (errors > 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %u error%s; nothing was written",
                         tool->operands[0], errors, errors == 1 ? "" : "s");
    return MESO_OK;
}

static MesoStatus write_set(const MesoTool *tool, const MesoTileSet *set, json_t *notes, MesoError *error)
{
    json_t *root = meso_tiles_to_json(set);
    if (!root || json_object_set_new(root, "provenance", meso_provenance_json(&tool->provenance)) != 0 ||
        json_object_update(root, notes) != 0) {
        json_decref(root);
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    }
    MesoStatus status = meso_json_write_file(root, tool->output, error);
    json_decref(root);
    return status;
}

static MesoStatus run(MesoTool *tool, json_t *notes)
{
    MesoTileSet set;
    MesoStatus status = meso_tile_refuse_clash(tool);
    if (!status)
        status = read_set(tool, &set, notes);
    if (!status)
        status = meso_tile_report_counts(tool, &set, NULL);
    if (!status && tool->output)
        status = meso_mesh_paths_move(&set, tool->operands[0], tool->output, &tool->arena, &tool->error);
    if (!status)
        status = write_set(tool, &set, notes, &tool->error);
    if (!status && tool->output && strcmp(tool->output, "-") != 0)
        status = meso_tile_find_meshes(&set, tool->output, &tool->arena, say_problem, tool, &tool->error);
    if (status)
        return status;
    meso_tool_say_of(tool, tool->operands[0], "%u interfaces, %u cross-sections, %u tiles, %u sweeps, %u inner meshes",
                     set.interface_count, set.section_count, set.tile_count, set.sweep_count, set.inner_count);
    return MESO_OK;
}

int meso_tile_import(int argc, char **argv)
{
    MesoTool tool = {0};
    MesoOption options[] = {MESO_TOOL_OPTIONS(tool), {0}};
    json_t *notes = json_object();
    if (meso_tile_start(&tool, &info, options, argc, argv))
        tool.status = run(&tool, notes);
    json_decref(notes);
    return meso_tool_finish(&tool);
}
