/*
 * Visibility of a picture by GL, window by window: the nearest surface at each sample, as raster_tiles.h has it, which
 * it agrees with but for what rounding decides. The samples of a pixel are drawn side by side, each with the picture
 * moved by its place.
 */
#ifndef MESO_GL_VISIBILITY_H
#define MESO_GL_VISIBILITY_H

#include "libcore/render/gl/gl_context.h"
#include "libcore/render/raster/raster_tiles.h"

typedef struct MesoGlVisibility MesoGlVisibility;

/*
 * What of such pictures needs nothing but their size, so that shapes may be made ready meanwhile; the driver compiles
 * what it draws with. `detailed`: samples have uv and colour too, which are 0 and white otherwise. What is not GL's is
 * from the system. MESO_ERR_LIMIT over the driver's limits, MESO_ERR_INTERNAL with its words where GL fails,
 * MESO_ERR_MEMORY.
 */
MesoStatus meso_gl_visibility_init(MesoGlVisibility **visibility, const MesoGlContext *context, uint32_t width,
                                   uint32_t height, uint32_t samples, bool detailed, MesoError *error);

/*
 * The rest, for the job's shapes, which have to last, as the job's view and `view`, which is the same. Where the
 * context's shaders are to bend sweeps, all of them are uploaded; otherwise `thread_count` threads sift what each
 * window may show (sift.h). Samples never have triangles or shares of their corners. What is not GL's lives in
 * `arena`. The same errors.
 */
MesoStatus meso_gl_visibility_begin(MesoGlVisibility *visibility, MesoArena *arena, const MesoRasterJob *job,
                                    const MesoView *view, uint32_t thread_count, MesoError *error);
void meso_gl_visibility_release(MesoGlVisibility *visibility);

/* Pixels a side of the windows that are drawn at once; and what those of a picture take, the driver's part and ours. */
uint32_t meso_gl_window_side(uint32_t samples);
size_t meso_gl_window_bytes(uint32_t width, uint32_t height, uint32_t samples);

/* Finds what a window shows, at most of that side. */
MesoStatus meso_gl_visibility_draw(MesoGlVisibility *visibility, MesoWindow window, MesoError *error);

/* The surface at sample `sample` of pixel (x, y) of the window drawn last; false where there is nothing. */
bool meso_gl_visibility_sample(const MesoGlVisibility *visibility, uint32_t x, uint32_t y, uint32_t sample,
                               MesoSurfaceSample *out);

#endif
