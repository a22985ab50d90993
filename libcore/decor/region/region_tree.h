/*
 * The tree of regions: the root is the surface, the children of a region are a
 * partition of it, the leaves are what triangles are labelled with. Regions are numbered as they
 * are made, children of one region in a row, so that a parent is always below its children.
 */
#ifndef MESO_REGION_TREE_H
#define MESO_REGION_TREE_H

#include "libcore/base/arena.h"
#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoRegion {
    uint32_t parent;                /* MESO_NO_INDEX of the root */
    uint32_t child_begin, child_count;
    uint32_t number;                /* among its brothers */
    uint32_t step;                  /* that made it, by the count of operations; 0 of the root */
    uint32_t depth;                 /* 0 of the root */
    const char *tag;                /* "dot", "band": what made it; "surface" of the root */
    const char *name;               /* the tag's, where nothing else is said */
    uint32_t material[2];           /* of the pattern, the first MESO_NO_INDEX: its parent's */
    float mix;                      /* share of the second one */
    uint32_t rule;                  /* of a growth that was applied to it, from 1; 0: none */
    bool rested;                    /* a growth leaves it as it is */
    float level;                    /* mean of the field that made it, from 0 to 1 over its brothers */
    uint32_t triangle_count;        /* when it was made */
    double area;                    /* when it was made */
} MesoRegion;

typedef struct MesoRegionTree {
    uint32_t region_count, region_room;
    MesoRegion *regions;            /* [region_count] */
    MesoArena *arena;
} MesoRegionTree;

/* The root alone, of `area`. */
MesoStatus meso_region_tree_init(MesoRegionTree *tree, MesoArena *arena, const MesoTriangulation *mesh,
                                 MesoError *error);

/* Gives a leaf `count` children like `like`, but for what is their own; the first one's number goes to `first`. */
MesoStatus meso_region_tree_split(MesoRegionTree *tree, uint32_t leaf, uint32_t count, const MesoRegion *like,
                                  uint32_t *first, MesoError *error);

static inline bool meso_region_is_leaf(const MesoRegionTree *tree, uint32_t region)
{
    return tree->regions[region].child_count == 0;
}

/* True for the region itself as well. O(depth). */
bool meso_region_is_within(const MesoRegionTree *tree, uint32_t region, uint32_t ancestor);

/* The nearest region upwards that has a material, itself included; MESO_NO_INDEX where none has. O(depth). */
uint32_t meso_region_painted(const MesoRegionTree *tree, uint32_t region);

/* "band.0/cell.3": names and numbers from below the root; "surface" for the root. NULL when memory is out. */
const char *meso_region_path(const MesoRegionTree *tree, MesoArena *arena, uint32_t region, MesoError *error);

/*
 * Whether the way from `scope` down to `region` fits a path: names joined by '/', each may end in ".NUMBER"; '*' is any
 * one region, '**' any number, "." or "" the scope itself. O(depth * length of the path).
 */
bool meso_region_fits_path(const MesoRegionTree *tree, uint32_t scope, uint32_t region, const char *path);

/* ---- triangles of regions ---- */

/* Triangles by leaf. */
typedef struct MesoRegionLists {
    uint32_t *begin;        /* [region_count + 1]; nothing between of inner regions */
    uint32_t *triangles;    /* [triangle_count] ascending for each leaf */
} MesoRegionLists;

/* Counts and sorts all triangles. O(triangles + regions). */
MesoStatus meso_region_lists_build(MesoRegionLists *lists, MesoArena *arena, const MesoRegionTree *tree,
                                   const MesoTriangulation *mesh, MesoError *error);

/*
 * The domain of a region, leaf or inner: `member` is [region_count] zeroes that the function sets for its leaves; the
 * caller clears them again with meso_region_domain_end(). O(triangles of the region).
 */
MesoStatus meso_region_domain(MesoDomain *domain, uint8_t *member, MesoArena *arena, const MesoRegionTree *tree,
                              const MesoRegionLists *lists, const MesoTriangulation *mesh, uint32_t region,
                              MesoError *error);
void meso_region_domain_end(const MesoRegionTree *tree, uint32_t region, uint8_t *member);

/* Calls `visit` for each leaf of a region in the order of their numbers along the tree. */
void meso_region_each_leaf(const MesoRegionTree *tree, uint32_t region,
                           void (*visit)(void *context, uint32_t leaf), void *context);

#endif
