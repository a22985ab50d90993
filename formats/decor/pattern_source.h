/* What a pattern is read from: its text and the files that it names, up to some limits. */
#ifndef MESO_PATTERN_SOURCE_H
#define MESO_PATTERN_SOURCE_H

#include "formats/file/input.h"

enum {
    MESO_PATTERN_VERSION = 1,
    MESO_MACROS_VERSION = 1,
    MESO_PATTERN_STEPS = 1 << 16,       /* the most steps, those of macros counted for each call */
    MESO_PATTERN_VALUES = 1 << 20,      /* the most values of JSON that all calls of macros write out */
    MESO_PATTERN_SEEDS = 1 << 20,       /* the most places of seeds, points of files among them */
    MESO_PATTERN_NESTING = 32           /* of macros in macros */
};

/* How the reader gets at the files that a pattern names: other macros, points. */
typedef struct MesoPatternFiles {
    void *context;
    /*
     * The file that the pattern calls `name`, as it is written there; the caller's, and open until the
     * pattern has been read. Asked for once for each name. NULL, with `error` filled, where it cannot be had.
     */
    const MesoInput *(*open)(void *context, const char *name, MesoError *error);
} MesoPatternFiles;

#endif
