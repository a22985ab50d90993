/*
 * Contours: the outlines of cross-sections, from their CSG trees by Clipper
 * (MesoGen, section 3.6), sampled, and resampled to rings for sweeps.
 */
#ifndef MESO_CONTOUR_H
#define MESO_CONTOUR_H

#include "libcore/tiling/tile/tile_set.h"

/* One closed loop of a cross-section: counter-clockwise around material, clockwise around a hole. */
typedef struct MesoContour {
    uint32_t point_begin, point_count;
    bool hole;
} MesoContour;

/*
 * All contours of a tile set. Points are relative to the cross-section's
 * centre, x along the side and y up, in edge lengths. The centre is a point of
 * the interface's unit square.
 */
typedef struct MesoContourSet {
    uint32_t contour_count, point_count;
    uint32_t *section_begin;    /* [section_count + 1] into contours */
    MesoVec2 *center;           /* [section_count] */
    MesoContour *contours;      /* by area, largest first, within a section */
    MesoVec2 *points;
} MesoContourSet;

/*
 * Samples every cross-section of a checked set.
 *
 * step    sampling step in edge lengths, in [1e-4, 1]: discs get
 *         floor(circumference / step) points, straight edges are cut into
 *         pieces of at most 2 * step
 *
 * A cross-section whose drawing has no area gets no contours. O(points log points).
 * MESO_ERR_LIMIT if a drawing needs more than 2^20 points or 1024 contours.
 */
MesoStatus meso_contour_set_build(MesoContourSet *contours, MesoArena *arena,
                                  const MesoTileSet *set, float step, MesoError *error);

#endif
