/*
 * Random numbers by integers alone, so that a seed means the same on every
 * machine and for every compiler: xoshiro256** seeded through SplitMix64
 * (Blackman and Vigna, "Scrambled Linear Pseudorandom Number Generators", 2021).
 */
#ifndef MESO_RANDOM_H
#define MESO_RANDOM_H

#include <stdint.h>

typedef struct MesoRandom {
    uint64_t state[4];
} MesoRandom;

/* Streams of one seed are independent: sub-seeds of restarts, parts, threads. */
void meso_random_init(MesoRandom *random, uint64_t seed, uint64_t stream);

uint64_t meso_random_next(MesoRandom *random);

/* Uniform in [0, bound), without bias (Lemire 2019); bound > 0. */
uint32_t meso_random_below(MesoRandom *random, uint32_t bound);

#endif
