/* Where fields begin, and the points of polylines. */
#ifndef MESO_PATTERN_SEEDS_H
#define MESO_PATTERN_SEEDS_H

#include "formats/decor/pattern_parser.h"

/* A word, an object, or a list of them, their union; missing, all borders. */
void meso_pattern_seeds(MesoPatternParser *parser, const MesoJsonField *field, MesoSeedSet *seeds);

/* True if `value` is an object that is a seed. */
bool meso_pattern_is_seed(const json_t *value);

/* Points of the surface in a row, `least` or more: a list of [x, y, z] and of seeds that are points. */
const MesoSeedSpec *meso_pattern_row(MesoPatternParser *parser, const MesoJsonField *field, uint32_t least,
                                     uint32_t *count);

#endif
