/* Fewer columns for the kinds of sweeps, as a tolerance allows, with rings at their ends that neighbours share. */
#ifndef MESO_COLUMN_THIN_H
#define MESO_COLUMN_THIN_H

#include "libcore/tiling/strand/contour_ring.h"
#include "libcore/tiling/strand/profile_set.h"

/* Where a column ends: points of rings, all rings numbered through, or MESO_NO_INDEX where the end is a point. */
typedef struct MesoColumnPlace {
    uint32_t start, end;
    bool creased;       /* a sharp corner of either ring: it stays */
    float signs[2];     /* of x at the start and the end: -1 where it is against the ring's */
    bool doubled;       /* there are two of it, with the normals of both sides; one at the seam, as at its other end */
} MesoColumnPlace;

/*
 * Drops columns of finely sampled kinds, so that what is dropped stays within the limits of what is left, at both ends
 * and wherever they are blended between, and no chord stands for a turn of over 60 degrees; sharp corners stay. The
 * other points of a ring that are kept move out of the bends, so that the ring lies as far outside of its chords as
 * inside, which takes seven chords for ten.
 *
 * Which points a ring keeps depends on its drawing, and on where columns begin: every sweep that ends there, from
 * either side of a wall, has the same. What a sweep needs between its ends, for the corners of the other end or for its
 * blends, is absent on the ring (scene.h). Columns begin anew at a point that both rings have, where u is then 0.
 *
 * places   [column_count of the profiles]
 *
 * Replaces the columns of `profiles` by others in `scratch`, and changes kinds and origins. O(columns * log of those of
 * a ring).
 */
MesoStatus meso_columns_thin(MesoProfileSet *profiles, const MesoColumnPlace *places, const MesoRing *rings,
                             uint32_t ring_count, MesoArena *scratch, MesoColumnLimits limits, MesoError *error);

#endif
