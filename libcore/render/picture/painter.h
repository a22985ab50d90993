/* Pictures, whole or in bands: visibility by raster_tiles.h or gl_visibility.h, light by light_rig.h. */
#ifndef MESO_PAINTER_H
#define MESO_PAINTER_H

#include "libcore/render/gl/gl_visibility.h"
#include "libcore/render/image.h"

/*
 * All sweeps and bodies of `scene`, on this machine's processors alone, `thread_count` of them (0: all); the same bytes
 * for any number. The image's arrays go to `arena`, the names of its channels stay the scene's. Colour is the mean over 1, 4 or 16 samples a pixel, the other variables are those of its middle. Scratch goes to
 * `arena` too. MESO_ERR_MEMORY, MESO_ERR_LIMIT or MESO_ERR_USAGE for options that no picture has.
 */
MesoStatus meso_tile_picture(MesoImage *image, MesoArena *arena, const MesoScene *scene,
                             const MesoRenderOptions *options, uint32_t thread_count, MesoError *error);

/*
 * The same with visibility by GL: all but motion, for which it is MESO_ERR_USAGE. `context` is current on this thread;
 * light is done by `thread_count` threads. Also MESO_ERR_INTERNAL, with the driver's words, where GL fails.
 */
MesoStatus meso_gl_picture(MesoImage *image, MesoArena *arena, const MesoGlContext *context, const MesoScene *scene,
                           const MesoRenderOptions *options, uint32_t thread_count, MesoError *error);

/*
 * The parts of meso_tile_picture(), for pictures that are larger than memory: bands of rows, of which each is painted
 * into the same image, whose height is the band's. All pixels are as those of the whole picture.
 */
typedef struct MesoPainter MesoPainter;

/* Rows of a band, a multiple of 16, or all: those that `options` ask for, or as many as go into MESO_BAND_BYTES. */
enum { MESO_BAND_BYTES = 64 << 20 };
uint32_t meso_paint_band_rows(const MesoScene *scene, const MesoRenderOptions *options);

/*
 * Gets ready, draws the lights' maps, and makes room for a band. The painter lives in `arena`, as long as the scene
 * and `options` do; `band` has all that is the same for all bands. Where mattes, or the box of what is covered, come of
 * several bands, the whole picture is looked through for what is on it: both are told before the first band.
 */
MesoStatus meso_painter_init(MesoPainter **painter, MesoImage *band, MesoArena *arena, const MesoScene *scene,
                             const MesoRenderOptions *options, uint32_t thread_count, MesoError *error);

/*
 * The parts of meso_gl_picture(). The first needs no driver: it may run while another thread makes the context, and
 * what finds visibility there (gl_visibility.h) for this picture's size and samples, and detailed where it says so.
 * Into an image whose arrays have their places (meso_image_place()).
 */
bool meso_gl_is_detailed(const MesoScene *scene, const MesoRenderOptions *options);
MesoStatus meso_gl_painter_init(MesoPainter **painter, MesoArena *arena, const MesoScene *scene,
                                const MesoRenderOptions *options, uint32_t thread_count, MesoError *error);
MesoStatus meso_gl_paint(MesoPainter *painter, MesoImage *image, MesoArena *arena, MesoGlVisibility *gl,
                         MesoError *error);

/* Paints the band that begins with this row, and cuts its height to the picture's. MESO_ERR_MEMORY alone. */
MesoStatus meso_paint(MesoPainter *painter, MesoImage *band, uint32_t first_row, MesoError *error);

#endif
