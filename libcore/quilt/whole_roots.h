/* Where whole elements grow from strands: leaves from a stem. */
#ifndef MESO_WHOLE_ROOTS_H
#define MESO_WHOLE_ROOTS_H

#include "libcore/quilt/swatch/swatch.h"

/*
 * roots [element_count]: of each whole element that touches a strand, or is within a quarter of the mean edge from one, its
 * vertex that is nearest to it; MESO_NO_INDEX for all others. O(elements * triangles) at worst, boxes are compared first.
 */
void meso_whole_roots(uint32_t *roots, const MesoSwatch *swatch);

#endif
