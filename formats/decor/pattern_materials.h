/* The materials of a pattern. */
#ifndef MESO_PATTERN_MATERIALS_H
#define MESO_PATTERN_MATERIALS_H

#include "formats/decor/pattern_parser.h"

/* A table from names to colours and materials; a grey one where it is missing or empty. */
void meso_pattern_materials(MesoPatternParser *parser, const MesoJsonField *field, MesoPattern *pattern);

#endif
