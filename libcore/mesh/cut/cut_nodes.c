#include "libcore/mesh/cut/cut_nodes.h"

#include <string.h>

#include "libcore/mesh/cut/triangle_split.h"

enum { ONE = MESO_SPLIT_ONE, APART = MESO_SPLIT_APART };

_Static_assert(MESO_CUT_SNAP * MESO_SPLIT_ONE == MESO_SPLIT_APART, "one bound, said twice");

/* ---- sorting ---- */

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, FEW = 64 };

static void sort_few(MesoCutKey *keys, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        MesoCutKey moved = keys[i];
        uint32_t j = i;
        for (; j > 0 && keys[j - 1].key > moved.key; j--)
            keys[j] = keys[j - 1];
        keys[j] = moved;
    }
}

static void sort_by_digit(MesoCutKey *to, const MesoCutKey *from, uint32_t count, uint32_t shift)
{
    uint32_t begin[DIGITS + 1] = {0};
    for (uint32_t i = 0; i < count; i++)
        begin[(from[i].key >> shift) % DIGITS + 1]++;
    for (uint32_t d = 0; d < DIGITS; d++)
        begin[d + 1] += begin[d];
    for (uint32_t i = 0; i < count; i++)
        to[begin[(from[i].key >> shift) % DIGITS]++] = from[i];
}

void meso_cut_sort(MesoCutKey *keys, MesoCutKey *spare, uint32_t count)
{
    uint64_t all = 0;
    bool sorted = true;
    for (uint32_t i = 0; i < count; i++) {
        all |= keys[i].key;
        sorted = sorted && (i == 0 || keys[i - 1].key <= keys[i].key);
    }
    if (sorted)
        return;
    if (count <= FEW) {
        sort_few(keys, count);
        return;
    }
    MesoCutKey *from = keys, *to = spare;
    for (uint32_t shift = 0; shift < 64 && all >> shift; shift += DIGIT_BITS) {
        if ((all >> shift) % DIGITS == 0)
            continue;
        sort_by_digit(to, from, count, shift);
        MesoCutKey *swapped = from;
        from = to;
        to = swapped;
    }
    if (from != keys)
        memcpy(keys, from, count * sizeof *keys);
}

/* ---- one node ---- */

/*
 * How near nodes of an edge may be to each other and to its ends. Where an edge is so short for its place that
 * coordinates would hardly tell the new vertices from the old ones, more than MESO_CUT_SNAP: 64 times their rounding.
 */
static int32_t apart_on(const MesoTriangulation *mesh, uint32_t half_edge)
{
    MesoVec3 a = mesh->positions[mesh->corners[half_edge]];
    MesoVec3 b = mesh->positions[mesh->corners[meso_next_corner(half_edge)]];
    float size = fmaxf(fmaxf(fmaxf(fabsf(a.x), fabsf(a.y)), fabsf(a.z)), fmaxf(fmaxf(fabsf(b.x), fabsf(b.y)), fabsf(b.z)));
    double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z;
    double least = 0x1p-18 * (double)size, length = sqrt(x * x + y * y + z * z);
    if (length * MESO_CUT_SNAP >= least)
        return APART;
    return length > 2 * least ? (int32_t)(ONE * (least / length)) : ONE;
}

static int32_t clamp(int32_t share, int32_t most)
{
    return share < 0 ? 0 : share > most ? most : share;
}

/* Rounding may have carried it a little beyond 0 or 1. */
static bool to_grid(float share, int32_t *whole)
{
    if (!(share > -0.5f && share < 1.5f))
        return false;
    *whole = clamp((int32_t)lrintf(share * ONE), ONE);
    return true;
}

/* At `share` of an edge, by either half-edge: x is the share along the lower one, element that, until it is numbered. */
static MesoCutPlace place_on_edge(const MesoTriangulation *mesh, uint32_t half_edge, int32_t share)
{
    uint32_t lower = meso_cut_lower(mesh, half_edge);
    if (meso_cut_runs_against(mesh, half_edge, lower))
        share = ONE - share;
    int32_t apart = apart_on(mesh, lower);
    if (share >= apart && share <= ONE - apart)
        return (MesoCutPlace){MESO_ON_EDGE, lower, share, 0};
    uint32_t end = share < ONE / 2 ? lower : meso_next_corner(lower);
    return (MesoCutPlace){MESO_AT_VERTEX, mesh->corners[end], 0, 0};
}

static MesoCutPlace place_in_triangle(const MesoTriangulation *mesh, uint32_t triangle, int32_t x, int32_t y)
{
    int32_t weight[3] = {ONE - x - y, x, y};
    uint32_t least = weight[1] < weight[0] ? 1 : 0;
    least = weight[2] < weight[least] ? 2 : least;
    if (weight[least] >= APART)
        return (MesoCutPlace){MESO_IN_TRIANGLE, triangle, x, y};
    int64_t begin = weight[(least + 1) % 3], end = weight[(least + 2) % 3];
    return place_on_edge(mesh, 3 * triangle + (least + 1) % 3, (int32_t)((end * ONE + (begin + end) / 2) / (begin + end)));
}

static bool place_node(MesoCutPlace *place, const MesoTriangulation *mesh, const MesoCutNode *node)
{
    int32_t x, y;
    uint32_t e = node->element;
    switch (node->kind) {
    case MESO_AT_VERTEX:
        *place = (MesoCutPlace){MESO_AT_VERTEX, e, 0, 0};
        return e < mesh->vertex_count;
    case MESO_ON_EDGE:
        if (e / 3 >= mesh->triangle_count || !to_grid(node->share[0], &x))
            return false;
        *place = place_on_edge(mesh, e, x);
        return true;
    case MESO_IN_TRIANGLE:
        if (e >= mesh->triangle_count || !to_grid(node->share[0], &x) || !to_grid(node->share[1], &y))
            return false;
        *place = place_in_triangle(mesh, e, x, clamp(y, ONE - x));
        return true;
    }
    return false;
}

/* ---- all nodes ---- */

static uint32_t place_all(MesoCutNodes *placed, const MesoTriangulation *mesh, const MesoCutLines *lines)
{
    for (uint32_t n = 0; n < lines->node_count; n++)
        if (!place_node(&placed->places[n], mesh, &lines->nodes[n]))
            return n;
    return lines->node_count;
}

static uint32_t list_on_edges(MesoCutKey *keys, const MesoCutPlace *places, uint32_t node_count)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < node_count; n++)
        if (places[n].kind == MESO_ON_EDGE)
            keys[count++] = (MesoCutKey){(uint64_t)places[n].element << 25 | (uint32_t)places[n].x, n};
    return count;
}

/* Goes along each edge: a node near to the last that stands becomes one with it. */
static void number_on_edges(MesoCutNodes *placed, const MesoTriangulation *mesh, const MesoCutKey *keys, uint32_t count)
{
    int32_t apart = 0;
    for (uint32_t i = 0; i < count; i++) {
        MesoCutPlace *place = &placed->places[keys[i].value];
        bool is_first = placed->edge_count == 0 || placed->edges[placed->edge_count - 1].half_edge != place->element;
        if (is_first) {
            placed->edges[placed->edge_count++] = (MesoCutEdge){place->element, placed->share_count, 0};
            apart = apart_on(mesh, place->element);
        }
        if (is_first || place->x - placed->shares[placed->share_count - 1] >= apart) {
            placed->shares[placed->share_count++] = place->x;
            placed->edges[placed->edge_count - 1].count++;
        }
        place->element = placed->share_count - 1;
    }
}

MesoStatus meso_cut_nodes_place(MesoCutNodes *placed, const MesoTriangulation *mesh, const MesoCutLines *lines,
                                MesoArena *arena, MesoError *error)
{
    *placed = (MesoCutNodes){.places = MESO_NEW(arena, MesoCutPlace, lines->node_count, error)};
    MesoCutKey *keys = MESO_NEW(arena, MesoCutKey, lines->node_count, error);
    MesoCutKey *spare = MESO_NEW(arena, MesoCutKey, lines->node_count, error);
    if (!placed->places || !keys || !spare)
        return MESO_ERR_MEMORY;
    uint32_t bad = place_all(placed, mesh, lines);
    if (bad < lines->node_count)
        return meso_fail(error, MESO_ERR_INTERNAL, "node %u of the lines has no place on the mesh", bad);
    uint32_t count = list_on_edges(keys, placed->places, lines->node_count);
    placed->edges = MESO_NEW(arena, MesoCutEdge, count, error);
    placed->shares = MESO_NEW(arena, int32_t, count, error);
    if (!placed->edges || !placed->shares)
        return MESO_ERR_MEMORY;
    meso_cut_sort(keys, spare, count);
    number_on_edges(placed, mesh, keys, count);
    return MESO_OK;
}
