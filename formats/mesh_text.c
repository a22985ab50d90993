#include "formats/mesh_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool has_newline(const char *begin, const char *end)
{
    return memchr(begin, '\n', (size_t)(end - begin)) != NULL;
}

/* Old line ends, a carriage return alone, become new ones, up to and with that of the line `last` (NULL: of all). */
static char *renew_line_ends(char *begin, char *end, const char *last)
{
    size_t length = last ? strlen(last) : 0;
    for (char *at = begin, *line = begin; at < end; at++) {
        if (*at != '\r')
            continue;
        *at = '\n';
        if (last && (size_t)(at - line) == length && memcmp(line, last, length) == 0)
            return at + 1;
        line = at + 1;
    }
    return end;
}

static bool is_ascii_header(const char *begin, const char *end)
{
    static const char ascii[] = "format ascii";
    for (const char *line = begin; line && (size_t)(end - line) >= sizeof ascii; line = memchr(line, '\n', (size_t)(end - line))) {
        line += *line == '\n';
        if ((size_t)(end - line) >= sizeof ascii && memcmp(line, ascii, sizeof ascii - 1) == 0)
            return true;
    }
    return false;
}

/* The header of a PLY, whose format has no comment sign, is text whatever bytes come after it. */
static void mend_line_ends(MesoMeshText *text)
{
    char *begin = text->bytes, *end = begin + text->size, *header_end = begin;
    if (!text->comment) {
        if (text->size < 5 || memcmp(begin, "ply\r", 4) != 0 || begin[4] == '\n')
            return;
        header_end = renew_line_ends(begin, end, "end_header");
        if (!is_ascii_header(begin, header_end))
            return;
    }
    if (!has_newline(header_end, end))
        renew_line_ends(header_end, end, NULL);
}

MesoStatus meso_mesh_text_init(MesoMeshText *text, MesoArena *arena, const MesoInput *input,
                               char comment, MesoError *error)
{
    size_t mark = meso_input_mark(input);
    *text = (MesoMeshText){.path = input->path, .comment = comment, .size = input->size - mark, .next_line = 1};
    text->bytes = MESO_NEW(arena, char, input->size + 1, error);
    if (!text->bytes)
        return MESO_ERR_MEMORY;
    memcpy(text->bytes, input->data + mark, text->size);
    mend_line_ends(text);
    text->at = text->end = text->next = text->bytes;
    return MESO_OK;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static char *line_end(const MesoMeshText *text, char *begin)
{
    char *end = memchr(begin, '\n', (size_t)(text->bytes + text->size - begin));
    return end ? end : text->bytes + text->size;
}

/* Where the backslash before the line end at `end` stands, or NULL. */
static char *joining_backslash(char *begin, char *end)
{
    if (end > begin && end[-1] == '\r')
        end--;
    return end > begin && end[-1] == '\\' ? end - 1 : NULL;
}

static char *comment_begin(const MesoMeshText *text, char *begin, char *end)
{
    return text->comment ? memchr(begin, text->comment, (size_t)(end - begin)) : NULL;
}

bool meso_mesh_text_line(MesoMeshText *text, bool joined)
{
    char *limit = text->bytes + text->size;
    text->at = text->end = text->next;
    text->line = text->next_line;
    if (text->at == limit)
        return false;

    text->end = line_end(text, text->at);
    text->next_line++;
    char *comment = comment_begin(text, text->at, text->end);
    char *backslash;
    while (!comment && joined && (backslash = joining_backslash(text->at, text->end))) {
        char *more = text->end < limit ? text->end + 1 : limit;
        memset(backslash, ' ', (size_t)(more - backslash));
        if (more == limit)
            break;
        text->end = line_end(text, more);
        text->next_line++;
        comment = comment_begin(text, more, text->end);
    }
    text->next = text->end < limit ? text->end + 1 : limit;
    if (comment)
        memset(comment, ' ', (size_t)(text->end - comment));
    return true;
}

bool meso_mesh_text_filled_line(MesoMeshText *text)
{
    while (meso_mesh_text_line(text, false)) {
        while (text->at < text->end && is_blank(*text->at))
            text->at++;
        if (text->at < text->end)
            return true;
    }
    return false;
}

bool meso_mesh_text_word(MesoMeshText *text, MesoWord *word)
{
    char *at = text->at;
    while (at < text->end && is_blank(*at))
        at++;
    word->text = at;
    while (at < text->end && !is_blank(*at))
        at++;
    word->size = (size_t)(at - word->text);
    text->at = at;
    return word->size > 0;
}

bool meso_word_is(MesoWord word, const char *expected)
{
    return word.size == strlen(expected) && memcmp(word.text, expected, word.size) == 0;
}

MesoStatus meso_mesh_text_fail(const MesoMeshText *text, MesoError *error, const char *format, ...)
{
    char message[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return meso_fail(error, MESO_ERR_INPUT, "%s:%u: %s", text->path, text->line, message);
}

/* Keeps strtof from hexadecimal numbers and from "nan" and "inf". */
static bool is_decimal(MesoWord word)
{
    for (size_t i = 0; i < word.size; i++) {
        char c = word.text[i];
        if ((c < '0' || c > '9') && c != '.' && c != '-' && c != '+' && c != 'e' && c != 'E')
            return false;
    }
    return true;
}

/* The tools keep to the C locale, where the decimal separator is a point. */
MesoStatus meso_word_number(const MesoMeshText *text, MesoWord word, const char *what, float *number,
                            MesoError *error)
{
    char *end = NULL;
    if (is_decimal(word))
        *number = strtof(word.text, &end);
    if (end != word.text + word.size)
        return meso_mesh_text_fail(text, error, "%s '%.*s' is not a finite number", what,
                                   MESO_WORD_ARGUMENTS(word));
    if (!isfinite(*number))
        return meso_mesh_text_fail(text, error, "%s '%.*s' is too large", what,
                                   MESO_WORD_ARGUMENTS(word));
    return MESO_OK;
}

bool meso_word_integer(MesoWord word, int64_t *integer)
{
    const int64_t limit = 1000000000000000;
    bool negative = word.size > 0 && word.text[0] == '-';
    size_t i = negative || (word.size > 0 && word.text[0] == '+');
    if (i == word.size)
        return false;
    *integer = 0;
    for (; i < word.size; i++) {
        if (word.text[i] < '0' || word.text[i] > '9')
            return false;
        *integer = 10 * *integer + (word.text[i] - '0');
        if (*integer > limit)
            *integer = limit;
    }
    if (negative)
        *integer = -*integer;
    return true;
}
