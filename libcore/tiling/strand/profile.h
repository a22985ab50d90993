/*
 * Profiles: the rings of points that sweeps carry along, and the kinds of
 * sweeps that a tile set can make. All depends on the tile set alone, so that
 * two slots that show the same cross-section to each other use the same ring.
 */
#ifndef MESO_PROFILE_H
#define MESO_PROFILE_H

#include "libcore/scene/scene.h"
#include "libcore/tiling/tile/contour.h"

/* Where a swept kind of the scene comes from. */
typedef struct MesoKindOrigin {
    uint32_t tile, sweep;               /* sweep is MESO_NO_INDEX for a cap */
    uint32_t start_side, end_side;      /* of the tile; equal for a cap */
    uint32_t start_section, end_section;
    bool mirrored;                      /* the tile's transform flips */
} MesoKindOrigin;

typedef struct MesoProfileSet {
    uint32_t kind_count, column_count;
    MesoSweptKind *kinds;       /* [kind_count] by tile, mirrored, then sweeps before caps; no instances yet */
    MesoKindOrigin *origins;    /* [kind_count] */
    MesoSweepColumn *columns;
    uint32_t *tile_kinds;       /* [2 * tile_count + 1]: kinds of tile t unmirrored from 2 t, mirrored from 2 t + 1 */
} MesoProfileSet;

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
 * divisions   vertices along a sweep; caps get a quarter, at least 4
 *
 * O(points of all kinds).
 */
MesoStatus meso_profile_set_build(MesoProfileSet *profiles, MesoArena *arena, const MesoTileSet *set,
                                  const MesoContourSet *contours, uint32_t divisions, MesoError *error);

/* Resamples `contour` to `count` >= its own points, in order, keeping them all. For profiles and tests. */
MesoStatus meso_contour_resample(const MesoVec2 *contour, uint32_t contour_count, MesoVec2 *out,
                                 uint32_t count, MesoArena *scratch, MesoError *error);

#endif
