/* A quilt from the first patch to the last. */
#include <stdlib.h>
#include <string.h>

#include "libcore/quilt/quilt_work.h"

/* Margins of a patch are made tighter by steps where its seed is not covered. */
static const float TIGHTNESS[] = {1, 0.5f, 0.25f, 0.1f};
enum { TIGHTNESS_COUNT = sizeof TIGHTNESS / sizeof *TIGHTNESS };

/* Voxels of the field along the longer side of the swatch. */
#define VOXELS 72

typedef struct Front {
    uint32_t *triangles;    /* [count] not done, next to what is; in the order in which they came */
    uint32_t count;
    uint8_t *listed;        /* [triangle_count] */
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

/* The most constrained triangle: the largest share of done ones around it, then the oldest. MESO_NO_INDEX at the end. */
static uint32_t next_seed(Front *front, const MesoQuiltWork *work)
{
    uint32_t best = MESO_NO_INDEX, kept = 0;
    float most = -1;
    for (uint32_t i = 0; i < front->count; i++) {
        uint32_t triangle = front->triangles[i], all;
        if (work->covers[triangle] == MESO_COVER_DONE)
            continue;
        front->triangles[kept++] = triangle;
        uint32_t done = count_done_around(work, triangle, &all);
        if ((float)done / (float)all > most) {
            most = (float)done / (float)all;
            best = triangle;
        }
    }
    front->count = kept;
    if (best != MESO_NO_INDEX)
        return best;
    while (front->next_bare < work->base->triangle_count && work->covers[front->next_bare] == MESO_COVER_DONE)
        front->next_bare++;
    return front->next_bare < work->base->triangle_count ? front->next_bare : MESO_NO_INDEX;
}

static MesoStatus cover_seed(uint32_t seed, Front *front, MesoQuiltWork *work, MesoArena *scratch, MesoError *error)
{
    for (int attempt = 0; attempt < TIGHTNESS_COUNT; attempt++) {
        MesoArenaMark mark = meso_arena_mark(scratch);
        MesoQuiltStep step = {.seed = seed, .patch = work->report.patch_count++, .tightness = TIGHTNESS[attempt]};
        bool done = false;
        MesoStatus status = meso_quilt_step(&step, &done, work, scratch, error);
        if (!status)
            extend_front(front, work, &step.chart);
        meso_arena_rewind(scratch, mark);
        if (status || done)
            return status;
    }
    /* nothing can be placed there: it counts as done, so that there is an end */
    work->covers[seed] = MESO_COVER_DONE;
    work->report.skipped_count++;
    front->done_count++;
    front->listed[seed] = 2;
    return MESO_OK;
}

static MesoStatus check_limits(const MesoQuiltWork *work, MesoError *error)
{
    uint64_t limit = work->options.triangle_limit;
    if (limit && work->composite.triangle_count > limit)
        return meso_fail(error, MESO_ERR_LIMIT, "the quilt has more than %llu triangles", (unsigned long long)limit);
    return MESO_OK;
}

static MesoStatus grow(MesoQuiltWork *work, Front *front, MesoArena *scratch, MesoError *error)
{
    for (;;) {
        uint32_t seed = next_seed(front, work);
        if (seed == MESO_NO_INDEX || (work->options.step_limit && work->report.patch_count >= work->options.step_limit))
            return MESO_OK;
        MesoStatus status = cover_seed(seed, front, work, scratch, error);
        if (!status)
            status = check_limits(work, error);
        if (status)
            return status;
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
    work->gap = 0.5f * edge;
    work->ring = least(2 * edge, 0.05f * side);
    work->strand_margin = least(4 * edge, 0.1f * side);
    work->widening = least(5 * edge, 0.12f * side);
    for (uint32_t e = 0; e < swatch->element_count; e++)
        if (swatch->kinds[e] == MESO_ELEMENT_WHOLE && swatch->radii[e] > work->whole_margin)
            work->whole_margin = swatch->radii[e];
    work->chart_radius = 0.55f * sqrtf(swatch->size.x * swatch->size.x + swatch->size.y * swatch->size.y) +
                         work->whole_margin;
}

static MesoStatus prepare(MesoQuiltWork *work, Front *front, MesoArena *scratch, MesoError *error)
{
    uint32_t count = work->base->triangle_count;
    choose_lengths(work);
    const MesoSwatch *swatch = work->swatch;
    float longest = swatch->size.x > swatch->size.y ? swatch->size.x : swatch->size.y;
    MesoStatus status = meso_match_field_build(&work->field, scratch, swatch, work->options.lambda / swatch->mean_edge,
                                               longest / VOXELS, work->options.thread_count, error);
    if (!status)
        status = meso_composite_init(&work->composite, count, error);
    if (!status)
        status = meso_chart_maker_init(&work->maker, work->base, error);
    if (status)
        return status;
    work->covers = MESO_NEW(scratch, uint8_t, count, error);
    work->chart_triangles = MESO_NEW(scratch, uint32_t, count, error);
    front->triangles = MESO_NEW(scratch, uint32_t, count, error);
    front->listed = MESO_NEW(scratch, uint8_t, count, error);
    if (!work->covers || !work->chart_triangles || !front->triangles || !front->listed)
        return MESO_ERR_MEMORY;
    memset(work->chart_triangles, 0xff, count * sizeof *work->chart_triangles);
    return MESO_OK;
}

MesoStatus meso_quilt_grow(MesoQuilt *quilt, MesoArena *arena, const MesoTriangulation *base, const MesoSwatch *swatch,
                           const MesoQuiltOptions *options, MesoError *error)
{
    *quilt = (MesoQuilt){0};
    MesoQuiltWork *work = calloc(1, sizeof *work);
    if (!work)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: a quilt");
    work->base = base;
    work->swatch = swatch;
    work->options = *options;
    MesoArena scratch;
    meso_arena_init(&scratch);
    for (int i = 0; i < MESO_QUILT_TRIALS; i++) {
        meso_arena_init(&work->trial_arenas[i]);
        work->trial_marks[i] = meso_arena_mark(&work->trial_arenas[i]);
    }
    Front front = {0};
    MesoStatus status = prepare(work, &front, &scratch, error);
    if (!status)
        status = grow(work, &front, &scratch, error);
    meso_arena_release(&scratch);
    for (int i = 0; i < MESO_QUILT_TRIALS; i++)
        meso_arena_release(&work->trial_arenas[i]);
    if (!status)
        status = meso_composite_finish(quilt, arena, &work->composite, swatch, error);
    work->report.cap_count = quilt->report.cap_count;
    quilt->report = work->report;
    if (work->report.patch_count)
        quilt->report.matching_cost = work->cost_sum / work->report.patch_count;
    if (work->moved_count)
        quilt->report.deformation_rms = sqrt(work->square_sum / (double)work->moved_count);
    meso_chart_maker_release(&work->maker);
    meso_composite_release(&work->composite);
    free(work);
    return status;
}
