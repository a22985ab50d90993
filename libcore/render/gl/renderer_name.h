/* What GL_RENDERER tells of a driver. */
#ifndef MESO_RENDERER_NAME_H
#define MESO_RENDERER_NAME_H

#include <stdbool.h>
#include <string.h>
#include <strings.h>

/* True for the GL_RENDERER of a driver that draws on the CPU, or of one that stands before it. */
static inline bool meso_gl_is_software(const char *renderer)
{
    static const char *const names[] = {"llvmpipe", "softpipe", "swrast", "swr", "software", "basic render"};
    for (const char *at = renderer; *at; at++)
        for (size_t i = 0; i < sizeof names / sizeof *names; i++)
            if (strncasecmp(at, names[i], strlen(names[i])) == 0)
                return true;
    return false;
}

#endif
