#include "libcore/geodesic/cells/voronoi.h"

#include "libcore/base/parallel.h"
#include "libcore/geodesic/cells/cell_borders.h"
#include "libcore/geodesic/geodesic_solver.h"

/* A range of triangles, and where what it has goes. */
typedef struct Range {
    MesoCellBorders borders;
    uint32_t *shared_number;        /* [borders.shared_count] numbers of all lines' */
    uint32_t first_node, first_segment;
} Range;

/* What a thread has for itself. */
typedef struct Worker {
    MesoArena arena;
    MesoBorderTracer *tracer;
    uint32_t *number;               /* of a range's nodes, by all lines' numbers */
    uint32_t number_room;
    MesoStatus status;
    MesoError error;
} Worker;

typedef struct Tracing {
    const MesoTriangulation *mesh;
    MesoNearestSeeds nearest;
    uint32_t worker_count, range_count;
    Worker workers[MESO_TEAM_MOST];
    Range *ranges;                  /* [range_count] */
    MesoIndexMap edges, vertices;   /* numbers of nodes that several ranges have: by lower half-edge, by vertex */
    MesoCutLines *lines;
    uint64_t node_count, segment_count;     /* of the lines, with those of all ranges so far */
    MesoArena *arena, *scratch;
    MesoError *error;
} Tracing;

/* ---- ranges ---- */

static void trace_some(void *context, uint32_t number, uint64_t begin, uint64_t end)
{
    Tracing *tracing = context;
    Worker *worker = &tracing->workers[number];
    if (!worker->tracer)
        worker->tracer = meso_border_tracer_new(&worker->arena, tracing->mesh, &tracing->nearest, &worker->error);
    if (!worker->tracer || worker->status) {
        worker->status = MESO_ERR_MEMORY;
        return;
    }
    worker->status = meso_cell_borders_trace(&tracing->ranges[begin / MESO_BORDER_RANGE].borders, &worker->arena,
                                             worker->tracer, (uint32_t)begin, (uint32_t)end);
}

/*
 * Numbers the nodes of a range behind those of the ranges before it, but for those that these have. So nodes have the
 * numbers that they would have if all triangles came in a row.
 */
static MesoStatus number_range(Tracing *tracing, Range *range)
{
    const MesoCellBorders *borders = &range->borders;
    uint32_t known_count = 0;
    range->first_node = (uint32_t)tracing->node_count;
    range->first_segment = (uint32_t)tracing->segment_count;
    range->shared_number = MESO_NEW(tracing->scratch, uint32_t, borders->shared_count, tracing->error);
    if (!range->shared_number)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < borders->shared_count; i++) {
        const MesoCutNode *node = &borders->nodes[borders->shared[i]];
        MesoIndexMap *map = node->kind == MESO_ON_EDGE ? &tracing->edges : &tracing->vertices;
        uint32_t *number = meso_index_map_at(map, tracing->scratch, node->element, tracing->error);
        if (!number)
            return MESO_ERR_MEMORY;
        if (*number == MESO_NO_INDEX)
            *number = range->first_node + borders->shared[i] - known_count;
        else
            known_count++;
        range->shared_number[i] = *number;
    }
    tracing->node_count += borders->node_count - known_count;
    tracing->segment_count += borders->segment_count;
    return MESO_OK;
}

static MesoStatus number_ranges(Tracing *tracing)
{
    MesoStatus status = MESO_OK;
    tracing->node_count = tracing->lines->node_count;
    tracing->segment_count = tracing->lines->segment_count;
    for (uint32_t r = 0; r < tracing->range_count && !status; r++)
        status = number_range(tracing, &tracing->ranges[r]);
    return status ? status : meso_cut_lines_reserve(tracing->lines, tracing->arena, tracing->node_count,
                                                    tracing->segment_count, tracing->error);
}

/* Numbers of all lines' for a range's nodes; those that are its own go where they belong. */
static void place_nodes(const Tracing *tracing, const Range *range, uint32_t *number)
{
    const MesoCellBorders *borders = &range->borders;
    uint32_t own = range->first_node;
    for (uint32_t n = 0, s = 0; n < borders->node_count; n++) {
        number[n] = own;
        if (s < borders->shared_count && borders->shared[s] == n)
            number[n] = range->shared_number[s++];
        if (number[n] == own)
            tracing->lines->nodes[own++] = borders->nodes[n];
    }
}

static void place_some(void *context, uint32_t number, uint64_t begin, uint64_t end)
{
    Tracing *tracing = context;
    Worker *worker = &tracing->workers[number];
    for (uint64_t r = begin; r < end && !worker->status; r++) {
        const Range *range = &tracing->ranges[r];
        const MesoCellBorders *borders = &range->borders;
        if (borders->node_count > worker->number_room) {
            worker->number_room = 2 * borders->node_count;
            worker->number = MESO_NEW(&worker->arena, uint32_t, worker->number_room, &worker->error);
            worker->status = worker->number ? MESO_OK : MESO_ERR_MEMORY;
        }
        if (worker->status)
            return;
        place_nodes(tracing, range, worker->number);
        for (uint32_t s = 0; s < borders->segment_count; s++) {
            MesoCutSegment segment = borders->segments[s];
            for (uint32_t k = 0; k < 2; k++)
                segment.node[k] = worker->number[segment.node[k]];
            tracing->lines->segments[range->first_segment + s] = segment;
        }
    }
}

static MesoStatus first_failure(const Tracing *tracing)
{
    for (uint32_t i = 0; i < tracing->worker_count; i++)
        if (tracing->workers[i].status) {
            if (tracing->error)
                *tracing->error = tracing->workers[i].error;
            return tracing->workers[i].status;
        }
    return MESO_OK;
}

static MesoStatus trace_ranges(Tracing *tracing)
{
    uint32_t count = meso_domain_size(tracing->nearest.domain, tracing->mesh);
    tracing->range_count = count / MESO_BORDER_RANGE + (count % MESO_BORDER_RANGE != 0);
    tracing->ranges = MESO_NEW(tracing->scratch, Range, tracing->range_count, tracing->error);
    if (!tracing->ranges)
        return MESO_ERR_MEMORY;
    meso_parallel_team(tracing->worker_count, count, MESO_BORDER_RANGE, trace_some, tracing);
    MesoStatus status = first_failure(tracing);
    if (!status)
        status = number_ranges(tracing);
    if (status)
        return status;
    meso_parallel_team(tracing->worker_count, tracing->range_count, 1, place_some, tracing);
    status = first_failure(tracing);
    if (!status) {
        tracing->lines->node_count = (uint32_t)tracing->node_count;
        tracing->lines->segment_count = (uint32_t)tracing->segment_count;
    }
    return status;
}

/* ---- results ---- */

static void hand_out(const MesoNearestSeeds *nearest, uint32_t *cell, float *distance)
{
    const MesoDomainVertices *vertices = &nearest->vertices;
    for (uint32_t v = meso_domain_vertex_from(vertices, 0); v != MESO_NO_INDEX && (cell || distance);
         v = meso_domain_vertex_from(vertices, v + 1)) {
        const MesoSeedSlots *slots = meso_seed_slots(nearest, v);
        if (cell)
            cell[v] = slots->seed[0];
        if (distance)
            distance[v] = slots->distance[0];
    }
}

static uint32_t count_workers(const MesoGeodesicSolver *solver, const MesoVoronoiQuery *query)
{
    uint32_t count = query->threads ? query->threads : meso_parallel_cores();
    if (query->seed_count < 2 || !meso_geodesic_team_is_worth(solver, query->domain))
        return 1;
    return count < MESO_TEAM_MOST ? count : MESO_TEAM_MOST;
}

MesoStatus meso_voronoi_trace(MesoCutLines *lines, uint32_t *cell, float *distance, MesoArena *arena,
                              const MesoTriangulation *mesh, MesoGeodesicSolver *solver, const MesoVoronoiQuery *query,
                              MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    Tracing tracing = {.mesh = mesh, .lines = lines, .arena = arena, .scratch = &scratch, .error = error,
                       .worker_count = count_workers(solver, query)};
    tracing.nearest = (MesoNearestSeeds){.domain = query->domain, .seed_count = query->seed_count,
                                         .seeds = query->seeds, .threads = tracing.worker_count};
    MesoStatus status = meso_nearest_seeds_find(&tracing.nearest, &scratch, mesh, solver, error);
    if (!status) {
        hand_out(&tracing.nearest, cell, distance);
        status = meso_nearest_seeds_settle(&tracing.nearest, &scratch, mesh, error);
    }
    for (uint32_t i = 0; i < tracing.worker_count; i++)
        meso_arena_init(&tracing.workers[i].arena);
    if (!status)
        status = trace_ranges(&tracing);
    for (uint32_t i = 0; i < tracing.worker_count; i++)
        meso_arena_release(&tracing.workers[i].arena);
    meso_arena_release(&scratch);
    return status;
}
