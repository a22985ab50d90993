#include "cmd/replicate/replicate_files.h"

#include <string.h>

#include "cmd/common/mesh_path.h"

const char *meso_replicate_file_path(const MesoReplicateFiles *files, const char *name)
{
    int folder = meso_folder_length(files->details);
    return *name == '/' || folder == 0
        ? name : meso_arena_print(&files->tool->arena, &files->tool->error, "%.*s%s", folder, files->details, name);
}

const MesoInput *meso_replicate_file(MesoReplicateFiles *files, const char *name, const char *role)
{
    MesoTool *tool = files->tool;
    const char *path = meso_replicate_file_path(files, name);
    for (uint32_t i = 0; path && i < files->count; i++)
        if (strcmp(files->inputs[i].path, path) == 0)
            return &files->inputs[i];
    if (path && files->count == MESO_REPLICATE_FILES) {
        meso_fail(&tool->error, MESO_ERR_LIMIT, "over %d files", MESO_REPLICATE_FILES);
        return NULL;
    }
    if (!path || meso_tool_open_input(tool, &files->inputs[files->count], path, role))
        return NULL;
    return &files->inputs[files->count++];
}

static const MesoInput *open_named(void *context, const char *name, MesoError *error)
{
    MesoReplicateFiles *files = context;
    const MesoInput *input = meso_replicate_file(files, name, "details file");
    if (!input && error != &files->tool->error)
        *error = files->tool->error;
    return input;
}

MesoJsonFiles meso_replicate_json_files(MesoReplicateFiles *files)
{
    return (MesoJsonFiles){files, open_named};
}

void meso_replicate_files_close(MesoReplicateFiles *files)
{
    for (uint32_t i = 0; i < files->count; i++)
        meso_input_close(&files->inputs[i]);
}
