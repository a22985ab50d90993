/* What a pattern is read from, up to some limits: its text, and the files that it names. */
#ifndef MESO_PATTERN_SOURCE_H
#define MESO_PATTERN_SOURCE_H

#include "formats/json/json_files.h"

enum {
    MESO_PATTERN_VERSION = 1,
    MESO_MACROS_VERSION = 1,
    MESO_PATTERN_STEPS = 1 << 16,       /* the most steps, those of macros counted for each call */
    MESO_PATTERN_VALUES = 1 << 20,      /* the most values of JSON that all calls of macros write out */
    MESO_PATTERN_SEEDS = 1 << 20,       /* the most places of seeds, points of files among them */
    MESO_PATTERN_NESTING = 32           /* of macros in macros */
};

#endif
