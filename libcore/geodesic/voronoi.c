#include "libcore/geodesic/voronoi.h"

#include "libcore/base/grow.h"
#include "libcore/geodesic/nearest_seeds.h"

enum { SLOTS = MESO_NEAREST_SEEDS, EDGE_SEEDS = 2 * SLOTS, OUTLINE_CHANGES = 6 };

/* The cells that an edge begins and ends in, along its lower half-edge. */
typedef struct EdgeCells {
    uint32_t half_edge;
    uint32_t next;          /* below it: of the edges that begin at the same vertex, another that is known; 0: none */
    uint32_t seed[2];
    uint32_t node;          /* between them; MESO_NO_INDEX where they are one */
} EdgeCells;

/* What is known at a vertex, plus one; 0 is nothing. */
typedef struct VertexLines {
    uint32_t edge;          /* the newest that begins there */
    uint32_t node;
} VertexLines;

/* A change from one cell to the next along the outline of a triangle. */
typedef struct Change {
    uint32_t node, before, behind;
} Change;

typedef struct Tracer {
    const MesoTriangulation *mesh;
    const MesoVoronoiQuery *query;
    MesoNearestSeeds nearest;
    VertexLines *at_vertices;   /* by vertex number */
    uint32_t edge_count, edge_room;
    EdgeCells *edge_cells;      /* [edge_count] */
    MesoCutLines *lines;
    MesoArena *arena, *scratch;
    MesoError *error;
} Tracer;

/* ---- sides ---- */

static double slot_distance(const MesoSeedSlots *slots, uint32_t seed)
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
static uint32_t seeds_of_side(const MesoSeedSlots *ends[2], double length, EndDistances found[EDGE_SEEDS])
{
    uint32_t count = 0;
    for (uint32_t end = 0; end < 2; end++)
        for (uint32_t k = 0; k < SLOTS && ends[end]->distance[k] == ends[end]->distance[0]; k++) {
            double own = ends[end]->distance[k], other = slot_distance(ends[1 - end], ends[end]->seed[k]);
            other = own + length < other ? own + length : other;
            found[count++] = (EndDistances){ends[end]->seed[k], {end == 0 ? own : other, end == 0 ? other : own}};
        }
    return count;
}

static bool is_nearer_at(const MesoSeedSlots *slots, uint32_t seed, uint32_t than)
{
    double distance = slot_distance(slots, seed), other = slot_distance(slots, than);
    return distance != other ? distance < other : seed < than;
}

/*
 * The nearest at one end, of several the one at the other end; where two are equal all along, the one at the corner
 * that faces the side, so that the side belongs to the cell on one of its sides at least; and then the lowest.
 */
static const EndDistances *nearest_at(const EndDistances *seeds, uint32_t count, uint32_t end,
                                      const MesoSeedSlots *facing)
{
    const EndDistances *nearest = &seeds[0];
    for (uint32_t i = 1; i < count; i++) {
        const EndDistances *other = &seeds[i];
        if (other->at[end] != nearest->at[end]           ? other->at[end] < nearest->at[end]
            : other->at[1 - end] != nearest->at[1 - end] ? other->at[1 - end] < nearest->at[1 - end]
                                                         : is_nearer_at(facing, other->seed, nearest->seed))
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
    const MesoSeedSlots *ends[2] = {meso_seed_slots(&tracer->nearest, a), meso_seed_slots(&tracer->nearest, b)};
    EndDistances seeds[EDGE_SEEDS];
    float length = meso_vec3_length(meso_vec3_sub(mesh->positions[a], mesh->positions[b]));
    uint32_t count = seeds_of_side(ends, length, seeds);
    bool inside = meso_domain_holds(tracer->query->domain, mesh, half_edge / 3);
    uint32_t facing = mesh->corners[meso_previous_corner(inside ? half_edge : mesh->twins[half_edge])];
    const EndDistances *first = nearest_at(seeds, count, 0, meso_seed_slots(&tracer->nearest, facing));
    const EndDistances *last = nearest_at(seeds, count, 1, meso_seed_slots(&tracer->nearest, facing));
    *cells = (EdgeCells){.half_edge = half_edge, .seed = {first->seed, last->seed}, .node = MESO_NO_INDEX};
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

static VertexLines *at_vertex(const Tracer *tracer, uint32_t vertex)
{
    return &tracer->at_vertices[meso_domain_vertex_number(&tracer->nearest.vertices, vertex)];
}

static MesoStatus change_at_vertex(Tracer *tracer, Outline *outline, uint32_t vertex, uint32_t seed)
{
    VertexLines *known = at_vertex(tracer, vertex);
    MesoStatus status = MESO_OK;
    if (known->node == 0) {
        status = meso_cut_add_node(tracer->lines, tracer->arena, (MesoCutNode){MESO_AT_VERTEX, vertex, {0, 0}},
                                   &known->node, tracer->error);
        known->node++;
    }
    change_to(outline, known->node - 1, seed);
    return status;
}

static MesoStatus find_edge(Tracer *tracer, uint32_t edge, EdgeCells *cells)
{
    VertexLines *known = at_vertex(tracer, tracer->mesh->corners[edge]);
    for (uint32_t e = known->edge; e > 0; e = tracer->edge_cells[e - 1].next)
        if (tracer->edge_cells[e - 1].half_edge == edge) {
            *cells = tracer->edge_cells[e - 1];
            return MESO_OK;
        }
    tracer->edge_cells = MESO_GROW(tracer->scratch, tracer->edge_cells, tracer->edge_count, tracer->edge_room, 256,
                                   tracer->error);
    if (!tracer->edge_cells)
        return MESO_ERR_MEMORY;
    MesoStatus status = divide_edge(tracer, edge, cells);
    cells->next = known->edge;
    tracer->edge_cells[tracer->edge_count++] = *cells;
    known->edge = tracer->edge_count;
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
        uint32_t corner = tracer->mesh->corners[3 * (size_t)triangle + k];
        const MesoSeedSlots *slots = meso_seed_slots(&tracer->nearest, corner);
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
static bool is_in_one_cell(const MesoSeedSlots *const slots[3])
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
    const MesoSeedSlots *slots[3] = {meso_seed_slots(&tracer->nearest, corners[0]),
                                     meso_seed_slots(&tracer->nearest, corners[1]),
                                     meso_seed_slots(&tracer->nearest, corners[2])};
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

static MesoStatus trace_triangles(Tracer *tracer)
{
    const MesoDomain *domain = tracer->query->domain;
    uint32_t count = meso_domain_size(domain, tracer->mesh);
    tracer->at_vertices = MESO_NEW(tracer->scratch, VertexLines, tracer->nearest.vertices.count, tracer->error);
    MesoStatus status = tracer->at_vertices ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count && !status; i++)
        status = trace_triangle(tracer, meso_domain_triangle(domain, i));
    return status;
}

/* ---- results ---- */

static void hand_out(const Tracer *tracer, uint32_t *cell, float *distance)
{
    const MesoDomainVertices *vertices = &tracer->nearest.vertices;
    for (uint32_t v = meso_domain_vertex_from(vertices, 0); v != MESO_NO_INDEX;
         v = meso_domain_vertex_from(vertices, v + 1)) {
        const MesoSeedSlots *slots = meso_seed_slots(&tracer->nearest, v);
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
    Tracer tracer = {.mesh = mesh, .query = query, .lines = lines, .arena = arena, .scratch = &scratch,
                     .error = error, .nearest = {.domain = query->domain, .seed_count = query->seed_count,
                                                 .seeds = query->seeds}};
    MesoStatus status = meso_nearest_seeds_find(&tracer.nearest, &scratch, mesh, solver, error);
    if (!status) {
        hand_out(&tracer, cell, distance);
        status = meso_nearest_seeds_settle(&tracer.nearest, &scratch, mesh, error);
    }
    if (!status)
        status = trace_triangles(&tracer);
    meso_arena_release(&scratch);
    return status;
}
