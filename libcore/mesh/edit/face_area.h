/* Areas of polygons as vectors, in double precision. */
#ifndef MESO_FACE_AREA_H
#define MESO_FACE_AREA_H

#include "libcore/mesh/polygon_mesh.h"

typedef struct MesoAreaVector {
    double x, y, z;
} MesoAreaVector;

static inline MesoAreaVector meso_area_between(MesoVec3 o, MesoVec3 p, MesoVec3 q)
{
    double ax = (double)p.x - o.x, ay = (double)p.y - o.y, az = (double)p.z - o.z;
    double bx = (double)q.x - o.x, by = (double)q.y - o.y, bz = (double)q.z - o.z;
    return (MesoAreaVector){ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx};
}

/*
 * Twice the area vector of a face: the sum of the cross products of its fan. Along its normal, as long as twice the
 * area of its shadow on the plane across it.
 */
static inline MesoAreaVector meso_face_area(const MesoPolygonMesh *mesh, uint32_t face)
{
    uint32_t begin = meso_polygon_begin(mesh, face), end = begin + meso_polygon_sides(mesh, face);
    MesoAreaVector sum = {0, 0, 0};
    for (uint32_t c = begin + 1; c + 1 < end; c++) {
        MesoAreaVector a = meso_area_between(mesh->positions[mesh->corners[begin]], mesh->positions[mesh->corners[c]],
                                             mesh->positions[mesh->corners[c + 1]]);
        sum = (MesoAreaVector){sum.x + a.x, sum.y + a.y, sum.z + a.z};
    }
    return sum;
}

static inline double meso_area_dot(MesoAreaVector a, MesoAreaVector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Six times the volume of the cone from a face to `o`; over a closed surface, six times the enclosed volume. */
static inline double meso_face_volume(const MesoPolygonMesh *mesh, uint32_t face, MesoVec3 o)
{
    MesoVec3 p = mesh->positions[mesh->corners[meso_polygon_begin(mesh, face)]];
    MesoAreaVector to = {(double)p.x - o.x, (double)p.y - o.y, (double)p.z - o.z};
    return meso_area_dot(meso_face_area(mesh, face), to);
}

#endif
