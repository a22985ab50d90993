/*
 * What is left of a scene's shapes for somebody else to draw, such as a driver: the triangles that may hold a sample of
 * a window, apart for each sample. Most triangles of a dense scene lie between samples. All processors make the shapes,
 * as fine as raster_tiles.h does, and look at each triangle before it costs anything.
 */
#ifndef MESO_SIFT_H
#define MESO_SIFT_H

#include "libcore/render/raster/raster_bins.h"

typedef struct MesoSiftVertex {
    MesoVec3 position, normal;  /* relative to the anchor */
    uint32_t shape;
    uint8_t color[4];           /* white where the shape has none */
    MesoVec2 uv;                /* v: how far along a sweep */
} MesoSiftVertex;

/* Triangles of consecutive shapes. */
typedef struct MesoSiftBatch {
    uint32_t vertex_count, vertex_room;
    MesoSiftVertex *vertices;                   /* [vertex_count] */
    uint32_t index_counts[MESO_RASTER_LANES], index_rooms[MESO_RASTER_LANES];
    uint32_t *indices[MESO_RASTER_LANES];       /* [index_counts[sample]] of each sample: three a triangle */
} MesoSiftBatch;

typedef MesoStatus MesoTakeBatch(void *context, const MesoSiftBatch *batch, MesoError *error);

/*
 * Hands over what a window of the job's picture may show, on this thread, batch by batch in the order of the shapes;
 * the same for any `thread_count`. No triangle is left out that holds a sample when its vertices are rounded to a 16th
 * of a pixel or less. Batches without triangles are not handed over. What `take` returns other than MESO_OK ends it.
 * O(shapes + vertices of those that the window may show). Otherwise MESO_ERR_MEMORY alone.
 */
MesoStatus meso_sift(const MesoRasterJob *job, MesoWindow window, uint32_t thread_count, MesoTakeBatch *take,
                     void *context, MesoError *error);

#endif
