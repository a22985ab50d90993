/* Which regions a step of a pattern is for: "on". */
#ifndef MESO_PATTERN_SELECTOR_H
#define MESO_PATTERN_SELECTOR_H

#include "formats/decor/pattern_parser.h"

/* A path or an object; missing, everything in the scope. */
void meso_pattern_selector(MesoPatternParser *parser, const MesoJsonField *field, MesoSelector *selector);

/* The same of a rule of growth, which looks at path, tag and shape alone. */
void meso_pattern_rule_selector(MesoPatternParser *parser, const MesoJsonField *field, MesoSelector *selector);

/* Every tag that regions can have, ended by NULL. */
extern const char *const meso_pattern_tags[];

#endif
