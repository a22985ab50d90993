/* Fields of a pattern's steps: seeds, distances and blends of them, noise, levels. */
#ifndef MESO_PATTERN_FIELD_H
#define MESO_PATTERN_FIELD_H

#include "formats/decor/pattern_parser.h"

/* {"dist": SEEDS} or {"blend": [SEEDS, SEEDS]}, and "noise"; the distance from all borders where neither is given. */
void meso_pattern_field(MesoPatternParser *parser, const MesoJsonField *object, MesoFieldSpec *spec);

/* "at", "count" or "every", and "unit", of the field that `object` has. */
void meso_pattern_levels(MesoPatternParser *parser, const MesoJsonField *object, MesoLevels *levels);

#endif
