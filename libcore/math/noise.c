#include "libcore/math/noise.h"

/* A 64-bit finaliser (SplitMix64's): all bits of the cell reach all bits of the result. */
static uint32_t hash_cell(int64_t x, int64_t y, int64_t z, uint64_t seed)
{
    uint64_t h = seed ^ (uint32_t)x * 0x9e3779b97f4a7c15u ^ (uint32_t)y * 0xc2b2ae3d27d4eb4fu ^
                 (uint32_t)z * 0x165667b19e3779f9u;
    h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
    h = (h ^ h >> 27) * 0x94d049bb133111ebu;
    return (uint32_t)((h ^ h >> 31) >> 32);
}

static float towards_edge(uint32_t hash, float x, float y, float z)
{
    uint32_t edge = hash % 12, axes = edge / 4;
    float a = axes == 2 ? y : x, b = axes == 0 ? y : z;
    return (edge & 1 ? -a : a) + (edge & 2 ? -b : b);
}

static float blend(float t)
{
    return t * t * t * (t * (t * 6 - 15) + 10);
}

static float mix(float a, float b, float t)
{
    return a + t * (b - a);
}

float meso_noise(MesoVec3 p, uint64_t seed)
{
    float fx = floorf(p.x), fy = floorf(p.y), fz = floorf(p.z);
    float x = p.x - fx, y = p.y - fy, z = p.z - fz;
    /* beyond what a float tells apart there are no cells */
    if (!(fabsf(fx) < 1e9f && fabsf(fy) < 1e9f && fabsf(fz) < 1e9f))
        return 0;
    int64_t cx = (int64_t)fx, cy = (int64_t)fy, cz = (int64_t)fz;
    float corner[8];
    for (int i = 0; i < 8; i++) {
        int dx = i & 1, dy = i >> 1 & 1, dz = i >> 2;
        corner[i] = towards_edge(hash_cell(cx + dx, cy + dy, cz + dz, seed), x - (float)dx, y - (float)dy,
                                 z - (float)dz);
    }
    float u = blend(x), v = blend(y), w = blend(z);
    float low = mix(mix(corner[0], corner[1], u), mix(corner[2], corner[3], u), v);
    float high = mix(mix(corner[4], corner[5], u), mix(corner[6], corner[7], u), v);
    return mix(low, high, w);
}
