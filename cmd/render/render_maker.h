/* Who finds what is seen: tiles, or GL, and whose context it has. */
#ifndef MESO_RENDER_MAKER_H
#define MESO_RENDER_MAKER_H

#include "cmd/render/render_arguments.h"

typedef struct MesoRenderMaker {
    const char *context;        /* of GL, as of meso_gl_context_init(); NULL: tiles */
    bool tried;                 /* a GPU is tried: where it draws no picture, tiles do */
    const char *why;            /* tiles where a GPU might have drawn; NULL: nobody asked */
} MesoRenderMaker;

/* Whether some GPU has a node among those of `folder`, such as /dev, that this process may use. Opens no driver. */
bool meso_gpu_is_there(const char *folder);

/*
 * Whom the arguments ask for: auto takes a GPU where there may be one, and nothing wants tiles. `held`: the scene and
 * the picture are held in memory as GL has them.
 */
MesoRenderMaker meso_render_maker(const MesoRenderArguments *a, bool held);

/* Whether the arguments ask for GL by its name. */
bool meso_render_wants_gl(const MesoRenderArguments *a);

#endif
