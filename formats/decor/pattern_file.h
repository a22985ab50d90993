/* Recursive patterns of meso-decor from files (.pattern.json, "meso-pattern", version 1): meso-pattern(5). */
#ifndef MESO_PATTERN_FILE_H
#define MESO_PATTERN_FILE_H

#include "formats/decor/pattern_source.h"
#include "libcore/base/arena.h"
#include "libcore/decor/pattern.h"

/*
 * Reads a pattern into `arena`: macros are written out, names of materials are numbers, what was left out has its
 * default. `files` may be NULL; a pattern that names others is then refused. Every number is finite, each range in
 * order, each number of a material below their count, of which there is at least one. MESO_ERR_INPUT names the file and
 * the place ("steps[3].macro grid.steps[1].contour.at: ..."), the line and column where the JSON itself is broken, and
 * a newer version. O(size of the files + steps written out), which the limits of pattern_source.h bound.
 */
MesoStatus meso_pattern_read(MesoPattern *pattern, MesoArena *arena, const MesoInput *input,
                             const MesoJsonFiles *files, MesoError *error);

/* The text of the built-in macros, a file as "macro_files" may name. */
extern const char meso_builtin_macros[];

#endif
