#include "libcore/geodesic/voronoi.h"

#include <stdlib.h>

#include "libcore/base/grow.h"
#include "libcore/base/index_map.h"
#include "libcore/mesh/cut/mesh_cut.h"
#include "libcore/mesh/cut/mesh_domain.h"

enum { SLOTS = 3, EDGE_SEEDS = 2 * SLOTS, OUTLINE_CHANGES = 6 };

/* The nearest seeds of a vertex, by distance and then by number; MESO_NO_INDEX where there are fewer. */
typedef struct Slots {
    float distance[SLOTS];
    uint32_t seed[SLOTS];
} Slots;

/* The cells that an edge begins and ends in, along its lower half-edge. */
typedef struct EdgeCells {
    uint32_t seed[2];
    uint32_t node;          /* between them; MESO_NO_INDEX where they are one */
} EdgeCells;

/* A change from one cell to the next along the outline of a triangle. */
typedef struct Change {
    uint32_t node, before, behind;
} Change;

typedef struct Tracer {
    const MesoTriangulation *mesh;
    const MesoVoronoiQuery *query;
    MesoGeodesicSolver *solver;
    MesoDomainVertices vertices;
    Slots *slots;               /* [vertices.count] */
    float *bound;               /* [vertex_count] what distances from a seed have to be below to matter */
    float *front;               /* [vertex_count] those of a solve; as `bound` before and after it */
    MesoIndexMap edges;         /* by the lower half-edge of an edge: its number among those that are known */
    uint32_t edge_count, edge_room;
    EdgeCells *edge_cells;      /* [edge_count] */
    MesoIndexMap vertex_nodes;
    MesoCutLines *lines;
    MesoArena *arena, *scratch;
    MesoError *error;
} Tracer;

static Slots *slots_of(const Tracer *tracer, uint32_t vertex)
{
    return &tracer->slots[meso_domain_vertex_number(&tracer->vertices, vertex)];
}

/* ---- distances ---- */

static MesoStatus make_room(Tracer *tracer)
{
    MesoStatus status = meso_domain_vertices_init(&tracer->vertices, tracer->scratch, tracer->mesh,
                                                  tracer->query->domain, tracer->error);
    if (status)
        return status;
    tracer->slots = MESO_NEW(tracer->scratch, Slots, tracer->vertices.count, tracer->error);
    tracer->bound = MESO_NEW(tracer->scratch, float, tracer->mesh->vertex_count, tracer->error);
    tracer->front = MESO_NEW(tracer->scratch, float, tracer->mesh->vertex_count, tracer->error);
    if (!tracer->slots || !tracer->bound || !tracer->front)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < tracer->vertices.count; i++)
        for (uint32_t k = 0; k < SLOTS; k++) {
            tracer->slots[i].distance[k] = INFINITY;
            tracer->slots[i].seed[k] = MESO_NO_INDEX;
        }
    return MESO_OK;
}

/* A seed at a vertex is that vertex; the corners of its triangle know one that is inside. Returns how many. */
static uint32_t plant(const MesoTriangulation *mesh, const MesoMeshPoint *point, MesoGeodesicSeed planted[3])
{
    const uint32_t *corners = mesh->corners + 3 * (size_t)point->triangle;
    MesoVec3 place = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++) {
        if (point->weight[k] >= 1) {
            planted[0] = (MesoGeodesicSeed){corners[k], 0, false};
            return 1;
        }
        place = meso_vec3_mad(place, point->weight[k], mesh->positions[corners[k]]);
    }
    for (uint32_t k = 0; k < 3; k++) {
        float distance = meso_vec3_length(meso_vec3_sub(mesh->positions[corners[k]], place));
        planted[k] = (MesoGeodesicSeed){corners[k], distance, false};
    }
    return 3;
}

/* Distances from the nearest of all seeds, in `front`. */
static MesoStatus solve_together(Tracer *tracer)
{
    const MesoVoronoiQuery *query = tracer->query;
    size_t room = 3 * (size_t)query->seed_count;
    MesoGeodesicSeed *planted = MESO_NEW(tracer->scratch, MesoGeodesicSeed, room, tracer->error);
    if (!planted)
        return MESO_ERR_MEMORY;
    MesoGeodesicQuery all = {.domain = query->domain, .seeds = planted, .target = MESO_NO_INDEX};
    for (uint32_t i = 0; i < query->seed_count; i++)
        all.seed_count += plant(tracer->mesh, &query->seeds[i], planted + all.seed_count);
    return meso_geodesic_solve(tracer->solver, &all, tracer->front, NULL, NULL, tracer->error);
}

/* The square of a vertex's longest side, in `bound`. */
static void find_longest_sides(Tracer *tracer)
{
    const MesoTriangulation *mesh = tracer->mesh;
    uint32_t count = meso_domain_size(tracer->query->domain, mesh);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *corners = mesh->corners + 3 * (size_t)meso_domain_triangle(tracer->query->domain, i);
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = corners[k], b = corners[k == 2 ? 0 : k + 1];
            MesoVec3 side = meso_vec3_sub(mesh->positions[a], mesh->positions[b]);
            float square = meso_vec3_dot(side, side);
            tracer->bound[a] = square > tracer->bound[a] ? square : tracer->bound[a];
            tracer->bound[b] = square > tracer->bound[b] ? square : tracer->bound[b];
        }
    }
}

/*
 * A front has to go where its seed is the nearest of a vertex, or of the other end of one of its sides: there each of
 * two seeds is nearer or farther by the side's length at most. A little more, for what rounding and fronts that mix
 * take off the least distance.
 */
static void find_bounds(Tracer *tracer)
{
    const float reach = 2.1f;
    find_longest_sides(tracer);
    for (uint32_t v = meso_domain_vertex_from(&tracer->vertices, 0); v != MESO_NO_INDEX;
         v = meso_domain_vertex_from(&tracer->vertices, v + 1))
        tracer->front[v] = tracer->bound[v] = tracer->front[v] + reach * sqrtf(tracer->bound[v]);
}

static bool comes_before(float distance, uint32_t seed, const Slots *slots, uint32_t k)
{
    return distance < slots->distance[k] || (distance == slots->distance[k] && seed < slots->seed[k]);
}

static void put_slot(Slots *slots, uint32_t seed, float distance)
{
    uint32_t k = SLOTS;
    while (k > 0 && comes_before(distance, seed, slots, k - 1)) {
        k--;
        if (k + 1 < SLOTS) {
            slots->distance[k + 1] = slots->distance[k];
            slots->seed[k + 1] = slots->seed[k];
        }
    }
    if (k < SLOTS) {
        slots->distance[k] = distance;
        slots->seed[k] = seed;
    }
}

/* Distances from one seed, where it matters. */
static MesoStatus solve_alone(Tracer *tracer, uint32_t seed)
{
    MesoGeodesicSeed planted[3];
    const uint32_t *touched;
    uint32_t touched_count;
    MesoGeodesicQuery one = {.domain = tracer->query->domain, .seeds = planted, .target = MESO_NO_INDEX, .keep = true};
    one.seed_count = plant(tracer->mesh, &tracer->query->seeds[seed], planted);
    MesoStatus status = meso_geodesic_solve(tracer->solver, &one, tracer->front, &touched, &touched_count,
                                            tracer->error);
    for (uint32_t i = 0; i < touched_count && !status; i++) {
        put_slot(slots_of(tracer, touched[i]), seed, tracer->front[touched[i]]);
        tracer->front[touched[i]] = tracer->bound[touched[i]];
    }
    return status;
}

/* A seed and its triangle. */
typedef struct SeedPlace {
    uint32_t triangle, seed;
} SeedPlace;

static int by_triangle(const void *a, const void *b)
{
    const SeedPlace *p = a, *q = b;
    int order = (p->triangle > q->triangle) - (p->triangle < q->triangle);
    return order ? order : (p->seed > q->seed) - (p->seed < q->seed);
}

/* One after another in the order of their triangles: what one has touched, the next finds in the caches. */
static MesoStatus solve_each(Tracer *tracer)
{
    uint32_t count = tracer->query->seed_count;
    SeedPlace *places = MESO_NEW(tracer->scratch, SeedPlace, count, tracer->error);
    if (!places)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        places[i] = (SeedPlace){tracer->query->seeds[i].triangle, i};
    qsort(places, count, sizeof *places, by_triangle);
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < count && !status; i++)
        status = solve_alone(tracer, places[i].seed);
    return status;
}

/*
 * Seeds that are nearly as near as the nearest are as near: borders that would cross a side within MESO_CUT_SNAP of its
 * length from the vertex go through the vertex then, in all of its triangles. Along a side of length l the distances
 * of two seeds come nearer by 2 l at most, and bounds are a little more than that above the distance.
 */
static void level_slots(Tracer *tracer)
{
    for (uint32_t v = meso_domain_vertex_from(&tracer->vertices, 0); v != MESO_NO_INDEX;
         v = meso_domain_vertex_from(&tracer->vertices, v + 1)) {
        Slots *slots = slots_of(tracer, v);
        float least = slots->distance[0], snap = MESO_CUT_SNAP * (tracer->bound[v] - least);
        for (uint32_t k = 1; k < SLOTS; k++)
            if (slots->distance[k] - least <= snap)
                slots->distance[k] = least;
    }
}

static MesoStatus solve(Tracer *tracer)
{
    MesoStatus status = make_room(tracer);
    if (!status)
        status = solve_together(tracer);
    if (status)
        return status;
    find_bounds(tracer);
    status = solve_each(tracer);
    level_slots(tracer);
    return status;
}

/* ---- sides ---- */

static double slot_distance(const Slots *slots, uint32_t seed)
{
    for (uint32_t k = 0; k < SLOTS; k++)
        if (slots->seed[k] == seed)
            return slots->distance[k];
    return INFINITY;
}

/* A seed's distances at the two ends of a side. */
typedef struct EndDistances {
    uint32_t seed;
    double at[2];
} EndDistances;

/* The nearest seeds of both ends; they are at most the side's length farther at the other one. */
static uint32_t seeds_of_side(const Slots *ends[2], double length, EndDistances found[EDGE_SEEDS])
{
    uint32_t count = 0;
    for (uint32_t end = 0; end < 2; end++)
        for (uint32_t k = 0; k < SLOTS && ends[end]->distance[k] == ends[end]->distance[0]; k++) {
            double own = ends[end]->distance[k], other = slot_distance(ends[1 - end], ends[end]->seed[k]);
            other = fmin(other, own + length);
            found[count++] = (EndDistances){ends[end]->seed[k], {end == 0 ? own : other, end == 0 ? other : own}};
        }
    return count;
}

/*
 * The nearest at one end, of several the one at the other end; where two are equal all along, the one at the corner
 * that faces the side, so that the side belongs to the cell on one of its sides at least; and then the lowest.
 */
static const EndDistances *nearest_at(const EndDistances *seeds, uint32_t count, uint32_t end, const Slots *facing)
{
    const EndDistances *nearest = &seeds[0];
    for (uint32_t i = 1; i < count; i++) {
        const EndDistances *other = &seeds[i];
        double here = slot_distance(facing, nearest->seed), there = slot_distance(facing, other->seed);
        if (other->at[end] != nearest->at[end]           ? other->at[end] < nearest->at[end]
            : other->at[1 - end] != nearest->at[1 - end] ? other->at[1 - end] < nearest->at[1 - end]
            : there != here                              ? there < here : other->seed < nearest->seed)
            nearest = other;
    }
    return nearest;
}

/*
 * Seeds that are equally near at one end do not change places along the edge, and so there is one change at most; a
 * third one that would come between is left out, for it would have an island there.
 */
static MesoStatus divide_edge(Tracer *tracer, uint32_t half_edge, EdgeCells *cells)
{
    const MesoTriangulation *mesh = tracer->mesh;
    uint32_t a = mesh->corners[half_edge], b = mesh->corners[meso_next_corner(half_edge)];
    const Slots *ends[2] = {slots_of(tracer, a), slots_of(tracer, b)};
    EndDistances seeds[EDGE_SEEDS];
    float length = meso_vec3_length(meso_vec3_sub(mesh->positions[a], mesh->positions[b]));
    uint32_t count = seeds_of_side(ends, length, seeds);
    bool inside = meso_domain_holds(tracer->query->domain, mesh, half_edge / 3);
    uint32_t facing = mesh->corners[meso_previous_corner(inside ? half_edge : mesh->twins[half_edge])];
    const EndDistances *first = nearest_at(seeds, count, 0, slots_of(tracer, facing));
    const EndDistances *last = nearest_at(seeds, count, 1, slots_of(tracer, facing));
    *cells = (EdgeCells){{first->seed, last->seed}, MESO_NO_INDEX};
    if (first->seed == last->seed)
        return MESO_OK;
    double begin = last->at[0] - first->at[0], end = first->at[1] - last->at[1];
    MesoCutNode node = {MESO_ON_EDGE, half_edge, {(float)(begin / (begin + end))}};
    return meso_cut_add_node(tracer->lines, tracer->arena, node, &cells->node, tracer->error);
}

/* ---- triangles ---- */

/* What an outline has come through. */
typedef struct Outline {
    uint32_t count;
    Change changes[OUTLINE_CHANGES];
    uint32_t first, seed;       /* the cells it has begun in, and come to; MESO_NO_INDEX at first */
} Outline;

static void change_to(Outline *outline, uint32_t node, uint32_t seed)
{
    outline->changes[outline->count++] = (Change){node, outline->seed, seed};
    outline->seed = seed;
}

static MesoStatus change_at_vertex(Tracer *tracer, Outline *outline, uint32_t vertex, uint32_t seed)
{
    uint32_t *node = meso_index_map_at(&tracer->vertex_nodes, tracer->scratch, vertex, tracer->error);
    if (!node)
        return MESO_ERR_MEMORY;
    MesoStatus status = MESO_OK;
    if (*node == MESO_NO_INDEX)
        status = meso_cut_add_node(tracer->lines, tracer->arena, (MesoCutNode){MESO_AT_VERTEX, vertex, {0, 0}}, node,
                                   tracer->error);
    change_to(outline, *node, seed);
    return status;
}

static MesoStatus find_edge(Tracer *tracer, uint32_t edge, EdgeCells *cells)
{
    uint32_t *number = meso_index_map_at(&tracer->edges, tracer->scratch, edge, tracer->error);
    if (!number)
        return MESO_ERR_MEMORY;
    if (*number != MESO_NO_INDEX) {
        *cells = tracer->edge_cells[*number];
        return MESO_OK;
    }
    *number = tracer->edge_count;
    tracer->edge_cells = MESO_GROW(tracer->scratch, tracer->edge_cells, tracer->edge_count, tracer->edge_room, 256,
                                   tracer->error);
    if (!tracer->edge_cells)
        return MESO_ERR_MEMORY;
    MesoStatus status = divide_edge(tracer, edge, cells);
    tracer->edge_cells[tracer->edge_count++] = *cells;
    return status;
}

/* Goes on along a side, which may begin in another cell than the one before has ended in. */
static MesoStatus add_side(Tracer *tracer, uint32_t half_edge, Outline *outline)
{
    const uint32_t *corners = tracer->mesh->corners;
    uint32_t twin = tracer->mesh->twins[half_edge], edge = twin < half_edge ? twin : half_edge;
    EdgeCells cells;
    MesoStatus status = find_edge(tracer, edge, &cells);
    if (status)
        return status;
    bool same = corners[edge] == corners[half_edge];
    uint32_t begin = cells.seed[same ? 0 : 1], end = cells.seed[same ? 1 : 0];
    if (outline->seed == MESO_NO_INDEX)
        outline->first = outline->seed = begin;
    else if (outline->seed != begin)
        status = change_at_vertex(tracer, outline, corners[half_edge], begin);
    if (begin != end)
        change_to(outline, cells.node, end);
    return status;
}

/* Weights of the point at which three seeds are equally far; false where it is not inside. */
static bool meeting_point(const Tracer *tracer, uint32_t triangle, const Change *outline, double weight[3])
{
    double d[3][2];     /* by corner: how much farther the second and the third seed are than the first */
    for (uint32_t k = 0; k < 3; k++) {
        const Slots *slots = slots_of(tracer, tracer->mesh->corners[3 * (size_t)triangle + k]);
        double first = slot_distance(slots, outline[0].before);
        d[k][0] = slot_distance(slots, outline[1].before) - first;
        d[k][1] = slot_distance(slots, outline[2].before) - first;
    }
    double sum = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t a = (k + 1) % 3, b = (k + 2) % 3;
        weight[k] = d[a][0] * d[b][1] - d[a][1] * d[b][0];
        sum += weight[k];
    }
    for (uint32_t k = 0; k < 3; k++) {
        weight[k] /= sum;
        if (!(weight[k] > 0 && weight[k] < 1))
            return false;
    }
    return true;
}

static void middle_of_changes(const Tracer *tracer, uint32_t triangle, const Change *outline, uint32_t count,
                              double weight[3])
{
    const uint32_t *corners = tracer->mesh->corners;
    weight[0] = weight[1] = weight[2] = 0;
    for (uint32_t i = 0; i < count; i++) {
        const MesoCutNode *node = &tracer->lines->nodes[outline[i].node];
        bool at_vertex = node->kind == MESO_AT_VERTEX;
        uint32_t begin = at_vertex ? node->element : corners[node->element];
        uint32_t end = at_vertex ? node->element : corners[meso_next_corner(node->element)];
        double share = at_vertex ? 0 : node->share[0];
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t corner = corners[3 * triangle + k];
            weight[k] += (corner == begin ? 1 - share : corner == end ? share : 0) / count;
        }
    }
}

static MesoStatus add_segment(Tracer *tracer, uint32_t triangle, const Change *from, uint32_t to)
{
    uint32_t line = from->before < from->behind ? from->before : from->behind;
    MesoCutSegment segment = {{from->node, to}, triangle, line};
    return meso_cut_add_segment(tracer->lines, tracer->arena, segment, tracer->error);
}

/* Joins all changes of a triangle's outline to one node inside. */
static MesoStatus add_star(Tracer *tracer, uint32_t triangle, const Change *outline, uint32_t count)
{
    double weight[3];
    uint32_t middle;
    bool three = count == 3 && outline[0].before != outline[1].before && outline[1].before != outline[2].before &&
                 outline[2].before != outline[0].before;
    if (!three || !meeting_point(tracer, triangle, outline, weight))
        middle_of_changes(tracer, triangle, outline, count, weight);
    MesoCutNode node = {MESO_IN_TRIANGLE, triangle, {(float)weight[1], (float)weight[2]}};
    MesoStatus status = meso_cut_add_node(tracer->lines, tracer->arena, node, &middle, tracer->error);
    for (uint32_t i = 0; i < count && !status; i++)
        status = add_segment(tracer, triangle, &outline[i], middle);
    return status;
}

/* Whether all corners know the same one seed as the nearest, or one of them none at all. */
static bool is_in_one_cell(const Slots *const slots[3])
{
    bool same = true;
    for (uint32_t k = 0; k < 3; k++) {
        if (slots[k]->seed[0] == MESO_NO_INDEX)
            return true;
        same = same && slots[k]->seed[0] == slots[0]->seed[0] && slots[k]->distance[1] > slots[k]->distance[0];
    }
    return same;
}

static MesoStatus trace_triangle(Tracer *tracer, uint32_t triangle)
{
    const uint32_t *corners = tracer->mesh->corners + 3 * (size_t)triangle;
    const Slots *slots[3] = {slots_of(tracer, corners[0]), slots_of(tracer, corners[1]), slots_of(tracer, corners[2])};
    if (is_in_one_cell(slots))
        return MESO_OK;
    Outline outline = {.seed = MESO_NO_INDEX};
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 3 && !status; k++)
        status = add_side(tracer, 3 * triangle + k, &outline);
    if (!status && outline.seed != outline.first)
        status = change_at_vertex(tracer, &outline, corners[0], outline.first);
    if (status || outline.count == 0)
        return status;
    return outline.count == 2 ? add_segment(tracer, triangle, &outline.changes[0], outline.changes[1].node)
                              : add_star(tracer, triangle, outline.changes, outline.count);
}

/* ---- results ---- */

static void hand_out(const Tracer *tracer, uint32_t *cell, float *distance)
{
    const MesoDomainVertices *vertices = &tracer->vertices;
    for (uint32_t v = meso_domain_vertex_from(vertices, 0); v != MESO_NO_INDEX;
         v = meso_domain_vertex_from(vertices, v + 1)) {
        const Slots *slots = slots_of(tracer, v);
        if (cell)
            cell[v] = slots->seed[0];
        if (distance)
            distance[v] = slots->distance[0];
    }
}

MesoStatus meso_voronoi_trace(MesoCutLines *lines, uint32_t *cell, float *distance, MesoArena *arena,
                              const MesoTriangulation *mesh, MesoGeodesicSolver *solver, const MesoVoronoiQuery *query,
                              MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    Tracer tracer = {.mesh = mesh, .query = query, .solver = solver, .lines = lines, .arena = arena,
                     .scratch = &scratch, .error = error};
    MesoStatus status = solve(&tracer);
    uint32_t count = meso_domain_size(query->domain, mesh);
    for (uint32_t i = 0; i < count && !status; i++)
        status = trace_triangle(&tracer, meso_domain_triangle(query->domain, i));
    if (!status)
        hand_out(&tracer, cell, distance);
    meso_arena_release(&scratch);
    return status;
}
