/* Strands along the seam: what both sides have there, cut by one curtain, and which sections belong together. */
#include "libcore/quilt/quilt_work.h"

#include <stdlib.h>

/* Rings of an old strand behind the seam that may be deformed lie within so many edges of the swatch. */
#define BAND_EDGES 12

/* Sections are one where their lengths differ by less than this factor. */
#define LENGTH_RATIO 2.0f

/* ---- sections ---- */

/*
 * The direction along a strand, away from its side: the one that is most at right angles to the triangles at the
 * section, the smallest axis of the sum of n n^T. By inverse iteration on the adjugate, which has the same axes.
 */
static MesoVec3 strand_axis(const MesoSection *section, const float *covariance)
{
    double a = covariance[0], b = covariance[1], c = covariance[2], d = covariance[3], e = covariance[4];
    double f = covariance[5], shift = 1e-6 * (a + d + f);
    a += shift;
    d += shift;
    f += shift;
    /* adjugate of the symmetric a b c / b d e / c e f */
    double m[6] = {d * f - e * e, c * e - b * f, b * e - c * d, a * f - c * c, b * c - a * e, a * d - b * b};
    MesoVec3 unit = meso_vec3_unit(section->area, (MesoVec3){1, 0, 0});
    double x = unit.x, y = unit.y, z = unit.z;
    for (int i = 0; i < 8; i++) {
        double u = m[0] * x + m[1] * y + m[2] * z, v = m[1] * x + m[3] * y + m[4] * z;
        double w = m[2] * x + m[4] * y + m[5] * z, length = sqrt(u * u + v * v + w * w);
        if (!(length > 0))
            return unit;
        x = u / length;
        y = v / length;
        z = w / length;
    }
    MesoVec3 axis = {(float)x, (float)y, (float)z};
    return meso_vec3_dot(axis, section->area) < 0 ? meso_vec3_scale(axis, -1) : axis;
}

/* Sums of n n^T over the triangles at each section: six numbers each. */
static void sum_covariances(float *sums, const MesoStrandSide *side, const uint32_t *section_of)
{
    const MesoClip *clip = &side->clip;
    for (uint32_t t = 0; t < clip->triangle_count; t++) {
        const uint32_t *corner = &clip->corners[3 * (size_t)t];
        uint32_t section = MESO_NO_INDEX;
        for (int k = 0; k < 3; k++)
            if (corner[k] >= clip->kept_count && section_of[corner[k] - clip->kept_count] != MESO_NO_INDEX)
                section = section_of[corner[k] - clip->kept_count];
        if (section == MESO_NO_INDEX)
            continue;
        MesoVec3 a = side->clipped[corner[0]];
        MesoVec3 n = meso_vec3_cross(meso_vec3_sub(side->clipped[corner[1]], a), meso_vec3_sub(side->clipped[corner[2]], a));
        n = meso_vec3_unit(n, (MesoVec3){0, 0, 0});
        float *sum = &sums[6 * (size_t)section];
        sum[0] += n.x * n.x;
        sum[1] += n.x * n.y;
        sum[2] += n.x * n.z;
        sum[3] += n.y * n.y;
        sum[4] += n.y * n.z;
        sum[5] += n.z * n.z;
    }
}

static MesoStatus find_sections(MesoStrandSide *side, const uint32_t *rings, MesoArena *arena, MesoError *error)
{
    const MesoClip *clip = &side->clip;
    side->section_count = 0;
    uint32_t most = clip->loop_count - clip->open_count;
    side->sections = MESO_NEW(arena, MesoSection, most, error);
    side->axes = MESO_NEW(arena, MesoVec3, most, error);
    side->partners = MESO_NEW(arena, uint32_t, most, error);
    side->moves = MESO_NEW(arena, MesoVec3, most, error);
    side->besides = MESO_NEW(arena, MesoVec3, most, error);
    side->rings = MESO_NEW(arena, uint32_t, most, error);
    uint32_t *section_of = MESO_NEW(arena, uint32_t, clip->made_count, error);
    float *sums = MESO_NEW(arena, float, 6 * (size_t)most, error);
    if (!side->sections || !side->axes || !side->partners || !side->moves || !side->besides || !side->rings || !section_of || !sums)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < clip->made_count; i++)
        section_of[i] = MESO_NO_INDEX;
    for (uint32_t l = clip->open_count; l < clip->loop_count; l++) {
        MesoSection *section = &side->sections[side->section_count];
        *section = (MesoSection){.count = clip->loop_begin[l + 1] - clip->loop_begin[l],
                                 .vertices = &clip->loops[clip->loop_begin[l]], .positions = side->clipped};
        meso_section_measure(section);
        for (uint32_t i = 0; i < section->count; i++)
            section_of[section->vertices[i] - clip->kept_count] = side->section_count;
        side->rings[side->section_count] = rings[clip->ends[2 * (size_t)(section->vertices[0] - clip->kept_count)]];
        side->partners[side->section_count++] = MESO_NO_INDEX;
    }
    sum_covariances(sums, side, section_of);
    for (uint32_t s = 0; s < side->section_count; s++)
        side->axes[s] = strand_axis(&side->sections[s], &sums[6 * (size_t)s]);
    return MESO_OK;
}

/* `rings` [vertex_count] of each vertex. */
static MesoStatus cut_side(MesoStrandSide *side, const uint32_t *rings, MesoArena *arena, MesoError *error)
{
    MesoStatus status = meso_clip_whole(&side->clip, arena, side->values, side->vertex_count, side->corners,
                                           side->triangle_count, error);
    if (status)
        return status;
    side->clipped = MESO_NEW(arena, MesoVec3, (size_t)side->clip.kept_count + side->clip.made_count, error);
    if (!side->clipped)
        return MESO_ERR_MEMORY;
    meso_clip_positions(side->clipped, &side->clip, side->positions);
    return find_sections(side, rings, arena, error);
}

/* ---- both sides ---- */

static MesoStatus side_room(MesoStrandSide *side, MesoArena *arena, uint32_t vertices, uint32_t triangles,
                            MesoError *error)
{
    *side = (MesoStrandSide){0};
    side->positions = MESO_NEW(arena, MesoVec3, vertices, error);
    side->values = MESO_NEW(arena, float, vertices, error);
    side->vertices = MESO_NEW(arena, uint32_t, vertices, error);
    side->triangles = MESO_NEW(arena, uint32_t, triangles, error);
    side->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)triangles, error);
    return side->positions && side->values && side->vertices && side->triangles && side->corners ? MESO_OK
                                                                                                  : MESO_ERR_MEMORY;
}

/* Adds a triangle of a larger mesh; `numbers` by vertex there, MESO_NO_INDEX where it is new. */
static void add_triangle(MesoStrandSide *side, uint32_t *numbers, const uint32_t *corners, uint32_t triangle,
                         const MesoVec3 *positions, const float *values, const uint32_t *names)
{
    uint32_t *to = &side->corners[3 * (size_t)side->triangle_count];
    for (size_t k = 0; k < 3; k++) {
        uint32_t v = corners[k];
        if (numbers[v] == MESO_NO_INDEX) {
            numbers[v] = side->vertex_count;
            side->positions[side->vertex_count] = positions[v];
            side->values[side->vertex_count] = values[v];
            side->vertices[side->vertex_count++] = names ? names[v] : v;
        }
        to[k] = numbers[v];
    }
    side->triangles[side->triangle_count++] = triangle;
}

/* The rings that a side's vertices are in. */
static uint32_t *rings_of(const MesoStrandSide *side, const uint32_t *numbers, const MesoStrandRings *rings,
                          uint32_t vertex_count, MesoArena *arena, MesoError *error)
{
    uint32_t *here = MESO_NEW(arena, uint32_t, side->vertex_count, error);
    for (uint32_t v = 0; here && v < vertex_count; v++)
        if (numbers[v] != MESO_NO_INDEX)
            here[numbers[v]] = rings->of_vertex[v];
    return here;
}

static MesoStatus cut_old(MesoStrandSide *side, const MesoRingShares *shares, const MesoQuiltStep *step,
                          const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    const MesoOldGeometry *old = &step->old;
    MesoStatus status = side_room(side, arena, old->vertex_count, old->triangle_count, error);
    float *values = MESO_NEW(arena, float, old->vertex_count, error);
    uint32_t *numbers = MESO_NEW(arena, uint32_t, old->vertex_count, error);
    if (status || !values || !numbers)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < old->vertex_count; v++) {
        values[v] = shares->old_values[step->old_rings.of_vertex[v]];
        numbers[v] = MESO_NO_INDEX;
    }
    float band = BAND_EDGES * work->swatch->mean_edge;
    for (uint32_t t = 0; t < old->triangle_count; t++) {
        const uint32_t *corner = &old->corners[3 * (size_t)t];
        if (values[corner[0]] < band || values[corner[1]] < band || values[corner[2]] < band)
            add_triangle(side, numbers, corner, old->triangles[t], old->positions, values, old->vertices);
    }
    uint32_t *rings = rings_of(side, numbers, &step->old_rings, old->vertex_count, arena, error);
    return rings ? cut_side(side, rings, arena, error) : MESO_ERR_MEMORY;
}

static MesoStatus cut_new(MesoStrandSide *side, const MesoRingShares *shares, const MesoQuiltWork *work,
                          MesoArena *arena, MesoError *error)
{
    const MesoSwatch *swatch = work->swatch;
    MesoStatus status = side_room(side, arena, swatch->vertex_count, swatch->triangle_count, error);
    float *values = MESO_NEW(arena, float, swatch->vertex_count, error);
    uint32_t *numbers = MESO_NEW(arena, uint32_t, swatch->vertex_count, error);
    if (status || !values || !numbers)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < swatch->vertex_count; v++) {
        uint32_t ring = work->rings.of_vertex[v];
        values[v] = ring == MESO_NO_INDEX ? -INFINITY : shares->new_values[ring];
        numbers[v] = MESO_NO_INDEX;
    }
    for (uint32_t t = 0; t < swatch->triangle_count; t++) {
        const uint32_t *corner = &swatch->corners[3 * (size_t)t];
        float a = values[corner[0]], b = values[corner[1]], c = values[corner[2]];
        if ((a > 0 || b > 0 || c > 0) && a > -INFINITY && b > -INFINITY && c > -INFINITY)
            add_triangle(side, numbers, corner, t, shares->places, values, NULL);
    }
    uint32_t *rings = rings_of(side, numbers, &work->rings, swatch->vertex_count, arena, error);
    return rings ? cut_side(side, rings, arena, error) : MESO_ERR_MEMORY;
}

MesoStatus meso_strands_cut(MesoStrandSide *old_side, MesoStrandSide *new_side, MesoRingShares *shares,
                            const MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    MesoStatus status = meso_strands_share(shares, step, work, arena, error);
    if (!status)
        status = cut_old(old_side, shares, step, work, arena, error);
    return status ? status : cut_new(new_side, shares, work, arena, error);
}

/* ---- pairs ---- */

typedef struct Candidate {
    float distance;
    uint32_t old_section, new_section;
} Candidate;

static int compare_candidates(const void *a, const void *b)
{
    const Candidate *x = a, *y = b;
    if (x->distance != y->distance)
        return x->distance < y->distance ? -1 : 1;
    if (x->old_section != y->old_section)
        return x->old_section < y->old_section ? -1 : 1;
    return x->new_section < y->new_section ? -1 : x->new_section > y->new_section;
}

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* The middle one of all sections' lengths: that of a strand cut across. `lengths` has room for them. */
static float usual_length(float *lengths, const MesoStrandSide *old_side, const MesoStrandSide *new_side)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < old_side->section_count; i++)
        lengths[count++] = old_side->sections[i].length;
    for (uint32_t j = 0; j < new_side->section_count; j++)
        lengths[count++] = new_side->sections[j].length;
    qsort(lengths, count, sizeof *lengths, compare_floats);
    return count ? lengths[count / 2] : 0;
}

/*
 * How far a section lies beside the other one's way; INFINITY where they cannot be one. Strands that are cut along have
 * long sections, which must not reach further for that.
 */
static float distance_beside(const MesoSection *a, MesoVec3 a_axis, const MesoSection *b, MesoVec3 b_axis, float reach,
                             float usual)
{
    float larger = a->reach > b->reach ? a->reach : b->reach, most = 0.25f * usual;
    larger = larger < most ? larger : most;
    if (a->length > LENGTH_RATIO * b->length || b->length > LENGTH_RATIO * a->length)
        return INFINITY;
    MesoVec3 apart = meso_vec3_sub(b->centre, a->centre);
    if (meso_vec3_length(apart) > 2 * reach * larger + a->reach)
        return INFINITY;
    if (meso_vec3_dot(a_axis, b_axis) > -0.3f)
        return INFINITY;    /* they run past each other */
    MesoVec3 axis = meso_vec3_unit(meso_vec3_sub(a_axis, b_axis), a_axis);
    MesoVec3 beside = meso_vec3_mad(apart, -meso_vec3_dot(apart, axis), axis);
    float distance = meso_vec3_length(beside);
    return distance <= reach * larger ? distance : INFINITY;
}

/* What ends or is cut along, in strands: sections without partner, and how much longer than usual the others are. */
static float count_flaws(const MesoStrandSide *side, float usual)
{
    float flaws = 0;
    for (uint32_t s = 0; s < side->section_count; s++) {
        float length = usual > 0 ? side->sections[s].length / usual : 1;
        if (side->partners[s] == MESO_NO_INDEX)
            flaws += length;
        else
            flaws += length > 1.5f ? length - 1.5f : 0;
    }
    return flaws;
}

typedef struct Pairing {
    MesoStrandSide *old_side, *new_side;
    const MesoRingShares *shares;
    const MesoStrandRings *old_rings, *new_rings;
} Pairing;

/*
 * What both sections of a pair are to move by, so that strands meet. Beside their way as their rings say, each of which
 * knows where the other side has its strand; else each goes on along its axis to the middle between both. And along it,
 * so that it is a step from one to the other.
 */
static void find_moves(const Pairing *p, uint32_t i, uint32_t j)
{
    MesoVec3 a = p->old_side->axes[i], b = p->new_side->axes[j];
    MesoVec3 axis = meso_vec3_unit(meso_vec3_sub(a, b), a);
    MesoVec3 apart = meso_vec3_sub(p->new_side->sections[j].centre, p->old_side->sections[i].centre);
    uint32_t old_ring = p->old_side->rings[i], new_ring = p->new_side->rings[j];
    float along = meso_vec3_dot(apart, axis), step = 0.5f * (p->old_rings->steps[old_ring] + p->new_rings->steps[new_ring]);
    MesoVec3 beside = meso_vec3_mad(apart, -0.5f * along, meso_vec3_sub(a, b));
    if (p->shares->old_has[old_ring] && p->shares->new_has[new_ring])
        beside = meso_vec3_scale(meso_vec3_sub(p->shares->old_ways[old_ring], p->shares->new_ways[new_ring]), 0.5f);
    beside = meso_vec3_mad(beside, -meso_vec3_dot(beside, axis), axis);
    MesoVec3 nearer = meso_vec3_scale(axis, 0.5f * (along - step));
    p->old_side->moves[i] = meso_vec3_mad(nearer, 0.5f, beside);
    p->new_side->moves[j] = meso_vec3_scale(p->old_side->moves[i], -1);
    p->old_side->besides[i] = beside;
    p->new_side->besides[j] = meso_vec3_scale(beside, -1);
}

MesoStatus meso_strands_pair(MesoStrandSide *old_side, MesoStrandSide *new_side, float *flaws, float reach,
                             const MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                             MesoArena *scratch, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    size_t most = (size_t)old_side->section_count * new_side->section_count;
    Candidate *candidates = MESO_NEW(scratch, Candidate, most, error);
    float *lengths = MESO_NEW(scratch, float, (size_t)old_side->section_count + new_side->section_count, error);
    if (!candidates || !lengths)
        return MESO_ERR_MEMORY;
    float usual = usual_length(lengths, old_side, new_side);
    size_t candidate_count = 0;
    for (uint32_t i = 0; i < old_side->section_count; i++) {
        old_side->partners[i] = MESO_NO_INDEX;
        for (uint32_t j = 0; j < new_side->section_count; j++) {
            float distance = distance_beside(&old_side->sections[i], old_side->axes[i], &new_side->sections[j],
                                             new_side->axes[j], reach, usual);
            if (distance < INFINITY)
                candidates[candidate_count++] = (Candidate){distance, i, j};
        }
    }
    for (uint32_t j = 0; j < new_side->section_count; j++)
        new_side->partners[j] = MESO_NO_INDEX;
    qsort(candidates, candidate_count, sizeof *candidates, compare_candidates);
    for (size_t c = 0; c < candidate_count; c++) {
        uint32_t i = candidates[c].old_section, j = candidates[c].new_section;
        if (old_side->partners[i] == MESO_NO_INDEX && new_side->partners[j] == MESO_NO_INDEX) {
            old_side->partners[i] = j;
            new_side->partners[j] = i;
        }
    }
    const Pairing pairing = {old_side, new_side, shares, &step->old_rings, &work->rings};
    for (uint32_t i = 0; i < old_side->section_count; i++)
        if (old_side->partners[i] != MESO_NO_INDEX)
            find_moves(&pairing, i, old_side->partners[i]);
    *flaws = count_flaws(old_side, usual) + count_flaws(new_side, usual);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
