/* Light from files: pictures of all directions (environment.h). */
#ifndef MESO_LIGHT_FILE_H
#define MESO_LIGHT_FILE_H

#include "formats/file/input.h"
#include "libcore/render/environment/lat_long.h"

/*
 * An OpenEXR or a Radiance picture, twice as wide as high: its R, G and B, or Y for all of them. MESO_ERR_INPUT, with
 * the path, for another picture, and for what image_read.h says of files.
 */
MesoStatus meso_light_read(MesoLatLong *map, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
