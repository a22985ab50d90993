/* Pictures without a driver: visibility by raster_tiles.h, light by light_rig.h. */
#ifndef MESO_TILE_PICTURE_H
#define MESO_TILE_PICTURE_H

#include "libcore/render/render.h"

/*
 * meso_render() on this machine's processors alone, `thread_count` of them (0: all); the same bytes for any number.
 * Colour is the mean over 1, 4 or 16 samples a pixel, the other variables are those of its middle. Scratch goes to
 * `arena` too. MESO_ERR_MEMORY, MESO_ERR_LIMIT or MESO_ERR_USAGE for options that no picture has.
 */
MesoStatus meso_tile_picture(MesoImage *image, MesoArena *arena, const MesoScene *scene,
                             const MesoRenderOptions *options, uint32_t thread_count, MesoError *error);

#endif
