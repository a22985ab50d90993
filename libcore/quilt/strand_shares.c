/* Which rings of strands belong to which side of the seam. */
#include "libcore/quilt/quilt_work.h"

#include <stdlib.h>

/*
 * Rings of one strand, as both sides have it: they lie beside each other by no more than so many times a ring's reach,
 * and along by no more than so many steps from ring to ring; and go the same way, by the cosine. Thin strands reach so
 * many steps.
 */
#define BESIDE_MOST 1.2f
#define THIN_STEPS 2.5f
#define ALONG_MOST 0.6f
#define COSINE_LEAST 0.8f

/* Rings so many reaches from the seam are looked at; and of those that go along it, so many pull. */
#define BAND_REACHES 1.5f
enum { PULLS_MOST = 24 };

/* New rings so many mean edges of the swatch on the old side are of no interest. */
#define DEEP_EDGES 6.0f

/* Rings with a vertex so near to the chart's rim, in mean edges of the swatch, stay as they are. */
#define RIM_EDGES 1.0f

/* Where the middle of a ring is. */
typedef struct RingPlace {
    float x, y;
    uint32_t ring;
} RingPlace;

/* The rings of one side as they lie in the plane. */
typedef struct RingSide {
    const MesoStrandRings *rings;
    const MesoVec3 *middles;    /* [rings->count] */
    const MesoVec3 *axes;       /* [rings->count] */
    float *values;              /* [rings->count] positive on this side */
    const uint8_t *fixed;       /* [rings->count] it reaches to the chart's rim: old ones stay, new ones do not come */
    uint32_t near_count;
    uint32_t *near;             /* [near_count] rings near the seam */
    RingPlace *by_x;            /* [near_count] the same, from left to right */
    MesoVec3 *ways;             /* [rings->count] beside the strand, to the same one of the other side */
    uint8_t *has_other;         /* [rings->count] */
} RingSide;

static float reach_of(const MesoStrandRings *rings, uint32_t r)
{
    float thin = THIN_STEPS * rings->steps[r];
    return rings->reaches[r] > thin ? rings->reaches[r] : thin;
}

static float seam_at(const MesoQuiltStep *step, MesoVec3 p)
{
    return meso_seam_at(&step->seam, (MesoVec2){p.x, p.y});
}

/* From the chart's rim; -1 outside of the plane's box. */
static float rim_at(const MesoQuiltStep *step, MesoVec3 p)
{
    const MesoSeamGround *g = &step->ground;
    float x = (p.x - g->low.x) / g->cell, y = (p.y - g->low.y) / g->cell;
    if (!(x >= 0 && y >= 0 && x < (float)g->columns && y < (float)g->rows))
        return -1;
    return g->rim[(size_t)(uint32_t)y * g->columns + (size_t)x];
}

/* ---- the sides ---- */

static int compare_places(const void *a, const void *b)
{
    const RingPlace *p = a, *q = b;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return p->ring < q->ring ? -1 : p->ring > q->ring;
}

static MesoStatus sort_near(RingSide *side, MesoArena *arena, MesoError *error)
{
    side->by_x = MESO_NEW(arena, RingPlace, side->near_count, error);
    if (!side->by_x)
        return MESO_ERR_MEMORY;
    for (uint32_t m = 0; m < side->near_count; m++) {
        MesoVec3 p = side->middles[side->near[m]];
        side->by_x[m] = (RingPlace){p.x, p.y, side->near[m]};
    }
    qsort(side->by_x, side->near_count, sizeof *side->by_x, compare_places);
    return MESO_OK;
}

/* Rings near the seam, and such as would change sides but for the rim, with room around. */
static MesoStatus list_near(RingSide *side, const MesoQuiltStep *step, MesoArena *arena, MesoError *error)
{
    side->near = MESO_NEW(arena, uint32_t, side->rings->count, error);
    side->ways = MESO_NEW(arena, MesoVec3, side->rings->count, error);
    side->has_other = MESO_NEW(arena, uint8_t, side->rings->count, error);
    if (!side->near || !side->ways || !side->has_other)
        return MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < side->rings->count; r++) {
        float reach = BAND_REACHES * reach_of(side->rings, r);
        if (fabsf(side->values[r]) < reach || fabsf(rim_at(step, side->middles[r])) < reach)
            side->near[side->near_count++] = r;
    }
    return sort_near(side, arena, error);
}

static MesoStatus side_room(RingSide *side, const MesoStrandRings *rings, MesoArena *arena, MesoError *error)
{
    *side = (RingSide){.rings = rings, .values = MESO_NEW(arena, float, rings->count, error)};
    return side->values ? MESO_OK : MESO_ERR_MEMORY;
}

/* Rings that reach out of the chart, and those next to them. */
MesoStatus meso_strands_fix_old(uint8_t **old_fixed, const MesoQuiltStep *step, const MesoQuiltWork *work,
                                MesoArena *arena, MesoError *error)
{
    const MesoOldGeometry *old = &step->old;
    const MesoStrandRings *rings = &step->old_rings;
    uint8_t *fixed = *old_fixed = MESO_NEW(arena, uint8_t, rings->count, error);
    if (!fixed)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < old->vertex_count; v++) {
        uint32_t r = rings->of_vertex[v], of_swatch = work->rings.of_vertex[work->composite.vertex_origins[old->vertices[v]]];
        fixed[r] |= rings->sizes[r] < work->rings.sizes[of_swatch] ||
                    rim_at(step, old->positions[v]) < RIM_EDGES * work->swatch->mean_edge;
    }
    for (uint32_t c = 0; c < 3 * old->triangle_count; c++) {
        uint32_t a = rings->of_vertex[old->corners[c]], b = rings->of_vertex[old->corners[meso_next_corner(c)]];
        if (fixed[a] == 1 && !fixed[b])
            fixed[b] = 2;
        if (fixed[b] == 1 && !fixed[a])
            fixed[a] = 2;
    }
    return MESO_OK;
}

static MesoStatus make_old(RingSide *side, const MesoQuiltStep *step, MesoArena *arena, MesoError *error)
{
    const MesoStrandRings *rings = &step->old_rings;
    MesoStatus status = side_room(side, rings, arena, error);
    if (status)
        return status;
    side->middles = rings->middles;
    side->axes = rings->axes;
    for (uint32_t r = 0; r < rings->count; r++)
        side->values[r] = -seam_at(step, rings->middles[r]);
    side->fixed = step->old_fixed;
    return list_near(side, step, arena, error);
}

static MesoStatus make_new(RingSide *side, uint8_t **new_fixed, const MesoQuiltStep *step, const MesoQuiltWork *work,
                           MesoArena *arena, MesoError *error)
{
    const MesoStrandRings *rings = &work->rings;
    MesoVec3 *middles = MESO_NEW(arena, MesoVec3, rings->count, error);
    MesoVec3 *axes = MESO_NEW(arena, MesoVec3, rings->count, error);
    uint8_t *fixed = MESO_NEW(arena, uint8_t, rings->count, error);
    MesoStatus status = side_room(side, rings, arena, error);
    if (!middles || !axes || !fixed || status)
        return MESO_ERR_MEMORY;
    side->middles = middles;
    side->axes = axes;
    side->fixed = *new_fixed = fixed;
    for (uint32_t r = 0; r < rings->count; r++) {
        MesoVec2 flat = meso_step_turn(step, (MesoVec2){rings->axes[r].x, rings->axes[r].y});
        axes[r] = (MesoVec3){flat.x, flat.y, rings->axes[r].z};
        middles[r] = meso_step_warp(step, meso_step_from_swatch(step, rings->middles[r]));
        side->values[r] = seam_at(step, middles[r]);
        fixed[r] = rim_at(step, middles[r]) < 0;
    }
    return list_near(side, step, arena, error);
}

/* Vertices of new rings that are of interest come to their places; rings that have one off the chart are `fixed`. */
static void place_vertices(MesoVec3 *places, uint8_t *fixed, const RingSide *side, uint32_t begin, uint32_t end,
                           const MesoQuiltStep *step, const MesoQuiltWork *work)
{
    const MesoStrandRings *rings = &work->rings;
    float deep = -DEEP_EDGES * work->swatch->mean_edge;
    uint32_t near = MESO_NO_INDEX;
    for (uint32_t v = begin; v < end; v++) {
        uint32_t r = rings->of_vertex[v];
        if (r == MESO_NO_INDEX || side->values[r] < deep || rim_at(step, side->middles[r]) < 0)
            continue;
        places[v] = meso_step_warp(step, meso_step_from_swatch(step, work->swatch->positions[v]));
        fixed[r] = fixed[r] || !meso_quilt_plane_has(&step->plane, (MesoVec2){places[v].x, places[v].y}, &near);
    }
}

/* ---- strands that both have ---- */

/* The way beside a strand from one of its rings to the other side's; false where that is not the same strand. */
static bool way_beside(MesoVec3 *way, float *distance, const RingSide *a, uint32_t i, const RingSide *b, uint32_t j)
{
    MesoVec3 apart = meso_vec3_sub(b->middles[j], a->middles[i]);
    float a_reach = reach_of(a->rings, i), b_reach = reach_of(b->rings, j);
    float step = a->rings->steps[i] > b->rings->steps[j] ? a->rings->steps[i] : b->rings->steps[j];
    float along = meso_vec3_dot(apart, a->axes[i]), cosine = meso_vec3_dot(a->axes[i], b->axes[j]);
    if (fabsf(along) > ALONG_MOST * step || fabsf(cosine) < COSINE_LEAST)
        return false;
    *way = meso_vec3_mad(apart, -along, a->axes[i]);
    *distance = meso_vec3_length(*way) + 0.5f * fabsf(along);
    return meso_vec3_length(*way) < BESIDE_MOST * (a_reach > b_reach ? a_reach : b_reach);
}

/* That rings of one strand are apart, at most. */
static float farthest_apart(const RingSide *side)
{
    float farthest = 0;
    for (uint32_t m = 0; m < side->near_count; m++) {
        uint32_t r = side->near[m];
        float far = BESIDE_MOST * reach_of(side->rings, r) + ALONG_MOST * side->rings->steps[r];
        farthest = far > farthest ? far : farthest;
    }
    return farthest;
}

/* The first of the rings by x that lies right of a place. */
static uint32_t first_right_of(const RingSide *side, float x)
{
    uint32_t low = 0, high = side->near_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (side->by_x[middle].x > x)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* The nearest that is the same strand; of equal ones the first. */
static void find_other(RingSide *a, uint32_t r, const RingSide *b, float farthest, uint8_t *meets_fixed)
{
    MesoVec3 p = a->middles[r], way;
    float least = INFINITY, distance;
    uint32_t best = MESO_NO_INDEX;
    for (uint32_t n = first_right_of(b, p.x - farthest); n < b->near_count; n++) {
        uint32_t q = b->by_x[n].ring;
        if (b->by_x[n].x >= p.x + farthest)
            break;
        if (!(fabsf(b->by_x[n].y - p.y) < farthest) || !way_beside(&way, &distance, a, r, b, q) ||
            !(distance < least || (distance == least && q < best)))
            continue;
        least = distance;
        best = q;
        a->ways[r] = way;
    }
    if (best != MESO_NO_INDEX) {
        a->has_other[r] = 1;
        meets_fixed[r] = b->fixed[best];
    }
}

static void find_others(RingSide *a, const RingSide *b, uint8_t *meets_fixed)
{
    float a_apart = farthest_apart(a), b_apart = farthest_apart(b);
    for (uint32_t m = 0; m < a->near_count; m++)
        find_other(a, a->near[m], b, a_apart > b_apart ? a_apart : b_apart, meets_fixed);
}

/*
 * From the middle between both: what is positive on one side is negative on the other. Where the rim holds one of them,
 * the older strand stays. New rings that are not on the chart end there, open, where nothing older goes on.
 */
static void share_out(RingSide *side, const uint8_t *meets_fixed, const MesoQuiltStep *step, bool is_new)
{
    float little = 0.1f * step->ground.cell;
    for (uint32_t m = 0; m < side->near_count; m++) {
        uint32_t r = side->near[m];
        float seam = seam_at(step, meso_vec3_mad(side->middles[r], 0.5f, side->ways[r]));
        if (side->has_other[r])
            side->values[r] = is_new ? seam : -seam;
    }
    for (uint32_t r = 0; r < side->rings->count; r++) {
        if (!side->fixed[r] && !meets_fixed[r])
            continue;
        if (!is_new)
            side->values[r] = side->values[r] > little ? side->values[r] : little;
        else if (side->fixed[r] && !side->has_other[r])
            side->values[r] = -INFINITY;
        else
            side->values[r] = side->values[r] < -little ? side->values[r] : -little;
    }
}

static MesoStatus list_pulls(MesoRingShares *shares, const RingSide *side, const uint8_t *meets_fixed, MesoArena *arena, MesoError *error)
{
    uint32_t count = 0, number = 0;
    for (uint32_t m = 0; m < side->near_count; m++)
        count += side->has_other[side->near[m]] && !meets_fixed[side->near[m]];
    uint32_t stride = count / PULLS_MOST + 1;
    shares->pulls_from = MESO_NEW(arena, MesoVec3, count / stride + 1, error);
    shares->pulls_apart = MESO_NEW(arena, MesoVec3, count / stride + 1, error);
    if (!shares->pulls_from || !shares->pulls_apart)
        return MESO_ERR_MEMORY;
    shares->pull_count = 0;
    for (uint32_t m = 0; m < side->near_count; m++)
        if (side->has_other[side->near[m]] && !meets_fixed[side->near[m]] && number++ % stride == 0) {
            shares->pulls_from[shares->pull_count] = side->middles[side->near[m]];
            shares->pulls_apart[shares->pull_count++] = side->ways[side->near[m]];
        }
    return MESO_OK;
}

typedef struct Sharing {
    RingSide sides[2];
    uint8_t *meets[2];          /* [rings of the side] the other side's ring is fixed */
    uint8_t *new_fixed;         /* what the new side has as `fixed` */
    uint8_t *fixed[2];          /* [rings of the new side] by each half of the vertices */
    MesoVec3 *places;
    const MesoQuiltStep *step;
    const MesoQuiltWork *work;
} Sharing;

static MesoStatus make_side(void *context, int side, MesoArena *arena, MesoError *error)
{
    Sharing *s = context;
    MesoStatus status = side ? make_new(&s->sides[1], &s->new_fixed, s->step, s->work, arena, error)
                             : make_old(&s->sides[0], s->step, arena, error);
    if (status)
        return status;
    s->meets[side] = MESO_NEW(arena, uint8_t, s->sides[side].rings->count, error);
    return s->meets[side] ? MESO_OK : MESO_ERR_MEMORY;
}

/* The new side's vertices take longer than all else: either task has half of them. */
static MesoStatus place_half(void *context, int half, MesoArena *arena, MesoError *error)
{
    Sharing *s = context;
    uint32_t count = s->work->swatch->vertex_count, middle = count / 2;
    s->fixed[half] = MESO_NEW(arena, uint8_t, s->work->rings.count, error);
    if (!s->fixed[half])
        return MESO_ERR_MEMORY;
    place_vertices(s->places, s->fixed[half], &s->sides[1], half ? middle : 0, half ? count : middle, s->step, s->work);
    return MESO_OK;
}

static void fix_new(Sharing *s)
{
    for (uint32_t r = 0; r < s->work->rings.count; r++)
        s->new_fixed[r] |= s->fixed[0][r] | s->fixed[1][r];
}

static MesoStatus find_side(void *context, int side, MesoArena *arena, MesoError *error)
{
    Sharing *s = context;
    (void)arena;
    (void)error;
    find_others(&s->sides[side], &s->sides[1 - side], s->meets[side]);
    return MESO_OK;
}

MesoStatus meso_strands_share(MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                              MesoArena *arena, MesoError *error)
{
    Sharing s = {.places = MESO_NEW(arena, MesoVec3, work->swatch->vertex_count, error), .step = step, .work = work};
    *shares = (MesoRingShares){.places = s.places};
    if (!shares->places)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_quilt_both(make_side, &s, step, work, arena, error);
    if (!status)
        status = meso_quilt_both(place_half, &s, step, work, arena, error);
    if (status)
        return status;
    fix_new(&s);
    status = meso_quilt_both(find_side, &s, step, work, arena, error);
    if (status)
        return status;
    share_out(&s.sides[0], s.meets[0], step, false);
    share_out(&s.sides[1], s.meets[1], step, true);
    shares->old_values = s.sides[0].values;
    shares->new_values = s.sides[1].values;
    shares->old_ways = s.sides[0].ways;
    shares->new_ways = s.sides[1].ways;
    shares->new_middles = s.sides[1].middles;
    shares->new_axes = s.sides[1].axes;
    shares->old_has = s.sides[0].has_other;
    shares->new_has = s.sides[1].has_other;
    return list_pulls(shares, &s.sides[1], s.meets[1], arena, error);
}
