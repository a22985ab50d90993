#include "libcore/quilt/swatch/swatch_elements.h"

#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/math/box.h"
#include "libcore/mesh/cut/triangulation.h"

/* An element that is longer than this part of its tile runs through it, closed or not. */
#define THROUGH 0.75f

/* ---- sorting ---- */

typedef struct Sort {
    const MesoSwatch *from;
    uint32_t *element_of;       /* [vertex_count] of `from`, or MESO_NO_INDEX without triangles */
    uint32_t *triangle_to;      /* [triangle_count] its place */
    uint32_t *vertex_to;        /* [vertex_count] its place */
} Sort;

/* Elements are numbered by their first triangle. */
static MesoStatus number_elements(Sort *sort, uint32_t *count, MesoArena *scratch, MesoError *error)
{
    const MesoSwatch *from = sort->from;
    uint32_t *parent = MESO_NEW(scratch, uint32_t, from->vertex_count, error);
    uint32_t *of_root = MESO_NEW(scratch, uint32_t, from->vertex_count, error);
    if (!parent || !of_root)
        return MESO_ERR_MEMORY;
    meso_sets_init(parent, from->vertex_count);
    memset(of_root, 0xff, from->vertex_count * sizeof *of_root);
    for (uint32_t h = 0; h < 3 * from->triangle_count; h++)
        meso_sets_join(parent, from->corners[h], from->corners[meso_next_corner(h)]);
    for (uint32_t h = 0; h < 3 * from->triangle_count; h++) {
        uint32_t *element = &of_root[meso_sets_root(parent, from->corners[h])];
        if (*element == MESO_NO_INDEX)
            *element = (*count)++;
    }
    for (uint32_t v = 0; v < from->vertex_count; v++)
        sort->element_of[v] = of_root[meso_sets_root(parent, v)];
    return MESO_OK;
}

/* Turns numbers of members, at [element + 1], into where they begin; `next` gets the same. */
static void begin_at(uint32_t *begin, uint32_t *next, uint32_t count)
{
    for (uint32_t e = 0; e < count; e++) {
        next[e] = begin[e];
        begin[e + 1] += begin[e];
    }
}

static MesoStatus place_members(MesoSwatch *swatch, Sort *sort, MesoArena *scratch, MesoError *error)
{
    const MesoSwatch *from = sort->from;
    uint32_t count = swatch->element_count;
    uint32_t *next = MESO_NEW(scratch, uint32_t, count, error);
    if (!next)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < from->vertex_count; v++)
        if (sort->element_of[v] != MESO_NO_INDEX)
            swatch->vertex_begin[sort->element_of[v] + 1]++;
    for (uint32_t t = 0; t < from->triangle_count; t++)
        swatch->triangle_begin[sort->element_of[from->corners[3 * t]] + 1]++;
    begin_at(swatch->vertex_begin, next, count);
    for (uint32_t v = 0; v < from->vertex_count; v++)
        sort->vertex_to[v] = sort->element_of[v] == MESO_NO_INDEX ? MESO_NO_INDEX : next[sort->element_of[v]]++;
    begin_at(swatch->triangle_begin, next, count);
    for (uint32_t t = 0; t < from->triangle_count; t++)
        sort->triangle_to[t] = next[sort->element_of[from->corners[3 * t]]]++;
    swatch->vertex_count = swatch->vertex_begin[count];
    swatch->triangle_count = from->triangle_count;
    return MESO_OK;
}

static MesoStatus make_arrays(MesoSwatch *swatch, MesoArena *arena, const MesoSwatch *from, MesoError *error)
{
    uint32_t vertices = swatch->vertex_count, triangles = swatch->triangle_count;
    swatch->positions = MESO_NEW(arena, MesoVec3, vertices, error);
    swatch->normals = MESO_NEW(arena, MesoVec3, vertices, error);
    swatch->uvs = from->uvs ? MESO_NEW(arena, MesoVec2, vertices, error) : NULL;
    swatch->corner_uvs = from->corner_uvs ? MESO_NEW(arena, MesoVec2, 3 * (size_t)triangles, error) : NULL;
    swatch->corners = MESO_NEW(arena, uint32_t, 3 * (size_t)triangles, error);
    swatch->twins = MESO_NEW(arena, uint32_t, 3 * (size_t)triangles, error);
    swatch->materials = MESO_NEW(arena, uint32_t, triangles, error);
    swatch->mates = MESO_NEW(arena, uint32_t, vertices, error);
    swatch->kinds = MESO_NEW(arena, uint8_t, swatch->element_count, error);
    swatch->centres = MESO_NEW(arena, MesoVec3, swatch->element_count, error);
    swatch->radii = MESO_NEW(arena, float, swatch->element_count, error);
    if (!swatch->positions || !swatch->normals || (from->uvs && !swatch->uvs) ||
        (from->corner_uvs && !swatch->corner_uvs) || !swatch->corners || !swatch->twins || !swatch->materials ||
        !swatch->mates || !swatch->kinds || !swatch->centres || !swatch->radii)
        return MESO_ERR_MEMORY;
    return MESO_OK;
}

static void move_members(MesoSwatch *swatch, const Sort *sort)
{
    const MesoSwatch *from = sort->from;
    for (uint32_t v = 0; v < from->vertex_count; v++) {
        uint32_t to = sort->vertex_to[v];
        if (to == MESO_NO_INDEX)
            continue;
        swatch->positions[to] = from->positions[v];
        swatch->normals[to] = from->normals[v];
        uint32_t mate = from->mates ? from->mates[v] : MESO_NO_INDEX;
        swatch->mates[to] = mate == MESO_NO_INDEX ? mate : sort->vertex_to[mate];
        if (from->uvs)
            swatch->uvs[to] = from->uvs[v];
    }
    for (uint32_t h = 0; h < 3 * from->triangle_count; h++) {
        uint32_t to = 3 * sort->triangle_to[h / 3] + h % 3, twin = from->twins[h];
        swatch->corners[to] = sort->vertex_to[from->corners[h]];
        swatch->twins[to] = twin == MESO_NO_INDEX ? twin : 3 * sort->triangle_to[twin / 3] + twin % 3;
        if (from->corner_uvs)
            swatch->corner_uvs[to] = from->corner_uvs[h];
        swatch->materials[to / 3] = from->materials[h / 3];
    }
}

static MesoStatus sort_elements(MesoSwatch *swatch, MesoArena *arena, Sort *sort, MesoArena *scratch, MesoError *error)
{
    const MesoSwatch *from = sort->from;
    sort->element_of = MESO_NEW(scratch, uint32_t, from->vertex_count, error);
    sort->vertex_to = MESO_NEW(scratch, uint32_t, from->vertex_count, error);
    sort->triangle_to = MESO_NEW(scratch, uint32_t, from->triangle_count, error);
    if (!sort->element_of || !sort->vertex_to || !sort->triangle_to)
        return MESO_ERR_MEMORY;
    MesoStatus status = number_elements(sort, &swatch->element_count, scratch, error);
    if (status)
        return status;
    swatch->vertex_begin = MESO_NEW(arena, uint32_t, (size_t)swatch->element_count + 1, error);
    swatch->triangle_begin = MESO_NEW(arena, uint32_t, (size_t)swatch->element_count + 1, error);
    if (!swatch->vertex_begin || !swatch->triangle_begin)
        return MESO_ERR_MEMORY;
    status = place_members(swatch, sort, scratch, error);
    if (!status)
        status = make_arrays(swatch, arena, from, error);
    if (!status)
        move_members(swatch, sort);
    return status;
}

MesoStatus meso_swatch_sort(MesoSwatch *swatch, MesoArena *arena, const MesoSwatch *from, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    Sort sort = {.from = from};
    *swatch = (MesoSwatch){0};
    MesoStatus status = sort_elements(swatch, arena, &sort, &scratch, error);
    meso_arena_release(&scratch);
    return status;
}

/* ---- open ends ---- */

/* Follows the border from half-edge `first` around; `after` [vertex_count] is the half-edge that begins there. */
static void add_loop(MesoSwatch *swatch, uint32_t *after, uint32_t first)
{
    uint32_t end = swatch->loop_begin[swatch->loop_count];
    for (uint32_t h = first; h != MESO_NO_INDEX;) {
        uint32_t vertex = swatch->corners[h], next = swatch->corners[meso_next_corner(h)];
        swatch->loop_vertices[end++] = vertex;
        after[vertex] = MESO_NO_INDEX;
        h = after[next];
    }
    swatch->loop_begin[++swatch->loop_count] = end;
}

MesoStatus meso_swatch_find_loops(MesoSwatch *swatch, MesoArena *arena, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    uint32_t half_edges = 3 * swatch->triangle_count;
    swatch->open_edge_count = swatch->loop_count = 0;
    for (uint32_t h = 0; h < half_edges; h++)
        swatch->open_edge_count += swatch->twins[h] == MESO_NO_INDEX;
    uint32_t *after = MESO_NEW(&scratch, uint32_t, swatch->vertex_count, error);
    swatch->loop_begin = MESO_NEW(arena, uint32_t, (size_t)swatch->open_edge_count / 2 + 2, error);
    swatch->loop_vertices = MESO_NEW(arena, uint32_t, swatch->open_edge_count, error);
    bool there = after && swatch->loop_begin && swatch->loop_vertices;
    if (there)
        memset(after, 0xff, swatch->vertex_count * sizeof *after);
    for (uint32_t h = 0; h < half_edges && there; h++)
        if (swatch->twins[h] == MESO_NO_INDEX)
            after[swatch->corners[h]] = h;
    for (uint32_t h = 0; h < half_edges && there; h++)
        if (swatch->twins[h] == MESO_NO_INDEX && after[swatch->corners[h]] == h)
            add_loop(swatch, after, h);
    meso_arena_release(&scratch);
    return there ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- measures ---- */

static float reach(const MesoVec3 *points, uint32_t count, MesoVec3 centre)
{
    float most = 0;
    for (uint32_t i = 0; i < count; i++) {
        float length = meso_vec2_length((MesoVec2){points[i].x - centre.x, points[i].y - centre.y});
        most = length > most ? length : most;
    }
    return most;
}

void meso_swatch_measure(MesoSwatch *swatch)
{
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        const MesoVec3 *points = swatch->positions + swatch->vertex_begin[e];
        uint32_t count = swatch->vertex_begin[e + 1] - swatch->vertex_begin[e];
        MesoBox box = meso_box_of(points, count);
        swatch->centres[e] = meso_vec3_lerp(box.low, box.high, 0.5f);
        swatch->radii[e] = reach(points, count, swatch->centres[e]);
    }
    double sum = 0;
    uint32_t edges = 0;
    for (uint32_t h = 0; h < 3 * swatch->triangle_count; h++) {
        if (swatch->twins[h] != MESO_NO_INDEX && swatch->twins[h] < h)
            continue;
        MesoVec3 a = swatch->positions[swatch->corners[h]], b = swatch->positions[swatch->corners[meso_next_corner(h)]];
        sum += (double)meso_vec3_length(meso_vec3_sub(b, a));
        edges++;
    }
    swatch->mean_edge = edges ? (float)(sum / edges) : 0;
}

/* ---- kinds ---- */

uint32_t meso_swatch_element(const MesoSwatch *swatch, uint32_t vertex)
{
    uint32_t low = 0, high = swatch->element_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        *(swatch->vertex_begin[middle] <= vertex ? &low : &high) = middle;
    }
    return low;
}

void meso_swatch_find_kinds(MesoSwatch *swatch)
{
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        MesoBox box = meso_box_of(swatch->positions + swatch->vertex_begin[e],
                                  swatch->vertex_begin[e + 1] - swatch->vertex_begin[e]);
        bool through = box.high.x - box.low.x > THROUGH * swatch->size.x ||
                       box.high.y - box.low.y > THROUGH * swatch->size.y;
        swatch->kinds[e] = through ? MESO_ELEMENT_STRAND : MESO_ELEMENT_WHOLE;
    }
    for (uint32_t l = 0; l < swatch->loop_count; l++)
        swatch->kinds[meso_swatch_element(swatch, swatch->loop_vertices[swatch->loop_begin[l]])] = MESO_ELEMENT_STRAND;
}
