/* Surfaces of meso-quilt: any polygons as triangles, or a plane. */
#ifndef MESO_QUILT_SURFACE_H
#define MESO_QUILT_SURFACE_H

#include "cmd/quilt/quilt_arguments.h"
#include "formats/quilt/quilt_move.h"

typedef struct MesoQuiltSurface {
    MesoPolygonMesh polygons;       /* triangles; attributes of faces, vertices and corners are kept */
    MesoSurfaceMark mark;           /* of what the file has */
    MesoTriangulation base;         /* owned, with `origins` and `faces` by `polygons` */
    MesoVec2 *uvs;                  /* [3 * base.triangle_count] by corner of the base; NULL: it has none */
    MesoVec3 *guide;                /* [base.triangle_count], or NULL */
    float longest_side;             /* of the box around it */
} MesoQuiltSurface;

/* MESO_ERR_USAGE where --plane is given and is no two lengths. */
MesoStatus meso_quilt_plane_check(MesoQuiltArguments *arguments);

/*
 * By --plane, or from the operand `path`; `input` must stay open as long as the surface is used. MESO_ERR_INPUT where
 * it is no manifold, or neighbours are wound against each other.
 */
MesoStatus meso_quilt_surface_read(MesoQuiltSurface *surface, MesoQuiltArguments *arguments, MesoInput *input,
                                   const char *path);

void meso_quilt_surface_release(MesoQuiltSurface *surface);

#endif
