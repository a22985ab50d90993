/*
 * Light maps: how far a scene's shapes reach towards parallel light of one direction. A point that lies behind is in
 * their shadow. Many of them at once stand for the sky, or for a light with an extent.
 */
#ifndef MESO_LIGHT_MAP_H
#define MESO_LIGHT_MAP_H

#include "libcore/render/raster/raster_view.h"
#include "libcore/render/raster/shapes.h"

/* Square, around the scene's sphere. */
typedef struct MesoLightMap {
    MesoVec3 toward;            /* the light, unit */
    MesoRasterView view;        /* parallel, against it */
    uint32_t size;              /* texels a side, a multiple of 4 */
    float texel;                /* scene units */
    float *nearness;            /* [size * size] by cells of 4 x 4 */
} MesoLightMap;

/* Along `toward` around a sphere; the map lives in `arena`. MESO_ERR_MEMORY alone. */
MesoStatus meso_light_map_init(MesoLightMap *map, MesoArena *arena, MesoVec3 toward, MesoVec3 middle, float radius,
                               uint32_t size, MesoError *error);

/*
 * Draws all shapes into all maps, each as fine as half a texel of the finest map. The same on any number of threads.
 * O(shapes' vertices * maps). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_light_maps_draw(MesoLightMap *maps, uint32_t map_count, const MesoShapes *shapes, uint32_t thread_count,
                                MesoError *error);

/* Share of the light that reaches `p` past what is nearer by more than `bias`: over the four texels around. */
float meso_light_map_lit(const MesoLightMap *map, MesoVec3 p, float bias);

#endif
