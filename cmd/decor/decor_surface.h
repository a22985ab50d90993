/* Surfaces of meso-decor: any polygons, as triangles that can be cut, with what a scene shows of them. */
#ifndef MESO_DECOR_SURFACE_H
#define MESO_DECOR_SURFACE_H

#include "cmd/common/tool.h"
#include "libcore/decor/decor_scene.h"

typedef struct MesoDecorSurface {
    MesoPolygonMesh polygons;   /* as the file has them */
    MesoSurface triangles;      /* cut where they have more sides */
    MesoDecorValues values;
    uint32_t vertex_width, corner_width;
} MesoDecorSurface;

/* Reads the operand; `input` must stay open as long as the surface is used. MESO_ERR_INPUT where it is no manifold. */
MesoStatus meso_decor_surface_read(MesoDecorSurface *surface, MesoTool *tool, MesoInput *input, const char *path);

/* A triangulation to work on, with the surface's values. */
MesoStatus meso_decor_surface_start(MesoTriangulation *mesh, const MesoDecorSurface *surface, MesoError *error);

#endif
