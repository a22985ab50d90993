/* Where the tile of a swatch is. */
#ifndef MESO_SWATCH_TILE_H
#define MESO_SWATCH_TILE_H

#include "libcore/quilt/swatch/swatch.h"

/*
 * Finds the periods and the tile of a sorted and measured swatch with its loops, moves it so that its tile begins at
 * the origin, and makes ends that meet across a period meet exactly. MESO_ERR_INPUT where it is not periodic but has
 * to be.
 */
MesoStatus meso_swatch_place(MesoSwatch *swatch, const MesoSwatchOptions *options, MesoError *error);

/* Whether a vertex with a mate meets it along x, not y. */
static inline bool meso_swatch_mates_along_x(const MesoSwatch *swatch, uint32_t high)
{
    MesoVec3 p = swatch->positions[swatch->mates[high]], q = swatch->positions[high];
    return fabsf(q.x - p.x) > fabsf(q.y - p.y);
}

/* Makes mates meet: their places are apart by the tile's size, in floats, and their normals the same. */
void meso_swatch_snap(MesoSwatch *swatch);

#endif
