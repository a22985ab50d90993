/* Tree of boxes: which of many boxes meet a given one. */
#ifndef MESO_BOX_TREE_H
#define MESO_BOX_TREE_H

#include "libcore/base/arena.h"
#include "libcore/math/box.h"

/* Boxes of a leaf. */
enum { MESO_BOX_TREE_LEAF = 4 };

typedef struct MesoBoxTree {
    uint32_t count, leaf_count;
    uint32_t *order;        /* [count] boxes along a curve that fills space */
    MesoBox *boxes;   /* [count] in that order */
    MesoBox *nodes;   /* [2 * leaf_count] of a binary heap: node 1 is all, 2n and 2n + 1 are the halves of n */
} MesoBoxTree;

/* Boxes must be finite. O(n log n); to `arena`. */
MesoStatus meso_box_tree_build(MesoBoxTree *tree, MesoArena *arena, const MesoBox *boxes, uint32_t count,
                               MesoError *error);

/* Calls `found` for each box that meets or touches `box`, in an order that follows from the boxes alone. */
void meso_box_tree_query(const MesoBoxTree *tree, MesoBox box, void (*found)(void *context, uint32_t number),
                         void *context);

/*
 * Calls `found` with the places in `order` of each two boxes that meet or touch, of which the first lies from `begin`
 * to `end`, whole numbers of leaves or the number of boxes, and the other one behind it: over all places, once for each
 * pair.
 */
void meso_box_tree_query_pairs(const MesoBoxTree *tree, uint32_t begin, uint32_t end,
                               void (*found)(void *context, uint32_t place, uint32_t other), void *context);

#endif
