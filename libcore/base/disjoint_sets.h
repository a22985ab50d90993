/*
 * Disjoint sets: `parent` [count] is a forest, each root the smallest element of its set (Tarjan, "Efficiency of
 * a good but not linear set union algorithm", 1975; paths are halved as in Tarjan and van Leeuwen, 1984).
 */
#ifndef MESO_DISJOINT_SETS_H
#define MESO_DISJOINT_SETS_H

#include <stdint.h>

/* Each element alone. */
static inline void meso_sets_init(uint32_t *parent, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        parent[i] = i;
}

/* Smallest element of the set of `i`. */
static inline uint32_t meso_sets_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

/* Joins two sets; false where they were one. */
static inline _Bool meso_sets_join(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = meso_sets_root(parent, a);
    b = meso_sets_root(parent, b);
    parent[a > b ? a : b] = a > b ? b : a;
    return a != b;
}

#endif
