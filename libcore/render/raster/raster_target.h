/*
 * Targets that triangles are drawn to, without a driver: cells of sixteen places each, which are one pixel with sixteen
 * samples, four with four, or sixteen with one. Edges are whole numbers, so that neighbours leave no gap and share no
 * place, and the nearest triangle, of equals the first, wins whatever the machine.
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
} MesoRasterTarget;

/* Nothing there: nearness -inf, or 0 where it is the inverse of a depth; ids 0. */
void meso_raster_clear(const MesoRasterTarget *target, float nothing);

/* Relative to the target's corner; nearness is linear in x and y. */
typedef struct MesoRasterVertex {
    int32_t x, y;               /* units, within 2^29 */
    float nearness;
} MesoRasterVertex;

/*
 * Triangles by three vertices each; triangle t has the id first_id + t. `one_sided`: those that are clockwise in the
 * target, whose rows run down, are left out. O(triangles + cells of their boxes).
 */
void meso_raster_draw(const MesoRasterTarget *target, const MesoRasterVertex *vertices, const uint32_t *corners,
                      uint32_t triangle_count, uint32_t first_id, bool one_sided);

/* The same without wide vectors, for tests. */
void meso_raster_draw_plain(const MesoRasterTarget *target, const MesoRasterVertex *vertices, const uint32_t *corners,
                            uint32_t triangle_count, uint32_t first_id, bool one_sided);

#endif
