#include "formats/mesh_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

MesoStatus meso_mesh_text_init(MesoMeshText *text, MesoArena *arena, const MesoInput *input,
                               char comment, MesoError *error)
{
    *text = (MesoMeshText){.path = input->path, .comment = comment, .size = input->size, .next_line = 1};
    text->bytes = MESO_NEW(arena, char, input->size + 1, error);
    if (!text->bytes)
        return MESO_ERR_MEMORY;
    memcpy(text->bytes, input->data, input->size);
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
