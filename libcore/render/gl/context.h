/*
 * GL 4.5 core contexts without a window behind one interface with two makers:
 * OSMesa (software, everywhere) and EGL surfaceless (GPU drivers). No other
 * file knows either.
 */
#ifndef MESO_CONTEXT_H
#define MESO_CONTEXT_H

#include <stdint.h>

#include "libcore/render/gl/gl_context.h"

/*
 * `maker` is "osmesa", "egl", "gpu" (a GPU that egl offers) or "auto" (gpu
 * where there is one, else osmesa). The context is current on this thread. `thread_count` bounds the
 * threads of a software driver (0: its own choice). The environment of this
 * process is emptied, but for where drivers are installed, so that it changes
 * no pixel; no other thread may read it meanwhile.
 * MESO_ERR_USAGE for another maker, MESO_ERR_INTERNAL where none can be made.
 */
MesoStatus meso_gl_context_init(MesoGlContext *context, const char *maker, uint32_t thread_count,
                                MesoError *error);
void meso_gl_context_release(MesoGlContext *context);

#endif
