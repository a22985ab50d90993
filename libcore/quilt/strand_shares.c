/* Which rings of strands belong to which side of the seam. */
#include "libcore/quilt/quilt_work.h"

/*
 * Rings of one strand, as both sides have it: they lie beside each other by no more than so many times a ring's reach,
 * and along by no more than so many steps from ring to ring; and go the same way, by the cosine.
 */
#define BESIDE_MOST 1.2f
#define ALONG_MOST 1.0f
#define COSINE_LEAST 0.8f

/* Rings so many reaches from the seam are looked at; and of those that go along it, so many pull. */
#define BAND_REACHES 1.5f
enum { PULLS_MOST = 60 };

/* Cells from the chart's rim in which nothing is changed. */
#define RIM_CELLS 1.0f

/* The rings of one side as they lie in the plane. */
typedef struct RingSide {
    const MesoStrandRings *rings;
    const MesoVec3 *middles;    /* [rings->count] */
    const MesoVec2 *axes;       /* [rings->count] */
    float *values;              /* [rings->count] positive on this side */
    uint32_t near_count;
    uint32_t *near;             /* [near_count] rings near the seam */
    MesoVec3 *ways;             /* [near_count] beside the strand, to the same one of the other side */
    uint8_t *has_other;         /* [near_count] */
} RingSide;

static float seam_at(const MesoQuiltStep *step, MesoVec3 p)
{
    return meso_seam_at(&step->seam, (MesoVec2){p.x, p.y});
}

static bool is_at_rim(const MesoQuiltStep *step, MesoVec3 p)
{
    const MesoSeamGround *g = &step->ground;
    float x = (p.x - g->low.x) / g->cell, y = (p.y - g->low.y) / g->cell;
    if (!(x >= 0 && y >= 0 && x < (float)g->columns && y < (float)g->rows))
        return true;
    return g->rim[(size_t)(uint32_t)y * g->columns + (size_t)x] <= RIM_CELLS * g->cell;
}

/* ---- the sides ---- */

static MesoStatus list_near(RingSide *side, MesoArena *arena, MesoError *error)
{
    side->near = MESO_NEW(arena, uint32_t, side->rings->count, error);
    side->ways = MESO_NEW(arena, MesoVec3, side->rings->count, error);
    side->has_other = MESO_NEW(arena, uint8_t, side->rings->count, error);
    if (!side->near || !side->ways || !side->has_other)
        return MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < side->rings->count; r++)
        if (fabsf(side->values[r]) < BAND_REACHES * side->rings->reaches[r])
            side->near[side->near_count++] = r;
    return MESO_OK;
}

/* What reaches out of the chart stays as it is. */
static void hold_rim(float *values, const MesoQuiltStep *step)
{
    const MesoOldGeometry *old = &step->old;
    for (uint32_t v = 0; v < old->vertex_count; v++) {
        float *value = &values[step->old_rings.of_vertex[v]];
        if (*value <= 0 && is_at_rim(step, old->positions[v]))
            *value = 0.1f * step->ground.cell;
    }
}

static MesoStatus make_old(RingSide *side, const MesoQuiltStep *step, MesoArena *arena, MesoError *error)
{
    const MesoStrandRings *rings = &step->old_rings;
    *side = (RingSide){.rings = rings, .middles = rings->middles, .axes = rings->axes,
                       .values = MESO_NEW(arena, float, rings->count, error)};
    if (!side->values)
        return MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < rings->count; r++)
        side->values[r] = -seam_at(step, rings->middles[r]);
    return list_near(side, arena, error);
}

static MesoStatus make_new(RingSide *side, MesoVec3 *places, const MesoQuiltStep *step, const MesoQuiltWork *work,
                           MesoArena *arena, MesoError *error)
{
    const MesoStrandRings *rings = &work->rings;
    MesoVec3 *middles = MESO_NEW(arena, MesoVec3, rings->count, error);
    MesoVec2 *axes = MESO_NEW(arena, MesoVec2, rings->count, error);
    *side = (RingSide){.rings = rings, .middles = middles, .axes = axes,
                       .values = MESO_NEW(arena, float, rings->count, error)};
    if (!middles || !axes || !side->values)
        return MESO_ERR_MEMORY;
    for (uint32_t r = 0; r < rings->count; r++) {
        middles[r] = meso_step_warp(step, meso_step_from_swatch(step, rings->middles[r]));
        axes[r] = meso_step_turn(step, rings->axes[r]);
        side->values[r] = seam_at(step, middles[r]);
    }
    const MesoQuiltPlane *plane = &step->plane;
    for (uint32_t v = 0; v < work->swatch->vertex_count; v++) {
        uint32_t r = rings->of_vertex[v];
        float b1, b2;
        if (r == MESO_NO_INDEX || side->values[r] == -INFINITY)
            continue;
        MesoVec3 p = meso_step_from_swatch(step, work->swatch->positions[v]);
        bool outside = p.x < plane->low.x || p.y < plane->low.y || p.x > plane->high.x || p.y > plane->high.y;
        if (!outside) {
            places[v] = meso_step_warp(step, p);
            outside = is_at_rim(step, places[v]) ||
                      meso_quilt_plane_locate(plane, (MesoVec2){places[v].x, places[v].y}, &b1, &b2) == MESO_NO_INDEX;
        }
        if (outside)
            side->values[r] = -INFINITY;
    }
    return list_near(side, arena, error);
}

/* ---- strands that both have ---- */

/* The way beside a strand from one of its rings to the other side's; false where that is not the same strand. */
static bool way_beside(MesoVec3 *way, float *distance, const RingSide *a, uint32_t i, const RingSide *b, uint32_t j)
{
    MesoVec3 apart = meso_vec3_sub(b->middles[j], a->middles[i]);
    float reach = a->rings->reaches[i] > b->rings->reaches[j] ? a->rings->reaches[i] : b->rings->reaches[j];
    float step = a->rings->steps[i] > b->rings->steps[j] ? a->rings->steps[i] : b->rings->steps[j];
    MesoVec2 axis = a->axes[i];
    float along = apart.x * axis.x + apart.y * axis.y;
    if (fabsf(along) > ALONG_MOST * step || fabsf(axis.x * b->axes[j].x + axis.y * b->axes[j].y) < COSINE_LEAST)
        return false;
    *way = (MesoVec3){apart.x - along * axis.x, apart.y - along * axis.y, apart.z};
    *distance = meso_vec3_length(*way) + 0.5f * fabsf(along);
    return meso_vec3_length(*way) < BESIDE_MOST * reach;
}

static void find_others(RingSide *a, const RingSide *b)
{
    for (uint32_t m = 0; m < a->near_count; m++) {
        float least = INFINITY, distance;
        MesoVec3 way;
        for (uint32_t n = 0; n < b->near_count; n++)
            if (way_beside(&way, &distance, a, a->near[m], b, b->near[n]) && distance < least) {
                least = distance;
                a->ways[m] = way;
                a->has_other[m] = 1;
            }
    }
}

/* From the middle between both: what is positive on one side is negative on the other. */
static void share_out(RingSide *side, const MesoQuiltStep *step, float sign)
{
    for (uint32_t m = 0; m < side->near_count; m++)
        if (side->has_other[m]) {
            uint32_t r = side->near[m];
            side->values[r] = sign * seam_at(step, meso_vec3_mad(side->middles[r], 0.5f, side->ways[m]));
        }
}

static MesoStatus list_pulls(MesoRingShares *shares, const RingSide *side, MesoArena *arena, MesoError *error)
{
    uint32_t count = 0, number = 0;
    for (uint32_t m = 0; m < side->near_count; m++)
        count += side->has_other[m];
    uint32_t stride = count / PULLS_MOST + 1;
    shares->pulls_from = MESO_NEW(arena, MesoVec3, count / stride + 1, error);
    shares->pulls_apart = MESO_NEW(arena, MesoVec3, count / stride + 1, error);
    if (!shares->pulls_from || !shares->pulls_apart)
        return MESO_ERR_MEMORY;
    shares->pull_count = 0;
    for (uint32_t m = 0; m < side->near_count; m++)
        if (side->has_other[m] && number++ % stride == 0) {
            shares->pulls_from[shares->pull_count] = side->middles[side->near[m]];
            shares->pulls_apart[shares->pull_count++] = side->ways[m];
        }
    return MESO_OK;
}

MesoStatus meso_strands_share(MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                              MesoArena *arena, MesoError *error)
{
    RingSide old_side, new_side;
    *shares = (MesoRingShares){.places = MESO_NEW(arena, MesoVec3, work->swatch->vertex_count, error)};
    if (!shares->places)
        return MESO_ERR_MEMORY;
    MesoStatus status = make_old(&old_side, step, arena, error);
    if (!status)
        status = make_new(&new_side, shares->places, step, work, arena, error);
    if (status)
        return status;
    find_others(&old_side, &new_side);
    find_others(&new_side, &old_side);
    share_out(&old_side, step, -1);
    share_out(&new_side, step, 1);
    hold_rim(old_side.values, step);
    shares->old_values = old_side.values;
    shares->new_values = new_side.values;
    return list_pulls(shares, &new_side, arena, error);
}
