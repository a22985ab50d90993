/* What the parts of the parser share. Once something is wrong they do nothing more; what they return can be used. */
#ifndef MESO_GRAMMAR_PARSER_H
#define MESO_GRAMMAR_PARSER_H

#include "libcore/growth/language/grammar_tree.h"
#include "libcore/growth/language/grammar_type.h"

/* The declarations of a whole text: what the grammar holds but for its code. */
void meso_parse_grammar(MesoGrammarParser *parser, const char *text, size_t size);

/* A quantity; where nothing in it depends on the place, a constant. */
MesoExpression *meso_parse_expression(MesoGrammarParser *parser);

/* A constant of type `wanted`; `what` is for messages. */
double meso_parse_constant(MesoGrammarParser *parser, MesoGrammarType wanted, const char *what);

/* "(...)" for `slots`, by place or name; none where all may be left out. */
void meso_parse_arguments(MesoGrammarParser *parser, const MesoToken *of, const MesoGrammarSlot *slots,
                          MesoArgument *arguments);

/* A source of `family` with its arguments; numbers of seeds stay expressions. Returns its word, or NULL. */
const MesoGrammarSourceWord *meso_parse_source(MesoGrammarParser *parser, MesoGrammarFamily family, const char *what,
                                               MesoGrammarSource *source, MesoArgument *arguments);

/* Number of a field, by name or written here, perhaps with '-' before it. */
uint32_t meso_parse_direction(MesoGrammarParser *parser);

/* "{ ... }". Names that are given in it end with it. */
MesoBlock meso_parse_block(MesoGrammarParser *parser);

/* A block, or one statement. */
MesoBlock meso_parse_body(MesoGrammarParser *parser);

/* "Name(arguments)" */
MesoStatement *meso_parse_rule_call(MesoGrammarParser *parser);

/* grammar_names.c */

void meso_parse_advance(MesoGrammarParser *parser);

/* Whether the next token is this word or sign; accept() goes on where it is, expect() says so where it is not. */
bool meso_parse_at(const MesoGrammarParser *parser, const char *text);
bool meso_parse_accept(MesoGrammarParser *parser, const char *text);
void meso_parse_expect(MesoGrammarParser *parser, const char *text, const char *where);

/* A name that means nothing yet. */
MesoToken meso_parse_new_name(MesoGrammarParser *parser, const char *what);

/* What a token names, or NULL. */
const MesoNamed *meso_parse_find(const MesoGrammarParser *parser, const MesoToken *token);

void meso_parse_add_name(MesoGrammarParser *parser, const MesoToken *token, MesoNameKind kind, uint32_t index);

/* A new local's register, with a name or without. */
uint32_t meso_parse_add_local(MesoGrammarParser *parser, const MesoToken *token);

/* Says that `token` is no `what` and which one may be meant: of names of `kind`, and of `words` up to a NULL. */
void meso_parse_unknown(MesoGrammarParser *parser, const MesoToken *token, const char *what, MesoNameKind kind,
                        const char *const *words);

/* Number of a rule by its name, new where it is not known. */
uint32_t meso_parse_rule_number(MesoGrammarParser *parser, const MesoToken *token);

/* A place in the text for draws (`child`: for keys of branches). */
uint32_t meso_parse_site(MesoGrammarParser *parser, bool child);

/* Zeroed memory; NULL where it is out, with the status set. */
void *meso_parse_allocate(MesoGrammarParser *parser, size_t count, size_t size);

/* A copy of a token's text with its zero; "" where memory is out. */
const char *meso_parse_copy(MesoGrammarParser *parser, const MesoToken *token);

/* One more deep: false, and told, where that is too deep. */
bool meso_parse_enter(MesoGrammarParser *parser);

/* As MESO_GROW, with the parser's arena and status. */
#define MESO_PARSE_GROW(parser, array, count, room)                                                              \
    ((array) = MESO_GROW((parser)->arena, array, count, room, 16, (parser)->lexer.error),                        \
     (array) ? true : ((parser)->lexer.status = MESO_ERR_MEMORY, (parser)->lexer.at = (parser)->lexer.end, false))

#endif
