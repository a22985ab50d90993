#include "libcore/quilt/settle/sphere_tree.h"

#include <stdlib.h>

#include "libcore/math/box.h"
#include "libcore/quilt/seam/bodies_meet.h"

enum { LEAF = 1, DEPTH = 64 };

typedef struct Item {
    float key;
    uint32_t triangle;
} Item;

typedef struct Build {
    MesoSphereTree *tree;
    Item *items;
} Build;

static MesoVec3 corner_at(const MesoSphereTree *tree, uint32_t triangle, uint32_t k)
{
    return tree->points[tree->corners[3 * (size_t)triangle + k]];
}

static int by_key(const void *a, const void *b)
{
    const Item *p = a, *q = b;
    if (p->key != q->key)
        return p->key < q->key ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

static float component(MesoVec3 p, int axis)
{
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/* The sphere around the middle of the box: not the smallest, but near to it. */
static MesoBox set_sphere(MesoSphereNode *node, const Build *build, uint32_t begin, uint32_t count)
{
    MesoBox box = meso_box_empty();
    for (uint32_t i = 0; i < 3 * count; i++)
        meso_box_add(&box, corner_at(build->tree, build->tree->order[begin + i / 3], i % 3));
    node->centre = meso_vec3_lerp(box.low, box.high, 0.5f);
    float most = 0;
    for (uint32_t i = 0; i < 3 * count; i++) {
        MesoVec3 d = meso_vec3_sub(corner_at(build->tree, build->tree->order[begin + i / 3], i % 3), node->centre);
        most = fmaxf(most, meso_vec3_dot(d, d));
    }
    node->radius = sqrtf(most) * 1.0001f;   /* what rounding takes in another frame */
    return box;
}

/* Halves along the longest side of the box. */
static void split(const Build *build, uint32_t begin, uint32_t count, const MesoBox *box)
{
    MesoVec3 size = meso_vec3_sub(box->high, box->low);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    uint32_t *order = build->tree->order;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t = order[begin + i];
        float key = 0;
        for (uint32_t k = 0; k < 3; k++)
            key += component(corner_at(build->tree, t, k), axis);
        build->items[i] = (Item){key, t};
    }
    qsort(build->items, count, sizeof *build->items, by_key);
    for (uint32_t i = 0; i < count; i++)
        order[begin + i] = build->items[i].triangle;
}

/* Depth is the logarithm of the count. */
static void build_node(const Build *build, uint32_t begin, uint32_t count)
{
    uint32_t n = build->tree->node_count++;
    MesoSphereNode *node = &build->tree->nodes[n];
    MesoBox box = set_sphere(node, build, begin, count);
    if (count <= LEAF) {
        node->begin = begin;
        node->count = count;
        return;
    }
    split(build, begin, count, &box);
    build_node(build, begin, count / 2);
    node->next = build->tree->node_count;
    build_node(build, begin + count / 2, count - count / 2);
}

MesoStatus meso_sphere_tree_build(MesoSphereTree *tree, MesoArena *arena, const MesoVec3 *points,
                                  const uint32_t *corners, uint32_t triangle_count, MesoError *error)
{
    *tree = (MesoSphereTree){.points = points, .corners = corners};
    tree->nodes = MESO_NEW(arena, MesoSphereNode, 2 * (size_t)triangle_count + 1, error);
    tree->order = MESO_NEW(arena, uint32_t, triangle_count, error);
    MesoArenaMark mark = meso_arena_mark(arena);
    Build build = {tree, MESO_NEW(arena, Item, triangle_count, error)};
    if (!tree->nodes || !tree->order || !build.items)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < triangle_count; t++)
        tree->order[t] = t;
    if (triangle_count)
        build_node(&build, 0, triangle_count);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

/* ---- two of them ---- */

/* From the frame of one body to that of the other. */
static MesoPose between(const MesoPose *a, const MesoPose *b)
{
    const MesoVec3 axes[3] = {b->x, b->y, b->z};
    MesoVec3 to[3], d = meso_vec3_sub(b->origin, a->origin);
    for (int k = 0; k < 3; k++)
        to[k] = (MesoVec3){meso_vec3_dot(axes[k], a->x), meso_vec3_dot(axes[k], a->y), meso_vec3_dot(axes[k], a->z)};
    return (MesoPose){to[0], to[1], to[2], {meso_vec3_dot(d, a->x), meso_vec3_dot(d, a->y), meso_vec3_dot(d, a->z)}};
}

static MesoVec3 moved(const MesoPose *pose, MesoVec3 p)
{
    MesoVec3 q = meso_vec3_mad(pose->origin, p.x, pose->x);
    return meso_vec3_mad(meso_vec3_mad(q, p.y, pose->y), p.z, pose->z);
}

/* Whether a triangle is all on one side of another one's plane, of normal `up`. */
static bool is_beside(const MesoVec3 p[3], MesoVec3 on, MesoVec3 up)
{
    float a = meso_vec3_dot(meso_vec3_sub(p[0], on), up), b = meso_vec3_dot(meso_vec3_sub(p[1], on), up);
    float c = meso_vec3_dot(meso_vec3_sub(p[2], on), up);
    return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

static MesoVec3 normal_of(const MesoVec3 p[3])
{
    return meso_vec3_unit(meso_vec3_cross(meso_vec3_sub(p[1], p[0]), meso_vec3_sub(p[2], p[0])), (MesoVec3){0, 0, 0});
}

/* Adds to `push` as well. */
static uint32_t leaf_crossings(MesoVec3 *push, const MesoSphereTree *a, const MesoSphereNode *m,
                               const MesoSphereTree *b, const MesoSphereNode *n, const MesoPose *pose)
{
    uint32_t count = 0;
    for (uint32_t j = n->begin; j < n->begin + n->count; j++) {
        MesoVec3 q[3];
        for (uint32_t k = 0; k < 3; k++)
            q[k] = moved(pose, corner_at(b, b->order[j], k));
        const MesoVec3 up = meso_vec3_cross(meso_vec3_sub(q[1], q[0]), meso_vec3_sub(q[2], q[0]));
        for (uint32_t i = m->begin; i < m->begin + m->count; i++) {
            const MesoVec3 p[3] = {corner_at(a, a->order[i], 0), corner_at(a, a->order[i], 1),
                                   corner_at(a, a->order[i], 2)};
            if (is_beside(p, q[0], up) || !meso_triangles_cross(p, q))
                continue;
            count++;
            *push = meso_vec3_add(*push, meso_vec3_sub(normal_of(q), normal_of(p)));
        }
    }
    return count;
}

typedef struct Pair {
    uint32_t m, n;
} Pair;

uint32_t meso_sphere_trees_push(MesoVec3 *push, const MesoSphereTree *a, const MesoPose *at_a, const MesoSphereTree *b,
                                const MesoPose *at_b, uint32_t most)
{
    MesoVec3 sum = {0, 0, 0};
    MesoPose pose = between(at_a, at_b);
    Pair stack[2 * DEPTH];
    uint32_t size = 0, count = 0;
    if (a->node_count && b->node_count)
        stack[size++] = (Pair){0, 0};
    while (size && count < most) {
        Pair pair = stack[--size];
        const MesoSphereNode *m = &a->nodes[pair.m], *n = &b->nodes[pair.n];
        MesoVec3 d = meso_vec3_sub(moved(&pose, n->centre), m->centre);
        float reach = m->radius + n->radius;
        if (meso_vec3_dot(d, d) > reach * reach)
            continue;
        if (m->count && n->count) {
            count += leaf_crossings(&sum, a, m, b, n, &pose);
        } else if (n->count || (!m->count && m->radius > n->radius)) {
            stack[size++] = (Pair){m->next, pair.n};
            stack[size++] = (Pair){pair.m + 1, pair.n};
        } else {
            stack[size++] = (Pair){pair.m, n->next};
            stack[size++] = (Pair){pair.m, pair.n + 1};
        }
    }
    *push = meso_vec3_mad(meso_vec3_mad(meso_vec3_scale(at_a->x, sum.x), sum.y, at_a->y), sum.z, at_a->z);
    return count < most ? count : most;
}

uint32_t meso_sphere_trees_crossings(const MesoSphereTree *a, const MesoPose *at_a, const MesoSphereTree *b,
                                     const MesoPose *at_b, uint32_t most)
{
    MesoVec3 push;
    return meso_sphere_trees_push(&push, a, at_a, b, at_b, most);
}
