/* Small vectors in double precision, for sums and determinants that floats are too coarse for. */
#ifndef MESO_VEC3D_H
#define MESO_VEC3D_H

#include "libcore/math/vec.h"

typedef struct MesoVec3d {
    double x, y, z;
} MesoVec3d;

static inline MesoVec3d meso_vec3d(MesoVec3 a)
{
    return (MesoVec3d){a.x, a.y, a.z};
}

static inline MesoVec3 meso_vec3d_narrow(MesoVec3d a)
{
    return (MesoVec3){(float)a.x, (float)a.y, (float)a.z};
}

static inline MesoVec3d meso_vec3d_add(MesoVec3d a, MesoVec3d b)
{
    return (MesoVec3d){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline MesoVec3d meso_vec3d_sub(MesoVec3d a, MesoVec3d b)
{
    return (MesoVec3d){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline MesoVec3d meso_vec3d_scale(MesoVec3d a, double s)
{
    return (MesoVec3d){a.x * s, a.y * s, a.z * s};
}

/* a + s * b */
static inline MesoVec3d meso_vec3d_mad(MesoVec3d a, double s, MesoVec3d b)
{
    return (MesoVec3d){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline double meso_vec3d_dot(MesoVec3d a, MesoVec3d b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline MesoVec3d meso_vec3d_cross(MesoVec3d a, MesoVec3d b)
{
    return (MesoVec3d){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double meso_vec3d_length(MesoVec3d a)
{
    return sqrt(meso_vec3d_dot(a, a));
}

/* a . (b x c) */
static inline double meso_vec3d_det(MesoVec3d a, MesoVec3d b, MesoVec3d c)
{
    return meso_vec3d_dot(a, meso_vec3d_cross(b, c));
}

#endif
