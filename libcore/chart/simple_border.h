/* Whether the border of a flattened disk meets itself. */
#ifndef MESO_SIMPLE_BORDER_H
#define MESO_SIMPLE_BORDER_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

/*
 * Above 0 where a b c turn counter-clockwise, below where clockwise. The sign is right: differences of floats whose
 * sizes are within 2^29 of each other, and products of these, are exact in double precision or rounded with their sign.
 */
static inline double meso_turn(MesoVec2 a, MesoVec2 b, MesoVec2 c)
{
    double abx = (double)b.x - a.x, aby = (double)b.y - a.y, acx = (double)c.x - a.x, acy = (double)c.y - a.y;
    return abx * acy - aby * acx;
}

/*
 * `border` [2 * count] are sides between `places`, each end met by two. A disk whose triangles all turn
 * counter-clockwise and whose border is simple has no two triangles that overlap. A sweep along x: O(count log count)
 * and what overlaps in x. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_border_is_simple(bool *simple, MesoArena *scratch, const MesoVec2 *places, const uint32_t *border,
                                 uint32_t count, MesoError *error);

#endif
