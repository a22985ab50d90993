/* Boxes side by side in a square: shelves of falling height. */
#ifndef MESO_BOX_PACK_H
#define MESO_BOX_PACK_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

/*
 * Places `count` boxes of the given `sizes`, not turned, in a square, apart from each other and its border by
 * `gap` of its side; `lows` [count] are their lower corners. The side is the least that shelves fit in, to 1e-3.
 * O(count log count). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_boxes_pack(MesoVec2 *lows, float *side, MesoArena *scratch, const MesoVec2 *sizes, uint32_t count,
                           float gap, MesoError *error);

#endif
