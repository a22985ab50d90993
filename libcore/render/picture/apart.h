/* A picture drawn in a process of its own, for drivers that die where memory is short. */
#ifndef MESO_APART_H
#define MESO_APART_H

#include "libcore/render/image.h"

typedef struct MesoApartPicture {
    MesoImage image;
    char renderer[128];         /* GL_RENDERER */
    double context_made;        /* when drawing began: seconds of the monotonic clock */
    size_t size;                /* of the whole, which is shared memory */
} MesoApartPicture;

/*
 * meso_gl_picture() in a child of this process (isolate.h), with a context that
 * meso_gl_context_init() makes there: this process opens no GL, and keeps its
 * environment. `arena` is scratch. What they return; also MESO_ERR_MEMORY
 * where memory is short before drawing or at the driver's death, and
 * MESO_ERR_INTERNAL where it dies otherwise.
 */
MesoStatus meso_apart_picture_init(MesoApartPicture **picture, MesoArena *arena, const char *maker,
                             uint32_t thread_count, const MesoScene *scene,
                             const MesoRenderOptions *options, MesoError *error);
void meso_apart_picture_release(MesoApartPicture *picture);

#endif
