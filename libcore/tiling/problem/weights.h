/*
 * Weights of variants: how likely each is where the solver has a choice. The
 * chance of a variant is its weight over the sum of those still possible; where
 * all of them weigh 0, each has the same.
 */
#ifndef MESO_WEIGHTS_H
#define MESO_WEIGHTS_H

#include "libcore/base/arena.h"
#include "libcore/base/random.h"
#include "libcore/tiling/tile/variant.h"

/*
 * A tile's weight, up to MESO_WEIGHT_LIMIT, is shared equally by its variants,
 * so that weights compare tiles however many ways each may be turned.
 * MESO_WEIGHT_SCALE can be divided by every number of variants, 1 to 8.
 * Draws take whole numbers: weights with fractions are counted in parts of
 * one, MESO_WEIGHT_PARTS of them, all weights of a problem alike.
 */
enum { MESO_WEIGHT_LIMIT = 1000000, MESO_WEIGHT_SCALE = 840, MESO_WEIGHT_PARTS = 1000 };

typedef struct MesoWeightStop {
    double value;               /* finite */
    double weight;              /* 0 to MESO_WEIGHT_LIMIT */
} MesoWeightStop;

/*
 * A weight that follows an attribute of slots: linear between stops, the same
 * before the first one as there, and behind the last one as there.
 */
typedef struct MesoWeightRamp {
    const double *values;       /* [slot_count] the attribute; not NaN where the ramp is used */
    uint32_t stop_count;        /* at least 1 */
    const MesoWeightStop *stops;    /* [stop_count] by ascending value */
} MesoWeightRamp;

/* `amount`, or `amount` times the weight of a ramp. */
typedef struct MesoWeight {
    uint64_t amount;
    uint32_t ramp;              /* MESO_NO_INDEX: none */
} MesoWeight;

/* Ramps are evaluated for a slot when it is drawn for: they take no memory by slot. */
typedef struct MesoWeights {
    uint32_t table_count;       /* 0: every variant has the same chance */
    uint32_t variant_count;
    const MesoWeight *tables;   /* [table_count * variant_count] */
    const uint32_t *slot_table; /* [slot_count] table of each slot; NULL: the first for all */
    const MesoWeightRamp *ramps;
} MesoWeights;

/*
 * Tables of variants from tables of tile weights, [table_count * tile_count], whose amounts are at
 * most MESO_WEIGHT_LIMIT, and 1 with a ramp; both times MESO_WEIGHT_PARTS where they count parts.
 * NULL: out of memory.
 */
MesoWeight *meso_weights_of_variants(MesoArena *arena, const MesoVariantSet *variants,
                                     uint32_t tile_count, uint32_t table_count,
                                     const MesoWeight *tile_weights, MesoError *error);

/*
 * What `variant` weighs at `slot`, in units of an amount of 1 over MESO_WEIGHT_SCALE; a ramp's
 * weight is rounded to a whole number of them, times the tile's variants. O(log(stops)).
 */
uint64_t meso_weight_at(const MesoWeights *weights, uint32_t slot, uint32_t variant);

/*
 * One of the variants of `bits` [words], and of `also` unless that is NULL, by
 * their weights at `slot`. There must be one. `weights` may be NULL: all alike.
 * O(words + variants).
 */
uint32_t meso_weights_draw(const MesoWeights *weights, uint32_t slot, const uint64_t *bits,
                           const uint64_t *also, uint32_t words, MesoRandom *random);

/* The same from `list` [count], count > 0. */
uint32_t meso_weights_draw_listed(const MesoWeights *weights, uint32_t slot, const uint32_t *list,
                                  uint32_t count, MesoRandom *random);

#endif
