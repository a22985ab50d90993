#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include "libcore/render/gl/context_makers.h"
#include "libcore/render/gl/driver_library.h"
#include "libcore/render/gl/renderer_name.h"

enum { MAX_DEVICES = 32 };

typedef struct Native {
    EGLDisplay display;
    EGLContext context;
} Native;

static struct {
    __typeof__(eglGetProcAddress) *get_proc_address;
    __typeof__(eglMakeCurrent) *make_current;
    __typeof__(eglDestroyContext) *destroy_context;
    __typeof__(eglTerminate) *terminate;
    __typeof__(eglInitialize) *initialize;
    __typeof__(eglBindAPI) *bind_api;
    __typeof__(eglCreateContext) *create_context;
    __typeof__(eglGetError) *get_error;
} egl;

static MesoStatus load(MesoError *error)
{
    const MesoDriverFunction functions[] = {
        {"eglGetProcAddress", &egl.get_proc_address}, {"eglMakeCurrent", &egl.make_current},
        {"eglDestroyContext", &egl.destroy_context}, {"eglTerminate", &egl.terminate},
        {"eglInitialize", &egl.initialize}, {"eglBindAPI", &egl.bind_api},
        {"eglCreateContext", &egl.create_context}, {"eglGetError", &egl.get_error},
    };
    return meso_driver_library("libEGL.so.1", functions, sizeof functions / sizeof *functions, error);
}

/* What was tried, and what each said: the end of a message. */
typedef struct Log {
    char text[400];
    size_t used;
} Log;

__attribute__((format(printf, 2, 3))) static void note(Log *log, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int written = vsnprintf(log->text + log->used, sizeof log->text - log->used, format, arguments);
    va_end(arguments);
    log->used += written > 0 ? (size_t)written : 0;
    if (log->used >= sizeof log->text)
        log->used = sizeof log->text - 1;
}

static const char *egl_words(EGLint code)
{
    static const char *const words[] = {"nothing wrong", "not initialized", "bad access", "bad alloc", "bad attribute",
                                        "bad config", "bad context", "bad current surface", "bad display", "bad match",
                                        "bad native pixmap", "bad native window", "bad parameter", "bad surface",
                                        "context lost"};
    EGLint number = code - EGL_SUCCESS;
    return number >= 0 && number < (EGLint)(sizeof words / sizeof *words) ? words[number] : "an unknown error";
}

/* `call` failed. */
static bool fail_with(Log *log, const char *call)
{
    note(log, "%s said %s", call, egl_words(egl.get_error()));
    return false;
}

static void *find(const char *name)
{
    union {
        void (*function)(void);
        void *pointer;
    } result = {egl.get_proc_address(name)};
    return result.pointer;
}

static void close_display(const Native *native)
{
    egl.make_current(native->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl.destroy_context(native->display, native->context);
    /* The driver leaves some bytes behind; unloaded, it could not be named to the leak checker. */
#if !defined(__SANITIZE_ADDRESS__)
    egl.terminate(native->display);
#endif
}

static void release(MesoGlContext *context)
{
    close_display(context->native);
    free(context->native);
}

/* A current GL 4.5 core context on `display`, or false with nothing left behind and the reason noted. */
static bool open_display(Native *native, EGLDisplay display, Log *log)
{
    static const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
        EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};

    if (display == EGL_NO_DISPLAY)
        return fail_with(log, "eglGetPlatformDisplay");
    if (!egl.initialize(display, NULL, NULL))
        return fail_with(log, "eglInitialize");
    EGLContext context = EGL_NO_CONTEXT;
    if (!egl.bind_api(EGL_OPENGL_API))
        fail_with(log, "eglBindAPI");
    else if ((context = egl.create_context(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes)) == EGL_NO_CONTEXT)
        fail_with(log, "eglCreateContext of GL 4.5 core");
    else if (!egl.make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        fail_with(log, "eglMakeCurrent without a surface");
    else {
        *native = (Native){display, context};
        return true;
    }
    if (context != EGL_NO_CONTEXT)
        egl.destroy_context(display, context);
    egl.terminate(display);
    return false;
}

/* Its name; NULL where it has none. */
static const char *renderer_now(void)
{
    PFNGLGETSTRINGPROC get_string = (PFNGLGETSTRINGPROC)find("glGetString");
    return get_string ? (const char *)get_string(GL_RENDERER) : NULL;
}

/* The first device whose driver is a GPU's. */
static bool open_gpu(Native *native, PFNEGLGETPLATFORMDISPLAYEXTPROC get_display, Log *log)
{
    PFNEGLQUERYDEVICESEXTPROC query_devices =
        (PFNEGLQUERYDEVICESEXTPROC)find("eglQueryDevicesEXT");
    PFNEGLQUERYDEVICESTRINGEXTPROC query_string =
        (PFNEGLQUERYDEVICESTRINGEXTPROC)find("eglQueryDeviceStringEXT");
    EGLDeviceEXT devices[MAX_DEVICES];
    EGLint count = 0;
    if (!query_devices || !query_string || !query_devices(MAX_DEVICES, devices, &count)) {
        note(log, "; EGL lists no devices");
        return false;
    }

    for (EGLint i = 0; i < count; i++) {
        const char *extensions = query_string(devices[i], EGL_EXTENSIONS), *name;
        note(log, "; device %d of %d: ", i, count);
        if (extensions && strstr(extensions, "EGL_MESA_device_software")) {
            note(log, "software");
            continue;
        }
        if (!open_display(native, get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL), log))
            continue;
        name = renderer_now();
        if (name && !meso_gl_is_software(name))
            return true;
        note(log, "%s draws on the CPU", name ? name : "a driver without a name");
        close_display(native);
    }
    if (count == 0)
        note(log, "; there is no device");
    return false;
}

/* A GPU's context, or unless `gpu_only` that of a software driver. */
static bool open_any(Native *native, bool gpu_only, Log *log)
{
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)find("eglGetPlatformDisplayEXT");
    if (!get_display) {
        note(log, "; it has no eglGetPlatformDisplayEXT");
        return false;
    }
    if (open_gpu(native, get_display, log))
        return true;
    if (gpu_only)
        return false;
    note(log, "; surfaceless: ");
    return open_display(native, get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL), log);
}

MesoStatus meso_gl_egl_init(MesoGlContext *context, bool gpu_only, MesoError *error)
{
    MesoStatus status = load(error);
    if (status)
        return status;
    Native *native = malloc(sizeof *native);
    if (!native)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: GL context");
    Log log = {.used = 0};
    bool opened = open_any(native, gpu_only, &log);
    if (!opened) {
        free(native);
        return meso_fail(error, MESO_ERR_INTERNAL, "EGL has no GL 4.5 core context without a window%s", log.text);
    }
    context->native = native;
    context->release = release;
    context->find = find;
    return MESO_OK;
}
