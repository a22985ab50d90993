/*
 * Four floats at once, by the compiler's own vectors: any machine has these, or does without. Each operation is that of
 * a float, lane by lane.
 */
#ifndef MESO_FOUR_H
#define MESO_FOUR_H

#include <stdint.h>

#ifdef __GNUC__
#define MESO_HAS_FOUR 1

typedef float MesoFour __attribute__((vector_size(16)));
typedef int32_t MesoFourBits __attribute__((vector_size(16)));
typedef uint64_t MesoFourWords __attribute__((vector_size(16)));

#define MESO_FOUR static inline __attribute__((always_inline))

#ifdef __clang__
#define MESO_FOUR_SHUFFLE(a, b, i, j, k, l) __builtin_shufflevector((a), (b), i, j, k, l)
#else
#define MESO_FOUR_SHUFFLE(a, b, i, j, k, l) __builtin_shuffle((a), (b), (MesoFourBits){i, j, k, l})
#endif

MESO_FOUR MesoFour meso_four_all(float a)
{
    return (MesoFour){a, a, a, a};
}

MESO_FOUR MesoFour meso_four_choose(MesoFourBits which, MesoFour a, MesoFour b)
{
    return (MesoFour)((which & (MesoFourBits)a) | (~which & (MesoFourBits)b));
}

MESO_FOUR MesoFour meso_four_least(MesoFour a, MesoFour b)
{
    return meso_four_choose(a < b, a, b);
}

MESO_FOUR MesoFour meso_four_most(MesoFour a, MesoFour b)
{
    return meso_four_choose(a > b, a, b);
}

MESO_FOUR MesoFour meso_four_absolute(MesoFour a)
{
    return (MesoFour)((MesoFourBits)a & INT32_MAX);
}

MESO_FOUR MesoFour meso_four_root(MesoFour a)
{
    return (MesoFour){__builtin_sqrtf(a[0]), __builtin_sqrtf(a[1]), __builtin_sqrtf(a[2]), __builtin_sqrtf(a[3])};
}

/* ---- four vectors ---- */

typedef struct MesoFour3 {
    MesoFour x, y, z;
} MesoFour3;

MESO_FOUR MesoFour3 meso_four3_add(MesoFour3 a, MesoFour3 b)
{
    return (MesoFour3){a.x + b.x, a.y + b.y, a.z + b.z};
}

MESO_FOUR MesoFour3 meso_four3_sub(MesoFour3 a, MesoFour3 b)
{
    return (MesoFour3){a.x - b.x, a.y - b.y, a.z - b.z};
}

MESO_FOUR MesoFour3 meso_four3_scale(MesoFour3 a, MesoFour s)
{
    return (MesoFour3){a.x * s, a.y * s, a.z * s};
}

/* a + s * b */
MESO_FOUR MesoFour3 meso_four3_mad(MesoFour3 a, MesoFour s, MesoFour3 b)
{
    return (MesoFour3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

MESO_FOUR MesoFour meso_four3_dot(MesoFour3 a, MesoFour3 b)
{
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

MESO_FOUR MesoFour3 meso_four3_cross(MesoFour3 a, MesoFour3 b)
{
    return (MesoFour3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

MESO_FOUR MesoFour3 meso_four3_choose(MesoFourBits which, MesoFour3 a, MesoFour3 b)
{
    return (MesoFour3){meso_four_choose(which, a.x, b.x), meso_four_choose(which, a.y, b.y),
                       meso_four_choose(which, a.z, b.z)};
}

#endif
#endif
