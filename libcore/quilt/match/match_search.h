/* The best places of a swatch under points of a surface: equation 3 for all translations by whole voxels, and turns. */
#ifndef MESO_MATCH_SEARCH_H
#define MESO_MATCH_SEARCH_H

#include "libcore/quilt/match/match_field.h"

/* A point p of the plane lies on the swatch at p turned by -2 pi turn / turn_count about the origin, plus `shift`. */
typedef struct MesoMatch {
    MesoVec2 shift;
    uint32_t turn;
    float cost;         /* mean of D - 1 over the points, by their weights; 0 is perfect */
} MesoMatch;

/*
 * Finds places of least cost, best first, no two of one turn within `apart` of each other.
 *
 * matches       [wanted] gets them
 * found         how many there are: fewer than `wanted` where there are no more, 0 where the window fits nowhere
 * points        [point_count] in the window; one outside it counts as if it were inside where the table ends. Their
 *               heights are those of the swatch
 * weights       [point_count] at least 0, or NULL: all 1
 * low, high     the window: a box of the plane that, turned and shifted, has to lie in the tile of the swatch, `margin`
 *               off its sides
 * turn_count    1: no turns
 *
 * Shifts are whole numbers of voxels in x and y, all of them. D is taken from the table at the voxel of the point, and
 * linearly between three normals: costs are too high by what half a voxel and half a bin make, everywhere about alike.
 * Where places of nearly one cost have to be told apart, ask for several and meso_match_refine() them. Without points
 * costs are 0.
 *
 * O(turns * points * shifts), four shifts at a time. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_match_search(MesoMatch *matches, uint32_t *found, uint32_t wanted, float apart,
                             const MesoMatchField *field, MesoArena *scratch, const MesoMatchPoint *points,
                             const float *weights, uint32_t point_count, MesoVec2 low, MesoVec2 high, float margin,
                             uint32_t turn_count, MesoError *error);

/* Puts the `keep` best of `count` places first, best first and of equals the first one, with their costs by
 * meso_match_at(); returns how many these are. What costs more than `keep` others is given up on the way.
 * O(count * point_count). */
uint32_t meso_match_refine(MesoMatch *matches, uint32_t count, uint32_t keep, const MesoMatchField *field,
                           const MesoMatchPoint *points, const float *weights, uint32_t point_count,
                           uint32_t turn_count);

/* The cost of one place by meso_match_at(), of any shift. O(point_count). */
float meso_match_cost(const MesoMatchField *field, const MesoMatchPoint *points, const float *weights,
                      uint32_t point_count, MesoVec2 shift, uint32_t turn, uint32_t turn_count);

/* A point of the plane and its normal, on the swatch. */
MesoMatchPoint meso_match_placed(MesoMatchPoint point, MesoVec2 shift, uint32_t turn, uint32_t turn_count);

#endif
