#include "libcore/render/apart.h"

#include <string.h>

#include "libcore/base/clock.h"
#include "libcore/render/isolate.h"

/*
 * What a software driver takes: its tables, the code that it compiles, and the stacks of its threads; some 130 MB
 * are measured. Where there is less, its end is a matter of luck, and so nothing is begun: it may die, and might
 * draw something else.
 */
enum { DRIVER_BYTES = 192 << 20 };

/* The arrays of the image follow the head. */
enum { HEAD_BYTES = (sizeof(MesoPicture) + 63) / 64 * 64 };

typedef struct Work {
    MesoPicture *picture;
    MesoArena *arena;
    const char *maker;
    uint32_t thread_count;
    const MesoScene *scene;
    const MesoRenderOptions *options;
} Work;

/* The context is left to the end of the process, which is at hand. */
static MesoStatus draw(void *pointer, MesoError *error)
{
    const Work *work = pointer;
    MesoGlContext context;
    MesoStatus status = meso_gl_context_init(&context, work->maker, work->thread_count, error);
    if (status)
        return status;
    work->picture->context_made = meso_seconds();
    memcpy(work->picture->renderer, context.renderer, sizeof context.renderer);
    return meso_render_placed(&work->picture->image, work->arena, &context, work->scene,
                              work->options, error);
}

MesoStatus meso_picture_init(MesoPicture **picture, MesoArena *arena, const char *maker,
                             uint32_t thread_count, const MesoScene *scene,
                             const MesoRenderOptions *options, MesoError *error)
{
    size_t image_bytes, least_bytes;
    *picture = NULL;
    MesoStatus status = meso_render_memory(scene, options, &image_bytes, &least_bytes, error);
    if (status)
        return status;
    size_t size = HEAD_BYTES + image_bytes;
    MesoPicture *result = meso_shared_new(size, error);
    if (!result)
        return MESO_ERR_MEMORY;
    result->size = size;
    meso_image_place(&result->image, (unsigned char *)result + HEAD_BYTES, scene, options);

    Work work = {result, arena, maker, thread_count, scene, options};
    status = meso_isolate("drawing", draw, &work, DRIVER_BYTES + least_bytes, error);
    if (status) {
        meso_picture_release(result);
        return status;
    }
    *picture = result;
    return MESO_OK;
}

void meso_picture_release(MesoPicture *picture)
{
    if (picture)
        meso_shared_free(picture, picture->size);
}
