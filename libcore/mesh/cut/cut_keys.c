#include "libcore/mesh/cut/cut_keys.h"

#include <stdbool.h>
#include <string.h>

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, FEW = 64 };

static void sort_few(uint64_t *keys, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        uint64_t moved = keys[i];
        uint32_t j = i;
        for (; j > 0 && keys[j - 1] >> 32 > moved >> 32; j--)
            keys[j] = keys[j - 1];
        keys[j] = moved;
    }
}

static void sort_by_digit(uint64_t *to, const uint64_t *from, uint32_t count, uint32_t shift)
{
    uint32_t begin[DIGITS + 1] = {0};
    for (uint32_t i = 0; i < count; i++)
        begin[(from[i] >> shift) % DIGITS + 1]++;
    for (uint32_t d = 0; d < DIGITS; d++)
        begin[d + 1] += begin[d];
    for (uint32_t i = 0; i < count; i++)
        to[begin[(from[i] >> shift) % DIGITS]++] = from[i];
}

void meso_cut_sort(uint64_t *keys, uint64_t *spare, uint32_t count)
{
    uint64_t all = 0, *from = keys, *to = spare;
    bool sorted = true;
    for (uint32_t i = 0; i < count; i++) {
        all |= keys[i];
        sorted = sorted && (i == 0 || keys[i - 1] >> 32 <= keys[i] >> 32);
    }
    if (sorted)
        return;
    if (count <= FEW) {
        sort_few(keys, count);
        return;
    }
    for (uint32_t shift = 32; shift < 64 && all >> shift; shift += DIGIT_BITS) {
        sort_by_digit(to, from, count, shift);
        uint64_t *swapped = from;
        from = to;
        to = swapped;
    }
    if (from != keys)
        memcpy(keys, from, count * sizeof *keys);
}
