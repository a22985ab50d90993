/*
 * Profiles: the rings of points that sweeps carry along, and the kinds of
 * sweeps that a tile set can make. All depends on the tile set alone, so that
 * two slots that show the same cross-section to each other use the same ring.
 */
#ifndef MESO_PROFILE_H
#define MESO_PROFILE_H

#include "libcore/tiling/strand/profile_set.h"
#include "libcore/tiling/tile/contour.h"

/*
 * Makes the kinds of all tiles of a checked set.
 *
 * The contours of cross-sections that sweeps join, directly or over others,
 * get rings of the same number of points, the most that any of them has; extra
 * points lie on the longest segments, so that corners stay. Contours of one
 * sweep pair up by kind (outline, hole) and size; one without a partner shrinks
 * to its middle at the other end. The two rings of a sweep are aligned as in the
 * prototype, to the nearest point:
 *
 *     start at u (1 - u if flipped), end at 1 - u (u if flipped), plus half a
 *     turn if the flips differ, half a turn unless `half_turn`, and `turn`
 *
 * A section turns along the sweep by the angle between the points that this pairs, at most half a turn, and by
 * `turns` more; each outline about its own middle, a hole with the only outline there is.
 *
 * divisions   vertices along a sweep; caps get a quarter, at least 4
 * limits      columns are dropped within them (column_thin.h)
 *
 * O(points of all kinds).
 */
MesoStatus meso_profile_set_build(MesoProfileSet *profiles, MesoArena *arena, const MesoTileSet *set,
                                  const MesoContourSet *contours, uint32_t divisions, MesoColumnLimits limits,
                                  MesoError *error);

#endif
