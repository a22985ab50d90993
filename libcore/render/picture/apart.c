#include "libcore/render/picture/apart.h"

#include <pthread.h>
#include <string.h>

#include "libcore/base/clock.h"
#include "libcore/base/kept_memory.h"
#include "libcore/render/gl/context.h"
#include "libcore/render/gl/gl_visibility.h"
#include "libcore/render/isolate.h"
#include "libcore/render/picture/painter.h"

/*
 * What a software driver takes: its tables, the code that it compiles, and the stacks of its threads; some 130 MB
 * are measured. Where there is less, its end is a matter of luck, and so nothing is begun: it may die, and might
 * draw something else.
 */
enum { DRIVER_BYTES = 192 << 20 };

/* The arrays of the image follow the head. */
enum { HEAD_BYTES = (sizeof(MesoApartPicture) + 63) / 64 * 64 };

typedef struct Work {
    MesoApartPicture *picture;
    MesoArena *arena;
    const char *maker;
    uint32_t thread_count;
    const MesoScene *scene;
    const MesoRenderOptions *options;
} Work;

/* What needs no driver, which is made ready beside it. */
typedef struct Ready {
    const Work *work;
    MesoPainter *painter;
    MesoStatus status;
    MesoError error;
} Ready;

static void *get_ready(void *pointer)
{
    Ready *ready = pointer;
    const Work *work = ready->work;
    ready->status = meso_gl_painter_init(&ready->painter, work->arena, work->scene, work->options, work->thread_count,
                                         &ready->error);
    meso_shared_fill(work->picture, work->picture->size);
    return NULL;
}

static MesoStatus make_visibility(MesoGlVisibility **gl, const Work *work, MesoError *error)
{
    MesoGlContext context;
    const MesoRenderOptions *options = work->options;
    MesoStatus status = meso_gl_context_init(&context, work->maker, work->thread_count, error);
    if (status)
        return status;
    work->picture->context_made = meso_seconds();
    memcpy(work->picture->renderer, context.renderer, sizeof context.renderer);
    return meso_gl_visibility_init(gl, &context, options->width, options->height, options->samples,
                                   meso_gl_is_detailed(work->scene, options), error);
}

/* The context, and what is in it, is left to the end of the process, which is at hand. */
static MesoStatus draw(void *pointer, MesoError *error)
{
    const Work *work = pointer;
    Ready ready = {.work = work};
    MesoGlVisibility *gl = NULL;
    pthread_t thread;
    meso_kept_memory_more();
    bool beside = pthread_create(&thread, NULL, get_ready, &ready) == 0;
    MesoStatus status = make_visibility(&gl, work, error);
    if (beside)
        pthread_join(thread, NULL);
    else
        get_ready(&ready);
    if (!status && ready.status) {
        status = ready.status;
        if (error)
            *error = ready.error;
    }
    return status ? status : meso_gl_paint(ready.painter, &work->picture->image, work->arena, gl, error);
}

MesoStatus meso_apart_picture_init(MesoApartPicture **picture, MesoArena *arena, const char *maker,
                             uint32_t thread_count, const MesoScene *scene,
                             const MesoRenderOptions *options, MesoError *error)
{
    *picture = NULL;
    MesoStatus status = meso_render_check(options, error);
    if (status)
        return status;
    size_t size = HEAD_BYTES + meso_image_bytes(scene, options);
    MesoApartPicture *result = meso_shared_new(size, error);
    if (!result)
        return MESO_ERR_MEMORY;
    result->size = size;
    meso_image_place(&result->image, (unsigned char *)result + HEAD_BYTES, scene, options);

    Work work = {result, arena, maker, thread_count, scene, options};
    size_t need = DRIVER_BYTES + meso_gl_window_bytes(options->width, options->height, options->samples);
    status = meso_isolate("drawing", draw, &work, need, error);
    if (status) {
        meso_apart_picture_release(result);
        return status;
    }
    *picture = result;
    return MESO_OK;
}

void meso_apart_picture_release(MesoApartPicture *picture)
{
    if (picture)
        meso_shared_free(picture, picture->size);
}
