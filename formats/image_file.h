/* Pictures out: OpenEXR through its Core C API, PNG through libpng. */
#ifndef MESO_IMAGE_FILE_H
#define MESO_IMAGE_FILE_H

#include "formats/output.h"
#include "formats/provenance.h"
#include "libcore/render/render.h"

/*
 * One part, scan lines, ZIP: R G B A (half, linear, premultiplied), Z (float,
 * distance along the view axis, +inf where empty), N.X N.Y N.Z (half, world
 * space), albedo.R albedo.G albedo.B (half), slot and tile (uint, number + 1,
 * 0 where empty). Provenance and the names of the tiles as string attributes.
 */
MesoStatus meso_exr_write(const MesoImage *image, const MesoModel *model,
                          const MesoProvenance *provenance, MesoOutput *output, MesoError *error);

/* 8 bits, sRGB, over `background` (linear RGB) or, where that is NULL, with alpha. */
MesoStatus meso_png_write(const MesoImage *image, const float *background,
                          const MesoProvenance *provenance, MesoOutput *output, MesoError *error);

#endif
