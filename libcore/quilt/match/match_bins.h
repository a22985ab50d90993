/*
 * 26 directions: to the faces, edges and corners of a cube. Three of them span the triangle that a direction lies in,
 * of the 48 that the sphere is cut into by the cube's mirrors; none is farther than 28 degrees from the nearest.
 */
#ifndef MESO_MATCH_BINS_H
#define MESO_MATCH_BINS_H

#include "libcore/math/vec.h"

enum { MESO_MATCH_BINS = 26 };

/* Three bins and their weights, which add up to 1. */
typedef struct MesoMatchBlend {
    uint32_t bins[3];
    float weights[3];
} MesoMatchBlend;

/* The bin of a direction by signs -1, 0, 1 of its coordinates, not all 0: the middle one of 27 is left out. */
static inline uint32_t meso_match_bin_of_signs(int x, int y, int z)
{
    int number = x + 1 + 3 * (y + 1) + 9 * (z + 1);
    return (uint32_t)(number - (number > 13));
}

/* The unit direction of a bin. */
static inline MesoVec3 meso_match_direction(uint32_t bin)
{
    uint32_t number = bin + (bin >= 13);
    MesoVec3 signs = {(float)(number % 3) - 1, (float)(number / 3 % 3) - 1, (float)(number / 9) - 1};
    return meso_vec3_unit(signs, signs);
}

/* The bins around a direction: linear in between, all weight on one at its own direction. Up for 0. */
static inline MesoMatchBlend meso_match_blend(MesoVec3 n)
{
    const float size[3] = {n.x < 0 ? -n.x : n.x, n.y < 0 ? -n.y : n.y, n.z < 0 ? -n.z : n.z};
    int first = size[1] > size[0] ? 1 : 0;
    first = size[2] > size[first] ? 2 : first;
    int second = first == 0 ? 1 : 0, third = first == 2 ? 1 : 2;
    if (size[third] > size[second]) {
        int swap = second;
        second = third;
        third = swap;
    }
    const int signs[3] = {n.x < 0 ? -1 : 1, n.y < 0 ? -1 : 1, n.z < 0 ? -1 : 1};
    float face = size[first] - size[second], edge = 1.41421356f * (size[second] - size[third]);
    float corner = 1.73205081f * size[third], sum = face + edge + corner;
    if (!(sum > 0))
        return (MesoMatchBlend){{meso_match_bin_of_signs(0, 0, 1), 0, 0}, {1, 0, 0}};
    MesoMatchBlend blend = {{0}, {face / sum, edge / sum, corner / sum}};
    int chosen[3] = {0, 0, 0};
    const int order[3] = {first, second, third};
    for (int k = 0; k < 3; k++) {
        chosen[order[k]] = signs[order[k]];
        blend.bins[k] = meso_match_bin_of_signs(chosen[0], chosen[1], chosen[2]);
    }
    return blend;
}

/* The nearest bin of a direction. */
static inline uint32_t meso_match_nearest_bin(MesoVec3 n)
{
    MesoMatchBlend blend = meso_match_blend(n);
    uint32_t best = blend.bins[0];
    float most = -2;
    for (int k = 0; k < 3; k++) {
        float dot = meso_vec3_dot(meso_match_direction(blend.bins[k]), n);
        if (blend.weights[k] > 0 && dot > most) {
            most = dot;
            best = blend.bins[k];
        }
    }
    return best;
}

#endif
