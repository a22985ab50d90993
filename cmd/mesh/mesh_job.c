#include "cmd/mesh/mesh_job.h"

#include <stdio.h>
#include <string.h>

#include "cmd/common/scene_output.h"
#include "cmd/mesh/mesh_steps.h"
#include "formats/mesh/mesh_read.h"
#include "formats/mesh/write/mesh_write.h"
#include "formats/model/scene_of_mesh.h"

typedef struct Job {
    MesoTool *tool;
    MesoMeshWork work;
    MesoMeshStep *steps;        /* [step_count] */
    uint32_t step_count;
    MesoMeshKind kind;          /* of the output; MESO_MESH_KINDS: as a scene, or none */
    const MesoSceneKind *scene_kind;    /* what only scenes are written as; NULL for others */
    json_t *report;             /* array of steps */
} Job;

/* ---- before the work ---- */

static bool is_stream(const char *path)
{
    return path && (*path == 0 || strcmp(path, "-") == 0);
}

static bool has_step(const Job *job, const char *word)
{
    for (uint32_t i = 0; i < job->step_count; i++)
        if (strcmp(job->steps[i].kind->word, word) == 0)
            return true;
    return false;
}

static MesoStatus parse_steps(Job *job)
{
    MesoTool *tool = job->tool;
    job->step_count = tool->operand_count - 1;
    job->steps = MESO_NEW(&tool->arena, MesoMeshStep, job->step_count, &tool->error);
    MesoStatus status = job->steps ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < job->step_count && !status; i++)
        status = meso_mesh_step_parse(&job->steps[i], tool->operands[i], &tool->error);
    return status;
}

/* By the extension; NULL for others. */
static const MesoSceneKind *scene_kind(const char *path)
{
    const char *dot = strrchr(path, '.');
    const MesoSceneKind *kind = dot ? meso_scene_kind_named(dot + 1) : NULL;
    return kind && kind->draco ? kind : NULL;
}

static MesoStatus check_output(Job *job)
{
    MesoTool *tool = job->tool;
    bool info = has_step(job, "info");
    if (!tool->output && !info)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "nothing would come of it: give -o FILE, or the step info");
    if (info && !tool->json && is_stream(tool->output))
        return meso_fail(&tool->error, MESO_ERR_USAGE,
                         "the product and what info says cannot both go to standard output; use "
                         "--json=FILE or -o FILE");
    job->kind = tool->output ? meso_mesh_kind_of(tool->output) : MESO_MESH_KINDS;
    if (tool->output && job->kind == MESO_MESH_KINDS)
        job->scene_kind = scene_kind(tool->output);
    if (tool->output && job->kind == MESO_MESH_KINDS && !job->scene_kind)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "-o: the extension of '%s' is not %s, glb or drc", tool->output,
                         meso_mesh_kind_names());
    return MESO_OK;
}

/* ---- reading ---- */

/* Faces that no other tool would take are read where clean is the first to change anything. */
static bool is_to_be_cleaned(const Job *job)
{
    uint32_t i = 0;
    while (i < job->step_count && strcmp(job->steps[i].kind->word, "info") == 0)
        i++;
    return i == job->step_count ? !job->tool->output : strcmp(job->steps[i].kind->word, "clean") == 0;
}

static MesoStatus read_mesh(Job *job)
{
    MesoInput input;
    MesoTool *tool = job->tool;
    MesoMeshWork *work = &job->work;
    MesoStatus status = meso_tool_open_input(tool, &input, tool->operands[tool->operand_count - 1], "surface");
    if (status)
        return status;
    if (is_to_be_cleaned(job))
        status = meso_polygon_mesh_read_loops(&work->mesh, &work->looped, &work->arena, &input, tool->threads,
                                              &tool->error);
    else
        status = meso_polygon_mesh_read(&work->mesh, &work->arena, &input, tool->threads, &tool->error);
    meso_input_close(&input);
    return status;
}

/* ---- steps ---- */

/* "weld=0.1: vertices gone 4, faces gone 0; 12 vertices, 5 faces" */
static void say_step(const Job *job, const MesoMeshStep *step)
{
    char line[400];
    int used = 0;
    const MesoMeshWork *work = &job->work;
    for (uint32_t i = 0; i < work->count_count; i++) {
        used += snprintf(line + used, sizeof line - (size_t)used, "%s%s %u", i ? ", " : "", work->counts[i].name,
                         work->counts[i].count);
    }
    for (char *c = line; c < line + used; c++)
        *c = *c == '_' ? ' ' : *c;
    if (strcmp(step->kind->word, "info") != 0 && strcmp(step->kind->word, "convert") != 0)
        meso_tool_say(job->tool, "%s: %.*s%s%u vertices, %u faces", step->text, used, line, used ? "; " : "",
                      work->mesh.vertex_count, work->mesh.face_count);
}

static MesoStatus report_step(const Job *job, const MesoMeshStep *step)
{
    const MesoMeshWork *work = &job->work;
    json_t *item = json_pack("{sssIsI}", "step", step->text, "vertices", (json_int_t)work->mesh.vertex_count, "faces",
                             (json_int_t)work->mesh.face_count);
    int failed = item == NULL;
    for (uint32_t i = 0; i < work->count_count && !failed; i++)
        failed |= json_object_set_new(item, work->counts[i].name, json_integer(work->counts[i].count));
    failed |= json_array_append_new(job->report, item);
    return failed ? meso_fail(&job->tool->error, MESO_ERR_MEMORY, "out of memory for the report") : MESO_OK;
}

static MesoStatus run_step(Job *job, const MesoMeshStep *step)
{
    MesoStatus status = meso_mesh_step_run(step, &job->work);
    if (status)
        return status;
    say_step(job, step);
    return report_step(job, step);
}

/* ---- writing ---- */

static void say_left_out(const Job *job)
{
    const MesoPolygonMesh *mesh = &job->work.mesh;
    for (uint32_t i = 0; i < mesh->attribute_count; i++)
        if (!meso_mesh_kind_holds(job->kind, mesh, &mesh->attributes[i]))
            meso_tool_say(job->tool, "left out the attribute '%s', which such a file does not hold",
                          mesh->attributes[i].name);
}

/* Triangles and quads; what files of scenes hold of the attributes. */
static MesoStatus write_as_scene(Job *job)
{
    MesoTool *tool = job->tool;
    MesoScene scene;
    MesoSceneOutput output = MESO_SCENE_OUTPUT_DEFAULTS;
    output.kind = job->scene_kind;
    MesoStatus status = meso_scene_of_mesh(&scene, &tool->arena, &job->work.mesh, &tool->error);
    return status ? status : meso_tool_write_scene(tool, &output, &(MesoSceneProduct){.scene = &scene});
}

static MesoStatus write_polygons(Job *job)
{
    MesoOutput *output;
    MesoTool *tool = job->tool;
    say_left_out(job);
    MesoStatus status = meso_output_open(&output, tool->output, &tool->error);
    if (!status)
        status = meso_polygon_mesh_write(&job->work.mesh, job->kind, &tool->provenance, output, &tool->error);
    return meso_output_finish(output, status, &tool->error);
}

static MesoStatus write_mesh(Job *job)
{
    MesoTool *tool = job->tool;
    MesoPolygonMesh *mesh = &job->work.mesh;
    if (mesh->face_count == 0)
        return meso_fail(&tool->error, MESO_ERR_INPUT, "no face is left; nothing was written");
    MesoStatus status = meso_polygon_mesh_check(mesh, tool->threads, NULL, &tool->error);
    if (status)
        return status;
    return job->scene_kind ? write_as_scene(job) : write_polygons(job);
}

/* ---- all together ---- */

static MesoStatus begin_report(Job *job)
{
    MesoTool *tool = job->tool;
    job->report = json_array();
    job->work.infos = json_array();
    int failed = json_object_set_new(tool->report, "steps", job->report);
    failed |= json_object_set_new(tool->report, "info", job->work.infos);
    return failed ? meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the report") : MESO_OK;
}

MesoStatus meso_mesh_job_run(MesoMeshArguments *arguments)
{
    Job job = {.tool = &arguments->tool, .work = {.tool = &arguments->tool, .crease = (double)arguments->crease}};
    MesoStatus status = parse_steps(&job);
    if (!status)
        status = check_output(&job);
    if (!status)
        status = begin_report(&job);
    if (!status)
        status = read_mesh(&job);
    for (uint32_t i = 0; i < job.step_count && !status; i++)
        status = run_step(&job, &job.steps[i]);
    if (!status && arguments->tool.output)
        status = write_mesh(&job);
    meso_mesh_work_release(&job.work);
    return status;
}
