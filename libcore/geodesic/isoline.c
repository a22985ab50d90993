#include "libcore/geodesic/isoline.h"

#include "libcore/base/index_map.h"
#include "libcore/mesh/cut/mesh_domain.h"

/* Levels by number: those before `first` are below the vertex, those from `end` on above; it is on the others. */
typedef struct VertexLevels {
    uint32_t first, end;
} VertexLevels;

/* How far neighbours are above and below a vertex. */
typedef struct VertexReach {
    float up, down;
} VertexReach;

typedef struct Tracer {
    const MesoTriangulation *mesh;
    const MesoIsolineQuery *query;
    MesoDomainVertices vertices;
    VertexLevels *levels;           /* [vertices.count] */
    MesoIndexMap edge_nodes;        /* by the lower half-edge of an edge: node of the lowest level that crosses it */
    MesoIndexMap vertex_nodes;
    MesoCutLines *lines;
    MesoArena *arena, *scratch;
    MesoError *error;
} Tracer;

/* ---- levels at vertices ---- */

static void widen(VertexReach *low, VertexReach *high, float difference)
{
    if (difference > low->up)
        low->up = difference;
    if (difference > high->down)
        high->down = difference;
}

static void find_reach(const Tracer *tracer, VertexReach *reach)
{
    const MesoDomain *domain = tracer->query->domain;
    uint32_t count = meso_domain_size(domain, tracer->mesh);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *corners = tracer->mesh->corners + 3 * (size_t)meso_domain_triangle(domain, i);
        VertexReach *of[3];
        float f[3];
        for (uint32_t k = 0; k < 3; k++) {
            of[k] = &reach[meso_domain_vertex_number(&tracer->vertices, corners[k])];
            f[k] = tracer->query->field[corners[k]];
        }
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t next = k == 2 ? 0 : k + 1;
            if (!isfinite(f[k]) || !isfinite(f[next]))
                continue;
            if (f[k] < f[next])
                widen(of[k], of[next], f[next] - f[k]);
            else
                widen(of[next], of[k], f[k] - f[next]);
        }
    }
}

/* Number of the first level that is not below `value`. */
static uint32_t level_from(const MesoIsolineQuery *query, float value)
{
    uint32_t first = 0, count = query->level_count;
    while (count > 0) {
        uint32_t half = count / 2;
        bool right = query->levels[first + half] < value;
        first = right ? first + half + 1 : first;
        count = right ? count - half - 1 : half;
    }
    return first;
}

static VertexLevels levels_at(const MesoIsolineQuery *query, float value, VertexReach reach)
{
    if (!isfinite(value))
        return (VertexLevels){query->level_count, query->level_count};
    float top = value + MESO_CUT_SNAP * reach.up;
    VertexLevels found;
    found.first = found.end = level_from(query, value - MESO_CUT_SNAP * reach.down);
    while (found.end < query->level_count && query->levels[found.end] <= top)
        found.end++;
    return found;
}

static MesoStatus find_levels(Tracer *tracer)
{
    const MesoDomainVertices *vertices = &tracer->vertices;
    tracer->levels = MESO_NEW(tracer->scratch, VertexLevels, vertices->count, tracer->error);
    VertexReach *reach = MESO_NEW(tracer->scratch, VertexReach, vertices->count, tracer->error);
    if (!tracer->levels || !reach)
        return MESO_ERR_MEMORY;
    find_reach(tracer, reach);
    for (uint32_t v = meso_domain_vertex_from(vertices, 0); v != MESO_NO_INDEX;
         v = meso_domain_vertex_from(vertices, v + 1)) {
        uint32_t number = meso_domain_vertex_number(vertices, v);
        tracer->levels[number] = levels_at(tracer->query, tracer->query->field[v], reach[number]);
    }
    return MESO_OK;
}

static VertexLevels levels_of(const Tracer *tracer, uint32_t vertex)
{
    return tracer->levels[meso_domain_vertex_number(&tracer->vertices, vertex)];
}

/* ---- nodes ---- */

static MesoStatus vertex_node(Tracer *tracer, uint32_t vertex, uint32_t *node)
{
    uint32_t *known = meso_index_map_at(&tracer->vertex_nodes, tracer->scratch, vertex, tracer->error);
    if (!known)
        return MESO_ERR_MEMORY;
    MesoStatus status = MESO_OK;
    if (*known == MESO_NO_INDEX)
        status = meso_cut_add_node(tracer->lines, tracer->arena, (MesoCutNode){MESO_AT_VERTEX, vertex, {0}}, known,
                                   tracer->error);
    *node = *known;
    return status;
}

/* Share of the way from a vertex to another at which a level lies that is between them and on neither. */
static float crossing_share(float from, float to, float level)
{
    if (!isfinite(from) || !isfinite(to))
        return 0.5f;
    return (float)(((double)level - from) / ((double)to - from));
}

/* Adds the nodes of all levels that cross an edge, ascending. */
static MesoStatus cross_edge(Tracer *tracer, uint32_t edge, uint32_t first, uint32_t end)
{
    const uint32_t *corners = tracer->mesh->corners;
    float from = tracer->query->field[corners[edge]], to = tracer->query->field[corners[meso_next_corner(edge)]];
    MesoStatus status = MESO_OK;
    for (uint32_t level = first; level < end && !status; level++) {
        MesoCutNode node = {MESO_ON_EDGE, edge, {crossing_share(from, to, tracer->query->levels[level])}};
        status = meso_cut_add_node(tracer->lines, tracer->arena, node, NULL, tracer->error);
    }
    return status;
}

static MesoStatus edge_node(Tracer *tracer, uint32_t half_edge, uint32_t level, uint32_t *node)
{
    uint32_t twin = tracer->mesh->twins[half_edge], edge = twin < half_edge ? twin : half_edge;
    VertexLevels a = levels_of(tracer, tracer->mesh->corners[half_edge]);
    VertexLevels b = levels_of(tracer, tracer->mesh->corners[meso_next_corner(half_edge)]);
    uint32_t first = a.end <= level ? a.end : b.end, end = a.end <= level ? b.first : a.first;
    uint32_t *known = meso_index_map_at(&tracer->edge_nodes, tracer->scratch, edge, tracer->error);
    if (!known)
        return MESO_ERR_MEMORY;
    MesoStatus status = MESO_OK;
    if (*known == MESO_NO_INDEX) {
        *known = tracer->lines->node_count;
        status = cross_edge(tracer, edge, first, end);
    }
    *node = *known + (level - first);
    return status;
}

/* ---- segments ---- */

/* Whether the triangle across a side whose two vertices are on the level has what is not below it. */
static bool above_across(const Tracer *tracer, uint32_t half_edge, uint32_t level)
{
    uint32_t across = meso_domain_across(tracer->query->domain, tracer->mesh, half_edge);
    if (across == MESO_NO_INDEX)
        return false;
    return levels_of(tracer, tracer->mesh->corners[meso_previous_corner(across)]).end > level;
}

/*
 * The part of the triangle that is not below the level is left at a place of its outline, and entered at another;
 * each is a vertex on the level, or inside a side.
 */
static MesoStatus cross_triangle(Tracer *tracer, uint32_t triangle, const VertexLevels levels[3], uint32_t level)
{
    const uint32_t *corners = tracer->mesh->corners + 3 * (size_t)triangle;
    uint32_t leave = 3, enter = 3, vertices[2] = {MESO_NO_INDEX, MESO_NO_INDEX};
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t next = k == 2 ? 0 : k + 1;
        bool above = level < levels[k].end, next_above = level < levels[next].end;
        if (above && !next_above) {
            leave = k;
            vertices[0] = level >= levels[k].first ? k : MESO_NO_INDEX;
        } else if (!above && next_above) {
            enter = k;
            vertices[1] = level >= levels[next].first ? next : MESO_NO_INDEX;
        }
    }
    if (leave == 3)
        return MESO_OK;
    if (vertices[0] != MESO_NO_INDEX && vertices[1] != MESO_NO_INDEX &&
        (vertices[0] == vertices[1] || !above_across(tracer, 3 * triangle + vertices[1], level)))
        return MESO_OK;
    MesoCutSegment segment = {.triangle = triangle, .line = level};
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < 2 && !status; i++)
        status = vertices[i] != MESO_NO_INDEX
                     ? vertex_node(tracer, corners[vertices[i]], &segment.node[i])
                     : edge_node(tracer, 3 * triangle + (i == 0 ? leave : enter), level, &segment.node[i]);
    return status ? status : meso_cut_add_segment(tracer->lines, tracer->arena, segment, tracer->error);
}

static MesoStatus trace_triangle(Tracer *tracer, uint32_t triangle)
{
    VertexLevels levels[3];
    uint32_t first = UINT32_MAX, end = 0;
    for (uint32_t k = 0; k < 3; k++) {
        levels[k] = levels_of(tracer, tracer->mesh->corners[3 * (size_t)triangle + k]);
        first = levels[k].end < first ? levels[k].end : first;  /* nothing is below those before */
        end = levels[k].end > end ? levels[k].end : end;        /* all is below these */
    }
    MesoStatus status = MESO_OK;
    for (uint32_t level = first; level < end && !status; level++)
        status = cross_triangle(tracer, triangle, levels, level);
    return status;
}

MesoStatus meso_isolines_trace(MesoCutLines *lines, MesoArena *arena, const MesoTriangulation *mesh,
                               const MesoIsolineQuery *query, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    Tracer tracer = {.mesh = mesh, .query = query, .lines = lines, .arena = arena, .scratch = &scratch, .error = error};
    MesoStatus status = meso_domain_vertices_init(&tracer.vertices, &scratch, mesh, query->domain, error);
    if (!status)
        status = find_levels(&tracer);
    uint32_t count = meso_domain_size(query->domain, mesh);
    for (uint32_t i = 0; i < count && !status; i++)
        status = trace_triangle(&tracer, meso_domain_triangle(query->domain, i));
    meso_arena_release(&scratch);
    return status;
}
