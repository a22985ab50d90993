/*
 * Drawing of light maps from the front: what lies behind what has been drawn is not even made. A map keeps what is
 * nearest at each texel, so that neither the order nor what is left out changes it.
 */
#ifndef MESO_LIGHT_ORDER_H
#define MESO_LIGHT_ORDER_H

#include "libcore/render/light/light_map.h"

/*
 * Numbers of the shapes' bundles, those first that may be nearest to the light; NULL where sweeps are stored, which are
 * drawn as they come. `failed` is set where memory is out. The caller frees it.
 */
uint32_t *meso_light_order(const MesoLightMaps *maps, const MesoShapes *shapes, bool *failed);

/* Whether nothing of what is in such a rectangle of the map's view changes it any more; false is always right. */
bool meso_light_map_hides(const MesoLightMap *map, uint32_t size, const MesoRasterRect *rect);

/* Whether none of the maps is changed by what is in the box. */
bool meso_light_maps_hide(const MesoLightMaps *maps, const MesoBox *box);

#endif
