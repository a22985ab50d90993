/* Strands along the seam: what both sides have there, cut between rings. */
#include "libcore/quilt/quilt_work.h"

/* Rings of an old strand behind the seam that may be deformed lie within so many edges of the swatch. */
#define BAND_EDGES 12

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
