#include "libcore/mesh/cut/cut_keys.h"

#include <string.h>

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, FEW = 64 };

static void sort_few(MesoCutKey *keys, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        MesoCutKey moved = keys[i];
        uint32_t j = i;
        for (; j > 0 && keys[j - 1].key > moved.key; j--)
            keys[j] = keys[j - 1];
        keys[j] = moved;
    }
}

static void sort_by_digit(MesoCutKey *to, const MesoCutKey *from, uint32_t count, uint32_t shift)
{
    uint32_t begin[DIGITS + 1] = {0};
    for (uint32_t i = 0; i < count; i++)
        begin[(from[i].key >> shift) % DIGITS + 1]++;
    for (uint32_t d = 0; d < DIGITS; d++)
        begin[d + 1] += begin[d];
    for (uint32_t i = 0; i < count; i++)
        to[begin[(from[i].key >> shift) % DIGITS]++] = from[i];
}

void meso_cut_sort(MesoCutKey *keys, MesoCutKey *spare, uint32_t count)
{
    uint64_t all = 0;
    bool sorted = true;
    for (uint32_t i = 0; i < count; i++) {
        all |= keys[i].key;
        sorted = sorted && (i == 0 || keys[i - 1].key <= keys[i].key);
    }
    if (sorted)
        return;
    if (count <= FEW) {
        sort_few(keys, count);
        return;
    }
    MesoCutKey *from = keys, *to = spare;
    for (uint32_t shift = 0; shift < 64 && all >> shift; shift += DIGIT_BITS) {
        if ((all >> shift) % DIGITS == 0)
            continue;
        sort_by_digit(to, from, count, shift);
        MesoCutKey *swapped = from;
        from = to;
        to = swapped;
    }
    if (from != keys)
        memcpy(keys, from, count * sizeof *keys);
}
