/*
 * A curve cut into n equal steps of its parameter lies within |C''| / (8 n n) of its chords, where only the part of
 * C'' across the curve counts; and a quad whose corners are D = P11 - P10 - P01 + P00 off a parallelogram, within
 * |D| / 4 of its triangles, where only the part across the quad counts, and D is proportional to 1 / n.
 */
#include "libcore/tiling/strand/steps.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/sweep.h"

enum { SWEEPS_A_RANGE = 512, LEAST_INTERVALS = 16, MOST_INTERVALS = 256, LEAST_CAP_STEPS = 3 };

/* Pairs of columns: the outermost, and all around where the shape changes. */
enum { OUTER_PAIRS = 5, MORE_PAIRS = 27, MOST_PAIRS = OUTER_PAIRS + MORE_PAIRS };

/*
 * What columns are off counts against the tolerance of the steps but for a small part, as both are seldom worst at one
 * place, and leaves so much of it. It counts less for caps, which bend most at the tip, where the columns meet.
 */
static const float OFF_PART = 1.0f, CAP_OFF_PART = 0.75f, LEAST_LEFT = 0.3f;

/* Differences at a few places miss the worst one. */
static const float MARGIN = 1.18f;

/* Of what a chord is off, where its ends are moved out of the bend (scene.h). */
static const float BOWED = 0.5f;

/* Of a shape's size: less is none. */
static const float SMALL_CHANGE = 0.02f;

/* What a radian of turn takes in intervals to be seen. */
static const float INTERVALS_A_RADIAN = 5;

/* Some neighbouring columns of a kind, two by two, as a kind of their own. */
typedef struct Sample {
    MesoSweepColumn columns[2 * MOST_PAIRS];
    uint32_t firsts[MOST_PAIRS];    /* of the kind, of each pair */
    bool sharp[2 * MOST_PAIRS];     /* a corner, where a column that is off is seen whichever way */
    MesoSweptKind kind;
    MesoScene scene;
    float radius;       /* of a cap */
} Sample;

typedef struct Chooser {
    const MesoScene *scene;
    const MesoKindOrigin *origins;
    float tolerance;
    uint16_t *rings;    /* [sweep_count] */
    atomic_bool failed; /* memory is out */
} Chooser;

/* ---- what to look at ---- */

/* The column that one joins on rings between the ends; MESO_NO_INDEX: none. */
static uint32_t next_inner(const MesoSweptKind *kind, const MesoSweepColumn *columns, uint32_t c)
{
    if (columns[c].absent & MESO_ABSENT_BETWEEN)
        return MESO_NO_INDEX;
    while (c + 1 < kind->column_count && columns[c].joins_next)
        if (!(columns[++c].absent & MESO_ABSENT_BETWEEN))
            return c;
    return MESO_NO_INDEX;
}

/* How far a column reaches in one of four directions, or how far it is to the next one. */
static float worth(const MesoSweepColumn *column, const MesoSweepColumn *next, uint32_t what)
{
    if (what == 4)
        return fmaxf(meso_vec2_length(meso_vec2_sub(next->start, column->start)),
                     meso_vec2_length(meso_vec2_sub(next->end, column->end)));
    float sign = what & 1 ? -1 : 1;
    return sign * (what & 2 ? column->start.y + column->end.y : column->start.x + column->end.x);
}

static bool changes(const MesoSweptKind *kind, const MesoSweepColumn *columns)
{
    float change = 0, size = 0;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        change = fmaxf(change, meso_vec2_length(meso_vec2_sub(columns[c].end, columns[c].start)));
        size = fmaxf(size, meso_vec2_length(columns[c].start));
    }
    return kind->turn != 0 || change > SMALL_CHANGE * size;
}

/* Of the two columns at a corner, one does not join the other; at the seam it takes their normals to tell. */
static bool is_sharp(const MesoSweptKind *kind, const MesoSweepColumn *columns, uint32_t c)
{
    const MesoSweepColumn *first = columns, *last = columns + kind->column_count - 1;
    if (c > 0 && c + 1 < kind->column_count)
        return !columns[c].joins_next || !columns[c - 1].joins_next;
    float cross = meso_vec2_cross(first->start_normal, last->start_normal);
    float dot = first->start_normal.x * last->start_normal.x + first->start_normal.y * last->start_normal.y;
    return !(fabsf(cross) < SMALL_CHANGE * dot);
}

static void add_pair(Sample *sample, const MesoSweptKind *kind, const MesoSweepColumn *columns, uint32_t first,
                     uint32_t second)
{
    const uint32_t pair[2] = {first, second};
    for (uint32_t c = 0; c < sample->kind.column_count; c += 2)
        if (sample->firsts[c / 2] == first)
            return;     /* it is there */
    sample->firsts[sample->kind.column_count / 2] = first;
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t to = sample->kind.column_count++;
        sample->columns[to] = columns[pair[i]];
        sample->columns[to].absent = 0;
        sample->sharp[to] = is_sharp(kind, columns, pair[i]);
    }
}

static void add_outermost(Sample *sample, const MesoSweptKind *kind, const MesoSweepColumn *columns, uint32_t what)
{
    uint32_t best = MESO_NO_INDEX, best_next = MESO_NO_INDEX;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        uint32_t next = next_inner(kind, columns, c);
        if (next != MESO_NO_INDEX && (best == MESO_NO_INDEX || worth(&columns[c], &columns[next], what) >
                                                                   worth(&columns[best], &columns[best_next], what))) {
            best = c;
            best_next = next;
        }
    }
    if (best != MESO_NO_INDEX)
        add_pair(sample, kind, columns, best, best_next);
}

static Sample make_sample(const MesoScene *scene, const MesoSweptKind *kind)
{
    Sample sample = {.kind = *kind, .scene = {.section_scale = scene->section_scale, .frame_rule = scene->frame_rule,
                                                 .deform = scene->deform, .cages = scene->cages}};
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    sample.kind.column_begin = sample.kind.column_count = 0;
    memset(sample.kind.absent, 0, sizeof sample.kind.absent);
    for (uint32_t what = 0; what < OUTER_PAIRS; what++)
        add_outermost(&sample, kind, columns, what);
    uint32_t stride = 1 + (kind->column_count - kind->absent[2]) / MORE_PAIRS, passed = 0;
    bool more = scene->deform == MESO_SWEEP_SHAPE || changes(kind, columns);
    for (uint32_t c = 0; c < kind->column_count && more; c++) {
        uint32_t next = next_inner(kind, columns, c);
        if (next != MESO_NO_INDEX && passed++ % stride == 0)
            add_pair(&sample, kind, columns, c, next);
    }
    for (uint32_t c = 0; c < kind->column_count; c++)
        sample.radius = fmaxf(sample.radius, meso_vec2_length(columns[c].start));
    return sample;
}

/* ---- how many it takes ---- */

/* How far off a bend is seen: across the column at a corner, elsewhere across the surface. */
static float seen(MesoVec3 bend, MesoVec3 along, MesoVec3 normal, bool sharp)
{
    float square = meso_vec3_dot(along, along);
    if (!sharp)
        return fabsf(meso_vec3_dot(bend, normal));
    return meso_vec3_length(square > 0 ? meso_vec3_mad(bend, -meso_vec3_dot(bend, along) / square, along) : bend);
}

static MesoVec3 second_difference(const MesoMeshVertex *v, uint32_t stride)
{
    return meso_vec3_add(meso_vec3_mad(v[0].position, -2, v[stride].position), v[2 * stride].position);
}

/*
 * At each of the places along a sweep: how much columns bend, by second differences, and quads are warped, by D; and
 * what columns leave of the tolerance.
 */
typedef struct Wants {
    uint32_t intervals;
    float bend[MOST_INTERVALS + 1];
    float warp[MOST_INTERVALS + 1];
    float left[MOST_INTERVALS + 1];
} Wants;

/*
 * At the ends, where there is no second difference, it goes on as it does beside them, half the way: the first step's
 * own middle is not nearer to the end but where there are many.
 */
static void add_bend(Wants *wants, const MesoMeshVertex *column, uint32_t stride, bool sharp)
{
    uint32_t n = wants->intervals;
    MesoVec3 before = {0, 0, 0};
    for (uint32_t i = 1; i < n; i++) {
        const MesoMeshVertex *v = column + (i - 1) * stride;
        MesoVec3 bend = second_difference(v, stride), along = meso_vec3_sub(v[2 * stride].position, v[0].position);
        MesoVec3 step = meso_vec3_sub(bend, before);
        wants->bend[i] = fmaxf(wants->bend[i], seen(bend, along, v[stride].normal, sharp));
        if (i == 2)
            wants->bend[0] = fmaxf(wants->bend[0],
                                   seen(meso_vec3_mad(before, -0.5f, step), along, column->normal, sharp));
        if (i + 1 == n)
            wants->bend[n] = fmaxf(wants->bend[n],
                                   seen(meso_vec3_mad(bend, 0.5f, step), along, v[2 * stride].normal, sharp));
        before = bend;
    }
}

static void add_warp(Wants *wants, const MesoMeshVertex *pair, uint32_t stride)
{
    for (uint32_t i = 0; i < wants->intervals; i++) {
        const MesoMeshVertex *v = pair + i * stride, *next = v + stride;
        MesoVec3 around = meso_vec3_sub(v[1].position, v[0].position);
        MesoVec3 beyond = meso_vec3_sub(next[1].position, next[0].position);
        MesoVec3 along = meso_vec3_sub(next[0].position, v[0].position);
        MesoVec3 normal = meso_vec3_direction(meso_vec3_cross(around, along), (MesoVec3){0, 0, 0});
        float warp = fabsf(meso_vec3_dot(meso_vec3_sub(beyond, around), normal));
        wants->warp[i] = fmaxf(wants->warp[i], warp);
        wants->warp[i + 1] = fmaxf(wants->warp[i + 1], warp);
    }
}

/* What is wanted somewhere. */
typedef struct Want {
    float bend, warp, left;
} Want;

static Want want_at(const Wants *wants, float v)
{
    float place = v * (float)wants->intervals;
    uint32_t i = (uint32_t)place < wants->intervals ? (uint32_t)place : wants->intervals - 1;
    float t = place - (float)i;
    return (Want){wants->bend[i] + t * (wants->bend[i + 1] - wants->bend[i]),
                  wants->warp[i] + t * (wants->warp[i + 1] - wants->warp[i]),
                  wants->left[i] + t * (wants->left[i + 1] - wants->left[i])};
}

/* Steps so that the errors, of which one falls with their number and one with its square, add up to what is left;
 * `part` of what chords are off counts. */
static float steps_for(Want want, float part)
{
    float e = part * want.bend, f = want.warp;
    return (f + sqrtf(f * f + 4 * want.left * e)) / (2 * want.left);
}

static float steps_at(const Wants *wants, uint32_t i, float part)
{
    return steps_for((Want){wants->bend[i], wants->warp[i], wants->left[i]}, part);
}

/* How far a ring is moved out of the bend, by the steps before and behind it. */
static float shift_at(const Wants *wants, float before, float here, float next)
{
    return want_at(wants, here).bend * ((here - before) * (here - before) + (next - here) * (next - here)) / 4;
}

/* Whether a sweep with so many rings is off by no more than is left: the middle of each step, whose ends have moved. */
static bool are_enough(const Wants *wants, const MesoSweptKind *kind, const MesoSweepInstance *sweep)
{
    uint32_t last = kind->division_count - 1;
    float from = 0, to = meso_sweep_place(kind, sweep, 1), shift = 0;
    bool enough = true;
    for (uint32_t r = 1; r <= last && enough; r++) {
        float next = r < last ? meso_sweep_place(kind, sweep, r + 1) : 1, step = to - from;
        float shift_ahead = r < last ? shift_at(wants, from, to, next) : 0;
        Want want = want_at(wants, (from + to) / 2);
        float off = want.bend * step * step - (shift + shift_ahead) / 2 + want.warp * step;
        enough = off <= want.left && shift_ahead <= want.left;
        from = to;
        to = next;
        shift = shift_ahead;
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
    float sums[MOST_INTERVALS + 1] = {0}, before = steps_at(wants, 0, BOWED);
    for (uint32_t i = 1; i <= n; i++) {
        float here = steps_at(wants, i, BOWED);
        sums[i] = sums[i - 1] + (before + here) / (float)(2 * n);
        before = here;
    }
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
        straight = steps_at(wants, i, 1) <= 1;
    return straight;
}

/* Of a tolerance that columns use, at one of the blends. */
typedef struct Budget {
    float left[MESO_KIND_BLENDS];
} Budget;

/* To what one step from end to end would be off, with a margin. Sections are blended by w (scene.h). */
static void scale_wants(Wants *wants, const Budget *budget)
{
    float m = (float)wants->intervals;
    for (uint32_t i = 0; i <= wants->intervals; i++) {
        float v = (float)i / m, place = v * v * (3 - 2 * v) * (MESO_KIND_BLENDS - 1);
        uint32_t k = place < MESO_KIND_BLENDS - 1 ? (uint32_t)place : MESO_KIND_BLENDS - 2;
        wants->bend[i] *= MARGIN * m * m / 8;
        wants->warp[i] *= MARGIN * m / 4;
        wants->left[i] = budget->left[k] + (place - (float)k) * (budget->left[k + 1] - budget->left[k]);
    }
}

static uint32_t intervals_of(const MesoSweptKind *kind, const MesoSweepInstance *sweep)
{
    float wanted = INTERVALS_A_RADIAN * (fabsf(kind->turn) + fabsf(sweep->twist));
    return wanted < LEAST_INTERVALS ? LEAST_INTERVALS : wanted > MOST_INTERVALS ? MOST_INTERVALS : (uint32_t)wanted;
}

/* What the steps of one range of sweeps are found with. */
typedef struct Work {
    Sample sample;
    MesoMeshVertex vertices[(MOST_INTERVALS + 1) * 2 * MOST_PAIRS];
} Work;

/* Steps, and the sweep's pace. */
static float tube_steps(Work *work, MesoSweepInstance *sweep, const Budget *budget)
{
    Sample *sample = &work->sample;
    MesoMeshVertex *vertices = work->vertices;
    uint32_t stride = sample->kind.column_count;
    Wants wants = {.intervals = intervals_of(&sample->kind, sweep)};
    sample->kind.division_count = wants.intervals + 1;
    sample->scene.columns = sample->columns;
    meso_sweep_vertices(&sample->scene, &sample->kind, sweep, vertices);
    for (uint32_t c = 0; c < stride; c++)
        add_bend(&wants, vertices + c, stride, sample->sharp[c]);
    for (uint32_t c = 0; c < stride; c += 2)
        add_warp(&wants, vertices + c, stride);
    scale_wants(&wants, budget);
    if (is_straight(&wants))
        return 1;
    float steps = fmaxf(2, pace_steps(&wants, sweep->pace) + 2 * MESO_END_NEARER);
    MesoSweptKind kind = {.bowed = true};
    uint32_t rings = (uint32_t)ceilf(fminf(steps, MESO_MOST_DIVISIONS)) + 1;
    for (kind.division_count = rings; kind.division_count < rings + 4 + rings / 4; kind.division_count++)
        if (are_enough(&wants, &kind, sweep))
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
static float cap_steps(const Sample *sample, const MesoSweepInstance *cap, float tolerance)
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
        budget.left[k] = fmaxf(LEAST_LEFT * c->tolerance, c->tolerance - part * scale * c->origins[kind].off[k]);
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
    work->sample = make_sample(c->scene, &kinds[kind]);
    for (uint64_t i = begin; i < end; i++) {
        if (i >= (uint64_t)kinds[kind].instance_begin + kinds[kind].instance_count) {
            while (i >= (uint64_t)kinds[kind].instance_begin + kinds[kind].instance_count)
                kind++;
            work->sample = make_sample(c->scene, &kinds[kind]);
        }
        MesoSweepInstance *sweep = &c->scene->sweeps[i];
        const uint32_t *absent = kinds[kind].absent;
        uint32_t least = absent[0] || absent[1] || absent[2] ? 3 : 2;
        const Budget budget = budget_of(c, kind, sweep);
        float steps = kinds[kind].cap ? cap_steps(&work->sample, sweep, budget.left[0])
                                      : tube_steps(work, sweep, &budget);
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
