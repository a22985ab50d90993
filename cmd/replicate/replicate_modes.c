#include "cmd/replicate/replicate_modes.h"

#include <string.h>
#include <unistd.h>

#include "cmd/common/input_kind.h"
#include "libcore/base/grow.h"

/* ---- what there is ---- */

/* Room for what is known of each detail; the new ones have not been there. */
static MesoStatus follow(MesoReplicateRun *r, const MesoDetail *details, uint32_t count)
{
    MesoTool *tool = r->tool;
    if (r->ahead)       /* all of them are known */
        return MESO_OK;
    r->details = details;
    if (count > r->room) {
        uint32_t room = count + count / 2;
        r->grown = meso_arena_enlarge(&tool->arena, r->grown, r->count, room, sizeof *r->grown, &tool->error);
        r->lives = meso_arena_enlarge(&tool->arena, r->lives, r->count, room, sizeof *r->lives, &tool->error);
        if (!r->grown || !r->lives)
            return MESO_ERR_MEMORY;
        r->room = room;
    }
    for (; r->count < count; r->count++) {
        r->grown[r->count] = 0;
        r->lives[r->count] = (MesoReplicaLife){MESO_NEVER, MESO_NEVER, MESO_NO_INDEX};
    }
    return MESO_OK;
}

static MesoStatus note_frame(MesoReplicateRun *r, int32_t number)
{
    r->history = MESO_GROW(&r->tool->arena, r->history, r->history_count, r->history_room, 64, &r->tool->error);
    if (!r->history)
        return MESO_ERR_MEMORY;
    r->history[r->history_count++] = number;
    return MESO_OK;
}

const char *meso_replicate_run_history(const MesoReplicateRun *r)
{
    MesoTool *tool = r->tool;
    const char *text = "";
    for (uint32_t i = 0; i < r->history_count && text;) {
        uint32_t end = i + 1;
        int32_t first = r->history[i], step = end < r->history_count ? r->history[end] - first : 0;
        while (end < r->history_count && step != 0 && r->history[end] - r->history[end - 1] == step)
            end++;
        int32_t last = r->history[end - 1];
        const char *comma = *text ? "," : "";
        text = end == i + 1 ? meso_arena_print(&tool->arena, &tool->error, "%s%s%d", text, comma, first)
             : step == 1 || step == -1
                 ? meso_arena_print(&tool->arena, &tool->error, "%s%s%d-%d", text, comma, first, last)
                 : meso_arena_print(&tool->arena, &tool->error, "%s%s%d-%dx%d", text, comma, first, last,
                                    step < 0 ? -step : step);
        i = end;
    }
    return text;
}

/* ---- steps ---- */

static MesoStatus step(MesoReplicateRun *r)
{
    uint32_t count;
    MesoStatus status = meso_replicate_step(r->replication, (uint32_t)r->clip->number, &r->tool->error);
    const MesoDetail *details = meso_replicate_details(r->replication, &count);
    return status ? status : follow(r, details, count);
}

/* Of those that a detail gives way to, the nearest that is there. */
static uint32_t taken_by(const MesoReplicateRun *r, uint32_t detail)
{
    uint32_t best = MESO_NO_INDEX;
    float least = INFINITY;
    MesoVec3 at = meso_detail_position(&r->clip->rest, r->clip->positions, &r->details[detail].point);
    for (uint32_t i = r->plan.pair_begin[detail]; i < r->plan.pair_begin[detail + 1]; i++) {
        uint32_t other = r->plan.pairs[i].other;
        MesoVec3 apart = meso_vec3_sub(at, meso_detail_position(&r->clip->rest, r->clip->positions,
                                                                &r->details[other].point));
        float d = meso_vec3_dot(apart, apart);
        if (r->grown[other] > 0 && d < least) {
            least = d;
            best = other;
        }
    }
    return best;
}

static void note_lives(MesoReplicateRun *r)
{
    const MesoDetailFate *fates = r->way == MESO_WAY_PLAY ? NULL : meso_replicate_fates(r->replication);
    for (uint32_t i = 0; i < r->count; i++) {
        MesoReplicaLife *life = &r->lives[i];
        if (r->grown[i] > 0) {
            life->first = life->first == MESO_NEVER ? r->clip->number : life->first;
            life->died = MESO_NEVER;
            life->merged = MESO_NO_INDEX;
        } else if (life->first != MESO_NEVER && life->died == MESO_NEVER) {
            life->died = r->clip->number;
            life->merged = fates ? fates[i].into : taken_by(r, i);
        }
    }
}

static void take_grown(MesoReplicateRun *r)
{
    uint32_t count;
    meso_replicate_details(r->replication, &count);
    memcpy(r->grown, meso_replicate_grown(r->replication), count * sizeof *r->grown);
    memset(r->grown + count, 0, (r->count - count) * sizeof *r->grown);
}

MesoStatus meso_replicate_run_frame(MesoReplicateRun *r, uint32_t frame)
{
    MesoStatus status = meso_replicate_clip_load(r->clip, frame);
    if (!status && r->way != MESO_WAY_PLAY)
        status = step(r);
    if (!status)
        status = note_frame(r, r->clip->number);
    if (status)
        return status;
    if (r->way == MESO_WAY_PLAY)
        meso_player_play(r->player, r->grown, r->clip->positions, r->tool->threads);
    else
        take_grown(r);
    note_lives(r);
    return MESO_OK;
}

/* ---- states ---- */

/* Whether there is such a file; where it cannot be seen its reader says why. */
static bool is_there(const char *path)
{
    return path && access(path, F_OK) == 0;
}

static MesoStatus check_kinds(const MesoReplicateRun *r, const char *path, const MesoDetail *details, uint32_t count,
                              uint32_t original_count)
{
    for (uint32_t i = 0; i < count; i++)
        if (details[i].copied >= original_count || details[i].kind != details[details[i].copied].kind)
            return meso_fail(&r->tool->error, MESO_ERR_INPUT, "%s: detail %u is a copy of none of its kind", path, i);
    return MESO_OK;
}

static MesoStatus take_state(MesoReplicateRun *r, const MesoReplicaStateFile *f, const char *path)
{
    uint32_t count, originals = r->count;
    MesoStatus status = meso_replica_compare(path, &f->mark, &f->settings, &r->mark, &r->settings, &r->tool->error);
    if (!status && f->vertex_count != r->clip->rest.vertex_count)
        status = meso_fail(&r->tool->error, MESO_ERR_INPUT, "%s: chunk 'places' is broken", path);
    if (status)
        return status;
    status = meso_replicate_resume(r->replication, &f->state, &r->tool->error);
    if (status == MESO_ERR_INPUT)
        return meso_fail_prefix(&r->tool->error, path);
    if (!status)
        status = check_kinds(r, path, f->state.details, f->state.detail_count, originals);
    for (uint32_t i = 0; i < f->history_count && !status; i++)
        status = note_frame(r, f->history[i]);
    if (status)
        return status;
    const MesoDetail *details = meso_replicate_details(r->replication, &count);
    status = follow(r, details, count);
    if (status)
        return status;
    memcpy(r->lives, f->lives, count * sizeof *r->lives);
    meso_replicate_clip_resume(r->clip, f->positions, r->history[r->history_count - 1]);
    return MESO_OK;
}

static MesoStatus read_state(MesoReplicateRun *r)
{
    const char *path = r->arguments->state;
    MesoInput input;
    MesoArena arena;
    MesoReplicaStateFile file;
    if (!is_there(path))
        return MESO_OK;
    MesoStatus status = meso_input_open(&input, path, &r->tool->error);
    if (status)
        return status;
    meso_arena_init(&arena);
    status = meso_replica_state_read(&file, &arena, &input, &r->tool->error);
    if (!status)
        status = take_state(r, &file, path);
    meso_arena_release(&arena);
    meso_input_close(&input);
    return status;
}

MesoStatus meso_replicate_run_store(const MesoReplicateRun *r, MesoOutput *output)
{
    const MesoReplicaStateFile file = {
        .mark = r->mark, .settings = r->settings, .state = meso_replicate_state(r->replication),
        .lives = r->lives, .history_count = r->history_count, .history = r->history,
        .vertex_count = r->clip->rest.vertex_count, .positions = r->clip->positions};
    return meso_replica_state_write(&file, &r->tool->provenance, output, &r->tool->error);
}

/* ---- plans ---- */

static MesoStatus read_plan(MesoReplicateRun *r)
{
    const char *path = r->arguments->plan;
    MesoInput input;
    MesoReplicaPlanFile file;
    MesoStatus status = meso_input_open(&input, path, &r->tool->error);
    if (status)
        return status;
    status = meso_replica_plan_read(&file, &r->playing, &input, &r->tool->error);
    meso_input_close(&input);
    if (!status)
        status = meso_replica_compare(path, &file.mark, &file.settings, &r->mark, &r->settings, &r->tool->error);
    if (!status && file.plan.detail_count < r->count)
        status = meso_fail(&r->tool->error, MESO_ERR_INPUT, "%s: it has fewer details than there were", path);
    if (!status)
        status = check_kinds(r, path, file.plan.details, file.plan.detail_count, r->count);
    if (status)
        return status;
    r->plan = file.plan;
    status = meso_player_build(&r->player, &r->playing, &r->clip->rest, &r->plan, &r->tool->error);
    return status == MESO_ERR_INPUT ? meso_fail_prefix(&r->tool->error, path) : status;
}

static MesoStatus write_plan(MesoReplicateRun *r)
{
    MesoTool *tool = r->tool;
    MesoOutput *output = NULL;
    const MesoReplicaPlanFile file = {r->mark, r->settings, r->plan};
    const char *typed = tool->provenance.command_line;
    const MesoOptionChange changes[] = {{"frames", NULL}, {"output", NULL}, {NULL, NULL}};
    tool->provenance.command_line = meso_tool_command(tool, changes, &tool->arena, &tool->error);
    MesoStatus status = tool->provenance.command_line ? meso_output_open(&output, r->arguments->plan, &tool->error)
                                                      : MESO_ERR_MEMORY;
    if (!status)
        status = meso_replica_plan_write(&file, &tool->provenance, output, &tool->error);
    status = meso_output_finish(output, status, &tool->error);
    tool->provenance.command_line = typed;
    return status;
}

static MesoStatus make_plan(MesoReplicateRun *r)
{
    MesoStatus status = MESO_OK;
    meso_tool_progress_begin(r->tool, "planning", "frames");
    for (uint32_t f = 0; f < r->clip->frame_count && !status; f++) {
        status = meso_replicate_clip_load(r->clip, f);
        if (!status)
            status = step(r);
        meso_tool_progress(r->tool, f + 1, r->clip->frame_count);
    }
    if (!status)
        status = meso_replicate_plan(&r->plan, &r->playing, r->replication, &r->tool->error);
    if (!status)
        status = meso_player_build(&r->player, &r->playing, &r->clip->rest, &r->plan, &r->tool->error);
    return status || !r->arguments->plan ? status : write_plan(r);
}

static MesoStatus prepare_play(MesoReplicateRun *r)
{
    MesoStatus status = is_there(r->arguments->plan) ? read_plan(r) : make_plan(r);
    return status ? status : follow(r, r->plan.details, r->plan.detail_count);
}

/* ---- the whole ---- */

static MesoStatus begin_replication(MesoReplicateRun *r, const MesoOriginals *originals)
{
    static const MesoReplicateMode modes[] = {MESO_REPLICATE_LIVE, MESO_REPLICATE_PLAN, MESO_REPLICATE_PAPER};
    const MesoReplicaSettings *said = &r->settings;
    const MesoReplicateOptions options = {
        .clip = &r->clip->clip, .originals = originals->details, .original_count = originals->count,
        .mode = modes[r->way], .births = (MesoReplicateBirths)said->births, .alpha = said->alpha, .beta = said->beta,
        .gamma = said->gamma, .mu = said->mu, .substeps = said->substeps, .ramp = said->ramp, .seed = said->seed,
        .thread_count = r->tool->threads};
    uint32_t count;
    MesoStatus status = meso_replicate_begin(&r->replication, &options, &r->tool->error);
    if (status)
        return status;
    const MesoDetail *details = meso_replicate_details(r->replication, &count);
    return follow(r, details, count);
}

MesoStatus meso_replicate_run_begin(MesoReplicateRun *r, MesoReplicateArguments *a, MesoReplicateClip *clip,
                                    const MesoOriginals *originals)
{
    static const char *const ways[] = {"plan", "play", "paper"};
    static const char *const births[] = {"usual", "exemplars", "statistics"};
    *r = (MesoReplicateRun){.arguments = a, .tool = &a->tool, .clip = clip};
    meso_arena_init(&r->playing);
    while (strcmp(ways[r->way], a->mode) != 0)
        r->way++;
    r->settings = (MesoReplicaSettings){
        .mode = r->way, .substeps = a->substeps, .seed = a->tool.seed, .alpha = (double)a->alpha,
        .beta = (double)a->beta, .gamma = (double)a->gamma, .mu = (double)a->mu, .ramp = (double)a->ramp};
    while (strcmp(births[r->settings.births], a->births) != 0)
        r->settings.births++;
    r->mark = meso_replica_mark(&clip->rest, originals->details, originals->count);
    MesoStatus status = MESO_OK;
    if (r->way == MESO_WAY_PLAY && is_there(a->plan))
        status = follow(r, originals->details, originals->count);
    else
        status = begin_replication(r, originals);
    if (status == MESO_ERR_INPUT || status == MESO_ERR_LIMIT)
        meso_fail_prefix(&a->tool.error, a->tool.operands[0]);
    if (status)
        return status;
    return r->way == MESO_WAY_PLAY ? prepare_play(r) : read_state(r);
}

MesoStatus meso_replicate_run_look_ahead(MesoReplicateRun *r, const MesoOriginals *originals,
                                         const MesoFrameList *frames)
{
    MesoStatus status = MESO_OK;
    uint32_t frame;
    if (r->way != MESO_WAY_PLAN)
        return MESO_OK;
    meso_tool_progress_begin(r->tool, "looking ahead", "frames");
    for (uint32_t i = 0; i < frames->count && !status; i++) {
        status = meso_replicate_clip_find(r->clip, frames->frames[i], &frame);
        if (!status)
            status = meso_replicate_clip_load(r->clip, frame);
        if (!status)
            status = step(r);
        meso_tool_progress(r->tool, i + 1, frames->count);
    }
    MesoDetail *details = status ? NULL : MESO_NEW(&r->tool->arena, MesoDetail, r->count, &r->tool->error);
    if (!details)
        return status ? status : MESO_ERR_MEMORY;
    r->details = memcpy(details, r->details, r->count * sizeof *details);
    r->ahead = true;
    meso_replicate_release(r->replication);
    r->replication = NULL;
    meso_replicate_clip_rewind(r->clip);
    return begin_replication(r, originals);
}

void meso_replicate_run_end(MesoReplicateRun *r)
{
    meso_replicate_release(r->replication);
    if (r->tool)
        meso_arena_release(&r->playing);
}
