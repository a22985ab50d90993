/* Quilts carried from one surface to another by texture coordinates that both have. */
#ifndef MESO_QUILT_TRANSFER_H
#define MESO_QUILT_TRANSFER_H

#include "libcore/quilt/quilt.h"

/* A surface in the plane of its texture: finite coordinates of the corners of its triangles. */
typedef struct MesoTextureMesh {
    uint32_t triangle_count;
    const MesoVec2 *corner_uvs;     /* [3 * triangle_count] */
} MesoTextureMesh;

/*
 * The vertices of a quilt over `from` come to lie over the triangle of `to` that has their texture coordinates, with
 * weights there; heights stay. Vertices beyond a border of `from` are as far beyond that of `to`. Close to borders that
 * differ, up to half a triangle of `to`, its nearest triangle is taken.
 *
 * MESO_ERR_INPUT, and the triangle of `to` that it is about, or MESO_NO_INDEX, in `fault`, where no triangle has the
 * coordinates of a vertex, where two have them, or where one that has is turned over against that of `from`. The quilt
 * is left half carried then. O(vertices + triangles), where triangles are of about one size. MESO_ERR_MEMORY.
 */
MesoStatus meso_quilt_transfer(MesoQuilt *quilt, const MesoTextureMesh *from, const MesoTextureMesh *to,
                               uint32_t *fault, MesoError *error);

#endif
