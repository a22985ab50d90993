#include "libcore/tiling/propagate/domain.h"

#include <assert.h>
#include <string.h>

#include "libcore/base/grow.h"

static bool grow_domains(MesoDomainTable *table, MesoError *error)
{
    MesoDomain *domains = meso_arena_enlarge(&table->arena, table->domains, table->domain_capacity,
                                             table->states.capacity, sizeof *domains, error);
    if (!domains)
        return false;
    table->domains = domains;
    table->domain_capacity = table->states.capacity;
    return true;
}

/* Variants that show `code` on side `side`. */
static const uint64_t *variants_showing(const MesoDomainTable *table, uint32_t side, uint32_t code)
{
    return table->showing + ((size_t)side * table->label_count + code) * table->states.word_count;
}

/* What the neighbours may show is the opposite of what a state shows: the code's lowest bit turned. */
static bool describe_state(MesoDomainTable *table, uint32_t state, MesoError *error)
{
    MesoDomain *domain = &table->domains[state];
    const uint64_t *bits = meso_domain_bits(table, state);
    uint32_t set_words = table->sets.word_count, words = table->states.word_count;

    memset(table->scratch_sets, 0, 4 * (size_t)set_words * sizeof *table->scratch_sets);
    domain->size = meso_bits_count(bits, words);
    for (uint32_t k = 0; k < 4; k++)
        for (uint32_t code = 0; code < table->label_count; code++) {
            const uint64_t *showing = variants_showing(table, k, code);
            uint64_t shown = 0;
            for (uint32_t w = 0; w < words; w++)
                shown |= bits[w] & showing[w];
            if (shown)
                meso_bits_set(table->scratch_sets + (size_t)k * set_words, code ^ 1);
        }
    for (uint32_t k = 0; k < 4; k++) {
        domain->allow[k] = meso_interner_add(&table->sets, &table->arena,
                                        table->scratch_sets + (size_t)k * set_words, error);
        if (domain->allow[k] == MESO_NO_INDEX)
            return false;
    }
    return true;
}

static MesoStatus init_growing(MesoDomainTable *table, uint32_t label_words, uint32_t step_count,
                               MesoError *error)
{
    meso_arena_init(&table->arena);
    table->states = (MesoInterner){.word_count = meso_bits_words(table->variant_count)};
    table->sets = (MesoInterner){.word_count = label_words};
    table->domain_capacity = 0;
    table->step_mask = step_count - 1;
    table->steps = MESO_NEW(&table->arena, MesoDomainStep, step_count, error);
    table->scratch_state = MESO_NEW(&table->arena, uint64_t, table->states.word_count, error);
    table->scratch_sets = MESO_NEW(&table->arena, uint64_t, 4 * (size_t)label_words, error);
    if (!table->steps || !table->scratch_state || !table->scratch_sets)
        return MESO_ERR_MEMORY;

    /* An unused cache entry has the key of a step from the empty state, and is right about it. */
    uint32_t empty = meso_domain_intern(table, table->scratch_state, error);
    assert(empty == MESO_DOMAIN_EMPTY || empty == MESO_NO_INDEX);
    return empty == MESO_NO_INDEX ? MESO_ERR_MEMORY : MESO_OK;
}

MesoStatus meso_domain_table_init(MesoDomainTable *table, uint32_t variant_count,
                                  const uint32_t *codes, uint32_t label_count,
                                  uint32_t step_count, MesoError *error)
{
    assert(variant_count > 0 && step_count > 0 && (step_count & (step_count - 1)) == 0);
    *table = (MesoDomainTable){.codes = codes, .variant_count = variant_count, .label_count = label_count};
    meso_arena_init(&table->fixed);
    size_t words = meso_bits_words(variant_count);
    table->showing = MESO_NEW(&table->fixed, uint64_t, 4 * label_count * words, error);
    if (!table->showing)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < variant_count; v++)
        for (uint32_t k = 0; k < 4; k++)
            meso_bits_set(table->showing + ((size_t)k * label_count + codes[4 * (size_t)v + k]) * words, v);
    return init_growing(table, meso_bits_words(label_count), step_count, error);
}

void meso_domain_table_release(MesoDomainTable *table)
{
    meso_arena_release(&table->arena);
    meso_arena_release(&table->fixed);
}

uint32_t meso_domain_intern(MesoDomainTable *table, const uint64_t *bits, MesoError *error)
{
    uint32_t count = table->states.count;
    uint32_t state = meso_interner_add(&table->states, &table->arena, bits, error);
    if (state == MESO_NO_INDEX || table->states.count == count)
        return state;
    if (table->domain_capacity < table->states.capacity && !grow_domains(table, error))
        return MESO_NO_INDEX;
    return describe_state(table, state, error) ? state : MESO_NO_INDEX;
}

uint32_t meso_domain_single(MesoDomainTable *table, uint32_t variant, MesoError *error)
{
    assert(variant < table->variant_count);
    memset(table->scratch_state, 0, table->states.word_count * sizeof *table->scratch_state);
    meso_bits_set(table->scratch_state, variant);
    return meso_domain_intern(table, table->scratch_state, error);
}

uint32_t meso_domain_without(MesoDomainTable *table, uint32_t state, uint32_t variant, MesoError *error)
{
    memcpy(table->scratch_state, meso_domain_bits(table, state),
           table->states.word_count * sizeof *table->scratch_state);
    meso_bits_clear(table->scratch_state, variant);
    return meso_domain_intern(table, table->scratch_state, error);
}

uint32_t meso_domain_variant(const MesoDomainTable *table, uint32_t state, uint32_t rank)
{
    const uint64_t *bits = meso_domain_bits(table, state);
    assert(rank < table->domains[state].size);
    uint32_t w = 0;
    for (uint32_t count; (count = (uint32_t)__builtin_popcountll(bits[w])) <= rank; w++)
        rank -= count;
    uint64_t rest = bits[w];
    while (rank--)
        rest &= rest - 1;
    return 64 * w + (uint32_t)__builtin_ctzll(rest);
}

uint32_t meso_domain_narrow(MesoDomainTable *table, uint32_t state, uint32_t side, uint32_t set,
                            MesoError *error)
{
    const uint64_t *bits = meso_domain_bits(table, state);
    const uint64_t *labels = meso_domain_labels(table, set);
    uint32_t words = table->states.word_count;
    memset(table->scratch_state, 0, words * sizeof *table->scratch_state);
    for (uint32_t code = 0; code < table->label_count; code++) {
        if (!meso_bits_test(labels, code))
            continue;
        const uint64_t *showing = variants_showing(table, side, code);
        for (uint32_t w = 0; w < words; w++)
            table->scratch_state[w] |= bits[w] & showing[w];
    }
    uint32_t next = meso_domain_intern(table, table->scratch_state, error);
    if (next == MESO_NO_INDEX)
        return MESO_NO_INDEX;
    uint64_t key = meso_domain_step_key(state, side, set);
    *meso_domain_step_place(table, key) = (MesoDomainStep){key, next};
    return next;
}

/* Numbers in the new table of the states in `states`, which `renumber` keeps. */
static MesoStatus move_states(MesoDomainTable *table, const MesoDomainTable *old, uint32_t *renumber,
                              uint32_t count, uint32_t *states, MesoError *error)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *number = &renumber[states[i]];
        if (*number == MESO_NO_INDEX)
            *number = meso_domain_intern(table, meso_domain_bits(old, states[i]), error);
        if (*number == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
        states[i] = *number;
    }
    return MESO_OK;
}

MesoStatus meso_domain_collect(MesoDomainTable *table, uint32_t count, uint32_t *states,
                               uint32_t *more_states, MesoError *error)
{
    MesoDomainTable old = *table;
    MesoStatus status = init_growing(table, old.sets.word_count, old.step_mask + 1, error);
    uint32_t *renumber = MESO_NEW(&old.arena, uint32_t, old.states.count, error);
    if (!renumber)
        status = MESO_ERR_MEMORY;
    if (!status) {
        memset(renumber, 0xff, old.states.count * sizeof *renumber);
        status = move_states(table, &old, renumber, count, states, error);
    }
    if (!status)
        status = move_states(table, &old, renumber, count, more_states, error);
    meso_arena_release(&old.arena);
    return status;
}
