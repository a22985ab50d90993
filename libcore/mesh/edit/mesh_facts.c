#include "libcore/mesh/edit/mesh_facts.h"

#include <math.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/math/box.h"
#include "libcore/mesh/edit/face_area.h"
#include "libcore/mesh/edit/mesh_clean.h"
#include "libcore/mesh/edit/mesh_orient.h"
#include "libcore/mesh/edit/mesh_weld.h"

typedef struct Finding {
    const MesoPolygonMesh *mesh;
    MesoHalfEdges edges;
    MesoMeshFacts *facts;
    MesoArena scratch;
    uint32_t used_vertices;
} Finding;

/* ---- faces ---- */

static void count_sides(const Finding *finding)
{
    MesoMeshFacts *facts = finding->facts;
    for (uint32_t f = 0; f < finding->mesh->face_count; f++) {
        uint32_t sides = meso_polygon_sides(finding->mesh, f);
        facts->triangles += sides == 3;
        facts->quads += sides == 4;
        facts->larger += sides > 4;
        facts->most_sides = sides > facts->most_sides ? sides : facts->most_sides;
        facts->flat_faces += meso_face_is_flat(finding->mesh, f);
    }
}

static void sum_areas(const Finding *finding)
{
    const MesoPolygonMesh *mesh = finding->mesh;
    MesoMeshFacts *facts = finding->facts;
    double volume = 0;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *v = mesh->corners + meso_polygon_begin(mesh, f);
        for (uint32_t k = 1; k + 1 < meso_polygon_sides(mesh, f); k++) {
            MesoAreaVector a = meso_area_between(mesh->positions[v[0]], mesh->positions[v[k]],
                                                 mesh->positions[v[k + 1]]);
            facts->area += sqrt(meso_area_dot(a, a)) / 2;
        }
        volume += meso_face_volume(mesh, f, mesh->positions[mesh->corners[0]]) / 6;
    }
    facts->closed = mesh->face_count > 0 && facts->border_edges == 0 && facts->crowded_edges == 0;
    facts->volume = facts->closed && facts->disagreeing_edges == 0 ? volume : NAN;
}

static MesoStatus count_doubles(Finding *finding, MesoError *error)
{
    uint32_t *doubles = MESO_NEW(&finding->scratch, uint32_t, finding->mesh->face_count, error);
    MesoStatus status = doubles ? meso_mesh_find_doubles(doubles, finding->mesh, error) : MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < finding->mesh->face_count && !status; f++)
        finding->facts->double_faces += doubles[f] != f;
    return status;
}

/* ---- edges ---- */

static double edge_length(const MesoPolygonMesh *mesh, uint32_t from, uint32_t to)
{
    MesoVec3 p = mesh->positions[from], q = mesh->positions[to];
    double x = (double)q.x - p.x, y = (double)q.y - p.y, z = (double)q.z - p.z;
    return sqrt(x * x + y * y + z * z);
}

/* Crowded edges count once for each of their faces in lengths and valences: they have no place where they are
 * counted once. */
static MesoStatus look_at_edges(Finding *finding, MesoError *error)
{
    const MesoPolygonMesh *mesh = finding->mesh;
    MesoMeshFacts *facts = finding->facts;
    uint32_t *valences = MESO_NEW(&finding->scratch, uint32_t, mesh->vertex_count, error);
    double sum = 0;
    uint64_t count = 0;
    if (!valences)
        return MESO_ERR_MEMORY;
    facts->shortest_edge = mesh->corner_count ? INFINITY : 0;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        for (uint32_t h = begin; h < end; h++) {
            uint32_t from = mesh->corners[h], to = mesh->corners[h + 1 < end ? h + 1 : begin];
            if (finding->edges.twin[h] != MESO_NO_INDEX && finding->edges.twin[h] < h)
                continue;
            double length = edge_length(mesh, from, to);
            facts->shortest_edge = fmin(facts->shortest_edge, length);
            facts->longest_edge = fmax(facts->longest_edge, length);
            sum += length;
            count++;
            valences[from]++;
            valences[to]++;
        }
    }
    facts->mean_edge = count ? sum / (double)count : 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        facts->valences[valences[v] < MESO_MOST_VALENCE ? valences[v] : MESO_MOST_VALENCE]++;
    finding->used_vertices = mesh->vertex_count - facts->valences[0];
    return MESO_OK;
}

/* ---- what hangs together ---- */

/* Sets of vertices that sides of faces join: all sides, or those of the border; those of one vertex do not count. */
static uint32_t count_sets(const Finding *finding, uint32_t *sets, bool border)
{
    const MesoPolygonMesh *mesh = finding->mesh;
    uint32_t joined = 0, met = 0;
    meso_sets_init(sets, mesh->vertex_count);
    bool *seen = (bool *)(sets + mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        seen[v] = false;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        for (uint32_t h = begin; h < end; h++) {
            uint32_t from = mesh->corners[h], to = mesh->corners[h + 1 < end ? h + 1 : begin];
            if (border && finding->edges.twin[h] != MESO_NO_INDEX)
                continue;
            met += !seen[from];
            seen[from] = true;
            met += !seen[to];
            seen[to] = true;
            joined += meso_sets_join(sets, from, to);
        }
    }
    return met - joined;
}

static MesoStatus count_parts(Finding *finding, MesoError *error)
{
    uint32_t *sets = meso_arena_alloc(&finding->scratch, finding->mesh->vertex_count, sizeof *sets + sizeof(bool),
                                      error);
    if (!sets)
        return MESO_ERR_MEMORY;
    finding->facts->components = count_sets(finding, sets, false);
    finding->facts->border_loops = finding->facts->border_edges ? count_sets(finding, sets, true) : 0;
    return MESO_OK;
}

static MesoStatus count_pinched(Finding *finding, MesoError *error)
{
    const MesoPolygonMesh *mesh = finding->mesh;
    uint32_t *fans = MESO_NEW(&finding->scratch, uint32_t, mesh->corner_count, error);
    uint8_t *counts = MESO_NEW(&finding->scratch, uint8_t, mesh->vertex_count, error);
    MesoStatus status = fans && counts ? meso_mesh_find_fans(fans, mesh, &finding->edges, error) : MESO_ERR_MEMORY;
    for (uint32_t c = 0; c < mesh->corner_count && !status; c++) {
        uint8_t *count = &counts[mesh->corners[c]];
        finding->facts->pinched_vertices += fans[c] == c && *count == 1;
        *count = (uint8_t)(*count + (fans[c] == c && *count < 2));
    }
    return status;
}

static MesoStatus find_sides(Finding *finding, MesoError *error)
{
    MesoOrientCounts counts = {0};
    MesoPolygonMesh shape = *finding->mesh, turned;
    shape.attribute_count = 0;
    MesoStatus status = MESO_OK;
    if (finding->edges.reversed_count > 0)
        status = meso_mesh_orient(&turned, &finding->scratch, &shape, &finding->edges, &counts, error);
    finding->facts->orientable = counts.disagreeing == 0;
    return status;
}

/* ---- places ---- */

static void find_bounds(const Finding *finding)
{
    if (finding->mesh->vertex_count == 0)
        return;
    MesoBox box = meso_box_of(finding->mesh->positions, finding->mesh->vertex_count);
    finding->facts->low = box.low;
    finding->facts->high = box.high;
}

static MesoStatus find_borders(bool **on_border, Finding *finding, MesoError *error)
{
    const MesoPolygonMesh *mesh = finding->mesh;
    *on_border = MESO_NEW(&finding->scratch, bool, mesh->vertex_count, error);
    if (!*on_border)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        for (uint32_t h = begin; h < end; h++)
            if (finding->edges.twin[h] == MESO_NO_INDEX)
                (*on_border)[mesh->corners[h]] = (*on_border)[mesh->corners[h + 1 < end ? h + 1 : begin]] = true;
    }
    return MESO_OK;
}

/* Vertices that would be welded to one before, and those of them where both are on borders. */
static MesoStatus count_welded(uint32_t *count, uint32_t *borders, Finding *finding, const bool *on_border,
                               double distance, MesoError *error)
{
    uint32_t *first = MESO_NEW(&finding->scratch, uint32_t, finding->mesh->vertex_count, error);
    MesoStatus status = first ? meso_mesh_weld_map(first, finding->mesh, distance, error) : MESO_ERR_MEMORY;
    *count = *borders = 0;
    for (uint32_t v = 0; v < finding->mesh->vertex_count && !status; v++) {
        *count += first[v] != v;
        *borders += first[v] != v && on_border[v] && on_border[first[v]];
    }
    return status;
}

static MesoStatus find_places(Finding *finding, MesoError *error)
{
    bool *on_border = NULL;
    MesoMeshFacts *facts = finding->facts;
    find_bounds(finding);
    facts->near_distance = facts->mean_edge * MESO_NEAR_VERTICES;
    MesoStatus status = find_borders(&on_border, finding, error);
    if (!status)
        status = count_welded(&facts->coinciding_vertices, &facts->coinciding_borders, finding, on_border, 0, error);
    if (status || facts->near_distance <= 1e-30)
        return status;
    status = count_welded(&facts->near_vertices, &facts->near_borders, finding, on_border, facts->near_distance, error);
    facts->near_vertices -= facts->coinciding_vertices;
    facts->near_borders -= facts->coinciding_borders < facts->near_borders ? facts->coinciding_borders : facts->near_borders;
    return status;
}

/* Euler's formula: vertices - edges + faces = 2 components - 2 genus - border loops. */
static void find_genus(const Finding *finding)
{
    MesoMeshFacts *facts = finding->facts;
    facts->euler = (int64_t)finding->used_vertices - facts->edge_count + finding->mesh->face_count;
    facts->has_genus = facts->crowded_edges == 0 && facts->pinched_vertices == 0 && facts->orientable;
    if (facts->has_genus)
        facts->genus = (2 * (int64_t)facts->components - facts->border_loops - facts->euler) / 2;
}

static MesoStatus find(Finding *finding, uint32_t thread_count, MesoError *error)
{
    MesoStatus status = meso_half_edges_join(&finding->edges, &finding->scratch, finding->mesh, thread_count, error);
    if (status)
        return status;
    finding->facts->edge_count = finding->edges.edge_count;
    finding->facts->border_edges = finding->edges.border_count;
    finding->facts->crowded_edges = finding->edges.crowded_count;
    finding->facts->disagreeing_edges = finding->edges.reversed_count;
    count_sides(finding);
    sum_areas(finding);
    status = count_doubles(finding, error);
    if (!status)
        status = look_at_edges(finding, error);
    if (!status)
        status = count_parts(finding, error);
    if (!status)
        status = count_pinched(finding, error);
    if (!status)
        status = find_sides(finding, error);
    if (!status)
        status = find_places(finding, error);
    if (!status)
        find_genus(finding);
    return status;
}

MesoStatus meso_mesh_find_facts(MesoMeshFacts *facts, const MesoPolygonMesh *mesh, uint32_t thread_count,
                                MesoError *error)
{
    Finding finding = {.mesh = mesh, .facts = facts};
    *facts = (MesoMeshFacts){0};
    meso_arena_init(&finding.scratch);
    MesoStatus status = find(&finding, thread_count, error);
    meso_arena_release(&finding.scratch);
    return status;
}
