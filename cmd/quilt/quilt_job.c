#include "cmd/quilt/quilt_job.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "cmd/common/seed_list.h"
#include "cmd/quilt/quilt_guide.h"
#include "cmd/quilt/quilt_measure.h"
#include "cmd/quilt/quilt_report.h"
#include "cmd/quilt/quilt_surface.h"
#include "cmd/quilt/quilt_swatch.h"
#include "libcore/base/clock.h"
#include "formats/model/scene_backdrop.h"
#include "libcore/quilt/base/quilt_base.h"
#include "libcore/quilt/embed/quilt_scene.h"
#include "libcore/quilt/finish/quilt_finish.h"
#include "libcore/quilt/settle/quilt_settle.h"

static const uint64_t TRIANGLE_LIMIT = (uint64_t)1 << 30;

/* The base's edges are so much shorter than the swatch's sides. */
static const float EDGE_SHARE = 0.1f;

/* Whole elements may reach so far beyond borders, as a share of the swatch's mean edge. */
static const float OVERHANG = 0.5f;

typedef struct Job {
    MesoQuiltArguments *arguments;
    MesoTool *tool;
    MesoInput swatch_input, surface_input;
    MesoQuiltSwatch swatch;
    MesoQuiltSurface surface;
    MesoSeedList seeds;
    MesoQuiltTimes times;       /* of the swatch and the surface */
    bool as_quilt;              /* the product is a .quilt */
} Job;

/* ---- what goes together ---- */

static bool ends_in(const char *path, const char *extension)
{
    const char *dot = path ? strrchr(path, '.') : NULL;
    return dot && strcasecmp(dot, extension) == 0;
}

/* A swatch by itself: a recipe, and nothing to put it on. */
static bool makes_swatch(const MesoQuiltArguments *a)
{
    return a->swatch && !a->plane && a->tool.operand_count == 0;
}

static MesoStatus check_operands(const MesoQuiltArguments *a, MesoError *error)
{
    uint32_t wanted = 2u - (a->swatch != NULL) - (a->plane != NULL);
    if (makes_swatch(a) || a->tool.operand_count == wanted)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "%u operand%s: give %s%s%s%s", a->tool.operand_count,
                     a->tool.operand_count == 1 ? "" : "s",
                     a->swatch ? "" : "SWATCH", wanted == 2 ? " and " : "", a->plane ? "" : "SURFACE",
                     wanted == 0 ? "none beside --swatch and --plane" : "");
}

static MesoStatus check_recipe(const MesoQuiltArguments *a, MesoError *error)
{
    const char *given = a->given.columns ? "columns" : a->given.rows ? "rows" : a->given.sides ? "sides"
        : a->given.jitter ? "jitter" : a->given.thickness ? "thickness" : NULL;
    if (a->swatch || !given)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "--%s is for a recipe, --swatch", given);
}

/* Those of scenes, and .quilt. */
static MesoStatus choose_kind(Job *job)
{
    MesoQuiltArguments *a = job->arguments;
    const MesoSceneOutput *o = &a->output;
    const char *path = job->tool->output ? job->tool->output : "-", *dot = strrchr(path, '.');
    job->as_quilt = o->to ? strcmp(o->to, "quilt") == 0 : ends_in(path, ".quilt");
    if (!job->as_quilt && !o->to && !(dot && meso_scene_kind_named(dot + 1)))
        return meso_fail(&job->tool->error, MESO_ERR_USAGE, "no kind of file is known by the name '%s': end it in "
                         ".meso, .quilt, .ply, .obj, .glb, .drc, .stl or .usda, or give --to", path);
    if (!job->as_quilt)
        return meso_tool_choose_scene_kind(job->tool, &a->output);
    if (a->under)
        return meso_fail(&job->tool->error, MESO_ERR_USAGE, "--surface is for meshes and models; a .quilt holds its "
                         "surface");
    const char *given = o->given.position_bits ? "position-bits" : o->given.normal_bits ? "normal-bits"
        : o->given.speed ? "speed" : o->given.compress ? "compress" : o->given.unit ? "unit"
        : o->given.up ? "up" : NULL;
    if (!job->tool->output)
        job->tool->output = "-";
    if (!given)
        return MESO_OK;
    return meso_fail(&job->tool->error, MESO_ERR_USAGE, "--%s is for meshes; the output is .quilt", given);
}

static MesoStatus read_seeds(Job *job)
{
    MesoTool *tool = job->tool;
    const char *seeds = job->arguments->seeds;
    if (!seeds)
        return MESO_OK;
    if (tool->seed)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--seed and --seeds are both given; one is needed");
    MesoStatus status = meso_seed_list_parse(&job->seeds, &tool->arena, seeds, &tool->error);
    for (uint32_t r = 0; !status && r < job->seeds.range_count; r++)
        if (job->seeds.ranges[r].attempts > 0)
            status = meso_fail(&tool->error, MESO_ERR_USAGE, "--seeds: there are no attempts here: leave out 'x%u'",
                               job->seeds.ranges[r].attempts);
    if (!status && !meso_seed_path_is_pattern(tool->output))
        status = meso_fail(&tool->error, MESO_ERR_USAGE,
                           "-o '%s': with --seeds it needs one %%d for the seed (and %%%% for a %%)", tool->output);
    return status;
}

/* ---- a quilt ---- */

/* A fifth of the surface is what one sees a texture in; a plane is measured in the swatch's own units. */
static float scale_of(const Job *job)
{
    const MesoQuiltArguments *a = job->arguments;
    const MesoVec3 tile = job->swatch.tile;
    if (a->scale > 0 || a->plane)
        return a->scale > 0 ? a->scale : 1;
    return job->surface.longest_side / 5 / fmaxf(tile.x, tile.y);
}

static MesoQuiltOptions options_of(const Job *job, uint64_t seed, const MesoVec3 *guide)
{
    const MesoQuiltArguments *a = job->arguments;
    const float thick = job->swatch.swatch.size.z;
    return (MesoQuiltOptions){
        .scale = scale_of(job), .height_scale = a->height > 0 && thick > 0 ? a->height / thick : 0,
        .offset = a->offset, .turn_count = a->turns, .guide = guide, .guide_turn = meso_quilt_guide_turn(a),
        .patch = a->patch, .lambda = a->lambda, .mu = a->mu, .seed = seed, .step_limit = a->until,
        .triangle_limit = TRIANGLE_LIMIT,
        .thread_count = job->tool->threads, .progress = meso_tool_progress, .context = job->tool};
}

/* Seconds since `*since`, which is now from then on. */
static double lap(double *since)
{
    double before = *since;
    *since = meso_seconds();
    return *since - before;
}

static MesoStatus grow(Job *job, MesoQuiltResult *result, MesoQuiltBase *base, uint64_t seed)
{
    MesoTool *tool = job->tool;
    MesoQuilt *quilt = &result->quilt;
    double since = meso_seconds();
    MesoQuiltOptions options = options_of(job, seed, base->guide);
    const MesoFinishOptions finish = {.scale = options.scale, .height_scale = options.height_scale,
                                      .offset = options.offset, .thread_count = options.thread_count,
                                      .spent = meso_quilt_room_used(&result->room),
                                      .overhang = OVERHANG * options.scale * job->swatch.swatch.mean_edge};
    meso_tool_progress_begin(tool, "quilting", "triangles");
    MesoStatus status = meso_quilt_grow(quilt, &result->room.arenas[0], &base->mesh, &job->swatch.swatch, &options,
                                        &tool->error);
    result->times.growth = lap(&since);
    const MesoQuiltVertex *before = quilt->vertices;
    if (!status)
        status = meso_quilt_finish(quilt, meso_quilt_room_free(&result->room), base, &job->swatch.swatch, &finish,
                                   &tool->error);
    if (!status)
        meso_quilt_room_turn(&result->room, quilt, before);
    result->times.finish = lap(&since);
    const MesoSettleOptions settle = {.scale = options.scale, .height_scale = options.height_scale,
                                      .offset = options.offset, .overhang = finish.overhang,
                                      .thread_count = options.thread_count,
                                      .partial = options.step_limit > 0};
    before = quilt->vertices;
    if (!status)
        status = meso_quilt_settle(quilt, meso_quilt_room_free(&result->room), &job->surface.base, &job->swatch.swatch,
                                   &settle, &tool->error);
    if (!status)
        meso_quilt_room_turn(&result->room, quilt, before);
    result->times.settling = lap(&since);
    return status;
}

static MesoStatus make_quilt(Job *job, MesoQuiltResult *result, uint64_t seed)
{
    MesoTool *tool = job->tool;
    double since = meso_seconds();
    const MesoSwatch *swatch = &job->swatch.swatch;
    MesoQuiltBase base;
    float scale = scale_of(job), shorter = fminf(swatch->size.x, swatch->size.y);
    float diagonal = sqrtf(swatch->size.x * swatch->size.x + swatch->size.y * swatch->size.y);
    MesoStatus status = meso_quilt_base_build(&base, &tool->arena, &job->surface.base, job->surface.guide,
                                              EDGE_SHARE * scale * shorter, 0.5f * scale * diagonal, &tool->error);
    result->times.base = lap(&since);
    if (!status) {
        json_object_set_new(tool->report, "base_triangles", json_integer(base.mesh.triangle_count));
        status = grow(job, result, &base, seed);
        meso_quilt_base_release(&base);
    }
    if (status == MESO_ERR_INPUT || status == MESO_ERR_LIMIT)
        meso_fail_prefix(&tool->error, job->surface_input.path ? job->surface_input.path : "--plane");
    return status;
}

/* Where it lies: what the report says of stretch is told of a .quilt too. */
static MesoStatus lay_out(Job *job, MesoQuiltResult *result)
{
    MesoTool *tool = job->tool;
    const MesoQuilt *quilt = &result->quilt;
    double since = meso_seconds();
    if (quilt->element_count == 0)
        return meso_fail(&tool->error, MESO_ERR_INPUT, "no element of the swatch fits onto the surface: lower --scale");
    result->positions = MESO_NEW(&tool->arena, MesoVec3, quilt->vertex_count, &tool->error);
    if (!result->positions)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_quilt_lay(result->positions, &result->lay, quilt, &job->surface.base,
                                       meso_quilt_embedding_named(job->arguments->embedding), tool->threads,
                                       &tool->error);
    result->times.embedding = lap(&since);
    return status;
}

/* ---- products ---- */

static MesoStatus write_quilt(const Job *job, const MesoQuiltResult *result)
{
    MesoTool *tool = job->tool;
    MesoOutput *output = NULL;
    struct stat file;
    const MesoQuiltFile product = {result->quilt, job->swatch.swatch, job->surface.base, job->surface.mark,
                                   meso_quilt_embedding_named(job->arguments->embedding), job->surface.uvs};
    MesoStatus status = meso_output_open(&output, tool->output, &tool->error);
    if (!status)
        status = meso_quilt_write(&product, &tool->provenance, output, &tool->error);
    status = meso_output_finish(output, status, &tool->error);
    json_object_set_new(tool->report, "kind", json_string("quilt"));
    if (!status && stat(tool->output, &file) == 0 && S_ISREG(file.st_mode))
        json_object_set_new(tool->report, "bytes", json_integer((json_int_t)file.st_size));
    return status;
}

static MesoStatus write_scene(const Job *job, const MesoQuiltResult *result)
{
    MesoTool *tool = job->tool;
    MesoScene scene;
    MesoQuiltHeights heights = meso_quilt_heights(&result->quilt);
    MesoStatus status = meso_quilt_scene(&scene, &tool->arena, &result->quilt, &job->swatch.swatch, result->positions,
                                         tool->threads, &tool->error);
    scene.thickness = heights.high - heights.low;
    if (!status && job->arguments->under) {
        status = meso_scene_add_backdrop(&scene, &tool->arena, &job->surface.polygons, job->arguments->under,
                                         &tool->error);
        if (status == MESO_ERR_INPUT)
            meso_fail_prefix(&tool->error, job->surface_input.path);
    }
    return status ? status : meso_tool_write_scene(tool, &job->arguments->output,
                                                   &(MesoSceneProduct){.scene = &scene, .smaller = "raise --scale"});
}

static MesoStatus measure(const Job *job, const MesoQuiltResult *result)
{
    const MesoQuiltOptions grown = options_of(job, 0, NULL);
    const MesoQuiltCheckOptions options = {.scale = grown.scale, .height_scale = grown.height_scale,
                                           .offset = grown.offset, .thread_count = grown.thread_count};
    return meso_quilt_measure(job->tool, &result->quilt, &job->swatch.swatch, result->positions, &job->surface.base,
                              &options);
}

static MesoStatus run_seed(Job *job, uint64_t seed)
{
    MesoTool *tool = job->tool;
    MesoQuiltResult result = {.times = job->times};
    MesoStatus status = make_quilt(job, &result, seed);
    if (!status)
        status = lay_out(job, &result);
    if (!status)
        status = (job->as_quilt ? write_quilt : write_scene)(job, &result);
    if (!status)
        status = meso_quilt_report(tool, &result, &job->swatch.swatch, scale_of(job));
    if (!status && job->arguments->check)
        status = measure(job, &result);
    meso_quilt_room_release(&result.room);
    return status;
}

/* ---- many seeds ---- */

/* What its seed alone would give. */
static MesoStatus run_one_of_many(void *context, uint64_t seed)
{
    Job *job = context;
    MesoTool *tool = job->tool;
    tool->output = meso_seed_path(tool->output, seed, &tool->arena, &tool->error);
    MesoStatus status = tool->output ? meso_tool_check_output(tool, "-o", tool->output) : MESO_ERR_MEMORY;
    if (!status)
        status = meso_seed_provenance(tool, seed, &(MesoOptionChange){"output", tool->output}, 1);
    return status ? status : run_seed(job, seed);
}

/* ---- the whole ---- */

static MesoStatus run_recipe(MesoQuiltArguments *a)
{
    MesoPolygonMesh mesh;
    MesoStatus status = meso_quilt_swatch_make(&mesh, a);
    return status ? status : meso_quilt_swatch_write(&mesh, a);
}

static MesoStatus read_inputs(Job *job)
{
    MesoQuiltArguments *a = job->arguments;
    MesoTool *tool = job->tool;
    const char *const *operands = tool->operands;
    double since = meso_seconds();
    MesoStatus status = meso_quilt_swatch_read(&job->swatch, a, &job->swatch_input, a->swatch ? NULL : operands[0]);
    job->times.swatch = lap(&since);
    if (!status)
        status = meso_quilt_surface_read(&job->surface, a, &job->surface_input,
                                         a->plane ? NULL : operands[tool->operand_count - 1]);
    job->times.surface = lap(&since);
    if (status)
        return status;
    meso_quilt_swatch_report(tool->report, &job->swatch);
    json_object_set_new(tool->report, "surface_triangles", json_integer(job->surface.base.triangle_count));
    if (!(a->scale > 0) && !a->plane)
        meso_tool_say(tool, "scale %g: the swatch is a fifth of the surface", (double)scale_of(job));
    return MESO_OK;
}

static void close_inputs(Job *job)
{
    if (job->swatch_input.data)
        meso_input_close(&job->swatch_input);
    if (job->surface_input.data)
        meso_input_close(&job->surface_input);
    meso_quilt_surface_release(&job->surface);
}

MesoStatus meso_quilt_job_run(MesoQuiltArguments *a)
{
    Job job = {.arguments = a, .tool = &a->tool};
    MesoStatus status = check_operands(a, &a->tool.error);
    if (!status)
        status = check_recipe(a, &a->tool.error);
    if (status || makes_swatch(a))
        return status ? status : run_recipe(a);
    status = choose_kind(&job);
    if (!status)
        status = meso_scene_check_backdrop(a->under, &a->tool.error);
    if (!status)
        status = meso_quilt_plane_check(a);
    if (!status)
        status = read_seeds(&job);
    if (!status)
        status = read_inputs(&job);
    if (!status)
        status = a->seeds ? meso_seed_runs(job.tool, &job.seeds, run_one_of_many, &job) : run_seed(&job, a->tool.seed);
    close_inputs(&job);
    return status;
}
