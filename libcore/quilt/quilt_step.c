/* One patch of a quilt. */
#include <string.h>

#include "libcore/base/clock.h"
#include "libcore/base/parallel.h"
#include "libcore/quilt/phase/phase_plane.h"
#include "libcore/quilt/quilt_work.h"

/* How far from each other sections of a placement may lie beside their way. */
#define REACH_BEFORE_WARP 3.0f

/* Ways that are not worth a warp, in mean edges of the swatch. */
#define WARP_LEAST 0.01f

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

/* ---- scratch ---- */

MesoArena *meso_arena_pool_lend(MesoArenaPool *pool)
{
    uint32_t i = 0;
    while (atomic_exchange(&pool->lent[i], true))
        i = (i + 1) % MESO_QUILT_ARENAS;
    return &pool->arenas[i];
}

void meso_arena_pool_return(MesoArenaPool *pool, MesoArena *arena)
{
    meso_arena_clear(arena);
    atomic_store(&pool->lent[arena - pool->arenas], false);
}

/* ---- cores ---- */

/* Cores that no patch keeps at work, and the one that asks. */
static uint32_t idle_cores(const MesoQuiltWork *work)
{
    uint32_t threads = work->options.thread_count ? work->options.thread_count : meso_parallel_cores();
    uint32_t busy = atomic_load(&work->busy_patches);
    return threads > busy ? threads - busy + 1 : 1;
}

/* Tasks of both sides. */
typedef struct Sides {
    MesoSideTask *task;
    void *context;
    MesoArena *arenas[2];
    MesoStatus statuses[2];
    MesoError errors[2];
} Sides;

static void do_side(void *context, uint64_t begin, uint64_t end)
{
    Sides *sides = context;
    for (uint64_t i = begin; i < end; i++)
        sides->statuses[i] = sides->task(sides->context, (int)i, sides->arenas[i], &sides->errors[i]);
}

MesoStatus meso_quilt_both(MesoSideTask *task, void *context, const MesoQuiltStep *step, const MesoQuiltWork *work,
                           MesoArena *arena, MesoError *error)
{
    bool together = step->beside && idle_cores(work) > 1;
    Sides sides = {.task = task, .context = context, .arenas = {arena, together ? step->beside : arena}};
    meso_parallel_for(together ? 2 : 1, 2, 1, do_side, &sides);
    for (int i = 0; i < 2; i++)
        if (sides.statuses[i]) {
            if (error)
                *error = sides.errors[i];
            return sides.statuses[i];
        }
    return MESO_OK;
}

/* ---- pairs of both sides ---- */

/* Where a point of the new side belongs. */
typedef struct Pull {
    MesoVec3 from, apart;
} Pull;

/* Pairs of sections and of whole elements near the seam. */
static MesoStatus collect_pulls(Pull **pulls, uint32_t *count, const MesoQuiltStep *step,
                                const MesoStrandSide *new_side, const MesoRingShares *shares,
                                const MesoWholePairs *wholes, const MesoQuiltWork *work, MesoArena *arena,
                                MesoError *error)
{
    *count = 0;
    *pulls = MESO_NEW(arena, Pull, (size_t)new_side->section_count + shares->pull_count + wholes->count, error);
    if (!*pulls)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < new_side->section_count; s++) {
        if (new_side->partners[s] != MESO_NO_INDEX)
            (*pulls)[(*count)++] = (Pull){new_side->sections[s].centre, new_side->besides[s]};
    }
    for (uint32_t i = 0; i < shares->pull_count; i++)
        (*pulls)[(*count)++] = (Pull){shares->pulls_from[i], shares->pulls_apart[i]};
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
    MesoRingShares shares;
    MesoStrandSide old_side, new_side;
    MesoWholePairs wholes;
    float flaws;            /* strands that end, or are cut along */
} Candidate;

/* What meets at the seam. */
static MesoStatus meet(Candidate *c, const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    MesoQuiltStep *step = &c->step;
    step->warp = (MesoThinPlate){0};
    MesoStatus status = meso_strands_cut(&c->old_side, &c->new_side, MESO_CUT_ENDS, &c->shares, step, work, arena,
                                         error);
    if (!status)
        status = meso_strands_pair(&c->old_side, &c->new_side, &c->flaws, REACH_BEFORE_WARP, &c->shares, step, work,
                                   arena, error);
    if (!status)
        status = meso_quilt_pair_wholes(&c->wholes, step, work, arena, error);
    return status;
}

/* The seam of a placement, and what meets there. */
static MesoStatus try_placement(Candidate *c, const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    c->step.warp = (MesoThinPlate){0};
    MesoStatus status = meso_quilt_seam(&c->step, work, arena, error);
    return status ? status : meet(c, work, arena, error);
}

/* Placements of one step, side by side. */
typedef struct Trials {
    MesoQuiltWork *work;
    Candidate candidates[MESO_QUILT_TRIALS];
    MesoArena **arenas;         /* one for each, lent when its turn comes */
    MesoStatus statuses[MESO_QUILT_TRIALS];
    MesoError errors[MESO_QUILT_TRIALS];
    uint32_t first;             /* that the range begins with */
} Trials;

static void try_range(void *context, uint64_t begin, uint64_t end)
{
    Trials *trials = context;
    for (uint64_t i = trials->first + begin; i < trials->first + end; i++) {
        trials->arenas[i] = meso_arena_pool_lend(&trials->work->pool);
        trials->statuses[i] = try_placement(&trials->candidates[i], trials->work, trials->arenas[i],
                                            &trials->errors[i]);
    }
}

/* Nothing where it is NULL. */
static void give_back(MesoArenaPool *pool, MesoArena **arena)
{
    if (*arena)
        meso_arena_pool_return(pool, *arena);
    *arena = NULL;
}

/*
 * The first one; where that leaves flaws, the others as well, until one leaves none. Which has the fewest. Cores that
 * would be idle begin with the others meanwhile: what comes of these counts only where those before them have flaws.
 */
static MesoStatus run_trials(Trials *trials, uint32_t count, uint32_t *chosen, MesoError *error)
{
    *chosen = 0;
    for (uint32_t tried = 0; tried < count && (tried == 0 || trials->candidates[*chosen].flaws > 0);) {
        uint32_t cores = idle_cores(trials->work), some = cores < count - tried ? cores : count - tried;
        trials->first = tried;
        meso_parallel_for(some, some, 1, try_range, trials);
        tried += some;
        uint32_t counted = trials->statuses[0] || !(trials->candidates[0].flaws > 0) ? 1 : tried;
        for (uint32_t i = trials->first; i < counted; i++) {
            if (trials->statuses[i]) {
                if (error)
                    *error = trials->errors[i];
                return trials->statuses[i];
            }
            if (i == *chosen)
                continue;
            bool better = trials->candidates[i].flaws < trials->candidates[*chosen].flaws;
            give_back(&trials->work->pool, &trials->arenas[better ? *chosen : i]);
            *chosen = better ? i : *chosen;
        }
    }
    return MESO_OK;
}

/* Placements of a patch, best first. */
typedef struct Places {
    MesoMatch matches[MESO_QUILT_TRIALS];
    uint32_t found;
} Places;

/* The placement with the fewest ends; of equal ones the one that matches best. */
static MesoStatus choose_placement(Candidate *best, MesoArena **trial, const Places *places, MesoQuiltPatch *patch,
                                   MesoQuiltWork *work, MesoError *error)
{
    MesoQuiltStep *step = &patch->step;
    uint32_t found = places->found, chosen;
    Trials trials = {.work = work, .arenas = patch->trial_arenas};
    for (uint32_t i = 0; i < found; i++) {
        trials.candidates[i].step = *step;
        trials.candidates[i].step.beside = NULL;    /* they are tried side by side */
        meso_quilt_choose(&trials.candidates[i].step, work, places->matches[i]);
    }
    MesoStatus status = run_trials(&trials, found, &chosen, error);
    if (status)
        return status;
    *best = trials.candidates[chosen];
    *trial = trials.arenas[chosen];
    best->step.beside = step->beside;
    for (uint32_t i = 0; i < found; i++)
        if (i != chosen)
            give_back(&work->pool, &trials.arenas[i]);
    step->tally->report.retry_count += chosen > 0;
    step->tally->cost_sum += best->step.match.cost;
    return MESO_OK;
}

/* Both sides as they are to be joined: cut anew where the warp has moved them. */
static MesoStatus cut_all(Candidate *c, MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena,
                          MesoError *error)
{
    float reach = step->warp.count ? MESO_REACH_LAST : REACH_BEFORE_WARP;
    MesoStatus status = step->warp.count ? meso_strands_share(&c->shares, step, work, arena, error) : MESO_OK;
    step->before_sides[0] = meso_arena_mark(arena);
    step->before_sides[1] = meso_arena_mark(step->beside);
    if (!status)
        status = meso_strands_cut_shared(&c->old_side, &c->new_side, MESO_CUT_ALL, &c->shares, step, work, arena,
                                         error);
    return status ? status : meso_strands_pair(&c->old_side, &c->new_side, &c->flaws, reach, &c->shares, step,
                                               work, arena, error);
}

/* The seam outlives the trial that it is of. */
static MesoStatus keep_seam(MesoQuiltStep *step, MesoArena *arena, MesoError *error)
{
    size_t count = (size_t)step->seam.columns * step->seam.rows;
    float *values = MESO_NEW(arena, float, count, error), *rim = MESO_NEW(arena, float, count, error);
    if (!values || !rim)
        return MESO_ERR_MEMORY;
    step->seam.values = memcpy(values, step->seam.values, count * sizeof *values);
    step->rim = memcpy(rim, step->rim, count * sizeof *rim);
    return MESO_OK;
}

/* What meets where the placement has been made exact takes the place of what was tried, in `trial`. */
static MesoStatus meet_again(Candidate *c, const MesoQuiltWork *work, MesoArena *arena, MesoArena *trial,
                             MesoError *error)
{
    MesoStatus status = work->welds ? MESO_OK : keep_seam(&c->step, arena, error);
    bool moved = meso_quilt_align(&c->step, work);
    if (moved)
        meso_arena_clear(trial);
    if (!status && moved)
        status = work->welds ? try_placement(c, work, trial, error) : meet(c, work, trial, error);
    return status || !work->welds ? status : keep_seam(&c->step, arena, error);
}

/*
 * The placement made exact, by less than a voxel or so, and the warp that takes up what is left. The seam for which it
 * was chosen stays, but where sides may fit vertex by vertex. The step becomes the candidate's.
 */
static MesoStatus fit(Candidate *c, MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena, MesoArena *trial,
                      MesoError *error)
{
    Pull *pulls;
    uint32_t count;
    MesoArenaMark beside = meso_arena_mark(step->beside);
    MesoStatus status = meet_again(c, work, arena, trial, error);
    *step = c->step;
    if (!status)
        status = collect_pulls(&pulls, &count, step, &c->new_side, &c->shares, &c->wholes, work, arena, error);
    if (status)
        return status;
    step->tally->report.correspondence_count += count;
    if (count)
        status = fit_warp(step, pulls, count, work, arena, error);
    if (step->warp.count)
        meso_arena_rewind(step->beside, beside);    /* all that was cut is to be cut anew */
    return status ? status : cut_all(c, step, work, arena, error);
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

/* Chart, plane, and what lies there already. */
static MesoStatus survey(MesoQuiltPatch *patch, MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    MesoQuiltStep *step = &patch->step;
    MesoChartOptions options = {.radius = step->tightness * work->chart_radius * work->options.scale,
                                .largest_ratio = 4, .relaxations = 4};
    step->maker->unfolds = true;
    step->maker->lent = step->beside;
    MesoStatus status = meso_chart_grow(&step->chart, arena, step->maker, step->seed, &options, error);
    meso_arena_clear(step->beside);     /* in one block: the next chart finds its room there */
    if (status)
        return status;
    step->tally->report.shrunk_count += step->chart.radius < 0.99f * options.radius;
    float angle = guide_angle(step, work);
    status = meso_quilt_plane_make(&step->plane, arena, work->base, &step->chart, work->chart_triangles, angle,
                                   work->options.scale, work->options.height_scale, work->options.offset, error);
    if (!status && work->in_phase)
        status = meso_phase_plane(step->plane.places, arena, &step->chart, work->chart_triangles, &work->phases,
                                  work->options.guide, angle, work->options.scale, error);
    if (!status && work->in_phase)
        status = meso_quilt_plane_index(&step->plane, arena, error);
    patch->laid_out = true;
    return status ? status : meso_old_geometry_load(step, work, arena, error);
}

/* What is to be known of what lies there before a seam can go through it, and where the swatch may go. */
typedef struct Look {
    MesoQuiltStep *step;
    const MesoQuiltWork *work;
    Places places;
} Look;

static MesoStatus look_at(void *context, int side, MesoArena *arena, MesoError *error)
{
    Look *look = context;
    MesoQuiltStep *step = look->step;
    if (side)
        return meso_quilt_place(look->places.matches, &look->places.found, MESO_QUILT_TRIALS, step, look->work, arena,
                                error);
    MesoStatus status = meso_strands_old_rings(&step->old_rings, &step->old, look->work, arena, error);
    if (!status)
        status = meso_quilt_ground(step, look->work, arena, error);
    return status ? status : meso_strands_fix_old(&step->old_fixed, step, look->work, arena, error);
}

MesoStatus meso_quilt_prepare(MesoQuiltPatch *patch, MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    MesoQuiltStep *step = &patch->step;
    double *seconds = step->tally->report.seconds, clocks[6] = {meso_seconds()};
    step->beside = meso_arena_pool_lend(&work->pool);
    MesoStatus status = survey(patch, work, arena, error);
    clocks[1] = meso_seconds();
    Candidate c = {0};
    MesoArena *trial;
    Look look = {.step = step, .work = work};
    if (!status)
        status = meso_quilt_both(look_at, &look, step, work, arena, error);
    clocks[2] = meso_seconds();
    if (!status)
        status = choose_placement(&c, &trial, &look.places, patch, work, error);
    if (!status)
        status = fit(&c, step, work, arena, trial, error);
    clocks[3] = meso_seconds();
    if (!status && !step->warp.count)
        status = meso_strands_try_weld(&patch->weld, &patch->welded, &c.old_side, &c.new_side, step, work, arena,
                                       error);
    if (!status && !patch->welded)
        status = meso_strands_plan(&patch->joint, &c.old_side, &c.new_side, &c.shares, step, work, arena, error);
    clocks[4] = meso_seconds();
    if (!status)
        status = meso_quilt_plan_wholes(&patch->wholes, &c.wholes, step, work, arena, error);
    clocks[5] = meso_seconds();
    for (int i = 0; i < MESO_QUILT_TRIALS; i++)
        give_back(&work->pool, &patch->trial_arenas[i]);
    const int stages[5] = {0, 1, 2, 4, 3};  /* of MesoQuiltReport */
    for (int i = 0; i < 5; i++)
        seconds[stages[i]] += clocks[i + 1] - clocks[i];
    return status;
}

static void add_tally(MesoQuiltTally *sum, const MesoQuiltTally *tally)
{
    const MesoQuiltReport *from = &tally->report;
    MesoQuiltReport *to = &sum->report;
    to->correspondence_count += from->correspondence_count;
    to->join_count += from->join_count;
    to->weld_count += from->weld_count;
    to->open_count += from->open_count;
    to->retry_count += from->retry_count;
    to->shrunk_count += from->shrunk_count;
    to->removed_count += from->removed_count;
    if (from->deformation_largest > to->deformation_largest)
        to->deformation_largest = from->deformation_largest;
    for (int i = 0; i < 6; i++)
        to->seconds[i] += from->seconds[i];
    sum->cost_sum += tally->cost_sum;
    sum->square_sum += tally->square_sum;
    sum->moved_count += tally->moved_count;
}

MesoStatus meso_quilt_commit(MesoQuiltPatch *patch, MesoStatus prepared, bool *done, MesoQuiltWork *work,
                             MesoArena *arena, MesoError *error)
{
    MesoQuiltStep *step = &patch->step;
    double clock = meso_seconds();
    MesoStatus status = prepared;
    if (!status)
        status = patch->welded ? meso_strands_commit_weld(&patch->weld, step, work, arena, error)
                               : meso_strands_commit(&patch->joint, step, work, arena, error);
    if (!status)
        status = meso_quilt_commit_wholes(&patch->wholes, step, work, error);
    meso_old_geometry_forget(step, work);
    *done = !status && meso_quilt_cover(step, work);
    if (patch->laid_out)
        meso_quilt_plane_forget(&step->plane);
    step->tally->report.seconds[5] += meso_seconds() - clock;
    add_tally(&work->tally, step->tally);
    return status;
}
