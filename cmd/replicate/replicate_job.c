#include "cmd/replicate/replicate_job.h"

#include <string.h>

#include "cmd/common/input_kind.h"
#include "cmd/replicate/replicate_deform.h"
#include "cmd/replicate/replicate_output.h"
#include "cmd/replicate/replicate_table.h"
#include "formats/model/scene_backdrop.h"
#include "formats/replicate/details_file.h"

static const MesoInputPlace PLACE_DETAILS = {"DETAILS", "details (.details.json)", "details",
                                             MESO_FILE_DETAILS | MESO_FILE_JSON};

typedef struct Job {
    MesoReplicateArguments *arguments;
    MesoTool *tool;
    MesoInput details_input;
    MesoReplicateFiles files;
    MesoDetailsFile details;
    MesoReplicateKinds kinds;
    MesoReplicateCarve carve;
    MesoReplicateClip clip;
    MesoOriginals originals;
    MesoReplicateRun run;
    MesoReplicateOutput output;
    MesoReplicateTable table;
    MesoFrameList frames;       /* by number, those that are wanted */
} Job;

/* ---- what goes together ---- */

static MesoStatus check_operands(MesoReplicateArguments *a)
{
    uint32_t wanted = a->deform ? 1 : 2;
    if (a->tool.operand_count == wanted)
        return MESO_OK;
    return meso_fail(&a->tool.error, MESO_ERR_USAGE, "%u operand%s: give %s", a->tool.operand_count,
                     a->tool.operand_count == 1 ? "" : "s",
                     a->deform ? "SURFACE beside --deform" : "DETAILS and FRAMES");
}

static MesoStatus check_options(MesoReplicateArguments *a)
{
    MesoError *error = &a->tool.error;
    bool play = strcmp(a->mode, "play") == 0;
    if (a->state && play)
        return meso_fail(error, MESO_ERR_USAGE, "--state: what is played needs none; --plan keeps what it needs");
    if (a->plan && !play)
        return meso_fail(error, MESO_ERR_USAGE, "--plan is for --mode play; --state keeps what other modes need");
    const char *given = a->given.alpha ? "alpha" : a->given.beta ? "beta" : a->given.gamma ? "gamma" : NULL;
    if (given && strcmp(a->mode, "paper") != 0)
        return meso_fail(error, MESO_ERR_USAGE, "--%s is for --mode paper", given);
    if (a->given.mu && play)
        return meso_fail(error, MESO_ERR_USAGE, "--mu: what is played has the sizes that the shape asks for at once");
    return meso_scene_check_backdrop(a->surface, error);
}

/* ---- inputs ---- */

static MesoStatus read_details(Job *job)
{
    MesoTool *tool = job->tool;
    job->files = (MesoReplicateFiles){.tool = tool, .details = tool->operands[0]};
    MesoJsonFiles files = meso_replicate_json_files(&job->files);
    MesoStatus status = meso_tool_open_place(tool, &job->details_input, tool->operands[0], &PLACE_DETAILS);
    if (!status)
        status = meso_details_read(&job->details, &tool->arena, &job->details_input, &files, &tool->error);
    return status ? status : meso_replicate_kinds(&job->kinds, &job->files, &job->details);
}

static MesoStatus strew_details(Job *job)
{
    MesoTool *tool = job->tool;
    MesoReplicateGround ground = {.triangles = &job->clip.triangles, .files = &job->files, .tool = tool};
    MesoStatus status = meso_growth_ground_build(&ground.ground, &tool->arena, &job->clip.rest,
                                                 meso_replicate_up(job->arguments), tool->threads, &tool->error);
    if (!status)
        status = meso_replicate_originals(&job->originals, &ground, &job->details);
    json_object_set_new(tool->report, "originals", json_integer((json_int_t)job->originals.count));
    return status;
}

/* No product may go over a frame that is still to be read. */
static MesoStatus check_over(const Job *job, int32_t number)
{
    MesoTool *tool = job->tool;
    MesoFileKey in, out;
    const char *frames = tool->operands[1];
    if (!job->output.numbered || !meso_frame_path_is_pattern(frames))
        return MESO_OK;
    const char *from = meso_frame_path(frames, number, &tool->arena, &tool->error);
    const char *to = meso_frame_path(job->output.path, number, &tool->arena, &tool->error);
    if (!from || !to)
        return MESO_ERR_MEMORY;
    if (!meso_path_key(&in, from, false) || !meso_path_key(&out, to, true) || memcmp(&in, &out, sizeof in) != 0)
        return MESO_OK;
    return meso_fail(&tool->error, MESO_ERR_USAGE, "-o '%s' would write over the frames: name other files",
                     job->output.path);
}

static MesoStatus choose_frames(Job *job)
{
    MesoTool *tool = job->tool;
    uint32_t frame;
    MesoStatus status = MESO_OK;
    if (job->arguments->frames) {
        status = meso_frame_list_parse(&job->frames, &tool->arena, job->arguments->frames, &tool->error);
    } else {
        job->frames.count = job->clip.frame_count;
        job->frames.frames = MESO_NEW(&tool->arena, int32_t, job->frames.count, &tool->error);
        status = job->frames.frames ? MESO_OK : MESO_ERR_MEMORY;
        for (uint32_t f = 0; f < job->frames.count && !status; f++)
            job->frames.frames[f] = meso_replicate_clip_number(&job->clip, f);
    }
    for (uint32_t i = 0; i < job->frames.count && !status; i++)
        status = meso_replicate_clip_find(&job->clip, job->frames.frames[i], &frame);
    bool one = meso_replicate_output_is_one(&job->output);
    for (uint32_t i = 1; i < job->frames.count && !status && one; i++)
        if (job->frames.frames[i] <= job->frames.frames[i - 1])
            status = meso_fail(&tool->error, MESO_ERR_USAGE, "--frames: those of one file go forwards");
    if (!status && !one && !job->output.numbered && job->frames.count > 1)
        status = meso_fail(&tool->error, MESO_ERR_USAGE, "-o '%s': for %u frames it needs the place of their number, "
                           "as in out-%%04d.meso", job->output.path, job->frames.count);
    return status ? status : check_over(job, job->frames.frames[0]);
}

static MesoStatus read_inputs(Job *job)
{
    MesoStatus status = read_details(job);
    if (!status)
        status = meso_replicate_clip_open(&job->clip, job->arguments, job->tool->operands[1]);
    if (!status)
        status = choose_frames(job);
    return status ? status : strew_details(job);
}

static void close_inputs(Job *job)
{
    if (job->details_input.data)
        meso_input_close(&job->details_input);
    meso_replicate_files_close(&job->files);
    meso_replicate_clip_close(&job->clip);
}

/* ---- frames ---- */

/* How many of the list were the last ones that have been gone through: it may come by a frame more than once. */
static uint32_t frames_done(const Job *job)
{
    const MesoReplicateRun *r = &job->run;
    uint32_t most = r->history_count < job->frames.count ? r->history_count : job->frames.count;
    while (most > 0 && memcmp(r->history + r->history_count - most, job->frames.frames,
                              most * sizeof *job->frames.frames) != 0)
        most--;
    return most;
}

/*
 * With a state, what comes behind the frames that it has gone through, or at least behind its last one; all where that
 * is none of the list.
 */
static uint32_t first_frame(const Job *job)
{
    if (!job->arguments->state || job->run.history_count == 0)
        return 0;
    uint32_t done = frames_done(job);
    int32_t last = job->run.history[job->run.history_count - 1];
    for (uint32_t i = job->frames.count; i > 0 && done == 0; i--)
        if (job->frames.frames[i - 1] == last)
            done = i;
    return done;
}

static MesoStatus run_frame(Job *job, int32_t number, json_t *reports)
{
    MesoTool *tool = job->tool;
    uint32_t frame;
    json_t *whole = tool->report;
    MesoStatus status = meso_replicate_clip_find(&job->clip, number, &frame);
    if (!status)
        status = meso_replicate_run_frame(&job->run, frame);
    if (!status)
        status = meso_replicate_table_frame(&job->table, &job->run);
    if (status)
        return status;
    tool->report = json_pack("{s:i}", "frame", number);
    status = meso_replicate_output_frame(&job->output, &job->run);
    json_array_append_new(reports, tool->report);
    tool->report = whole;
    return status;
}

static MesoStatus run_frames(Job *job)
{
    MesoTool *tool = job->tool;
    json_t *reports = json_array();
    MesoStatus status = MESO_OK;
    uint32_t begin = first_frame(job);
    if (begin == job->frames.count)
        meso_tool_say(tool, "all frames are done, as '%s' says", job->arguments->state);
    meso_tool_progress_begin(tool, "replicating", "frames");
    for (uint32_t i = begin; i < job->frames.count && !status; i++) {
        status = run_frame(job, job->frames.frames[i], reports);
        meso_tool_progress(tool, i + 1 - begin, job->frames.count - begin);
    }
    json_object_set_new(tool->report, "details", json_integer((json_int_t)job->run.count));
    json_object_set_new(tool->report, "frames", reports);
    return status;
}

static void report_holes(const Job *job)
{
    uint32_t count = job->carve.mesh.uncut_count;
    if (!job->carve.kinds)
        return;
    json_object_set_new(job->tool->report, "holes_left_out", json_integer((json_int_t)count));
    if (count > 0)
        meso_tool_say(job->tool, "%u hole%s left out, which would meet a border or another hole", count,
                      count == 1 ? " is" : "s are");
}

static MesoStatus run(Job *job)
{
    MesoReplicateArguments *a = job->arguments;
    MesoStatus status = meso_replicate_run_begin(&job->run, a, &job->clip, &job->originals);
    if (!status)
        status = meso_replicate_carve_begin(&job->carve, &job->kinds, &job->files, &job->details, &job->clip.rest,
                                            a->fineness);
    if (!status && job->carve.kinds && meso_replicate_output_is_one(&job->output))
        status = meso_replicate_run_look_ahead(&job->run, &job->originals, &job->frames);
    if (!status)
        status = meso_replicate_output_begin(&job->output, &job->run, &job->kinds, &job->carve);
    if (!status && a->report)
        job->table.frames = json_array();
    if (!status)
        status = run_frames(job);
    if (!status)
        report_holes(job);
    status = meso_replicate_output_end(&job->output, status);
    status = meso_replicate_table_end(&job->table, &job->run, job->kinds.names, status);
    meso_replicate_carve_end(&job->carve);
    meso_replicate_run_end(&job->run);
    return status;
}

MesoStatus meso_replicate_job_run(MesoReplicateArguments *a)
{
    Job job = {.arguments = a, .tool = &a->tool};
    MesoStatus status = check_operands(a);
    if (!status && a->deform)
        return meso_replicate_deform(a);
    if (!status)
        status = check_options(a);
    if (!status)
        status = meso_replicate_output_choose(&job.output, a);
    if (!status)
        status = read_inputs(&job);
    if (!status)
        status = run(&job);
    close_inputs(&job);
    return status;
}
