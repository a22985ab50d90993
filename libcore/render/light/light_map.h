/*
 * Light maps: how far a scene's shapes reach towards parallel light of one direction. A point that lies behind is in
 * their shadow. Many of them at once stand for the sky, or for a light with an extent.
 */
#ifndef MESO_LIGHT_MAP_H
#define MESO_LIGHT_MAP_H

#include "libcore/render/raster/raster_view.h"
#include "libcore/render/raster/shapes.h"

typedef struct MesoLightMap {
    MesoVec3 toward;            /* the light, unit */
    MesoRasterView view;        /* parallel, against it */
    float *nearness;            /* [size * size] by cells of 4 x 4 */
} MesoLightMap;

/* Square ones of one size around one sphere, side by side: a place is looked up in many at once. */
typedef struct MesoLightMaps {
    MesoLightMap *maps;         /* [count] */
    uint32_t count, size;       /* texels a side, a multiple of 4 */
    float texel;                /* scene units */
    float tolerance;            /* how far what is drawn may lie from shapes: 0: all of them is drawn */
    float *rows[9];             /* [count] coordinates of `toward`, and of what is right and down in the maps */
    float *nearness;            /* [count * size * size] */
} MesoLightMaps;

/* Along `towards` [count] around a sphere, with a tolerance of half a texel; they live in `arena`. MESO_ERR_MEMORY
 * alone. */
MesoStatus meso_light_maps_init(MesoLightMaps *maps, MesoArena *arena, const MesoVec3 *towards, uint32_t count,
                                MesoVec3 middle, float radius, uint32_t size, MesoError *error);

/*
 * Draws all shapes into all maps of sets of them, the finest last, each within the tolerance of the set. The same on
 * any number of threads. O(shapes' vertices * maps). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_light_maps_draw(MesoLightMaps *const *sets, uint32_t set_count, const MesoShapes *shapes,
                                uint32_t thread_count, MesoError *error);

/*
 * How much a surface at `p` with the normal `n` faces each light, not below 0, and what share of that light reaches it
 * past what is nearer, over the four texels around; off the surface by what a texel may hide of its slope.
 * `facing`, `lit` [count]; 0 where it faces away.
 */
void meso_light_maps_lit(const MesoLightMaps *maps, MesoVec3 p, MesoVec3 n, float *facing, float *lit);

#endif
