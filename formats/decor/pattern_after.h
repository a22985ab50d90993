/* What regions get: painting, displacement, names; a split's children by their tags, or what a step selects. */
#ifndef MESO_PATTERN_AFTER_H
#define MESO_PATTERN_AFTER_H

#include "formats/decor/pattern_parser.h"

/* "paint", "displace" and "names" of an operator that makes children with these tags (ended by NULL). */
void meso_pattern_after_split(MesoPatternParser *parser, const MesoJsonField *step, const char *const *tags,
                              const MesoAfterSplit **after, uint32_t *count);

/* "paint" or "displace" of a step that is nothing else. */
void meso_pattern_after_alone(MesoPatternParser *parser, const MesoJsonField *step, const MesoAfterSplit **after,
                              uint32_t *count);

#endif
