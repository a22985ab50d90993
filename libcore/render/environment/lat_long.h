/*
 * Pictures of all directions by latitude and longitude, as OpenEXR's ImfEnvmap.h has them: y is up and at the top, z in
 * the middle, and x a quarter to the left of it, as one sees them from within.
 */
#ifndef MESO_LAT_LONG_H
#define MESO_LAT_LONG_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef struct MesoLatLong {
    uint32_t width, height;
    float *rgb;                 /* [3 * width * height] radiance, linear; rows from the top */
} MesoLatLong;

/* Black. MESO_ERR_MEMORY alone. */
MesoStatus meso_lat_long_init(MesoLatLong *map, MesoArena *arena, uint32_t width, uint32_t height, MesoError *error);

/* Of the middle of a texel; unit. */
MesoVec3 meso_lat_long_direction(const MesoLatLong *map, uint32_t x, uint32_t y);

/* Of a texel of that row, exactly; all together are 4 pi. */
float meso_lat_long_solid_angle(const MesoLatLong *map, uint32_t y);

/* Radiance from a unit direction, between the four texels around it. */
void meso_lat_long_at(const MesoLatLong *map, MesoVec3 direction, float out[3]);

/* Means of `map` over the texels of `out`, by solid angle: what shines together stays the same. O(texels of both). */
void meso_lat_long_resample(const MesoLatLong *map, MesoLatLong *out);

static inline float meso_luminance(const float color[3])
{
    return 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
}

#endif
