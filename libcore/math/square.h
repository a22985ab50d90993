/*
 * Symmetries of the unit square. A transform is an element of D4: flip x first,
 * then `quarter` counter-clockwise quarter turns. The prototype's flip y is
 * flip x and two quarter turns, so that each element has exactly one number here.
 */
#ifndef MESO_SQUARE_H
#define MESO_SQUARE_H

#include "libcore/math/vec.h"

enum { MESO_TRANSFORM_COUNT = 8 };

typedef uint8_t MesoTransform;  /* 4 * flip + quarter */

static inline MesoTransform meso_transform_make(bool flip_x, bool flip_y, uint32_t quarters)
{
    return (MesoTransform)(4u * (flip_x != flip_y) + ((quarters + (flip_y ? 2u : 0u)) & 3u));
}

/* True for the four that mirror. */
static inline bool meso_transform_flips(MesoTransform transform)
{
    return transform >= 4;
}

/* Where a point of the square goes. */
MesoVec2 meso_transform_point(MesoTransform transform, MesoVec2 point);

/* `second` after `first`. */
MesoTransform meso_transform_compose(MesoTransform second, MesoTransform first);
MesoTransform meso_transform_inverse(MesoTransform transform);

#endif
