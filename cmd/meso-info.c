/* meso-info: prints any file of the suite as JSON. */
#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "cmd/common/tool.h"
#include "cmd/info/info_compare.h"
#include "cmd/info/info_describe.h"
#include "cmd/info/info_grammar.h"
#include "cmd/info/info_quilt.h"
#include "cmd/info/info_replicate.h"
#include "formats/file/container.h"
#include "formats/json/json_text.h"
#include "formats/product/file_kind.h"
#include "formats/product/product_file.h"
#include "formats/tiling/result/slots_file.h"
#include "formats/tiling/result/slots_text.h"

static const MesoToolInfo INFO_TOOL = {
    .name = "meso-info",
    .synopsis = "meso-info [options] FILE...\n"
                "meso-info --slots csv|json SLOTS\n"
                "meso-info --compare PICTURE PICTURE",
    .purpose = "Check any files of the suite and print what they hold as JSON.",
    .examples = "meso-info vase.slots\n"
                "meso-info vase.meso -o vase.json\n"
                "meso-info --slots csv vase.slots -o vase.csv\n"
                "meso-info --compare before.exr after.exr",
    .words = "1 *\n"
             "--output .json .csv\n"
             "--json .json",
    .operands_low = 1,
    .operands_high = UINT32_MAX,
    .to_standard_output = true,
};

typedef struct InfoArguments {
    MesoTool tool;
    const char *slots;          /* --slots: csv, json, or NULL */
    const char *compared;       /* --compare: a picture, or NULL */
} InfoArguments;

static bool has_extension(const char *path, const char *extension)
{
    size_t length = strlen(path), size = strlen(extension);
    return length > size && strcasecmp(path + length - size, extension) == 0;
}

static MesoStatus put_kind(json_t *facts, const char *kind, MesoError *error)
{
    return json_object_set_new(facts, "kind", json_string(kind)) == 0 ? MESO_OK
               : meso_fail(error, MESO_ERR_MEMORY, "out of memory");
}

static MesoStatus describe_container(json_t *facts, MesoArena *arena, const MesoInput *input,
                                     MesoError *error)
{
    MesoFileKind kind = meso_file_kind(input);
    if (kind == MESO_FILE_STATE || kind == MESO_FILE_PLAN)
        return (kind == MESO_FILE_STATE ? meso_info_state : meso_info_plan)(facts, arena, input, error);
    MesoStatus status = put_kind(facts, kind == MESO_FILE_MODEL ? "model" : kind == MESO_FILE_QUILT ? "quilt" : "slots",
                                 error);
    if (status)
        return status;
    return kind == MESO_FILE_MODEL ? meso_info_model(facts, arena, input, error)
        : kind == MESO_FILE_QUILT ? meso_info_quilt(facts, arena, input, error)
                                  : meso_info_slots(facts, arena, input, error);
}

static MesoStatus describe_product(json_t *facts, MesoProductKind kind, MesoArena *arena,
                                   const MesoInput *input, MesoError *error)
{
    MesoStatus status = meso_product_describe(facts, kind, input, error);
    if (status)
        return status;
    /* A mesh that none of our tools made is a surface to grow on, or may be one. */
    bool mesh = kind == MESO_PRODUCT_PLY || kind == MESO_PRODUCT_OBJ;
    const json_t *tool = json_object_get(json_object_get(facts, "provenance"), "tool");
    if (mesh && (!json_is_string(tool) || strcmp(json_string_value(tool), "meso-map") != 0))
        return meso_info_mesh(facts, arena, input, error);
    return put_kind(facts, meso_product_name(kind), error);
}

static MesoStatus describe(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoProductKind product = meso_product_recognise(input);
    if (meso_container_recognise(input))
        return describe_container(facts, arena, input, error);
    if (product != MESO_PRODUCT_NONE)
        return describe_product(facts, product, arena, input, error);
    MesoFileKind kind = meso_file_kind(input);
    if (kind == MESO_FILE_SEED_LINES)
        return meso_info_seed_lines(facts, arena, input, error);
    if (kind == MESO_FILE_LISTING || kind == MESO_FILE_CSV || has_extension(input->path, ".csv")) {
        MesoStatus status = put_kind(facts, "slots", error);
        return status ? status : meso_info_slots(facts, arena, input, error);
    }
    if (kind == MESO_FILE_GRAMMAR)
        return meso_info_grammar(facts, arena, input, error);
    if (kind & MESO_FILES_OF_JSON)
        return meso_info_json(facts, arena, input, error);
    if (has_extension(input->path, ".obj") || has_extension(input->path, ".off") ||
        kind & (MESO_FILE_OBJ | MESO_FILE_PLY | MESO_FILE_OFF))
        return meso_info_mesh(facts, arena, input, error);
    return meso_fail(error, MESO_ERR_INPUT,
                     "%s: no kind of file that is known here: .slots or a listing of slots, .meso, .quilt, "
                     ".tiles.json or a prototype's tile set, constraints, report, pattern, .grammar, .jsonl of seeds, details, .state, "
                     ".plan, .obj, .ply, .off, .glb, .drc, .exr, .png",
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

/* The report names the first files alone where there are more than a provenance holds. */
static MesoStatus open_file(MesoTool *tool, MesoInput *input, const char *path)
{
    if (tool->provenance.input_count < MESO_PROVENANCE_INPUTS)
        return meso_tool_open_input(tool, input, path, "file");
    return meso_input_open(input, path, &tool->error);
}

static MesoStatus inform(MesoTool *tool, json_t *facts, const char *path, MesoError *error)
{
    MesoInput input;
    MesoStatus status = open_file(tool, &input, path);
    if (status)
        return status;
    MesoArenaMark mark = meso_arena_mark(&tool->arena);
    if (put_file(facts, &input) != 0)
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    if (!status)
        status = describe(facts, &tool->arena, &input, error);
    meso_arena_rewind(&tool->arena, mark);
    meso_input_close(&input);
    return status;
}

static MesoStatus inform_of_one(MesoTool *tool, MesoError *error)
{
    json_t *facts = json_object();
    MesoStatus status = inform(tool, facts, tool->operands[0], error);
    if (!status)
        status = meso_json_write_file(facts, tool->output, error);
    json_decref(facts);
    return status;
}

/* What is known of a file that is no good: its name, and why. */
static json_t *failed_facts(const char *path, const MesoError *why)
{
    json_t *facts = json_object();
    int failed = json_object_set_new(facts, "file", meso_json_string(path));
    failed |= json_object_set_new(facts, "kind", json_null());
    failed |= json_object_set_new(facts, "error", meso_json_string(why->message));
    if (!failed)
        return facts;
    json_decref(facts);
    return NULL;
}

/* Appends the facts of one file. Of MESO_ERR_INPUT the next file knows nothing; other errors end the work. */
static MesoStatus append_facts(MesoTool *tool, json_t *list, const char *path, MesoError *error)
{
    json_t *facts = json_object();
    MesoStatus status = inform(tool, facts, path, error);
    if (status) {
        json_decref(facts);
        facts = failed_facts(path, error);
    }
    if (status == MESO_ERR_INPUT)
        meso_tool_complain(tool, error);
    if (json_array_append_new(list, facts) != 0)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    return status;
}

/* An array, in the order of the operands. */
static MesoStatus inform_of_several(MesoTool *tool, MesoError *error)
{
    json_t *list = json_array();
    MesoStatus status = list ? MESO_OK : meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    uint32_t bad = 0;
    for (uint32_t i = 0; i < tool->operand_count && !status; i++) {
        status = append_facts(tool, list, tool->operands[i], error);
        if (status == MESO_ERR_INPUT) {
            bad++;
            status = MESO_OK;
        }
    }
    if (!status)
        status = meso_json_write_file(list, tool->output, error);
    json_decref(list);
    if (!status && bad > 0)
        return meso_fail(error, MESO_ERR_INPUT, "%u of %u files are no good", bad, tool->operand_count);
    return status;
}

/* ---- listings ---- */

static MesoStatus write_listing(const InfoArguments *a, const MesoSlotsFile *slots, MesoError *error)
{
    MesoOutput *output;
    json_t *root = NULL;
    bool csv = strcmp(a->slots, "csv") == 0;
    if (!csv) {
        root = meso_slots_to_json(slots);
        if (json_object_set_new(root, "provenance", meso_provenance_json(&a->tool.provenance)) != 0) {
            json_decref(root);
            return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
        }
    }
    MesoStatus status = meso_output_open(&output, a->tool.output ? a->tool.output : "-", error);
    if (!status)
        status = csv ? meso_slots_write_csv(slots, output, error) : meso_json_write(root, output, error);
    json_decref(root);
    return meso_output_finish(output, status, error);
}

static MesoStatus list_slots(InfoArguments *a, MesoError *error)
{
    MesoTool *tool = &a->tool;
    MesoSlotsFile slots;
    MesoInput input;
    if (tool->operand_count > 1)
        return meso_fail(error, MESO_ERR_USAGE, "--slots lists one file; %u are given", tool->operand_count);
    MesoStatus status = open_file(tool, &input, tool->operands[0]);
    if (status)
        return status;
    status = meso_slots_read(&slots, &tool->arena, &input, error);
    if (!status)
        status = write_listing(a, &slots, error);
    meso_input_close(&input);
    return status;
}

/* ---- pictures ---- */

static MesoStatus compare_pictures(InfoArguments *a, MesoError *error)
{
    MesoTool *tool = &a->tool;
    MesoInput first, second;
    if (tool->operand_count > 1 || a->slots)
        return meso_fail(error, MESO_ERR_USAGE, "--compare FILE is for one other file%s",
                         a->slots ? ", and not for --slots" : "");
    MesoStatus status = meso_tool_open_input(tool, &first, a->compared, "picture");
    if (status)
        return status;
    status = open_file(tool, &second, tool->operands[0]);
    if (status) {
        meso_input_close(&first);
        return status;
    }
    json_t *facts = json_object();
    status = meso_info_compare(facts, &tool->arena, &first, &second, error);
    if (!status || status == MESO_ERR_NO) {
        MesoStatus written = meso_json_write_file(facts, tool->output, error);
        status = written ? written : status;
    }
    json_decref(facts);
    meso_input_close(&first);
    meso_input_close(&second);
    return status;
}

int main(int argc, char **argv)
{
    static InfoArguments a;
    const MesoOption options[] = {
        MESO_CHOICE(0, "slots", "FORMAT", "list which tile each slot of an assignment holds: csv or json",
                    &a.slots, "csv|json"),
        MESO_INPUT_FILE(0, "compare", "PICTURE", "how far FILE is from that picture, in each channel, and where most",
                        &a.compared),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    MesoTool *tool = &a.tool;
    if (!meso_tool_start(tool, &INFO_TOOL, options, argc, argv))
        return meso_tool_finish(tool);
    if (a.compared)
        tool->status = compare_pictures(&a, &tool->error);
    else if (a.slots)
        tool->status = list_slots(&a, &tool->error);
    else
        tool->status = tool->operand_count == 1 ? inform_of_one(tool, &tool->error) : inform_of_several(tool, &tool->error);
    return meso_tool_finish(tool);
}
