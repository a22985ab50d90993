/* Where the tile of a swatch is. */
#ifndef MESO_SWATCH_TILE_H
#define MESO_SWATCH_TILE_H

#include "libcore/quilt/swatch/swatch.h"

/*
 * Finds the periods and the tile of a sorted and measured swatch with its loops, moves it so that its tile begins at the
 * origin, and makes ends that meet across a period meet exactly. MESO_ERR_INPUT where it is not periodic but has to be.
 */
MesoStatus meso_swatch_place(MesoSwatch *swatch, const MesoSwatchOptions *options, MesoError *error);

#endif
