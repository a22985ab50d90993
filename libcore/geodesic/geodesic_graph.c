/*
 * The graph of "DecoSurf: Recursive Geodesic Patterns on Triangle Meshes"
 * (Nazzaro, Puppo and Pellacini 2020, section 4.2): about 12 arcs a vertex,
 * to its neighbours and to the corners that face the sides of its ring. A
 * corner that faces a side is joined only if the straight line there, in the
 * plane of both triangles, stays inside them: else it would be shorter than
 * any path on the surface.
 */
#include <stdlib.h>

#include "libcore/geodesic/geodesic_solver.h"

typedef struct Arc {
    uint32_t end;
    float length;
} Arc;

struct MesoGeodesicGraph {
    uint32_t vertex_count, queue_room;
    uint32_t *begins;   /* [vertex_count + 1] */
    Arc *arcs;
    uint32_t *queue;    /* [queue_room] a ring */
};

/* ---- arcs ---- */

static MesoVec3 row_position(const MesoGeodesicSolver *solver, uint32_t vertex)
{
    const MesoGeodesicRow *row = &solver->rows[vertex];
    return (MesoVec3){row->x, row->y, row->z};
}

static float side_length(const MesoGeodesicSolver *solver, uint32_t a, uint32_t b)
{
    return meso_vec3_length(meso_vec3_sub(row_position(solver, b), row_position(solver, a)));
}

/* Length of the straight line from the corner that faces `side` to the one across it; INFINITY if it leaves both
 * triangles. */
static float length_across(const MesoGeodesicSolver *solver, uint32_t side)
{
    const MesoTriangulation *mesh = solver->mesh;
    MesoVec3 a = row_position(solver, mesh->corners[side]);
    MesoVec3 along = meso_vec3_sub(row_position(solver, mesh->corners[meso_next_corner(side)]), a);
    MesoVec3 near = meso_vec3_sub(row_position(solver, mesh->corners[meso_previous_corner(side)]), a);
    MesoVec3 far = meso_vec3_sub(row_position(solver, mesh->corners[meso_previous_corner(mesh->twins[side])]), a);
    float l = meso_vec3_length(along);
    float near_x = meso_vec3_dot(near, along) / l, near_y = meso_vec3_length(meso_vec3_cross(near, along)) / l;
    float far_x = meso_vec3_dot(far, along) / l, far_y = meso_vec3_length(meso_vec3_cross(far, along)) / l;
    float crossing = near_x * far_y + far_x * near_y, height = near_y + far_y;
    if (!(crossing >= 0 && crossing <= l * height))
        return INFINITY;
    float x = far_x - near_x;
    return sqrtf(x * x + height * height);
}

/* What is done with each arc from a vertex. */
typedef struct ArcTaker {
    void (*take)(void *context, Arc arc);
    void *context;
} ArcTaker;

/*
 * The arcs from a vertex, by the triangles at it. With a domain, those of its triangles alone. An arc along a side
 * comes with the triangle behind it, and the last at a border on its own; where a domain ends it may come twice.
 */
static void take_arcs(const MesoGeodesicSolver *solver, uint32_t vertex, const MesoDomain *domain, ArcTaker taker)
{
    const MesoTriangulation *mesh = solver->mesh;
    if (mesh->vertex_corner[vertex] == MESO_NO_INDEX)
        return;
    MesoFan fan = meso_fan_first(mesh, vertex);
    uint32_t first = fan.corner;
    bool more = true;
    while (more) {
        uint32_t corner = fan.corner, opposite = meso_next_corner(corner), twin = mesh->twins[opposite];
        bool turned = fan.turned;
        bool border = !meso_fan_next(mesh, &fan);
        more = !border && fan.corner != first;
        if (domain && !meso_domain_has(domain, mesh, corner / 3))
            continue;
        uint32_t entry = mesh->corners[turned ? meso_previous_corner(corner) : meso_next_corner(corner)];
        uint32_t leaving = mesh->corners[turned ? meso_next_corner(corner) : meso_previous_corner(corner)];
        taker.take(taker.context, (Arc){entry, side_length(solver, vertex, entry)});
        if (border || domain)
            taker.take(taker.context, (Arc){leaving, side_length(solver, vertex, leaving)});
        if (twin == MESO_NO_INDEX || (domain && !meso_domain_has(domain, mesh, twin / 3)))
            continue;
        float across = length_across(solver, opposite);
        if (across < INFINITY)
            taker.take(taker.context, (Arc){mesh->corners[meso_previous_corner(twin)], across});
    }
}

/* ---- building ---- */

static void add_arc(void *context, Arc arc)
{
    Arc **end = context;
    *(*end)++ = arc;
}

void meso_geodesic_graph_release(MesoGeodesicGraph *graph)
{
    if (!graph)
        return;
    free(graph->begins);
    free(graph->arcs);
    free(graph->queue);
    free(graph);
}

static MesoGeodesicGraph *new_graph(uint32_t vertex_count, uint64_t arc_bound)
{
    MesoGeodesicGraph *graph = calloc(1, sizeof *graph);
    if (!graph)
        return NULL;
    graph->vertex_count = vertex_count;
    graph->queue_room = vertex_count + 1;
    graph->begins = malloc(((size_t)vertex_count + 1) * sizeof *graph->begins);
    graph->arcs = malloc(arc_bound * sizeof *graph->arcs);
    graph->queue = malloc(graph->queue_room * sizeof *graph->queue);
    if (graph->begins && graph->arcs && graph->queue)
        return graph;
    meso_geodesic_graph_release(graph);
    return NULL;
}

MesoStatus meso_geodesic_graph_make(MesoGeodesicSolver *solver, MesoError *error)
{
    const MesoTriangulation *mesh = solver->mesh;
    uint64_t bound = 6 * (uint64_t)mesh->triangle_count + mesh->vertex_count + 1;
    if (bound > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "a graph of %llu arcs is beyond what can be counted",
                         (unsigned long long)bound);
    MesoGeodesicGraph *graph = new_graph(mesh->vertex_count, bound);
    if (!graph)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: a graph of %llu arcs", (unsigned long long)bound);
    Arc *end = graph->arcs;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        graph->begins[v] = (uint32_t)(end - graph->arcs);
        take_arcs(solver, v, NULL, (ArcTaker){add_arc, &end});
    }
    graph->begins[mesh->vertex_count] = (uint32_t)(end - graph->arcs);
    solver->graph = graph;
    return MESO_OK;
}

/* ---- shortest paths ---- */

/* Small labels first, large labels last (Bertsekas 1993): near to an order by distance, at the price of a list. */
typedef struct Search {
    MesoGeodesicGraph *graph;
    const MesoGeodesicRun *run;
    MesoGeodesicSolver *solver;
    uint32_t front, count;
    double sum;             /* of the distances in the list */
    float from;             /* distance of the vertex whose arcs are taken */
    float reach;            /* nothing beyond is looked for: the target has been met, and its neighbours lie nearer */
} Search;

static uint32_t step(const Search *search, uint32_t place)
{
    return place + 1 == search->graph->queue_room ? 0 : place + 1;
}

static uint32_t back_place(const Search *search)
{
    uint64_t place = (uint64_t)search->front + search->count;
    return (uint32_t)(place >= search->graph->queue_room ? place - search->graph->queue_room : place);
}

static void put_vertex(Search *search, uint32_t vertex, float distance)
{
    uint32_t *queue = search->graph->queue;
    if (search->count == 0 || !(distance < search->solver->rows[queue[search->front]].distance)) {
        queue[back_place(search)] = vertex;
    } else {
        search->front = search->front == 0 ? search->graph->queue_room - 1 : search->front - 1;
        queue[search->front] = vertex;
    }
    search->count++;
}

static uint32_t take_vertex(Search *search)
{
    uint32_t *queue = search->graph->queue;
    double mean = search->sum / search->count;
    for (uint32_t tries = 0; tries < search->count; tries++) {
        uint32_t vertex = queue[search->front];
        if (search->solver->rows[vertex].distance <= mean)
            break;
        queue[back_place(search)] = vertex;
        search->front = step(search, search->front);
    }
    uint32_t vertex = queue[search->front];
    search->front = step(search, search->front);
    search->count--;
    search->sum -= search->solver->rows[vertex].distance;
    search->solver->states[vertex] &= (uint8_t)~MESO_VERTEX_QUEUED;
    return vertex;
}

static float target_reach(const Search *search, uint32_t target, float distance)
{
    MesoOneRing ring = meso_one_ring(&search->solver->rings, target);
    float longest = 0;
    for (uint32_t i = 0; i < ring.count; i++)
        longest = fmaxf(longest, side_length(search->solver, target, ring.spokes[i]));
    return distance + longest;
}

static void lower(Search *search, uint32_t vertex, float distance)
{
    MesoGeodesicRow *row = &search->solver->rows[vertex];
    float before = row->distance;
    if (!(distance <= search->reach) || !meso_geodesic_lowers(search->run, vertex, distance))
        return;
    if (search->solver->states[vertex] & MESO_VERTEX_QUEUED) {
        search->sum -= (double)before - distance;
    } else {
        put_vertex(search, vertex, distance);
        search->sum += distance;
        search->solver->states[vertex] |= MESO_VERTEX_QUEUED;
    }
    row->distance = distance;
    if (vertex == search->run->query->target)
        search->reach = target_reach(search, vertex, distance);
}

static void follow_arc(void *context, Arc arc)
{
    Search *search = context;
    lower(search, arc.end, search->from + arc.length);
}

void meso_geodesic_graph_run(const MesoGeodesicRun *run)
{
    MesoGeodesicGraph *graph = run->solver->graph;
    const MesoGeodesicQuery *query = run->query;
    const MesoDomain *domain = query->domain && query->domain->member ? query->domain : NULL;
    Search search = {.graph = graph, .run = run, .solver = run->solver, .reach = INFINITY};
    for (uint32_t i = 0; i < query->seed_count; i++)
        lower(&search, query->seeds[i].vertex, query->seeds[i].distance * run->solver->scale);
    while (search.count > 0) {
        uint32_t vertex = take_vertex(&search);
        search.from = run->solver->rows[vertex].distance;
        if (domain && run->solver->states[vertex] & MESO_VERTEX_NEAR_WALL)
            take_arcs(run->solver, vertex, domain, (ArcTaker){follow_arc, &search});
        else
            for (uint32_t a = graph->begins[vertex]; a < graph->begins[vertex + 1]; a++)
                lower(&search, graph->arcs[a].end, search.from + graph->arcs[a].length);
    }
}
