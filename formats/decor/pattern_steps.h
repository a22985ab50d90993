/* Steps of a pattern, its macros written out. */
#ifndef MESO_PATTERN_STEPS_H
#define MESO_PATTERN_STEPS_H

#include "formats/decor/pattern_parser.h"

/* A list of steps. */
void meso_pattern_steps(MesoPatternParser *parser, const MesoJsonField *list, const MesoStep **steps, uint32_t *count);

#endif
