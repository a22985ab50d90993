/* The columns of all kinds of sweeps at each level of detail. */
#ifndef MESO_SHAPE_LEVELS_H
#define MESO_SHAPE_LEVELS_H

#include "libcore/render/raster/shape_columns.h"

/* Level l stays within finest * 2^(l / 2) of the kinds' own surfaces; 0 is all that there is. */
enum { MESO_SHAPE_LEVELS = 40 };

/* Of a use, tolerances from `low` to `high`; level 1 is beyond `finest`. Scene units. */
typedef struct MesoLevelRange {
    MesoShapeUse use;
    float low, high, finest;
} MesoLevelRange;

/*
 * Makes those of `levels` [kind_count * MESO_SHAPE_LEVELS * MESO_SHAPE_USES], zeroed at first, that such a range asks
 * for and that are not there; `scales` [kind_count] are as meso_shape_columns() has them. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_shape_levels(MesoShapeColumns *levels, MesoArena *arena, const MesoScene *scene, const float *scales,
                             const MesoLevelRange *range, MesoError *error);

/* Those of a kind within a tolerance of a range that has been made. O(1). */
const MesoShapeColumns *meso_shape_level(const MesoShapeColumns *levels, float finest, uint32_t kind, float tolerance,
                                         MesoShapeUse use);

#endif
