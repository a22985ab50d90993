/* Shapes of regions: what selections and rules ask, and what is told of a finished pattern. */
#ifndef MESO_REGION_SHAPE_H
#define MESO_REGION_SHAPE_H

#include "libcore/decor/region/region_tree.h"

typedef struct MesoRegionShape {
    uint32_t borders;       /* loops */
    uint32_t corners;       /* places on them where three or more regions meet */
    double area, perimeter;
    double aspect;          /* sides of the rectangle with this area and perimeter, the longer by the shorter: 1 where
                               it is rounder than a square */
} MesoRegionShape;

/* Of a domain. O(its triangles). MESO_ERR_MEMORY alone. */
MesoStatus meso_region_shape(MesoRegionShape *shape, MesoArena *scratch, const MesoTriangulation *mesh,
                             const MesoDomain *domain, MesoError *error);

/* All regions of a pattern, as they are in the end. */
typedef struct MesoRegionFacts {
    MesoRegionShape *shapes;    /* [region_count] */
    uint32_t *neighbour_begin;  /* [region_count + 1]; leaves have neighbours, leaves across their borders */
    uint32_t *neighbours;       /* ascending for each */
} MesoRegionFacts;

/* O(triangles * depth of the tree). MESO_ERR_MEMORY alone. */
MesoStatus meso_region_facts(MesoRegionFacts *facts, MesoArena *arena, const MesoRegionTree *tree,
                             const MesoTriangulation *mesh, MesoError *error);

#endif
