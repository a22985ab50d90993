/* Whole elements of a patch: closed and small ones, which are placed whole or not at all. */
#include "libcore/quilt/quilt_work.h"
#include "libcore/quilt/seam/bodies_meet.h"

#include <string.h>

/* Two elements are one where their centres are nearer than this share of their reach. */
#define PARTNER_REACH 0.75f

static float radius_of_old(const MesoQuiltStep *step, const MesoQuiltWork *work, uint32_t i)
{
    return work->swatch->radii[work->composite.wholes[step->old.wholes[i]].element];
}

static float distance(MesoVec3 a, MesoVec3 b)
{
    return meso_vec3_length(meso_vec3_sub(a, b));
}

/* The old element nearest to a new one that could be the same; MESO_NO_INDEX: none. */
static uint32_t nearest_old(const MesoQuiltStep *step, const MesoQuiltWork *work, MesoVec3 centre, float radius)
{
    uint32_t best = MESO_NO_INDEX;
    float least = INFINITY;
    for (uint32_t i = 0; i < step->old.whole_count; i++) {
        float other = radius_of_old(step, work, i), d = distance(step->old.centres[i], centre);
        float smaller = other < radius ? other : radius;
        if (d < least && d < PARTNER_REACH * smaller && other < 2 * radius && radius < 2 * other) {
            least = d;
            best = i;
        }
    }
    return best;
}

static bool is_on_chart(const MesoQuiltStep *step, MesoVec3 p)
{
    float b1, b2;
    return meso_quilt_plane_locate(&step->plane, (MesoVec2){p.x, p.y}, &b1, &b2) != MESO_NO_INDEX;
}

MesoStatus meso_quilt_pair_wholes(MesoWholePairs *pairs, const MesoQuiltStep *step, const MesoQuiltWork *work,
                                  MesoArena *arena, MesoError *error)
{
    const MesoSwatch *swatch = work->swatch;
    *pairs = (MesoWholePairs){0};
    pairs->elements = MESO_NEW(arena, uint32_t, swatch->element_count, error);
    pairs->centres = MESO_NEW(arena, MesoVec3, swatch->element_count, error);
    pairs->partners = MESO_NEW(arena, uint32_t, swatch->element_count, error);
    uint32_t *taken = MESO_NEW(arena, uint32_t, step->old.whole_count, error);
    if (!pairs->elements || !pairs->centres || !pairs->partners || !taken)
        return MESO_ERR_MEMORY;
    memset(taken, 0xff, step->old.whole_count * sizeof *taken);
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        if (swatch->kinds[e] != MESO_ELEMENT_WHOLE)
            continue;
        MesoVec3 centre = meso_step_from_swatch(step, swatch->centres[e]);
        if (!is_on_chart(step, centre))
            continue;
        uint32_t i = pairs->count++, old = nearest_old(step, work, centre, swatch->radii[e]);
        pairs->elements[i] = e;
        pairs->centres[i] = centre;
        pairs->partners[i] = MESO_NO_INDEX;
        if (old == MESO_NO_INDEX)
            continue;
        /* of two that want the same one, the nearer has it */
        uint32_t rival = taken[old];
        if (rival != MESO_NO_INDEX &&
            distance(pairs->centres[rival], step->old.centres[old]) <= distance(centre, step->old.centres[old]))
            continue;
        if (rival != MESO_NO_INDEX)
            pairs->partners[rival] = MESO_NO_INDEX;
        taken[old] = i;
        pairs->partners[i] = old;
    }
    return MESO_OK;
}

/* ---- placing ---- */

typedef struct WholeWork {
    const MesoQuiltStep *step;
    const MesoQuiltWork *work;
    MesoWholePlan *plan;
    MesoVec3 *points;       /* [largest element] a new one */
    MesoVec3 *others;       /* [largest element] an old one */
    MesoQuiltVertex *places;    /* of the new one: where the plan's go on */
} WholeWork;

static float seam_at(const MesoQuiltStep *step, MesoVec3 p)
{
    return meso_seam_at(&step->seam, (MesoVec2){p.x, p.y});
}

/* A new element on the base; false where it reaches out of the chart. */
static bool lay_out(WholeWork *w, uint32_t element, MesoQuiltVertex *centre)
{
    const MesoSwatch *swatch = w->work->swatch;
    uint32_t first = swatch->vertex_begin[element], count = swatch->vertex_begin[element + 1] - first;
    for (uint32_t i = 0; i < count; i++) {
        w->points[i] = meso_step_warp(w->step, meso_step_from_swatch(w->step, swatch->positions[first + i]));
        if (!meso_quilt_plane_from(&w->step->plane, w->points[i], &w->places[i]))
            return false;
    }
    MesoVec3 middle = meso_step_warp(w->step, meso_step_from_swatch(w->step, swatch->centres[element]));
    return meso_quilt_plane_from(&w->step->plane, middle, centre);
}

static bool meets_old(WholeWork *w, uint32_t element, uint32_t old)
{
    const MesoSwatch *swatch = w->work->swatch;
    const MesoPlacedWhole *placed = &w->work->composite.wholes[w->step->old.wholes[old]];
    uint32_t count = swatch->vertex_begin[placed->element + 1] - swatch->vertex_begin[placed->element];
    for (uint32_t i = 0; i < count; i++)
        if (!meso_quilt_plane_to(&w->step->plane, w->work->composite.whole_vertices[placed->vertex_begin + i],
                                 &w->others[i]))
            return false;   /* it lies at the rim, far from all that is new */
    const uint32_t *begin = swatch->triangle_begin;
    MesoBodyPart a = {w->points, &swatch->corners[3 * (size_t)begin[element]], begin[element + 1] - begin[element],
                      swatch->vertex_begin[element], swatch->vertex_begin[element + 1] - swatch->vertex_begin[element]};
    MesoBodyPart b = {w->others, &swatch->corners[3 * (size_t)begin[placed->element]],
                      begin[placed->element + 1] - begin[placed->element], swatch->vertex_begin[placed->element], count};
    return meso_bodies_meet(&a, &b);
}

/* Whether a new element meets an old one that stays. */
static bool is_in_the_way(WholeWork *w, uint32_t element, MesoVec3 centre)
{
    float radius = w->work->swatch->radii[element];
    for (uint32_t i = 0; i < w->step->old.whole_count; i++) {
        MesoVec3 d = meso_vec3_sub(w->step->old.centres[i], centre);
        float reach = radius + radius_of_old(w->step, w->work, i);
        if (!w->plan->old_dies[i] && d.x * d.x + d.y * d.y < reach * reach && meets_old(w, element, i))
            return true;
    }
    return false;
}

static uint32_t element_size(const MesoSwatch *swatch, uint32_t element)
{
    return swatch->vertex_begin[element + 1] - swatch->vertex_begin[element];
}

/* On which side an element stands: where it grows from a strand, else its centre. */
static float side_of_new(const WholeWork *w, uint32_t element)
{
    uint32_t root = w->work->roots[element];
    const MesoSwatch *swatch = w->work->swatch;
    MesoVec3 at = root == MESO_NO_INDEX ? swatch->centres[element] : swatch->positions[root];
    return seam_at(w->step, meso_step_warp(w->step, meso_step_from_swatch(w->step, at)));
}

static float side_of_old(const WholeWork *w, uint32_t old)
{
    const MesoPlacedWhole *placed = &w->work->composite.wholes[w->step->old.wholes[old]];
    uint32_t root = w->work->roots[placed->element];
    MesoVec3 at = w->step->old.centres[old];
    if (root != MESO_NO_INDEX) {
        uint32_t v = placed->vertex_begin + root - w->work->swatch->vertex_begin[placed->element];
        meso_quilt_plane_to(&w->step->plane, w->work->composite.whole_vertices[v], &at);
    }
    return seam_at(w->step, at);
}

/* Whether a pair, or a new element alone, lies on the new side. */
static bool is_new(const WholeWork *w, uint32_t element, uint32_t old)
{
    float side = side_of_new(w, element);
    return (old == MESO_NO_INDEX ? side : 0.5f * (side + side_of_old(w, old))) > 0;
}

static void plan_new(WholeWork *w, const MesoWholePairs *pairs)
{
    const MesoSwatch *swatch = w->work->swatch;
    for (uint32_t i = 0; i < pairs->count; i++) {
        uint32_t element = pairs->elements[i], old = pairs->partners[i];
        MesoVec3 centre = meso_step_warp(w->step, meso_step_from_swatch(w->step, swatch->centres[element]));
        MesoQuiltVertex place;
        if (!is_new(w, element, old) || !lay_out(w, element, &place))
            continue;
        if (old != MESO_NO_INDEX)
            w->plan->old_dies[old] = true;
        if (is_in_the_way(w, element, centre)) {
            if (old != MESO_NO_INDEX)
                w->plan->old_dies[old] = false;     /* the older one of a pair does as well */
            else
                w->step->tally->report.removed_count++;
            continue;
        }
        w->plan->elements[w->plan->count] = element;
        w->plan->centres[w->plan->count++] = place;
        w->places += element_size(swatch, element);
    }
}

/* Old ones without partner go where the new side is; with one, their partner decides. */
static void find_leavers(WholeWork *w, const MesoWholePairs *pairs)
{
    for (uint32_t i = 0; i < w->step->old.whole_count; i++)
        w->plan->old_dies[i] = side_of_old(w, i) > 0;
    for (uint32_t i = 0; i < pairs->count; i++)
        if (pairs->partners[i] != MESO_NO_INDEX)
            w->plan->old_dies[pairs->partners[i]] = false;
}

MesoStatus meso_quilt_plan_wholes(MesoWholePlan *plan, const MesoWholePairs *pairs, const MesoQuiltStep *step,
                                  const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    const MesoSwatch *swatch = work->swatch;
    uint32_t largest = 0;
    size_t total = 0;
    for (uint32_t e = 0; e < swatch->element_count; e++)
        if (swatch->kinds[e] == MESO_ELEMENT_WHOLE && element_size(swatch, e) > largest)
            largest = element_size(swatch, e);
    for (uint32_t i = 0; i < pairs->count; i++)
        total += element_size(swatch, pairs->elements[i]);
    *plan = (MesoWholePlan){0};
    plan->old_dies = MESO_NEW(arena, bool, step->old.whole_count, error);
    plan->elements = MESO_NEW(arena, uint32_t, pairs->count, error);
    plan->centres = MESO_NEW(arena, MesoQuiltVertex, pairs->count, error);
    plan->places = MESO_NEW(arena, MesoQuiltVertex, total, error);
    WholeWork w = {.step = step, .work = work, .plan = plan, .places = plan->places};
    w.points = MESO_NEW(arena, MesoVec3, largest, error);
    w.others = MESO_NEW(arena, MesoVec3, largest, error);
    if (!plan->old_dies || !plan->elements || !plan->centres || !plan->places || !w.points || !w.others)
        return MESO_ERR_MEMORY;
    find_leavers(&w, pairs);
    plan_new(&w, pairs);
    return MESO_OK;
}

MesoStatus meso_quilt_commit_wholes(const MesoWholePlan *plan, const MesoQuiltStep *step, MesoQuiltWork *work,
                                    MesoError *error)
{
    const MesoQuiltVertex *places = plan->places;
    for (uint32_t i = 0; i < plan->count; i++) {
        uint32_t count = element_size(work->swatch, plan->elements[i]);
        if (meso_composite_add_whole(&work->composite, plan->elements[i], step->patch, plan->centres[i], places, count,
                                     error) == MESO_NO_INDEX)
            return error ? error->status : MESO_ERR_MEMORY;
        places += count;
    }
    for (uint32_t i = 0; i < step->old.whole_count; i++)
        work->composite.wholes[step->old.wholes[i]].dead |= plan->old_dies[i];
    return MESO_OK;
}
