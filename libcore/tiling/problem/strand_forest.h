/*
 * Joints and links (strands.h) as a forest of disjoint sets, with the sums that
 * tell rings from cycles, and undo: union by size, without path compression.
 */
#ifndef MESO_STRAND_FOREST_H
#define MESO_STRAND_FOREST_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

/* Sums are of the whole set, and stand at its root. */
typedef struct MesoStrandNode {
    uint32_t parent;            /* itself at a root */
    uint32_t joints, links;
    uint32_t forks;             /* joints with over two link ends */
    uint32_t open;              /* joints to which a slot to come may add links */
    uint32_t degree;            /* link ends at this joint alone */
} MesoStrandNode;

/* A link, with what is needed to take it back. */
typedef struct MesoStrandStep {
    uint32_t a, b;              /* joints */
    uint32_t child;             /* root that was hung below another, or MESO_NO_INDEX */
} MesoStrandStep;

typedef struct MesoStrandForest {
    uint32_t count;
    MesoStrandNode *nodes;      /* [count] */
} MesoStrandForest;

MesoStatus meso_strand_forest_init(MesoStrandForest *forest, MesoArena *arena, uint32_t count,
                                   MesoError *error);

/* O(log(count)). */
static inline uint32_t meso_strand_root(const MesoStrandForest *forest, uint32_t joint)
{
    while (forest->nodes[joint].parent != joint)
        joint = forest->nodes[joint].parent;
    return joint;
}

/* Adds a link, and takes one back: the last that was added. O(log(count)). */
MesoStrandStep meso_strand_link(MesoStrandForest *forest, uint32_t a, uint32_t b);
void meso_strand_unlink(MesoStrandForest *forest, MesoStrandStep step);

/* A set is a strand where it has links; a ring where each of its joints has two link ends. */
static inline bool meso_strand_cyclic(const MesoStrandNode *root)
{
    return root->links >= root->joints;
}

static inline bool meso_strand_ring(const MesoStrandNode *root)
{
    return root->links == root->joints && root->forks == 0;
}

#endif
