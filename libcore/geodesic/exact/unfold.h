/* Triangles in their plane. */
#ifndef MESO_UNFOLD_H
#define MESO_UNFOLD_H

#include "libcore/mesh/cut/triangulation.h"

/*
 * A half-edge: its length, and where its triangle's third corner lies, along it and to its left; straight on where it
 * has no length, for there any direction is as good.
 */
typedef struct MesoSideShape {
    double length, x, y;
} MesoSideShape;

static inline MesoSideShape meso_side_shape(const MesoTriangulation *mesh, const MesoVec3 *positions, uint32_t h)
{
    MesoVec3 o = positions[mesh->corners[h]], p = positions[mesh->corners[meso_next_corner(h)]];
    MesoVec3 q = positions[mesh->corners[meso_previous_corner(h)]];
    double a[3] = {(double)p.x - o.x, (double)p.y - o.y, (double)p.z - o.z};
    double b[3] = {(double)q.x - o.x, (double)q.y - o.y, (double)q.z - o.z};
    double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    if (!(length > 0))
        return (MesoSideShape){length, sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]), 0};
    return (MesoSideShape){length, (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / length,
                           sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) / length};
}

#endif
