/*
 * Domains: what a slot may still hold, as a set of variants. Equal domains are
 * one interned state, a number; a state knows for each side the label set that
 * the neighbour across it may show, interned too. Narrowing a state by a label
 * set is then a look-up for all but the first of many equal cases.
 */
#ifndef MESO_DOMAIN_H
#define MESO_DOMAIN_H

#include "libcore/base/arena.h"
#include "libcore/base/bits.h"
#include "libcore/base/interner.h"
#include "libcore/tiling/tile/variant.h"

/* What is known of a state beside its variants. */
typedef struct MesoDomain {
    uint32_t size;              /* number of variants */
    uint32_t allow[4];          /* label set that the neighbour's side may show */
} MesoDomain;

typedef struct MesoDomainStep {
    uint64_t key;
    uint32_t next;
} MesoDomainStep;

typedef struct MesoDomainTable {
    MesoArena arena;            /* all from `states` on; a collection moves to a new one */
    MesoArena fixed;            /* of what is above it */
    const uint32_t *codes;      /* [4 * variant_count] label codes of the variants */
    uint32_t variant_count, label_count;
    uint64_t *showing;          /* [4 * label_count * words of a state] variants by side and code */
    MesoInterner states, sets;
    uint32_t domain_capacity;
    MesoDomain *domains;        /* [domain_capacity] of each state */
    MesoDomainStep *steps;      /* [step_mask + 1] cache; a later step replaces an earlier */
    uint32_t step_mask;
    uint64_t *scratch_state;    /* [words of a state] */
    uint64_t *scratch_sets;     /* [4 * words of a set] */
} MesoDomainTable;

/* The state without variants. */
enum { MESO_DOMAIN_EMPTY = 0 };

/*
 * Prepares a table with the empty state in it.
 *
 * codes       [4 * variant_count] label code (label.h) of side k of variant
 *             v at 4 v + k, each below `label_count`; must outlive the table
 * step_count  entries of the step cache: a power of two
 *
 * Returns MESO_ERR_MEMORY alone; the table may be released in any case.
 */
MesoStatus meso_domain_table_init(MesoDomainTable *table, uint32_t variant_count,
                                  const uint32_t *codes, uint32_t label_count,
                                  uint32_t step_count, MesoError *error);

void meso_domain_table_release(MesoDomainTable *table);

/* State of the variants in `bits` [words of a state], or MESO_NO_INDEX when memory is out. */
uint32_t meso_domain_intern(MesoDomainTable *table, const uint64_t *bits, MesoError *error);

/* State of variant `variant` alone; as meso_domain_intern(). */
uint32_t meso_domain_single(MesoDomainTable *table, uint32_t variant, MesoError *error);

/* `state` without `variant`; as meso_domain_intern(). */
uint32_t meso_domain_without(MesoDomainTable *table, uint32_t state, uint32_t variant, MesoError *error);

/* The `rank`-th variant of a state, counted from 0; rank < its size. */
uint32_t meso_domain_variant(const MesoDomainTable *table, uint32_t state, uint32_t rank);

/*
 * The part of `state` that shows a label of `set` on side `side`; fills the
 * step cache. MESO_NO_INDEX when memory is out. O(labels * words of the state) for a
 * new step; use meso_domain_step().
 */
uint32_t meso_domain_narrow(MesoDomainTable *table, uint32_t state, uint32_t side, uint32_t set,
                            MesoError *error);

/*
 * Forgets the states that none of the two arrays holds and renumbers the
 * rest, in the arrays too. MESO_ERR_MEMORY leaves table and arrays unusable.
 * O(count + states).
 */
MesoStatus meso_domain_collect(MesoDomainTable *table, uint32_t count, uint32_t *states,
                               uint32_t *more_states, MesoError *error);

static inline const uint64_t *meso_domain_bits(const MesoDomainTable *table, uint32_t state)
{
    return meso_interner_bits(&table->states, state);
}

static inline const uint64_t *meso_domain_labels(const MesoDomainTable *table, uint32_t set)
{
    return meso_interner_bits(&table->sets, set);
}

static inline uint64_t meso_domain_step_key(uint32_t state, uint32_t side, uint32_t set)
{
    return ((uint64_t)state << 32) | ((uint64_t)set << 2) | side;
}

static inline MesoDomainStep *meso_domain_step_place(const MesoDomainTable *table, uint64_t key)
{
    return table->steps + ((uint32_t)((key * 0x9e3779b97f4a7c15u) >> 32) & table->step_mask);
}

/* meso_domain_narrow() through the cache. O(1) where the step was met lately. */
static inline uint32_t meso_domain_step(MesoDomainTable *table, uint32_t state, uint32_t side,
                                        uint32_t set, MesoError *error)
{
    uint64_t key = meso_domain_step_key(state, side, set);
    const MesoDomainStep *step = meso_domain_step_place(table, key);
    return step->key == key ? step->next : meso_domain_narrow(table, state, side, set, error);
}

#endif
