/*
 * Cage: a hexahedron between two heights over a bilinear patch, which the unit
 * cube is bent into.
 */
#ifndef MESO_CAGE_H
#define MESO_CAGE_H

#include "libcore/math/vec.h"

/* Corners of the patch in the order (1,0), (1,1), (0,1), (0,0) of the unit square. */
typedef struct MesoCage {
    MesoVec3 base[4];
    MesoVec3 rise[4];   /* a corner at height h is base + h * rise */
    float low, high;    /* heights of the bottom and the top */
} MesoCage;

/* Where the point (x, y, h) of the unit cube lies: trilinear, h from the bottom to the top. */
static inline MesoVec3 meso_cage_point(const MesoCage *cage, float x, float y, float h)
{
    MesoVec3 p[4];
    float height = cage->low + (cage->high - cage->low) * h;
    for (uint32_t i = 0; i < 4; i++)
        p[i] = meso_vec3_mad(cage->base[i], height, cage->rise[i]);
    return meso_vec3_lerp(meso_vec3_lerp(p[3], p[0], x), meso_vec3_lerp(p[2], p[1], x), y);
}

/*
 * The same by weights of the corners: where x or y is 0 or 1, the two corners there alone count, and either may come
 * first. Cages that share them agree to the bit on points of that side for which 1 minus their place along it is exact.
 */
static inline MesoVec3 meso_cage_blend(const MesoCage *cage, float x, float y, float h)
{
    const float weights[4] = {x * (1 - y), x * y, (1 - x) * y, (1 - x) * (1 - y)};
    float height = cage->low + (cage->high - cage->low) * h;
    MesoVec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < 4; i++)
        sum = meso_vec3_mad(sum, weights[i], meso_vec3_mad(cage->base[i], height, cage->rise[i]));
    return sum;
}

/* Corner 0..7: bit 2 is the top. */
static inline MesoVec3 meso_cage_corner(const MesoCage *cage, uint32_t corner)
{
    return meso_vec3_mad(cage->base[corner & 3], corner & 4 ? cage->high : cage->low, cage->rise[corner & 3]);
}

#endif
