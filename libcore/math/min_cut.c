#include "libcore/math/min_cut.h"

#include <stdbool.h>
#include <string.h>

#include "libcore/base/index.h"

/* Half of an edge: what may still flow along it. */
typedef struct Arc {
    uint32_t target;
    uint32_t twin;      /* the arc back */
    uint64_t room;
} Arc;

/*
 * What the source feeds is pushed from node to node, from the highest first (Cherkassky and Goldberg, "On Implementing
 * the Push-Relabel Method for the Maximum Flow Problem", 1997), until all that is left has no way to the sink: that is
 * enough for a cut.
 */
typedef struct Network {
    uint32_t node_count;
    uint32_t *begins;   /* [node_count + 1] arcs by the node that they leave */
    Arc *arcs;
    uint64_t *excess;   /* [node_count] what has come to a node, from the source at first, and not gone on */
    uint64_t *demands;  /* [node_count] what the sink may still take from it */
    uint32_t *levels;   /* [node_count] no more than arcs with room on the way to the sink, that last one too */
    uint32_t *next_arcs;    /* [node_count] those before it lead nowhere from this level */
    uint32_t *queue;    /* [node_count] for levels */
    uint32_t *heads;    /* [node_count + 2] by level, the first node that has something to push; MESO_NO_INDEX: none */
    uint32_t *following;    /* [node_count] the next one of that level */
    uint32_t *sizes;    /* [node_count + 2] nodes by level */
    uint32_t highest;   /* level that may have such nodes */
    uint64_t work;      /* since levels were measured */
    uint64_t flow;
} Network;

/* More than what all edges can carry together: there are fewer than 2^31, of less than 2^32 each. */
static const uint64_t FIXED = UINT64_MAX / 2;

/* Levels are measured again after so much work a node: a lift's own, and its arcs. */
enum { LIFT_WORK = 12, WORK_MOST = 6 };

static uint64_t terminal_capacity(uint32_t capacity)
{
    return capacity == MESO_CUT_FIXED ? FIXED : capacity;
}

/* ---- begin ---- */

static MesoStatus allocate(Network *network, MesoArena *scratch, uint32_t edge_count, MesoError *error)
{
    size_t count = network->node_count;
    if (edge_count > UINT32_MAX / 2)
        return meso_fail(error, MESO_ERR_LIMIT, "%u edges are beyond what can be cut", edge_count);
    if (!(network->begins = MESO_NEW(scratch, uint32_t, count + 1, error)) ||
        !(network->arcs = MESO_NEW_BARE(scratch, Arc, 2 * (size_t)edge_count, error)) ||
        !(network->excess = MESO_NEW_BARE(scratch, uint64_t, count, error)) ||
        !(network->demands = MESO_NEW_BARE(scratch, uint64_t, count, error)) ||
        !(network->levels = MESO_NEW_BARE(scratch, uint32_t, count, error)) ||
        !(network->next_arcs = MESO_NEW_BARE(scratch, uint32_t, count, error)) ||
        !(network->queue = MESO_NEW_BARE(scratch, uint32_t, count, error)) ||
        !(network->heads = MESO_NEW_BARE(scratch, uint32_t, count + 2, error)) ||
        !(network->following = MESO_NEW_BARE(scratch, uint32_t, count, error)) ||
        !(network->sizes = MESO_NEW_BARE(scratch, uint32_t, count + 2, error)))
        return MESO_ERR_MEMORY;
    return MESO_OK;
}

/* What the source can send to a node and the sink take from it flows at once. */
static MesoStatus join_terminals(Network *network, const uint32_t *source, const uint32_t *sink, MesoError *error)
{
    for (uint32_t v = 0; v < network->node_count; v++) {
        uint64_t supply = terminal_capacity(source[v]), demand = terminal_capacity(sink[v]);
        uint64_t through = supply < demand ? supply : demand;
        if (through == FIXED)
            return meso_fail(error, MESO_ERR_INPUT, "node %u is fixed to both sides of a cut", v);
        network->excess[v] = supply - through;
        network->demands[v] = demand - through;
        network->flow += through;
    }
    return MESO_OK;
}

/* Nothing need flow to what the source feeds without end, nor from what the sink drains without end. */
static uint64_t arc_room(const uint32_t *source, const uint32_t *sink, uint32_t from, uint32_t to, uint32_t capacity)
{
    return from == to || source[to] == MESO_CUT_FIXED || sink[from] == MESO_CUT_FIXED ? 0 : capacity;
}

static MesoStatus join_edges(Network *network, const uint32_t *source, const uint32_t *sink, const MesoCutEdge *edges,
                             uint32_t edge_count, MesoError *error)
{
    uint32_t *begins = network->begins;
    for (uint32_t e = 0; e < edge_count; e++) {
        if (edges[e].a >= network->node_count || edges[e].b >= network->node_count)
            return meso_fail(error, MESO_ERR_INTERNAL, "edge %u joins nodes %u and %u of %u", e, edges[e].a, edges[e].b,
                             network->node_count);
        begins[edges[e].a]++;
        begins[edges[e].b]++;
    }
    for (uint32_t v = 0; v < network->node_count; v++)
        begins[v + 1] += begins[v];
    for (uint32_t e = edge_count; e-- > 0;) {
        uint32_t a = edges[e].a, b = edges[e].b, forth = --begins[a], back = --begins[b];
        network->arcs[forth] = (Arc){b, back, arc_room(source, sink, a, b, edges[e].capacity)};
        network->arcs[back] = (Arc){a, forth, arc_room(source, sink, b, a, edges[e].capacity)};
    }
    return MESO_OK;
}

/* ---- levels ---- */

/* Has something to push, and a way. */
static void activate(Network *network, uint32_t v)
{
    uint32_t level = network->levels[v];
    network->following[v] = network->heads[level];
    network->heads[level] = v;
    network->highest = level > network->highest ? level : network->highest;
}

/* How far it is to the sink from wherever there is a way; other nodes are out of it. */
static void measure_levels(Network *network)
{
    uint32_t *levels = network->levels, *queue = network->queue, end = 0;
    memset(levels, 0xff, network->node_count * sizeof *levels);
    memset(network->heads, 0xff, ((size_t)network->node_count + 2) * sizeof *network->heads);
    memset(network->sizes, 0, ((size_t)network->node_count + 2) * sizeof *network->sizes);
    network->highest = 0;
    network->work = 0;
    for (uint32_t v = 0; v < network->node_count; v++)
        if (network->demands[v]) {
            levels[v] = 1;
            queue[end++] = v;
        }
    for (uint32_t begin = 0; begin < end; begin++) {
        uint32_t v = queue[begin];
        network->next_arcs[v] = network->begins[v];
        network->sizes[levels[v]]++;
        if (network->excess[v])
            activate(network, v);
        for (uint32_t k = network->begins[v]; k < network->begins[v + 1]; k++) {
            const Arc *arc = &network->arcs[k];
            if (levels[arc->target] == MESO_NO_INDEX && network->arcs[arc->twin].room) {
                levels[arc->target] = levels[v] + 1;
                queue[end++] = arc->target;
            }
        }
    }
}

/* No node is left at a level: none above it has a way to the sink. */
static void cut_off(Network *network, uint32_t level)
{
    for (uint32_t v = 0; v < network->node_count; v++)
        if (network->levels[v] != MESO_NO_INDEX && network->levels[v] > level) {
            network->sizes[network->levels[v]]--;
            network->levels[v] = MESO_NO_INDEX;
        }
    for (uint32_t above = level; above <= network->highest; above++)
        network->heads[above] = MESO_NO_INDEX;
}

/* One above the lowest node that the arcs with room of `v` lead to; MESO_NO_INDEX where there is none. */
static uint32_t level_above(const Network *network, uint32_t v, uint32_t *arc)
{
    uint32_t least = MESO_NO_INDEX;
    *arc = network->begins[v];
    if (network->demands[v])
        return 1;
    for (uint32_t k = network->begins[v]; k < network->begins[v + 1]; k++)
        if (network->arcs[k].room && network->levels[network->arcs[k].target] < least) {
            least = network->levels[network->arcs[k].target];
            *arc = k;
        }
    return least < network->node_count ? least + 1 : MESO_NO_INDEX;
}

/* Whether `v`, which none of its arcs leads down from, has a way at a higher level. */
static bool lift(Network *network, uint32_t v)
{
    uint32_t level = network->levels[v], arc, higher = level_above(network, v, &arc);
    network->work += LIFT_WORK + network->begins[v + 1] - network->begins[v];
    network->levels[v] = higher;
    network->next_arcs[v] = arc;
    if (--network->sizes[level] == 0) {
        network->levels[v] = MESO_NO_INDEX;
        cut_off(network, level);
        return false;
    }
    if (higher == MESO_NO_INDEX)
        return false;
    network->sizes[higher]++;
    network->highest = higher > network->highest ? higher : network->highest;
    return true;
}

/* ---- pushes ---- */

static uint64_t lesser(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static void push_to_sink(Network *network, uint32_t v)
{
    uint64_t amount = lesser(network->excess[v], network->demands[v]);
    network->excess[v] -= amount;
    network->demands[v] -= amount;
    network->flow += amount;
}

/* Along the arcs of `v` that lead one level down. */
static void push_down(Network *network, uint32_t v)
{
    uint32_t below = network->levels[v] - 1, *k = &network->next_arcs[v];
    if (below == 0)
        push_to_sink(network, v);
    for (; *k < network->begins[v + 1] && network->excess[v]; ++*k) {
        Arc *arc = &network->arcs[*k];
        if (!arc->room || network->levels[arc->target] != below)
            continue;
        uint64_t amount = lesser(network->excess[v], arc->room);
        if (!network->excess[arc->target])
            activate(network, arc->target);
        arc->room -= amount;
        network->arcs[arc->twin].room += amount;
        network->excess[arc->target] += amount;
        network->excess[v] -= amount;
        if (!network->excess[v])
            break;      /* there may be more room here */
    }
}

static void push_all(Network *network)
{
    measure_levels(network);
    while (network->highest) {
        uint32_t v = network->heads[network->highest];
        if (v == MESO_NO_INDEX) {
            network->highest--;
            continue;
        }
        network->heads[network->highest] = network->following[v];
        do
            push_down(network, v);
        while (network->excess[v] && lift(network, v));
        if (network->work > WORK_MOST * (uint64_t)network->node_count + network->begins[network->node_count])
            measure_levels(network);
    }
    measure_levels(network);
}

MesoStatus meso_min_cut(uint8_t *sink_side, uint64_t *value, MesoArena *scratch, uint32_t node_count,
                        const uint32_t *source, const uint32_t *sink, const MesoCutEdge *edges, uint32_t edge_count,
                        MesoError *error)
{
    Network network = {.node_count = node_count};
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoStatus status = allocate(&network, scratch, edge_count, error);
    if (!status)
        status = join_terminals(&network, source, sink, error);
    if (!status)
        status = join_edges(&network, source, sink, edges, edge_count, error);
    if (!status) {
        push_all(&network);
        /* the last levels are of those nodes that still have a way to the sink */
        for (uint32_t v = 0; v < node_count; v++)
            sink_side[v] = network.levels[v] != MESO_NO_INDEX;
        if (value)
            *value = network.flow;
    }
    meso_arena_rewind(scratch, mark);
    return status;
}
