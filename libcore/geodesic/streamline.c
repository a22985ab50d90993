#include "libcore/geodesic/streamline.h"

#include <assert.h>

#include "libcore/base/index_map.h"
#include "libcore/mesh/cut/mesh_domain.h"

/* Where a line has come to. */
typedef struct Place {
    MesoNodeKind kind;
    uint32_t element;       /* as a node's */
    double weight[3];       /* in a triangle; on an edge: of its half-edge's begin and end */
    double height;          /* the field, its sign turned where lines go down */
} Place;

/* A step from a place: to another, through a triangle or along a side of it. */
typedef struct Step {
    Place to;
    uint32_t triangle;
} Step;

/* How the weights of a triangle's corners change along the gradient. */
typedef struct Slope {
    double rate[3];
    double square;          /* of the gradient's length: the rate of the height */
} Slope;

typedef struct Walker {
    const MesoTriangulation *mesh;
    const MesoStreamQuery *query;
    MesoIndexMap vertex_nodes;
    MesoCutLines *lines;
    MesoArena *arena, *scratch;
    MesoError *error;
} Walker;

/* ---- the field ---- */

static double height_at(const Walker *walker, uint32_t vertex)
{
    double value = walker->query->field[vertex];
    return walker->query->down ? -value : value;
}

static bool has_field(const Walker *walker, uint32_t triangle)
{
    const uint32_t *corners = walker->mesh->corners + 3 * (size_t)triangle;
    return isfinite(walker->query->field[corners[0]]) && isfinite(walker->query->field[corners[1]]) &&
           isfinite(walker->query->field[corners[2]]);
}

static bool usable(const Walker *walker, uint32_t triangle)
{
    return meso_domain_holds(walker->query->domain, walker->mesh, triangle) && has_field(walker, triangle);
}

/* The half-edge across where lines can go on, or MESO_NO_INDEX. */
static uint32_t across(const Walker *walker, uint32_t half_edge)
{
    uint32_t twin = walker->mesh->twins[half_edge];
    return twin != MESO_NO_INDEX && usable(walker, twin / 3) ? twin : MESO_NO_INDEX;
}

static double dot(MesoVec3 a, MesoVec3 b)
{
    return (double)a.x * b.x + (double)a.y * b.y + (double)a.z * b.z;
}

/* By the metric of the triangle's sides from its first corner; flat where they have no area between them. */
static Slope slope_of(const Walker *walker, uint32_t triangle)
{
    const double thinnest = 1e-24;      /* square of the sine between two sides: positions are good to 1e-7 */
    const uint32_t *corners = walker->mesh->corners + 3 * (size_t)triangle;
    const MesoVec3 *positions = walker->mesh->positions;
    MesoVec3 p = meso_vec3_sub(positions[corners[1]], positions[corners[0]]);
    MesoVec3 q = meso_vec3_sub(positions[corners[2]], positions[corners[0]]);
    double origin = height_at(walker, corners[0]);
    double rise_p = height_at(walker, corners[1]) - origin, rise_q = height_at(walker, corners[2]) - origin;
    double pp = dot(p, p), pq = dot(p, q), qq = dot(q, q), area = pp * qq - pq * pq;
    if (!(area > thinnest * pp * qq))
        return (Slope){{0, 0, 0}, 0};
    double u = (qq * rise_p - pq * rise_q) / area, v = (pp * rise_q - pq * rise_p) / area;
    return (Slope){{-u - v, u, v}, u * rise_p + v * rise_q};
}

/* ---- places ---- */

static Place vertex_place(const Walker *walker, uint32_t vertex)
{
    return (Place){MESO_AT_VERTEX, vertex, {0, 0, 0}, height_at(walker, vertex)};
}

static Place edge_place(const Walker *walker, uint32_t half_edge, double share)
{
    const uint32_t *corners = walker->mesh->corners;
    double begin = height_at(walker, corners[half_edge]);
    double end = height_at(walker, corners[meso_next_corner(half_edge)]);
    return (Place){MESO_ON_EDGE, half_edge, {1 - share, share, 0}, begin + share * (end - begin)};
}

static Place start_place(const Walker *walker, const MesoMeshPoint *point)
{
    const uint32_t *corners = walker->mesh->corners + 3 * (size_t)point->triangle;
    Place place = {.kind = MESO_IN_TRIANGLE, .element = point->triangle};
    uint32_t zeros = 0, zero = 0, other = 0;
    for (uint32_t k = 0; k < 3; k++) {
        place.weight[k] = point->weight[k];
        place.height += point->weight[k] * height_at(walker, corners[k]);
        if (point->weight[k] > 0) {
            other = k;
        } else {
            zero = k;
            zeros++;
        }
    }
    if (zeros == 2)
        return vertex_place(walker, corners[other]);
    uint32_t begin = (zero + 1) % 3, end = (zero + 2) % 3;
    if (zeros == 1)
        return edge_place(walker, 3 * point->triangle + begin,
                          place.weight[end] / (place.weight[begin] + place.weight[end]));
    return place;
}

/* Whether a line may not go on from where it has come to. */
static bool at_border(const Walker *walker, const Place *place)
{
    if (place->kind == MESO_ON_EDGE)
        return across(walker, place->element) == MESO_NO_INDEX || !usable(walker, place->element / 3);
    MesoFan fan = meso_fan_first(walker->mesh, place->element);
    uint32_t first = fan.corner;
    do {
        if (!usable(walker, fan.corner / 3) || across(walker, meso_fan_exit(fan)) == MESO_NO_INDEX)
            return true;
    } while (meso_fan_next(walker->mesh, &fan) && fan.corner != first);
    return false;
}

/* ---- steps ---- */

/* To a place of a side, or to its end where that is near and no step back from `height`. */
static Place arrival(const Walker *walker, uint32_t half_edge, double share, double height)
{
    const uint32_t *corners = walker->mesh->corners;
    if (share < MESO_CUT_SNAP && (share <= 0 || height_at(walker, corners[half_edge]) > height))
        return vertex_place(walker, corners[half_edge]);
    uint32_t end = corners[meso_next_corner(half_edge)];
    if (share > 1 - MESO_CUT_SNAP && (share >= 1 || height_at(walker, end) > height))
        return vertex_place(walker, end);
    return edge_place(walker, half_edge, share);
}

/* From weights of a triangle along its gradient to the side that is met first; false where it is flat. */
static bool cross_triangle(const Walker *walker, uint32_t triangle, const double weight[3], double height, Step *step)
{
    Slope slope = slope_of(walker, triangle);
    double soonest = INFINITY;
    uint32_t leave = 3;
    for (uint32_t k = 0; k < 3; k++) {
        double time = slope.rate[k] < 0 ? fmax(weight[k], 0) / -slope.rate[k] : INFINITY;
        if (time < soonest) {
            soonest = time;
            leave = k;
        }
    }
    if (leave == 3)
        return false;
    uint32_t begin = (leave + 1) % 3, end = (leave + 2) % 3;
    double from = fmax(0, weight[begin] + soonest * slope.rate[begin]);
    double to = fmax(0, weight[end] + soonest * slope.rate[end]);
    if (!(from + to > 0))
        return false;
    *step = (Step){arrival(walker, 3 * triangle + begin, to / (from + to), height), triangle};
    return true;
}

/* Into the steeper of the sides that the gradient points into, or along the edge to its higher end. */
static bool step_from_edge(const Walker *walker, const Place *place, Step *step)
{
    uint32_t sides[2] = {place->element, across(walker, place->element)}, into = MESO_NO_INDEX;
    double steepest = 0;
    for (uint32_t i = 0; i < 2; i++) {
        if (sides[i] == MESO_NO_INDEX || !usable(walker, sides[i] / 3))
            continue;
        Slope slope = slope_of(walker, sides[i] / 3);
        if (slope.rate[meso_previous_corner(sides[i]) % 3] > 0 && slope.square > steepest) {
            steepest = slope.square;
            into = sides[i];
        }
    }
    const uint32_t *corners = walker->mesh->corners;
    uint32_t begin = corners[place->element], end = corners[meso_next_corner(place->element)];
    if (into != MESO_NO_INDEX) {
        double weight[3] = {0, 0, 0};
        bool same = corners[into] == begin;
        weight[into % 3] = place->weight[same ? 0 : 1];
        weight[meso_next_corner(into) % 3] = place->weight[same ? 1 : 0];
        return cross_triangle(walker, into / 3, weight, place->height, step);
    }
    double rise = height_at(walker, end) - height_at(walker, begin);
    if (rise == 0 || at_border(walker, place))
        return false;
    *step = (Step){vertex_place(walker, rise > 0 ? end : begin), place->element / 3};
    return true;
}

/* Along a spoke of a vertex, if that is steeper than what was found before. */
static void try_spoke(const Walker *walker, uint32_t vertex, uint32_t half_edge, double *steepest, Step *step)
{
    const uint32_t *corners = walker->mesh->corners;
    uint32_t begin = corners[half_edge], end = corners[meso_next_corner(half_edge)];
    end = begin == vertex ? end : begin;
    MesoVec3 along = meso_vec3_sub(walker->mesh->positions[end], walker->mesh->positions[vertex]);
    double rise = height_at(walker, end) - height_at(walker, vertex), square = dot(along, along);
    if (rise > 0 && rise * rise > *steepest * square) {
        *steepest = rise * rise / square;
        *step = (Step){vertex_place(walker, end), half_edge / 3};
    }
}

/* Across the triangle of a corner, if its gradient points from the vertex into it. */
static void try_sector(const Walker *walker, uint32_t corner, double *steepest, Step *step)
{
    Slope slope = slope_of(walker, corner / 3);
    uint32_t next = meso_next_corner(corner), previous = meso_previous_corner(corner);
    double to_next = slope.rate[next % 3], to_previous = slope.rate[previous % 3];
    if (to_next > 0 && to_previous > 0 && slope.square > *steepest) {
        double height = height_at(walker, walker->mesh->corners[corner]);
        *steepest = slope.square;
        *step = (Step){arrival(walker, next, to_previous / (to_next + to_previous), height), corner / 3};
    }
}

static bool step_from_vertex(const Walker *walker, const Place *place, Step *step)
{
    if (walker->mesh->vertex_corner[place->element] == MESO_NO_INDEX)
        return false;
    MesoFan fan = meso_fan_first(walker->mesh, place->element);
    uint32_t first = fan.corner;
    double steepest = 0;
    do {
        if (!usable(walker, fan.corner / 3))
            continue;
        try_sector(walker, fan.corner, &steepest, step);
        try_spoke(walker, place->element, meso_fan_entry(fan), &steepest, step);
        try_spoke(walker, place->element, meso_fan_exit(fan), &steepest, step);
    } while (meso_fan_next(walker->mesh, &fan) && fan.corner != first);
    return steepest > 0;
}

static bool find_step(const Walker *walker, const Place *place, Step *step)
{
    if (place->kind == MESO_AT_VERTEX)
        return step_from_vertex(walker, place, step);
    if (place->kind == MESO_ON_EDGE)
        return step_from_edge(walker, place, step);
    return cross_triangle(walker, place->element, place->weight, place->height, step);
}

/* Whether a step leads along a side that nothing lies behind: what is cut there is cut already. */
static bool along_border(const Walker *walker, const Place *from, const Step *step)
{
    if (from->kind != MESO_AT_VERTEX || step->to.kind != MESO_AT_VERTEX)
        return false;
    for (uint32_t h = 3 * step->triangle; h < 3 * step->triangle + 3; h++) {
        uint32_t a = walker->mesh->corners[h], b = walker->mesh->corners[meso_next_corner(h)];
        if ((a == from->element && b == step->to.element) || (b == from->element && a == step->to.element))
            return across(walker, h) == MESO_NO_INDEX;
    }
    return false;
}

/* ---- lines ---- */

/* The node of a place, and whether a line has passed there before. */
static MesoStatus place_node(Walker *walker, const Place *place, uint32_t *node, bool *known)
{
    MesoCutNode added = {place->kind, place->element, {0, 0}};
    uint32_t *vertex_node = NULL;
    *known = false;
    if (place->kind == MESO_AT_VERTEX) {
        vertex_node = meso_index_map_at(&walker->vertex_nodes, walker->scratch, place->element, walker->error);
        if (!vertex_node)
            return MESO_ERR_MEMORY;
        *known = *vertex_node != MESO_NO_INDEX;
        *node = *vertex_node;
        if (*known)
            return MESO_OK;
    } else {
        added.share[0] = (float)place->weight[1];
        added.share[1] = (float)place->weight[2];
    }
    MesoStatus status = meso_cut_add_node(walker->lines, walker->arena, added, node, walker->error);
    if (vertex_node)
        *vertex_node = *node;
    return status;
}

static MesoStatus walk(Walker *walker, uint32_t line, uint32_t step_limit, MesoStreamStop *stop)
{
    const MesoMeshPoint *start = &walker->query->starts[line];
    assert(meso_domain_holds(walker->query->domain, walker->mesh, start->triangle));
    *stop = MESO_STREAM_BLOCKED;
    Place place = start_place(walker, start);
    Step step;
    if (!has_field(walker, start->triangle) || !find_step(walker, &place, &step) || along_border(walker, &place, &step))
        return MESO_OK;
    MesoCutSegment segment = {.line = line};
    bool known;
    MesoStatus status = place_node(walker, &place, &segment.node[0], &known);
    *stop = known && walker->query->join ? MESO_STREAM_JOINED : MESO_STREAM_STOPS;
    for (uint32_t count = 1; !status && *stop == MESO_STREAM_STOPS; count++) {
        segment.triangle = step.triangle;
        status = place_node(walker, &step.to, &segment.node[1], &known);
        if (!status)
            status = meso_cut_add_segment(walker->lines, walker->arena, segment, walker->error);
        segment.node[0] = segment.node[1];
        place = step.to;
        *stop = known && walker->query->join ? MESO_STREAM_JOINED
                : at_border(walker, &place) ? MESO_STREAM_BORDER
                : !find_step(walker, &place, &step) ? MESO_STREAM_EXTREMUM
                : count == step_limit ? MESO_STREAM_LONG : MESO_STREAM_STOPS;
    }
    return status;
}

MesoStatus meso_streamlines_trace(MesoCutLines *lines, MesoStreamReport *report, MesoArena *arena,
                                  const MesoTriangulation *mesh, const MesoStreamQuery *query, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    Walker walker = {.mesh = mesh, .query = query, .lines = lines, .arena = arena, .scratch = &scratch, .error = error};
    uint32_t step_limit = query->step_limit ? query->step_limit : meso_domain_size(query->domain, mesh);
    *report = (MesoStreamReport){.stops = MESO_NEW(arena, MesoStreamStop, query->start_count, error)};
    MesoStatus status = report->stops ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < query->start_count && !status; i++) {
        status = walk(&walker, i, step_limit, &report->stops[i]);
        if (!status)
            report->counts[report->stops[i]]++;
    }
    meso_arena_release(&scratch);
    return status;
}
