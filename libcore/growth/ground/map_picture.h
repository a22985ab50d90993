/* Maps as pictures over a surface's texture coordinates, to look at, or to paint on. */
#ifndef MESO_MAP_PICTURE_H
#define MESO_MAP_PICTURE_H

#include "libcore/growth/ground/growth_maps.h"

enum { MESO_MAP_GUTTER = 2 };

/*
 * The values of a map at the middles of pixels: what reads them as an image finds the map again, to a pixel. Where
 * triangles lie over one another the last one counts; what leaves the picture comes in again on the other side.
 *
 * uvs     [3 * triangle_count] (0,0) is the lower left corner of the picture
 * values  [width * height] rows from the top; NaN where nothing lies, but that MESO_MAP_GUTTER pixels around each
 *         triangle have its values as they would go on
 *
 * O(pixels + triangles), and O(pixels) for each time that triangles lie over one another. MESO_ERR_MEMORY alone.
 */
MesoStatus meso_map_picture(float *values, uint32_t width, uint32_t height, const MesoGrowthGround *ground,
                            const MesoGrowthMap *map, const MesoVec2 *uvs, MesoArena *scratch, MesoError *error);

#endif
