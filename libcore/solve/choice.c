#include "libcore/solve/choice.h"

/* Uniform in [0, bound) for bounds beyond 32 bits: draws again above the last whole multiple. */
static uint64_t random_below_wide(MesoRandom *random, uint64_t bound)
{
    uint64_t excess = (0u - bound) % bound;     /* 2^64 modulo the bound */
    uint64_t draw = meso_random_next(random);
    while (excess && draw > UINT64_MAX - excess)
        draw = meso_random_next(random);
    return draw % bound;
}

/* The variants of `bits`, and of `also` unless it is NULL. */
static uint64_t both(const uint64_t *bits, const uint64_t *also, uint32_t w)
{
    return also ? bits[w] & also[w] : bits[w];
}

/* `rank`-th of the variants, by weight where there are `weights`, by number otherwise. */
static uint32_t pick(const uint64_t *bits, const uint64_t *also, uint32_t words,
                     const uint64_t *weights, uint64_t rank)
{
    for (uint32_t w = 0; w < words; w++)
        for (uint64_t rest = both(bits, also, w); rest; rest &= rest - 1) {
            uint32_t variant = 64 * w + (uint32_t)__builtin_ctzll(rest);
            uint64_t weight = weights ? weights[variant] : 1;
            if (rank < weight)
                return variant;
            rank -= weight;
        }
    return MESO_NO_INDEX;
}

static uint64_t total(const uint64_t *bits, const uint64_t *also, uint32_t words, const uint64_t *weights)
{
    uint64_t sum = 0;
    for (uint32_t w = 0; w < words; w++) {
        uint64_t rest = both(bits, also, w);
        if (!weights)
            sum += (uint64_t)__builtin_popcountll(rest);
        for (; weights && rest; rest &= rest - 1)
            sum += weights[64 * w + (uint32_t)__builtin_ctzll(rest)];
    }
    return sum;
}

static uint32_t draw(const uint64_t *bits, const uint64_t *also, uint32_t words,
                     const uint64_t *weights, MesoRandom *random)
{
    uint64_t sum = total(bits, also, words, weights);
    if (sum == 0) {
        weights = NULL;
        sum = total(bits, also, words, NULL);
    }
    uint64_t rank = sum <= UINT32_MAX ? meso_random_below(random, (uint32_t)sum)
                                      : random_below_wide(random, sum);
    return pick(bits, also, words, weights, rank);
}

/* Variants of a quota that the draw is to come from, or NULL. */
static const uint64_t *needed_variants(const MesoQuotaTrack *track, const uint64_t *bits, MesoRandom *random)
{
    for (uint32_t q = 0; q < track->count; q++) {
        const MesoQuota *quota = &track->quotas[q];
        MesoQuotaCount count = track->counts[q];
        if (count.inside >= quota->least || total(bits, quota->variants, track->word_count, NULL) == 0)
            continue;
        if (count.possible <= count.inside)
            continue;
        if (meso_random_below(random, count.possible - count.inside) < quota->least - count.inside)
            return quota->variants;
    }
    return NULL;
}

static const uint64_t *weights_at(const MesoWeights *weights, uint32_t variant_count, uint32_t slot)
{
    if (weights->table_count == 0)
        return NULL;
    uint32_t table = weights->slot_table ? weights->slot_table[slot] : 0;
    return weights->tables + (size_t)table * variant_count;
}

uint32_t meso_choose_variant(const MesoPropagation *propagation, const MesoConstraints *constraints,
                             uint32_t slot, bool keeping, MesoRandom *random)
{
    const MesoDomainTable *domains = &propagation->domains;
    uint32_t state = propagation->state[slot];
    if (!constraints)
        return meso_domain_variant(domains, state, meso_random_below(random, domains->domains[state].size));

    const uint64_t *bits = meso_domain_bits(domains, state);
    if (keeping && constraints->keep && constraints->keep[slot] != MESO_NO_INDEX &&
        meso_bits_test(bits, constraints->keep[slot]))
        return constraints->keep[slot];
    const uint64_t *needed = needed_variants(&propagation->quotas, bits, random);
    return draw(bits, needed, domains->states.word_count,
                weights_at(&constraints->weights, domains->variant_count, slot), random);
}
