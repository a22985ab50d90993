#include "libcore/render/raster/raster_bins.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"

enum { CELLS = MESO_TILE_CELLS };

static uint16_t tile_at(float pixel, float tile_pixels, uint32_t tiles)
{
    float tile = floorf(pixel / tile_pixels);
    return tile > 0 ? tile < (float)(tiles - 1) ? (uint16_t)tile : (uint16_t)(tiles - 1) : 0;
}

static void find_ranges(void *context, uint64_t begin, uint64_t end)
{
    MesoRasterBins *bins = context;
    float width = (float)bins->job.width, height = (float)bins->job.height;
    for (uint64_t i = begin; i < end; i++) {
        MesoRasterRect r = meso_raster_rect(&bins->job.view, &bins->bounds[i]);
        bins->ranges[i] = (MesoTileRange){1, 0, 0, 0};
        if (!(r.right > 0 && r.bottom > 0 && r.left < width && r.top < height) ||
            (bins->job.samples == 1 && !meso_raster_rect_has_middle(&r)))
            continue;
        bins->ranges[i] = (MesoTileRange){tile_at(r.left, bins->tile_pixels, bins->tiles_x),
                                      tile_at(r.top, bins->tile_pixels, bins->tiles_y),
                                      tile_at(r.right, bins->tile_pixels, bins->tiles_x),
                                      tile_at(r.bottom, bins->tile_pixels, bins->tiles_y)};
    }
}

static MesoStatus sort_shapes(MesoRasterBins *bins, MesoArena *arena, MesoError *error)
{
    uint32_t count = bins->count;
    uint64_t tiles = (uint64_t)bins->tiles_x * bins->tiles_y;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t y = bins->ranges[i].top; y <= bins->ranges[i].bottom; y++)
            for (uint32_t x = bins->ranges[i].left; x <= bins->ranges[i].right; x++)
                bins->begin[y * bins->tiles_x + x + 1]++;
    for (uint64_t t = 0; t < tiles; t++)
        bins->begin[t + 1] += bins->begin[t];
    bins->binned = MESO_NEW(arena, uint32_t, bins->begin[tiles], error);
    uint64_t *next = MESO_NEW(arena, uint64_t, tiles, error);
    if (!bins->binned || !next)
        return MESO_ERR_MEMORY;
    memcpy(next, bins->begin, tiles * sizeof *next);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t y = bins->ranges[i].top; y <= bins->ranges[i].bottom; y++)
            for (uint32_t x = bins->ranges[i].left; x <= bins->ranges[i].right; x++)
                bins->binned[next[y * bins->tiles_x + x]++] = i;
    return MESO_OK;
}

MesoStatus meso_raster_bins_init(MesoRasterBins **out, MesoArena *arena, const MesoRasterJob *job,
                                 uint32_t thread_count, MesoError *error)
{
    MesoRasterBins *bins = *out = MESO_NEW(arena, MesoRasterBins, 1, error);
    if (!bins)
        return MESO_ERR_MEMORY;
    const MesoShapes *shapes = job->shapes;
    *bins = (MesoRasterBins){.job = *job, .lanes = meso_raster_lanes(job->samples), .bundled = shapes->made > 0};
    bins->count = bins->bundled ? shapes->bundle_count : shapes->count;
    bins->bounds = bins->bundled ? shapes->bundle_bounds : shapes->bounds;
    uint32_t pixels = CELLS * bins->lanes.pixels;
    bins->tile_pixels = (float)pixels;
    bins->tiles_x = (job->width + pixels - 1) / pixels;
    bins->tiles_y = (job->height + pixels - 1) / pixels;
    bins->ranges = MESO_NEW(arena, MesoTileRange, bins->count, error);
    bins->begin = MESO_NEW(arena, uint64_t, (uint64_t)bins->tiles_x * bins->tiles_y + 1, error);
    if (!bins->ranges || !bins->begin)
        return MESO_ERR_MEMORY;
    meso_parallel_for(thread_count, bins->count, 4096, find_ranges, bins);
    return sort_shapes(bins, arena, error);
}

/* How much is to be drawn in a tile. */
typedef struct TileLoad {
    uint64_t binned;
    uint32_t tile;
} TileLoad;

static int by_load(const void *a, const void *b)
{
    const TileLoad *x = a, *y = b;
    if (x->binned != y->binned)
        return x->binned > y->binned ? -1 : 1;
    return x->tile < y->tile ? -1 : x->tile > y->tile;
}

uint32_t *meso_raster_bins_order(const MesoRasterBins *bins, uint32_t first, uint32_t count)
{
    TileLoad *loads = malloc((count + 1) * sizeof *loads);
    uint32_t *order = malloc((count + 1) * sizeof *order);
    for (uint32_t i = 0; i < count && loads; i++)
        loads[i] = (TileLoad){bins->begin[first + i + 1] - bins->begin[first + i], first + i};
    if (loads)
        qsort(loads, count, sizeof *loads, by_load);
    for (uint32_t i = 0; i < count && loads && order; i++)
        order[i] = loads[i].tile;
    if (!loads) {
        free(order);
        order = NULL;
    }
    free(loads);
    return order;
}

uint32_t meso_raster_tile_rows(uint32_t samples)
{
    return CELLS * meso_raster_lanes(samples).pixels;
}

float meso_raster_tolerance(const MesoRasterJob *job, uint32_t shape)
{
    MesoBox box = meso_shape_bounds(job->shapes, shape);
    MesoRasterRect rect = meso_raster_rect(&job->view, &box);
    return job->tolerance * meso_raster_pixel(&job->view, rect.depth);
}
