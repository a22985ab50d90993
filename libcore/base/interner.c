#include "libcore/base/interner.h"

#include <stdbool.h>
#include <string.h>

#include "libcore/base/grow.h"

enum { FIRST_CAPACITY = 256 };

static uint64_t hash_words(const uint64_t *words, uint32_t count)
{
    uint64_t hash = 0;
    for (uint32_t w = 0; w < count; w++) {
        hash = (hash ^ words[w]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash ^ (hash >> 32);
}

/* A few words: memcmp() would take longer to begin. */
static bool same_words(const uint64_t *a, const uint64_t *b, uint32_t count)
{
    for (uint32_t w = 0; w < count; w++)
        if (a[w] != b[w])
            return false;
    return true;
}

/* Place of `bits` in the index: of its number, or the free one where it belongs. */
static uint32_t *interner_place(const MesoInterner *interner, const uint64_t *bits)
{
    uint32_t i = (uint32_t)hash_words(bits, interner->word_count);
    for (;; i++) {
        uint32_t *place = &interner->index[i & interner->index_mask];
        if (*place == 0 || same_words(meso_interner_bits(interner, *place - 1), bits, interner->word_count))
            return place;
    }
}

static bool interner_grow(MesoInterner *interner, MesoArena *arena, MesoError *error)
{
    uint32_t capacity = interner->capacity ? 2 * interner->capacity : FIRST_CAPACITY;
    if (capacity > MESO_INTERNER_LIMIT) {
        meso_fail(error, MESO_ERR_MEMORY, "out of memory: more than %d bit vectors", MESO_INTERNER_LIMIT);
        return false;
    }
    uint64_t *bits = meso_arena_enlarge(arena, interner->bits, interner->count, capacity,
                                        interner->word_count * sizeof *bits, error);
    uint32_t *index = MESO_NEW(arena, uint32_t, 2 * (size_t)capacity, error);
    if (!bits || !index)
        return false;
    interner->bits = bits;
    interner->index = index;
    interner->index_mask = 2 * capacity - 1;
    interner->capacity = capacity;
    for (uint32_t i = 0; i < interner->count; i++)
        *interner_place(interner, meso_interner_bits(interner, i)) = i + 1;
    return true;
}

uint32_t meso_interner_add(MesoInterner *interner, MesoArena *arena, const uint64_t *bits,
                           MesoError *error)
{
    uint32_t *place = interner->capacity ? interner_place(interner, bits) : NULL;
    if (place && *place)
        return *place - 1;
    if (interner->count == interner->capacity) {
        if (!interner_grow(interner, arena, error))
            return MESO_NO_INDEX;
        place = interner_place(interner, bits);
    }
    uint32_t number = interner->count++;
    memcpy(interner->bits + (size_t)number * interner->word_count, bits,
           interner->word_count * sizeof *bits);
    *place = number + 1;
    return number;
}
