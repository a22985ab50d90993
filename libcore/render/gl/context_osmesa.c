#include <stdlib.h>

#include <GL/osmesa.h>

#include "libcore/render/gl/context_makers.h"
#include "libcore/render/gl/driver_library.h"

/* Mesa's LLVM keeps 200 to 320 bytes a context to the end. */
#if defined(__SANITIZE_ADDRESS__)
const char *__lsan_default_options(void);
const char *__lsan_default_options(void)
{
    return "print_suppressions=0";
}

const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libLLVM\nleak:libOSMesa\nleak:libEGL\nleak:libgallium\nleak:swrast_dri\nleak:libglapi\n";
}
#endif

enum { DUMMY_SIZE = 16 };

static struct {
    __typeof__(OSMesaCreateContextAttribs) *create;
    __typeof__(OSMesaMakeCurrent) *make_current;
    __typeof__(OSMesaDestroyContext) *destroy;
    __typeof__(OSMesaGetProcAddress) *find;
} mesa;

static MesoStatus load(MesoError *error)
{
    const MesoDriverFunction functions[] = {
        {"OSMesaCreateContextAttribs", &mesa.create}, {"OSMesaMakeCurrent", &mesa.make_current},
        {"OSMesaDestroyContext", &mesa.destroy}, {"OSMesaGetProcAddress", &mesa.find}};
    return meso_driver_library("libOSMesa.so.8", functions, sizeof functions / sizeof *functions, error);
}

/* Everything is drawn to framebuffer objects; OSMesa still wants a buffer of its own. */
typedef struct Native {
    OSMesaContext context;
    unsigned char dummy[4 * DUMMY_SIZE * DUMMY_SIZE];
} Native;

static void release(MesoGlContext *context)
{
    Native *native = context->native;
    mesa.make_current(NULL, NULL, 0, 0, 0);
    mesa.destroy(native->context);
    free(native);
}

static void *find(const char *name)
{
    union {
        OSMESAproc function;
        void *pointer;
    } result = {mesa.find(name)};
    return result.pointer;
}

MesoStatus meso_gl_osmesa_init(MesoGlContext *context, MesoError *error)
{
    static const int attributes[] = {
        OSMESA_FORMAT, OSMESA_RGBA, OSMESA_PROFILE, OSMESA_CORE_PROFILE,
        OSMESA_CONTEXT_MAJOR_VERSION, 4, OSMESA_CONTEXT_MINOR_VERSION, 5, 0};

    MesoStatus status = load(error);
    if (status)
        return status;
    Native *native = calloc(1, sizeof *native);
    if (!native)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: GL context");
    native->context = mesa.create(attributes, NULL);
    if (!native->context) {
        free(native);
        return meso_fail(error, MESO_ERR_INTERNAL, "OSMesa has no GL 4.5 core context");
    }
    if (!mesa.make_current(native->context, native->dummy, GL_UNSIGNED_BYTE, DUMMY_SIZE, DUMMY_SIZE)) {
        mesa.destroy(native->context);
        free(native);
        return meso_fail(error, MESO_ERR_INTERNAL, "OSMesa cannot make its GL context current");
    }
    context->native = native;
    context->release = release;
    context->find = find;
    return MESO_OK;
}
