#include "cmd/common/scene_output.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "cmd/common/scene_report.h"
#include "formats/model/model_body.h"
#include "formats/scene/strand/strand_scene.h"
#include "formats/scene/strand/usda_scene.h"

static const MesoSceneKind KINDS[] = {
    {"meso", NULL, MESO_SCENE_NO_DRACO, false, NULL},
    {"ply", meso_ply_write, MESO_SCENE_NO_DRACO, false, NULL},
    {"obj", meso_obj_write, MESO_SCENE_NO_DRACO, false, NULL},
    {"glb", meso_glb_write, MESO_SCENE_MAY_DRACO, true, "write .ply"},
    {"drc", meso_drc_write, MESO_SCENE_DRACO, false, "write .glb"},
    {"stl", meso_stl_write, MESO_SCENE_NO_DRACO, false, "write .ply"},
    {"usda", meso_usda_scene_write, MESO_SCENE_NO_DRACO, true, NULL},
};

const MesoSceneKind *meso_scene_kind_named(const char *name)
{
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++)
        if (strcasecmp(KINDS[i].name, name) == 0)
            return &KINDS[i];
    return NULL;
}

static bool is_draco(const MesoSceneOutput *output)
{
    return output->kind->draco == MESO_SCENE_DRACO ||
           (output->kind->draco == MESO_SCENE_MAY_DRACO && strcmp(output->compress, "draco") == 0);
}

static bool is_meshopt(const MesoSceneOutput *output)
{
    return output->kind->draco == MESO_SCENE_MAY_DRACO && strcmp(output->compress, "meshopt") == 0;
}

/* An option that would change nothing was meant for something else. */
static MesoStatus check_options(const MesoSceneOutput *output, MesoError *error)
{
    const char *bits = output->given.normal_bits ? "normal-bits" : NULL;
    bits = output->given.position_bits ? "position-bits" : bits;
    const char *placed = output->given.unit ? "unit" : output->given.up ? "up" : NULL;
    if (bits && !is_draco(output) && !is_meshopt(output))
        return meso_fail(error, MESO_ERR_USAGE, "--%s is for .drc, and for .glb with --compress; the output is .%s",
                         bits, output->kind->name);
    if (output->given.speed && !is_draco(output))
        return meso_fail(error, MESO_ERR_USAGE, "--speed is for .drc, and for .glb with --compress draco; the output "
                         "is .%s", output->kind->name);
    if (is_meshopt(output) && output->position_bits > 16)
        return meso_fail(error, MESO_ERR_USAGE, "--position-bits %u: with --compress meshopt at most 16",
                         output->position_bits);
    if (output->given.compress && output->kind->draco != MESO_SCENE_MAY_DRACO)
        return meso_fail(error, MESO_ERR_USAGE, "--compress is for .glb; the output is .%s", output->kind->name);
    const char *plain = output->instances ? "instances" : output->tangents ? "tangents" : NULL;
    plain = output->lengths ? "lengths" : plain;
    if (plain && (output->kind->draco != MESO_SCENE_MAY_DRACO || is_draco(output) ||
                                                   is_meshopt(output)))
        return meso_fail(error, MESO_ERR_USAGE, "--%s is for .glb that is not compressed", plain);
    if ((output->weld || output->cap_borders) && !output->kind->write)
        return meso_fail(error, MESO_ERR_USAGE, "--%s is for meshes; the output is .%s",
                         output->weld ? "weld" : "cap-borders", output->kind->name);
    if (placed && !output->kind->placed)
        return meso_fail(error, MESO_ERR_USAGE, "--%s is for .glb and .usda; the output is .%s", placed,
                         output->kind->name);
    return MESO_OK;
}

/* Two whole numbers with a character between them, and nothing behind. */
static bool parse_pair(const char *text, char between, uint32_t pair[2])
{
    for (int i = 0; i < 2; i++) {
        char *end;
        unsigned long long value = strtoull(text, &end, 10);
        if (*text < '0' || *text > '9' || *end != (i ? 0 : between) || value > UINT32_MAX)
            return false;
        pair[i] = (uint32_t)value;
        text = end + 1;
    }
    return true;
}

static MesoStatus make_rule(MesoSceneOutput *output, MesoError *error)
{
    uint32_t pair[2];
    if (output->slots && output->shard)
        return meso_fail(error, MESO_ERR_USAGE, "--slots and --shard each say which part; give one of them");
    if (output->slots && output->weld)
        return meso_fail(error, MESO_ERR_USAGE, "--slots cuts strands, --weld joins them; --shard takes whole ones");
    if ((output->slots || output->shard) && !output->kind->write)
        return meso_fail(error, MESO_ERR_USAGE, "--%s is for meshes; a model is small",
                         output->slots ? "slots" : "shard");
    if (output->slots && (!parse_pair(output->slots, '-', pair) || pair[0] > pair[1]))
        return meso_fail(error, MESO_ERR_USAGE, "--slots takes two numbers, the lower one first: 0-99, not '%s'",
                         output->slots);
    if (output->slots)
        output->rule = (MesoSelectionRule){.low = pair[0], .high = pair[1]};
    if (output->shard && (!parse_pair(output->shard, '/', pair) || pair[0] < 1 || pair[0] > pair[1]))
        return meso_fail(error, MESO_ERR_USAGE, "--shard takes a number and of how many: 1/4 to 4/4, not '%s'",
                         output->shard);
    if (output->shard)
        output->rule = (MesoSelectionRule){.shard = pair[0] - 1, .shard_count = pair[1]};
    return MESO_OK;
}

/*
 * The file of materials that goes with an OBJ of a name in .obj: the same name in .mtl. NULL, with `*status`
 * MESO_OK, where there is none to go with: other kinds, and standard output, which has no name.
 */
static const char *materials_path(MesoTool *tool, const MesoSceneOutput *output, MesoStatus *status)
{
    const size_t length = strlen(tool->output);
    *status = MESO_OK;
    if (output->kind->write != meso_obj_write || length < 5 || strcasecmp(tool->output + length - 4, ".obj") != 0)
        return NULL;
    const char *path = meso_arena_print(&tool->arena, &tool->error, "%.*s.mtl", (int)length - 4, tool->output);
    *status = path ? meso_tool_check_output(tool, "-o", path) : MESO_ERR_MEMORY;
    return path;
}

MesoStatus meso_tool_choose_scene_kind(MesoTool *tool, MesoSceneOutput *output)
{
    if (!tool->output)
        tool->output = "-";
    const char *slash = strrchr(tool->output, '/');
    const char *dot = strrchr(slash ? slash : tool->output, '.');
    const char *name = output->to ? output->to : dot ? dot + 1 : "";
    output->kind = meso_scene_kind_named(name);
    if (output->kind) {
        MesoStatus status = check_options(output, &tool->error);
        if (!status)
            status = make_rule(output, &tool->error);
        if (!status)
            materials_path(tool, output, &status);
        return status;
    }
    return meso_fail(&tool->error, MESO_ERR_USAGE,
                     "no kind of file is known by the name '%s': end it in .meso, .ply, .obj, .glb, "
                     ".drc, .stl or .usda, or give --to", tool->output);
}

/* "lower --divisions, or write .ply"; `text` gets NULL where nothing helps. */
static MesoStatus advise(const char **text, MesoTool *tool, const char *smaller, const char *instead)
{
    *text = smaller ? smaller : instead;
    if (!smaller || !instead)
        return MESO_OK;
    *text = meso_arena_print(&tool->arena, &tool->error, "%s, or %s", smaller, instead);
    return *text ? MESO_OK : MESO_ERR_MEMORY;
}

/* What is written, of a scene: all of it where `selection` and `box` are NULL. */
typedef struct Slice {
    MesoSceneParts parts;
    const MesoSelection *selection;
    const MesoBox *box;
    MesoStrands strands;        /* count 0: not told */
} Slice;

static MesoStatus write_mesh(MesoTool *tool, const MesoSceneOutput *output, const Slice *slice,
                             const char *smaller, const char *materials,
                             MesoOutput *file)
{
    const char *slash = materials ? strrchr(materials, '/') : NULL;
    MesoMeshWriteOptions options = {
        .materials = slash ? slash + 1 : materials,
        .thread_count = tool->threads,
        .position_bits = output->position_bits,
        .normal_bits = output->normal_bits,
        .speed = output->speed,
        .compression = is_draco(output) ? MESO_GLB_DRACO : is_meshopt(output) ? MESO_GLB_MESHOPT : MESO_GLB_PLAIN,
        .lengths = output->lengths,
        .tangents = output->tangents,
        .instances = output->instances,
        .z_up = strcmp(output->up, "z") == 0,
        .unit = output->unit,
        .provenance = &tool->provenance,
        .selection = slice->selection,
        .box = slice->box,
        .strand_count = slice->strands.count,
        .strand_lengths = slice->strands.length,
        .progress = meso_tool_progress,
        .progress_context = tool,
    };
    MesoStatus status = advise(&options.smaller, tool, smaller, output->kind->instead);
    return status ? status : output->kind->write(&slice->parts, &options, file, &tool->error);
}

static MesoStatus write_model(MesoTool *tool, const MesoSceneProduct *product, MesoOutput *file)
{
    return product->write_model ? product->write_model(product->model, &tool->provenance, file, &tool->error)
                                : meso_body_write(product->scene, &tool->provenance, file, &tool->error);
}

static void report(MesoTool *tool, const MesoSceneKind *kind, const MesoSceneParts *parts)
{
    struct stat file;
    json_t *root = tool->report;
    uint64_t vertex_count = parts->vertex_begin[parts->part_count];
    json_object_set_new(root, "kind", json_string(kind->name));
    meso_scene_report_ids(root, parts->scene);
    json_object_set_new(root, "parts", json_integer(parts->part_count));
    json_object_set_new(root, "vertices", json_integer((json_int_t)vertex_count));
    json_object_set_new(root, "faces", json_integer((json_int_t)parts->face_begin[parts->part_count]));
    json_object_set_new(root, "triangles", json_integer((json_int_t)parts->triangle_count));
    if (stat(tool->output, &file) == 0 && S_ISREG(file.st_mode))
        json_object_set_new(root, "bytes", json_integer((json_int_t)file.st_size));
    if (tool->verbose)
        meso_tool_say(tool, "%u parts, %llu vertices, %llu triangles", parts->part_count,
                      (unsigned long long)vertex_count, (unsigned long long)parts->triangle_count);
}

static MesoStatus write_materials(MesoTool *tool, const MesoScene *scene, const char *path, MesoOutput **file)
{
    MesoStatus status = path ? meso_output_open(file, path, &tool->error) : MESO_OK;
    return status || !path ? status : meso_mtl_write(scene, &tool->provenance, *file, &tool->error);
}

/* files[0] is the product, files[1] its materials. */
static MesoStatus write_product(MesoTool *tool, const MesoSceneOutput *output, const MesoSceneProduct *product,
                                const Slice *slice, MesoOutput **files)
{
    MesoStatus status;
    const char *materials = materials_path(tool, output, &status);
    if (!status)
        status = meso_output_open(&files[0], tool->output, &tool->error);
    if (!status)
        status = write_materials(tool, product->scene, materials, &files[1]);
    if (status)
        return status;
    meso_tool_progress_begin(tool, "writing", is_draco(output) ? "triangles" : "vertices");
    return output->kind->write ? write_mesh(tool, output, slice, product->smaller, materials, files[0])
                               : write_model(tool, product, files[0]);
}

/* Strands closed, numbered and welded, as the options say. `scene` is made over. */
static MesoStatus make_strands(MesoTool *tool, const MesoSceneOutput *output, MesoScene *scene, MesoStrands *strands)
{
    const MesoScene given = *scene;
    MesoScene closed = given;
    MesoStatus status = MESO_OK;
    if (output->cap_borders)
        status = meso_strand_scene_cap(&closed, &tool->arena, &given, &tool->error);
    if (!status)
        status = meso_strands_find(strands, &tool->arena, &closed, &tool->error);
    if (status)
        return status;
    if (output->weld)
        return meso_strand_scene_weld(scene, &tool->arena, &closed, strands, tool->threads, &tool->error);
    status = meso_strand_scene_number(scene, &tool->arena, &closed, strands, &tool->error);
    if (scene->channel_count == closed.channel_count)
        strands->count = 0;
    return status;
}

/* The parts become those that are selected. */
static MesoStatus select_parts(MesoTool *tool, const MesoSceneOutput *output, Slice *slice, MesoSelection *selection,
                               MesoBox *box)
{
    const MesoSceneParts whole = slice->parts;
    slice->selection = selection;
    slice->box = is_draco(output) ? box : NULL;
    MesoStatus status = meso_selection_make(selection, &tool->arena, &whole, &output->rule, &tool->error);
    if (!status && slice->box)
        status = meso_scene_parts_box(&whole, tool->threads, box, &tool->error);
    return status ? status : meso_scene_parts_init(&slice->parts, &tool->arena, &selection->scene, &tool->error);
}

MesoStatus meso_tool_write_scene(MesoTool *tool, const MesoSceneOutput *output, const MesoSceneProduct *product)
{
    enum { OWN = 2 };
    MesoOutput *files[OWN + MESO_SCENE_BESIDE] = {NULL};
    MesoScene scene = *product->scene;
    MesoSelection selection;
    MesoBox box;
    Slice slice = {.selection = NULL};
    MesoStatus status = MESO_OK;
    for (int i = 0; i < MESO_SCENE_BESIDE; i++)
        files[OWN + i] = product->beside[i];
    if (output->kind->write && scene.sweep_count > 0)
        status = make_strands(tool, output, &scene, &slice.strands);
    if (!status)
        status = meso_scene_parts_init(&slice.parts, &tool->arena, &scene, &tool->error);
    if (!status && (output->slots || output->shard))
        status = select_parts(tool, output, &slice, &selection, &box);
    if (!status)
        status = write_product(tool, output, product, &slice, files);
    status = meso_output_finish_all(files, OWN + MESO_SCENE_BESIDE, status, &tool->error);
    if (!status)
        report(tool, output->kind, &slice.parts);
    return status;
}
