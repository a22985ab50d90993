#include "libcore/quilt/seam/seam_cut.h"

#include <string.h>

#include "libcore/math/min_cut.h"
#include "libcore/quilt/seam/seam_line.h"

/* Weights of the four directions between cells, along and across: 1 to 1 / sqrt(2), in whole numbers. */
enum { ALONG = 17, ACROSS = 12, DIRECTIONS = 4 };

static const struct {
    int32_t x, y;
    uint32_t weight;
} STEPS[DIRECTIONS] = {{1, 0, ALONG}, {0, 1, ALONG}, {1, 1, ACROSS}, {-1, 1, ACROSS}};

/* The graph of the free cells: fixed ones are one with the source, which is old, or the sink. */
typedef struct Graph {
    uint32_t node_count, edge_count;
    uint32_t *nodes;            /* [cells] */
    uint32_t *source, *sink;    /* [node_count] */
    MesoCutEdge *edges;
} Graph;

static MesoStatus make_graph(Graph *graph, MesoArena *scratch, size_t cells, const uint8_t *states, MesoError *error)
{
    *graph = (Graph){.nodes = MESO_NEW(scratch, uint32_t, cells, error)};
    if (!graph->nodes)
        return MESO_ERR_MEMORY;
    for (size_t c = 0; c < cells; c++)
        graph->nodes[c] = states[c] == MESO_SEAM_FREE ? graph->node_count++ : MESO_NO_INDEX;
    graph->source = MESO_NEW(scratch, uint32_t, graph->node_count, error);
    graph->sink = MESO_NEW(scratch, uint32_t, graph->node_count, error);
    graph->edges = MESO_NEW_BARE(scratch, MesoCutEdge, (size_t)DIRECTIONS * graph->node_count, error);
    return graph->source && graph->sink && graph->edges ? MESO_OK : MESO_ERR_MEMORY;
}

static void join_cells(Graph *graph, const uint8_t *states, size_t c, size_t d, uint32_t capacity)
{
    if (states[c] == MESO_SEAM_FREE && states[d] == MESO_SEAM_FREE) {
        graph->edges[graph->edge_count++] = (MesoCutEdge){graph->nodes[c], graph->nodes[d], capacity};
        return;
    }
    if ((states[c] != MESO_SEAM_FREE && states[d] != MESO_SEAM_FREE) || states[c] == MESO_SEAM_VOID ||
        states[d] == MESO_SEAM_VOID)
        return;
    size_t free = states[c] == MESO_SEAM_FREE ? c : d, fixed = free == c ? d : c;
    (states[fixed] == MESO_SEAM_OLD ? graph->source : graph->sink)[graph->nodes[free]] += capacity;
}

static void join_neighbours(Graph *graph, const MesoSeamGrid *grid, const uint8_t *states, const uint16_t *costs)
{
    for (uint32_t j = 0; j < grid->rows; j++)
        for (uint32_t i = 0; i < grid->columns; i++)
            for (int k = 0; k < DIRECTIONS; k++) {
                uint32_t x = i + (uint32_t)STEPS[k].x, y = j + (uint32_t)STEPS[k].y;
                if (x >= grid->columns || y >= grid->rows)
                    continue;
                size_t c = (size_t)j * grid->columns + i, d = (size_t)y * grid->columns + x;
                uint32_t cost = (uint32_t)costs[c] + costs[d] + 1;
                join_cells(graph, states, c, d, cost * STEPS[k].weight);
            }
}

/* Void cells take the side of the one before them: of lines from the left, then from the right, then of columns. */
static void fill_void(uint8_t *sides, const MesoSeamGrid *grid)
{
    uint32_t cells = grid->columns * grid->rows;
    const uint32_t steps[2] = {1, grid->columns};
    for (int pass = 0; pass < 4; pass++)
        for (uint32_t i = 0; i < cells; i++) {
            uint32_t at = pass & 1 ? cells - 1 - i : i, step = steps[pass >> 1];
            uint32_t line = pass >> 1 ? at / grid->columns : at % grid->columns;
            uint32_t last = pass >> 1 ? grid->rows - 1 : grid->columns - 1;
            if (sides[at] == MESO_SEAM_VOID && line != (pass & 1 ? last : 0))
                sides[at] = sides[pass & 1 ? at + step : at - step];
        }
    for (uint32_t i = 0; i < cells; i++)
        sides[i] = sides[i] == 1;
}

/* Writes 1 for the cells on the new side. */
static MesoStatus choose_sides(uint8_t *sides, MesoArena *scratch, const MesoSeamGrid *grid, const uint8_t *states,
                               const uint16_t *costs, MesoError *error)
{
    size_t cells = (size_t)grid->columns * grid->rows;
    Graph graph;
    if (make_graph(&graph, scratch, cells, states, error) != MESO_OK)
        return MESO_ERR_MEMORY;
    join_neighbours(&graph, grid, states, costs);
    uint8_t *sink_side = MESO_NEW(scratch, uint8_t, graph.node_count, error);
    if (!sink_side)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_min_cut(sink_side, NULL, scratch, graph.node_count, graph.source, graph.sink,
                                     graph.edges, graph.edge_count, error);
    for (size_t c = 0; c < cells && status == MESO_OK; c++)
        sides[c] = states[c] == MESO_SEAM_FREE ? sink_side[graph.nodes[c]] : states[c];
    if (status == MESO_OK)
        fill_void(sides, grid);
    return status;
}

static MesoStatus measure(MesoSeamGrid *grid, MesoArena *scratch, const uint8_t *sides, MesoError *error)
{
    size_t cells = (size_t)grid->columns * grid->rows;
    MesoSeamLine line;
    MesoStatus status = meso_seam_line_trace(&line, scratch, sides, grid->columns, grid->rows, error);
    if (status == MESO_OK)
        status = meso_seam_line_distances(grid->values, scratch, &line, sides, grid->columns, grid->rows, error);
    for (size_t c = 0; c < cells && status == MESO_OK; c++)
        grid->values[c] *= grid->cell;
    return status;
}

static MesoStatus fill(MesoSeamGrid *grid, float value)
{
    for (size_t c = 0; c < (size_t)grid->columns * grid->rows; c++)
        grid->values[c] = value;
    return MESO_OK;
}

MesoStatus meso_seam_cut(MesoSeamGrid *grid, MesoArena *arena, const uint8_t *states, const uint16_t *costs,
                         MesoError *error)
{
    size_t cells = (size_t)grid->columns * grid->rows;
    if (cells == 0 || cells > 1u << 24)
        return meso_fail(error, MESO_ERR_INTERNAL, "a seam on a grid of %u x %u cells", grid->columns, grid->rows);
    grid->values = MESO_NEW(arena, float, cells, error);
    if (!grid->values)
        return MESO_ERR_MEMORY;
    float far = grid->cell * (float)(grid->columns + grid->rows);
    if (!memchr(states, MESO_SEAM_OLD, cells))
        return fill(grid, far);
    if (!memchr(states, MESO_SEAM_NEW, cells))
        return fill(grid, -far);

    MesoArenaMark mark = meso_arena_mark(arena);
    uint8_t *sides = MESO_NEW(arena, uint8_t, cells, error);
    MesoStatus status = sides ? choose_sides(sides, arena, grid, states, costs, error) : MESO_ERR_MEMORY;
    if (status == MESO_OK)
        status = measure(grid, arena, sides, error);
    meso_arena_rewind(arena, mark);
    return status;
}

/* The cell whose centre lies at or below `x`, in cells from the first centre, and how far on it is. */
static uint32_t cell_below(float x, uint32_t count, float *t)
{
    float last = (float)(count - 1);
    x = x > 0 ? x < last ? x : last : 0;
    uint32_t below = count > 1 && x >= last ? count - 2 : (uint32_t)x;
    *t = x - (float)below;
    return below;
}

float meso_seam_at(const MesoSeamGrid *grid, MesoVec2 point)
{
    float s, t;
    uint32_t i = cell_below((point.x - grid->low.x) / grid->cell - 0.5f, grid->columns, &s);
    uint32_t j = cell_below((point.y - grid->low.y) / grid->cell - 0.5f, grid->rows, &t);
    size_t right = grid->columns > 1, up = grid->rows > 1 ? grid->columns : 0;
    const float *v = &grid->values[(size_t)j * grid->columns + i];
    float below = v[0] + (v[right] - v[0]) * s, above = v[up] + (v[up + right] - v[up]) * s;
    return below + (above - below) * t;
}
