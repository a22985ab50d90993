/* Lists of numbers by other numbers, such as nodes by triangles: the one in the upper half of a key is sorted by. */
#ifndef MESO_CUT_KEYS_H
#define MESO_CUT_KEYS_H

#include <stdint.h>

static inline uint64_t meso_cut_key(uint32_t upper, uint32_t value)
{
    return (uint64_t)upper << 32 | value;
}

/* Sorts by the upper halves; equal ones keep their order. `spare` [count] is scratch. O(count). */
void meso_cut_sort(uint64_t *keys, uint64_t *spare, uint32_t count);

#endif
