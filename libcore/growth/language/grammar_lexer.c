#include "libcore/growth/language/grammar_lexer.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_DIGITS = 40, MOST_EXPONENT = 9999 };

static bool is_digit(char c) { return c >= '0' && c <= '9'; }
static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

void meso_grammar_lexer_begin(MesoGrammarLexer *lexer, const char *path, const char *text, size_t size, MesoError *error)
{
    bool marked = size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0;
    const char *begin = text + (marked ? 3 : 0);
    *lexer = (MesoGrammarLexer){.path = path, .at = begin, .end = text + size, .counted = begin, .line = 1, .column = 1,
                                .wrong = MESO_ERR_INPUT, .error = error};
}

void meso_grammar_wrong(MesoGrammarLexer *lexer, const MesoToken *token, const char *format, ...)
{
    char message[400];
    va_list list;
    if (lexer->status)
        return;
    va_start(list, format);
    vsnprintf(message, sizeof message, format, list);
    va_end(list);
    lexer->status = meso_fail(lexer->error, lexer->wrong, "%.100s:%u:%u: %s", lexer->path, token->line, token->column,
                              message);
    lexer->at = lexer->end;
}

void meso_token_text(const MesoToken *token, char text[64])
{
    if (token->kind == MESO_TOKEN_END)
        snprintf(text, 64, "the end");
    else
        snprintf(text, 64, token->kind == MESO_TOKEN_TEXT ? "\"%.*s\"" : "'%.*s'",
                 (int)(token->length < 40 ? token->length : 40), token->text);
}

bool meso_token_is(const MesoToken *token, const char *text)
{
    bool word = token->kind == MESO_TOKEN_NAME || token->kind == MESO_TOKEN_SIGN;
    return word && strlen(text) == token->length && memcmp(token->text, text, token->length) == 0;
}

/* Line ends are LF, CR LF or CR. */
static void skip_blanks(MesoGrammarLexer *lexer)
{
    for (; lexer->at < lexer->end; lexer->at++) {
        char c = *lexer->at;
        if (c == '#')
            while (lexer->at + 1 < lexer->end && lexer->at[1] != '\n' && lexer->at[1] != '\r')
                lexer->at++;
        else if (c == '\n' || (c == '\r' && !(lexer->at + 1 < lexer->end && lexer->at[1] == '\n'))) {
            lexer->line++;
            lexer->column = 1;
            lexer->counted = lexer->at + 1;
        } else if (c != ' ' && c != '\t' && c != '\r')
            return;
    }
}

/* Bytes that continue a character of UTF-8 are not counted. */
static uint32_t column_of(MesoGrammarLexer *lexer)
{
    for (; lexer->counted < lexer->at; lexer->counted++)
        lexer->column += ((unsigned char)*lexer->counted & 0xc0) != 0x80;
    return lexer->column;
}

static char peek(const MesoGrammarLexer *lexer, size_t ahead)
{
    return (size_t)(lexer->end - lexer->at) > ahead ? lexer->at[ahead] : '\0';
}

/* digits [. digits] [e [+-] digits], written without its point for strtod(), so that no locale has a say. */
static void read_number(MesoGrammarLexer *lexer, MesoToken *token)
{
    char plain[MOST_DIGITS + 16];
    uint32_t count = 0;
    int32_t exponent = 0, written = 0;
    for (bool point = false; is_digit(peek(lexer, 0)) || (!point && peek(lexer, 0) == '.'); lexer->at++) {
        if (*lexer->at == '.')
            point = true;
        else if (count < MOST_DIGITS) {
            plain[count++] = *lexer->at;
            exponent -= point;
        } else
            exponent += !point;
    }
    size_t sign = peek(lexer, 1) == '-' || peek(lexer, 1) == '+';
    if ((peek(lexer, 0) == 'e' || peek(lexer, 0) == 'E') && is_digit(peek(lexer, 1 + sign))) {
        bool negative = peek(lexer, 1) == '-';
        for (lexer->at += 1 + sign; is_digit(peek(lexer, 0)); lexer->at++)
            if (written < MOST_EXPONENT)
                written = 10 * written + (*lexer->at - '0');
        written = negative ? -written : written;
    }
    snprintf(plain + count, sizeof plain - count, "e%d", (exponent < -MOST_EXPONENT ? -MOST_EXPONENT : exponent) + written);
    token->kind = MESO_TOKEN_NUMBER;
    token->number = strtod(plain, NULL);
    if (!isfinite(token->number))
        meso_grammar_wrong(lexer, token, "the number is too large");
}

static void read_text(MesoGrammarLexer *lexer, MesoToken *token)
{
    token->kind = MESO_TOKEN_TEXT;
    token->text = ++lexer->at;
    while (lexer->at < lexer->end && *lexer->at != '"' && (unsigned char)*lexer->at >= ' ')
        lexer->at++;
    token->length = (uint32_t)(lexer->at - token->text);
    if (lexer->at == lexer->end || *lexer->at != '"')
        meso_grammar_wrong(lexer, token, "the text does not end on its line: '\"' is missing");
    else
        lexer->at++;
}

static void read_sign(MesoGrammarLexer *lexer, MesoToken *token)
{
    static const char *const pairs[] = {"->", "<=", ">=", "==", "!=", NULL};
    token->kind = MESO_TOKEN_SIGN;
    token->length = 1;
    for (uint32_t i = 0; pairs[i]; i++)
        if (peek(lexer, 0) == pairs[i][0] && peek(lexer, 1) == pairs[i][1])
            token->length = 2;
    unsigned char c = (unsigned char)*lexer->at;
    if (token->length == 1 && (c == '\0' || !strchr("{}(),:=+-*/%<>", c)))
        meso_grammar_wrong(lexer, token, c > ' ' && c < 127 ? "'%c' has no meaning here"
                                                            : "a character that has no meaning outside texts and comments",
                           c);
    else
        lexer->at += token->length;
}

MesoToken meso_grammar_lexer_next(MesoGrammarLexer *lexer)
{
    skip_blanks(lexer);
    MesoToken token = {.text = lexer->at, .line = lexer->line, .column = column_of(lexer)};
    if (lexer->at == lexer->end)
        return token;
    const char *begin = lexer->at;
    if (is_letter(*begin)) {
        token.kind = MESO_TOKEN_NAME;
        while (is_letter(peek(lexer, 0)) || is_digit(peek(lexer, 0)))
            lexer->at++;
    } else if (is_digit(*begin) || (*begin == '.' && is_digit(peek(lexer, 1)))) {
        read_number(lexer, &token);
    } else if (*begin == '"') {
        read_text(lexer, &token);
        return token;
    } else {
        read_sign(lexer, &token);
        return token;
    }
    token.length = (uint32_t)(lexer->at - begin);
    return token;
}
