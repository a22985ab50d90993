/* What cannot be seen on a target that has something already, before it is made. */
#ifndef MESO_RASTER_HIDDEN_H
#define MESO_RASTER_HIDDEN_H

#include "libcore/render/raster/raster_view.h"

/*
 * Whether nothing of what is in such a rectangle of the picture can be seen in `window`, whose pixels the target has:
 * no sample is within it, or all are nearer. True only where that is certain. O(pixels of the rectangle).
 */
bool meso_raster_hides(const MesoRasterTarget *target, const MesoWindow *window, const MesoRasterView *view,
                       const MesoRasterRect *rect);

#endif
