/* Areas of a triangulation's triangles. */
#ifndef MESO_TRIANGLE_AREA_H
#define MESO_TRIANGLE_AREA_H

#include "libcore/mesh/cut/triangulation.h"

/* In double precision. */
static inline double meso_triangle_area(const MesoTriangulation *mesh, uint32_t triangle)
{
    const uint32_t *c = &mesh->corners[3 * (size_t)triangle];
    MesoVec3 a = mesh->positions[c[0]], b = mesh->positions[c[1]], d = mesh->positions[c[2]];
    double ux = (double)b.x - a.x, uy = (double)b.y - a.y, uz = (double)b.z - a.z;
    double vx = (double)d.x - a.x, vy = (double)d.y - a.y, vz = (double)d.z - a.z;
    double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    return 0.5 * sqrt(x * x + y * y + z * z);
}

#endif
