/* What GL_RENDERER tells of a driver. */
#ifndef MESO_RENDERER_NAME_H
#define MESO_RENDERER_NAME_H

#include <stdbool.h>
#include <string.h>

/* True for the GL_RENDERER of a driver that draws on the CPU. */
static inline bool meso_gl_is_software(const char *renderer)
{
    static const char *const names[] = {"llvmpipe", "softpipe", "swrast", "SWR", "Software"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strstr(renderer, names[i]))
            return true;
    return false;
}

#endif
