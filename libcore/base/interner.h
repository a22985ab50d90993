/* Interner: bit vectors become numbers. */
#ifndef MESO_INTERNER_H
#define MESO_INTERNER_H

#include "libcore/base/arena.h"
#include "libcore/base/index.h"

/* Numbers stay below this, so that three more bits fit beside one. */
enum { MESO_INTERNER_LIMIT = 1 << 29 };

/* Bit vectors of one length, each stored once and known by its number. */
typedef struct MesoInterner {
    uint32_t word_count;
    uint32_t count, capacity;
    uint64_t *bits;             /* [capacity * word_count] */
    uint32_t *index;            /* [index_mask + 1] number + 1, or 0; open addressing */
    uint32_t index_mask;
} MesoInterner;

/*
 * Number of `bits` [word_count]; new ones are copied to `arena` and get the number
 * `count`, which grows by one. An interner starts zeroed but for `word_count`.
 * MESO_NO_INDEX when memory is out.
 */
uint32_t meso_interner_add(MesoInterner *interner, MesoArena *arena, const uint64_t *bits,
                           MesoError *error);

static inline const uint64_t *meso_interner_bits(const MesoInterner *interner, uint32_t number)
{
    return interner->bits + (size_t)number * interner->word_count;
}

#endif
