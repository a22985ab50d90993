/*
 * Eight floats at once, by the compiler's own vectors, which makes them of what the machine has. Each operation is that
 * of a float, lane by lane, and so are the results. All is to be inlined, also in functions for machines with wide
 * vectors.
 */
#ifndef MESO_LANES_H
#define MESO_LANES_H

#include <stdint.h>

enum { MESO_LANES = 8 };

typedef float MesoLanes __attribute__((vector_size(32)));
typedef int32_t MesoLaneBits __attribute__((vector_size(32)));

#define MESO_LANES_INLINE static inline __attribute__((always_inline))

MESO_LANES_INLINE MesoLanes meso_lanes_all(float a)
{
    return (MesoLanes){a, a, a, a, a, a, a, a};
}

MESO_LANES_INLINE MesoLanes meso_lanes_choose(MesoLaneBits which, MesoLanes a, MesoLanes b)
{
    return (MesoLanes)((which & (MesoLaneBits)a) | (~which & (MesoLaneBits)b));
}

MESO_LANES_INLINE MesoLanes meso_lanes_most(MesoLanes a, MesoLanes b)
{
    return meso_lanes_choose(a > b, a, b);
}

MESO_LANES_INLINE MesoLanes meso_lanes_root(MesoLanes a)
{
    MesoLanes root = a;
    for (uint32_t lane = 0; lane < MESO_LANES; lane++)
        root[lane] = __builtin_sqrtf(a[lane]);
    return root;
}

/* ---- vectors in space ---- */

typedef struct MesoLanes3 {
    MesoLanes x, y, z;
} MesoLanes3;

MESO_LANES_INLINE MesoLanes3 meso_lanes3_add(MesoLanes3 a, MesoLanes3 b)
{
    return (MesoLanes3){a.x + b.x, a.y + b.y, a.z + b.z};
}

MESO_LANES_INLINE MesoLanes3 meso_lanes3_sub(MesoLanes3 a, MesoLanes3 b)
{
    return (MesoLanes3){a.x - b.x, a.y - b.y, a.z - b.z};
}

MESO_LANES_INLINE MesoLanes3 meso_lanes3_scale(MesoLanes3 a, MesoLanes s)
{
    return (MesoLanes3){a.x * s, a.y * s, a.z * s};
}

/* a + s * b */
MESO_LANES_INLINE MesoLanes3 meso_lanes3_mad(MesoLanes3 a, MesoLanes s, MesoLanes3 b)
{
    return (MesoLanes3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

MESO_LANES_INLINE MesoLanes meso_lanes3_dot(MesoLanes3 a, MesoLanes3 b)
{
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

MESO_LANES_INLINE MesoLanes3 meso_lanes3_cross(MesoLanes3 a, MesoLanes3 b)
{
    return (MesoLanes3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

MESO_LANES_INLINE MesoLanes3 meso_lanes3_choose(MesoLaneBits which, MesoLanes3 a, MesoLanes3 b)
{
    return (MesoLanes3){meso_lanes_choose(which, a.x, b.x), meso_lanes_choose(which, a.y, b.y),
                       meso_lanes_choose(which, a.z, b.z)};
}

#endif
