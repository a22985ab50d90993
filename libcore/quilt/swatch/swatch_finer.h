/* The finest period of a swatch: a tile may be many of them. */
#ifndef MESO_SWATCH_FINER_H
#define MESO_SWATCH_FINER_H

#include "libcore/quilt/swatch/swatch.h"

/*
 * Divides the period of a swatch in its place, along x and along y, by the largest number up to 64 for which a move by the
 * quotient takes each triangle to a triangle: within a hundredth of the mean edge, of the same material, modulo the
 * periods. The tile stays. Expected O(triangles) for each number that divides it, and less for others. MESO_ERR_MEMORY
 * alone.
 */
MesoStatus meso_swatch_refine_period(MesoSwatch *swatch, MesoArena *scratch, MesoError *error);

#endif
