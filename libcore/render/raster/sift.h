/*
 * What is left of a scene's shapes for somebody else to draw, such as a driver: the triangles that may be seen at a
 * sample of a window, apart for each sample. Most triangles of a dense scene lie between samples, and most others
 * behind what is before them. All processors make the shapes, as fine as raster_tiles.h does, part by part of the
 * window, in each from the nearest on; those that are hidden are not even made.
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

/* Triangles of a part of the window. */
typedef struct MesoSiftBatch {
    uint32_t vertex_count, vertex_room;
    MesoSiftVertex *vertices;                   /* [vertex_count] */
    uint32_t index_counts[MESO_RASTER_LANES], index_rooms[MESO_RASTER_LANES];
    uint32_t *indices[MESO_RASTER_LANES];       /* [index_counts[sample]] of each sample: three a triangle */
} MesoSiftBatch;

typedef MesoStatus MesoTakeBatch(void *context, const MesoSiftBatch *batch, MesoError *error);

/*
 * Hands over what a window of the job's picture may show, on this thread, part by part, while others make more; the
 * same for any `thread_count`. No triangle is left out that some sample sees when the vertices of all are rounded to
 * 2^-bits of a pixel or less; one that reaches several parts comes with each in which it may be seen. Batches without
 * triangles are not handed over. What `take` returns other than MESO_OK ends it. O(shapes + vertices of those that the
 * window may show). Otherwise MESO_ERR_MEMORY alone.
 */
MesoStatus meso_sift(const MesoRasterJob *job, MesoWindow window, uint32_t bits, uint32_t thread_count,
                     MesoTakeBatch *take, void *context, MesoError *error);

#endif
