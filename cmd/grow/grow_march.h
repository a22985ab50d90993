/* How steps of meso-grow go over the surface: straight on, or through the texels of an atlas. */
#ifndef MESO_GROW_MARCH_H
#define MESO_GROW_MARCH_H

#include "cmd/grow/grow_surface.h"
#include "libcore/growth/engine/growth.h"
#include "libcore/growth/march/texture_march.h"

typedef struct MesoGrowMarch {
    MesoGeometryImage image;
    MesoTextureMarch texture;
    MesoGrowthMarch march;      /* `walk` is NULL where it is straight on */
} MesoGrowMarch;

/* By --march, --atlas and --texels. The march, which stays where it is, and the surface go together. */
MesoStatus meso_grow_march_init(MesoGrowMarch *march, MesoGrowArguments *arguments, const MesoGrowSurface *surface);

#endif
