/*
 * Trees of boxes over anything that has some: items sorted along a curve that fills space (Morton 1966), a complete
 * binary tree above leaves of eight (compare Lauterbach et al., "Fast BVH Construction on GPUs", 2009).
 */
#ifndef MESO_INSPECT_TREE_H
#define MESO_INSPECT_TREE_H

#include "libcore/base/arena.h"
#include "libcore/math/box.h"
#include "libcore/math/vec3d.h"

enum { MESO_INSPECT_LEAF = 8 };

typedef struct MesoInspectTree {
    uint32_t item_count, leaf_count;
    uint32_t leaf_room;     /* a power of 2; node 1 is the root, 2 n and 2 n + 1 are below n, leaf l is leaf_room + l */
    uint32_t *order;        /* [item_count] items; leaf l has those from 8 l */
    MesoBox *boxes;         /* [2 * leaf_room] by node, empty where there is nothing */
    uint32_t *owners;       /* [2 * leaf_room] of all that is below, or MESO_NO_INDEX; NULL: there are none */
} MesoInspectTree;

/*
 * boxes   [count]; what is not finite is in no tree
 * owners  [count] below MESO_NO_INDEX, or NULL
 *
 * The tree lies in `arena`, which is its scratch too. O(count).
 */
MesoStatus meso_inspect_tree_build(MesoInspectTree *tree, MesoArena *arena, const MesoBox *boxes,
                                   const uint32_t *owners, uint32_t count, MesoError *error);

/* Leaves whose boxes meet `box`, and whose items are not all of `but` (MESO_NO_INDEX: any), ascending from
 * `first`. */
void meso_inspect_tree_meet(const MesoInspectTree *tree, MesoBox box, uint32_t but, uint32_t first,
                            void (*visit)(void *context, uint32_t leaf), void *context);

/* What is asked for what is nearest to it. */
typedef struct MesoInspectAsking {
    MesoVec3d point;
    uint32_t only, but;     /* nodes all of one owner: those of others than `only`, and those of `but`, are not asked;
                             * MESO_NO_INDEX: any are */
    uint32_t most;          /* leaves that are asked, near ones sooner; 0: as many as there are */
} MesoInspectAsking;

/* The item for which `distance` gives the least square, below `*square`, which becomes it; MESO_NO_INDEX: none. All
 * items in leaves that are no further away than that are asked, up to the most. */
uint32_t meso_inspect_tree_nearest(const MesoInspectTree *tree, const MesoInspectAsking *asking, double *square,
                                   double (*distance)(void *context, uint32_t item), void *context);

/* What is below a node that has another owner than `only` is not asked (MESO_NO_INDEX: all of it is). The item that `hit` gives the least way to, of those whose boxes a ray meets before `*way`, which becomes it. */
uint32_t meso_inspect_tree_ray(const MesoInspectTree *tree, MesoVec3d origin, MesoVec3d direction, uint32_t only,
                               double *way, double (*hit)(void *context, uint32_t item), void *context);

static inline uint32_t meso_inspect_leaf_end(const MesoInspectTree *tree, uint32_t leaf)
{
    uint32_t end = MESO_INSPECT_LEAF * (leaf + 1);
    return end < tree->item_count ? end : tree->item_count;
}

static inline bool meso_boxes_meet(const MesoBox *a, const MesoBox *b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y &&
           a->low.z <= b->high.z && b->low.z <= a->high.z;
}

#endif
