/* Noise of space: smooth, without a direction, the same on every machine. */
#ifndef MESO_NOISE_H
#define MESO_NOISE_H

#include "libcore/math/vec.h"

/*
 * Gradient noise (Perlin, "Improving Noise", 2002): quintic blends between the 12 gradients towards a cube's edges,
 * chosen by a hash of the cell's corner and `seed`. 0 at points with whole coordinates, within [-1, 1], continuous up
 * to the second derivative. Cells repeat after 2^32 of them. O(1).
 */
float meso_noise(MesoVec3 p, uint64_t seed);

#endif
