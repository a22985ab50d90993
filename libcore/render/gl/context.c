#define _DEFAULT_SOURCE     /* clearenv() */
#include "libcore/render/gl/context.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <GL/glcorearb.h>

#include "libcore/render/gl/context_makers.h"
#include "libcore/render/gl/renderer_name.h"

/*
 * Mesa and other drivers read some hundred variables, under names of no one
 * form, that change pixels, print, or kill them. So only those stay that say where
 * drivers are installed. No shader cache is kept in the user's home.
 */
static void prepare_environment(uint32_t thread_count)
{
    static const char *const kept[] = {"LIBGL_DRIVERS_PATH", "__EGL_VENDOR_LIBRARY_DIRS",
                                       "__EGL_VENDOR_LIBRARY_FILENAMES"};
    enum { KEPT_COUNT = sizeof kept / sizeof *kept };
    const char *values[KEPT_COUNT];
    for (size_t i = 0; i < KEPT_COUNT; i++)
        values[i] = getenv(kept[i]);
    clearenv();
    for (size_t i = 0; i < KEPT_COUNT; i++)
        if (values[i])
            setenv(kept[i], values[i], 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "1", 1);
    if (thread_count) {
        char text[16];
        snprintf(text, sizeof text, "%u", thread_count);
        setenv("LP_NUM_THREADS", text, 1);
    }
}

static MesoStatus read_renderer(MesoGlContext *context, MesoError *error)
{
    PFNGLGETSTRINGPROC get_string = (PFNGLGETSTRINGPROC)context->find("glGetString");
    const GLubyte *name = get_string ? get_string(GL_RENDERER) : NULL;
    if (!name)
        return meso_fail(error, MESO_ERR_INTERNAL, "GL context without a renderer's name");
    snprintf(context->renderer, sizeof context->renderer, "%s", (const char *)name);
    context->bends = !meso_gl_is_software(context->renderer);
    return MESO_OK;
}

static MesoStatus make(MesoGlContext *context, const char *maker, MesoError *error)
{
    if (strcmp(maker, "osmesa") == 0)
        return meso_gl_osmesa_init(context, error);
    if (strcmp(maker, "egl") == 0)
        return meso_gl_egl_init(context, false, error);
    if (strcmp(maker, "gpu") == 0)
        return meso_gl_egl_init(context, true, error);
    if (strcmp(maker, "auto") != 0)
        return meso_fail(error, MESO_ERR_USAGE, "no GL context maker '%s' (osmesa, egl, gpu or auto)", maker);
    if (meso_gl_egl_init(context, true, NULL) == MESO_OK)
        return MESO_OK;
    return meso_gl_osmesa_init(context, error);
}

MesoStatus meso_gl_context_init(MesoGlContext *context, const char *maker, uint32_t thread_count,
                                MesoError *error)
{
    *context = (MesoGlContext){0};
    prepare_environment(thread_count);
    MesoStatus status = make(context, maker, error);
    if (status)
        return status;
    status = read_renderer(context, error);
    if (status)
        meso_gl_context_release(context);
    return status;
}

void meso_gl_context_release(MesoGlContext *context)
{
    if (context->release)
        context->release(context);
    *context = (MesoGlContext){0};
}
