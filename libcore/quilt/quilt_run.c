/* A quilt from the first patch to the last. */
#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/quilt/quilt_work.h"
#include "libcore/quilt/whole_roots.h"

/* Margins of a patch are made tighter by steps where its seed is not covered. */
static const float TIGHTNESS[] = {1, 0.5f, 0.25f, 0.1f};
enum { TIGHTNESS_COUNT = sizeof TIGHTNESS / sizeof *TIGHTNESS };

/* A voxel of the field is half an edge of the swatch wide, but there are so many along its longer side. */
#define VOXELS_LEAST 48
#define VOXELS_MOST 128

/*
 * How far around its seed a patch looks for what is not done, in sides of the swatch, to have its middle there: a
 * quarter fewer patches, and so fewer seams. Not so where elements are whole, which are matched by many neighbours
 * alone, nor where the swatch is periodic: the more of it lies on the older quilt, the more often it just goes on.
 */
#define SEED_REACH 0.2f

/*
 * Stripes fit a surface where they are off by less, of their distances: no more than patches give way to each other.
 * Where they are off by hardly anything, as on a plane, patches meet without them.
 */
#define STRAIN_MOST 0.09
#define STRAIN_LEAST 0.005

/* Triangles that are looked at for seeds of one round. */
enum { SEED_TRIES = 24 };

/* What is under a chart reaches out of it by so many edges of the swatch, or reaches of its whole elements. */
#define OUT_EDGES 4.0f
#define OUT_WHOLES 2.0f

typedef struct Front {
    uint32_t *triangles;    /* [count] not done, next to what is; in the order in which they came */
    float *constraints;     /* [count] share of done triangles around them */
    uint32_t count;
    uint8_t *listed;        /* [triangle_count] */
    uint8_t *seen;          /* [triangle_count] 0 between seeds */
    uint32_t *around;       /* [triangle_count] */
    uint32_t next_bare;     /* triangles below it are done */
    uint32_t done_count;
} Front;

/* Corners of triangles around, by vertex: done triangles there count for the seed. */
static uint32_t count_done_around(const MesoQuiltWork *work, uint32_t triangle, uint32_t *all)
{
    uint32_t done = 0;
    *all = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoFan fan = meso_fan_first(work->base, work->base->corners[3 * triangle + k]);
        uint32_t first = fan.corner;
        do {
            done += work->covers[fan.corner / 3] == MESO_COVER_DONE;
            ++*all;
        } while (meso_fan_next(work->base, &fan) && fan.corner != first);
    }
    return done;
}

/* Lists what lies next to the triangles of a patch. */
static void extend_front(Front *front, const MesoQuiltWork *work, const MesoChart *chart)
{
    for (uint32_t i = 0; i < chart->triangle_count; i++) {
        uint32_t triangle = chart->triangles[i];
        if (work->covers[triangle] != MESO_COVER_DONE)
            continue;
        if (front->listed[triangle] != 2) {
            front->listed[triangle] = 2;
            front->done_count++;
        }
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t across = work->base->twins[3 * triangle + k];
            if (across != MESO_NO_INDEX && work->covers[across / 3] != MESO_COVER_DONE && !front->listed[across / 3]) {
                front->listed[across / 3] = 1;
                front->triangles[front->count++] = across / 3;
            }
        }
    }
}

typedef struct Seed {
    uint32_t triangle;
    float constraint;   /* share of what is done around it */
} Seed;

static MesoVec3 centre_of(const MesoTriangulation *base, uint32_t triangle)
{
    const uint32_t *corners = &base->corners[3 * (size_t)triangle];
    MesoVec3 sum = meso_vec3_add(base->positions[corners[0]], base->positions[corners[1]]);
    return meso_vec3_scale(meso_vec3_add(sum, base->positions[corners[2]]), 1.0f / 3);
}

static float square_between(MesoVec3 a, MesoVec3 b)
{
    MesoVec3 d = meso_vec3_sub(a, b);
    return meso_vec3_dot(d, d);
}

/* What is not done and hangs together with a seed, no farther from it than the patch looks; to front->around. */
static uint32_t look_around(Front *front, const MesoQuiltWork *work, uint32_t seed)
{
    const MesoTriangulation *base = work->base;
    MesoVec3 middle = centre_of(base, seed);
    uint32_t count = 0;
    front->around[count++] = seed;
    front->seen[seed] = 1;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t across = base->twins[3 * (size_t)front->around[i] + k], triangle = across / 3;
            if (across == MESO_NO_INDEX || work->covers[triangle] == MESO_COVER_DONE || front->seen[triangle] ||
                square_between(centre_of(base, triangle), middle) > work->seed_reach * work->seed_reach)
                continue;
            front->seen[triangle] = 1;
            front->around[count++] = triangle;
        }
    for (uint32_t i = 0; i < count; i++)
        front->seen[front->around[i]] = 0;
    return count;
}

/* The triangle in the middle of what is not done around a seed: nearest to the mean, by area. */
static uint32_t move_in(Front *front, const MesoQuiltWork *work, uint32_t seed)
{
    const MesoTriangulation *base = work->base;
    uint32_t count = look_around(front, work, seed), best = seed;
    MesoVec3 sum = {0, 0, 0};
    float area = 0, least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *corners = &base->corners[3 * (size_t)front->around[i]];
        MesoVec3 a = base->positions[corners[0]];
        float weight = meso_vec3_length(meso_vec3_cross(meso_vec3_sub(base->positions[corners[1]], a),
                                                        meso_vec3_sub(base->positions[corners[2]], a)));
        sum = meso_vec3_mad(sum, weight, centre_of(base, front->around[i]));
        area += weight;
    }
    for (uint32_t i = 0; i < count && area > 0; i++) {
        float square = square_between(centre_of(base, front->around[i]), meso_vec3_scale(sum, 1 / area));
        if (square < least) {
            least = square;
            best = front->around[i];
        }
    }
    return best;
}

/* Whether a triangle is so far from all seeds, but for `less`. */
static bool is_apart(const MesoQuiltWork *work, const Seed *seeds, uint32_t count, uint32_t triangle, float less)
{
    float apart = work->seeds_apart - less;
    MesoVec3 centre = centre_of(work->base, triangle);
    for (uint32_t i = 0; i < count; i++)
        if (!(square_between(centre, centre_of(work->base, seeds[i].triangle)) > apart * apart))
            return false;
    return true;
}

/* Drops what is done, and measures what is not. */
static void measure_front(Front *front, const MesoQuiltWork *work)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < front->count; i++) {
        uint32_t triangle = front->triangles[i], all;
        if (work->covers[triangle] == MESO_COVER_DONE)
            continue;
        uint32_t done = count_done_around(work, triangle, &all);
        front->constraints[kept] = (float)done / (float)all;
        front->triangles[kept++] = triangle;
    }
    front->count = kept;
}

/* The most constrained triangle of those that may be far enough from the seeds before; it does not come again. */
static Seed take_constrained(Front *front, const MesoQuiltWork *work, const Seed *seeds, uint32_t count)
{
    Seed best = {MESO_NO_INDEX, -1};
    uint32_t at = 0;
    for (uint32_t i = 0; i < front->count; i++)
        if (front->constraints[i] > best.constraint &&
            is_apart(work, seeds, count, front->triangles[i], work->seed_reach)) {
            best = (Seed){front->triangles[i], front->constraints[i]};
            at = i;
        }
    if (best.triangle != MESO_NO_INDEX)
        front->constraints[at] = -1;
    return best;
}

/*
 * In the middle of what is not done next to the most constrained triangle: that with the largest share of done ones
 * around it, then the oldest; and some more, each next to the most constrained one from which it comes to lie so far
 * from those before it that their charts cannot touch. None at the end.
 */
static uint32_t next_seeds(Seed seeds[MESO_QUILT_PATCHES], Front *front, const MesoQuiltWork *work)
{
    uint32_t count = 0;
    measure_front(front, work);
    for (int tries = 0; count < MESO_QUILT_PATCHES && tries < SEED_TRIES; tries++) {
        Seed seed = take_constrained(front, work, seeds, count);
        if (seed.triangle == MESO_NO_INDEX)
            break;
        seed.triangle = move_in(front, work, seed.triangle);
        if (is_apart(work, seeds, count, seed.triangle, 0))
            seeds[count++] = seed;
    }
    if (count)
        return count;
    while (front->next_bare < work->base->triangle_count && work->covers[front->next_bare] == MESO_COVER_DONE)
        front->next_bare++;
    if (front->next_bare == work->base->triangle_count)
        return 0;
    seeds[0] = (Seed){front->next_bare, 0};
    return 1;
}

/* ---- rounds ---- */

/* Patches that are made at the same time, and all that each needs. */
typedef struct Round {
    MesoQuiltWork *work;
    uint32_t count;
    MesoQuiltPatch patches[MESO_QUILT_PATCHES];
    MesoQuiltTally tallies[MESO_QUILT_PATCHES];
    MesoChartMaker makers[MESO_QUILT_PATCHES];
    MesoArena arenas[MESO_QUILT_PATCHES];
    MesoStatus statuses[MESO_QUILT_PATCHES];
    MesoError errors[MESO_QUILT_PATCHES];
} Round;

static void begin_patch(Round *round, uint32_t i, uint32_t seed, float tightness)
{
    round->tallies[i] = (MesoQuiltTally){0};
    round->patches[i] = (MesoQuiltPatch){
        .step = {.seed = seed, .patch = round->work->tally.report.patch_count++, .maker = &round->makers[i],
                 .tally = &round->tallies[i], .tightness = tightness},
    };
}

static void prepare_range(void *context, uint64_t begin, uint64_t end)
{
    Round *round = context;
    for (uint64_t i = begin; i < end; i++) {
        round->statuses[i] = meso_quilt_prepare(&round->patches[i], round->work, &round->arenas[i], &round->errors[i]);
        meso_arena_trim(&round->arenas[i]);
        atomic_fetch_sub(&round->work->busy_patches, 1);
    }
}

/* `count` patches that have begun, each by a core as long as there are such. */
static void prepare(Round *round, uint32_t count)
{
    atomic_store(&round->work->busy_patches, count);
    meso_parallel_for(round->work->options.thread_count, count, 1, prepare_range, round);
}

static MesoStatus end_patch(Round *round, uint32_t i, bool *done, Front *front, MesoError *error)
{
    MesoArena *scratch = meso_arena_pool_lend(&round->work->pool);
    MesoStatus status = meso_quilt_commit(&round->patches[i], round->statuses[i], done, round->work, scratch,
                                          &round->errors[i]);
    meso_arena_pool_return(&round->work->pool, scratch);
    if (!status)
        extend_front(front, round->work, &round->patches[i].step.chart);
    else if (error)
        *error = round->errors[i];
    if (round->patches[i].step.beside)
        meso_arena_pool_return(&round->work->pool, round->patches[i].step.beside);
    meso_arena_clear(&round->arenas[i]);
    return status;
}

/*
 * A seed that its patch could not cover: with margins made tighter; in the end it counts as done, so that there is an
 * end.
 */
static MesoStatus insist(Round *round, uint32_t seed, Front *front, MesoError *error)
{
    MesoQuiltWork *work = round->work;
    bool done = false;
    for (int attempt = 1; attempt < TIGHTNESS_COUNT && !done; attempt++) {
        begin_patch(round, 0, seed, TIGHTNESS[attempt]);
        prepare(round, 1);
        MesoStatus status = end_patch(round, 0, &done, front, error);
        if (status)
            return status;
    }
    if (!done) {
        work->covers[seed] = MESO_COVER_DONE;
        work->tally.report.skipped_count++;
        front->done_count++;
        front->listed[seed] = 2;
    }
    return MESO_OK;
}

static MesoStatus run_round(Round *round, const Seed *seeds, Front *front, MesoError *error)
{
    bool done[MESO_QUILT_PATCHES];
    for (uint32_t i = round->count; i < MESO_QUILT_PATCHES; i++)
        meso_arena_release(&round->arenas[i]);
    for (uint32_t i = 0; i < round->count; i++)
        begin_patch(round, i, seeds[i].triangle, TIGHTNESS[0]);
    prepare(round, round->count);
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < round->count; i++) {
        MesoStatus ended = end_patch(round, i, &done[i], front, status ? NULL : error);
        status = status ? status : ended;
    }
    for (uint32_t i = 0; i < round->count && !status; i++)
        if (!done[i] && round->work->covers[seeds[i].triangle] != MESO_COVER_DONE)
            status = insist(round, seeds[i].triangle, front, error);
    return status;
}

static MesoStatus check_limits(const MesoQuiltWork *work, MesoError *error)
{
    uint64_t limit = work->options.triangle_limit;
    if (limit && work->composite.triangle_count > limit)
        return meso_fail(error, MESO_ERR_LIMIT, "the quilt has more than %llu triangles", (unsigned long long)limit);
    return MESO_OK;
}

/* Nothing of it is in use between rounds. */
static void give_scratch_back(MesoQuiltWork *work, Round *round)
{
    for (int i = 0; i < MESO_QUILT_PATCHES; i++)
        meso_arena_release(&round->arenas[i]);
    for (int i = 0; i < MESO_QUILT_ARENAS; i++)
        meso_arena_release(&work->pool.arenas[i]);
}

static MesoStatus grow(MesoQuiltWork *work, Round *round, Front *front, MesoError *error)
{
    uint32_t limit = work->options.step_limit;
    for (;;) {
        Seed seeds[MESO_QUILT_PATCHES];
        round->count = next_seeds(seeds, front, work);
        uint32_t begun = work->tally.report.patch_count;
        if (limit && round->count > limit - (begun < limit ? begun : limit))
            round->count = limit - (begun < limit ? begun : limit);
        if (!round->count)
            return MESO_OK;
        MesoStatus status = run_round(round, seeds, front, error);
        if (!status)
            status = check_limits(work, error);
        if (status)
            return status;
        if (meso_composite_wants_packing(&work->composite))
            give_scratch_back(work, round);
        meso_composite_pack(&work->composite, work->swatch);
        if (work->options.progress)
            work->options.progress(work->options.context, front->done_count, work->base->triangle_count);
    }
}

/* ---- set up ---- */

static float least(float a, float b)
{
    return a < b ? a : b;
}

static void choose_lengths(MesoQuiltWork *work)
{
    const MesoSwatch *swatch = work->swatch;
    MesoQuiltOptions *o = &work->options;
    o->height_scale = o->height_scale > 0 ? o->height_scale : o->scale;
    o->patch = o->patch > 0 ? o->patch : 0.55f;
    o->lambda = o->lambda > 0 ? o->lambda : 1;
    o->mu = o->mu > 0 ? o->mu : 1;
    o->turn_count = o->turn_count ? o->turn_count : 1;
    /* some edges of the swatch, but little of it where it is small and coarse */
    float edge = swatch->mean_edge, side = swatch->size.x < swatch->size.y ? swatch->size.x : swatch->size.y;
    work->ring = least(2 * edge, 0.05f * side);
    work->strand_margin = least(4 * edge, 0.1f * side);
    work->widening = least(5 * edge, 0.12f * side);
    bool strands = false;
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        strands |= swatch->kinds[e] == MESO_ELEMENT_STRAND;
        if (swatch->kinds[e] == MESO_ELEMENT_WHOLE && swatch->radii[e] > work->whole_margin)
            work->whole_margin = swatch->radii[e];
    }
    work->welds = strands && swatch->period.x > 0 && swatch->period.y > 0;
    work->seed_reach = strands && !work->welds ? SEED_REACH * side * o->scale : 0;
    work->chart_radius = 0.55f * sqrtf(swatch->size.x * swatch->size.x + swatch->size.y * swatch->size.y) +
                         work->whole_margin;
}

/*
 * Charts lie within their radius from their seed's middle, as the crow flies. Seeds that are so far apart have charts
 * that do not touch, nor does what is under one of them reach the other.
 */
static float distance_apart(const MesoQuiltWork *work)
{
    float out = fmaxf(OUT_EDGES * work->swatch->mean_edge, OUT_WHOLES * work->whole_margin);
    return (2 * work->chart_radius + out) * work->options.scale;
}

static float choose_voxel(const MesoSwatch *swatch)
{
    float longest = swatch->size.x > swatch->size.y ? swatch->size.x : swatch->size.y, voxel = 0.5f * swatch->mean_edge;
    voxel = voxel > longest / VOXELS_MOST ? voxel : longest / VOXELS_MOST;
    return least(voxel, longest / VOXELS_LEAST);
}

/*
 * Where strands of a swatch that is woven should lie, so that all patches agree on it. A periodic one lies where it
 * goes on without any deformation; and where stripes do not fit the surface, patches had better find out by themselves.
 */
static MesoStatus find_phases(MesoQuiltWork *work, MesoArena *scratch, MesoError *error)
{
    const MesoSwatch *swatch = work->swatch;
    const MesoQuiltOptions *o = &work->options;
    MesoWeavePitch *pitch = &work->pitch;
    uint32_t turns = o->turn_count;
    if (work->welds || !o->guide || (turns != 1 && turns != 2 && turns != 4) ||
        !meso_weave_pitch(pitch, work->rings.middles, work->rings.axes, work->rings.count,
                          (MesoVec2){swatch->size.x, swatch->size.y}) ||
        (turns == 4 && !pitch->alike))
        return MESO_OK;
    const MesoStripeOptions stripes = {
        .turn_count = turns, .diagonal = pitch->chequered, .turn_most = (double)o->guide_turn,
        .pitches = {(double)o->scale * pitch->pitches[0], (double)o->scale * pitch->pitches[1]},
        .thread_count = o->thread_count};
    MesoStatus status = meso_stripe_phases(&work->phases, scratch, work->base, o->guide, &stripes, error);
    work->in_phase = !status && work->phases.strain > STRAIN_LEAST && work->phases.strain < STRAIN_MOST;
    if (work->in_phase)
        work->options.guide = work->phases.directions;
    return status;
}

static MesoStatus set_up(MesoQuiltWork *work, Front *front, MesoArena *scratch, MesoError *error)
{
    size_t count = work->base->triangle_count;
    choose_lengths(work);
    work->seeds_apart = distance_apart(work);
    const MesoSwatch *swatch = work->swatch;
    MesoStatus status = meso_match_field_build(&work->field, scratch, swatch, work->options.lambda / swatch->mean_edge,
                                               choose_voxel(swatch), work->options.thread_count, error);
    if (!status)
        status = meso_strands_find_rings(&work->rings, swatch, scratch, error);
    if (!status)
        status = find_phases(work, scratch, error);
    if (!status)
        status = meso_composite_init(&work->composite, work->base->triangle_count, error);
    if (status)
        return status;
    work->roots = MESO_NEW(scratch, uint32_t, swatch->element_count, error);
    work->covers = MESO_NEW(scratch, uint8_t, count, error);
    work->chart_triangles = MESO_NEW(scratch, uint32_t, count, error);
    front->triangles = MESO_NEW(scratch, uint32_t, count, error);
    front->constraints = MESO_NEW(scratch, float, count, error);
    front->listed = MESO_NEW(scratch, uint8_t, count, error);
    front->seen = MESO_NEW(scratch, uint8_t, count, error);
    front->around = MESO_NEW(scratch, uint32_t, count, error);
    if (!work->roots || !work->covers || !work->chart_triangles || !front->triangles || !front->constraints ||
        !front->listed || !front->seen || !front->around)
        return MESO_ERR_MEMORY;
    meso_whole_roots(work->roots, swatch);
    memset(work->chart_triangles, 0xff, count * sizeof *work->chart_triangles);
    return MESO_OK;
}

static MesoStatus run(MesoQuiltWork *work, Round *round, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    Front front = {0};
    MesoStatus status = set_up(work, &front, &scratch, error);
    for (int i = 0; i < MESO_QUILT_PATCHES && !status; i++)
        status = meso_chart_maker_init(&round->makers[i], work->base, error);
    if (!status)
        status = grow(work, round, &front, error);
    for (int i = 0; i < MESO_QUILT_PATCHES; i++)
        meso_chart_maker_release(&round->makers[i]);
    give_scratch_back(work, round);
    meso_arena_release(&scratch);
    return status;
}

MesoStatus meso_quilt_grow(MesoQuilt *quilt, MesoArena *arena, const MesoTriangulation *base, const MesoSwatch *swatch,
                           const MesoQuiltOptions *options, MesoError *error)
{
    *quilt = (MesoQuilt){0};
    MesoQuiltWork *work = calloc(1, sizeof *work);
    Round *round = calloc(1, sizeof *round);
    MesoStatus status = MESO_OK;
    if (!work || !round) {
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory: a quilt");
    } else {
        work->base = base;
        work->swatch = swatch;
        work->options = *options;
        round->work = work;
        status = run(work, round, error);
        if (!status)
            status = meso_composite_finish(quilt, arena, &work->composite, swatch, error);
        MesoQuiltReport *report = &work->tally.report;
        report->cap_count = quilt->report.cap_count;
        if (report->patch_count)
            report->matching_cost = work->tally.cost_sum / report->patch_count;
        if (work->tally.moved_count)
            report->deformation_rms = sqrt(work->tally.square_sum / (double)work->tally.moved_count);
        quilt->report = *report;
        meso_composite_release(&work->composite);
    }
    free(round);
    free(work);
    return status;
}
