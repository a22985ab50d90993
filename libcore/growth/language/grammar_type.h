/* Types of quantities: which of them go together. */
#ifndef MESO_GRAMMAR_TYPE_H
#define MESO_GRAMMAR_TYPE_H

#include "libcore/growth/language/grammar_tree.h"

/* "a length", "an angle", "a number", "a condition", "a quantity in length^2"; in `text` [64]. */
void meso_grammar_type_text(MesoGrammarType type, char text[64]);

/* The type of an expression whose locals have `types`; what does not go together is told to `lexer`. */
MesoGrammarType meso_type_of(MesoGrammarLexer *lexer, const MesoExpression *expression, const MesoGrammarType *types);

/* Says that a quantity of type `wanted` belongs at `at`, for `what`, where `type` is another. */
void meso_type_want(MesoGrammarLexer *lexer, const MesoToken *at, MesoGrammarType type, MesoGrammarType wanted,
                    const char *what);

/* The same of an argument. */
void meso_type_want_slot(MesoGrammarLexer *lexer, const MesoToken *at, MesoGrammarType type,
                         const MesoGrammarSlot *slot);

/* Whether `type` and `other` go together; `type` becomes what both are. */
bool meso_type_join(MesoGrammarType *type, MesoGrammarType other);

#endif
