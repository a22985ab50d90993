#include "libcore/tiling/search/variant_choice.h"

static uint32_t common_count(const uint64_t *bits, const uint64_t *also, uint32_t words)
{
    uint32_t count = 0;
    for (uint32_t w = 0; w < words; w++)
        count += (uint32_t)__builtin_popcountll(bits[w] & also[w]);
    return count;
}

/* Variants of a quota that the draw is to come from, or NULL. */
static const uint64_t *needed_variants(const MesoQuotaTrack *track, const uint64_t *bits, MesoRandom *random)
{
    for (uint32_t q = 0; q < track->count; q++) {
        const MesoQuota *quota = &track->quotas[q];
        MesoQuotaCount count = track->counts[q];
        if (count.inside >= quota->least || common_count(bits, quota->variants, track->word_count) == 0)
            continue;
        if (count.possible <= count.inside)
            continue;
        if (meso_random_below(random, count.possible - count.inside) < quota->least - count.inside)
            return quota->variants;
    }
    return NULL;
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
    return meso_weights_draw(&constraints->weights, slot, bits, needed, domains->states.word_count, random);
}
