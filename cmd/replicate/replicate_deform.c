#include "cmd/replicate/replicate_deform.h"

#include <string.h>

#include "cmd/common/input_kind.h"
#include "cmd/replicate/replicate_clip.h"
#include "formats/clip/frame_list.h"
#include "formats/mesh/mesh_read.h"
#include "formats/model/scene_of_mesh.h"
#include "formats/replicate/deform_file.h"
#include "libcore/replicate/deform/deform.h"

static const float degree = 0.017453292519943295f;

typedef struct Job {
    MesoReplicateArguments *arguments;
    MesoTool *tool;
    MesoInput input;
    MesoPolygonMesh mesh;
    MesoDeformStep usual;       /* where a kind is named */
    MesoDeformFile steps;
    MesoVec3 *positions;
} Job;

/* ---- what is done ---- */

static bool find_kind(const char *name, MesoDeformKind *kind)
{
    for (*kind = 0; meso_deform_names[*kind]; ++*kind)
        if (strcmp(meso_deform_names[*kind], name) == 0)
            return true;
    return false;
}

static MesoStatus take_kind(Job *job, MesoDeformKind kind)
{
    const MesoReplicateArguments *a = job->arguments;
    bool angle = kind == MESO_DEFORM_TWIST || kind == MESO_DEFORM_BEND;
    job->usual = meso_deform_usual(kind, job->mesh.positions, job->mesh.vertex_count);
    if (a->given.amount)
        job->usual.amount = angle ? a->amount * degree : a->amount;
    job->steps = (MesoDeformFile){1, &job->usual};
    if ((kind == MESO_DEFORM_STRETCH || kind == MESO_DEFORM_SCALE) && !(job->usual.amount > 0))
        return meso_fail(&job->tool->error, MESO_ERR_USAGE, "--amount: a length cannot become %g times as long",
                         (double)job->usual.amount);
    return MESO_OK;
}

static MesoStatus take_file(Job *job)
{
    const MesoReplicateArguments *a = job->arguments;
    MesoTool *tool = job->tool;
    MesoInput input;
    const char *dot = strrchr(a->deform, '.');
    if (!dot || strcmp(dot, ".json") != 0)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--deform: '%s' is none of stretch, scale, twist, bend, "
                         "inflate, and no .json", a->deform);
    if (a->given.amount)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--amount is for a deformation that is named; '%s' says its own",
                         a->deform);
    MesoStatus status = meso_tool_open_input(tool, &input, a->deform, "deformation");
    if (status)
        return status;
    status = meso_deform_read(&job->steps, &tool->arena, &input, job->mesh.positions, job->mesh.vertex_count,
                              &tool->error);
    meso_input_close(&input);
    return status;
}

/* ---- frames ---- */

static MesoStatus write_frame(Job *job, uint32_t number, const char *pattern)
{
    MesoReplicateArguments *a = job->arguments;
    MesoTool *tool = job->tool;
    MesoScene scene;
    MesoPolygonMesh moved = job->mesh;
    double time = a->count > 1 ? (number - 1.0) / (a->count - 1.0) : 0;
    moved.positions = job->positions;
    tool->output = meso_frame_path(pattern, (int32_t)number, &tool->arena, &tool->error);
    MesoStatus status = tool->output ? meso_tool_check_output(tool, "-o", tool->output) : MESO_ERR_MEMORY;
    if (!status)
        status = meso_deform(job->positions, job->mesh.positions, job->mesh.vertex_count, job->steps.steps,
                             job->steps.step_count, time, tool->threads, &tool->error);
    if (status == MESO_ERR_INPUT)
        return meso_fail_prefix(&tool->error, a->deform);
    if (!status)
        status = meso_scene_of_mesh(&scene, &tool->arena, &moved, &tool->error);
    const char *frame = meso_arena_print(&tool->arena, &tool->error, "%u", number);
    const MesoOptionChange changes[] = {{"output", tool->output}, {"frames", frame}, {NULL, NULL}};
    if (!status && !frame)
        status = MESO_ERR_MEMORY;
    if (!status) {
        tool->provenance.command_line = meso_tool_command(tool, changes, &tool->arena, &tool->error);
        status = tool->provenance.command_line ? MESO_OK : MESO_ERR_MEMORY;
    }
    return status ? status : meso_tool_write_scene(tool, &a->output, &(MesoSceneProduct){.scene = &scene});
}

/* Those of --frames, or else all. */
static MesoStatus choose_frames(const Job *job, MesoFrameList *list)
{
    const MesoReplicateArguments *a = job->arguments;
    MesoTool *tool = job->tool;
    const char *text = a->frames ? a->frames : meso_arena_print(&tool->arena, &tool->error, "1-%u", a->count);
    MesoStatus status = text ? meso_frame_list_parse(list, &tool->arena, text, &tool->error) : MESO_ERR_MEMORY;
    for (uint32_t i = 0; !status && i < list->count; i++)
        if (list->frames[i] < 1 || (uint32_t)list->frames[i] > a->count)
            status = meso_fail(&tool->error, MESO_ERR_USAGE, "--frames: no frame %d; --count is %u", list->frames[i],
                               a->count);
    return status;
}

static MesoStatus write_frames(Job *job)
{
    MesoTool *tool = job->tool;
    const char *pattern = tool->output;
    MesoFrameList list;
    MesoStatus status = choose_frames(job, &list);
    for (uint32_t i = 0; !status && i < list.count; i++) {
        MesoArenaMark mark = meso_arena_mark(&tool->arena);
        status = write_frame(job, (uint32_t)list.frames[i], pattern);
        tool->output = pattern;
        meso_arena_rewind(&tool->arena, mark);
    }
    if (!status)
        json_object_set_new(tool->report, "frames", json_integer((json_int_t)list.count));
    return status;
}

static MesoStatus run(Job *job)
{
    MesoTool *tool = job->tool;
    MesoDeformKind kind;
    MesoStatus status = meso_polygon_mesh_read(&job->mesh, &tool->arena, &job->input, tool->threads, &tool->error);
    if (!status)
        status = meso_replicate_drop_normals(&job->mesh, tool);
    if (!status)
        status = find_kind(job->arguments->deform, &kind) ? take_kind(job, kind) : take_file(job);
    if (status)
        return status;
    job->positions = MESO_NEW(&tool->arena, MesoVec3, job->mesh.vertex_count, &tool->error);
    return job->positions ? write_frames(job) : MESO_ERR_MEMORY;
}

MesoStatus meso_replicate_deform(MesoReplicateArguments *a)
{
    MesoTool *tool = &a->tool;
    Job job = {.arguments = a, .tool = tool};
    if (!tool->output || !meso_frame_path_is_pattern(tool->output))
        return meso_fail(&tool->error, MESO_ERR_USAGE, "--deform makes frames: -o needs the place of their number, "
                         "as in body-%%04d.ply");
    MesoStatus status = meso_tool_choose_scene_kind(tool, &a->output);
    if (!status)
        status = meso_tool_open_place(tool, &job.input, tool->operands[0], &MESO_PLACE_SURFACE);
    if (status)
        return status;
    status = run(&job);
    meso_input_close(&job.input);
    return status;
}
