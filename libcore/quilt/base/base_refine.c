#include "libcore/quilt/base/base_refine.h"

#include <stdlib.h>
#include <string.h>

/* Edges longer by less than this share stay: passes end whatever rounding does. */
#define SLACK 1e-5f

/* ---- the mesh ---- */

void meso_base_mesh_release(MesoBaseMesh *base)
{
    meso_triangulation_release(&base->mesh);
    free(base->triangles);
    free(base->corner_weights);
    *base = (MesoBaseMesh){0};
}

MesoStatus meso_base_mesh_reserve(MesoBaseMesh *base, uint64_t vertex_count, uint64_t triangle_count, MesoError *error)
{
    MesoStatus status = meso_triangulation_reserve(&base->mesh, vertex_count, triangle_count, error);
    if (status || base->mesh.triangle_room <= base->triangle_room)
        return status;
    size_t room = base->mesh.triangle_room;
    uint32_t *triangles = realloc(base->triangles, room * sizeof *triangles);
    base->triangles = triangles ? triangles : base->triangles;
    MesoVec2 *weights = realloc(base->corner_weights, 3 * room * sizeof *weights);
    base->corner_weights = weights ? weights : base->corner_weights;
    if (!triangles || !weights)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %zu triangles", room);
    base->triangle_room = (uint32_t)room;
    return MESO_OK;
}

static bool is_wound_alike(const MesoTriangulation *mesh, uint32_t h)
{
    return mesh->twins[h] == MESO_NO_INDEX || mesh->corners[mesh->twins[h]] == mesh->corners[meso_next_corner(h)];
}

MesoStatus meso_base_mesh_copy(MesoBaseMesh *base, const MesoTriangulation *original, MesoError *error)
{
    *base = (MesoBaseMesh){0};
    size_t vertices = original->vertex_count, triangles = original->triangle_count;
    for (uint32_t h = 0; h < 3 * triangles; h++)
        if (!is_wound_alike(original, h))
            return meso_fail(error, MESO_ERR_INPUT, "faces %u and %u are wound against each other",
                             original->faces[h / 3], original->faces[original->twins[h] / 3]);
    MesoStatus status = meso_base_mesh_reserve(base, vertices + 1, triangles + 1, error);
    if (status) {
        meso_base_mesh_release(base);
        return status;
    }
    MesoTriangulation *mesh = &base->mesh;
    mesh->vertex_count = (uint32_t)vertices;
    mesh->triangle_count = (uint32_t)triangles;
    memcpy(mesh->positions, original->positions, vertices * sizeof *mesh->positions);
    memcpy(mesh->vertex_corner, original->vertex_corner, vertices * sizeof *mesh->vertex_corner);
    memcpy(mesh->origins, original->origins, vertices * sizeof *mesh->origins);
    memcpy(mesh->corners, original->corners, 3 * triangles * sizeof *mesh->corners);
    memcpy(mesh->twins, original->twins, 3 * triangles * sizeof *mesh->twins);
    memcpy(mesh->faces, original->faces, triangles * sizeof *mesh->faces);
    memset(mesh->labels, 0, triangles * sizeof *mesh->labels);
    for (uint32_t t = 0; t < triangles; t++) {
        base->triangles[t] = t;
        mesh->walls[t] = 0;
        for (uint32_t k = 0; k < 3; k++) {
            base->corner_weights[3 * t + k] = (MesoVec2){k == 1, k == 2};
            mesh->walls[t] |= (uint8_t)((mesh->twins[3 * t + k] == MESO_NO_INDEX) << k);
        }
    }
    return MESO_OK;
}

void meso_base_mesh_settle(MesoBaseMesh *base)
{
    MesoTriangulation *mesh = &base->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        mesh->labels[t] = 0;
        mesh->walls[t] = 0;
        for (uint32_t k = 0; k < 3; k++) {
            mesh->vertex_corner[mesh->corners[3 * t + k]] = 3 * t + k;
            mesh->walls[t] |= (uint8_t)((mesh->twins[3 * t + k] == MESO_NO_INDEX) << k);
        }
    }
}

/* ---- a pass ---- */

/* By half-edges of the mesh before the pass. */
typedef struct Pass {
    MesoBaseMesh *base;
    uint32_t half_edge_count, split_count;
    uint32_t *middles;          /* the vertex that splits it, or MESO_NO_INDEX */
    uint32_t *twins;
    uint32_t *firsts, *seconds; /* what it has become; the second half where it is split */
} Pass;

static MesoStatus begin_pass(Pass *pass, MesoBaseMesh *base, MesoError *error)
{
    size_t count = 3 * (size_t)base->mesh.triangle_count;
    uint32_t *room = malloc((4 * count + 1) * sizeof *room);
    if (!room)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %zu half-edges", count);
    *pass = (Pass){.base = base, .half_edge_count = (uint32_t)count, .middles = room, .twins = room + count,
                   .firsts = room + 2 * count, .seconds = room + 3 * count};
    memset(pass->middles, 0xff, count * sizeof *pass->middles);
    memcpy(pass->twins, base->mesh.twins, count * sizeof *pass->twins);
    return MESO_OK;
}

static MesoVec3 middle_of(MesoVec3 a, MesoVec3 b)
{
    return (MesoVec3){0.5f * a.x + 0.5f * b.x, 0.5f * a.y + 0.5f * b.y, 0.5f * a.z + 0.5f * b.z};
}

static MesoStatus split_edge(Pass *pass, uint32_t h, MesoError *error)
{
    MesoTriangulation *mesh = &pass->base->mesh;
    MesoStatus status = meso_base_mesh_reserve(pass->base, (uint64_t)mesh->vertex_count + 1, mesh->triangle_count,
                                               error);
    if (status)
        return status;
    MesoVec3 a = mesh->positions[mesh->corners[h]], b = mesh->positions[mesh->corners[meso_next_corner(h)]];
    mesh->positions[mesh->vertex_count] = middle_of(a, b);
    mesh->origins[mesh->vertex_count] = MESO_NO_INDEX;
    pass->middles[h] = mesh->vertex_count;
    if (mesh->twins[h] != MESO_NO_INDEX)
        pass->middles[mesh->twins[h]] = mesh->vertex_count;
    mesh->vertex_count++;
    pass->split_count++;
    return MESO_OK;
}

/* A corner of a piece: a vertex with its weights. */
typedef struct PieceCorner {
    uint32_t vertex;
    MesoVec2 weights;
} PieceCorner;

/* Puts a piece of triangle `from` at the place of `t`. */
static void put_piece(MesoBaseMesh *base, uint32_t t, uint32_t from, PieceCorner a, PieceCorner b, PieceCorner c)
{
    PieceCorner corner[3] = {a, b, c};
    base->triangles[t] = base->triangles[from];
    base->mesh.faces[t] = base->mesh.faces[from];
    for (uint32_t k = 0; k < 3; k++) {
        base->mesh.corners[3 * t + k] = corner[k].vertex;
        base->corner_weights[3 * t + k] = corner[k].weights;
    }
}

static void link_twins(MesoBaseMesh *base, uint32_t a, uint32_t b)
{
    base->mesh.twins[a] = b;
    base->mesh.twins[b] = a;
}

static float distance(const MesoBaseMesh *base, uint32_t a, uint32_t b)
{
    return meso_vec3_length(meso_vec3_sub(base->mesh.positions[a], base->mesh.positions[b]));
}

/* One side split: a, b, c with the middle m of a-b. */
static void split_in_two(Pass *pass, uint32_t t, uint32_t k, const PieceCorner *p, const PieceCorner *m)
{
    MesoBaseMesh *base = pass->base;
    uint32_t other = base->mesh.triangle_count++, side = 3 * t;
    PieceCorner a = p[k], b = p[(k + 1) % 3], c = p[(k + 2) % 3];
    put_piece(base, t, t, a, m[k], c);
    put_piece(base, other, t, m[k], b, c);
    link_twins(base, 3 * t + 1, 3 * other + 2);
    pass->firsts[side + k] = 3 * t;
    pass->seconds[side + k] = 3 * other;
    pass->firsts[side + (k + 1) % 3] = 3 * other + 1;
    pass->firsts[side + (k + 2) % 3] = 3 * t + 2;
}

/*
 * All but side k, from a to b, split: the tip at c, and the quadrangle below by its shorter diagonal.
 *
 *          c
 *         / \
 *        n---m
 *       /     \
 *      a-------b
 */
static void split_in_three(Pass *pass, uint32_t t, uint32_t k, const PieceCorner *p, const PieceCorner *middles)
{
    MesoBaseMesh *base = pass->base;
    uint32_t k1 = (k + 1) % 3, k2 = (k + 2) % 3, side = 3 * t;
    PieceCorner a = p[k], b = p[k1], c = p[k2], m = middles[k1], n = middles[k2];
    uint32_t low = base->mesh.triangle_count++, high = base->mesh.triangle_count++;
    put_piece(base, t, t, n, m, c);
    if (distance(base, a.vertex, m.vertex) <= distance(base, b.vertex, n.vertex)) {
        put_piece(base, low, t, a, b, m);
        put_piece(base, high, t, a, m, n);
        link_twins(base, 3 * low + 2, 3 * high);
        link_twins(base, 3 * high + 1, 3 * t);
        pass->firsts[side + k1] = 3 * low + 1;
        pass->seconds[side + k2] = 3 * high + 2;
    } else {
        put_piece(base, low, t, a, b, n);
        put_piece(base, high, t, b, m, n);
        link_twins(base, 3 * low + 1, 3 * high + 2);
        link_twins(base, 3 * high + 1, 3 * t);
        pass->firsts[side + k1] = 3 * high;
        pass->seconds[side + k2] = 3 * low + 2;
    }
    pass->firsts[side + k] = 3 * low;
    pass->seconds[side + k1] = 3 * t + 1;
    pass->firsts[side + k2] = 3 * t + 2;
}

static void split_in_four(Pass *pass, uint32_t t, const PieceCorner *p, const PieceCorner *m)
{
    MesoBaseMesh *base = pass->base;
    uint32_t first = base->mesh.triangle_count, side = 3 * t;
    base->mesh.triangle_count += 3;
    put_piece(base, t, t, m[0], m[1], m[2]);
    for (uint32_t k = 0; k < 3; k++) {
        /* the tip at corner k, with the side across from it towards the middle piece */
        uint32_t tip = first + k, before = (k + 2) % 3;
        put_piece(base, tip, t, p[k], m[k], m[before]);
        link_twins(base, 3 * tip + 1, 3 * t + before);
        pass->firsts[side + k] = 3 * tip;
        pass->seconds[side + before] = 3 * tip + 2;
    }
}

static void split_triangle(Pass *pass, uint32_t t)
{
    MesoBaseMesh *base = pass->base;
    PieceCorner p[3], m[3];
    uint32_t split = 0, last_split = 0, last_whole = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec2 a = base->corner_weights[3 * t + k], b = base->corner_weights[3 * t + (k + 1) % 3];
        p[k] = (PieceCorner){base->mesh.corners[3 * t + k], a};
        m[k] = (PieceCorner){pass->middles[3 * t + k], {0.5f * (a.x + b.x), 0.5f * (a.y + b.y)}};
        bool is_split = m[k].vertex != MESO_NO_INDEX;
        split += is_split;
        last_split = is_split ? k : last_split;
        last_whole = is_split ? last_whole : k;
    }
    if (split == 0)
        for (uint32_t k = 0; k < 3; k++)
            pass->firsts[3 * t + k] = 3 * t + k;
    else if (split == 1)
        split_in_two(pass, t, last_split, p, m);
    else if (split == 2)
        split_in_three(pass, t, last_whole, p, m);
    else
        split_in_four(pass, t, p, m);
}

static void link_sides(Pass *pass)
{
    uint32_t *twins = pass->base->mesh.twins;
    for (uint32_t h = 0; h < pass->half_edge_count; h++) {
        uint32_t across = pass->twins[h];
        bool is_split = pass->middles[h] != MESO_NO_INDEX, is_border = across == MESO_NO_INDEX;
        twins[pass->firsts[h]] = is_border ? across : is_split ? pass->seconds[across] : pass->firsts[across];
        if (is_split)
            twins[pass->seconds[h]] = is_border ? across : pass->firsts[across];
    }
}

static MesoStatus run_pass(Pass *pass, MesoError *error)
{
    uint64_t pieces = 0;
    for (uint32_t h = 0; h < pass->half_edge_count; h++)
        pieces += pass->middles[h] != MESO_NO_INDEX;
    MesoTriangulation *mesh = &pass->base->mesh;
    MesoStatus status = meso_base_mesh_reserve(pass->base, mesh->vertex_count, mesh->triangle_count + pieces, error);
    for (uint32_t t = 0; !status && t < pass->half_edge_count / 3; t++)
        split_triangle(pass, t);
    if (!status)
        link_sides(pass);
    return status;
}

/* ---- what is split ---- */

/* Floats far from the origin may be too coarse to split what is long. */
static bool is_long(const MesoBaseMesh *base, uint32_t h, float edge)
{
    uint32_t a = base->mesh.corners[h], b = base->mesh.corners[meso_next_corner(h)];
    if (!(distance(base, a, b) > edge))
        return false;
    MesoVec3 p = base->mesh.positions[a], q = base->mesh.positions[b], m = middle_of(p, q);
    return (m.x != p.x || m.y != p.y || m.z != p.z) && (m.x != q.x || m.y != q.y || m.z != q.z);
}

static bool is_first(const MesoTriangulation *mesh, uint32_t h)
{
    return mesh->twins[h] == MESO_NO_INDEX || h < mesh->twins[h];
}

static bool has_long(const MesoBaseMesh *base, float edge)
{
    for (uint32_t h = 0; h < 3 * base->mesh.triangle_count; h++)
        if (is_first(&base->mesh, h) && is_long(base, h, edge))
            return true;
    return false;
}

MesoStatus meso_base_refine(MesoBaseMesh *base, float edge, MesoError *error)
{
    MesoStatus status = MESO_OK;
    float limit = edge * (1 + SLACK);
    bool changed = false;
    while (!status && has_long(base, limit)) {
        Pass pass;
        status = begin_pass(&pass, base, error);
        if (status)
            return status;
        for (uint32_t h = 0; !status && h < pass.half_edge_count; h++)
            if (is_first(&base->mesh, h) && is_long(base, h, limit))
                status = split_edge(&pass, h, error);
        if (!status)
            status = run_pass(&pass, error);
        free(pass.middles);
        changed = true;
    }
    if (!status && changed)
        meso_base_mesh_settle(base);
    return status;
}

static void mark_border(uint8_t *on_border, const MesoTriangulation *mesh)
{
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->twins[h] == MESO_NO_INDEX)
            on_border[mesh->corners[h]] = on_border[mesh->corners[meso_next_corner(h)]] = 1;
}

/* A vertex in the middle of a triangle that has no neighbours. */
static MesoStatus split_alone(MesoBaseMesh *base, uint32_t t, MesoError *error)
{
    MesoTriangulation *mesh = &base->mesh;
    MesoStatus status = meso_base_mesh_reserve(base, (uint64_t)mesh->vertex_count + 1,
                                               (uint64_t)mesh->triangle_count + 2, error);
    if (status)
        return status;
    PieceCorner p[3], middle = {mesh->vertex_count, {0, 0}};
    MesoVec3 sum = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++) {
        p[k] = (PieceCorner){mesh->corners[3 * t + k], base->corner_weights[3 * t + k]};
        sum = meso_vec3_mad(sum, 1.0f / 3, mesh->positions[p[k].vertex]);
        middle.weights = meso_vec2_add(middle.weights, (MesoVec2){p[k].weights.x / 3, p[k].weights.y / 3});
    }
    mesh->positions[mesh->vertex_count] = sum;
    mesh->origins[mesh->vertex_count++] = MESO_NO_INDEX;
    uint32_t piece[3] = {t, mesh->triangle_count, mesh->triangle_count + 1};
    mesh->triangle_count += 2;
    for (uint32_t k = 0; k < 3; k++) {
        put_piece(base, piece[k], t, p[k], p[(k + 1) % 3], middle);
        mesh->twins[3 * piece[k]] = MESO_NO_INDEX;
        link_twins(base, 3 * piece[k] + 1, 3 * piece[(k + 1) % 3] + 2);
    }
    return MESO_OK;
}

static MesoStatus split_bridges(MesoBaseMesh *base, const uint8_t *on_border, MesoError *error)
{
    const MesoTriangulation *mesh = &base->mesh;
    Pass pass;
    MesoStatus status = begin_pass(&pass, base, error);
    if (status)
        return status;
    for (uint32_t h = 0; !status && h < pass.half_edge_count; h++)
        if (mesh->twins[h] != MESO_NO_INDEX && h < mesh->twins[h] && on_border[mesh->corners[h]] &&
            on_border[mesh->corners[meso_next_corner(h)]])
            status = split_edge(&pass, h, error);
    if (!status && pass.split_count)
        status = run_pass(&pass, error);
    for (uint32_t t = 0; !status && t < pass.half_edge_count / 3; t++)
        if (pass.twins[3 * t] == MESO_NO_INDEX && pass.twins[3 * t + 1] == MESO_NO_INDEX &&
            pass.twins[3 * t + 2] == MESO_NO_INDEX)
            status = split_alone(base, t, error);
    free(pass.middles);
    return status;
}

MesoStatus meso_base_free_borders(MesoBaseMesh *base, MesoError *error)
{
    uint8_t *on_border = calloc((size_t)base->mesh.vertex_count + 1, 1);
    if (!on_border)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %u vertices", base->mesh.vertex_count);
    mark_border(on_border, &base->mesh);
    MesoStatus status = split_bridges(base, on_border, error);
    free(on_border);
    if (!status)
        meso_base_mesh_settle(base);
    return status;
}
