/*
 * Strands brought nearer to how they lie around each other in the swatch. Each patch has been bent to fit those before
 * it, and what it was bent by goes on in those after it, although the surface does not ask for it. Here rings of
 * strands move along the surface, all at once, so that each has the others of its patch around it as in the swatch,
 * turned as suits them best ("As-rigid-as-possible surface modeling", Sorkine and Alexa 2007, in the surface); and so
 * that what goes on in another patch, along strands and beside them, does so as in the swatch. Which strands are joined
 * stays as it is. Each ring then is one of the swatch again, of its own width, as high up as there, and turned as the
 * swatch is; whole elements that grow from strands go with them.
 */
#include <string.h>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/parallel.h"
#include "libcore/quilt/finish/finish_relax_work.h"

/* ---- nodes ---- */

/* The patch that has placed a vertex: bands between two patches are of the later one. */
static void find_patches(uint32_t *patches, const MesoQuilt *quilt)
{
    memset(patches, 0xff, quilt->vertex_count * sizeof *patches);
    for (uint32_t h = 0; h < 3 * quilt->triangle_count; h++) {
        uint32_t *patch = &patches[quilt->corners[h]];
        *patch = quilt->patches[h / 3] < *patch ? quilt->patches[h / 3] : *patch;
    }
}

/* Vertices of one ring and patch that hang together are a node; to `node_of`, MESO_NO_INDEX: of no strand. */
static uint32_t find_nodes(uint32_t *node_of, uint32_t *sets, const uint32_t *patches, const MesoRelaxing *r,
                           const MesoQuilt *quilt)
{
    uint32_t count = 0;
    meso_sets_init(sets, quilt->vertex_count);
    for (uint32_t v = 0; v < quilt->vertex_count; v++)
        node_of[v] = r->rings->of_vertex[quilt->origins[v]];
    for (uint32_t h = 0; h < 3 * quilt->triangle_count; h++) {
        uint32_t a = quilt->corners[h], b = quilt->corners[meso_next_corner(h)];
        if (node_of[a] != MESO_NO_INDEX && node_of[a] == node_of[b] && patches[a] == patches[b])
            meso_sets_join(sets, a, b);
    }
    for (uint32_t v = 0; v < quilt->vertex_count; v++)
        if (node_of[v] != MESO_NO_INDEX) {
            uint32_t root = meso_sets_root(sets, v);
            node_of[v] = root == v ? count++ : node_of[root];
        }
    return count;
}

static MesoVec3 normal_under(const MesoFinishWork *work, uint32_t triangle)
{
    const MesoTriangulation *mesh = &work->base->mesh;
    const uint32_t *corners = &mesh->corners[3 * (size_t)triangle];
    MesoVec3 a = mesh->positions[corners[0]], b = meso_vec3_sub(mesh->positions[corners[1]], a);
    return meso_vec3_direction(meso_vec3_cross(b, meso_vec3_sub(mesh->positions[corners[2]], a)), (MesoVec3){0, 0, 0});
}

static void link_nodes(MesoRelaxNode *from, uint32_t to)
{
    if (from->next[0] == MESO_NO_INDEX)
        from->next[0] = to;
    else if (from->next[0] != to && from->next[1] == MESO_NO_INDEX)
        from->next[1] = to;
}

static void measure_nodes(MesoRelaxing *r, const uint32_t *node_of, const uint32_t *patches, const MesoFinishWork *work,
                          const MesoQuilt *quilt)
{
    for (uint32_t v = 0; v < quilt->vertex_count; v++) {
        if (node_of[v] == MESO_NO_INDEX)
            continue;
        MesoRelaxNode *node = &r->nodes[node_of[v]];
        if (!node->count++)
            *node = (MesoRelaxNode){.name = r->rings->of_vertex[quilt->origins[v]], .patch = patches[v], .count = 1,
                           .next = {MESO_NO_INDEX, MESO_NO_INDEX}};
        node->foot = meso_vec3_add(node->foot, meso_finish_foot(work, quilt->vertices[v]));
        node->normal = meso_vec3_add(node->normal, normal_under(work, quilt->vertices[v].triangle));
        node->origin = meso_vec3_add(node->origin, r->swatch->positions[quilt->origins[v]]);
        node->height += quilt->vertices[v].height;
    }
    for (uint32_t i = 0; i < r->node_count; i++) {
        MesoRelaxNode *node = &r->nodes[i];
        node->foot = meso_vec3_scale(node->foot, 1 / (float)node->count);
        node->origin = meso_vec3_scale(node->origin, 1 / (float)node->count);
        node->height /= (float)node->count;
        node->normal = meso_vec3_direction(node->normal, (MesoVec3){0, 0, 1});
        MesoVec3 axis = fabsf(node->normal.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
        node->x = meso_vec3_direction(meso_relax_along(axis, node->normal), axis);
        node->y = meso_vec3_cross(node->normal, node->x);
    }
    for (uint32_t h = 0; h < 3 * quilt->triangle_count; h++) {
        uint32_t a = node_of[quilt->corners[h]], b = node_of[quilt->corners[meso_next_corner(h)]];
        if (a == b || a == MESO_NO_INDEX || b == MESO_NO_INDEX)
            continue;
        link_nodes(&r->nodes[a], b);
        link_nodes(&r->nodes[b], a);
    }
}

static MesoStatus index_nodes(MesoRelaxing *r, MesoError *error)
{
    uint32_t room = 16;
    while (room < 2 * (uint64_t)r->node_count)
        room *= 2;
    r->table = MESO_NEW(r->arena, uint32_t, room, error);
    if (!r->table)
        return MESO_ERR_MEMORY;
    memset(r->table, 0xff, room * sizeof *r->table);
    r->mask = room - 1;
    for (uint32_t i = 0; i < r->node_count; i++) {
        uint32_t *entry = meso_relax_entry(r, r->nodes[i].patch, r->nodes[i].name);
        *entry = *entry == MESO_NO_INDEX ? i : *entry;
    }
    return MESO_OK;
}

/* ---- the quilt ---- */

static MesoVec3 move_of(const MesoRelaxing *r, uint32_t node)
{
    const double *m = &r->moves[3 * (size_t)node];
    return meso_relax_along((MesoVec3){(float)m[0], (float)m[1], (float)m[2]}, r->nodes[node].normal);
}

MesoQuiltVertex meso_relax_put(const MesoRelaxing *r, const MesoFinishWork *work, uint32_t node, uint32_t triangle,
                               uint32_t origin)
{
    const MesoRelaxNode *ring = &r->nodes[node];
    MesoVec3 beside = meso_vec3_sub(r->swatch->positions[origin], ring->origin);
    MesoVec3 foot = meso_vec3_add(ring->foot, meso_relax_turned(r, node, r->scale * beside.x, r->scale * beside.y));
    return meso_finish_locate(work, triangle, meso_vec3_add(foot, move_of(r, node)),
                              ring->height + r->height_scale * beside.z);
}

/* Rings in pieces keep the section that they have. */
static void move_vertex(MesoQuilt *quilt, const MesoFinishWork *work, uint32_t v, const MesoRelaxing *r, uint32_t node)
{
    MesoQuiltVertex *vertex = &quilt->vertices[v];
    MesoVec3 foot = meso_finish_foot(work, *vertex);
    if (r->nodes[node].count == r->rings->sizes[r->nodes[node].name])
        *vertex = meso_relax_put(r, work, node, vertex->triangle, quilt->origins[v]);
    else
        *vertex = meso_finish_locate(work, vertex->triangle, meso_vec3_add(foot, move_of(r, node)),
                                      vertex->height + r->nodes[node].rise);
}

/* Vertices are moved by blocks of so many. */
enum { BLOCK = 4096 };

typedef struct Mover {
    MesoQuilt *quilt;
    const MesoFinishWork *work;
    const MesoRelaxing *r;
    const uint32_t *node_of;
} Mover;

static void move_range(void *context, uint64_t begin, uint64_t end)
{
    const Mover *m = context;
    for (uint32_t v = (uint32_t)begin; v < end; v++)
        if (m->node_of[v] != MESO_NO_INDEX)
            move_vertex(m->quilt, m->work, v, m->r, m->node_of[v]);
}

static MesoStatus relax(MesoQuilt *quilt, MesoFinishWork *work, const MesoStrandRings *rings, MesoError *error)
{
    const MesoSwatch *swatch = work->swatch;
    float scale = work->options->scale, height_scale = work->options->height_scale;
    MesoRelaxing r = {.swatch = swatch, .rings = rings, .scale = scale, .arena = work->arena,
                      .height_scale = height_scale > 0 ? height_scale : scale,
                      .side = scale * fminf(swatch->size.x, swatch->size.y),
                      .thread_count = work->options->thread_count};
    uint32_t *patches = MESO_NEW(r.arena, uint32_t, quilt->vertex_count, error);
    uint32_t *node_of = MESO_NEW(r.arena, uint32_t, quilt->vertex_count, error);
    uint32_t *sets = MESO_NEW(r.arena, uint32_t, quilt->vertex_count, error);
    if (!patches || !node_of || !sets)
        return MESO_ERR_MEMORY;
    find_patches(patches, quilt);
    r.node_count = find_nodes(node_of, sets, patches, &r, quilt);
    r.nodes = MESO_NEW(r.arena, MesoRelaxNode, r.node_count, error);
    if (!r.nodes)
        return MESO_ERR_MEMORY;
    measure_nodes(&r, node_of, patches, work, quilt);
    bool any = false, may_move = false;
    MesoStatus status = meso_relax_find_carriers(&may_move, &r, error);
    if (!status)
        status = meso_relax_look_around(&r, error);
    if (!status)
        status = index_nodes(&r, error);
    if (!status)
        status = meso_relax_find_pairs(&r, error);
    if (!status)
        status = meso_relax_fit(&any, &r, may_move, error);
    if (!status && any)
        status = meso_relax_heights(&r, work->options->offset, error);
    if (!status && any)
        meso_relax_carry(quilt, &r, work);
    if (!status && any)
        meso_parallel_for(r.thread_count, quilt->vertex_count, BLOCK, move_range,
                          &(Mover){quilt, work, &r, node_of});
    work->levelled = any;
    return status;
}

MesoStatus meso_finish_relax(MesoQuilt *quilt, MesoFinishWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->arena);
    MesoStrandRings rings;
    MesoStatus status = meso_strands_find_rings(&rings, work->swatch, work->arena, error);
    if (!status && rings.count && quilt->triangle_count)
        status = relax(quilt, work, &rings, error);
    meso_arena_rewind(work->arena, mark);
    return status;
}
