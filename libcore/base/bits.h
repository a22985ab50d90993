/* Bit sets: `word_count` words of 64 bits, element i in bit i % 64 of word i / 64. */
#ifndef MESO_BITS_H
#define MESO_BITS_H

#include <stdbool.h>
#include <stdint.h>

static inline uint32_t meso_bits_words(uint32_t bit_count)
{
    return (bit_count + 63) / 64;
}

static inline bool meso_bits_test(const uint64_t *bits, uint32_t i)
{
    return (bits[i / 64] >> (i % 64)) & 1;
}

static inline void meso_bits_set(uint64_t *bits, uint32_t i)
{
    bits[i / 64] |= (uint64_t)1 << (i % 64);
}

static inline void meso_bits_clear(uint64_t *bits, uint32_t i)
{
    bits[i / 64] &= ~((uint64_t)1 << (i % 64));
}

static inline uint32_t meso_bits_count(const uint64_t *bits, uint32_t word_count)
{
    uint32_t count = 0;
    for (uint32_t w = 0; w < word_count; w++)
        count += (uint32_t)__builtin_popcountll(bits[w]);
    return count;
}

/* Elements below `i`. */
static inline uint32_t meso_bits_rank(const uint64_t *bits, uint32_t i)
{
    uint64_t below = bits[i / 64] & (((uint64_t)1 << (i % 64)) - 1);
    return meso_bits_count(bits, i / 64) + (uint32_t)__builtin_popcountll(below);
}

/* First element, or `64 * word_count` if there is none. */
static inline uint32_t meso_bits_first(const uint64_t *bits, uint32_t word_count)
{
    for (uint32_t w = 0; w < word_count; w++)
        if (bits[w])
            return 64 * w + (uint32_t)__builtin_ctzll(bits[w]);
    return 64 * word_count;
}

#endif
