/* The box of what a picture shows. */
#ifndef MESO_COVERED_H
#define MESO_COVERED_H

#include "libcore/render/image.h"

/* Widens the box, which begins empty, by the pixels of a band that are not clear; `first_row` is the band's in the
 * picture. O(pixels). */
void meso_covered_add(MesoWindow *box, const MesoImage *band, uint32_t first_row);

#endif
