/* meso-map: grows the geometry of an assignment, and writes it as a model or as a mesh. */
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "cmd/common/input_kind.h"
#include "cmd/common/mesh_path.h"
#include "cmd/common/scene_input.h"
#include "cmd/common/scene_output.h"
#include "cmd/common/surface_judge.h"
#include "cmd/common/tool.h"
#include "cmd/map/map_join.h"
#include "cmd/map/map_relax.h"
#include "cmd/map/map_shell.h"
#include "cmd/map/map_sweep.h"
#include "formats/mesh/mesh_read.h"
#include "formats/mesh/surface_read.h"
#include "formats/model/model_file.h"
#include "formats/tiling/result/slots_file.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/mesh/orientation.h"
#include "libcore/quilt/embed/quilt_lay.h"
#include "libcore/tiling/strand/expansion.h"

static const MesoToolInfo MAP_TOOL = {
    .name = "meso-map",
    .synopsis = "meso-map [options] TILES SURFACE SLOTS -o " MESO_SCENE_OUTPUT_NAMES "\n"
                "meso-map [options] MODEL -o " MESO_SCENE_OUTPUT_NAMES "\n"
                "meso-map [options] QUILT SURFACE -o " MESO_SCENE_OUTPUT_NAMES "\n"
                "meso-map --join PART... -o OUT.ply",
    .purpose = "Write what an assignment, a model or a mesh is as a model or a mesh.",
    .examples = "meso-map vase.tiles.json vase.obj vase.slots -o vase.meso\n"
                "meso-map --divisions 24 vase.meso -o vase.glb\n"
                "meso-map --to ply vase.meso -o - | gzip > vase.ply.gz\n"
                "meso-map vase.obj -o surface.glb\n"
                "meso-map mail.quilt torso-bent.obj -o mail-bent.glb",
    .words = "1 .json .meso .quilt\n"
             "2 .obj .ply .off\n"
             "3 .slots .csv .json\n"
             MESO_SCENE_OUTPUT_WORDS
             "--json .json",
    .operands_low = 1,
    .operands_high = UINT32_MAX,
};

typedef struct MapArguments {
    MesoTool tool;
    MesoMapOptions options;
    struct {
        bool thickness, offset, section_scale, tangent_scale, divisions, section_step;
    } given;
    MesoMapShell shell;
    MesoMapSweep sweep;
    const char *mesh_path;
    bool strict;
    bool pairs;                 /* --quads-from-triangles */
    bool join;                  /* --join */
    const char *embedding;      /* --embed; NULL: as the quilt says */
    MesoSceneOutput output;
} MapArguments;

/* The mapping options, in `options` and in `given`. */
#define MAPPING_ROW(name) {offsetof(MesoMapOptions, name), sizeof((MesoMapOptions){0}.name), \
                           offsetof(MapArguments, given.name)}
#define SHELL_ROW(name) {offsetof(MesoMapOptions, name), sizeof((MesoMapOptions){0}.name), \
                         offsetof(MapArguments, shell.given.name)}
#define SWEEP_ROW(name, option) {offsetof(MesoMapOptions, name), sizeof((MesoMapOptions){0}.name), \
                                 offsetof(MapArguments, sweep.given.option)}
static const struct {
    size_t offset, size, given;
} MAPPING[] = {MAPPING_ROW(thickness), MAPPING_ROW(offset), MAPPING_ROW(section_scale), MAPPING_ROW(tangent_scale),
               MAPPING_ROW(divisions), MAPPING_ROW(section_step), SWEEP_ROW(frame, frame),
               SWEEP_ROW(deform, deform), SWEEP_ROW(section_size, section_size), SWEEP_ROW(tolerance, tolerance),
               SWEEP_ROW(tolerance_in, tolerance), SWEEP_ROW(bends, bends), SWEEP_ROW(relax, relax),
               SHELL_ROW(normals), SHELL_ROW(side), SHELL_ROW(limit_folds)};
enum { MAPPING_COUNT = sizeof MAPPING / sizeof *MAPPING };

static const bool *is_given(const MapArguments *a, uint32_t option)
{
    return (const bool *)((const char *)a + MAPPING[option].given);
}

static bool names_quilt(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ".quilt") == 0;
}

static MesoStatus check_operands(const MapArguments *a, MesoError *error)
{
    if (a->tool.operand_count > 3)
        return meso_fail(error, MESO_ERR_USAGE, "%u operands given, at most 3 needed", a->tool.operand_count);
    if ((a->shell.thickness_by || a->shell.offset_by) && a->tool.operand_count < 3)
        return meso_fail(error, MESO_ERR_USAGE, "--thickness-by and --offset-by are for SURFACE, whose attributes a "
                         "model does not have");
    if (a->tool.operand_count == 2 && !names_quilt(a->tool.operands[0]))
        return meso_fail(error, MESO_ERR_USAGE,
                         "2 operands: give TILES SURFACE SLOTS, MODEL alone, or QUILT SURFACE with a name in .quilt");
    if (a->mesh_path && a->tool.operand_count < 3)
        return meso_fail(error, MESO_ERR_USAGE, "--mesh-path is for TILES; a model holds its meshes");
    if (a->embedding && a->tool.operand_count == 3)
        return meso_fail(error, MESO_ERR_USAGE, "--embed is for quilts, not for TILES");
    if (a->strict && a->tool.operand_count < 3)
        return meso_fail(error, MESO_ERR_USAGE, "--strict is for SURFACE; a model was made of one already");
    return MESO_OK;
}

static const MesoMapOptions DEFAULTS = {.tangent_scale = 1, .section_step = 0.02f, .divisions = 12};

/* Without a model, whose options they override, defaults that are spelled out say nothing. */
static MesoStatus forget_defaults(MapArguments *a, MesoError *error)
{
    if (a->tool.operand_count != 3)
        return MESO_OK;
    a->given.offset &= a->options.offset != DEFAULTS.offset;
    a->given.tangent_scale &= a->options.tangent_scale != DEFAULTS.tangent_scale;
    a->given.section_step &= a->options.section_step != DEFAULTS.section_step;
    a->given.divisions &= a->options.divisions != DEFAULTS.divisions;
    a->shell.given.normals &= a->options.normals != DEFAULTS.normals;
    a->shell.given.side &= a->options.side != DEFAULTS.side;
    a->sweep.given.frame &= a->options.frame != DEFAULTS.frame;
    a->sweep.given.bends &= a->options.bends != DEFAULTS.bends;
    a->sweep.given.deform &= a->options.deform != DEFAULTS.deform;
    a->sweep.given.relax &= a->options.relax != DEFAULTS.relax;
    a->sweep.given.section_size &= a->options.section_size != DEFAULTS.section_size;
    a->tool.provenance.command_line = meso_tool_command(&a->tool, NULL, &a->tool.arena, error);
    return a->tool.provenance.command_line ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- models ---- */

typedef struct Inputs {
    MesoInput tiles, surface, slots;
} Inputs;

static void warn_of_other_inputs(const MesoTool *tool, const MesoSlotsFile *slots, const Inputs *inputs)
{
    bool tiles = memcmp(slots->tiles_hash, inputs->tiles.hash, sizeof inputs->tiles.hash) == 0;
    bool surface = memcmp(slots->surface_hash, inputs->surface.hash, sizeof inputs->surface.hash) == 0;
    if (!slots->anonymous && (!tiles || !surface))
        meso_tool_say(tool, "warning: '%s' was solved with another version of %s%s%s; it still fits",
                      inputs->slots.path, tiles ? "" : "the tile set", tiles || surface ? "" : " and of ",
                      surface ? "" : "the surface");
}

/* The model keeps corners in the order that they were solved in. */
static MesoStatus turn_surface(MesoTool *tool, MesoModel *model, const uint8_t *quarters, MesoError *error)
{
    if (!quarters)
        return MESO_OK;
    MesoStatus status = meso_orientation_turn_mesh(&model->surface, &tool->arena, quarters, error);
    return status ? status : meso_orientation_turn_graph(&model->graph, &tool->arena, quarters, error);
}

/* The surface as it was when its slots were filled: one that disagreed about its side was given one. */
static MesoStatus wind_surface(MesoTool *tool, MesoQuadSurface *surface, const MesoSlotsFile *slots,
                               const Inputs *inputs, MesoWindCounts *wound, MesoError *error)
{
    return slots->over ? meso_quad_surface_wind(surface, &tool->arena, &inputs->surface, slots->over, NULL, wound,
                                                tool->threads, error)
                       : MESO_OK;
}

static MesoStatus bind_slots(MapArguments *a, MesoModel *model, MesoQuadSurface *surface, MesoSlotsFile *slots,
                             const Inputs *inputs, MesoError *error)
{
    MesoTool *tool = &a->tool;
    MesoWindCounts wound = {0};
    if (slots->assignment.slot_count != surface->mesh.face_count)
        return meso_fail(error, MESO_ERR_INPUT,
                         "'%s' assigns %u slots, but '%s' has %u faces: it belongs to another surface",
                         inputs->slots.path, slots->assignment.slot_count, inputs->surface.path,
                         surface->mesh.face_count);
    if (wind_surface(tool, surface, slots, inputs, &wound, error))
        return error->status;
    model->surface = surface->mesh;
    model->graph = surface->graph;
    if (meso_map_shell_heights(tool, &a->shell, &surface->surface.mesh, inputs->surface.path, model))
        return error->status;
    if (meso_slots_bind(slots, &model->tile_set, error))
        return meso_fail_prefix(error, inputs->slots.path);
    if (turn_surface(tool, model, slots->quarters, error))
        return MESO_ERR_MEMORY;
    model->assignment = slots->assignment;
    if (meso_assignment_check(&model->assignment, &model->tile_set, &model->graph, error))
        return meso_fail_prefix(error, inputs->slots.path);
    warn_of_other_inputs(tool, slots, inputs);
    const MesoSurfaceJudge judge = {.path = inputs->surface.path, .mesh = &model->surface, .graph = &model->graph,
                                    .wound = &wound, .strict = a->strict};
    return meso_tool_judge_surface(tool, &judge);
}

static MesoStatus read_parts(MapArguments *a, Inputs *inputs, MesoModel *model, MesoError *error)
{
    MesoTool *tool = &a->tool;
    MesoSlotsFile slots;
    MesoQuadSurface surface = {0};
    MesoStatus status = meso_tool_open_place(tool, &inputs->tiles, tool->operands[0], &MESO_PLACE_TILES);
    if (!status)
        status = meso_tiles_read(&model->tile_set, &tool->arena, &inputs->tiles, error);
    if (!status)
        status = meso_tool_open_place(tool, &inputs->surface, tool->operands[1], &MESO_PLACE_SURFACE);
    if (!status)
        status = (a->pairs ? meso_quad_surface_read_pairs : meso_quad_surface_read)(
            &surface, &tool->arena, &inputs->surface, tool->threads, error);
    if (!status)
        status = meso_tool_open_place(tool, &inputs->slots, tool->operands[2], &MESO_PLACE_SLOTS);
    if (!status)
        status = meso_slots_read(&slots, &tool->arena, &inputs->slots, error);
    if (!status)
        status = bind_slots(a, model, &surface, &slots, inputs, error);
    if (!status)
        status = meso_tool_read_tile_meshes(tool, &model->inner_meshes, &model->tile_set, tool->operands[0],
                                            a->mesh_path);
    model->options = a->options;
    return status;
}

/* What is not given on the command line stays as the model has it. */
static void merge_options(void *context, MesoMapOptions *options)
{
    const MapArguments *a = context;
    for (uint32_t i = 0; i < MAPPING_COUNT; i++)
        if (*is_given(a, i))
            memcpy((char *)options + MAPPING[i].offset, (const char *)&a->options + MAPPING[i].offset,
                   MAPPING[i].size);
    if (a->given.divisions || a->given.section_step)    /* they stand in place of a tolerance */
        options->tolerance = 0;
}

/* A model of tiles, expanded; or the scene of another one, with `tiling` NULL. `inputs` stay open: both may point
 * into them. */
typedef struct Mapped {
    const MesoModel *tiling;
    MesoRelaxReport relaxed;    /* all 0 where nothing was relaxed now */
    MesoScene scene;
} Mapped;

/* Mapping options mean nothing to what was not mapped. */
static MesoStatus check_mapping(const MapArguments *a, const MesoInput *input, const MesoModel *tiling,
                                MesoError *error)
{
    for (uint32_t i = 0; !tiling && i < MAPPING_COUNT; i++)
        if (*is_given(a, i))
            return meso_fail(error, MESO_ERR_USAGE, "mapping options are for models of tiles; '%s' is none",
                             input->path);
    return MESO_OK;
}

static MesoStatus check_quilt(const MapArguments *a, const MesoInput *input, const MesoSceneReading *reading,
                              MesoError *error)
{
    if (a->embedding && !reading->quilt)
        return meso_fail(error, MESO_ERR_USAGE, "--embed is for quilts; '%s' is none", input->path);
    return MESO_OK;
}

static MesoStatus read_model(MapArguments *a, Inputs *inputs, Mapped *mapped, MesoError *error)
{
    MesoSceneReading reading = {.thread_count = a->tool.threads, .remap = merge_options, .context = a,
                                .embedding = a->embedding};
    MesoStatus status = meso_tool_read_scene(&a->tool, &mapped->scene, &inputs->tiles, a->tool.operands[0], &reading);
    mapped->tiling = reading.tiling;
    mapped->relaxed = reading.relaxed;
    if (!status)
        status = check_quilt(a, &inputs->tiles, &reading, error);
    return status ? status : check_mapping(a, &inputs->tiles, reading.tiling, error);
}

/* A quilt over another surface of the same faces, or a finer one of the same texture coordinates. */
static MesoStatus read_quilt(MapArguments *a, Inputs *inputs, Mapped *mapped, MesoError *error)
{
    MesoTool *tool = &a->tool;
    MesoPolygonMesh mesh;
    MesoSceneReading reading = {.thread_count = tool->threads, .surface = &mesh, .surface_input = &inputs->surface,
                                .embedding = a->embedding};
    MesoStatus status = meso_tool_open_place(tool, &inputs->surface, tool->operands[1], &MESO_PLACE_SURFACE);
    if (!status)
        status = meso_polygon_mesh_read(&mesh, &tool->arena, &inputs->surface, tool->threads, error);
    if (!status)
        status = meso_tool_read_scene(tool, &mapped->scene, &inputs->tiles, tool->operands[0], &reading);
    mapped->tiling = NULL;
    if (!status && !reading.quilt)
        status = meso_fail(error, MESO_ERR_INPUT, "%s: is no quilt, and stays where it is", tool->operands[0]);
    return status ? status : check_mapping(a, &inputs->tiles, NULL, error);
}

static MesoStatus make_model(MapArguments *a, Inputs *inputs, Mapped *mapped, MesoError *error)
{
    MesoModel *model = MESO_NEW(&a->tool.arena, MesoModel, 1, error);
    MesoStatus status = model ? read_parts(a, inputs, model, error) : MESO_ERR_MEMORY;
    if (status)
        return status;
    model->options = meso_map_options_resolve(model->options, model->surface.mean_edge_length);
    mapped->tiling = model;
    status = meso_model_relax(model, &mapped->relaxed, &a->tool.arena, a->tool.threads, error);
    if (!status)
        status = meso_model_expand(&mapped->scene, NULL, &a->tool.arena, model, a->tool.threads, error);
    if (status == MESO_ERR_INPUT)       /* what the shell refuses lies in the surface */
        meso_fail_prefix(error, inputs->surface.path);
    return status;
}

static void close_inputs(Inputs *inputs)
{
    MesoInput *all[] = {&inputs->tiles, &inputs->surface, &inputs->slots};
    for (uint32_t i = 0; i < 3; i++)
        if (all[i]->data)
            meso_input_close(all[i]);
}

/* ---- products ---- */

static MesoStatus write_tiling(const void *model, const MesoProvenance *provenance, MesoOutput *output,
                               MesoError *error)
{
    return meso_model_write(model, provenance, output, error);
}

static MesoStatus write_product(MapArguments *a, const Mapped *mapped)
{
    MesoSceneProduct product = {.scene = &mapped->scene};
    if (mapped->tiling) {
        product.write_model = write_tiling;
        product.model = mapped->tiling;
        product.smaller = "lower --divisions or raise --section-step";
    }
    return meso_tool_write_scene(&a->tool, &a->output, &product);
}

static MesoStatus map(MapArguments *a, Inputs *inputs, MesoError *error)
{
    Mapped mapped = {0};
    MesoStatus status = meso_map_sweep_set(&a->sweep, a->given.divisions || a->given.section_step, &a->options, error);
    if (!status)
        status = meso_tool_choose_scene_kind(&a->tool, &a->output);
    if (!status && a->join)
        return meso_map_join(&a->tool, &a->output);
    if (!status)
        status = check_operands(a, error);
    meso_map_shell_set(&a->shell, &a->options);
    if (!status)
        status = forget_defaults(a, error);
    if (!status)
        status = (a->tool.operand_count == 1 ? read_model : a->tool.operand_count == 2 ? read_quilt : make_model)(
            a, inputs, &mapped, error);
    if (!status && mapped.tiling)
        status = meso_map_shell_judge(&a->tool, mapped.tiling);
    if (!status && mapped.relaxed.steps)
        status = meso_map_relax_report(&a->tool, &mapped.relaxed);
    return status ? status : write_product(a, &mapped);
}

int main(int argc, char **argv)
{
    MapArguments a = {.options = DEFAULTS, .output = MESO_SCENE_OUTPUT_DEFAULTS};
    Inputs inputs = {0};
    const MesoOption options[] = {
        MESO_SCENE_KIND_OPTION(a.output),
        MESO_GROUP("Mapping, lengths in scene units"),
        MESO_NUMBER(0, "thickness", "T", "twice the height of the shell (default: the mean edge length)",
                    &a.options.thickness, 1e-12, 1e12, .given = &a.given.thickness,
                    .more = MESO_OPTION_OVERRIDES),
        MESO_NUMBER(0, "offset", "O", "of the shell's bottom along the normals (default 0)",
                    &a.options.offset, -1e12, 1e12, .given = &a.given.offset, .more = MESO_OPTION_OVERRIDES),
        MESO_NUMBER(0, "section-scale", "S",
                    "of the drawings, 1 edge length in them (default: the mean edge length)",
                    &a.options.section_scale, 1e-12, 1e12, .given = &a.given.section_scale,
                    .more = MESO_OPTION_OVERRIDES),
        MESO_NUMBER(0, "tangent-scale", "M", "factor on the handles of trajectories (default 1)",
                    &a.options.tangent_scale, 1e-6, 1e3, .given = &a.given.tangent_scale,
                    .more = MESO_OPTION_OVERRIDES),
        MESO_COUNT(0, "divisions", "N", "vertices along a sweep (default 12)", &a.options.divisions, 2,
                   4096, .given = &a.given.divisions, .more = MESO_OPTION_OVERRIDES),
        MESO_NUMBER(0, "section-step", "X", "sampling step of drawings in edge lengths (default 0.02)",
                    &a.options.section_step, 1e-4, 1, .given = &a.given.section_step,
                    .more = MESO_OPTION_OVERRIDES),
        MESO_MAP_SHELL_OPTIONS(a.shell),
        MESO_MAP_SWEEP_OPTIONS(a.sweep),
        MESO_MAP_RELAX_OPTION(a.sweep, a.options),
        MESO_FOLDER(0, "mesh-path", "DIR", "folder of the tiles' meshes that are not beside TILES",
                    &a.mesh_path, .more = MESO_OPTION_OUTWARD),
        MESO_STRICT_OPTION(a.strict),
        MESO_PAIRS_OPTION(a.pairs),
        MESO_CHOICE(0, "embed", "HOW", "of a quilt: how it lies over its surface (default: as it was made)", &a.embedding,
                    MESO_QUILT_EMBEDDING_NAMES),
        MESO_MESH_OPTIONS(a.output),
        MESO_UP_OPTION(a.output),
        MESO_STRAND_OPTIONS(a.output),
        MESO_PART_OPTIONS(a.output),
        MESO_FLAG(0, "join", "the operands are parts; put them together", &a.join, .more = MESO_OPTION_OUTWARD),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    if (!meso_tool_start(&a.tool, &MAP_TOOL, options, argc, argv))
        return meso_tool_finish(&a.tool);
    a.tool.status = map(&a, &inputs, &a.tool.error);
    close_inputs(&inputs);
    return meso_tool_finish(&a.tool);
}
