#include "cmd/decor/decor_job.h"

#include <string.h>
#include <strings.h>

#include "cmd/common/input_kind.h"
#include "cmd/common/seed_list.h"
#include "cmd/decor/decor_surface.h"
#include "formats/decor/lines_file.h"
#include "formats/decor/pattern_file.h"
#include "formats/decor/tree_file.h"
#include "libcore/decor/decor.h"

/* Files do not number more regions, and nobody looks at them. */
enum { REGION_LIMIT = 1 << 18 };
static const uint64_t TRIANGLE_LIMIT = (uint64_t)1 << 28;

static const MesoInputPlace PLACE_PATTERN = {"PATTERN", "a pattern (.pattern.json)", "pattern",
                                             MESO_FILE_PATTERN | MESO_FILE_JSON};

enum { MOST_FILES = 64 };

typedef struct Job {
    MesoDecorArguments *arguments;
    MesoTool *tool;
    MesoInput pattern_input, surface_input;
    MesoInput files[MOST_FILES];    /* [file_count] that the pattern names */
    uint32_t file_count;
    MesoSeedList seeds;
    MesoPattern pattern;
    MesoDecorSurface surface;
} Job;

/* ---- inputs ---- */

/* Beside the pattern, where its path is not absolute. */
static const MesoInput *open_named(void *context, const char *name, MesoError *error)
{
    Job *job = context;
    MesoTool *tool = job->tool;
    const char *pattern = job->pattern_input.path, *slash = strrchr(pattern, '/');
    if (job->file_count == MOST_FILES) {
        meso_fail(error, MESO_ERR_LIMIT, "over %d files", MOST_FILES);
        return NULL;
    }
    const char *path = *name == '/' || !slash
        ? name : meso_arena_print(&tool->arena, error, "%.*s/%s", (int)(slash - pattern), pattern, name);
    MesoInput *input = &job->files[job->file_count];
    if (!path)
        return NULL;
    if (meso_tool_open_input(tool, input, path, "pattern file")) {
        if (error != &tool->error)
            *error = tool->error;
        return NULL;
    }
    job->file_count++;
    return input;
}

static MesoStatus read_inputs(Job *job)
{
    MesoTool *tool = job->tool;
    const MesoJsonFiles files = {job, open_named};
    MesoStatus status = meso_tool_open_place(tool, &job->pattern_input, tool->operands[0], &PLACE_PATTERN);
    if (status)
        return status;
    status = meso_pattern_read(&job->pattern, &tool->arena, &job->pattern_input, &files, &tool->error);
    if (!status)
        status = meso_decor_surface_read(&job->surface, tool, &job->surface_input, tool->operands[1]);
    return status;
}

static void close_inputs(Job *job)
{
    for (uint32_t i = 0; i < job->file_count; i++)
        meso_input_close(&job->files[i]);
    meso_input_close(&job->pattern_input);
    meso_input_close(&job->surface_input);
}

/* ---- a run ---- */

static void say_note(void *context, const char *place, const char *text)
{
    MesoTool *tool = context;
    meso_tool_say(tool, "warning: %s: %s: %s", tool->operands[0], place, text);
}

static MesoGeodesicEngine engine_of(const MesoDecorArguments *a)
{
    return strcmp(a->engine, "graph") == 0 ? MESO_GEODESIC_GRAPH
        : strcmp(a->engine, "exact") == 0 ? MESO_GEODESIC_EXACT : MESO_GEODESIC_FRONTS;
}

static bool ends_in(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, extension) == 0;
}

static MesoStatus write_text(const Job *job, const MesoDecor *decor, const char *path, bool tree, MesoOutput *output)
{
    MesoTool *tool = job->tool;
    if (tree)
        return meso_tree_write(decor, &tool->provenance, output, &tool->error);
    return ends_in(path, ".svg") ? meso_lines_svg_write(decor, &tool->provenance, output, &tool->error)
                                 : meso_lines_obj_write(decor, &tool->provenance, output, &tool->error);
}

/* A file that is to appear with the scene's; NULL where none is wanted, and on failure. */
static MesoStatus write_beside(const Job *job, const MesoDecor *decor, const char *path, bool tree, MesoOutput **output)
{
    *output = NULL;
    MesoStatus status = path ? meso_output_open(output, path, &job->tool->error) : MESO_OK;
    if (!path || status)
        return status;
    status = write_text(job, decor, path, tree, *output);
    if (status) {
        meso_output_discard(*output);
        *output = NULL;
    }
    return status;
}

static MesoStatus write_products(const Job *job, const MesoDecor *decor)
{
    const MesoDecorArguments *a = job->arguments;
    MesoTool *tool = job->tool;
    MesoScene scene;
    MesoSceneProduct product = {.scene = &scene};
    MesoStatus status = meso_decor_scene(&scene, &tool->arena, decor, &job->pattern, &job->surface.values,
                                         &tool->error);
    if (!status)
        status = write_beside(job, decor, a->tree, true, &product.beside[0]);
    if (!status)
        status = write_beside(job, decor, a->lines, false, &product.beside[1]);
    if (!status)
        return meso_tool_write_scene(tool, &a->output, &product);
    meso_output_discard(product.beside[0]);
    return status;
}

static void report(const Job *job, const MesoDecor *decor)
{
    uint32_t leaves = 0, depth = 0;
    for (uint32_t r = 0; r < decor->tree.region_count; r++) {
        leaves += decor->tree.regions[r].child_count == 0;
        depth = decor->tree.regions[r].depth > depth ? decor->tree.regions[r].depth : depth;
    }
    json_t *root = job->tool->report;
    json_object_set_new(root, "operations", json_integer(decor->operation_count));
    json_object_set_new(root, "regions", json_integer(leaves));
    json_object_set_new(root, "tree_regions", json_integer(decor->tree.region_count));
    json_object_set_new(root, "depth", json_integer(depth));
    json_object_set_new(root, "surface_triangles", json_integer(job->surface.triangles.mesh.face_count));
    if (job->tool->verbose)
        meso_tool_say(job->tool, "%u operations, %u regions, depth %u, %u triangles", decor->operation_count, leaves,
                      depth, decor->mesh.triangle_count);
}

static MesoStatus run_seed(Job *job, uint64_t seed)
{
    MesoTool *tool = job->tool;
    const MesoDecorOptions options = {
        .seed = seed, .engine = engine_of(job->arguments), .threads = tool->threads, .step_limit = job->arguments->until,
        .region_limit = REGION_LIMIT, .triangle_limit = TRIANGLE_LIMIT, .progress = meso_tool_progress,
        .note = say_note, .context = tool,
    };
    MesoDecor decor = {.keep_lines = job->arguments->lines != NULL, .surface = &job->surface.polygons};
    MesoStatus status = meso_decor_surface_start(&decor.mesh, &job->surface, &tool->error);
    if (status)
        return status;
    meso_tool_progress_begin(tool, "decorating", "operations");
    status = meso_decor_run(&decor, &tool->arena, &job->pattern, &options, &tool->error);
    if (status == MESO_ERR_INPUT || status == MESO_ERR_LIMIT)
        meso_fail_prefix(&tool->error, job->pattern_input.path);
    if (!status)
        status = write_products(job, &decor);
    if (!status)
        report(job, &decor);
    meso_triangulation_release(&decor.mesh);
    return status;
}

/* ---- many seeds ---- */

/* What the options name, for all seeds. */
typedef struct Names {
    const char *output, *tree, *lines;
} Names;

static MesoStatus check_names(const Job *job)
{
    const MesoDecorArguments *a = job->arguments;
    const char *const given[] = {job->tool->output, a->tree, a->lines}, *const options[] = {"-o", "--tree", "--lines"};
    for (int i = 0; i < 3; i++)
        if (given[i] && !meso_seed_path_is_pattern(given[i]))
            return meso_fail(&job->tool->error, MESO_ERR_USAGE,
                             "%s '%s': with --seeds it needs one %%d for the seed (and %%%% for a %%)", options[i], given[i]);
    return MESO_OK;
}

/* The name of one seed, of an option that is given; no input goes over it. */
static MesoStatus name_product(Job *job, const char **name, const char *pattern, const char *option, uint64_t seed)
{
    MesoTool *tool = job->tool;
    *name = NULL;
    if (!pattern)
        return MESO_OK;
    *name = meso_seed_path(pattern, seed, &tool->arena, &tool->error);
    return *name ? meso_tool_check_output(tool, option, *name) : MESO_ERR_MEMORY;
}

/* What its seed alone would give. */
static MesoStatus run_one_of_many(void *context, uint64_t seed)
{
    Job *job = context;
    MesoDecorArguments *a = job->arguments;
    MesoTool *tool = job->tool;
    const Names names = {tool->output, a->tree, a->lines};
    MesoStatus status = name_product(job, &tool->output, names.output, "-o", seed);
    if (!status)
        status = name_product(job, &a->tree, names.tree, "--tree", seed);
    if (!status)
        status = name_product(job, &a->lines, names.lines, "--lines", seed);
    const MesoOptionChange changes[] = {
        {"output", tool->output}, {a->tree ? "tree" : NULL, a->tree}, {a->lines ? "lines" : NULL, a->lines},
    };
    if (!status)
        status = meso_seed_provenance(tool, seed, changes, 3);
    if (!status)
        status = run_seed(job, seed);
    a->tree = names.tree;
    a->lines = names.lines;
    return status;
}

static MesoStatus run_all(Job *job)
{
    MesoTool *tool = job->tool;
    return job->arguments->seeds ? meso_seed_runs(tool, &job->seeds, run_one_of_many, job) : run_seed(job, tool->seed);
}

/* ---- what goes together ---- */

static MesoStatus read_seeds(Job *job)
{
    MesoTool *tool = job->tool;
    MesoSeedList *list = &job->seeds;
    if (!job->arguments->seeds)
        return MESO_OK;
    if (tool->seed)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--seed and --seeds are both given; one is needed");
    MesoStatus status = meso_seed_list_parse(list, &tool->arena, job->arguments->seeds, &tool->error);
    for (uint32_t r = 0; !status && r < list->range_count; r++)
        if (list->ranges[r].attempts > 0)
            status = meso_fail(&tool->error, MESO_ERR_USAGE, "--seeds: there are no attempts here: leave out 'x%u'",
                               list->ranges[r].attempts);
    return status ? status : check_names(job);
}

static MesoStatus check_lines(const Job *job)
{
    const char *lines = job->arguments->lines;
    if (!lines || ends_in(lines, ".svg") || ends_in(lines, ".obj"))
        return MESO_OK;
    return meso_fail(&job->tool->error, MESO_ERR_USAGE, "--lines '%s': end it in .svg or .obj", lines);
}

MesoStatus meso_decor_job_run(MesoDecorArguments *arguments)
{
    Job job = {.arguments = arguments, .tool = &arguments->tool};
    MesoStatus status = meso_tool_choose_scene_kind(job.tool, &arguments->output);
    if (!status)
        status = check_lines(&job);
    if (!status)
        status = read_seeds(&job);
    if (!status)
        status = read_inputs(&job);
    if (!status)
        status = run_all(&job);
    close_inputs(&job);
    return status;
}
