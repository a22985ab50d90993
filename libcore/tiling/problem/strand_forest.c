#include "libcore/tiling/problem/strand_forest.h"

MesoStatus meso_strand_forest_init(MesoStrandForest *forest, MesoArena *arena, uint32_t count,
                                   MesoError *error)
{
    *forest = (MesoStrandForest){.count = count};
    forest->nodes = MESO_NEW(arena, MesoStrandNode, count, error);
    if (!forest->nodes)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        forest->nodes[i] = (MesoStrandNode){.parent = i, .joints = 1};
    return MESO_OK;
}

static void add_end(MesoStrandForest *forest, uint32_t joint, MesoStrandNode *root)
{
    if (++forest->nodes[joint].degree == 3)
        root->forks++;
}

static void remove_end(MesoStrandForest *forest, uint32_t joint, MesoStrandNode *root)
{
    if (forest->nodes[joint].degree-- == 3)
        root->forks--;
}

MesoStrandStep meso_strand_link(MesoStrandForest *forest, uint32_t a, uint32_t b)
{
    MesoStrandStep step = {a, b, MESO_NO_INDEX};
    uint32_t root = meso_strand_root(forest, a), other = meso_strand_root(forest, b);
    if (root != other) {
        if (forest->nodes[root].joints < forest->nodes[other].joints) {
            uint32_t swap = root;
            root = other;
            other = swap;
        }
        MesoStrandNode *kept = &forest->nodes[root], *hung = &forest->nodes[other];
        hung->parent = root;
        kept->joints += hung->joints;
        kept->links += hung->links;
        kept->forks += hung->forks;
        kept->open += hung->open;
        step.child = other;
    }
    add_end(forest, a, &forest->nodes[root]);
    add_end(forest, b, &forest->nodes[root]);
    forest->nodes[root].links++;
    return step;
}

void meso_strand_unlink(MesoStrandForest *forest, MesoStrandStep step)
{
    uint32_t root = meso_strand_root(forest, step.a);
    forest->nodes[root].links--;
    remove_end(forest, step.b, &forest->nodes[root]);
    remove_end(forest, step.a, &forest->nodes[root]);
    if (step.child == MESO_NO_INDEX)
        return;
    MesoStrandNode *kept = &forest->nodes[root], *hung = &forest->nodes[step.child];
    hung->parent = step.child;
    kept->joints -= hung->joints;
    kept->links -= hung->links;
    kept->forks -= hung->forks;
    kept->open -= hung->open;
}
