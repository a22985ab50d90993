/*
 * A piece of surface between two columns and two rings, h long, is f = (a x x + 2 c x y + b y y) / 2 seen from the
 * side, and lies off its edges by the eighth of f's second derivative along them, to the outside where it is convex: A
 * around, B h h along, and A + B h h - D h / 4 or A + B h h + D h / 4 on the one or the other diagonal, where D h is
 * what the corners are off a parallelogram. Corners are moved out of the bends by half of A and of B h h. So it is
 * within e where
 *
 *     |A| / 2 + |B| h h / 2 <= e         |A / 2 + B h h / 2 - D h / 4| <= e
 *
 * with the diagonal that suits better: warp, which columns that wind around a
 * tube have much of, costs nothing where the surface is convex, until the diagonals are as bent the other way.
 */
#include "libcore/tiling/strand/steps.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/sweep.h"
#include "libcore/tiling/strand/column_sample.h"

enum { SWEEPS_A_RANGE = 512, LEAST_INTERVALS = 16, MOST_INTERVALS = 256, LEAST_CAP_STEPS = 3 };

/*
 * What columns are off counts against the tolerance of the steps but for a small part, as both are seldom worst at one
 * place, and leaves so much of it. It counts less for caps, which bend most at the tip, where the columns meet.
 */
static const float OFF_PART = 1.0f, CAP_OFF_PART = 0.75f, LEAST_LEFT = 0.3f;

/* Differences at a few places miss the worst one. */
static const float MARGIN = 1.18f;

/* Of what a chord is off, where its ends are moved out of the bend (scene.h). */
static const float BOWED = 0.5f;

/* Of a step, what rounding may take. */
static const float ENOUGH = 1.02f;

/* Folds of creases run across columns within much less than a step. */
static const float CREASED_INTERVALS = 64;

/* What a radian of turn takes in intervals to be seen. */
static const float INTERVALS_A_RADIAN = 5;

typedef struct Chooser {
    const MesoScene *scene;
    const MesoKindOrigin *origins;
    float tolerance;
    uint16_t *rings;    /* [sweep_count] */
    atomic_bool failed; /* memory is out */
} Chooser;

/* ---- how many it takes ---- */

/* How surfaces bend between two columns, of one step from end to end: to the outside where it is above 0. */
typedef struct PairBend {
    float along[MOST_INTERVALS + 1];        /* B, of both columns */
    float edges[MOST_INTERVALS + 1];        /* the larger |B|, and at a corner what is off whichever way */
    float warp[MOST_INTERVALS + 1];         /* D / 4 */
    bool convex;                            /* around */
} PairBend;

/* At each of the places along a sweep: what columns are off, and the steps that it takes, of one from end to end. */
typedef struct Wants {
    uint32_t intervals;
    float off[MOST_INTERVALS + 1];
    float edges[MOST_INTERVALS + 1];    /* of all pairs, by their edges, */
    float steps[MOST_INTERVALS + 1];    /* and by diagonals, too, each as suits best */
} Wants;

/* What the steps of one range of sweeps are found with. */
typedef struct Work {
    MesoColumnSample sample;
    Wants wants;
    PairBend bend;
    float diagonals[MESO_MOST_PAIRS][2][MOST_INTERVALS + 1];     /* steps by the one diagonal and the other */
    MesoMeshVertex vertices[(MOST_INTERVALS + 1) * MESO_MOST_SAMPLED];
} Work;

static MesoVec3 second_difference(const MesoMeshVertex *v, uint32_t stride)
{
    return meso_vec3_add(meso_vec3_mad(v[0].position, -2, v[stride].position), v[2 * stride].position);
}

/* Outward, between two columns at one place: `at` is one of the intervals. */
static MesoVec3 pair_normal(const MesoMeshVertex *first, const MesoMeshVertex *second, uint32_t stride, uint32_t at)
{
    const MesoMeshVertex *a = first + at * stride, *b = second + at * stride;
    MesoVec3 along = meso_vec3_sub(meso_vec3_add(a[stride].position, b[stride].position),
                                   meso_vec3_add(a->position, b->position));
    MesoVec3 around = meso_vec3_sub(meso_vec3_add(b->position, b[stride].position),
                                    meso_vec3_add(a->position, a[stride].position));
    return meso_vec3_direction(meso_vec3_cross(along, around), (MesoVec3){0, 0, 0});
}

/* How far a column that bends so is off a chord along it: at a corner across it whichever way, else to the outside. */
static float seen(MesoVec3 bend, MesoVec3 along, float outside, bool sharp)
{
    float square = meso_vec3_dot(along, along);
    if (!sharp)
        return fabsf(outside);
    return meso_vec3_length(square > 0 ? meso_vec3_mad(bend, -meso_vec3_dot(bend, along) / square, along) : bend);
}

/* At the ends, where there is no second difference, it goes on as it does beside them, half the way: the first step's
 * own middle is not nearer to the end but where there are many. */
static void go_on(float *values, uint32_t n)
{
    values[0] = 1.5f * values[1] - 0.5f * values[2];
    values[n] = 1.5f * values[n - 1] - 0.5f * values[n - 2];
}

/* D of an interval from these on, outward. */
static float warp_at(const MesoMeshVertex *a, const MesoMeshVertex *b, uint32_t stride, MesoVec3 normal)
{
    MesoVec3 here = meso_vec3_sub(b->position, a->position);
    return meso_vec3_dot(meso_vec3_sub(meso_vec3_sub(b[stride].position, a[stride].position), here), normal);
}

/* Between two columns. */
static void find_bend(PairBend *out, const Work *work, const MesoColumnPair *pair)
{
    const MesoColumnSample *sample = &work->sample;
    uint32_t n = work->wants.intervals, stride = sample->kind.column_count;
    const MesoMeshVertex *columns[2] = {work->vertices + pair->columns[0], work->vertices + pair->columns[1]};
    float m = (float)n, scale = MARGIN * m * m / 8;
    MesoVec3 before = pair_normal(columns[0], columns[1], stride, 0);
    float warp_before = warp_at(columns[0], columns[1], stride, before);
    out->warp[0] = MARGIN * m / 4 * warp_before;
    for (uint32_t i = 1; i < n; i++) {
        MesoVec3 behind = pair_normal(columns[0], columns[1], stride, i);
        float warp = warp_at(columns[0] + i * stride, columns[1] + i * stride, stride, behind);
        out->warp[i] = MARGIN * m / 8 * (warp_before + warp);
        warp_before = warp;
        MesoVec3 normal = meso_vec3_scale(meso_vec3_add(before, behind), 0.5f);
        out->along[i] = out->edges[i] = 0;
        for (uint32_t k = 0; k < 2; k++) {
            const MesoMeshVertex *v = columns[k] + (i - 1) * stride;
            MesoVec3 bend = second_difference(v, stride), along = meso_vec3_sub(v[2 * stride].position, v[0].position);
            float outside = -meso_vec3_dot(bend, normal);
            out->along[i] += scale / 2 * outside;
            out->edges[i] = fmaxf(out->edges[i], scale * seen(bend, along, outside,
                                                              sample->sharp[pair->columns[k]]));
        }
        before = behind;
    }
    go_on(out->along, n);
    go_on(out->edges, n);
    out->warp[n] = MARGIN * m / 4 * warp_before;
    const MesoSweepColumn *first = &sample->columns[pair->columns[0]], *second = &sample->columns[pair->columns[1]];
    MesoVec2 chord = meso_vec2_sub(second->start, first->start);
    MesoVec2 change = meso_vec2_sub(second->start_normal, first->start_normal);
    out->convex = chord.x * change.x + chord.y * change.y >= 0;
}

/* Where fmaxf() is a call. */
static float larger(float a, float b)
{
    return a > b ? a : b;
}

/* The most steps n at which |off + along / (n n) - warp / n| is `tolerance`, which |off| is less than. */
static float steps_across(float off, float along, float warp, float tolerance)
{
    float out = tolerance - off, in = tolerance + off;
    float above = warp * warp + 4 * out * along, below = warp * warp - 4 * in * along;
    /* outside: (tolerance - off) n n + warp n - along = 0; inside: (tolerance + off) n n - warp n + along = 0 */
    float n = above >= 0 ? larger(0, (-warp + sqrtf(above)) / (2 * out)) : 0;
    return below >= 0 ? larger(n, (warp + sqrtf(below)) / (2 * in)) : n;
}

/* Of one pair. `part` of what chords are off counts. */
static void add_pair_steps(Work *work, uint32_t pair, float tolerance, float part)
{
    Wants *wants = &work->wants;
    const PairBend *bend = &work->bend;
    for (uint32_t i = 0; i <= wants->intervals; i++) {
        float off = bend->convex ? wants->off[i] : -wants->off[i];
        float most = part * larger(0, bend->edges[i]), along = part * bend->along[i];
        float warp = bend->warp[i];     /* chords that are off less, or not at all, are not to be relied on */
        float first = larger(steps_across(off, along, warp, tolerance), steps_across(0, along, warp, tolerance));
        float second = larger(steps_across(off, along, -warp, tolerance), steps_across(0, along, -warp, tolerance));
        work->diagonals[pair][0][i] = first;
        work->diagonals[pair][1][i] = second;
        wants->edges[i] = larger(wants->edges[i], sqrtf(most / (tolerance - wants->off[i])));
        wants->steps[i] = larger(wants->steps[i], larger(wants->edges[i], (first < second ? first : second)));
    }
}

static void find_steps(Work *work, float tolerance, float part)
{
    const MesoColumnSample *sample = &work->sample;
    memset(work->wants.edges, 0, sizeof work->wants.edges);
    memset(work->wants.steps, 0, sizeof work->wants.steps);
    for (uint32_t p = 0; p < sample->pair_count; p++) {
        find_bend(&work->bend, work, &sample->pairs[p]);
        add_pair_steps(work, p, tolerance, part);
    }
}

/* Steps somewhere, between those at the places. */
static float steps_near(const Wants *wants, const float *steps, float v)
{
    float place = v * (float)wants->intervals;
    uint32_t i = (uint32_t)place < wants->intervals ? (uint32_t)place : wants->intervals - 1;
    return steps[i] + (place - (float)i) * (steps[i + 1] - steps[i]);
}

/* Which pair of a sample a joint is like: the nearest. */
static uint32_t pair_of(const MesoColumnSample *sample, uint32_t joint)
{
    uint32_t best = 0, least = UINT32_MAX;
    for (uint32_t p = 0; p < sample->pair_count; p++) {
        uint32_t other = sample->pairs[p].joint, gap = other > joint ? other - joint : joint - other;
        if (gap < least) {
            least = gap;
            best = p;
        }
    }
    return best;
}

/* Part of all that a row takes: from where to where, and how long it is, by rows whose ends are both moved. */
typedef struct Stride {
    float from, to, step;
} Stride;

static Stride stride_of(const MesoSweptKind *kind, const MesoSweepInstance *sweep, uint32_t row)
{
    uint32_t last = kind->division_count - 2;
    float from = row > 0 ? meso_sweep_place(kind, sweep, row) : 0;
    float to = row < last ? meso_sweep_place(kind, sweep, row + 1) : 1;
    return (Stride){from, to, (to - from) / (row == 0 || row == last ? 1 - MESO_END_NEARER : 1)};
}

/* Of the steps in a row, on average of a quarter and three, what it has too few: below 1 it has enough. */
static float lack_of(const Wants *wants, const float *steps, Stride row)
{
    float quarter = (row.to - row.from) / 4;
    return row.step * (steps_near(wants, steps, row.from + quarter) + steps_near(wants, steps, row.to - quarter)) / 2;
}

/* Whether the ring between two rows moves out of the bend by no more than it may. */
static bool is_moved_little(const Wants *wants, Stride before, Stride row)
{
    float lack = steps_near(wants, wants->edges, row.from);
    return (before.to - before.from) * (row.to - row.from) * lack * lack <= ENOUGH * ENOUGH;
}

/*
 * Chooses diagonals for a sweep with so many rings: of the rows that have theirs together, those that the worst of them
 * needs. Returns whether it has all steps that it wants then.
 */
static bool are_enough(const Work *work, const MesoSweptKind *kind, MesoSweepInstance *sweep)
{
    const MesoColumnSample *sample = &work->sample;
    const Wants *wants = &work->wants;
    uint32_t rows = kind->division_count - 1, joints = sample->kind.joint_count;
    uint32_t parts = meso_sweep_lean_parts(joints), parts_used = rows < parts ? rows : parts;
    float most[MESO_MOST_PAIRS][2];
    bool leans[MESO_MOST_PAIRS], enough = true;
    Stride before = {0, 0, 0};
    memset(sweep->steps.leans, 0, sizeof sweep->steps.leans);
    for (uint32_t part = 0, row = 0; part < parts_used; part++) {
        memset(most, 0, sizeof most);
        uint32_t first = row;
        for (; row < rows && (rows <= parts ? row : (uint32_t)((uint64_t)row * parts / rows)) == part; row++) {
            Stride here = stride_of(kind, sweep, row);
            enough = enough && lack_of(wants, wants->edges, here) <= ENOUGH && is_moved_little(wants, before, here);
            before = here;
            for (uint32_t p = 0; p < sample->pair_count; p++)
                for (uint32_t k = 0; k < 2; k++)
                    most[p][k] = larger(most[p][k], lack_of(wants, work->diagonals[p][k], here));
        }
        for (uint32_t p = 0; p < sample->pair_count; p++) {
            leans[p] = most[p][1] < most[p][0];
            enough = enough && most[p][leans[p]] <= ENOUGH;
        }
        for (uint32_t joint = 0; joint < joints; joint++) {
            uint32_t bit = meso_sweep_lean_bit(joint, joints, first, rows);
            if (leans[pair_of(sample, joint)])
                sweep->steps.leans[bit / 64] |= (uint64_t)1 << bit % 64;
        }
    }
    return enough;
}

/*
 * Steps that are as many at each place as that needs, and the pace that puts them there: v where an eighth of them is
 * reached, and so on.
 */
static float pace_steps(const Wants *wants, uint16_t pace[MESO_PACE_PARTS - 1])
{
    uint32_t n = wants->intervals;
    float sums[MOST_INTERVALS + 1] = {0};
    for (uint32_t i = 1; i <= n; i++)
        sums[i] = sums[i - 1] + (wants->steps[i - 1] + wants->steps[i]) / (float)(2 * n);
    for (uint32_t k = 1, i = 0; k < MESO_PACE_PARTS && sums[n] > 0; k++) {
        float wanted = sums[n] * (float)k / MESO_PACE_PARTS;
        while (sums[i + 1] < wanted)
            i++;
        float v = ((float)i + (wanted - sums[i]) / (sums[i + 1] - sums[i])) / (float)n;
        pace[k - 1] = (uint16_t)fminf(fmaxf(65536 * v, 1), 65535);
    }
    return sums[n];
}

/* Whether one step will do, which nothing is moved for. */
static bool is_straight(const Wants *wants)
{
    bool straight = true;
    for (uint32_t i = 0; i <= wants->intervals && straight; i++)
        straight = wants->steps[i] <= 1;
    return straight;
}

/* What columns are off at each of the blends. */
typedef struct Budget {
    float off[MESO_KIND_BLENDS];
} Budget;

/* Sections are blended by w (scene.h). */
static void spread_budget(Wants *wants, const Budget *budget)
{
    for (uint32_t i = 0; i <= wants->intervals; i++) {
        float v = (float)i / (float)wants->intervals, place = v * v * (3 - 2 * v) * (MESO_KIND_BLENDS - 1);
        uint32_t k = place < MESO_KIND_BLENDS - 1 ? (uint32_t)place : MESO_KIND_BLENDS - 2;
        wants->off[i] = budget->off[k] + (place - (float)k) * (budget->off[k + 1] - budget->off[k]);
    }
}

static uint32_t intervals_of(const MesoSweptKind *kind, const MesoSweepInstance *sweep)
{
    float wanted = INTERVALS_A_RADIAN * (fabsf(kind->turn) + fabsf(sweep->twist));
    if (sweep->mitre >= MESO_CREASED)
        wanted = fmaxf(wanted, CREASED_INTERVALS);
    return wanted < LEAST_INTERVALS ? LEAST_INTERVALS : wanted > MOST_INTERVALS ? MOST_INTERVALS : (uint32_t)wanted;
}

/* Steps, and the sweep's pace and leans. */
static float tube_steps(Work *work, MesoSweepInstance *sweep, const Budget *budget, float tolerance)
{
    MesoColumnSample *sample = &work->sample;
    Wants *wants = &work->wants;
    wants->intervals = intervals_of(&sample->kind, sweep);
    const MesoSweepGrid grid = {.column_count = sample->kind.column_count, .ring_count = wants->intervals + 1,
                                .bare = true};
    sample->kind.division_count = wants->intervals + 1;
    sample->scene.columns = sample->columns;
    meso_sweep_grid(&sample->scene, &sample->kind, sweep, &grid, work->vertices);
    spread_budget(wants, budget);
    find_steps(work, tolerance, BOWED);
    MesoSweptKind kind = {.division_count = 2};
    if (is_straight(wants)) {       /* where nothing is moved chords are off by all that they are */
        find_steps(work, tolerance, 1);
        if (is_straight(wants) && are_enough(work, &kind, sweep))
            return 1;
        find_steps(work, tolerance, BOWED);
    }
    float steps = fmaxf(2, pace_steps(wants, sweep->steps.pace) + 2 * MESO_END_NEARER);
    uint32_t rings = (uint32_t)ceilf(fminf(steps, MESO_MOST_DIVISIONS)) + 1;
    kind.bowed = true;
    for (kind.division_count = rings; kind.division_count < rings + 4 + rings / 2; kind.division_count++)
        if (are_enough(work, &kind, sweep))
            break;
    return (float)(kind.division_count - 1);
}

/* Scene units of one unit of the profiles, at most. */
static float scale_of(const MesoScene *scene, const MesoSweepInstance *sweep)
{
    float scale = scene->section_scale * fmaxf(sweep->size[0], sweep->size[1]);
    return scene->deform == MESO_SWEEP_CURVES ? scale : scale * meso_cell_stretch(&scene->cages[sweep->cage]).most;
}

/* (1 - v^4) r over a rise of h v: the second derivative 12 r lies across the tangent by h / |(4 r, h)| at the tip. */
static float cap_steps(const MesoColumnSample *sample, const MesoSweepInstance *cap, float tolerance)
{
    float scale = scale_of(&sample->scene, cap), r = scale * sample->radius, h = scale * MESO_CAP_RISE;
    float tangent = sqrtf(16 * r * r + h * h), part = tangent > 0 ? h / tangent : 0;
    return fmaxf(LEAST_CAP_STEPS, sqrtf(12 * r * part / (8 * tolerance)));
}

/* Rounded up to one of few numbers, so that there are few kinds. */
static uint16_t rings_for(uint32_t least, float steps)
{
    if (!(steps < MESO_MOST_DIVISIONS - 1))
        return MESO_MOST_DIVISIONS;
    uint32_t whole = steps > (float)(least - 1) ? (uint32_t)ceilf(steps) : least - 1, grain = 1;
    while (whole > 48 * grain)
        grain *= 2;
    whole = (whole + grain - 1) / grain * grain;
    return (uint16_t)(whole + 1 < MESO_MOST_DIVISIONS ? whole + 1 : MESO_MOST_DIVISIONS);
}

static Budget budget_of(const Chooser *c, uint32_t kind, const MesoSweepInstance *sweep)
{
    float scale = scale_of(c->scene, sweep), part = c->scene->kinds[kind].cap ? CAP_OFF_PART : OFF_PART;
    Budget budget;
    for (uint32_t k = 0; k < MESO_KIND_BLENDS; k++)
        budget.off[k] = fminf((1 - LEAST_LEFT) * c->tolerance, part * scale * c->origins[kind].off[k]);
    return budget;
}

static void choose_range(void *context, uint64_t begin, uint64_t end)
{
    Chooser *c = context;
    const MesoSweptKind *kinds = c->scene->kinds;
    Work *work = malloc(sizeof *work);
    if (!work) {
        atomic_store(&c->failed, true);
        return;
    }
    uint32_t kind = meso_scene_kind(c->scene, (uint32_t)begin);
    work->sample = meso_column_sample(c->scene, &kinds[kind]);
    for (uint64_t i = begin; i < end; i++) {
        if (i >= (uint64_t)kinds[kind].instance_begin + kinds[kind].instance_count) {
            while (i >= (uint64_t)kinds[kind].instance_begin + kinds[kind].instance_count)
                kind++;
            work->sample = meso_column_sample(c->scene, &kinds[kind]);
        }
        MesoSweepInstance *sweep = &c->scene->sweeps[i];
        const uint32_t *absent = kinds[kind].absent;
        uint32_t least = absent[0] || absent[1] || absent[2] ? 3 : 2;
        const Budget budget = budget_of(c, kind, sweep);
        float steps = kinds[kind].cap ? cap_steps(&work->sample, sweep, c->tolerance - budget.off[0])
                                      : tube_steps(work, sweep, &budget, c->tolerance);
        c->rings[i] = rings_for(least, steps);
    }
    free(work);
}

/* ---- kinds of equal steps ---- */

typedef struct Split {
    MesoSweptKind *kinds;
    MesoKindOrigin *origins;
    MesoSweepInstance *sweeps;
    uint32_t kind_count;
} Split;

/* `counts` [MESO_MOST_DIVISIONS + 1] is all 0 before and after; `split` NULL only counts the kinds. */
static uint32_t split_kind(Split *split, const MesoScene *scene, const MesoKindOrigin *origins, uint32_t k,
                           const uint16_t *rings, uint32_t *counts)
{
    const MesoSweptKind *kind = &scene->kinds[k];
    uint32_t parts = 0, end = kind->instance_begin;
    for (uint32_t i = 0; i < kind->instance_count; i++)
        parts += counts[rings[kind->instance_begin + i]]++ == 0;
    for (uint32_t r = 0; r <= MESO_MOST_DIVISIONS && split; r++) {
        if (!counts[r])
            continue;
        MesoSweptKind *part = &split->kinds[split->kind_count];
        *part = *kind;
        part->division_count = r;
        part->bowed = !kind->cap;
        part->instance_begin = end;
        part->instance_count = counts[r];
        split->origins[split->kind_count++] = origins[k];
        counts[r] = end;
        end += part->instance_count;
    }
    for (uint32_t i = kind->instance_begin; i < kind->instance_begin + kind->instance_count && split; i++)
        split->sweeps[counts[rings[i]]++] = scene->sweeps[i];
    for (uint32_t i = 0; i < kind->instance_count; i++)
        counts[rings[kind->instance_begin + i]] = 0;
    return parts;
}

static MesoStatus split_kinds(MesoScene *scene, MesoKindOrigin **origins, MesoArena *arena, const uint16_t *rings,
                              uint32_t *counts, MesoError *error)
{
    uint32_t kind_count = 0;
    for (uint32_t k = 0; k < scene->kind_count; k++)
        kind_count += split_kind(NULL, scene, *origins, k, rings, counts);
    Split split = {MESO_NEW(arena, MesoSweptKind, kind_count, error),
                   MESO_NEW(arena, MesoKindOrigin, kind_count, error),
                   MESO_NEW(arena, MesoSweepInstance, scene->sweep_count, error), 0};
    if (!split.kinds || !split.origins || !split.sweeps)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < scene->kind_count; k++)
        split_kind(&split, scene, *origins, k, rings, counts);
    scene->kinds = split.kinds;
    scene->kind_count = kind_count;
    scene->sweeps = split.sweeps;
    *origins = split.origins;
    return MESO_OK;
}

MesoStatus meso_scene_choose_steps(MesoScene *scene, MesoKindOrigin **origins, MesoArena *arena, float tolerance,
                                   uint32_t thread_count, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    Chooser chooser = {scene, *origins, tolerance, MESO_NEW(&scratch, uint16_t, scene->sweep_count, error), false};
    uint32_t *counts = MESO_NEW(&scratch, uint32_t, MESO_MOST_DIVISIONS + 1, error);
    MesoStatus status = MESO_ERR_MEMORY;
    if (chooser.rings && counts) {
        meso_parallel_for(thread_count, scene->sweep_count, SWEEPS_A_RANGE, choose_range, &chooser);
        status = atomic_load(&chooser.failed) ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for sweeps")
                                              : split_kinds(scene, origins, arena, chooser.rings, counts, error);
    }
    meso_arena_release(&scratch);
    return status;
}
