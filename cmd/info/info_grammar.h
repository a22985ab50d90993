/* What meso-info says about grammars of growth. */
#ifndef MESO_INFO_GRAMMAR_H
#define MESO_INFO_GRAMMAR_H

#include <jansson.h>

#include "formats/file/input.h"
#include "libcore/base/arena.h"

/* Reads and checks all of `input`, and sets what it found in `facts`. */
MesoStatus meso_info_grammar(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
