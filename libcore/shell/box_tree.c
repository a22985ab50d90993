#include "libcore/shell/box_tree.h"

enum { LEAF = MESO_BOX_TREE_LEAF };     /* looking at four boxes costs less than two more nodes */

static bool meet(const MesoBox *a, const MesoBox *b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y &&
           a->low.z <= b->high.z && b->low.z <= a->high.z;
}

/* An empty box adds nothing. */
static void add_box(MesoBox *sum, const MesoBox *box)
{
    if (!(box->low.x <= box->high.x))
        return;
    meso_box_add(sum, box->low);
    meso_box_add(sum, box->high);
}

/* Ten bits of each of three numbers, in turns. */
static uint64_t curve_key(MesoVec3 middle, MesoBox all, float size)
{
    const float at[3] = {middle.x - all.low.x, middle.y - all.low.y, middle.z - all.low.z};
    uint64_t key = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t cell = size > 0 ? (uint32_t)fminf(fmaxf(at[k] / size, 0) * 1023, 1023) : 0;
        for (uint32_t bit = 0; bit < 10; bit++)
            key |= (uint64_t)(cell >> bit & 1) << (3 * bit + k);
    }
    return key;
}

/* By the keys above bit 32, digit by digit; numbers below them are in order already. `other` is scratch. */
static void sort_keys(uint64_t *keys, uint64_t *other, uint32_t count)
{
    enum { BITS = 8, DIGITS = 4, VALUES = 1 << BITS };      /* an even number: what is sorted is in `keys` again */
    for (int digit = 0; digit < DIGITS; digit++) {
        uint32_t begin[VALUES + 1] = {0}, shift = (uint32_t)(32 + digit * BITS);
        for (uint32_t i = 0; i < count; i++)
            begin[(keys[i] >> shift & (VALUES - 1)) + 1]++;
        for (uint32_t v = 0; v < VALUES; v++)
            begin[v + 1] += begin[v];
        for (uint32_t i = 0; i < count; i++)
            other[begin[keys[i] >> shift & (VALUES - 1)]++] = keys[i];
        uint64_t *swap = keys;
        keys = other;
        other = swap;
    }
}

static MesoStatus sort_boxes(MesoBoxTree *tree, MesoArena *arena, const MesoBox *boxes, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(arena);
    uint64_t *keys = MESO_NEW(arena, uint64_t, tree->count, error);
    uint64_t *other = MESO_NEW_BARE(arena, uint64_t, tree->count, error);
    if (!keys || !other)
        return MESO_ERR_MEMORY;
    MesoBox all = meso_box_empty();
    for (uint32_t b = 0; b < tree->count; b++)
        add_box(&all, &boxes[b]);
    float size = fmaxf(all.high.x - all.low.x, fmaxf(all.high.y - all.low.y, all.high.z - all.low.z));
    for (uint32_t b = 0; b < tree->count; b++)
        keys[b] = curve_key(meso_vec3_lerp(boxes[b].low, boxes[b].high, 0.5f), all, size) << 32 | b;
    sort_keys(keys, other, tree->count);
    for (uint32_t b = 0; b < tree->count; b++) {
        tree->order[b] = (uint32_t)keys[b];
        tree->boxes[b] = boxes[tree->order[b]];
    }
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

MesoStatus meso_box_tree_build(MesoBoxTree *tree, MesoArena *arena, const MesoBox *boxes, uint32_t count,
                               MesoError *error)
{
    *tree = (MesoBoxTree){.count = count, .leaf_count = 1};
    while ((uint64_t)tree->leaf_count * LEAF < count)
        tree->leaf_count *= 2;
    tree->order = MESO_NEW(arena, uint32_t, count, error);
    tree->boxes = MESO_NEW(arena, MesoBox, count, error);
    tree->nodes = MESO_NEW(arena, MesoBox, 2 * (size_t)tree->leaf_count, error);
    if (!tree->order || !tree->boxes || !tree->nodes)
        return MESO_ERR_MEMORY;
    MesoStatus status = sort_boxes(tree, arena, boxes, error);
    if (status)
        return status;
    for (uint32_t leaf = 0; leaf < tree->leaf_count; leaf++) {
        MesoBox *node = &tree->nodes[tree->leaf_count + leaf];
        *node = meso_box_empty();
        for (uint64_t b = (uint64_t)leaf * LEAF; b < count && b < (uint64_t)(leaf + 1) * LEAF; b++)
            add_box(node, &tree->boxes[b]);
    }
    for (uint32_t n = tree->leaf_count; --n > 0;) {
        tree->nodes[n] = tree->nodes[2 * (size_t)n];
        add_box(&tree->nodes[n], &tree->nodes[2 * (size_t)n + 1]);
    }
    return MESO_OK;
}

void meso_box_tree_query(const MesoBoxTree *tree, MesoBox box, void (*found)(void *context, uint32_t number),
                         void *context)
{
    uint32_t stack[64], depth = 0;      /* a level of the tree adds one */
    stack[depth++] = 1;
    while (depth > 0) {
        uint32_t n = stack[--depth];
        if (!meet(&tree->nodes[n], &box))
            continue;
        if (n < tree->leaf_count) {
            stack[depth++] = 2 * n + 1;
            stack[depth++] = 2 * n;
            continue;
        }
        uint64_t b = (uint64_t)(n - tree->leaf_count) * LEAF, end = b + LEAF;
        for (; b < tree->count && b < end; b++)
            if (meet(&tree->boxes[b], &box))
                found(context, tree->order[b]);
    }
}

/* Pairs of boxes of two leaves, the first one not behind the second. */
static void pair_leaves(const MesoBoxTree *tree, uint32_t first, uint32_t second,
                        void (*found)(void *context, uint32_t place, uint32_t other), void *context)
{
    uint64_t end = (uint64_t)(first + 1) * LEAF, last = (uint64_t)(second + 1) * LEAF;
    for (uint64_t a = (uint64_t)first * LEAF; a < tree->count && a < end; a++) {
        const MesoBox *box = &tree->boxes[a];
        if (!meet(&tree->nodes[tree->leaf_count + second], box))
            continue;
        for (uint64_t b = first == second ? a + 1 : (uint64_t)second * LEAF; b < tree->count && b < last; b++)
            if (meet(&tree->boxes[b], box))
                found(context, (uint32_t)a, (uint32_t)b);
    }
}

void meso_box_tree_query_pairs(const MesoBoxTree *tree, uint32_t begin, uint32_t end,
                               void (*found)(void *context, uint32_t place, uint32_t other), void *context)
{
    struct {
        uint32_t node, leaf, leaves;    /* the first of its leaves, and how many */
    } stack[64], at;
    for (uint32_t leaf = begin / LEAF; (uint64_t)leaf * LEAF < end; leaf++) {
        const MesoBox box = tree->nodes[tree->leaf_count + leaf];
        uint32_t depth = 0;
        at.node = 1, at.leaf = 0, at.leaves = tree->leaf_count;
        stack[depth++] = at;
        while (depth > 0) {
            at = stack[--depth];
            if (at.leaf + at.leaves <= leaf || !meet(&tree->nodes[at.node], &box))
                continue;
            if (at.leaves > 1) {
                uint32_t half = at.leaves / 2;
                stack[depth].node = 2 * at.node + 1, stack[depth].leaf = at.leaf + half, stack[depth++].leaves = half;
                stack[depth].node = 2 * at.node, stack[depth].leaf = at.leaf, stack[depth++].leaves = half;
                continue;
            }
            pair_leaves(tree, leaf, at.leaf, found, context);
        }
    }
}
