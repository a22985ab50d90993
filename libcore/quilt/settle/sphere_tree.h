/*
 * A tree of spheres around the triangles of a rigid body: however it is turned, the spheres are the same, so that one tree
 * a kind of body tells of any two bodies where their triangles cross.
 */
#ifndef MESO_SPHERE_TREE_H
#define MESO_SPHERE_TREE_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef struct MesoSphereNode {
    MesoVec3 centre;
    float radius;
    uint32_t begin, count;      /* of a leaf: its triangles, in `order` */
    uint32_t next;              /* of others, count 0: its second child; the first one follows it */
} MesoSphereNode;

typedef struct MesoSphereTree {
    const MesoVec3 *points;
    const uint32_t *corners;    /* [3 * triangle_count] */
    MesoSphereNode *nodes;      /* none where there is no triangle */
    uint32_t *order;
    uint32_t node_count;
} MesoSphereTree;

/* Axes of a body, in space, and its origin. */
typedef struct MesoPose {
    MesoVec3 x, y, z, origin;
} MesoPose;

/* `points` and `corners` are kept. O(n log^2 n). MESO_ERR_MEMORY. */
MesoStatus meso_sphere_tree_build(MesoSphereTree *tree, MesoArena *arena, const MesoVec3 *points,
                                  const uint32_t *corners, uint32_t triangle_count, MesoError *error);

/* Pairs of triangles of two bodies that cross, up to `most`. */
uint32_t meso_sphere_trees_crossings(const MesoSphereTree *a, const MesoPose *at_a, const MesoSphereTree *b,
                                     const MesoPose *at_b, uint32_t most);

/* The same; `push` becomes the sum of ways in space for `a` to get off, of about length 1 for each of them. */
uint32_t meso_sphere_trees_push(MesoVec3 *push, const MesoSphereTree *a, const MesoPose *at_a, const MesoSphereTree *b,
                                const MesoPose *at_b, uint32_t most);

#endif
