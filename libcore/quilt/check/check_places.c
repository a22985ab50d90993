#include "libcore/quilt/check/check_places.h"

MesoStatus meso_places_init(MesoPlaces *places, MesoArena *arena, const MesoTriangulation *base, MesoError *error)
{
    *places = (MesoPlaces){.base = base, .sums = MESO_NEW(arena, double, (size_t)base->triangle_count + 1, error)};
    if (!places->sums)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < base->triangle_count; t++) {
        const uint32_t *v = &base->corners[3 * (size_t)t];
        MesoVec3 a = base->positions[v[0]], b = meso_vec3_sub(base->positions[v[1]], a);
        MesoVec3 area = meso_vec3_cross(b, meso_vec3_sub(base->positions[v[2]], a));
        places->sums[t + 1] = places->sums[t] + (double)meso_vec3_length(area);
    }
    return MESO_OK;
}

double meso_places_area(const MesoPlaces *places)
{
    return places->sums[places->base->triangle_count] / 2;
}

double meso_random_share(MesoRandom *random)
{
    return (double)(meso_random_next(random) >> 11) / 9007199254740992.0;
}

MesoVec3 meso_places_next(const MesoPlaces *places, MesoRandom *random, uint32_t *triangle)
{
    const MesoTriangulation *base = places->base;
    double at = places->sums[base->triangle_count] * meso_random_share(random);
    uint32_t low = 0, high = base->triangle_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        *(places->sums[middle] <= at ? &low : &high) = middle;
    }
    float u = (float)meso_random_share(random), v = (float)meso_random_share(random);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    const uint32_t *c = &base->corners[3 * (size_t)low];
    MesoVec3 a = base->positions[c[0]];
    *triangle = low;
    return meso_vec3_mad(meso_vec3_mad(a, u, meso_vec3_sub(base->positions[c[1]], a)), v,
                         meso_vec3_sub(base->positions[c[2]], a));
}
