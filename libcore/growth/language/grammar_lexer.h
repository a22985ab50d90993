/* The words and signs of a grammar's text, and what is said of wrong ones. */
#ifndef MESO_GRAMMAR_LEXER_H
#define MESO_GRAMMAR_LEXER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "libcore/base/error.h"

typedef enum MesoTokenKind {
    MESO_TOKEN_END, MESO_TOKEN_NAME, MESO_TOKEN_NUMBER, MESO_TOKEN_TEXT, MESO_TOKEN_SIGN
} MesoTokenKind;

typedef struct MesoToken {
    MesoTokenKind kind;
    const char *text;           /* [length]; of a text without its quotation marks */
    uint32_t length;
    uint32_t line, column;      /* from 1; columns count characters, not bytes */
    double number;
} MesoToken;

typedef struct MesoGrammarLexer {
    const char *path;
    const char *at, *end;
    const char *counted;        /* `column` is that of the character there */
    uint32_t line, column;
    MesoStatus status;          /* the first thing wrong; tokens are at an end then */
    MesoStatus wrong;           /* what status that is: MESO_ERR_INPUT, or MESO_ERR_USAGE for the command line */
    MesoError *error;
} MesoGrammarLexer;

/* The text [size] is read to its end, and need not end with a zero. */
void meso_grammar_lexer_begin(MesoGrammarLexer *lexer, const char *path, const char *text, size_t size, MesoError *error);

MesoToken meso_grammar_lexer_next(MesoGrammarLexer *lexer);

/* Says what is wrong at `token`, "path:line:column: ...", unless something was wrong before. */
void meso_grammar_wrong(MesoGrammarLexer *lexer, const MesoToken *token, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* What a token looks like, for messages: "'wall'", "the end"; in `text` [64]. */
void meso_token_text(const MesoToken *token, char text[64]);

bool meso_token_is(const MesoToken *token, const char *text);

#endif
