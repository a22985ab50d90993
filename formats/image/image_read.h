/* Pictures in: OpenEXR through its Core C API, PNG through libpng, Radiance's .hdr. Their numbers are data, such as
 * masks. */
#ifndef MESO_IMAGE_READ_H
#define MESO_IMAGE_READ_H

#include "formats/image/picture.h"

/*
 * Reads a PNG, an OpenEXR or a Radiance picture; its first bytes say which. Numbers are as stored, without a colour
 * space: 0 to 1 of a PNG's 1 to 16 bits, whose channels are Y or R G B, and A where the file has it, palettes looked
 * up; halves and floats of an EXR, infinite and NaN ones too, and integers, rounded to floats; scan lines or tiles, the
 * largest level of several, the first part of several; R, G and B in the units of radiance of a .hdr, whose rows may
 * run upwards.
 *
 * MESO_ERR_INPUT, with the path, for what is no such picture, is broken or cut short, is deep, or has channels of
 * another size than the picture; MESO_ERR_LIMIT for more than MESO_PICTURE_VALUES; MESO_ERR_MEMORY. O(values).
 */
MesoStatus meso_image_read(MesoPicture *out, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
