/* One patch of a quilt. */
#include "libcore/base/clock.h"
#include "libcore/base/parallel.h"
#include "libcore/quilt/quilt_work.h"

/* Placements that are looked at closely, so many at once, and how far from each other sections may lie beside their way. */
#define CANDIDATE_COUNT MESO_QUILT_TRIALS
#define TRIED_AT_ONCE 2
#define REACH_BEFORE_WARP 3.0f

/* Ways that are not worth a warp, in mean edges of the swatch. */
#define WARP_LEAST 1e-4f

/* Smoothing of the warp, and the share of the patch over which it fades out. */
#define WARP_SMOOTHING 0.02
#define WARP_FADE 0.7f

MesoVec3 meso_step_warp(const MesoQuiltStep *step, MesoVec3 p)
{
    if (!step->warp.count)
        return p;
    MesoVec2 place = {p.x, p.y};
    float away = meso_seam_at(&step->seam, place) / step->warp_reach;
    if (away >= 1)
        return p;
    away = away > 0 ? away : 0;
    float fade = 1 - away * away * (3 - 2 * away);
    MesoVec3 move = meso_thin_plate_at(&step->warp, place);
    float length = meso_vec3_length(move);
    if (length > 1.5f * step->warp_limit)
        fade *= step->warp_limit / length;  /* far from its points a plate leaves all bounds */
    return meso_vec3_mad(p, fade, move);
}

/* ---- pairs of both sides ---- */

/* Where a point of the new side belongs. */
typedef struct Pull {
    MesoVec3 from, apart;
} Pull;

/* Pairs of sections and of whole elements near the seam. */
static MesoStatus collect_pulls(Pull **pulls, uint32_t *count, const MesoQuiltStep *step,
                                const MesoStrandSide *old_side, const MesoStrandSide *new_side,
                                const MesoWholePairs *wholes, const MesoQuiltWork *work, MesoArena *arena,
                                MesoError *error)
{
    *count = 0;
    *pulls = MESO_NEW(arena, Pull, (size_t)new_side->section_count + wholes->count, error);
    if (!*pulls)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < new_side->section_count; s++) {
        uint32_t partner = new_side->partners[s];
        if (partner == MESO_NO_INDEX)
            continue;
        MesoVec3 from = new_side->sections[s].centre;
        (*pulls)[(*count)++] = (Pull){from, meso_vec3_sub(old_side->sections[partner].centre, from)};
    }
    for (uint32_t i = 0; i < wholes->count; i++) {
        uint32_t partner = wholes->partners[i];
        MesoVec3 from = meso_step_from_swatch(step, work->swatch->centres[wholes->elements[i]]);
        float radius = work->swatch->radii[wholes->elements[i]];
        float side = meso_seam_at(&step->seam, (MesoVec2){from.x, from.y});
        if (partner != MESO_NO_INDEX && side > -3 * radius && side < 3 * radius)
            (*pulls)[(*count)++] = (Pull){from, meso_vec3_sub(step->old.centres[partner], from)};
    }
    return MESO_OK;
}

/* What the new side is still to move by. */
static MesoStatus fit_warp(MesoQuiltStep *step, const Pull *pulls, uint32_t count, const MesoQuiltWork *work,
                           MesoArena *arena, MesoError *error)
{
    MesoVec2 *points = MESO_NEW(arena, MesoVec2, count, error);
    MesoVec3 *values = MESO_NEW(arena, MesoVec3, count, error);
    if (!points || !values)
        return MESO_ERR_MEMORY;
    step->warp_limit = 0;
    for (uint32_t i = 0; i < count; i++) {
        points[i] = (MesoVec2){pulls[i].from.x, pulls[i].from.y};
        values[i] = pulls[i].apart;
        float length = meso_vec3_length(values[i]);
        step->warp_limit = length > step->warp_limit ? length : step->warp_limit;
    }
    step->warp_reach = WARP_FADE * (work->swatch->size.x < work->swatch->size.y ? work->swatch->size.x
                                                                               : work->swatch->size.y);
    if (step->warp_limit < WARP_LEAST * work->swatch->mean_edge)
        return MESO_OK;     /* it fits as it is */
    return meso_thin_plate_fit(&step->warp, arena, count, points, values, WARP_SMOOTHING, error);
}

/* ---- the step ---- */

typedef struct Candidate {
    MesoQuiltStep step;     /* with the placement and its seam */
    MesoStrandSide old_side, new_side;
    MesoWholePairs wholes;
    float flaws;            /* strands that end, or are cut along */
    MesoStatus status;
    MesoError error;
} Candidate;

/* The seam of a placement, and what meets there. */
static MesoStatus try_placement(Candidate *c, const MesoQuiltWork *work, MesoArena *arena)
{
    MesoQuiltStep *step = &c->step;
    step->warp = (MesoThinPlate){0};
    MesoStatus status = meso_quilt_seam(step, work, arena, &c->error);
    if (!status)
        status = meso_strands_cut_old(&c->old_side, step, work, 0, arena, &c->error);
    if (!status)
        status = meso_strands_cut_new(&c->new_side, step, work, 0, arena, &c->error);
    if (!status)
        status = meso_strands_pair(&c->old_side, &c->new_side, &c->flaws, REACH_BEFORE_WARP, arena, &c->error);
    if (!status)
        status = meso_quilt_pair_wholes(&c->wholes, step, work, arena, &c->error);
    return status;
}

typedef struct Trials {
    Candidate *candidates;
    const MesoQuiltWork *work;
    MesoArena *arenas;      /* [candidates] */
    uint32_t begin;
} Trials;

static void try_range(void *context, uint64_t begin, uint64_t end)
{
    const Trials *trials = context;
    for (uint64_t i = trials->begin + begin; i < trials->begin + end; i++)
        trials->candidates[i].status = try_placement(&trials->candidates[i], trials->work, &trials->arenas[i]);
}

/* The placement with the fewest ends; of equal ones the one that matches best. Its seam goes to the step. */
static MesoStatus choose_placement(Candidate **best, MesoQuiltStep *step, MesoQuiltWork *work, MesoArena *arena,
                                   MesoError *error)
{
    MesoMatch matches[CANDIDATE_COUNT];
    uint32_t found;
    double clock = meso_seconds();
    MesoStatus status = meso_quilt_place(matches, &found, CANDIDATE_COUNT, step, work, arena, error);
    work->report.seconds[1] += meso_seconds() - clock;
    clock = meso_seconds();
    Candidate *candidates = status ? NULL : MESO_NEW(arena, Candidate, found, error);
    if (!candidates)
        return error ? error->status : MESO_ERR_MEMORY;
    *best = NULL;
    for (uint32_t i = 0; i < found && (!*best || (*best)->flaws > 0); i += TRIED_AT_ONCE) {
        uint32_t end = i + TRIED_AT_ONCE < found ? i + TRIED_AT_ONCE : found;
        for (uint32_t k = i; k < end; k++) {
            candidates[k].step = *step;
            meso_quilt_choose(&candidates[k].step, work, matches[k]);
        }
        Trials trials = {candidates, work, work->trial_arenas, i};
        meso_parallel_for(work->options.thread_count, end - i, 1, try_range, &trials);
        for (uint32_t k = i; k < end; k++) {
            if (candidates[k].status) {
                if (error)
                    *error = candidates[k].error;
                return candidates[k].status;
            }
            if (!*best || candidates[k].flaws < (*best)->flaws)
                *best = &candidates[k];
        }
    }
    *step = (*best)->step;
    work->report.retry_count += *best != candidates;
    work->cost_sum += step->match.cost;
    work->report.seconds[2] += meso_seconds() - clock;
    return MESO_OK;
}

/* The new side is cut again where placement or warp have moved it. */
static MesoStatus cut_again(Candidate *c, MesoQuiltStep *step, const MesoQuiltWork *work, float reach, MesoArena *arena,
                            MesoError *error)
{
    MesoStatus status = meso_strands_cut_new(&c->new_side, step, work, 0, arena, error);
    return status ? status : meso_strands_pair(&c->old_side, &c->new_side, &c->flaws, reach, arena, error);
}

static MesoStatus fit(Candidate *c, MesoQuiltStep *step, MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    Pull *pulls;
    uint32_t count;
    if (meso_quilt_align(&c->step, work)) {
        MesoStatus status = try_placement(c, work, arena);
        if (status) {
            if (error)
                *error = c->error;
            return status;
        }
    }
    *step = c->step;
    MesoStatus status = collect_pulls(&pulls, &count, step, &c->old_side, &c->new_side, &c->wholes, work, arena, error);
    if (status || !count)
        return status;
    work->report.correspondence_count += count;
    status = fit_warp(step, pulls, count, work, arena, error);
    return status || !step->warp.count ? status : cut_again(c, step, work, MESO_REACH_LAST, arena, error);
}

static MesoStatus stitch(MesoQuiltStep *step, MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    Candidate *c = NULL;
    MesoStatus status = choose_placement(&c, step, work, arena, error);
    if (status)
        return status;
    double clock = meso_seconds();
    status = fit(c, step, work, arena, error);
    if (!status)
        status = meso_strands_join(&c->old_side, &c->new_side, step, work, arena, error);
    work->report.seconds[4] += meso_seconds() - clock;
    clock = meso_seconds();
    if (!status)
        status = meso_quilt_place_wholes(&c->wholes, step, work, arena, error);
    work->report.seconds[3] += meso_seconds() - clock;
    return status;
}

/* The angle by which the swatch's x axis is turned in the chart: that of the guide, on the mean over the chart. */
static float guide_angle(const MesoQuiltStep *step, const MesoQuiltWork *work)
{
    if (!work->options.guide)
        return 0;
    double x = 0, y = 0;
    const MesoChart *chart = &step->chart;
    uint32_t symmetry = work->options.turn_count;
    for (uint32_t t = 0; t < chart->triangle_count; t++) {
        const uint32_t *flat = &chart->corners[3 * (size_t)t];
        MesoVec2 p = chart->places[flat[0]], q = meso_vec2_sub(chart->places[flat[1]], p);
        MesoVec2 r = meso_vec2_sub(chart->places[flat[2]], p);
        MesoVec2 guide = meso_chart_direction(chart, work->base, t, work->options.guide[chart->triangles[t]]);
        double angle = atan2(guide.y, guide.x) * symmetry;
        float distance = meso_vec2_length(p) / chart->radius;
        double weight = meso_vec2_cross(q, r) / (1 + distance * distance);
        x += weight * cos(angle);
        y += weight * sin(angle);
    }
    return x != 0 || y != 0 ? (float)(atan2(y, x) / symmetry) : 0;
}

MesoStatus meso_quilt_step(MesoQuiltStep *step, bool *done, MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    double clock = meso_seconds();
    MesoChartOptions options = {.radius = step->tightness * work->chart_radius * work->options.scale, .largest_ratio = 4,
                                .relaxations = 4};
    MesoStatus status = meso_chart_grow(&step->chart, arena, &work->maker, step->seed, &options, error);
    if (status)
        return status;
    work->report.shrunk_count += step->chart.radius < 0.99f * options.radius;
    status = meso_quilt_plane_make(&step->plane, arena, work->base, &step->chart, work->chart_triangles,
                                   guide_angle(step, work), work->options.scale, work->options.height_scale,
                                   work->options.offset, error);
    work->report.seconds[0] += meso_seconds() - clock;
    if (status)
        return status;
    status = meso_old_geometry_load(step, work, arena, error);
    if (!status)
        status = meso_quilt_ground(step, work, arena, error);
    if (!status)
        status = stitch(step, work, arena, error);
    meso_old_geometry_forget(step, work);
    for (int i = 0; i < MESO_QUILT_TRIALS; i++)
        meso_arena_rewind(&work->trial_arenas[i], work->trial_marks[i]);
    *done = !status && meso_quilt_cover(step, work);
    meso_quilt_plane_forget(&step->plane);
    return status;
}
