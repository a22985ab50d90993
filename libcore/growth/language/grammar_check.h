/* What can be said of a grammar once all of it is read. */
#ifndef MESO_GRAMMAR_CHECK_H
#define MESO_GRAMMAR_CHECK_H

#include "libcore/growth/language/grammar_tree.h"

/*
 * Types of all that is reached from seeds: a rule's arguments have those that it is called with. O(size * arguments).
 */
void meso_grammar_check_types(MesoGrammarParser *parser);

/* That no rule comes back to itself without a step: it would never end where it is. O(size). */
void meso_grammar_check_progress(MesoGrammarParser *parser);

#endif
