#include "libcore/base/grow.h"
#include "libcore/base/parallel.h"
#include "libcore/shell/box_tree.h"
#include "libcore/shell/prism_bodies.h"
#include "libcore/shell/prism_layer.h"

typedef struct Pair {
    uint32_t a, b;
} Pair;

typedef struct Search {
    MesoPrismLayer *layer;
    double low, high;       /* with the surface itself between them */
    uint8_t *graphs;        /* [vertex_count] */
    MesoBox *boxes;         /* [triangle_count] */
    MesoVec3 middle;        /* of them all */
    MesoBoxTree tree;       /* of the prisms' boxes: what lies near to each other is asked for together */
    MesoPrismHull *hulls;   /* [triangle_count] by places in the tree */
    float size;             /* that no coordinate of theirs is beyond, from the middle */
    Pair *pairs;            /* that meet */
    uint32_t pair_count;
    MesoArena *arena;
    MesoError *error;
} Search;

/* Pairs of some triangles, by themselves: they are put in one row in the tree's order. */
typedef struct Block {
    const Search *search;
    Pair *pairs;
    uint32_t pair_count, pair_room;
    MesoArena arena;
    MesoError error;
    MesoStatus status;
} Block;

enum { BLOCK = 128 * MESO_BOX_TREE_LEAF };     /* triangles */

/* ---- neighbours ---- */

/*
 * Whether the lids of a prism at all heights are seen from one side along `axis`: their projected areas are below that
 * of a bilinear function of two heights, and so positive where its four values are.
 */
static bool lids_face(const Search *search, uint32_t triangle, MesoVec3d axis)
{
    const double margin = 0.02;
    const uint32_t *v = &search->layer->mesh->corners[3 * (size_t)triangle];
    MesoVec3d sides[2][2];
    for (uint32_t k = 0; k < 2; k++) {
        double height = k == 0 ? search->low : search->high;
        MesoVec3d p = meso_prism_corner(search->layer, v[0], height);
        sides[0][k] = meso_vec3d_sub(meso_prism_corner(search->layer, v[1], height), p);
        sides[1][k] = meso_vec3d_sub(meso_prism_corner(search->layer, v[2], height), p);
    }
    double least = margin * search->layer->areas[triangle];
    for (uint32_t k = 0; k < 4; k++)
        if (!(meso_vec3d_det(sides[0][k & 1], sides[1][k >> 1], axis) > least))
            return false;
    return true;
}

/*
 * Whether the layer around a vertex does not meet itself: all its lids are seen from one side, so that each level is a
 * graph over the plane; as no prism folds, higher levels lie above lower ones, and each place is met once.
 */
static bool is_graph(const Search *search, uint32_t vertex)
{
    const MesoPrismLayer *layer = search->layer;
    MesoFan fan = meso_fan_first(layer->mesh, vertex);
    uint32_t first = fan.corner;
    do {
        if (layer->flat[fan.corner / 3] || !lids_face(search, fan.corner / 3, layer->normals[vertex]))
            return false;
    } while (meso_fan_next(layer->mesh, &fan) && fan.corner != first);
    return true;
}

static bool share_vertex(const Search *search, uint32_t a, uint32_t b, bool *graph)
{
    const uint32_t *v = &search->layer->mesh->corners[3 * (size_t)a], *w = &search->layer->mesh->corners[3 * (size_t)b];
    bool found = false;
    for (uint32_t k = 0; k < 9; k++)
        if (v[k / 3] == w[k % 3]) {
            found = true;
            *graph = *graph || search->graphs[v[k / 3]];
        }
    return found;
}

/* ---- pairs ---- */

static MesoPrismBody body_of(const Search *search, uint32_t triangle, double share)
{
    const MesoPrismLayer *layer = search->layer;
    const uint32_t *v = &layer->mesh->corners[3 * (size_t)triangle];
    MesoPrismBody body;
    for (uint32_t k = 0; k < 6; k++)
        body.corners[k] = meso_prism_corner(layer, v[k % 3], share * (k < 3 ? search->low : search->high));
    meso_prism_split(v, body.tetrahedra);
    return body;
}

/* Where the triangles themselves meet or touch, no height helps. */
static bool triangles_meet(const Search *search, uint32_t a, uint32_t b)
{
    MesoPrismBody one = body_of(search, a, 0), other = body_of(search, b, 0);
    return !meso_prism_hulls_apart(&one, &other);
}

static bool bodies_meet(const Search *search, uint32_t a, uint32_t b)
{
    bool graph = false, neighbours = share_vertex(search, a, b, &graph);
    if (graph)
        return false;
    MesoPrismBody body = body_of(search, a, 1), other = body_of(search, b, 1);
    if (!neighbours && meso_prism_hulls_apart(&body, &other))
        return false;
    return !meso_prism_tetrahedra_apart(&body, &other) && (neighbours || !triangles_meet(search, a, b));
}

/* Most prisms whose boxes meet do not, and that by far: those at two places of the tree. */
static bool are_clear(const Search *search, uint32_t place, uint32_t other)
{
    const MesoPrismHull *a = &search->hulls[place], *b = &search->hulls[other];
    bool graph = false;
    return meso_prism_hulls_clear(a, b, search->size) ||
           (!share_vertex(search, search->tree.order[place], search->tree.order[other], &graph) &&
            meso_prism_walls_clear(a, b, search->size));
}

static void try_pair(void *context, uint32_t first, uint32_t second)
{
    Block *block = context;
    const Search *search = block->search;
    uint32_t one = search->tree.order[first], other = search->tree.order[second];
    Pair pair = {one < other ? one : other, one < other ? other : one};
    const uint8_t *flat = search->layer->flat;
    if (block->status || flat[one] || flat[other] || are_clear(search, first, second) ||
        !bodies_meet(search, pair.a, pair.b))
        return;
    Pair *pairs = MESO_GROW(&block->arena, block->pairs, block->pair_count, block->pair_room, 256, &block->error);
    if (!pairs) {
        block->status = MESO_ERR_MEMORY;
        return;
    }
    block->pairs = pairs;
    block->pairs[block->pair_count++] = pair;
}

/* The box as floats, no smaller. */
static MesoBox box_of(const MesoPrismBody *body)
{
    MesoBox box = meso_box_empty();
    for (uint32_t k = 0; k < 6; k++) {
        MesoVec3 p = meso_vec3d_narrow(body->corners[k]);
        float size = 2e-7f * (fabsf(p.x) + fabsf(p.y) + fabsf(p.z));
        meso_box_add_around(&box, p, size);
    }
    return box;
}

static void find_graphs(void *context, uint64_t begin, uint64_t end)
{
    Search *search = context;
    for (uint32_t v = (uint32_t)begin; v < end; v++)
        search->graphs[v] = search->layer->mesh->vertex_corner[v] != MESO_NO_INDEX && is_graph(search, v);
}

static void find_blocks(void *context, uint64_t begin, uint64_t end)
{
    for (uint64_t b = begin; b < end; b++) {
        Block *block = &((Block *)context)[b];
        const Search *search = block->search;
        uint64_t last = (b + 1) * BLOCK, count = search->layer->mesh->triangle_count;
        meso_box_tree_query_pairs(&search->tree, (uint32_t)(b * BLOCK), (uint32_t)(last < count ? last : count),
                                  try_pair, block);
    }
}

static MesoStatus gather_blocks(Search *search, const Block *blocks, uint32_t count)
{
    uint64_t sum = 0;
    for (uint32_t b = 0; b < count; b++) {
        if (blocks[b].status) {
            if (search->error)
                *search->error = blocks[b].error;
            return blocks[b].status;
        }
        sum += blocks[b].pair_count;
    }
    if (sum > UINT32_MAX)
        return meso_fail(search->error, MESO_ERR_LIMIT, "%llu pairs of prisms meet", (unsigned long long)sum);
    search->pairs = MESO_NEW(search->arena, Pair, sum, search->error);
    if (!search->pairs)
        return MESO_ERR_MEMORY;
    for (uint32_t b = 0; b < count; b++)
        for (uint32_t p = 0; p < blocks[b].pair_count; p++)
            search->pairs[search->pair_count++] = blocks[b].pairs[p];
    return MESO_OK;
}

static void make_boxes(void *context, uint64_t begin, uint64_t end)
{
    Search *search = context;
    for (uint32_t t = (uint32_t)begin; t < end; t++) {
        MesoPrismBody body = body_of(search, t, 1);
        search->boxes[t] = box_of(&body);
    }
}

static void make_hulls(void *context, uint64_t begin, uint64_t end)
{
    Search *search = context;
    for (uint32_t place = (uint32_t)begin; place < end; place++) {
        MesoPrismBody body = body_of(search, search->tree.order[place], 1);
        search->hulls[place] = meso_prism_hull(&body, meso_vec3d(search->middle));
    }
}

/* A tree of the boxes, and the hulls about the middle of all. */
static MesoStatus build_tree(Search *search)
{
    uint32_t count = search->layer->mesh->triangle_count;
    search->hulls = MESO_NEW(search->arena, MesoPrismHull, count, search->error);
    MesoBox *boxes = MESO_NEW(search->arena, MesoBox, count, search->error), all = meso_box_empty();
    if (!search->hulls || !boxes)
        return MESO_ERR_MEMORY;
    search->boxes = boxes;
    meso_parallel_for(search->layer->thread_count, count, BLOCK, make_boxes, search);
    for (uint32_t t = 0; t < count; t++) {
        meso_box_add(&all, boxes[t].low);
        meso_box_add(&all, boxes[t].high);
    }
    MesoStatus status = meso_box_tree_build(&search->tree, search->arena, boxes, count, search->error);
    if (status)
        return status;
    search->middle = meso_vec3_lerp(all.low, all.high, 0.5f);
    MesoVec3 half = meso_vec3_sub(all.high, search->middle);
    search->size = fmaxf(half.x, fmaxf(half.y, half.z));
    meso_parallel_for(search->layer->thread_count, count, BLOCK, make_hulls, search);
    return MESO_OK;
}

static MesoStatus find_pairs(Search *search)
{
    const MesoTriangulation *mesh = search->layer->mesh;
    uint32_t block_count = mesh->triangle_count / BLOCK + (mesh->triangle_count % BLOCK != 0);
    Block *blocks = MESO_NEW(search->arena, Block, block_count, search->error);
    MesoStatus status = blocks ? build_tree(search) : MESO_ERR_MEMORY;
    if (status)
        return status;
    for (uint32_t b = 0; b < block_count; b++) {
        blocks[b].search = search;
        meso_arena_init(&blocks[b].arena);
    }
    meso_parallel_for(search->layer->thread_count, block_count, 1, find_blocks, blocks);
    status = gather_blocks(search, blocks, block_count);
    for (uint32_t b = 0; b < block_count; b++)
        meso_arena_release(&blocks[b].arena);
    return status;
}

/* ---- lower ---- */

static void lower_vertices(Search *search, uint8_t *marked, uint32_t triangle, double step)
{
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t v = search->layer->mesh->corners[3 * (size_t)triangle + k];
        if (!marked[v])
            search->layer->rises[v] = meso_vec3d_scale(search->layer->rises[v], step);
        marked[v] = 1;
    }
}

/* Pairs that are apart now are let go: what is lowered stays within the hull that it had. */
static MesoStatus lower_pairs(Search *search, uint8_t *marked, uint8_t *touched)
{
    enum { ROUNDS = 64 };
    MesoPrismLayer *layer = search->layer;
    for (uint32_t round = 0; search->pair_count > 0 && round < ROUNDS; round++) {
        for (uint32_t v = 0; v < layer->mesh->vertex_count; v++) {
            touched[v] |= marked[v];
            marked[v] = 0;
        }
        double step = round + 1 < ROUNDS ? 0.85 : 0;
        for (uint32_t p = 0; p < search->pair_count; p++) {
            lower_vertices(search, marked, search->pairs[p].a, step);
            lower_vertices(search, marked, search->pairs[p].b, step);
        }
        MesoStatus status = meso_prism_lower_folds(layer, marked, search->arena, search->error);
        if (status)
            return status;
        uint32_t kept = 0;
        for (uint32_t p = 0; p < search->pair_count; p++) {
            Pair pair = search->pairs[p];
            if (bodies_meet(search, pair.a, pair.b))
                search->pairs[kept++] = pair;
        }
        search->pair_count = kept;
    }
    for (uint32_t v = 0; v < layer->mesh->vertex_count; v++)
        if (touched[v] | marked[v])
            layer->thickness[v] = fmin(layer->thickness[v], meso_vec3d_length(layer->rises[v]));
    return MESO_OK;
}

MesoStatus meso_prism_lower_overlaps(MesoPrismLayer *layer, bool *lowered, MesoArena *scratch, MesoError *error)
{
    const MesoTriangulation *mesh = layer->mesh;
    MesoArenaMark mark = meso_arena_mark(scratch);
    Search search = {.layer = layer, .low = fmin(layer->low, 0), .high = fmax(layer->high, 0), .arena = scratch,
                     .error = error};
    search.graphs = MESO_NEW(scratch, uint8_t, mesh->vertex_count, error);
    uint8_t *marked = MESO_NEW(scratch, uint8_t, mesh->vertex_count, error);
    uint8_t *touched = MESO_NEW(scratch, uint8_t, mesh->vertex_count, error);
    if (!search.graphs || !marked || !touched)
        return MESO_ERR_MEMORY;
    meso_parallel_for(layer->thread_count, mesh->vertex_count, BLOCK, find_graphs, &search);
    MesoStatus status = find_pairs(&search);
    *lowered = search.pair_count > 0;
    if (!status)
        status = lower_pairs(&search, marked, touched);
    meso_arena_rewind(scratch, mark);
    return status;
}
