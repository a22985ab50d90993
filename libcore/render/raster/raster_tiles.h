/*
 * Visibility of a picture, tile by tile: which triangle of which shape is nearest at each sample, found by drawing the
 * shapes of a tile into memory that a processor's cache holds; and what the surface is like there, for those samples
 * that are asked for. A tile is 32 x 32 cells (raster_target.h).
 */
#ifndef MESO_RASTER_TILES_H
#define MESO_RASTER_TILES_H

#include "libcore/render/raster/raster_bins.h"

/* The surface at a sample. */
typedef struct MesoSurfaceSample {
    uint32_t shape, triangle;
    MesoVec3 position, normal;  /* relative to the anchor; unit, to the eye's side of the triangle */
    float shares[3];            /* of the triangle's corners */
    float depth;                /* along the view */
    float along;                /* a sweep, 0 to 1 */
    MesoVec2 uv;
    float color[3];             /* of the body, times the material's */
} MesoSurfaceSample;

typedef struct MesoRasterTile MesoRasterTile;

/* Where the tile lies in the picture, and its pixels that are in it. */
MesoWindow meso_raster_tile_window(const MesoRasterTile *tile);

/*
 * The surface at sample `sample` of pixel (x, y) of the tile; false where there is nothing. Quickest pixel by pixel.
 */
bool meso_raster_tile_sample(MesoRasterTile *tile, uint32_t x, uint32_t y, uint32_t sample, MesoSurfaceSample *out);

/* Whether there is anything at all in the tile. */
bool meso_raster_tile_empty(const MesoRasterTile *tile);

/*
 * Draws the tiles that have some of the rows [row_begin, row_end) of the picture, and hands over each, whole, once it
 * is drawn, from any thread; which does not change what it has. What a tile's visible shapes take is held for each
 * thread. O(vertices of the shapes in each tile + samples). MESO_ERR_MEMORY alone.
 */
typedef void MesoTakeTile(void *context, MesoRasterTile *tile);
MesoStatus meso_raster_rows(const MesoRasterBins *bins, uint32_t row_begin, uint32_t row_end, uint32_t thread_count,
                            MesoTakeTile *take, void *context, MesoError *error);

#endif
