#include "libcore/check/inspect_tree.h"

#include <string.h>

/* Cells of the curve along each axis: 2^16. */
enum { CURVE_BITS = 16, DIGIT_BITS = 8, DIGITS = 1 << DIGIT_BITS, DEEPEST = 64 };

typedef struct CurveKey {
    uint64_t code;
    uint32_t item;
} CurveKey;

/* ---- the curve ---- */

/* Bits of a number below 2^16, two zeros between them. */
static uint64_t spread(uint64_t x)
{
    x = (x | x << 16) & UINT64_C(0x0000ff0000ff);
    x = (x | x << 8) & UINT64_C(0x00f00f00f00f);
    x = (x | x << 4) & UINT64_C(0x0c30c30c30c3);
    return (x | x << 2) & UINT64_C(0x249249249249);
}

static uint64_t cell_of(double low, double high, double x)
{
    double at = high > low ? (x - low) / (high - low) * (1 << CURVE_BITS) : 0;
    return at < 0 ? 0 : at >= (1 << CURVE_BITS) ? (1 << CURVE_BITS) - 1 : (uint64_t)at;
}

static MesoVec3d middle_of(const MesoBox *box)
{
    return meso_vec3d_scale(meso_vec3d_add(meso_vec3d(box->low), meso_vec3d(box->high)), 0.5);
}

static uint64_t code_of(const MesoBox *all, const MesoBox *box)
{
    MesoVec3d p = middle_of(box);
    return spread(cell_of((double)all->low.x, (double)all->high.x, p.x)) |
           spread(cell_of((double)all->low.y, (double)all->high.y, p.y)) << 1 |
           spread(cell_of((double)all->low.z, (double)all->high.z, p.z)) << 2;
}

/* By digits from the lowest on; items of one code keep their order. */
static void sort_keys(CurveKey *keys, CurveKey *other, uint32_t count)
{
    for (int shift = 0; shift < 3 * CURVE_BITS; shift += DIGIT_BITS) {
        uint32_t begin[DIGITS + 1] = {0};
        for (uint32_t i = 0; i < count; i++)
            begin[(keys[i].code >> shift & (DIGITS - 1)) + 1]++;
        for (int d = 0; d < DIGITS; d++)
            begin[d + 1] += begin[d];
        for (uint32_t i = 0; i < count; i++)
            other[begin[keys[i].code >> shift & (DIGITS - 1)]++] = keys[i];
        CurveKey *sorted = other;
        other = keys;
        keys = sorted;
    }
}

/* ---- building ---- */

static bool is_finite_box(const MesoBox *box)
{
    return meso_vec3_finite(box->low) && meso_vec3_finite(box->high) && box->low.x <= box->high.x;
}

static void merge(MesoBox *box, const MesoBox *more)
{
    meso_box_add(box, more->low);
    meso_box_add(box, more->high);
}

static void fill_leaves(MesoInspectTree *tree, const MesoBox *boxes, const uint32_t *owners)
{
    for (uint32_t node = 0; node < 2 * tree->leaf_room; node++)
        tree->boxes[node] = meso_box_empty();
    for (uint32_t i = 0; i < tree->item_count; i++) {
        uint32_t node = tree->leaf_room + i / MESO_INSPECT_LEAF, item = tree->order[i];
        merge(&tree->boxes[node], &boxes[item]);
        if (owners && i % MESO_INSPECT_LEAF == 0)
            tree->owners[node] = owners[item];
        else if (owners && tree->owners[node] != owners[item])
            tree->owners[node] = MESO_NO_INDEX;
    }
}

static bool is_empty(const MesoBox *box)
{
    return !(box->low.x <= box->high.x);
}

static void fill_above(MesoInspectTree *tree)
{
    for (uint32_t node = tree->leaf_room; node-- > 1;) {
        const MesoBox *left = &tree->boxes[2 * node], *right = left + 1;
        if (!is_empty(left))
            merge(&tree->boxes[node], left);
        if (!is_empty(right))
            merge(&tree->boxes[node], right);
        if (tree->owners)
            tree->owners[node] = is_empty(right) || tree->owners[2 * node] == tree->owners[2 * node + 1]
                               ? tree->owners[2 * node] : MESO_NO_INDEX;
    }
}

static MesoStatus allocate(MesoInspectTree *tree, MesoArena *arena, bool owned, uint32_t count, MesoError *error)
{
    uint32_t leaves = count / MESO_INSPECT_LEAF + 1, room = 1;
    while (room < leaves)
        room *= 2;
    *tree = (MesoInspectTree){.leaf_room = room};
    tree->order = MESO_NEW(arena, uint32_t, count, error);
    tree->boxes = MESO_NEW(arena, MesoBox, 2 * (size_t)room, error);
    tree->owners = owned ? MESO_NEW(arena, uint32_t, 2 * (size_t)room, error) : NULL;
    return tree->order && tree->boxes && (!owned || tree->owners) ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_inspect_tree_build(MesoInspectTree *tree, MesoArena *arena, const MesoBox *boxes,
                                   const uint32_t *owners, uint32_t count, MesoError *error)
{
    MesoBox all = meso_box_empty();
    MesoStatus status = allocate(tree, arena, owners != NULL, count, error);
    if (status)
        return status;
    MesoArenaMark mark = meso_arena_mark(arena);
    CurveKey *keys = MESO_NEW(arena, CurveKey, count, error);
    CurveKey *other = keys ? MESO_NEW(arena, CurveKey, count, error) : NULL;
    if (!other)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        if (is_finite_box(&boxes[i]))
            merge(&all, &boxes[i]);
    for (uint32_t i = 0; i < count; i++)
        if (is_finite_box(&boxes[i]))
            keys[tree->item_count++] = (CurveKey){code_of(&all, &boxes[i]), i};
    sort_keys(keys, other, tree->item_count);       /* an even number of passes: it ends where it began */
    for (uint32_t i = 0; i < tree->item_count; i++)
        tree->order[i] = keys[i].item;
    meso_arena_rewind(arena, mark);
    tree->leaf_count = (tree->item_count + MESO_INSPECT_LEAF - 1) / MESO_INSPECT_LEAF;
    fill_leaves(tree, boxes, owners);
    fill_above(tree);
    return MESO_OK;
}

/* ---- asking ---- */

static inline bool is_of_others(const MesoInspectTree *tree, uint32_t node, uint32_t only)
{
    return only != MESO_NO_INDEX && tree->owners[node] != only && tree->owners[node] != MESO_NO_INDEX;
}

static inline bool is_of(const MesoInspectTree *tree, uint32_t node, uint32_t owner)
{
    return owner != MESO_NO_INDEX && tree->owners[node] == owner;
}

/* The last leaf below a node. */
static uint32_t last_leaf(const MesoInspectTree *tree, uint32_t node)
{
    while (node < tree->leaf_room)
        node = 2 * node + 1;
    return node - tree->leaf_room;
}

void meso_inspect_tree_meet(const MesoInspectTree *tree, MesoBox box, uint32_t but, uint32_t first,
                            void (*visit)(void *context, uint32_t leaf), void *context)
{
    uint32_t stack[DEEPEST], depth = 0;
    stack[depth++] = 1;
    while (depth > 0) {
        uint32_t node = stack[--depth];
        if (!meso_boxes_meet(&tree->boxes[node], &box) || last_leaf(tree, node) < first)
            continue;
        if (is_of(tree, node, but))
            continue;
        if (node >= tree->leaf_room) {
            visit(context, node - tree->leaf_room);
            continue;
        }
        stack[depth++] = 2 * node + 1;
        stack[depth++] = 2 * node;
    }
}

static inline double outside(double low, double high, double x)
{
    return x < low ? low - x : x > high ? x - high : 0;
}

static inline double square_to_box(const MesoBox *box, MesoVec3d p)
{
    double x = outside((double)box->low.x, (double)box->high.x, p.x);
    double y = outside((double)box->low.y, (double)box->high.y, p.y);
    double z = outside((double)box->low.z, (double)box->high.z, p.z);
    return x * x + y * y + z * z;
}

/* Asks the items of a leaf; the nearest so far is replaced by a nearer one. */
static void try_leaf(const MesoInspectTree *tree, uint32_t leaf, double *best, uint32_t *nearest,
                     double (*measure)(void *context, uint32_t item), void *context)
{
    for (uint32_t i = MESO_INSPECT_LEAF * leaf; i < meso_inspect_leaf_end(tree, leaf); i++) {
        double found = measure(context, tree->order[i]);
        if (found < *best) {
            *best = found;
            *nearest = tree->order[i];
        }
    }
}

uint32_t meso_inspect_tree_nearest(const MesoInspectTree *tree, const MesoInspectAsking *asking, double *square,
                                   double (*distance)(void *context, uint32_t item), void *context)
{
    struct { uint32_t node; double square; } stack[DEEPEST];
    uint32_t depth = 0, nearest = MESO_NO_INDEX, asked = 0;
    stack[depth].node = 1;
    stack[depth++].square = square_to_box(&tree->boxes[1], asking->point);
    while (depth > 0) {
        uint32_t node = stack[--depth].node;
        if (stack[depth].square > *square || stack[depth].square == INFINITY ||
            is_of_others(tree, node, asking->only) || is_of(tree, node, asking->but))
            continue;
        if (node >= tree->leaf_room) {
            try_leaf(tree, node - tree->leaf_room, square, &nearest, distance, context);
            if (++asked == asking->most)
                break;
            continue;
        }
        double left = square_to_box(&tree->boxes[2 * node], asking->point);
        double right = square_to_box(&tree->boxes[2 * node + 1], asking->point);
        uint32_t near = right < left ? 1 : 0;
        stack[depth].node = 2 * node + 1 - near;
        stack[depth++].square = near ? left : right;
        stack[depth].node = 2 * node + near;
        stack[depth++].square = near ? right : left;
    }
    return nearest;
}

/* A ray as boxes are asked about it: an axis that it does not move along has an infinite inverse. */
typedef struct Slabs {
    MesoVec3d origin, inverse;
} Slabs;

/* Narrows [*from, *to] to where the ray is between two planes. Plain comparisons: fmin() is a call. On a plane that it
 * runs along, 0 times infinity is no number, which narrows nothing. */
static inline void narrow(double low, double high, double origin, double inverse, double *from, double *to)
{
    double a = (low - origin) * inverse, b = (high - origin) * inverse;
    double first = a < b ? a : b, last = a < b ? b : a;
    *from = first > *from ? first : *from;
    *to = last < *to ? last : *to;
}

/* How far along the ray the box begins; INFINITY: not before `way`. */
static inline double way_to_box(const MesoBox *box, const Slabs *ray, double way)
{
    double from = 0, to = way;
    narrow((double)box->low.x, (double)box->high.x, ray->origin.x, ray->inverse.x, &from, &to);
    narrow((double)box->low.y, (double)box->high.y, ray->origin.y, ray->inverse.y, &from, &to);
    narrow((double)box->low.z, (double)box->high.z, ray->origin.z, ray->inverse.z, &from, &to);
    return from <= to ? from : INFINITY;
}

uint32_t meso_inspect_tree_ray(const MesoInspectTree *tree, MesoVec3d origin, MesoVec3d direction, uint32_t only,
                               double *way, double (*hit)(void *context, uint32_t item), void *context)
{
    struct { uint32_t node; double way; } stack[DEEPEST];
    const Slabs ray = {origin, {1 / direction.x, 1 / direction.y, 1 / direction.z}};
    uint32_t depth = 0, nearest = MESO_NO_INDEX;
    stack[depth].node = 1;
    stack[depth++].way = way_to_box(&tree->boxes[1], &ray, *way);
    while (depth > 0) {
        uint32_t node = stack[--depth].node;
        if (stack[depth].way > *way || stack[depth].way == INFINITY || is_of_others(tree, node, only))
            continue;
        if (node >= tree->leaf_room) {
            try_leaf(tree, node - tree->leaf_room, way, &nearest, hit, context);
            continue;
        }
        double left = way_to_box(&tree->boxes[2 * node], &ray, *way);
        double right = way_to_box(&tree->boxes[2 * node + 1], &ray, *way);
        uint32_t near = right < left ? 1 : 0;
        double farther = near ? left : right, closer = near ? right : left;
        stack[depth].node = 2 * node + 1 - near;
        stack[depth].way = farther;
        depth += farther < INFINITY;
        stack[depth].node = 2 * node + near;
        stack[depth].way = closer;
        depth += closer < INFINITY;
    }
    return nearest;
}
