/* Triangles on their way to a target; raster_draw.h brings them there. */
#ifndef MESO_RASTER_QUEUE_H
#define MESO_RASTER_QUEUE_H

#include "libcore/render/raster/raster_target.h"

enum { MESO_RASTER_STEP = 16 };     /* triangles that are looked at at once */

/* What processors have; each draws the same. */
typedef enum MesoRasterMachine {
    MESO_RASTER_PLAIN, MESO_RASTER_AVX2, MESO_RASTER_AVX512
} MesoRasterMachine;

/* They are there when the queue has been flushed. */
typedef struct MesoRasterQueue {
    MesoRasterTarget target;
    MesoRasterMachine machine;
    uint32_t count;
    int32_t x[3][MESO_RASTER_STEP], y[3][MESO_RASTER_STEP];     /* of each one's three corners */
    float nearness[3][MESO_RASTER_STEP];
    uint32_t ids[MESO_RASTER_STEP];
    int32_t one_sided[MESO_RASTER_STEP];
} MesoRasterQueue;

#endif
