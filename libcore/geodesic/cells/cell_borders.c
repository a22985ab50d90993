#include "libcore/geodesic/cells/cell_borders.h"

#include <string.h>

enum { SLOTS = MESO_NEAREST_SEEDS, EDGE_SEEDS = 2 * SLOTS, OUTLINE_CHANGES = 6 };

/* Of a triangle at most: what its outline comes through, and one inside that all of them are joined to. */
enum { TRIANGLE_NODES = OUTLINE_CHANGES + 1, TRIANGLE_SEGMENTS = OUTLINE_CHANGES };

/* The cells that an edge begins and ends in, along its lower half-edge. */
typedef struct EdgeCells {
    uint32_t seed[2];
    uint32_t node;          /* between them, of the range; MESO_NO_INDEX where they are one */
} EdgeCells;

/* A change from one cell to the next along the outline of a triangle. */
typedef struct Change {
    uint32_t node, before, behind;
} Change;

/* One range of triangles at a time. */
struct MesoBorderTracer {
    const MesoTriangulation *mesh;
    const MesoNearestSeeds *nearest;
    uint32_t begin, count;      /* the range: of the domain's triangles */
    uint32_t first, last;       /* those of the range with the lowest number and the highest */
    uint8_t *crossed;           /* [MESO_BORDER_RANGE] triangles whose sides have been looked at */
    EdgeCells *sides;           /* [3 * MESO_BORDER_RANGE] of those */
    MesoCellBorders found;      /* with room for what a range may have */
    MesoIndexMap at_vertices;   /* nodes at vertices */
    MesoArena scratch;          /* of that map */
    MesoError *error;
};

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

/* Of a node that another range may have, too, the number is noted. */
static uint32_t add_node(MesoBorderTracer *tracer, MesoCutNode node, bool shared)
{
    MesoCellBorders *found = &tracer->found;
    if (shared)
        found->shared[found->shared_count++] = found->node_count;
    found->nodes[found->node_count] = node;
    return found->node_count++;
}

/*
 * Seeds that are equally near at one end do not change places along the edge, and so there is one change at most; a
 * third one that would come between is left out, for it would have an island there.
 */
static void divide_edge(MesoBorderTracer *tracer, uint32_t half_edge, bool shared, EdgeCells *cells)
{
    const MesoTriangulation *mesh = tracer->mesh;
    uint32_t a = mesh->corners[half_edge], b = mesh->corners[meso_next_corner(half_edge)];
    const MesoSeedSlots *ends[2] = {meso_seed_slots(tracer->nearest, a), meso_seed_slots(tracer->nearest, b)};
    EndDistances seeds[EDGE_SEEDS];
    float length = meso_vec3_length(meso_vec3_sub(mesh->positions[a], mesh->positions[b]));
    uint32_t count = seeds_of_side(ends, length, seeds);
    bool inside = meso_domain_holds(tracer->nearest->domain, mesh, half_edge / 3);
    uint32_t facing = mesh->corners[meso_previous_corner(inside ? half_edge : mesh->twins[half_edge])];
    const EndDistances *first = nearest_at(seeds, count, 0, meso_seed_slots(tracer->nearest, facing));
    const EndDistances *last = nearest_at(seeds, count, 1, meso_seed_slots(tracer->nearest, facing));
    *cells = (EdgeCells){{first->seed, last->seed}, MESO_NO_INDEX};
    if (first->seed == last->seed)
        return;
    double begin = last->at[0] - first->at[0], end = first->at[1] - last->at[1];
    cells->node = add_node(tracer, (MesoCutNode){MESO_ON_EDGE, half_edge, {(float)(begin / (begin + end))}}, shared);
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

static MesoStatus change_at_vertex(MesoBorderTracer *tracer, Outline *outline, uint32_t vertex, uint32_t seed)
{
    uint32_t *known = meso_index_map_at(&tracer->at_vertices, &tracer->scratch, vertex, tracer->error);
    if (!known)
        return MESO_ERR_MEMORY;
    if (*known == MESO_NO_INDEX)
        *known = add_node(tracer, (MesoCutNode){MESO_AT_VERTEX, vertex, {0, 0}}, true);
    change_to(outline, *known, seed);
    return MESO_OK;
}

/* Which triangle of the range has a number, of those that the range has. */
static uint32_t place_in_range(const MesoBorderTracer *tracer, uint32_t triangle)
{
    const MesoDomain *domain = tracer->nearest->domain;
    if (tracer->last - tracer->first + 1 == tracer->count)
        return triangle - tracer->first;
    uint32_t low = 0, high = tracer->count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (domain->triangles[tracer->begin + middle] <= triangle)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* What side `k` of the range's triangle number `place` is divided into: as the triangle across, if that came first. */
static const EdgeCells *find_edge(MesoBorderTracer *tracer, uint32_t triangle, uint32_t place, uint32_t k)
{
    const MesoTriangulation *mesh = tracer->mesh;
    uint32_t half_edge = 3 * triangle + k, twin = mesh->twins[half_edge];
    uint32_t across = meso_domain_across(tracer->nearest->domain, mesh, half_edge);
    EdgeCells *cells = &tracer->sides[3 * place + k];
    bool shared = across != MESO_NO_INDEX && (across / 3 < tracer->first || across / 3 > tracer->last);
    if (across != MESO_NO_INDEX && !shared && across < half_edge) {
        uint32_t before = place_in_range(tracer, across / 3);
        if (tracer->crossed[before]) {
            *cells = tracer->sides[3 * before + across % 3];
            return cells;
        }
    }
    divide_edge(tracer, twin < half_edge ? twin : half_edge, shared, cells);
    return cells;
}

/* Goes on along a side, which may begin in another cell than the one before has ended in. */
static MesoStatus add_side(MesoBorderTracer *tracer, uint32_t half_edge, const EdgeCells *cells, Outline *outline)
{
    const uint32_t *corners = tracer->mesh->corners;
    uint32_t twin = tracer->mesh->twins[half_edge], edge = twin < half_edge ? twin : half_edge;
    MesoStatus status = MESO_OK;
    bool same = corners[edge] == corners[half_edge];
    uint32_t begin = cells->seed[same ? 0 : 1], end = cells->seed[same ? 1 : 0];
    if (outline->seed == MESO_NO_INDEX)
        outline->first = outline->seed = begin;
    else if (outline->seed != begin)
        status = change_at_vertex(tracer, outline, corners[half_edge], begin);
    if (begin != end)
        change_to(outline, cells->node, end);
    return status;
}

/* Weights of the point at which three seeds are equally far; false where it is not inside. */
static bool meeting_point(const MesoBorderTracer *tracer, uint32_t triangle, const Change *outline, double weight[3])
{
    double d[3][2];     /* by corner: how much farther the second and the third seed are than the first */
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t corner = tracer->mesh->corners[3 * (size_t)triangle + k];
        const MesoSeedSlots *slots = meso_seed_slots(tracer->nearest, corner);
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

static void middle_of_changes(const MesoBorderTracer *tracer, uint32_t triangle, const Change *outline, uint32_t count,
                              double weight[3])
{
    const uint32_t *corners = tracer->mesh->corners;
    weight[0] = weight[1] = weight[2] = 0;
    for (uint32_t i = 0; i < count; i++) {
        const MesoCutNode *node = &tracer->found.nodes[outline[i].node];
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

static void add_segment(MesoBorderTracer *tracer, uint32_t triangle, const Change *from, uint32_t to)
{
    uint32_t line = from->before < from->behind ? from->before : from->behind;
    tracer->found.segments[tracer->found.segment_count++] = (MesoCutSegment){{from->node, to}, triangle, line};
}

/* Joins all changes of a triangle's outline to one node inside. */
static void add_star(MesoBorderTracer *tracer, uint32_t triangle, const Change *outline, uint32_t count)
{
    double weight[3];
    bool three = count == 3 && outline[0].before != outline[1].before && outline[1].before != outline[2].before &&
                 outline[2].before != outline[0].before;
    if (!three || !meeting_point(tracer, triangle, outline, weight))
        middle_of_changes(tracer, triangle, outline, count, weight);
    MesoCutNode node = {MESO_IN_TRIANGLE, triangle, {(float)weight[1], (float)weight[2]}};
    uint32_t middle = add_node(tracer, node, false);
    for (uint32_t i = 0; i < count; i++)
        add_segment(tracer, triangle, &outline[i], middle);
}

/* Whether two vertices know the same one seed as the nearest. */
static bool is_in_one_cell(const MesoSeedSlots *a, const MesoSeedSlots *b)
{
    return a->seed[0] == b->seed[0] && a->distance[1] > a->distance[0] && b->distance[1] > b->distance[0];
}

/* Whether no border comes to a triangle: its corners are in one cell, or one of them in none. */
static bool is_clear(const MesoSeedSlots *const slots[3])
{
    for (uint32_t k = 0; k < 3; k++)
        if (slots[k]->seed[0] == MESO_NO_INDEX)
            return true;
    return is_in_one_cell(slots[0], slots[1]) && is_in_one_cell(slots[0], slots[2]);
}

static MesoStatus trace_triangle(MesoBorderTracer *tracer, uint32_t place)
{
    uint32_t triangle = meso_domain_triangle(tracer->nearest->domain, tracer->begin + place);
    const uint32_t *corners = tracer->mesh->corners + 3 * (size_t)triangle;
    const MesoSeedSlots *slots[3] = {meso_seed_slots(tracer->nearest, corners[0]),
                                     meso_seed_slots(tracer->nearest, corners[1]),
                                     meso_seed_slots(tracer->nearest, corners[2])};
    tracer->crossed[place] = !is_clear(slots);
    if (!tracer->crossed[place])
        return MESO_OK;
    Outline outline = {.seed = MESO_NO_INDEX};
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 3 && !status; k++) {
        const MesoSeedSlots *begin = slots[k], *end = slots[k == 2 ? 0 : k + 1];
        EdgeCells whole = {{begin->seed[0], begin->seed[0]}, MESO_NO_INDEX};
        status = add_side(tracer, 3 * triangle + k,
                          is_in_one_cell(begin, end) ? &whole : find_edge(tracer, triangle, place, k), &outline);
    }
    if (!status && outline.seed != outline.first)
        status = change_at_vertex(tracer, &outline, corners[0], outline.first);
    if (status || outline.count == 0)
        return status;
    if (outline.count == 2)
        add_segment(tracer, triangle, &outline.changes[0], outline.changes[1].node);
    else
        add_star(tracer, triangle, outline.changes, outline.count);
    return MESO_OK;
}

/* ---- ranges ---- */

MesoBorderTracer *meso_border_tracer_new(MesoArena *arena, const MesoTriangulation *mesh,
                                         const MesoNearestSeeds *nearest, MesoError *error)
{
    MesoBorderTracer *tracer = MESO_NEW(arena, MesoBorderTracer, 1, error);
    if (!tracer)
        return NULL;
    *tracer = (MesoBorderTracer){.mesh = mesh, .nearest = nearest, .error = error};
    meso_arena_init(&tracer->scratch);
    uint32_t room = meso_domain_size(nearest->domain, mesh);
    room = room < MESO_BORDER_RANGE ? room : MESO_BORDER_RANGE;
    tracer->crossed = MESO_NEW(arena, uint8_t, room, error);
    tracer->sides = MESO_NEW(arena, EdgeCells, 3 * (size_t)room, error);
    tracer->found.nodes = MESO_NEW(arena, MesoCutNode, TRIANGLE_NODES * (size_t)room, error);
    tracer->found.shared = MESO_NEW(arena, uint32_t, TRIANGLE_NODES * (size_t)room, error);
    tracer->found.segments = MESO_NEW(arena, MesoCutSegment, TRIANGLE_SEGMENTS * (size_t)room, error);
    return tracer->crossed && tracer->sides && tracer->found.nodes && tracer->found.shared && tracer->found.segments
               ? tracer : NULL;
}

static void *copy_of(MesoArena *arena, const void *array, uint32_t count, size_t size, MesoError *error)
{
    void *copy = meso_arena_alloc(arena, count, size, error);
    if (copy && count)
        memcpy(copy, array, count * size);
    return copy;
}

MesoStatus meso_cell_borders_trace(MesoCellBorders *borders, MesoArena *arena, MesoBorderTracer *tracer,
                                   uint32_t begin, uint32_t end)
{
    MesoCellBorders *found = &tracer->found;
    const MesoDomain *domain = tracer->nearest->domain;
    MesoStatus status = MESO_OK;
    tracer->begin = begin;
    tracer->count = end - begin;
    tracer->first = meso_domain_triangle(domain, begin);
    tracer->last = meso_domain_triangle(domain, end - 1);
    tracer->at_vertices = (MesoIndexMap){0};
    found->node_count = found->shared_count = found->segment_count = 0;
    for (uint32_t i = 0; i < tracer->count && !status; i++)
        status = trace_triangle(tracer, i);
    meso_arena_release(&tracer->scratch);
    *borders = *found;
    borders->nodes = copy_of(arena, found->nodes, found->node_count, sizeof *found->nodes, tracer->error);
    borders->shared = copy_of(arena, found->shared, found->shared_count, sizeof *found->shared, tracer->error);
    borders->segments = copy_of(arena, found->segments, found->segment_count, sizeof *found->segments, tracer->error);
    return !status && borders->nodes && borders->shared && borders->segments ? MESO_OK : MESO_ERR_MEMORY;
}
