#include "cmd/map/map_join.h"

#include <string.h>

#include "formats/scene/part/ply_join.h"

/* Their provenance is in the product already: they are pieces of it, not what it is made of. */
static MesoStatus open_parts(MesoTool *tool, MesoInput *inputs, uint32_t *opened)
{
    MesoStatus status = MESO_OK;
    for (*opened = 0; *opened < tool->operand_count && !status; *opened += !status) {
        const char *path = tool->operands[*opened];
        status = meso_paths_add_input(&tool->paths, path, &tool->arena, &tool->error);
        if (!status)
            status = meso_input_open(&inputs[*opened], path, &tool->error);
    }
    return status;
}

static MesoStatus write_joined(MesoTool *tool, const MesoInput *inputs)
{
    MesoOutput *file;
    MesoStatus status = meso_output_open(&file, tool->output, &tool->error);
    if (!status)
        status = meso_ply_join(inputs, tool->operand_count, file, &tool->error);
    return meso_output_finish(file, status, &tool->error);
}

MesoStatus meso_map_join(MesoTool *tool, const MesoSceneOutput *output)
{
    uint32_t opened = 0;
    if (output->kind->write != meso_ply_write)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--join puts .ply files together; the output is .%s",
                         output->kind->name);
    if (output->slots || output->shard)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--join makes a whole; --slots and --shard are for its parts");
    MesoInput *inputs = MESO_NEW(&tool->arena, MesoInput, tool->operand_count, &tool->error);
    MesoStatus status = inputs ? open_parts(tool, inputs, &opened) : MESO_ERR_MEMORY;
    if (!status)
        status = write_joined(tool, inputs);
    for (uint32_t i = 0; i < opened; i++)
        meso_input_close(&inputs[i]);
    return status;
}
