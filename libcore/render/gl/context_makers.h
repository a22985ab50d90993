/* The two makers behind context.h; each fills everything but `renderer`. */
#ifndef MESO_CONTEXT_MAKERS_H
#define MESO_CONTEXT_MAKERS_H

#include <stdbool.h>

#include "libcore/render/gl/gl_context.h"

MesoStatus meso_gl_osmesa_init(MesoGlContext *context, MesoError *error);

/* The first GPU that EGL finds; where there is none, a software driver unless `gpu_only`. */
MesoStatus meso_gl_egl_init(MesoGlContext *context, bool gpu_only, MesoError *error);

#endif
