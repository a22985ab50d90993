#include "libcore/tiling/relax/relax.h"

#include <math.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/tiling/relax/relax_work.h"

enum { NODES_A_RANGE = 512, LINKS_A_RANGE = 256 };

/* Of the steps, the last ones without alignment. */
static const float ALONE = 0.25f;

/* Of the mean edge length: the room that is looked for around sweeps, and how far one of their points may go. */
static const float ROOM = 0.1f, POINT_REACH = 0.3f;

typedef struct Stepper {
    MesoRelaxWork *work;
    uint32_t threads;
} Stepper;

static void trace_range(void *context, uint64_t begin, uint64_t end)
{
    MesoRelaxWork *work = context;
    for (uint64_t i = begin; i < end; i++)
        meso_relax_trace(&work->links[i], work->nodes);
}

static void take_range(void *context, uint64_t begin, uint64_t end)
{
    MesoRelaxWork *work = context;
    for (uint64_t n = begin; n < end; n++) {
        if (!work->nodes[n].free)
            continue;
        work->nodes[n].move = work->next[n];
        meso_relax_place(&work->nodes[n]);
    }
}

static void for_nodes(const Stepper *s, void (*body)(void *context, uint64_t begin, uint64_t end))
{
    meso_parallel_for(s->threads, s->work->joint_count, NODES_A_RANGE, body, s->work);
}

static void for_links(const Stepper *s, void (*body)(void *context, uint64_t begin, uint64_t end))
{
    meso_parallel_for(s->threads, s->work->link_count, LINKS_A_RANGE, body, s->work);
}

static void move(const Stepper *s, void (*choose)(void *work, uint64_t begin, uint64_t end))
{
    for_links(s, meso_relax_contacts);
    for_nodes(s, choose);
    for_nodes(s, take_range);
    for_links(s, trace_range);
}

static int16_t rounded(float value, int32_t unit)
{
    return isfinite(value) ? (int16_t)lroundf(fminf(fmaxf(value * (float)unit, -32767), 32767)) : 0;
}

/* Whole numbers, as files have them: products do not depend on whether a model was written between. */
static MesoStatus store(const MesoRelaxWork *work, MesoArena *arena, MesoError *error)
{
    MesoJointMove *joints = MESO_NEW(arena, MesoJointMove, work->joint_count, error);
    for (uint32_t n = 0; joints && n < work->joint_count; n++) {
        const MesoWallMove *move = &work->nodes[n].move;
        joints[n] = (MesoJointMove){rounded(move->along, MESO_JOINT_PLACES), rounded(move->rise, MESO_JOINT_PLACES),
                                    rounded(move->lean_along, MESO_JOINT_LEANS),
                                    rounded(move->lean_rise, MESO_JOINT_LEANS)};
    }
    work->model->joints = joints;
    work->model->joint_count = work->joint_count;
    return joints ? MESO_OK : MESO_ERR_MEMORY;
}

static void measure(const MesoRelaxWork *work, uint32_t when, MesoRelaxReport *report)
{
    report->intersections[when] = meso_relax_count(work);
    meso_relax_bends(work, &report->bend_mean[when], &report->bend_most[when]);
    for (uint32_t n = 0; n < work->joint_count && when == 1; n++) {
        MesoRelaxNode unmoved = work->nodes[n];
        if (!unmoved.free)
            continue;
        memset(&unmoved.move, 0, sizeof unmoved.move);
        meso_relax_place(&unmoved);
        float move = meso_vec3_length(meso_vec3_sub(unmoved.point, work->nodes[n].point));
        report->move_most = fmaxf(report->move_most, move);
        report->joints++;
    }
}

static MesoStatus relax(const Stepper *s, MesoRelaxReport *report, MesoArena *arena, MesoArena *scratch,
                        MesoError *error)
{
    MesoRelaxWork *work = s->work;
    uint32_t steps = work->options.relax, aligned = steps - (uint32_t)(ALONE * (float)steps);
    MesoStatus status = meso_relax_build(work, scratch, error);
    if (!status)
        status = meso_relax_find_meant(work, scratch, error);
    if (status)
        return status;
    for_links(s, trace_range);
    status = meso_relax_find_near(work, scratch, error);
    if (status)
        return status;
    if (report) {
        report->steps = steps;
        measure(work, 0, report);
    }
    for_nodes(s, meso_relax_bound_bends);
    for (uint32_t i = 0; i < steps; i++) {
        move(s, i < aligned ? meso_relax_align : meso_relax_part);
        move(s, meso_relax_part);
    }
    if (report)
        measure(work, 1, report);
    return store(work, arena, error);
}

MesoStatus meso_model_relax(MesoModel *model, MesoRelaxReport *report, MesoArena *arena, uint32_t thread_count,
                            MesoError *error)
{
    MesoArena scratch;
    float mean = model->surface.mean_edge_length, edge = mean > 0 ? mean : 1;
    MesoRelaxWork work = {.model = model, .options = meso_map_options_resolve(model->options, mean),
                          .room = ROOM * edge, .reach = POINT_REACH * edge};
    const Stepper stepper = {&work, thread_count};
    if (report)
        *report = (MesoRelaxReport){0};
    model->joints = NULL;
    model->joint_count = 0;
    if (model->options.relax == 0)
        return MESO_OK;
    if (model->options.deform != MESO_SWEEP_CURVES)
        return meso_fail(error, MESO_ERR_USAGE, "strands are relaxed where their sections keep their shape, and do not "
                         "deform with their slots");
    meso_arena_init(&scratch);
    MesoStatus status = relax(&stepper, report, arena, &scratch, error);
    meso_arena_release(&scratch);
    return status;
}
