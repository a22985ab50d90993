/*
 * GL 4.5 core contexts without a window behind one interface with two makers:
 * OSMesa (software, everywhere) and EGL surfaceless (GPU drivers). No other
 * file knows either.
 */
#ifndef MESO_CONTEXT_H
#define MESO_CONTEXT_H

#include "libcore/base/error.h"

typedef struct MesoGlContext {
    void *native;
    void (*release)(struct MesoGlContext *context);
    void *(*find)(const char *name);    /* a GL function by its name */
    char renderer[128];                 /* GL_RENDERER */
} MesoGlContext;

/* `maker` is "osmesa", "egl" or "auto" (egl where it offers a GPU, else osmesa). Current on this thread. */
MesoStatus meso_gl_context_init(MesoGlContext *context, const char *maker, MesoError *error);
void meso_gl_context_release(MesoGlContext *context);

#endif
