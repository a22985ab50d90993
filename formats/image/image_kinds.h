/* The readers of the kinds of pictures: what image_read.c chooses from. As meso_image_read() of a file of that kind. */
#ifndef MESO_IMAGE_KINDS_H
#define MESO_IMAGE_KINDS_H

#include "formats/image/picture.h"

MesoStatus meso_exr_read(MesoPicture *out, MesoArena *arena, const MesoInput *input, MesoError *error);
MesoStatus meso_hdr_read(MesoPicture *out, MesoArena *arena, const MesoInput *input, MesoError *error);
MesoStatus meso_png_read(MesoPicture *out, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
