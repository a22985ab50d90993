/* Strands along the seam: what both sides have there, cut between rings. */
#include "libcore/quilt/quilt_work.h"

/* Rings of an old strand behind the seam that may be deformed lie within so many edges of the swatch. */
#define BAND_EDGES 12

/* ---- sections ---- */

/* Along the strand, away from its side. */
static MesoVec3 axis_of(const MesoSection *section, MesoVec3 along)
{
    if (meso_vec3_length(along) == 0)
        return meso_vec3_unit(section->area, (MesoVec3){1, 0, 0});
    return meso_vec3_dot(along, section->area) < 0 ? meso_vec3_scale(along, -1) : along;
}

static MesoStatus find_sections(MesoStrandSide *side, const uint32_t *rings, const MesoVec3 *axes, MesoArena *arena, MesoError *error)
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
    side->turns = MESO_NEW(arena, MesoVec3, most, error);
    if (!side->sections || !side->axes || !side->partners || !side->moves || !side->besides || !side->rings || !side->turns)
        return MESO_ERR_MEMORY;
    for (uint32_t l = clip->open_count; l < clip->loop_count; l++) {
        MesoSection *section = &side->sections[side->section_count];
        *section = (MesoSection){.count = clip->loop_begin[l + 1] - clip->loop_begin[l],
                                 .vertices = &clip->loops[clip->loop_begin[l]], .positions = side->clipped};
        meso_section_measure(section);
        side->rings[side->section_count] = rings[clip->ends[2 * (size_t)(section->vertices[0] - clip->kept_count)]];
        side->axes[side->section_count] = axis_of(section, axes[side->rings[side->section_count]]);
        side->partners[side->section_count++] = MESO_NO_INDEX;
    }
    return MESO_OK;
}

/* `rings` [vertex_count] of each vertex; `axes` by ring. */
static MesoStatus cut_side(MesoStrandSide *side, const uint32_t *rings, const MesoVec3 *axes, MesoArena *arena, MesoError *error)
{
    MesoStatus status = meso_clip_whole(&side->clip, arena, side->values, side->vertex_count, side->corners,
                                           side->triangle_count, error);
    if (status)
        return status;
    side->clipped = MESO_NEW(arena, MesoVec3, (size_t)side->clip.kept_count + side->clip.made_count, error);
    if (!side->clipped)
        return MESO_ERR_MEMORY;
    meso_clip_positions(side->clipped, &side->clip, side->positions);
    return find_sections(side, rings, axes, arena, error);
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
    return rings ? cut_side(side, rings, step->old_rings.axes, arena, error) : MESO_ERR_MEMORY;
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
    return rings ? cut_side(side, rings, shares->new_axes, arena, error) : MESO_ERR_MEMORY;
}

MesoStatus meso_strands_cut_shared(MesoStrandSide *old_side, MesoStrandSide *new_side, const MesoRingShares *shares,
                                   const MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena,
                                   MesoError *error)
{
    MesoStatus status = cut_old(old_side, shares, step, work, arena, error);
    return status ? status : cut_new(new_side, shares, work, arena, error);
}

MesoStatus meso_strands_cut(MesoStrandSide *old_side, MesoStrandSide *new_side, MesoRingShares *shares,
                            const MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    MesoStatus status = meso_strands_share(shares, step, work, arena, error);
    return status ? status : meso_strands_cut_shared(old_side, new_side, shares, step, work, arena, error);
}
