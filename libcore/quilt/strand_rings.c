/*
 * Rings of strands: what of a strand lies equally far along it. A strand is cut between two of its rings, where its
 * middle line crosses the seam, however it lies to the seam otherwise: never along it.
 */
#include "libcore/base/disjoint_sets.h"
#include "libcore/quilt/quilt_work.h"
#include "libcore/quilt/swatch/swatch_elements.h"

#include <string.h>

/* Rings reach no further than this share of the swatch's shorter side: what does is no strand, but a sheet. */
#define REACH_MOST 0.25f

/* ---- rings in the swatch ---- */

typedef struct Neighbours {
    uint32_t *begin;            /* [vertex_count + 1] */
    uint32_t *others;           /* [6 * triangle_count] each twice where two triangles have the edge */
} Neighbours;

static MesoStatus list_neighbours(Neighbours *n, const MesoSwatch *swatch, MesoArena *scratch, MesoError *error)
{
    n->begin = MESO_NEW(scratch, uint32_t, (size_t)swatch->vertex_count + 2, error);
    n->others = MESO_NEW(scratch, uint32_t, 6 * (size_t)swatch->triangle_count, error);
    if (!n->begin || !n->others)
        return MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < 3 * swatch->triangle_count; c++)
        n->begin[swatch->corners[c] + 2] += 2;
    for (uint32_t v = 2; v < swatch->vertex_count + 2; v++)
        n->begin[v] += n->begin[v - 1];
    for (uint32_t c = 0; c < 3 * swatch->triangle_count; c++) {
        uint32_t a = swatch->corners[c], b = swatch->corners[meso_next_corner(c)];
        n->others[n->begin[a + 1]++] = b;
        n->others[n->begin[b + 1]++] = a;
    }
    return MESO_OK;
}

/* The first open end of each strand, or its first vertex where it has none. To `queue`; how many there are. */
static uint32_t find_ends(uint32_t *queue, uint8_t *begun, const MesoSwatch *swatch)
{
    uint32_t count = 0;
    for (uint32_t l = 0; l < swatch->loop_count; l++) {
        uint32_t begin = swatch->loop_begin[l], e = meso_swatch_element(swatch, swatch->loop_vertices[begin]);
        for (uint32_t i = begin; i < swatch->loop_begin[l + 1] && !begun[e]; i++)
            queue[count++] = swatch->loop_vertices[i];
        begun[e] = 1;
    }
    for (uint32_t e = 0; e < swatch->element_count; e++)
        if (!begun[e] && swatch->kinds[e] == MESO_ELEMENT_STRAND)
            queue[count++] = swatch->vertex_begin[e];
    return count;
}

/* Steps along edges from the ends that are in the queue. */
static void measure_depths(uint32_t *depths, uint32_t *queue, uint32_t tail, const Neighbours *n, uint32_t vertex_count)
{
    uint32_t head = 0;
    memset(depths, 0xff, vertex_count * sizeof *depths);
    for (uint32_t i = 0; i < tail; i++)
        depths[queue[i]] = 0;
    while (head < tail) {
        uint32_t v = queue[head++];
        for (uint32_t i = n->begin[v]; i < n->begin[v + 1]; i++)
            if (depths[n->others[i]] == MESO_NO_INDEX) {
                depths[n->others[i]] = depths[v] + 1;
                queue[tail++] = n->others[i];
            }
    }
}

/* Numbers sets by their first vertex; vertices of no ring have MESO_NO_INDEX in `of_vertex` and keep it. */
static void number_rings(MesoStrandRings *rings, uint32_t *sets, uint32_t vertex_count)
{
    rings->count = 0;
    for (uint32_t v = 0; v < vertex_count; v++)
        if (rings->of_vertex[v] != MESO_NO_INDEX) {
            uint32_t root = meso_sets_root(sets, v);
            rings->of_vertex[v] = root == v ? rings->count++ : rings->of_vertex[root];
        }
}

static MesoStatus ring_room(MesoStrandRings *rings, MesoArena *arena, MesoError *error)
{
    rings->sizes = MESO_NEW(arena, uint32_t, rings->count, error);
    rings->middles = MESO_NEW(arena, MesoVec3, rings->count, error);
    rings->axes = MESO_NEW(arena, MesoVec3, rings->count, error);
    rings->reaches = MESO_NEW(arena, float, rings->count, error);
    rings->steps = MESO_NEW(arena, float, rings->count, error);
    rings->next = MESO_NEW(arena, uint32_t, 2 * (size_t)rings->count, error);
    if (rings->next)
        memset(rings->next, 0xff, 2 * (size_t)rings->count * sizeof *rings->next);
    return rings->sizes && rings->middles && rings->axes && rings->next && rings->reaches && rings->steps ? MESO_OK : MESO_ERR_MEMORY;
}

static void find_middles(MesoStrandRings *rings, const MesoVec3 *positions, uint32_t vertex_count)
{
    for (uint32_t v = 0; v < vertex_count; v++) {
        uint32_t r = rings->of_vertex[v];
        if (r == MESO_NO_INDEX)
            continue;
        rings->middles[r] = meso_vec3_add(rings->middles[r], positions[v]);
        rings->sizes[r]++;
    }
    for (uint32_t r = 0; r < rings->count; r++)
        if (rings->sizes[r])
            rings->middles[r] = meso_vec3_scale(rings->middles[r], 1 / (float)rings->sizes[r]);
    for (uint32_t v = 0; v < vertex_count; v++) {
        uint32_t r = rings->of_vertex[v];
        if (r == MESO_NO_INDEX)
            continue;
        float reach = meso_vec3_length(meso_vec3_sub(positions[v], rings->middles[r]));
        rings->reaches[r] = reach > rings->reaches[r] ? reach : rings->reaches[r];
    }
}

/* The longer axis of x x^T, by its entries. */
static MesoVec2 longer_axis(const float *moments)
{
    float half = 0.5f * (moments[0] - moments[2]), length = sqrtf(half * half + moments[1] * moments[1]);
    MesoVec2 axis = half >= 0 ? (MesoVec2){half + length, moments[1]} : (MesoVec2){moments[1], length - half};
    float norm = meso_vec2_length(axis);
    return norm > 0 ? (MesoVec2){axis.x / norm, axis.y / norm} : (MesoVec2){0, 0};
}

static void add_next(MesoStrandRings *rings, uint32_t ring, uint32_t other)
{
    uint32_t *next = &rings->next[2 * (size_t)ring];
    if (next[0] == MESO_NO_INDEX)
        next[0] = other;
    else if (next[0] != other && next[1] == MESO_NO_INDEX)
        next[1] = other;
}

/* The two rings that an edge joins, and the way from one to the other; false where it does not. */
static bool joins_rings(uint32_t ends[2], MesoVec3 *way, const MesoStrandRings *rings, const uint32_t *corners,
                        uint32_t c)
{
    ends[0] = rings->of_vertex[corners[c]];
    ends[1] = rings->of_vertex[corners[meso_next_corner(c)]];
    if (ends[0] == ends[1] || ends[0] == MESO_NO_INDEX || ends[1] == MESO_NO_INDEX)
        return false;
    *way = meso_vec3_sub(rings->middles[ends[1]], rings->middles[ends[0]]);
    return true;
}

/*
 * Means over edges to other rings: first which way they go as seen from above, which takes the place of the moments
 * that say so, then the direction itself.
 */
static void find_axes(MesoStrandRings *rings, float *moments, float *edges, const uint32_t *corners,
                      uint32_t corner_count)
{
    uint32_t ends[2];
    MesoVec3 d;
    for (uint32_t c = 0; c < corner_count; c++)
        for (int k = 0; k < 2 && joins_rings(ends, &d, rings, corners, c); k++) {
            float *m = &moments[3 * (size_t)ends[k]];
            m[0] += d.x * d.x;
            m[1] += d.x * d.y;
            m[2] += d.y * d.y;
            add_next(rings, ends[k], ends[1 - k]);
            rings->steps[ends[k]] += meso_vec3_length(d);
            edges[ends[k]]++;
        }
    for (uint32_t r = 0; r < rings->count; r++) {
        MesoVec2 axis = longer_axis(&moments[3 * (size_t)r]);
        moments[3 * (size_t)r] = axis.x;
        moments[3 * (size_t)r + 1] = axis.y;
    }
    for (uint32_t c = 0; c < corner_count; c++)
        for (int k = 0; k < 2 && joins_rings(ends, &d, rings, corners, c); k++) {
            const float *axis = &moments[3 * (size_t)ends[k]];
            float side = d.x * axis[0] + d.y * axis[1] < 0 ? -1 : 1;
            rings->axes[ends[k]] = meso_vec3_mad(rings->axes[ends[k]], side, d);
        }
    for (uint32_t r = 0; r < rings->count; r++) {
        rings->axes[r] = meso_vec3_unit(rings->axes[r], (MesoVec3){0, 0, 0});
        rings->steps[r] = edges[r] > 0 ? rings->steps[r] / edges[r] : 0;
    }
}

/* `scratch` gives back what it lends. */
static MesoStatus measure_rings(MesoStrandRings *rings, const MesoVec3 *positions, uint32_t vertex_count,
                                const uint32_t *corners, uint32_t triangle_count, MesoArena *scratch, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    float *edges = MESO_NEW(scratch, float, rings->count, error);
    float *moments = MESO_NEW(scratch, float, 3 * (size_t)rings->count, error);
    if (!edges || !moments)
        return MESO_ERR_MEMORY;
    find_middles(rings, positions, vertex_count);
    find_axes(rings, moments, edges, corners, 3 * triangle_count);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}

/* Vertices of rings that are none have each a ring to themselves. */
static void split_wide(MesoStrandRings *rings, const MesoSwatch *swatch)
{
    float most = REACH_MOST * (swatch->size.x < swatch->size.y ? swatch->size.x : swatch->size.y);
    uint32_t count = rings->count;
    for (uint32_t v = 0; v < swatch->vertex_count; v++)
        if (rings->of_vertex[v] != MESO_NO_INDEX && rings->reaches[rings->of_vertex[v]] > most)
            rings->of_vertex[v] = count++;
    rings->count = count;
}

MesoStatus meso_strands_find_rings(MesoStrandRings *rings, const MesoSwatch *swatch, MesoArena *arena, MesoError *error)
{
    *rings = (MesoStrandRings){.of_vertex = MESO_NEW(arena, uint32_t, swatch->vertex_count, error)};
    uint32_t *sets = MESO_NEW(arena, uint32_t, swatch->vertex_count, error);
    uint32_t *queue = MESO_NEW(arena, uint32_t, swatch->vertex_count, error);
    uint8_t *begun = MESO_NEW(arena, uint8_t, swatch->element_count, error);
    Neighbours neighbours;
    if (!rings->of_vertex || !sets || !queue || !begun || list_neighbours(&neighbours, swatch, arena, error))
        return MESO_ERR_MEMORY;
    uint32_t *depths = rings->of_vertex;
    measure_depths(depths, queue, find_ends(queue, begun, swatch), &neighbours, swatch->vertex_count);
    meso_sets_init(sets, swatch->vertex_count);
    for (uint32_t c = 0; c < 3 * swatch->triangle_count; c++) {
        uint32_t a = swatch->corners[c], b = swatch->corners[meso_next_corner(c)];
        if (depths[a] == depths[b] && depths[a] != MESO_NO_INDEX)
            meso_sets_join(sets, a, b);
    }
    number_rings(rings, sets, swatch->vertex_count);
    MesoStatus status = ring_room(rings, arena, error);
    if (!status)
        status = measure_rings(rings, swatch->positions, swatch->vertex_count, swatch->corners, swatch->triangle_count,
                               arena, error);
    if (status)
        return status;
    split_wide(rings, swatch);
    status = ring_room(rings, arena, error);
    return status ? status : measure_rings(rings, swatch->positions, swatch->vertex_count, swatch->corners,
                                           swatch->triangle_count, arena, error);
}

/* ---- rings of what is there ---- */

MesoStatus meso_strands_old_rings(MesoStrandRings *rings, const MesoOldGeometry *old, const MesoQuiltWork *work,
                                  MesoArena *arena, MesoError *error)
{
    *rings = (MesoStrandRings){.of_vertex = MESO_NEW(arena, uint32_t, old->vertex_count, error)};
    uint32_t *sets = MESO_NEW(arena, uint32_t, old->vertex_count, error);
    if (!rings->of_vertex || !sets)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < old->vertex_count; v++)
        rings->of_vertex[v] = work->rings.of_vertex[work->composite.vertex_origins[old->vertices[v]]];
    meso_sets_init(sets, old->vertex_count);
    for (uint32_t c = 0; c < 3 * old->triangle_count; c++) {
        uint32_t a = old->corners[c], b = old->corners[meso_next_corner(c)];
        if (rings->of_vertex[a] == rings->of_vertex[b])
            meso_sets_join(sets, a, b);
    }
    number_rings(rings, sets, old->vertex_count);
    MesoStatus status = ring_room(rings, arena, error);
    return status ? status : measure_rings(rings, old->positions, old->vertex_count, old->corners, old->triangle_count,
                                           arena, error);
}
