#include "libcore/math/min_cut.h"

#include <string.h>

#include "libcore/base/index.h"

/* Half of an edge: what may still flow along it. */
typedef struct Arc {
    uint32_t target;
    uint32_t twin;      /* the arc back */
    uint64_t room;
} Arc;

typedef struct Network {
    uint32_t node_count;
    uint32_t *begins;   /* [node_count + 1] arcs by the node that they leave */
    Arc *arcs;
    uint64_t *supplies; /* [node_count] what the source may still send to a node */
    uint64_t *demands;  /* [node_count] what the sink may still take from it */
    uint32_t *levels;   /* [node_count] arcs with room on the way to the sink; MESO_NO_INDEX: there is no way */
    uint32_t *next_arcs;    /* [node_count] those before it lead nowhere in this phase */
    uint32_t *queue;    /* [node_count] for levels; then the arcs of a path */
    uint64_t flow;
} Network;

/* More than what all edges can carry together: there are fewer than 2^31, of less than 2^32 each. */
static const uint64_t FIXED = UINT64_MAX / 2;

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
        !(network->arcs = MESO_NEW(scratch, Arc, 2 * (size_t)edge_count, error)) ||
        !(network->supplies = MESO_NEW(scratch, uint64_t, count, error)) ||
        !(network->demands = MESO_NEW(scratch, uint64_t, count, error)) ||
        !(network->levels = MESO_NEW(scratch, uint32_t, count, error)) ||
        !(network->next_arcs = MESO_NEW(scratch, uint32_t, count, error)) ||
        !(network->queue = MESO_NEW(scratch, uint32_t, count, error)))
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
        network->supplies[v] = supply - through;
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

/* ---- phases ---- */

/* How far it is to the sink from wherever there is a way. Returns whether the source has any. */
static int find_levels(Network *network)
{
    uint32_t *levels = network->levels, *queue = network->queue, end = 0;
    int found = 0;
    memset(levels, 0xff, network->node_count * sizeof *levels);
    for (uint32_t v = 0; v < network->node_count; v++)
        if (network->demands[v]) {
            levels[v] = 0;
            queue[end++] = v;
        }
    for (uint32_t begin = 0; begin < end; begin++) {
        uint32_t v = queue[begin];
        found |= network->supplies[v] != 0;
        for (uint32_t k = network->begins[v]; k < network->begins[v + 1]; k++) {
            const Arc *arc = &network->arcs[k];
            if (levels[arc->target] == MESO_NO_INDEX && network->arcs[arc->twin].room) {
                levels[arc->target] = levels[v] + 1;
                queue[end++] = arc->target;
            }
        }
    }
    return found;
}

/* The next arc that leads from `v` one level down; MESO_NO_INDEX where there is none left. */
static uint32_t find_down(Network *network, uint32_t v)
{
    for (uint32_t *k = &network->next_arcs[v]; *k < network->begins[v + 1]; ++*k) {
        const Arc *arc = &network->arcs[*k];
        if (arc->room && network->levels[arc->target] == network->levels[v] - 1)
            return *k;
    }
    return MESO_NO_INDEX;
}

/* Sends what fits along a path of arcs to `end`. Returns how many of the arcs come before the first that is full now. */
static uint32_t send(Network *network, uint32_t start, const uint32_t *path, uint32_t length, uint32_t end)
{
    Arc *arcs = network->arcs;
    uint64_t amount = network->supplies[start] < network->demands[end] ? network->supplies[start]
                                                                       : network->demands[end];
    for (uint32_t k = 0; k < length; k++)
        amount = arcs[path[k]].room < amount ? arcs[path[k]].room : amount;
    uint32_t keep = length;
    for (uint32_t k = length; k-- > 0;) {
        Arc *arc = &arcs[path[k]];
        arc->room -= amount;
        arcs[arc->twin].room += amount;
        if (!arc->room)
            keep = k;
    }
    network->supplies[start] -= amount;
    network->demands[end] -= amount;
    network->flow += amount;
    return keep;
}

/* All that can flow down the levels from one node. A sink's own node has level 0 until it is full. */
static void drain(Network *network, uint32_t start)
{
    uint32_t *path = network->queue, length = 0, v = start;
    while (network->supplies[start]) {
        if (network->levels[v] == 0 && network->demands[v]) {
            length = send(network, start, path, length, v);
            v = length ? network->arcs[path[length - 1]].target : start;
            continue;
        }
        uint32_t down = network->levels[v] == 0 ? MESO_NO_INDEX : find_down(network, v);
        if (down != MESO_NO_INDEX) {
            path[length++] = down;
            v = network->arcs[down].target;
            continue;
        }
        if (!length)
            return;
        uint32_t back = path[--length];
        v = network->arcs[network->arcs[back].twin].target;
        network->next_arcs[v]++;
    }
}

static void run_phase(Network *network)
{
    memcpy(network->next_arcs, network->begins, network->node_count * sizeof *network->next_arcs);
    for (uint32_t v = 0; v < network->node_count; v++)
        if (network->supplies[v] && network->levels[v] != MESO_NO_INDEX)
            drain(network, v);
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
        while (find_levels(&network))
            run_phase(&network);
        /* the last levels are of those nodes that still have a way to the sink */
        for (uint32_t v = 0; v < node_count; v++)
            sink_side[v] = network.levels[v] != MESO_NO_INDEX;
        if (value)
            *value = network.flow;
    }
    meso_arena_rewind(scratch, mark);
    return status;
}
