/* Whether a quilt has holes that its swatch has not. */
#ifndef MESO_CHECK_COVER_H
#define MESO_CHECK_COVER_H

#include "libcore/quilt/quilt.h"

/* Radii of discs with nothing over them, in units of the swatch. */
typedef struct MesoCover {
    uint32_t place_count, empty_count;      /* places, and those around which it is emptier than it may be */
    double widest, swatch_widest;           /* radius of the widest disc around a place, and around one of the tile */
} MesoCover;

/*
 * Places are random, the same in each call, a hundred on each tile's area or so and 2^16 at most. A disc around one is
 * as wide as the nearest triangle of the quilt is far, all of them let down onto the surface; discs that reach beyond
 * a border do not count, nor such at a whole element's width from it. One may be a quarter wider than the widest of
 * the swatch, and half a mean edge.
 *
 * scale    as of MesoQuiltOptions
 *
 * O(n log n) for n triangles. MESO_ERR_MEMORY.
 */
MesoStatus meso_check_cover(MesoCover *cover, MesoArena *scratch, const MesoQuilt *quilt, const MesoSwatch *swatch,
                            const MesoTriangulation *base, float scale, MesoError *error);

#endif
