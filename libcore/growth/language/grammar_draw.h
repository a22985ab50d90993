/* Random numbers by place: hashes of the branch, the site in the text, and the turn of the loop there. */
#ifndef MESO_GRAMMAR_DRAW_H
#define MESO_GRAMMAR_DRAW_H

#include <stddef.h>
#include <stdint.h>

/* SplitMix64's finisher: a bijection in which every bit depends on every other. */
static inline uint64_t meso_draw_mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static inline uint64_t meso_draw_key(uint64_t key, uint64_t site, uint64_t turn)
{
    return meso_draw_mix(meso_draw_mix(key ^ site) + 0x9e3779b97f4a7c15u * (turn + 1));
}

/* In [0, 1), of 53 bits. */
static inline double meso_draw_share(uint64_t hash)
{
    return (double)(hash >> 11) * 0x1p-53;
}

/* Mean 0 and deviation 1: twelve shares of 16 bits, less 6 (within [-6, 6]); sums of whole numbers, so exact. */
static inline double meso_draw_normal(uint64_t hash)
{
    const uint64_t even = 0x0000ffff0000ffffu;
    uint64_t sums = 0;  /* two, of every other part */
    for (uint32_t word = 0; word < 3; word++) {
        sums += (hash & even) + (hash >> 16 & even);
        hash = meso_draw_mix(hash + 0x9e3779b97f4a7c15u);
    }
    return ((double)(int64_t)((sums >> 32) + (sums & UINT32_MAX)) + 6) * 0x1p-16 - 6;
}

/* FNV-1a of a name, and a number in it, mixed. */
static inline uint64_t meso_draw_site(const char *name, size_t length, uint64_t kind, uint64_t number)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (uint8_t)name[i]) * 0x100000001b3u;
    return meso_draw_mix(meso_draw_mix(hash + kind) + number);
}

#endif
