/* A GL context, whichever maker it has. */
#ifndef MESO_GL_CONTEXT_H
#define MESO_GL_CONTEXT_H

#include <stdbool.h>

#include "libcore/base/error.h"

typedef struct MesoGlContext {
    void *native;
    void (*release)(struct MesoGlContext *context);
    void *(*find)(const char *name);    /* a GL function by its name */
    char renderer[128];                 /* GL_RENDERER */
    bool bends;                         /* shaders are to bend sweeps: it draws on a GPU */
} MesoGlContext;

#endif
