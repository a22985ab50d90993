/* Rings: contours with a given number of points, for sweeps to carry along. */
#ifndef MESO_CONTOUR_RING_H
#define MESO_CONTOUR_RING_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef struct MesoRing {
    uint32_t count;
    MesoVec2 *points;       /* [count] */
    bool *creased;          /* [count] a sharp corner */
} MesoRing;

/* Resamples `contour` to `count` >= its own points, in order, keeping them all; more lie on the longest segments. */
MesoStatus meso_contour_resample(const MesoVec2 *contour, uint32_t contour_count, MesoVec2 *out,
                                 uint32_t count, MesoArena *scratch, MesoError *error);

/* A ring of them. It turns by more than 50 degrees in its sharp corners: discs of 8 points stay round. */
MesoStatus meso_ring_resample(MesoRing *ring, MesoArena *arena, const MesoVec2 *contour, uint32_t contour_count,
                              uint32_t count, MesoError *error);

/*
 * The same at equal parts of the contour's own points, of which only the sharp corners are kept: what lies where
 * does not depend on how finely the contours are sampled.
 */
MesoStatus meso_ring_spread(MesoRing *ring, MesoArena *arena, const MesoVec2 *contour, uint32_t contour_count,
                            uint32_t count, MesoError *error);

#endif
