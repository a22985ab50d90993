/* Points of shapes as a raster draws them. */
#ifndef MESO_SHAPE_POINTS_H
#define MESO_SHAPE_POINTS_H

#include "libcore/render/raster/shapes.h"

/*
 * Points of a mesh as they are drawn quickest: of a sweep ring by ring, of each the places of its columns; of a run its
 * vertices. How many, and all of them by their coordinates, each [count]; `joined` [count] gets 1 where a side of a
 * sweep leads to the next point, and another ring is behind it, and 0 elsewhere.
 */
uint64_t meso_shape_point_count(const MesoShapeMesh *mesh);
void meso_shape_points(const MesoShapeMesh *mesh, float *x, float *y, float *z, uint8_t *joined);

#endif
