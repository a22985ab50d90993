#include "libcore/render/raster/raster_target.h"

#include <stddef.h>

enum { LANES = MESO_RASTER_LANES, HALF = MESO_RASTER_UNIT / 2 };

/* ---- places ---- */

/* A pixel's middle first; then places no two of which share a row or a column of sixteenths. */
static const int8_t SIXTEEN[LANES][2] = {{0, 0}, {-1, -3}, {-3, 2}, {4, -1}, {-5, -2}, {2, 5}, {5, 3}, {3, -5},
                                         {-2, 6}, {1, -7}, {-4, -6}, {-6, 4}, {-8, 1}, {7, -4}, {6, 7}, {-7, -8}};
static const int8_t FOUR[4][2] = {{0, 0}, {5, -5}, {-6, 3}, {1, 7}};

MesoRasterLanes meso_raster_lanes(uint32_t samples)
{
    MesoRasterLanes lanes = {.pixels = samples == 1 ? 4 : samples == 4 ? 2 : 1, .samples = samples};
    lanes.cell = (int32_t)lanes.pixels * MESO_RASTER_UNIT;
    for (uint32_t l = 0; l < LANES; l++) {
        uint32_t pixel = l / samples, sample = l % samples;
        const int8_t *at = samples == 16 ? SIXTEEN[sample] : FOUR[sample];
        lanes.x[l] = (int32_t)(pixel % lanes.pixels) * MESO_RASTER_UNIT + HALF + at[0] * (MESO_RASTER_UNIT / 16);
        lanes.y[l] = (int32_t)(pixel / lanes.pixels) * MESO_RASTER_UNIT + HALF + at[1] * (MESO_RASTER_UNIT / 16);
    }
    return lanes;
}

void meso_raster_clear(const MesoRasterTarget *target, float nothing)
{
    size_t count = (size_t)LANES * (size_t)target->cells_x * (size_t)target->cells_y;
    for (size_t i = 0; i < count; i++)
        target->nearness[i] = nothing;
    for (size_t i = 0; target->ids && i < count; i++)
        target->ids[i] = 0;
    for (size_t i = 0; target->farthest && i < count / LANES; i++)
        target->farthest[i] = nothing;
}
