/* The columns of all kinds of sweeps at each level of detail. */
#ifndef MESO_SHAPE_LEVELS_H
#define MESO_SHAPE_LEVELS_H

#include "libcore/render/raster/shape_columns.h"
#include "libcore/scene/detail.h"

/* Level l stays within finest * 2^(l / 2) of the kinds' own surfaces; 0 is all that there is. */
enum { MESO_SHAPE_LEVELS = 40 };

/* [kind_count * MESO_SHAPE_LEVELS * MESO_SHAPE_USES], in `arena`; NULL when memory is out. */
MesoShapeColumns *meso_shape_levels(MesoArena *arena, const MesoScene *scene, const MesoKindDetail *details,
                                    float finest, MesoError *error);

/* Those of a kind within a tolerance. O(1). */
const MesoShapeColumns *meso_shape_level(const MesoShapeColumns *levels, float finest, uint32_t kind, float tolerance,
                                         MesoShapeUse use);

#endif
