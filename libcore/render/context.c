#include "libcore/render/context.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <GL/glcorearb.h>

#include "libcore/render/context_makers.h"

/* Mesa segfaults on a driver name that it does not know, and keeps a shader
 * cache in the user's home unless told not to. */
static void prepare_environment(uint32_t thread_count)
{
    static const char *const known[] = {"llvmpipe", "softpipe"};
    const char *driver = getenv("GALLIUM_DRIVER");
    bool keep = false;
    for (size_t i = 0; driver && i < sizeof known / sizeof *known; i++)
        keep = keep || strcmp(driver, known[i]) == 0;
    if (!keep)
        unsetenv("GALLIUM_DRIVER");
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
    return MESO_OK;
}

static MesoStatus make(MesoGlContext *context, const char *maker, MesoError *error)
{
    if (strcmp(maker, "osmesa") == 0)
        return meso_gl_osmesa_init(context, error);
    if (strcmp(maker, "egl") == 0)
        return meso_gl_egl_init(context, false, error);
    if (strcmp(maker, "auto") != 0)
        return meso_fail(error, MESO_ERR_USAGE, "no GL context maker '%s' (osmesa, egl or auto)", maker);
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
