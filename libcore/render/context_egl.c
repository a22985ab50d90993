#include <stdlib.h>
#include <string.h>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include "libcore/render/context_makers.h"
#include "libcore/render/renderer_name.h"

enum { MAX_DEVICES = 32 };

typedef struct Native {
    EGLDisplay display;
    EGLContext context;
} Native;

static void *find(const char *name)
{
    union {
        void (*function)(void);
        void *pointer;
    } result = {eglGetProcAddress(name)};
    return result.pointer;
}

static void close_display(const Native *native)
{
    eglMakeCurrent(native->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(native->display, native->context);
    /* The driver leaves some bytes behind; unloaded, it could not be named to the leak checker. */
#if !defined(__SANITIZE_ADDRESS__)
    eglTerminate(native->display);
#endif
}

static void release(MesoGlContext *context)
{
    close_display(context->native);
    free(context->native);
}

/* A current GL 4.5 core context on `display`, or false with nothing left behind. */
static bool open_display(Native *native, EGLDisplay display)
{
    static const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
        EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};

    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL))
        return false;
    EGLContext context = EGL_NO_CONTEXT;
    if (eglBindAPI(EGL_OPENGL_API))
        context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context != EGL_NO_CONTEXT) {
        if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
            *native = (Native){display, context};
            return true;
        }
        eglDestroyContext(display, context);
    }
    eglTerminate(display);
    return false;
}

static bool draws_on_cpu(void)
{
    PFNGLGETSTRINGPROC get_string = (PFNGLGETSTRINGPROC)find("glGetString");
    const GLubyte *name = get_string ? get_string(GL_RENDERER) : NULL;
    return !name || meso_gl_is_software((const char *)name);
}

/* The first device whose driver is a GPU's. */
static bool open_gpu(Native *native, PFNEGLGETPLATFORMDISPLAYEXTPROC get_display)
{
    PFNEGLQUERYDEVICESEXTPROC query_devices =
        (PFNEGLQUERYDEVICESEXTPROC)find("eglQueryDevicesEXT");
    PFNEGLQUERYDEVICESTRINGEXTPROC query_string =
        (PFNEGLQUERYDEVICESTRINGEXTPROC)find("eglQueryDeviceStringEXT");
    EGLDeviceEXT devices[MAX_DEVICES];
    EGLint count = 0;
    if (!query_devices || !query_string || !query_devices(MAX_DEVICES, devices, &count))
        return false;

    for (EGLint i = 0; i < count; i++) {
        const char *extensions = query_string(devices[i], EGL_EXTENSIONS);
        if (extensions && strstr(extensions, "EGL_MESA_device_software"))
            continue;
        if (!open_display(native, get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL)))
            continue;
        if (!draws_on_cpu())
            return true;
        close_display(native);
    }
    return false;
}

/* A GPU's context, or unless `gpu_only` that of a software driver. */
static bool open_any(Native *native, bool gpu_only)
{
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)find("eglGetPlatformDisplayEXT");
    if (!get_display)
        return false;
    return open_gpu(native, get_display)
        || (!gpu_only && open_display(native, get_display(EGL_PLATFORM_SURFACELESS_MESA,
                                                          EGL_DEFAULT_DISPLAY, NULL)));
}

MesoStatus meso_gl_egl_init(MesoGlContext *context, bool gpu_only, MesoError *error)
{
    Native *native = malloc(sizeof *native);
    if (!native)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: GL context");
    bool opened = open_any(native, gpu_only);
    if (!opened) {
        free(native);
        return meso_fail(error, MESO_ERR_INTERNAL, "EGL has no GL 4.5 core context without a window");
    }
    context->native = native;
    context->release = release;
    context->find = find;
    return MESO_OK;
}
