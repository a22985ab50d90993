/* Colours that differ a little from thing to thing, as those of reeds or feathers do. */
#ifndef MESO_VARY_H
#define MESO_VARY_H

#include <stdint.h>

#include "libcore/scene/scene.h"

/*
 * The channel of ids by which things of the scene are told apart most finely: strands, elements, details, branches or
 * slots, in this order; MESO_NO_INDEX where there is none of them.
 */
uint32_t meso_vary_channel(const MesoScene *scene);

/*
 * Changes a colour by what thing `id` it is of: its value by a factor of up to 2^amount or as little as 2^-amount, and
 * its hue by up to `amount` / 4 of a radian either way. The same for the same id; linear, stays within [0,1]; 0 changes
 * nothing.
 */
void meso_vary(float albedo[3], uint32_t id, float amount);

#endif
