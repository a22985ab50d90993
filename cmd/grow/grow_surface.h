/* Surfaces of meso-grow: any polygons, as triangles to walk over. */
#ifndef MESO_GROW_SURFACE_H
#define MESO_GROW_SURFACE_H

#include "cmd/grow/grow_arguments.h"
#include "libcore/growth/ground/growth_ground.h"

typedef struct MesoGrowSurface {
    MesoPolygonMesh polygons;       /* triangles; attributes of faces, vertices and corners are kept */
    MesoTriangulation mesh;         /* owned, with `origins` and `faces` by `polygons` */
    MesoGrowthGround ground;
} MesoGrowSurface;

/* `input` must stay open as long as the surface is used. MESO_ERR_INPUT where it is no manifold. */
MesoStatus meso_grow_surface_read(MesoGrowSurface *surface, MesoGrowArguments *arguments, MesoInput *input,
                                  const char *path);

void meso_grow_surface_release(MesoGrowSurface *surface);

#endif
