/* meso-info: prints any file of the suite as JSON. */
#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "cmd/info_describe.h"
#include "cmd/tool.h"
#include "formats/container.h"
#include "formats/file_kind.h"
#include "formats/json_text.h"
#include "formats/product_file.h"

static const MesoToolInfo INFO_TOOL = {
    .name = "meso-info",
    .synopsis = "meso-info [options] FILE",
    .purpose = "Check any file of the suite and print what it holds as JSON.",
    .examples = "meso-info vase.slots\n"
                "meso-info vase.meso -o vase.json",
    .operands_low = 1,
    .operands_high = 1,
    .to_standard_output = true,
};

static bool has_extension(const char *path, const char *extension)
{
    size_t length = strlen(path), size = strlen(extension);
    return length > size && strcasecmp(path + length - size, extension) == 0;
}

/* The kind stands in the container's header, behind the magic. */
static MesoStatus describe_container(json_t *facts, MesoArena *arena, const MesoInput *input,
                                     MesoError *error)
{
    bool model = input->size >= 16 && memcmp(input->data + 8, "model\0\0", 8) == 0;
    if (json_object_set_new(facts, "kind", json_string(model ? "model" : "slots")) != 0)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    return model ? meso_info_model(facts, arena, input, error)
                 : meso_info_slots(facts, arena, input, error);
}

static MesoStatus describe_product(json_t *facts, MesoProductKind kind, MesoArena *arena,
                                   const MesoInput *input, MesoError *error)
{
    MesoStatus status = meso_product_describe(facts, kind, input, error);
    if (status != MESO_OK)
        return status;
    /* A mesh that none of our tools made is a surface to grow on, or may be one. */
    bool mesh = kind == MESO_PRODUCT_PLY || kind == MESO_PRODUCT_OBJ;
    const json_t *tool = json_object_get(json_object_get(facts, "provenance"), "tool");
    if (mesh && (!json_is_string(tool) || strcmp(json_string_value(tool), "meso-map") != 0))
        return meso_info_mesh(facts, arena, input, error);
    if (json_object_set_new(facts, "kind", json_string(meso_product_name(kind))) != 0)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    return MESO_OK;
}

static MesoStatus describe(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoProductKind product = meso_product_recognise(input);
    if (meso_container_recognise(input))
        return describe_container(facts, arena, input, error);
    if (product != MESO_PRODUCT_NONE)
        return describe_product(facts, product, arena, input, error);
    MesoFileKind kind = meso_file_kind(input);
    if (kind & MESO_FILES_OF_JSON)
        return meso_info_json(facts, arena, input, error);
    if (has_extension(input->path, ".obj") || has_extension(input->path, ".off") ||
        kind & (MESO_FILE_OBJ | MESO_FILE_PLY | MESO_FILE_OFF))
        return meso_info_mesh(facts, arena, input, error);
    return meso_fail(error, MESO_ERR_INPUT,
                     "%s: no kind of file that is known here: .slots, .meso, .tiles.json or a "
                     "prototype's tile set, report, .obj, .ply, .off, .glb, .drc, .exr, .png",
                     input->path);
}

static int put_file(json_t *facts, const MesoInput *input)
{
    char hash[33];
    snprintf(hash, sizeof hash, "%016" PRIx64 "%016" PRIx64, input->hash[0], input->hash[1]);
    int failed = json_object_set_new(facts, "file", meso_json_string(input->path));
    failed |= json_object_set_new(facts, "kind", json_null());
    failed |= json_object_set_new(facts, "bytes", json_integer((json_int_t)input->size));
    return failed | json_object_set_new(facts, "xxh3_128", json_string(hash));
}

static MesoStatus print(MesoTool *tool, const json_t *facts, MesoError *error)
{
    MesoOutput *output;
    MesoStatus status = meso_output_open(&output, tool->output ? tool->output : "-", error);
    if (status != MESO_OK)
        return status;
    status = meso_json_write(facts, output, error);
    if (status == MESO_OK)
        return meso_output_commit(output, error);
    meso_output_discard(output);
    return status;
}

static MesoStatus inform(MesoTool *tool, MesoError *error)
{
    MesoInput input;
    MesoStatus status = meso_tool_open_input(tool, &input, tool->operands[0], "file");
    if (status != MESO_OK)
        return status;
    json_t *facts = json_object();
    if (put_file(facts, &input) != 0)
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    if (status == MESO_OK)
        status = describe(facts, &tool->arena, &input, error);
    if (status == MESO_OK)
        status = print(tool, facts, error);
    json_decref(facts);
    meso_input_close(&input);
    return status;
}

int main(int argc, char **argv)
{
    static MesoTool tool;
    const MesoOption options[] = {MESO_TOOL_OPTIONS(tool), {0}};
    if (!meso_tool_start(&tool, &INFO_TOOL, options, argc, argv))
        return meso_tool_finish(&tool);
    tool.status = inform(&tool, &tool.error);
    return meso_tool_finish(&tool);
}
