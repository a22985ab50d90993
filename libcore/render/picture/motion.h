/* Motion: where what a pixel shows is in the next frame, by the camera and by the model. */
#ifndef MESO_MOTION_H
#define MESO_MOTION_H

#include "libcore/render/raster/raster_tiles.h"
#include "libcore/render/image.h"

typedef struct MesoMotion {
    const MesoRasterJob *job;
    MesoRasterView to;          /* the next frame's */
    bool still;                 /* the model stays as it is */
    MesoShapes next;
} MesoMotion;

/*
 * Whether scenes have the same structure: as many things of the same kinds, in the same order, with bodies of the same
 * faces. Then what is at a place of a thing's surface has its place in the other one. O(scene).
 */
bool meso_motion_alike(const MesoScene *a, const MesoScene *b);

/*
 * From a job to the next frame of `options`, whose scene is alike, or NULL: it stays. `job` and `options` must outlive
 * it. MESO_ERR_MEMORY, or as meso_view_build().
 */
MesoStatus meso_motion_init(MesoMotion *motion, MesoArena *arena, const MesoRasterJob *job,
                            const MesoRenderOptions *options, uint32_t thread_count, MesoError *error);

/* Pixels to the right and up; exactly 0 where nothing moves, and 0 for what is behind the next frame's camera. */
void meso_motion_at(const MesoMotion *motion, const MesoSurfaceSample *sample, float pixels[2]);

#endif
