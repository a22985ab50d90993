#include "libcore/tiling/problem/weights.h"

#include <assert.h>
#include <math.h>

MesoWeight *meso_weights_of_variants(MesoArena *arena, const MesoVariantSet *variants,
                                     uint32_t tile_count, uint32_t table_count,
                                     const MesoWeight *tile_weights, MesoError *error)
{
    MesoWeight *tables = MESO_NEW(arena, MesoWeight, (size_t)table_count * variants->count, error);
    MesoArenaMark mark = meso_arena_mark(arena);
    uint32_t *shares = MESO_NEW(arena, uint32_t, tile_count, error);
    if (!tables || !shares)
        return NULL;
    for (uint32_t v = 0; v < variants->count; v++)
        shares[variants->tile[v]]++;
    for (uint32_t t = 0; t < table_count; t++)
        for (uint32_t v = 0; v < variants->count; v++) {
            MesoWeight weight = tile_weights[(size_t)t * tile_count + variants->tile[v]];
            assert(weight.amount <= MESO_WEIGHT_PARTS * (uint64_t)(weight.ramp == MESO_NO_INDEX ? MESO_WEIGHT_LIMIT : 1));
            weight.amount *= MESO_WEIGHT_SCALE / shares[variants->tile[v]];
            tables[(size_t)t * variants->count + v] = weight;
        }
    meso_arena_rewind(arena, mark);
    return tables;
}

static double ramp_weight(const MesoWeightRamp *ramp, uint32_t slot)
{
    const MesoWeightStop *stops = ramp->stops;
    double value = ramp->values[slot];
    uint32_t low = 0, high = ramp->stop_count - 1;
    if (!(value > stops[low].value))
        return stops[low].weight;
    if (value >= stops[high].value)
        return stops[high].weight;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (value >= stops[middle].value)
            low = middle;
        else
            high = middle;
    }
    /* Of halves, whose difference is finite. */
    double part = (value / 2 - stops[low].value / 2) / (stops[high].value / 2 - stops[low].value / 2);
    return stops[low].weight + part * (stops[high].weight - stops[low].weight);
}

uint64_t meso_weight_at(const MesoWeights *weights, uint32_t slot, uint32_t variant)
{
    size_t table = weights->slot_table ? weights->slot_table[slot] : 0;
    MesoWeight weight = weights->tables[table * weights->variant_count + variant];
    if (weight.ramp == MESO_NO_INDEX)
        return weight.amount;
    return (uint64_t)floor((double)weight.amount * ramp_weight(&weights->ramps[weight.ramp], slot) + 0.5);
}

/* Uniform in [0, bound) for bounds beyond 32 bits: draws again above the last whole multiple. */
static uint64_t random_below_wide(MesoRandom *random, uint64_t bound)
{
    uint64_t excess = (0u - bound) % bound;     /* 2^64 modulo the bound */
    uint64_t draw = meso_random_next(random);
    while (excess && draw > UINT64_MAX - excess)
        draw = meso_random_next(random);
    return draw % bound;
}

static uint64_t random_below(MesoRandom *random, uint64_t bound)
{
    return bound <= UINT32_MAX ? meso_random_below(random, (uint32_t)bound) : random_below_wide(random, bound);
}

/* NULL where all variants are alike. */
static const MesoWeights *given(const MesoWeights *weights)
{
    return weights && weights->table_count ? weights : NULL;
}

static uint64_t both(const uint64_t *bits, const uint64_t *also, uint32_t w)
{
    return also ? bits[w] & also[w] : bits[w];
}

static uint64_t sum_bits(const MesoWeights *weights, uint32_t slot, const uint64_t *bits,
                         const uint64_t *also, uint32_t words)
{
    uint64_t sum = 0;
    for (uint32_t w = 0; w < words; w++) {
        uint64_t rest = both(bits, also, w);
        if (!weights)
            sum += (uint64_t)__builtin_popcountll(rest);
        for (; weights && rest; rest &= rest - 1)
            sum += meso_weight_at(weights, slot, 64 * w + (uint32_t)__builtin_ctzll(rest));
    }
    return sum;
}

uint32_t meso_weights_draw(const MesoWeights *weights, uint32_t slot, const uint64_t *bits,
                           const uint64_t *also, uint32_t words, MesoRandom *random)
{
    weights = given(weights);
    uint64_t sum = sum_bits(weights, slot, bits, also, words);
    if (sum == 0) {
        weights = NULL;
        sum = sum_bits(NULL, slot, bits, also, words);
    }
    uint64_t rank = random_below(random, sum);
    for (uint32_t w = 0; w < words; w++)
        for (uint64_t rest = both(bits, also, w); rest; rest &= rest - 1) {
            uint32_t variant = 64 * w + (uint32_t)__builtin_ctzll(rest);
            uint64_t weight = weights ? meso_weight_at(weights, slot, variant) : 1;
            if (rank < weight)
                return variant;
            rank -= weight;
        }
    return MESO_NO_INDEX;
}

uint32_t meso_weights_draw_listed(const MesoWeights *weights, uint32_t slot, const uint32_t *list,
                                  uint32_t count, MesoRandom *random)
{
    uint64_t sum = 0;
    weights = given(weights);
    for (uint32_t i = 0; weights && i < count; i++)
        sum += meso_weight_at(weights, slot, list[i]);
    if (sum == 0)
        return list[meso_random_below(random, count)];
    uint64_t rank = random_below(random, sum);
    for (uint32_t i = 0; i < count; i++) {
        uint64_t weight = meso_weight_at(weights, slot, list[i]);
        if (rank < weight)
            return list[i];
        rank -= weight;
    }
    return MESO_NO_INDEX;
}
