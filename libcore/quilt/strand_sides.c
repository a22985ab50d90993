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

/* The mesh that a side is part of. */
typedef struct Source {
    uint32_t vertex_count, triangle_count;
    const uint32_t *corners;    /* [3 * triangle_count] */
    const uint32_t *names, *triangles;  /* of its vertices and triangles; NULL: their own numbers */
    const MesoVec3 *positions;  /* [vertex_count] */
    float *values;              /* [vertex_count] -INFINITY: not there, nor are the triangles around */
    float above, below;         /* triangles that are wanted have a value above, and one below */
} Source;

/* What a vertex's value says. */
enum { IS_THERE = 1, IS_ABOVE = 2, IS_BELOW = 4, IS_KEPT = 8 };

static uint8_t *judge_vertices(const Source *from, MesoArena *arena, MesoError *error)
{
    uint8_t *says = MESO_NEW(arena, uint8_t, from->vertex_count, error);
    for (uint32_t v = 0; says && v < from->vertex_count; v++) {
        float value = from->values[v];
        says[v] = (uint8_t)((value > -INFINITY ? IS_THERE : 0) | (value > from->above ? IS_ABOVE : 0) |
                            (value < from->below ? IS_BELOW : 0) | (value > 0 ? IS_KEPT : 0));
    }
    return says;
}

/* By what all its corners say, and what any of them does. */
static bool is_wanted(uint8_t all, uint8_t any)
{
    return (all & IS_THERE) && (any & (IS_ABOVE | IS_BELOW)) == (IS_ABOVE | IS_BELOW);
}

enum { AT_KEPT = 1, AT_DROPPED = 2, AT_CUT = 3 };

/* Which vertices belong to triangles that are kept, and to such as are not. */
static uint8_t *mark_vertices(const Source *from, const uint8_t *says, MesoArena *arena, MesoError *error)
{
    uint8_t *marks = MESO_NEW(arena, uint8_t, from->vertex_count, error);
    for (uint32_t t = 0; marks && t < from->triangle_count; t++) {
        const uint32_t *corner = &from->corners[3 * (size_t)t];
        uint8_t a = says[corner[0]], b = says[corner[1]], c = says[corner[2]], all = a & b & c;
        if (!is_wanted(all, a | b | c))
            continue;
        for (int k = 0; k < 3; k++)
            marks[corner[k]] |= all & IS_KEPT ? AT_KEPT : AT_DROPPED;
    }
    return marks;
}

/* Lists the triangles that the side is to have: all that are wanted, or those at the cut. */
static MesoStatus list_triangles(MesoStrandSide *side, const Source *from, MesoCutExtent extent, MesoArena *arena,
                                 MesoError *error)
{
    side->triangles = MESO_NEW(arena, uint32_t, from->triangle_count, error);
    const uint8_t *says = judge_vertices(from, arena, error);
    const uint8_t *marks = says && extent == MESO_CUT_ENDS ? mark_vertices(from, says, arena, error) : NULL;
    if (!side->triangles || !says || (extent == MESO_CUT_ENDS && !marks))
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < from->triangle_count; t++) {
        const uint32_t *corner = &from->corners[3 * (size_t)t];
        if (marks && marks[corner[0]] != AT_CUT && marks[corner[1]] != AT_CUT && marks[corner[2]] != AT_CUT)
            continue;
        uint8_t a = says[corner[0]], b = says[corner[1]], c = says[corner[2]];
        if (is_wanted(a & b & c, a | b | c))
            side->triangles[side->triangle_count++] = t;
    }
    return MESO_OK;
}

/* `rings` [vertices of the source]; of the side's vertices they come to be in `here`. */
static MesoStatus take_triangles(MesoStrandSide *side, uint32_t **here, const Source *from, const uint32_t *rings,
                                 MesoArena *arena, MesoError *error)
{
    uint32_t most = side->triangle_count < from->vertex_count / 3 ? 3 * side->triangle_count : from->vertex_count;
    side->positions = MESO_NEW(arena, MesoVec3, most, error);
    side->values = MESO_NEW(arena, float, most, error);
    side->vertices = MESO_NEW(arena, uint32_t, most, error);
    side->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)side->triangle_count, error);
    *here = MESO_NEW(arena, uint32_t, most, error);
    uint32_t *numbers = MESO_NEW(arena, uint32_t, from->vertex_count, error);    /* plus 1; 0: none yet */
    if (!side->positions || !side->values || !side->vertices || !side->corners || !*here || !numbers)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < side->triangle_count; i++) {
        uint32_t t = side->triangles[i];
        for (size_t k = 0; k < 3; k++) {
            uint32_t v = from->corners[3 * (size_t)t + k];
            if (!numbers[v]) {
                uint32_t n = side->vertex_count++;
                side->positions[n] = from->positions[v];
                side->values[n] = from->values[v];
                side->vertices[n] = from->names ? from->names[v] : v;
                (*here)[n] = rings[v];
                numbers[v] = n + 1;
            }
            side->corners[3 * (size_t)i + k] = numbers[v] - 1;
        }
        side->triangles[i] = from->triangles ? from->triangles[t] : t;
    }
    return MESO_OK;
}

/* `rings` [vertices of the source], `axes` by ring. */
static MesoStatus cut_out(MesoStrandSide *side, const Source *from, MesoCutExtent extent, const uint32_t *rings,
                          const MesoVec3 *axes, MesoArena *arena, MesoError *error)
{
    uint32_t *here;
    *side = (MesoStrandSide){0};
    MesoStatus status = list_triangles(side, from, extent, arena, error);
    if (!status)
        status = take_triangles(side, &here, from, rings, arena, error);
    return status ? status : cut_side(side, here, axes, arena, error);
}

static MesoStatus cut_old(MesoStrandSide *side, MesoCutExtent extent, const MesoRingShares *shares,
                          const MesoQuiltStep *step, const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    const MesoOldGeometry *old = &step->old;
    Source from = {old->vertex_count, old->triangle_count, old->corners, old->vertices, old->triangles, old->positions,
                   MESO_NEW(arena, float, old->vertex_count, error), -INFINITY, BAND_EDGES * work->swatch->mean_edge};
    if (!from.values)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < old->vertex_count; v++)
        from.values[v] = shares->old_values[step->old_rings.of_vertex[v]];
    return cut_out(side, &from, extent, step->old_rings.of_vertex, step->old_rings.axes, arena, error);
}

static MesoStatus cut_new(MesoStrandSide *side, MesoCutExtent extent, const MesoRingShares *shares,
                          const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    const MesoSwatch *swatch = work->swatch;
    Source from = {swatch->vertex_count, swatch->triangle_count, swatch->corners, NULL, NULL, shares->places,
                   MESO_NEW(arena, float, swatch->vertex_count, error), 0, INFINITY};
    if (!from.values)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < swatch->vertex_count; v++) {
        uint32_t ring = work->rings.of_vertex[v];
        from.values[v] = ring == MESO_NO_INDEX ? -INFINITY : shares->new_values[ring];
    }
    return cut_out(side, &from, extent, work->rings.of_vertex, shares->new_axes, arena, error);
}

typedef struct Cut {
    MesoStrandSide *old_side, *new_side;
    MesoCutExtent extent;
    const MesoRingShares *shares;
    const MesoQuiltStep *step;
    const MesoQuiltWork *work;
} Cut;

static MesoStatus cut_one(void *context, int side, MesoArena *arena, MesoError *error)
{
    const Cut *cut = context;
    return side ? cut_new(cut->new_side, cut->extent, cut->shares, cut->work, arena, error)
                : cut_old(cut->old_side, cut->extent, cut->shares, cut->step, cut->work, arena, error);
}

MesoStatus meso_strands_cut_shared(MesoStrandSide *old_side, MesoStrandSide *new_side, MesoCutExtent extent,
                                   const MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                                   MesoArena *arena, MesoError *error)
{
    Cut cut = {old_side, new_side, extent, shares, step, work};
    return meso_quilt_both(cut_one, &cut, step, work, arena, error);
}

MesoStatus meso_strands_cut(MesoStrandSide *old_side, MesoStrandSide *new_side, MesoCutExtent extent,
                            MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                            MesoArena *arena, MesoError *error)
{
    MesoStatus status = meso_strands_share(shares, step, work, arena, error);
    return status ? status : meso_strands_cut_shared(old_side, new_side, extent, shares, step, work, arena, error);
}
