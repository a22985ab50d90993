#include "cmd/tile/tile_command.h"

#include <stdlib.h>
#include <string.h>

#include "cmd/common/mesh_path.h"
#include "formats/file/output.h"
#include "libcore/tiling/tile/tile_set_check.h"

bool meso_tile_start(MesoTool *tool, const MesoToolInfo *info, const MesoOption *options,
                     int argc, char **argv)
{
    bool go = meso_tool_start(tool, info, options, argc, argv);
    tool->provenance.tool = "meso-tile";
    return go;
}

MesoStatus meso_tile_text_init(MesoTileText *text, MesoError *error)
{
    *text = (MesoTileText){0};
    text->stream = open_memstream(&text->bytes, &text->size);
    return text->stream ? MESO_OK : meso_fail(error, MESO_ERR_MEMORY, "out of memory");
}

MesoStatus meso_tile_text_finish(MesoTileText *text, const char *path, MesoStatus status,
                                 MesoError *error)
{
    if (!text->stream)
        return status;
    /* A stream in memory that cannot grow says so on the way; its close may not, and leave no bytes. */
    bool whole = fflush(text->stream) == 0 && !ferror(text->stream);
    whole &= fclose(text->stream) == 0;
    if ((!whole || !text->bytes) && !status)
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    MesoOutput *output = NULL;
    if (!status)
        status = meso_output_open(&output, path ? path : "-", error);
    if (!status)
        status = meso_output_write(output, text->bytes, text->size, error);
    status = meso_output_finish(output, status, error);
    free(text->bytes);
    *text = (MesoTileText){0};
    return status;
}

MesoStatus meso_tile_find_meshes(const MesoTileSet *set, const char *path, MesoArena *arena,
                                 MesoProblemReport *report, void *context, MesoError *error)
{
    for (uint32_t t = 0; t < set->tile_count; t++) {
        const MesoTile *tile = &set->tiles[t];
        for (uint32_t i = 0; i < tile->inner_count; i++) {
            const char *file = set->inners[tile->inner_begin + i].file;
            if (!*file)
                continue;
            MesoArenaMark mark = meso_arena_mark(arena);
            bool found = false;
            const char *mesh = meso_mesh_path(path, meso_folder_length(path), file, &found, arena, error);
            char *place = meso_arena_print(arena, error, "tiles[%u] '%s', inner mesh %u", t, tile->name, i);
            char *message = mesh ? meso_arena_print(arena, error, "no file '%s'", mesh) : NULL;
            if (!mesh || !place || !message)
                return MESO_ERR_MEMORY;
            if (!found)
                report(context, "warning", place, message);
            meso_arena_rewind(arena, mark);
        }
    }
    return MESO_OK;
}

bool meso_tile_streams_clash(const MesoTool *tool)
{
    return !tool->output && tool->json && (!*tool->json || strcmp(tool->json, "-") == 0);
}

MesoStatus meso_tile_refuse_clash(MesoTool *tool)
{
    if (!meso_tile_streams_clash(tool))
        return MESO_OK;
    tool->json = NULL;
    return meso_fail(&tool->error, MESO_ERR_USAGE, "the product and the report cannot both go to standard "
                     "output; use --json=FILE or -o FILE");
}

MesoStatus meso_tile_report_counts(MesoTool *tool, const MesoTileSet *set, const uint32_t *variants)
{
    json_t *report = tool->report;
    int failed = json_object_set_new(report, "interfaces", json_integer(set->interface_count));
    failed |= json_object_set_new(report, "cross_sections", json_integer(set->section_count));
    failed |= json_object_set_new(report, "tiles", json_integer(set->tile_count));
    failed |= json_object_set_new(report, "sweeps", json_integer(set->sweep_count));
    failed |= json_object_set_new(report, "inner_meshes", json_integer(set->inner_count));
    if (variants)
        failed |= json_object_set_new(report, "variants", json_integer(*variants));
    return failed ? meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the report") : MESO_OK;
}
