/*
 * Four floats at once, by the compiler's own vectors: any machine has these, or does without. Each operation is that of
 * a float, lane by lane.
 */
#ifndef MESO_FOUR_H
#define MESO_FOUR_H

#include <stdint.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

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

MESO_FOUR MesoFour meso_four_absolute(MesoFour a)
{
    return (MesoFour)((MesoFourBits)a & INT32_MAX);
}

/* Bit i: lane i is set. */
MESO_FOUR uint32_t meso_four_mask(MesoFourBits bits)
{
#ifdef __SSE__
    return (uint32_t)_mm_movemask_ps((__m128)bits);
#else
    return (uint32_t)((bits[0] & 1) | (bits[1] & 2) | (bits[2] & 4) | (bits[3] & 8));
#endif
}

MESO_FOUR MesoFour meso_four_root(MesoFour a)
{
    return (MesoFour){__builtin_sqrtf(a[0]), __builtin_sqrtf(a[1]), __builtin_sqrtf(a[2]), __builtin_sqrtf(a[3])};
}

#endif
#endif
