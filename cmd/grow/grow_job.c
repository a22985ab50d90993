#include "cmd/grow/grow_job.h"

#include <string.h>
#include <strings.h>

#include "cmd/common/input_kind.h"
#include "cmd/common/seed_list.h"
#include "cmd/grow/grow_contexts.h"
#include "cmd/grow/grow_march.h"
#include "cmd/grow/grow_report.h"
#include "cmd/grow/grow_shapes.h"
#include "cmd/grow/grow_show_map.h"
#include "cmd/grow/grow_surface.h"
#include "formats/growth/grammar_file.h"
#include "formats/growth/growth_svg.h"
#include "formats/model/scene_backdrop.h"

/* Where the grammar has no limits: what no surface and no memory holds. */
static const uint32_t MOST_GENERATIONS = 1000000, MOST_ELEMENTS = 50000000;

static const MesoInputPlace PLACE_GRAMMAR = {"GRAMMAR", "a grammar (.grammar)", "grammar", MESO_FILE_GRAMMAR};

typedef struct Job {
    MesoGrowArguments *arguments;
    MesoTool *tool;
    MesoInput grammar_input, surface_input;
    const char *folder;         /* of the grammar */
    MesoSeedList seeds;
    MesoGrowSurface surface;
    MesoGrowMarch march;
    MesoGrammar grammar;
    MesoGrowthShapes shapes;
    MesoGrowthContexts contexts;
    MesoGrowthPlaces places;
    bool as_drawing;            /* the product is an SVG */
} Job;

/* ---- what goes together ---- */

static bool ends_in(const char *path, const char *extension)
{
    const char *dot = path ? strrchr(path, '.') : NULL;
    return dot && strcasecmp(dot, extension) == 0;
}

/* Those of scenes, and .svg. */
static MesoStatus choose_kind(Job *job)
{
    MesoGrowArguments *a = job->arguments;
    const char *path = job->tool->output ? job->tool->output : "-", *dot = strrchr(path, '.');
    job->as_drawing = a->output.to ? strcmp(a->output.to, "svg") == 0 : ends_in(path, ".svg");
    if (!job->as_drawing && !a->output.to && !(dot && meso_scene_kind_named(dot + 1)))
        return meso_fail(&job->tool->error, MESO_ERR_USAGE, "no kind of file is known by the name '%s': end it in "
                         ".meso, .ply, .obj, .glb, .drc, .stl, .usda or .svg, or give --to", path);
    if (!job->as_drawing)
        return meso_tool_choose_scene_kind(job->tool, &a->output);
    if (!job->tool->output)
        job->tool->output = "-";
    return MESO_OK;
}

static MesoStatus read_seeds(Job *job)
{
    const MesoGrowArguments *a = job->arguments;
    MesoTool *tool = job->tool;
    if (!a->seeds)
        return MESO_OK;
    if (tool->seed)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--seed and --seeds are both given; one is needed");
    MesoStatus status = meso_seed_list_parse(&job->seeds, &tool->arena, a->seeds, &tool->error);
    const char *const given[] = {tool->output, a->trace}, *const options[] = {"-o", "--trace"};
    for (int i = 0; i < 2 && !status; i++)
        if (given[i] && !meso_seed_path_is_pattern(given[i]))
            status = meso_fail(&tool->error, MESO_ERR_USAGE,
                               "%s '%s': with --seeds it needs one %%d for the seed (and %%%% for a %%)", options[i],
                               given[i]);
    return status;
}

/* ---- inputs ---- */

/* All of --set, one name each. */
static MesoStatus read_settings(Job *job, MesoGrammarSetting **settings, uint32_t *count)
{
    const MesoTextList *list = &job->arguments->set;
    MesoTool *tool = job->tool;
    size_t most = 0;
    for (uint32_t i = 0; i < list->count; i++)
        most += strlen(list->items[i]) + 1;
    *count = 0;
    *settings = MESO_NEW(&tool->arena, MesoGrammarSetting, most + 1, &tool->error);
    if (!*settings)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < list->count; i++) {
        char *text = meso_arena_copy_text(&tool->arena, list->items[i], &tool->error);
        for (char *next; text; text = next) {
            next = strchr(text, ',');
            if (next)
                *next++ = 0;
            (*settings)[(*count)++].text = text;
        }
    }
    return MESO_OK;
}

static MesoStatus read_grammar(Job *job)
{
    MesoTool *tool = job->tool;
    MesoGrammarSetting *settings;
    MesoGrammarOptions options = {.extent = job->surface.ground.extent};
    const char *path = tool->operands[0], *slash = strrchr(path, '/');
    MesoStatus status = read_settings(job, &settings, &options.setting_count);
    options.settings = settings;
    if (!status)
        status = meso_tool_open_place(tool, &job->grammar_input, path, &PLACE_GRAMMAR);
    if (!status)
        status = meso_grammar_file_read(&job->grammar, &tool->arena, &job->grammar_input, &options, &tool->error);
    int length = slash == path ? 1 : (int)(slash - path);
    job->folder = slash ? meso_arena_print(&tool->arena, &tool->error, "%.*s", length, path) : "";
    return status ? status : job->folder ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus read_inputs(Job *job)
{
    MesoTool *tool = job->tool;
    MesoStatus status = meso_grow_surface_read(&job->surface, job->arguments, &job->surface_input, tool->operands[1]);
    if (!status)
        status = read_grammar(job);
    if (!status)
        status = meso_grow_march_init(&job->march, job->arguments, &job->surface);
    if (!status)
        status = meso_grow_shapes(&job->shapes, tool, &job->grammar, job->folder, job->arguments->detail);
    if (!status)
        status = meso_grow_contexts(&job->contexts, &job->places, tool, &job->grammar, &job->surface.polygons,
                                    &job->surface.ground, job->folder);
    if (!status && job->arguments->show_map)
        status = meso_grow_show_map(tool, job->arguments->show_map, &job->grammar, &job->contexts,
                                    &job->surface.polygons);
    return status;
}

static void close_inputs(Job *job)
{
    if (job->grammar_input.data)
        meso_input_close(&job->grammar_input);
    if (job->surface_input.data)
        meso_input_close(&job->surface_input);
    meso_grow_surface_release(&job->surface);
}

/* ---- products ---- */

static MesoStatus write_drawing(const Job *job, const MesoGrown *grown, MesoOutput *trace)
{
    MesoTool *tool = job->tool;
    MesoOutput *outputs[] = {NULL, trace};
    MesoStatus status = meso_output_open(&outputs[0], tool->output, &tool->error);
    if (!status)
        status = meso_growth_svg_write(grown, &job->grammar, &tool->provenance, outputs[0], &tool->error);
    json_object_set_new(tool->report, "kind", json_string("svg"));
    return meso_output_finish_all(outputs, 2, status, &tool->error);
}

/* The trace appears with the product, or not at all. */
static MesoStatus write_product(const Job *job, const MesoGrown *grown, MesoOutput *trace)
{
    MesoTool *tool = job->tool;
    MesoScene scene;
    uint32_t folds = 0;
    if (job->as_drawing)
        return write_drawing(job, grown, trace);
    MesoStatus status = meso_growth_show(&scene, &tool->arena, grown, &job->grammar, &job->shapes, tool->threads,
                                         &folds, &tool->error);
    if (!status && job->arguments->surface)
        status = meso_scene_add_backdrop(&scene, &tool->arena, &job->surface.polygons, job->arguments->surface,
                                         &tool->error);
    if (status) {
        meso_output_discard(trace);
        return status;
    }
    json_object_set_new(json_object_get(tool->report, "growth"), "folded_elements", json_integer(folds));
    if (folds)
        meso_tool_say(tool, "warning: %u elements are too wide for their curves, and fold", folds);
    return meso_tool_write_scene(tool, &job->arguments->output, &(MesoSceneProduct){
        .scene = &scene, .beside = {trace}, .smaller = "limit elements in the grammar, or give --until"});
}

/* ---- a run ---- */

static void trace_event(void *context, const MesoGrowthEvent *event)
{
    meso_grow_trace(context, event);
}

static double least_of(double a, double b)
{
    return a > 0 && (!(b > 0) || a < b) ? a : b;
}

static MesoStatus grow(Job *job, MesoGrown *grown, MesoGrowthStarts *starts, uint64_t seed, MesoGrowTrace *trace)
{
    const MesoGrowArguments *a = job->arguments;
    MesoTool *tool = job->tool;
    MesoStatus status = meso_growth_seeds(starts, &tool->arena, &job->grammar, &job->contexts, &job->places, seed,
                                          tool->threads, &tool->error);
    const MesoGrowthOptions options = {
        .grammar = &job->grammar, .contexts = &job->contexts, .starts = starts, .thread_count = tool->threads,
        .march = job->march.march.walk ? &job->march.march : NULL,
        .generations = least_of(a->until, a->most_generations ? a->most_generations : MOST_GENERATIONS),
        .elements = a->most_elements ? a->most_elements : MOST_ELEMENTS,
        .event = trace->output ? trace_event : NULL, .context = trace};
    if (!status)
        status = meso_grow(grown, &tool->arena, &options, &tool->error);
    if (!status)
        status = meso_growth_lift(grown, &tool->arena, &job->surface.ground, tool->threads, &tool->error);
    if (status == MESO_ERR_INPUT)
        meso_fail_prefix(&tool->error, job->grammar_input.path);
    return status;
}

/* Whether growth that was stopped is what was asked for. */
static bool is_wanted(const Job *job, const MesoGrown *grown)
{
    uint32_t until = job->arguments->until;
    return grown->end == MESO_GROWTH_ALL_DONE || (grown->end == MESO_GROWTH_GENERATIONS && until &&
                                                  grown->generation_count >= until);
}

static MesoStatus stopped(const Job *job, const MesoGrown *grown)
{
    return meso_fail(&job->tool->error, MESO_ERR_LIMIT, "growth was stopped by %s, with %u elements after %u "
                     "generations%s", meso_grow_end_phrase(grown->end), grown->element_count, grown->generation_count,
                     job->arguments->partial ? "" : "; --partial writes what has grown");
}

static MesoStatus run_seed(Job *job, uint64_t seed)
{
    MesoTool *tool = job->tool;
    MesoGrown grown;
    MesoGrowthStarts starts;
    MesoGrowTrace trace = {.grammar = &job->grammar, .mesh = &job->surface.mesh, .error = &tool->error};
    MesoStatus status = job->arguments->trace ? meso_output_open(&trace.output, job->arguments->trace, &tool->error)
                                              : MESO_OK;
    job->contexts.noise = seed;
    if (!status)
        status = grow(job, &grown, &starts, seed, &trace);
    if (!status)
        status = trace.status;
    if (!status && starts.count == 0)
        status = meso_fail(&tool->error, MESO_ERR_INPUT, "%s: no seed has a place on the surface",
                           job->grammar_input.path);
    if (status) {
        meso_output_discard(trace.output);
        return status;
    }
    meso_grow_report(tool, &grown, &job->grammar, starts.count);
    bool wanted = is_wanted(job, &grown);
    if (!wanted && !job->arguments->partial) {
        meso_output_discard(trace.output);
        return stopped(job, &grown);
    }
    status = write_product(job, &grown, trace.output);
    return status || wanted ? status : stopped(job, &grown);
}

/* ---- many seeds ---- */

/* What its seed alone would give. */
static MesoStatus run_one_of_many(void *context, uint64_t seed)
{
    Job *job = context;
    MesoGrowArguments *a = job->arguments;
    MesoTool *tool = job->tool;
    const char *trace = a->trace;
    tool->output = meso_seed_path(tool->output, seed, &tool->arena, &tool->error);
    a->trace = trace ? meso_seed_path(trace, seed, &tool->arena, &tool->error) : NULL;
    MesoStatus status = tool->output && (a->trace || !trace) ? meso_tool_check_output(tool, "-o", tool->output)
                                                             : MESO_ERR_MEMORY;
    if (!status && trace)
        status = meso_tool_check_output(tool, "--trace", a->trace);
    const MesoOptionChange changes[] = {{"output", tool->output}, {trace ? "trace" : NULL, a->trace}};
    if (!status)
        status = meso_seed_provenance(tool, seed, changes, 2);
    if (!status)
        status = run_seed(job, seed);
    a->trace = trace;
    return status;
}

/* ---- the whole ---- */

MesoStatus meso_grow_job_run(MesoGrowArguments *a)
{
    Job job = {.arguments = a, .tool = &a->tool};
    MesoVec3 up = a->up;
    if (!(up.x != 0 || up.y != 0 || up.z != 0))
        return meso_fail(&a->tool.error, MESO_ERR_USAGE, "option '--up' needs a direction, not 0,0,0");
    MesoStatus status = choose_kind(&job);
    if (!status)
        status = meso_scene_check_backdrop(a->surface, &a->tool.error);
    if (!status)
        status = read_seeds(&job);
    if (!status)
        status = read_inputs(&job);
    if (!status)
        status = a->seeds ? meso_seed_runs(job.tool, &job.seeds, run_one_of_many, &job) : run_seed(&job, a->tool.seed);
    close_inputs(&job);
    return status;
}
