/* Cuts of small graphs against all of their cuts, and a grid whose cut is known. */
#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/math/min_cut.h"

enum { MOST = 10, EDGES = 30 };

typedef struct Graph {
    uint32_t node_count, edge_count;
    uint32_t source[MOST], sink[MOST];
    MesoCutEdge edges[EDGES];
} Graph;

/* Small capacities, so that many cuts are alike; now and then the largest there are. */
static uint32_t random_capacity(MesoRandom *random, uint32_t bound)
{
    return meso_random_below(random, 12) == 0 ? UINT32_MAX - 1 : meso_random_below(random, bound);
}

static void make(Graph *graph, MesoRandom *random)
{
    uint32_t bound = 1 + meso_random_below(random, 6);
    *graph = (Graph){.node_count = 1 + meso_random_below(random, MOST), .edge_count = meso_random_below(random, EDGES)};
    for (uint32_t v = 0; v < graph->node_count; v++) {
        uint32_t fate = meso_random_below(random, 8);
        graph->source[v] = fate == 0 ? MESO_CUT_FIXED : fate < 4 ? random_capacity(random, bound) : 0;
        graph->sink[v] = fate == 7 ? MESO_CUT_FIXED : fate > 2 ? random_capacity(random, bound) : 0;
    }
    for (uint32_t e = 0; e < graph->edge_count; e++)
        graph->edges[e] = (MesoCutEdge){meso_random_below(random, graph->node_count),
                                        meso_random_below(random, graph->node_count), random_capacity(random, bound)};
}

/* The sum of a cut, UINT64_MAX where it cuts what is fixed. */
static uint64_t cost_of(const Graph *graph, uint32_t side)
{
    uint64_t sum = 0;
    for (uint32_t v = 0; v < graph->node_count; v++) {
        uint32_t cost = side >> v & 1 ? graph->source[v] : graph->sink[v];
        if (cost == MESO_CUT_FIXED)
            return UINT64_MAX;
        sum += cost;
    }
    for (uint32_t e = 0; e < graph->edge_count; e++)
        if ((side >> graph->edges[e].a & 1) != (side >> graph->edges[e].b & 1))
            sum += graph->edges[e].capacity;
    return sum;
}

/* The least cut with the fewest nodes at the sink is the intersection of all least cuts. */
static void test_all_cuts(void)
{
    MesoRandom random;
    MesoArena arena;
    Graph graph;
    meso_random_init(&random, 1, 0);
    meso_arena_init(&arena);
    for (uint32_t round = 0; round < 3000; round++) {
        uint8_t sides[MOST];
        uint64_t value, least = UINT64_MAX;
        uint32_t fewest = UINT32_MAX, got = 0;
        make(&graph, &random);
        size_t used = arena.used;
        CHECK(!meso_min_cut(sides, &value, &arena, graph.node_count, graph.source, graph.sink, graph.edges,
                            graph.edge_count, NULL));
        CHECK(arena.used == used);
        for (uint32_t side = 0; side < 1u << graph.node_count; side++) {
            uint64_t cost = cost_of(&graph, side);
            fewest = cost < least ? side : cost == least ? fewest & side : fewest;
            least = cost < least ? cost : least;
        }
        for (uint32_t v = 0; v < graph.node_count; v++)
            got |= (uint32_t)sides[v] << v;
        CHECK(value == least && got == fewest);
    }
    meso_arena_release(&arena);
}

/* A wall of cheap edges around the middle of a grid, with a gap that is dearer. */
static void test_grid(void)
{
    enum { SIDE = 50, COUNT = SIDE * SIDE, LOW = 10, HIGH = 30 };
    static uint32_t source[COUNT], sink[COUNT];
    static uint8_t sides[COUNT];
    static MesoCutEdge edges[2 * COUNT];
    MesoArena arena;
    uint32_t edge_count = 0;
    uint64_t value;
    for (uint32_t v = 0; v < COUNT; v++) {
        uint32_t steps[2] = {1, SIDE};
        for (int k = 0; k < 2; k++) {
            uint32_t x = v % SIDE + (k == 0), y = v / SIDE + (k == 1), w = v + steps[k];
            if (x >= SIDE || y >= SIDE)
                continue;
            int in_v = v % SIDE >= LOW && v % SIDE < HIGH && v / SIDE >= LOW && v / SIDE < HIGH;
            int in_w = x >= LOW && x < HIGH && y >= LOW && y < HIGH;
            edges[edge_count++] = (MesoCutEdge){v, w, in_v == in_w ? 100 : v == 20 * SIDE + LOW - 1 ? 90 : 10};
        }
        source[v] = v / SIDE == 0 ? MESO_CUT_FIXED : 0;
        sink[v] = v == 15 * SIDE + 15 || v == 25 * SIDE + 20 ? 5000 : 0;
    }
    meso_arena_init(&arena);
    CHECK(!meso_min_cut(sides, &value, &arena, COUNT, source, sink, edges, edge_count, NULL));
    CHECK(value == 800);    /* around the two sinks themselves: 2 * 4 * 100 */
    for (uint32_t v = 0; v < COUNT; v++)
        CHECK(sides[v] == (v == 15 * SIDE + 15 || v == 25 * SIDE + 20));
    sink[16 * SIDE + 15] = sink[25 * SIDE + 21] = 5000;     /* larger: the wall is cheaper, 79 * 10 + 90 */
    CHECK(!meso_min_cut(sides, &value, &arena, COUNT, source, sink, edges, edge_count, NULL));
    CHECK(value == 880);
    for (uint32_t v = 0; v < COUNT; v++)
        CHECK(sides[v] == (v % SIDE >= LOW && v % SIDE < HIGH && v / SIDE >= LOW && v / SIDE < HIGH));
    meso_arena_release(&arena);
}

static void test_refused(void)
{
    MesoArena arena;
    MesoError error;
    uint8_t sides[2];
    uint32_t ones[2] = {1, MESO_CUT_FIXED};
    MesoCutEdge edge = {0, 2, 1};
    meso_arena_init(&arena);
    CHECK(!meso_min_cut(sides, NULL, &arena, 0, NULL, NULL, NULL, 0, &error));
    CHECK(meso_min_cut(sides, NULL, &arena, 2, ones, ones, NULL, 0, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "node 1 is fixed to both sides of a cut");
    CHECK(meso_min_cut(sides, NULL, &arena, 1, ones, ones, &edge, 1, &error) == MESO_ERR_INTERNAL);
    meso_arena_release(&arena);
}

int main(void)
{
    test_all_cuts();
    test_grid();
    test_refused();
    return 0;
}
