/* Grammars from text. */
#ifndef MESO_GRAMMAR_READ_H
#define MESO_GRAMMAR_READ_H

#include "libcore/growth/language/grammar.h"

/*
 * Reads `text` [size] into `arena`; `path` is for messages. All names are known, types fit, every rule that comes back
 * to itself makes a step on the way, and nothing runs beyond its bounds: what is read can be run. MESO_ERR_INPUT says
 * "path:line:column: ...", MESO_ERR_USAGE what is wrong with a setting. O(size * most arguments of a rule).
 */
MesoStatus meso_grammar_read(MesoGrammar *grammar, MesoArena *arena, const char *path, const char *text, size_t size,
                             const MesoGrammarOptions *options, MesoError *error);

#endif
