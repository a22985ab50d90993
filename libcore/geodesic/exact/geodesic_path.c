#include "libcore/geodesic/exact/geodesic_path.h"

#include "libcore/geodesic/exact/event_queue.h"
#include "libcore/geodesic/exact/strip.h"

/* Each round shortens the path for good, and few are needed. */
enum { ROUND_LIMIT = 10000, TURN_LIMIT = 200 };

static bool is_inside(const MesoStrip *strip, uint32_t triangle)
{
    return !strip->domain || meso_domain_has(strip->domain, strip->mesh, triangle);
}

static MesoCutNode at_vertex(uint32_t vertex)
{
    return (MesoCutNode){MESO_AT_VERTEX, vertex, {0, 0}};
}

/* ---- the way through the triangles ---- */

/* A search from `from` to `to`: A* (Hart, Nilsson and Raphael 1968) with the straight distance as bound. */
typedef struct Search {
    MesoStrip *strip;
    MesoVec3 goal;
    double *cost;           /* [triangle_count] to the middle of the side that it is entered by, and 1 */
    uint32_t *entered;      /* [triangle_count] half-edge of the triangle before; MESO_NO_INDEX at the beginning */
    MesoEventQueue queue;
    MesoArena *arena;
    MesoError *error;
} Search;

static double between(MesoVec3 a, MesoVec3 b)
{
    return meso_vec3_length(meso_vec3_sub(a, b));
}

static MesoVec3 middle_of(const MesoTriangulation *mesh, uint32_t side)
{
    return meso_vec3_lerp(mesh->positions[mesh->corners[side]],
                          mesh->positions[mesh->corners[meso_next_corner(side)]], 0.5f);
}

static MesoStatus enter(Search *search, uint32_t triangle, uint32_t side, double cost, MesoVec3 at)
{
    double *known = &search->cost[triangle];
    if (!is_inside(search->strip, triangle) || !(*known == 0 || cost + 1 < *known))
        return MESO_OK;
    *known = cost + 1;
    search->entered[triangle] = side;
    return meso_event_push(&search->queue, search->arena,
                           (MesoEvent){cost + between(at, search->goal), triangle, 0}, search->error);
}

static MesoStatus enter_first(Search *search)
{
    const MesoTriangulation *mesh = search->strip->mesh;
    const MesoCutNode *from = &search->strip->from;
    MesoVec3 at = meso_cut_node_position(mesh, from);
    if (from->kind == MESO_IN_TRIANGLE)
        return enter(search, from->element, MESO_NO_INDEX, 0, at);
    if (from->kind == MESO_ON_EDGE) {
        uint32_t twin = mesh->twins[from->element];
        MesoStatus status = enter(search, from->element / 3, MESO_NO_INDEX, 0, at);
        return status || twin == MESO_NO_INDEX ? status : enter(search, twin / 3, MESO_NO_INDEX, 0, at);
    }
    if (mesh->vertex_corner[from->element] == MESO_NO_INDEX)
        return MESO_OK;
    MesoFan fan = meso_fan_first(mesh, from->element);
    uint32_t first = fan.corner;
    MesoStatus status = MESO_OK;
    do {
        status = enter(search, fan.corner / 3, MESO_NO_INDEX, 0, at);
    } while (!status && meso_fan_next(mesh, &fan) && fan.corner != first);
    return status;
}

static MesoStatus enter_neighbours(Search *search, uint32_t triangle)
{
    const MesoTriangulation *mesh = search->strip->mesh;
    uint32_t by = search->entered[triangle];
    MesoVec3 at = by == MESO_NO_INDEX ? meso_cut_node_position(mesh, &search->strip->from) : middle_of(mesh, by);
    MesoStatus status = MESO_OK;
    for (uint32_t side = 3 * triangle; side < 3 * triangle + 3 && !status; side++) {
        MesoVec3 middle = middle_of(mesh, side);
        double cost = search->cost[triangle] - 1 + between(at, middle);
        if (mesh->twins[side] != MESO_NO_INDEX)
            status = enter(search, mesh->twins[side] / 3, side, cost, middle);
    }
    return status;
}

/* The sides from the beginning to `triangle`. */
static MesoStatus take_way(Search *search, uint32_t triangle)
{
    MesoStrip *strip = search->strip;
    MesoStatus status = MESO_OK;
    for (uint32_t side; (side = search->entered[triangle]) != MESO_NO_INDEX && !status; triangle = side / 3)
        status = meso_strip_add(strip, side, search->error);
    strip->first = triangle;
    for (uint32_t i = 0; i < strip->side_count / 2; i++) {
        uint32_t *a = &strip->sides[i], *b = &strip->sides[strip->side_count - 1 - i], side = *a;
        *a = *b;
        *b = side;
    }
    return status;
}

static MesoStatus find_way(MesoStrip *strip, MesoError *error)
{
    Search search = {
        .strip = strip, .goal = meso_cut_node_position(strip->mesh, &strip->to), .arena = strip->arena, .error = error,
        .cost = MESO_NEW(strip->arena, double, strip->mesh->triangle_count, error),
        .entered = MESO_NEW(strip->arena, uint32_t, strip->mesh->triangle_count, error),
    };
    if (!search.cost || !search.entered)
        return MESO_ERR_MEMORY;
    MesoStatus status = enter_first(&search);
    while (!status && search.queue.count > 0) {
        MesoEvent event = meso_event_pop(&search.queue);
        if (meso_strip_touches(strip->mesh, event.item, &strip->to))
            return take_way(&search, event.item);
        status = enter_neighbours(&search, event.item);
    }
    return status ? status : meso_fail(error, MESO_ERR_NO, "no way from one end of the path to the other");
}

/* ---- along edges ---- */

/* A triangle of the domain that has the edge from a to b. */
static uint32_t triangle_at(const MesoStrip *strip, uint32_t a, uint32_t b)
{
    const MesoTriangulation *mesh = strip->mesh;
    MesoCutNode end = at_vertex(b);
    if (mesh->vertex_corner[a] == MESO_NO_INDEX)
        return MESO_NO_INDEX;
    MesoFan fan = meso_fan_first(mesh, a);
    uint32_t first = fan.corner;
    do {
        if (is_inside(strip, fan.corner / 3) && meso_strip_touches(mesh, fan.corner / 3, &end))
            return fan.corner / 3;
    } while (meso_fan_next(mesh, &fan) && fan.corner != first);
    return MESO_NO_INDEX;
}

static MesoStatus follow_edges(MesoStrip *strip, const uint32_t *vertices, uint32_t count, bool closed,
                               MesoError *error)
{
    uint32_t steps = closed ? count : count - 1;
    for (uint32_t i = 0; i < steps; i++)
        if (triangle_at(strip, vertices[i], vertices[(i + 1) % count]) == MESO_NO_INDEX)
            return meso_fail(error, MESO_ERR_NO, "no edge from vertex %u to vertex %u in the region", vertices[i],
                             vertices[(i + 1) % count]);
    uint32_t triangle = triangle_at(strip, vertices[0], vertices[1]);
    MesoStatus status = MESO_OK;
    strip->first = triangle;
    strip->from = at_vertex(vertices[0]);
    strip->to = at_vertex(vertices[closed ? 0 : count - 1]);
    for (uint32_t i = 1; i < steps && !status; i++) {
        MesoCutNode next = at_vertex(vertices[(i + 1) % count]);
        status = meso_strip_turn(strip, triangle, vertices[i], &next, &triangle, error);
    }
    return status;
}

/* ---- closed paths ---- */

static uint32_t last_triangle(const MesoStrip *strip)
{
    return strip->side_count ? strip->mesh->twins[strip->sides[strip->side_count - 1]] / 3 : strip->first;
}

static bool has_vertex(const MesoTriangulation *mesh, uint32_t side, uint32_t vertex)
{
    return mesh->corners[side] == vertex || mesh->corners[meso_next_corner(side)] == vertex;
}

/* Whether a closed path stays in the triangles around a vertex. */
static bool circles_vertex(const MesoStrip *strip, uint32_t vertex)
{
    const MesoTriangulation *mesh = strip->mesh;
    uint32_t last = last_triangle(strip);
    for (uint32_t i = 0; i < strip->side_count; i++)
        if (!has_vertex(mesh, strip->sides[i], vertex))
            return false;
    for (uint32_t side = 3 * last; side < 3 * last + 3; side++)
        if (mesh->twins[side] != MESO_NO_INDEX && mesh->twins[side] / 3 == strip->first &&
            has_vertex(mesh, side, vertex))
            return true;
    return last == strip->first;
}

static bool contracts(const MesoStrip *strip)
{
    return strip->side_count == 0 || circles_vertex(strip, strip->mesh->corners[strip->sides[0]]) ||
           circles_vertex(strip, strip->mesh->corners[meso_next_corner(strip->sides[0])]);
}

/* From the strip's last triangle to its first, past the point that both have. */
static MesoStatus close_strip(MesoStrip *strip, uint32_t last, MesoError *error)
{
    const MesoTriangulation *mesh = strip->mesh;
    const MesoCutNode *base = &strip->from, first = {MESO_IN_TRIANGLE, strip->first, {0, 0}};
    if (last == strip->first)
        return MESO_OK;
    if (base->kind == MESO_AT_VERTEX)
        return meso_strip_turn(strip, last, base->element, &first, &last, error);
    return meso_strip_add(strip, base->element / 3 == last ? base->element : mesh->twins[base->element], error);
}

/* Where a closed path may be held next: a vertex that it bends at, or else the side in its middle. */
static MesoCutNode next_base(const MesoStrip *strip, uint32_t *portal)
{
    if (strip->bend_count) {
        const MesoStripBend *bend = &strip->bends[strip->bend_count / 2];
        *portal = bend->portal;
        return at_vertex(bend->vertex);
    }
    *portal = strip->side_count / 2;
    double share = meso_strip_crossing(strip, *portal, strip->begin, strip->end);
    return (MesoCutNode){MESO_ON_EDGE, strip->sides[*portal], {(float)share, 0}};
}

/* The same ring of triangles, from another point of the path. */
static MesoStatus move_base(MesoStrip *strip, MesoError *error)
{
    uint32_t portal, last = last_triangle(strip);
    MesoCutNode base = next_base(strip, &portal);
    MesoStatus status = close_strip(strip, last, error);
    for (uint32_t i = 0; i < portal && !status; i++)
        status = meso_strip_add(strip, strip->sides[i], error);
    if (status)
        return status;
    strip->first = strip->sides[portal] / 3;
    strip->side_count -= portal < strip->side_count ? portal : strip->side_count;
    memmove(strip->sides, strip->sides + portal, strip->side_count * sizeof *strip->sides);
    strip->from = strip->to = base;
    return MESO_OK;
}

static MesoStatus tighten(MesoStrip *strip, bool *straight, MesoError *error)
{
    MesoStatus status = meso_strip_straighten(strip, ROUND_LIMIT, straight, error);
    double before = INFINITY;
    for (uint32_t turn = 0; !status; turn++) {
        if (contracts(strip))
            return meso_fail(error, MESO_ERR_NO, "the closed path contracts to a point");
        if (strip->length >= before * (1 - 1e-10))
            break;
        *straight &= turn < TURN_LIMIT;
        if (turn == TURN_LIMIT)
            break;
        before = strip->length;
        status = move_base(strip, error);
        if (!status)
            status = meso_strip_straighten(strip, ROUND_LIMIT, straight, error);
    }
    return status;
}

/* ---- lines ---- */

static const double SNAP = 1e-6;    /* singles do not tell nearer shares from the ends */

typedef struct Writer {
    const MesoStrip *strip;
    MesoArena *arena;
    MesoCutLines *lines;
    uint32_t line;
    MesoCutNode node;           /* the last */
    uint32_t number, portal;    /* its number, and where it lies in the strip */
    MesoError *error;
} Writer;

/* A triangle of the strip from side `begin` to side `end` that has both nodes. */
static uint32_t common_triangle(const MesoStrip *strip, uint32_t begin, uint32_t end, const MesoCutNode *a,
                                const MesoCutNode *b)
{
    const MesoTriangulation *mesh = strip->mesh;
    for (uint32_t i = begin; i <= end && i <= strip->side_count; i++) {
        uint32_t triangle = i == 0 ? strip->first : mesh->twins[strip->sides[i - 1]] / 3;
        if (meso_strip_touches(mesh, triangle, a) && meso_strip_touches(mesh, triangle, b))
            return triangle;
    }
    return MESO_NO_INDEX;
}

static MesoStatus write_node(Writer *writer, MesoCutNode node, uint32_t portal)
{
    if (node.kind == MESO_AT_VERTEX && writer->node.kind == MESO_AT_VERTEX && node.element == writer->node.element)
        return MESO_OK;
    uint32_t triangle = common_triangle(writer->strip, writer->portal, portal, &writer->node, &node), number;
    if (triangle == MESO_NO_INDEX)
        return meso_fail(writer->error, MESO_ERR_INTERNAL, "a path leaves its triangles");
    MesoStatus status = meso_cut_add_node(writer->lines, writer->arena, node, &number, writer->error);
    if (!status)
        status = meso_cut_add_segment(writer->lines, writer->arena,
                                      (MesoCutSegment){{writer->number, number}, triangle, writer->line},
                                      writer->error);
    writer->node = node;
    writer->number = number;
    writer->portal = portal;
    return status;
}

/* Between two points of the path, the sides that it crosses; it does not cross those that begin or end there. */
static MesoStatus write_crossings(Writer *writer, uint32_t b)
{
    const MesoStrip *strip = writer->strip;
    const MesoStripBend *last = b > 0 ? &strip->bends[b - 1] : NULL;
    const MesoStripBend *next = b < strip->bend_count ? &strip->bends[b] : NULL;
    MesoStatus status = MESO_OK;
    for (uint32_t i = last ? last->portal : 0; i < (next ? next->portal : strip->side_count) && !status; i++) {
        uint32_t side = strip->sides[i];
        if ((last && has_vertex(strip->mesh, side, last->vertex)) ||
            (next && has_vertex(strip->mesh, side, next->vertex)))
            continue;
        double share = meso_strip_crossing(strip, i, last ? last->at : strip->begin, next ? next->at : strip->end);
        MesoCutNode node = {MESO_ON_EDGE, side, {(float)share, 0}};
        if (share < SNAP || share > 1 - SNAP)
            node = at_vertex(strip->mesh->corners[share < SNAP ? side : meso_next_corner(side)]);
        status = write_node(writer, node, i);
    }
    return status;
}

static MesoStatus write_path(const MesoStrip *strip, uint32_t line, MesoArena *arena, MesoCutLines *lines,
                             MesoError *error)
{
    Writer writer = {strip, arena, lines, line, strip->from, 0, 0, error};
    MesoStatus status = meso_cut_add_node(lines, arena, strip->from, &writer.number, error);
    for (uint32_t b = 0; b <= strip->bend_count && !status; b++) {
        status = write_crossings(&writer, b);
        if (!status && b < strip->bend_count)
            status = write_node(&writer, at_vertex(strip->bends[b].vertex), strip->bends[b].portal);
    }
    return status ? status : write_node(&writer, strip->to, strip->side_count);
}

/* ---- paths ---- */

static MesoStatus path_in(MesoStrip *strip, uint32_t line, MesoArena *arena, MesoCutLines *lines,
                          MesoGeodesicPath *path, MesoError *error)
{
    MesoStatus status = find_way(strip, error);
    if (!status)
        status = meso_strip_straighten(strip, ROUND_LIMIT, &path->straight, error);
    path->length = strip->length;
    return status ? status : write_path(strip, line, arena, lines, error);
}

MesoStatus meso_geodesic_path(const MesoTriangulation *mesh, const MesoDomain *domain, MesoCutNode from, MesoCutNode to,
                              uint32_t line, MesoArena *arena, MesoCutLines *lines, MesoGeodesicPath *path,
                              MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStrip strip = {.mesh = mesh, .domain = domain, .arena = &scratch, .from = from, .to = to};
    *path = (MesoGeodesicPath){0};
    MesoStatus status = path_in(&strip, line, arena, lines, path, error);
    meso_arena_release(&scratch);
    return status;
}

MesoStatus meso_geodesic_shorten(const MesoTriangulation *mesh, const MesoDomain *domain, const uint32_t *vertices,
                                 uint32_t count, bool closed, uint32_t line, MesoArena *arena, MesoCutLines *lines,
                                 MesoGeodesicPath *path, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStrip strip = {.mesh = mesh, .domain = domain, .arena = &scratch};
    *path = (MesoGeodesicPath){0};
    MesoStatus status = count < 2 ? meso_fail(error, MESO_ERR_NO, "a path of %u vertices", count)
                                  : follow_edges(&strip, vertices, count, closed, error);
    if (!status)
        status = closed ? tighten(&strip, &path->straight, error)
                        : meso_strip_straighten(&strip, ROUND_LIMIT, &path->straight, error);
    path->length = strip.length;
    if (!status)
        status = write_path(&strip, line, arena, lines, error);
    meso_arena_release(&scratch);
    return status;
}
