#include "libcore/mesh/cut/mesh_cut.h"

#include <assert.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/cut/cut_work.h"
#include "libcore/mesh/cut/triangle_split.h"

/* A triangle that is cut: `whole` are the new numbers of its sides without nodes, MESO_NO_INDEX of those with. */
typedef struct CutTriangle {
    uint32_t triangle, first_part, part_count;
    uint32_t whole[3];
} CutTriangle;

/* One side of the triangle at work: its edge, where that has nodes, and the first of its points in the split. */
typedef struct Side {
    const MesoCutEdge *edge;
    uint32_t half_edge, first_point, count;
    bool reversed;      /* runs against the edge's lower half-edge */
} Side;

/*
 * All is worked out beside the mesh first, with the numbers that new elements are to have, so that a failure leaves
 * the mesh as it was.
 */
typedef struct Cut {
    const MesoTriangulation *mesh;
    const MesoCutLines *lines;
    MesoArena *arena;
    MesoCutReport *report;
    MesoCutNodes nodes;
    MesoCutWork work;
    MesoTriangleSplit split;
    uint32_t *node_point;           /* [node_count] of nodes inside triangles: point in the split */

    uint32_t triangle_count;
    CutTriangle *triangles;         /* [triangle_count] with all that there is work for */
    uint32_t part_room;
    uint32_t *corners, *twins;      /* [3 * part_count] as they are to be; MESO_NO_INDEX across the parent's sides */
    uint8_t *walls;                 /* [part_count] */
    float *corner_values;           /* [3 * corner_width * part_count] */
    uint32_t origin_count, origin_room;
    uint32_t (*pieces)[2];          /* [share_count + edge_count] both half-edges of an edge's pieces, lower first */
    uint8_t *piece_walls;           /* of a piece: 1 where it becomes a wall */
    uint32_t wall_count, wall_room;
    uint32_t *wall_sides;           /* new numbers of sides without nodes that become walls */
} Cut;

/* ---- one triangle ---- */

static MesoStatus add_side(Cut *cut, Side *side, uint32_t half_edge, MesoError *error)
{
    uint32_t e;
    *side = (Side){.half_edge = half_edge, .first_point = cut->split.point_count};
    if (!meso_cut_take(&cut->work.sides, half_edge, &e))
        return MESO_OK;
    side->edge = &cut->nodes.edges[e];
    side->count = side->edge->count;
    side->reversed = meso_cut_runs_against(cut->mesh, half_edge, side->edge->half_edge);
    for (uint32_t i = 0; i < side->count; i++) {
        uint32_t number = side->edge->first + (side->reversed ? side->count - 1 - i : i);
        int32_t share = cut->nodes.shares[number];
        MesoStatus status = meso_split_add_on_side(&cut->split, half_edge % 3,
                                                   side->reversed ? MESO_SPLIT_ONE - share : share, error);
        if (status)
            return status;
        cut->split.points[side->first_point + i].vertex = cut->report->first_vertex + number;
    }
    return MESO_OK;
}

static MesoStatus add_inner(Cut *cut, uint32_t triangle, MesoError *error)
{
    uint32_t node;
    while (meso_cut_take(&cut->work.inner, triangle, &node)) {
        if (node == MESO_NO_INDEX)
            continue;
        const MesoCutPlace *place = &cut->nodes.places[node];
        MesoStatus status = meso_split_add_inside(&cut->split, place->x, place->y, &cut->node_point[node], error);
        if (status)
            return status;
        cut->report->node_vertex[node] = cut->report->first_vertex + cut->origin_count +
                                         (cut->node_point[node] - cut->split.border_count);
    }
    return MESO_OK;
}

/* The point that a node is in the split; MESO_NO_INDEX where it is not in the triangle. */
static uint32_t point_of(const Cut *cut, const Side sides[3], uint32_t node)
{
    const MesoCutPlace *place = &cut->nodes.places[node];
    uint32_t triangle = sides[0].half_edge / 3;
    if (place->kind == MESO_IN_TRIANGLE)
        return place->element == triangle ? cut->node_point[node] : MESO_NO_INDEX;
    for (uint32_t k = 0; k < 3; k++) {
        const MesoCutEdge *edge = sides[k].edge;
        if (place->kind == MESO_AT_VERTEX && cut->mesh->corners[3 * triangle + k] == place->element)
            return k;
        if (place->kind == MESO_ON_EDGE && edge && place->element - edge->first < edge->count) {
            uint32_t i = place->element - edge->first;
            return sides[k].first_point + (sides[k].reversed ? edge->count - 1 - i : i);
        }
    }
    return MESO_NO_INDEX;
}

static MesoStatus draw_segments(Cut *cut, const Side sides[3], MesoError *error)
{
    uint32_t triangle = sides[0].half_edge / 3, s;
    while (meso_cut_take(&cut->work.segments, triangle, &s)) {
        const MesoCutSegment *segment = &cut->lines->segments[s];
        uint32_t a = point_of(cut, sides, segment->node[0]), b = point_of(cut, sides, segment->node[1]);
        if (a == MESO_NO_INDEX || b == MESO_NO_INDEX)
            return meso_fail(error, MESO_ERR_INTERNAL, "segment %u does not lie in triangle %u", s, triangle);
        MesoStatus status = meso_split_draw(&cut->split, a, b, error);
        if (status)
            return status;
    }
    return MESO_OK;
}

static MesoStatus split_triangle(Cut *cut, uint32_t triangle, Side sides[3], MesoError *error)
{
    const MesoTriangulation *mesh = cut->mesh;
    const uint32_t *corners = &mesh->corners[3 * triangle];
    const MesoVec3 corner[3] = {mesh->positions[corners[0]], mesh->positions[corners[1]], mesh->positions[corners[2]]};
    MesoStatus status = meso_split_begin(&cut->split, corner, error);
    for (uint32_t k = 0; k < 3 && !status; k++) {
        cut->split.points[k].vertex = corners[k];
        status = add_side(cut, &sides[k], 3 * triangle + k, error);
    }
    if (!status)
        status = add_inner(cut, triangle, error);
    if (!status)
        status = draw_segments(cut, sides, error);
    if (!status)
        meso_split_improve(&cut->split);
    return status;
}

/* ---- its parts ---- */

static void weights_of(const MesoSplitPoint *point, int32_t weight[3])
{
    weight[0] = MESO_SPLIT_ONE - point->x - point->y;
    weight[1] = point->x;
    weight[2] = point->y;
}

static MesoStatus add_origins(Cut *cut, uint32_t triangle, MesoError *error)
{
    const float unit = 1.0f / MESO_SPLIT_ONE;
    MesoCutReport *report = cut->report;
    for (uint32_t p = cut->split.border_count; p < cut->split.point_count; p++) {
        report->origins = MESO_GROW(cut->arena, report->origins, cut->origin_count, cut->origin_room, 256, error);
        if (!report->origins)
            return MESO_ERR_MEMORY;
        int32_t weight[3];
        weights_of(&cut->split.points[p], weight);
        cut->split.points[p].vertex = report->first_vertex + cut->origin_count;
        MesoCutOrigin *origin = &report->origins[cut->origin_count++];
        for (uint32_t k = 0; k < 3; k++) {
            origin->vertex[k] = cut->mesh->corners[3 * triangle + k];
            origin->weight[k] = (float)weight[k] * unit;
        }
    }
    return MESO_OK;
}

static MesoStatus reserve_parts(Cut *cut, uint64_t more, MesoError *error)
{
    uint64_t count = cut->report->part_count, room = 2 * (uint64_t)cut->part_room;
    size_t width = 3 * (size_t)cut->mesh->corner_width;
    if (count + more <= cut->part_room)
        return MESO_OK;
    room = room < count + more ? count + more : room;
    if (room > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "lines cut a mesh into more than %u triangles", UINT32_MAX);
    MesoCutPart *parts = meso_arena_enlarge(cut->arena, cut->report->parts, count, room, sizeof *parts, error);
    uint32_t *corners = meso_arena_enlarge(cut->arena, cut->corners, count, room, 3 * sizeof *corners, error);
    uint32_t *twins = meso_arena_enlarge(cut->arena, cut->twins, count, room, 3 * sizeof *twins, error);
    uint8_t *walls = meso_arena_enlarge(cut->arena, cut->walls, count, room, sizeof *walls, error);
    float *values = meso_arena_enlarge(cut->arena, cut->corner_values, count, room, width * sizeof *values, error);
    if (!parts || !corners || !twins || !walls || !values)
        return MESO_ERR_MEMORY;
    cut->report->parts = parts;
    cut->corners = corners;
    cut->twins = twins;
    cut->walls = walls;
    cut->corner_values = values;
    cut->part_room = (uint32_t)room;
    return MESO_OK;
}

/* Half-edge `number`, to be, lies along a side of the parent from point `begin` on. */
static MesoStatus note_border(Cut *cut, const Side sides[3], uint32_t begin, uint32_t number, bool is_line,
                              uint32_t part, MesoError *error)
{
    uint32_t k = begin;
    if (begin >= 3)
        for (k = 0; begin - sides[k].first_point >= sides[k].count; k++)
            assert(k < 2);
    const Side *side = &sides[k];
    if (meso_side_is_wall(cut->mesh, side->half_edge))
        cut->walls[part] |= (uint8_t)(1u << number % 3);
    if (!side->edge) {
        cut->triangles[cut->triangle_count - 1].whole[k] = number;
        if (!is_line)
            return MESO_OK;
        cut->wall_sides = MESO_GROW(cut->arena, cut->wall_sides, cut->wall_count, cut->wall_room, 256, error);
        if (!cut->wall_sides)
            return MESO_ERR_MEMORY;
        cut->wall_sides[cut->wall_count++] = number;
        return MESO_OK;
    }
    uint32_t i = begin < 3 ? 0 : begin - side->first_point + 1;
    uint32_t piece = side->edge->first + (uint32_t)(side->edge - cut->nodes.edges) +
                     (side->reversed ? side->count - i : i);
    cut->pieces[piece][side->half_edge != side->edge->half_edge] = number;
    if (is_line)
        cut->piece_walls[piece] = 1;
    return MESO_OK;
}

static void interpolate_corner(const Cut *cut, uint32_t triangle, const int32_t weight[3], float *values)
{
    uint32_t width = cut->mesh->corner_width;
    if (width == 0)
        return;
    const float *from = &cut->mesh->corner_values[3 * (size_t)width * triangle];
    for (uint32_t i = 0; i < width; i++)
        values[i] = (float)((weight[0] * (double)from[i] + weight[1] * (double)from[width + i] +
                             weight[2] * (double)from[2 * width + i]) / MESO_SPLIT_ONE);
}

/* Triangle `local` of the split becomes the next part; those behind the first are numbered from `next` on. */
static MesoStatus add_part(Cut *cut, const Side sides[3], uint32_t local, uint32_t next, MesoError *error)
{
    const MesoTriangleSplit *split = &cut->split;
    uint32_t part = cut->report->part_count++, parent = sides[0].half_edge / 3;
    uint32_t triangle = local == 0 ? parent : next + local - 1;
    int32_t sum[3] = {0, 0, 0};
    cut->walls[part] = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t h = 3 * local + k, across = split->twins[h];
        const MesoSplitPoint *point = &split->points[split->corners[h]];
        int32_t weight[3];
        weights_of(point, weight);
        for (uint32_t i = 0; i < 3; i++)
            sum[i] += weight[i];
        cut->corners[3 * (size_t)part + k] = point->vertex;
        if (split->lines[h])
            cut->walls[part] |= (uint8_t)(1u << k);
        cut->twins[3 * (size_t)part + k] =
            across == MESO_NO_INDEX ? MESO_NO_INDEX : across < 3 ? 3 * parent + across : 3 * next + across - 3;
        if (across == MESO_NO_INDEX &&
            note_border(cut, sides, split->corners[h], 3 * triangle + k, split->lines[h], part, error))
            return MESO_ERR_MEMORY;
        interpolate_corner(cut, parent, weight, &cut->corner_values[cut->mesh->corner_width * (3 * (size_t)part + k)]);
    }
    const double unit = 1.0 / (3.0 * MESO_SPLIT_ONE);
    cut->report->parts[part] = (MesoCutPart){
        triangle, parent, {(float)(sum[0] * unit), (float)(sum[1] * unit), (float)(sum[2] * unit)}};
    return MESO_OK;
}

static MesoStatus add_parts(Cut *cut, const Side sides[3], uint64_t next, MesoError *error)
{
    uint32_t triangle = sides[0].half_edge / 3, count = cut->split.half_edge_count / 3;
    MesoStatus status = reserve_parts(cut, count, error);
    if (!status)
        status = add_origins(cut, triangle, error);
    cut->triangles[cut->triangle_count++] = (CutTriangle){
        triangle, cut->report->part_count, count, {MESO_NO_INDEX, MESO_NO_INDEX, MESO_NO_INDEX}};
    for (uint32_t local = 0; local < count && !status; local++)
        status = add_part(cut, sides, local, (uint32_t)next, error);
    return status;
}

/* Works out all parts; says how many triangles there are to be. */
static MesoStatus split_triangles(Cut *cut, uint64_t *triangle_count, MesoError *error)
{
    uint32_t triangle;
    while (meso_cut_work_next(&cut->work, &triangle)) {
        Side sides[3];
        MesoStatus status = split_triangle(cut, triangle, sides, error);
        if (!status)
            status = add_parts(cut, sides, *triangle_count, error);
        if (status)
            return status;
        *triangle_count += cut->split.half_edge_count / 3 - 1;
    }
    return MESO_OK;
}

/* ---- the mesh ---- */

static void add_vertices(MesoTriangulation *mesh, const Cut *cut)
{
    uint32_t width = mesh->vertex_width;
    for (uint32_t i = 0; i < cut->origin_count; i++) {
        const MesoCutOrigin *origin = &cut->report->origins[i];
        uint32_t vertex = mesh->vertex_count++;
        double p[3] = {0, 0, 0};
        for (uint32_t k = 0; k < 3; k++) {
            const MesoVec3 *from = &mesh->positions[origin->vertex[k]];
            p[0] += origin->weight[k] * (double)from->x;
            p[1] += origin->weight[k] * (double)from->y;
            p[2] += origin->weight[k] * (double)from->z;
        }
        mesh->positions[vertex] = (MesoVec3){(float)p[0], (float)p[1], (float)p[2]};
        for (uint32_t w = 0; w < width; w++) {
            double value = 0;
            for (uint32_t k = 0; k < 3; k++)
                value += origin->weight[k] * (double)mesh->vertex_values[(size_t)width * origin->vertex[k] + w];
            mesh->vertex_values[(size_t)width * vertex + w] = (float)value;
        }
    }
}

static void write_part(MesoTriangulation *mesh, const Cut *cut, uint32_t part)
{
    uint32_t triangle = cut->report->parts[part].triangle, parent = cut->report->parts[part].parent;
    size_t width = 3 * (size_t)mesh->corner_width;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t vertex = cut->corners[3 * (size_t)part + k];
        mesh->corners[3 * triangle + k] = vertex;
        mesh->twins[3 * triangle + k] = cut->twins[3 * (size_t)part + k];
        mesh->vertex_corner[vertex] = 3 * triangle + k;
    }
    mesh->labels[triangle] = mesh->labels[parent];
    mesh->faces[triangle] = mesh->faces[parent];
    mesh->walls[triangle] = cut->walls[part];
    if (width)
        memcpy(&mesh->corner_values[width * triangle], &cut->corner_values[width * part], width * sizeof(float));
}

/*
 * A side without nodes is tied to what lies across it now: the neighbour's old side, which the neighbour finds tied to
 * the new one when its turn comes, or its new one if that was before.
 */
static void write_parts(MesoTriangulation *mesh, const Cut *cut, const CutTriangle *from)
{
    uint32_t across[3];
    for (uint32_t k = 0; k < 3; k++)
        across[k] = mesh->twins[3 * from->triangle + k];
    for (uint32_t i = 0; i < from->part_count; i++)
        write_part(mesh, cut, from->first_part + i);
    for (uint32_t k = 0; k < 3; k++)
        if (from->whole[k] != MESO_NO_INDEX && across[k] != MESO_NO_INDEX) {
            mesh->twins[from->whole[k]] = across[k];
            mesh->twins[across[k]] = from->whole[k];
        }
}

static void raise_wall(MesoTriangulation *mesh, uint32_t half_edge)
{
    if (half_edge != MESO_NO_INDEX)
        mesh->walls[half_edge / 3] |= (uint8_t)(1u << half_edge % 3);
}

static void tie_pieces(MesoTriangulation *mesh, const Cut *cut)
{
    uint32_t count = cut->nodes.share_count + cut->nodes.edge_count;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = cut->pieces[i][0], b = cut->pieces[i][1];
        mesh->twins[a] = b;
        if (b != MESO_NO_INDEX)
            mesh->twins[b] = a;
        if (cut->piece_walls[i]) {
            raise_wall(mesh, a);
            raise_wall(mesh, b);
        }
    }
    for (uint32_t i = 0; i < cut->wall_count; i++) {
        raise_wall(mesh, cut->wall_sides[i]);
        raise_wall(mesh, mesh->twins[cut->wall_sides[i]]);
    }
}

static void apply(MesoTriangulation *mesh, const Cut *cut, uint32_t triangle_count)
{
    add_vertices(mesh, cut);
    mesh->triangle_count = triangle_count;
    for (uint32_t i = 0; i < cut->triangle_count; i++)
        write_parts(mesh, cut, &cut->triangles[i]);
    tie_pieces(mesh, cut);
}

/* ---- cutting ---- */

/* Where no segments cross, a point on a side makes one part more in each triangle there, one inside two. */
static MesoStatus expect_parts(Cut *cut, MesoError *error)
{
    uint32_t count = meso_cut_work_count(&cut->work);
    cut->triangles = MESO_NEW(cut->arena, CutTriangle, count, error);
    if (!cut->triangles)
        return MESO_ERR_MEMORY;
    return reserve_parts(cut, count + 2 * ((uint64_t)cut->nodes.share_count + cut->work.inner.count) + 1, error);
}

static MesoStatus begin(Cut *cut, MesoError *error)
{
    MesoStatus status = meso_cut_nodes_place(&cut->nodes, cut->mesh, cut->lines, cut->arena, error);
    if (status)
        return status;
    size_t share_count = cut->nodes.share_count, piece_count = share_count + cut->nodes.edge_count;
    cut->node_point = MESO_NEW(cut->arena, uint32_t, cut->lines->node_count, error);
    cut->report->node_vertex = MESO_NEW(cut->arena, uint32_t, cut->lines->node_count, error);
    cut->report->origins = MESO_NEW(cut->arena, MesoCutOrigin, share_count, error);
    cut->pieces = meso_arena_alloc(cut->arena, piece_count, sizeof *cut->pieces, error);
    cut->piece_walls = MESO_NEW(cut->arena, uint8_t, piece_count, error);
    if (!cut->node_point || !cut->report->node_vertex || !cut->report->origins || !cut->pieces || !cut->piece_walls)
        return MESO_ERR_MEMORY;
    cut->origin_room = (uint32_t)share_count;
    memset(cut->pieces, 0xff, piece_count * sizeof *cut->pieces);
    status = meso_cut_work_list(&cut->work, cut->mesh, cut->lines, &cut->nodes, cut->arena, error);
    return status ? status : expect_parts(cut, error);
}

/* Vertices of nodes at vertices and on edges, and origins of the latter. */
static void number_places(Cut *cut)
{
    const MesoTriangulation *mesh = cut->mesh;
    const float unit = 1.0f / MESO_SPLIT_ONE;
    for (uint32_t n = 0; n < cut->lines->node_count; n++) {
        const MesoCutPlace *place = &cut->nodes.places[n];
        cut->report->node_vertex[n] = place->element + (place->kind == MESO_ON_EDGE ? mesh->vertex_count : 0);
    }
    for (uint32_t e = 0; e < cut->nodes.edge_count; e++) {
        const MesoCutEdge *edge = &cut->nodes.edges[e];
        uint32_t a = mesh->corners[edge->half_edge], b = mesh->corners[meso_next_corner(edge->half_edge)];
        for (uint32_t i = edge->first; i < edge->first + edge->count; i++) {
            int32_t share = cut->nodes.shares[i];
            cut->report->origins[cut->origin_count++] = (MesoCutOrigin){
                {a, b, a}, {(float)(MESO_SPLIT_ONE - share) * unit, (float)share * unit, 0}};
        }
    }
}

MesoStatus meso_mesh_cut(MesoTriangulation *mesh, const MesoCutLines *lines, MesoCutReport *report, MesoArena *arena,
                         MesoError *error)
{
    uint64_t triangle_count = mesh->triangle_count;
    *report = (MesoCutReport){.first_vertex = mesh->vertex_count, .first_triangle = mesh->triangle_count};
    Cut cut = {.mesh = mesh, .lines = lines, .arena = arena, .report = report, .split = {.arena = arena}};
    MesoStatus status = begin(&cut, error);
    if (status)
        return status;
    number_places(&cut);
    status = split_triangles(&cut, &triangle_count, error);
    if (!status)
        status = meso_triangulation_reserve(mesh, (uint64_t)mesh->vertex_count + cut.origin_count, triangle_count,
                                            error);
    if (!status)
        apply(mesh, &cut, (uint32_t)triangle_count);
    return status;
}
