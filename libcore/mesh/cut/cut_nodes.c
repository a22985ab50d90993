#include "libcore/mesh/cut/cut_nodes.h"

#include <string.h>

#include "libcore/mesh/cut/cut_keys.h"
#include "libcore/mesh/cut/triangle_split.h"

enum { ONE = MESO_SPLIT_ONE, APART = MESO_SPLIT_APART };

/* ---- one node ---- */

static double largest_coordinate(MesoVec3 p)
{
    double x = fabs((double)p.x), y = fabs((double)p.y), z = fabs((double)p.z);
    x = y > x ? y : x;
    return z > x ? z : x;
}

/*
 * How near nodes of an edge may be to each other and to its ends. Where an edge is so short for its place that
 * coordinates would hardly tell the new vertices from the old ones, more than MESO_CUT_SNAP: 64 times their rounding
 * or twice that.
 */
static int32_t apart_on(const MesoTriangulation *mesh, uint32_t half_edge)
{
    MesoVec3 a = mesh->positions[mesh->corners[half_edge]];
    MesoVec3 b = mesh->positions[mesh->corners[meso_next_corner(half_edge)]];
    double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z;
    double size = largest_coordinate(a) + largest_coordinate(b), least = 0x1p-18 * size;
    double length = sqrt(x * x + y * y + z * z);
    if (length * APART >= least * ONE)
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

/* At `share` along either half-edge. Until shares are numbered, x is that along the lower one, and element that. */
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

/* Onto a side where that is near; as near as nodes on sides may not be, where coordinates hold no more. */
static MesoCutPlace place_in_triangle(const MesoTriangulation *mesh, uint32_t triangle, int32_t x, int32_t y)
{
    int32_t weight[3] = {ONE - x - y, x, y}, apart = 0;
    uint32_t least = weight[1] < weight[0] ? 1 : 0;
    least = weight[2] < weight[least] ? 2 : least;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        int32_t on_side = apart_on(mesh, meso_cut_lower(mesh, h));
        apart = on_side > apart ? on_side : apart;
    }
    if (weight[least] >= apart)
        return (MesoCutPlace){MESO_IN_TRIANGLE, triangle, x, y};
    int64_t begin = weight[(least + 1) % 3], end = weight[(least + 2) % 3];
    int64_t share = (end * ONE + (begin + end) / 2) / (begin + end);
    return place_on_edge(mesh, 3 * triangle + (least + 1) % 3, (int32_t)share);
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

static uint32_t count_on_edges(const MesoCutPlace *places, uint32_t node_count)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < node_count; n++)
        count += places[n].kind == MESO_ON_EDGE;
    return count;
}

/* Nodes on edges by edge, along each by share, and where that is equal by number. */
static void list_on_edges(uint64_t *keys, uint64_t *spare, const MesoCutPlace *places, uint32_t node_count)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < node_count; n++)
        if (places[n].kind == MESO_ON_EDGE)
            keys[count++] = meso_cut_key((uint32_t)places[n].x, n);
    meso_cut_sort(keys, spare, count);
    for (uint32_t i = 0; i < count; i++)
        keys[i] = meso_cut_key(places[(uint32_t)keys[i]].element, (uint32_t)keys[i]);
    meso_cut_sort(keys, spare, count);
}

/* Goes along each edge: a node near to the last that stands becomes one with it. */
static void number_on_edges(MesoCutNodes *placed, const MesoTriangulation *mesh, const uint64_t *keys, uint32_t count)
{
    int32_t apart = 0;
    for (uint32_t i = 0; i < count; i++) {
        MesoCutPlace *place = &placed->places[(uint32_t)keys[i]];
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
    if (!placed->places)
        return MESO_ERR_MEMORY;
    uint32_t bad = place_all(placed, mesh, lines);
    if (bad < lines->node_count)
        return meso_fail(error, MESO_ERR_INTERNAL, "node %u of the lines has no place on the mesh", bad);
    uint32_t count = count_on_edges(placed->places, lines->node_count);
    placed->edges = MESO_NEW(arena, MesoCutEdge, count, error);
    placed->shares = MESO_NEW(arena, int32_t, count, error);
    MesoArenaMark mark = meso_arena_mark(arena);
    uint64_t *keys = MESO_NEW(arena, uint64_t, count, error);
    uint64_t *spare = MESO_NEW(arena, uint64_t, count, error);
    if (!placed->edges || !placed->shares || !keys || !spare)
        return MESO_ERR_MEMORY;
    list_on_edges(keys, spare, placed->places, lines->node_count);
    number_on_edges(placed, mesh, keys, count);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}
