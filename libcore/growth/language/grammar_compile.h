/* Code from the tree of a grammar. */
#ifndef MESO_GRAMMAR_COMPILE_H
#define MESO_GRAMMAR_COMPILE_H

#include "libcore/growth/language/grammar_tree.h"

/* Fills in the code of rules and seeds. O(size). */
void meso_grammar_compile(MesoGrammarParser *parser);

#endif
