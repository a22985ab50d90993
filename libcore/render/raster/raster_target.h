/*
 * Targets that triangles are drawn to (raster_draw.h), without a driver: cells of sixteen places each, which are one
 * pixel with sixteen samples, four with four, or sixteen with one.
 */
#ifndef MESO_RASTER_TARGET_H
#define MESO_RASTER_TARGET_H

#include <stdbool.h>
#include <stdint.h>

enum {
    MESO_RASTER_LANES = 16,
    MESO_RASTER_UNIT = 256      /* units of a vertex's coordinates in a pixel */
};

/* Where the places of a cell lie. */
typedef struct MesoRasterLanes {
    int32_t x[MESO_RASTER_LANES], y[MESO_RASTER_LANES];     /* units from the cell's corner */
    int32_t cell;               /* units, a side */
    uint32_t pixels;            /* a side */
    uint32_t samples;           /* a pixel: lanes of pixel (x, y) of the cell are (y * pixels + x) * samples on; the first
                                   is in its middle */
} MesoRasterLanes;

/* Those of 1, 4 or 16 samples a pixel. */
MesoRasterLanes meso_raster_lanes(uint32_t samples);

typedef struct MesoRasterTarget {
    const MesoRasterLanes *lanes;
    int32_t cells_x, cells_y;
    float *nearness;            /* [16 * cells_x * cells_y] the larger the nearer */
    uint32_t *ids;              /* of triangles, or NULL */
    float *farthest;            /* [cells_x * cells_y] at most the least nearness in each cell; of few samples NULL */
} MesoRasterTarget;

/* Nothing there: nearness -inf, or 0 where it is the inverse of a depth; ids 0. */
void meso_raster_clear(const MesoRasterTarget *target, float nothing);

/* Relative to the target's corner; nearness is linear in x and y. */
typedef struct MesoRasterVertex {
    int32_t x, y;               /* units, within 2^29 */
    float nearness;
} MesoRasterVertex;

/* Many of them. */
typedef struct MesoRasterPoints {
    int32_t *x, *y;
    float *nearness;
} MesoRasterPoints;

static inline MesoRasterVertex meso_raster_point(const MesoRasterPoints *points, uint32_t i)
{
    return (MesoRasterVertex){points->x[i], points->y[i], points->nearness[i]};
}

static inline void meso_raster_put_point(const MesoRasterPoints *points, uint32_t i, MesoRasterVertex vertex)
{
    points->x[i] = vertex.x;
    points->y[i] = vertex.y;
    points->nearness[i] = vertex.nearness;
}

/* The points from number `first` on. */
static inline MesoRasterPoints meso_raster_points_from(const MesoRasterPoints *points, uint32_t first)
{
    return (MesoRasterPoints){points->x + first, points->y + first, points->nearness + first};
}

#endif
