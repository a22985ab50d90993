/*
 * A picture to be drawn tile by tile, and which shapes, or bundles of them, each tile may show. A tile is 32 x 32 cells
 * (raster_target.h).
 */
#ifndef MESO_RASTER_BINS_H
#define MESO_RASTER_BINS_H

#include "libcore/render/raster/raster_view.h"
#include "libcore/render/raster/shapes.h"

enum { MESO_TILE_CELLS = 32 };

typedef struct MesoRasterJob {
    const MesoShapes *shapes;
    MesoRasterView view;
    uint32_t width, height;     /* of the picture */
    uint32_t samples;           /* a pixel: 1, 4 or 16 */
    float tolerance;            /* of the level of detail, in pixels; 0: all of it */
} MesoRasterJob;

/* The tolerance that a shape is made with, in scene units: what the job wants at its nearest point. */
float meso_raster_tolerance(const MesoRasterJob *job, uint32_t shape);

/* Tiles that a shape may reach; none where left is over right. */
typedef struct MesoTileRange {
    uint16_t left, top, right, bottom;
} MesoTileRange;

typedef struct MesoRasterBins {
    MesoRasterJob job;
    MesoRasterLanes lanes;
    float tile_pixels;
    uint32_t tiles_x, tiles_y;
    bool bundled;               /* what is binned are bundles, not shapes */
    uint32_t count;             /* of what is binned */
    const MesoBox *bounds;      /* [count] */
    MesoTileRange *ranges;      /* [count] */
    uint64_t *begin;            /* [tiles + 1] */
    uint32_t *binned;           /* by tile, ascending */
} MesoRasterBins;

/*
 * Which shapes each tile may show. Lives in `arena`, as long as the job's shapes: 8 bytes a shape and 4 a shape and
 * tile. O(shapes + shapes of each tile). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_raster_bins_init(MesoRasterBins **bins, MesoArena *arena, const MesoRasterJob *job,
                                 uint32_t thread_count, MesoError *error);

/*
 * The tiles [first, first + count), the fullest first: towards the end, threads that have done with theirs find small
 * ones. To be freed; NULL where memory is out.
 */
uint32_t *meso_raster_bins_order(const MesoRasterBins *bins, uint32_t first, uint32_t count);

/* Rows of the picture that a tile has. */
uint32_t meso_raster_tile_rows(uint32_t samples);

#endif
