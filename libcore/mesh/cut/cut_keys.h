/* Lists sorted by whole numbers, such as triangles or half-edges. */
#ifndef MESO_CUT_KEYS_H
#define MESO_CUT_KEYS_H

#include <stdbool.h>

#include "libcore/base/arena.h"
#include "libcore/base/index.h"

typedef struct MesoCutKey {
    uint64_t key;
    uint32_t value;
} MesoCutKey;

/* Sorts by keys; equal ones keep their order. `spare` [count] is scratch. O(count), but for the bits of the keys. */
void meso_cut_sort(MesoCutKey *keys, MesoCutKey *spare, uint32_t count);

#endif
