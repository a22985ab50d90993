#include "formats/mesh/mesh_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "formats/mesh/number_text.h"
#include "libcore/base/parallel.h"

/* ---- lines ---- */

/* The backslash before the line end at `end`, or NULL. */
static const char *joining_backslash(const char *begin, const char *end)
{
    if (end > begin && end[-1] == '\r')
        end--;
    return end > begin && end[-1] == '\\' ? end - 1 : NULL;
}

/* The line end is always there: every piece ends with one. */
static const char *find_end(const MesoMeshText *text, const char *at, const char *limit)
{
    return memchr(at, text->line_end, (size_t)(limit - at));
}

bool meso_text_line(const MesoMeshText *text, const MesoTextPiece *piece, const char *at, MesoTextLine *line)
{
    if (at == piece->end)
        return false;
    line->begin = line->at = at;
    line->line_end = text->line_end;
    for (;;) {
        line->end = find_end(text, at, piece->end);
        line->next = line->end + 1;
        const char *comment = text->comment ? memchr(at, text->comment, (size_t)(line->end - at)) : NULL;
        if (comment) {
            line->end = comment;
            return true;
        }
        if (!text->joined || !joining_backslash(at, line->end) || line->next == piece->end)
            break;
        at = line->next;
    }
    /* a backslash that joins nothing, at the end of the file, is as blank as those that do */
    if (text->joined && joining_backslash(at, line->end))
        line->end = joining_backslash(at, line->end);
    return true;
}

/* A backslash before a line end, inside of joined lines. */
static bool is_join(const MesoTextLine *line, const char *at)
{
    if (*at != '\\')
        return false;
    at++;
    at += at + 1 < line->end && *at == '\r' && line->line_end == '\n';
    return at < line->end && *at == line->line_end;
}

bool meso_text_word(MesoTextLine *line, MesoWord *word)
{
    const char *at = line->at;
    while (at < line->end && (meso_is_blank(*at) || is_join(line, at)))
        at++;
    word->text = at;
    while (at < line->end && !meso_is_blank(*at) && !is_join(line, at))
        at++;
    word->size = (size_t)(at - word->text);
    line->at = at;
    return word->size > 0;
}

bool meso_text_filled_line(const MesoMeshText *text, const MesoTextPiece *piece, const char *at, MesoTextLine *line)
{
    while (meso_text_line(text, piece, at, line)) {
        const char *first = line->at;
        while (first < line->end && meso_is_blank(*first))
            first++;
        if (first < line->end)
            return true;
        at = line->next;
    }
    return false;
}

bool meso_word_is(MesoWord word, const char *expected)
{
    return word.size == strlen(expected) && memcmp(word.text, expected, word.size) == 0;
}

/* ---- pieces ---- */

/* The first place from `at` on where a line begins that no backslash joins to the one before; `limit` at the latest. */
static size_t next_border(const MesoMeshText *text, size_t at, size_t limit)
{
    while (at < limit) {
        const char *end = find_end(text, text->data + at, text->data + limit);
        if (!end)
            return limit;
        at = (size_t)(end - text->data) + 1;
        if (!text->joined || !joining_backslash(text->data, end))
            return at;
    }
    return limit;
}

/* The last one before `at`, `begin` at the least. */
static size_t last_border(const MesoMeshText *text, size_t begin, size_t at)
{
    for (; at > begin; at--)
        if (text->data[at - 1] == text->line_end && !(text->joined &&
                                                      joining_backslash(text->data, text->data + at - 1)))
            return at;
    return begin;
}

/* What may not be followed by padding, or has no line end, is copied: the last lines. */
static MesoStatus copy_tail(const MesoMeshText *text, MesoArena *arena, size_t begin, MesoTextPiece *piece,
                            MesoError *error)
{
    size_t size = text->size - begin;
    char *copy = MESO_NEW(arena, char, size + 1 + MESO_TEXT_PADDING, error);
    if (!copy)
        return MESO_ERR_MEMORY;
    memcpy(copy, text->data + begin, size);
    if (copy[size - 1] != text->line_end)
        copy[size++] = text->line_end;
    *piece = (MesoTextPiece){.begin = copy, .end = copy + size, .offset = begin};
    return MESO_OK;
}

MesoStatus meso_mesh_text_init(MesoMeshText *text, MesoArena *arena, const MesoInput *input, size_t begin, char comment,
                               bool joined, MesoError *error)
{
    const char *data = (const char *)input->data;
    *text = (MesoMeshText){.path = input->path, .data = data, .size = input->size, .comment = comment,
                           .joined = joined};
    text->line_end = memchr(data, '\n', input->size) || !memchr(data, '\r', input->size) ? '\n' : '\r';
    if (begin == 0 && input->size >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0)
        begin = 3;
    text->pieces = MESO_NEW(arena, MesoTextPiece, (input->size - begin) / MESO_TEXT_PIECE + 2, error);
    if (!text->pieces)
        return MESO_ERR_MEMORY;
    if (begin == input->size)
        return MESO_OK;
    size_t tail = input->size - begin > MESO_TEXT_PADDING ? last_border(text, begin, input->size - MESO_TEXT_PADDING) : begin;
    for (size_t at = begin, next; at < tail; at = next) {
        next = tail - at > MESO_TEXT_PIECE ? next_border(text, at + MESO_TEXT_PIECE, tail) : tail;
        text->pieces[text->piece_count++] = (MesoTextPiece){.begin = data + at, .end = data + next, .offset = at};
    }
    return copy_tail(text, arena, tail, &text->pieces[text->piece_count++], error);
}

void meso_mesh_text_for(const MesoMeshText *text, uint32_t thread_count,
                        void (*body)(void *context, uint64_t begin, uint64_t end), void *context)
{
    meso_parallel_for(thread_count, text->piece_count, 1, body, context);
}

/* ---- errors ---- */

MesoStatus meso_text_wrong(MesoTextPiece *piece, const char *line, const char *format, ...)
{
    char message[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    piece->wrong = meso_text_offset(piece, line);
    piece->status = meso_fail(&piece->error, MESO_ERR_INPUT, "%s", message);
    return piece->status;
}

uint32_t meso_mesh_text_line_number(const MesoMeshText *text, size_t offset)
{
    const char *limit = text->data + offset;
    uint32_t line = 1;
    for (const char *at = text->data; (at = find_end(text, at, limit)) != NULL; at++)
        line++;
    return line + (offset == text->size && offset > 0 && limit[-1] != text->line_end);
}

MesoStatus meso_mesh_text_status(const MesoMeshText *text, MesoError *error)
{
    for (const MesoTextPiece *piece = text->pieces; piece < text->pieces + text->piece_count; piece++)
        if (piece->status)
            return meso_fail(error, piece->status, "%s:%u: %s", text->path,
                             meso_mesh_text_line_number(text, piece->wrong), piece->error.message);
    return MESO_OK;
}

/* ---- numbers ---- */

MesoStatus meso_word_number(MesoTextPiece *piece, const MesoTextLine *line, MesoWord word, const char *what,
                            float *number)
{
    if (meso_text_float(word.text, number) != word.text + word.size)
        return meso_text_wrong(piece, line->begin, "%s '%.*s' is not a finite number", what, MESO_WORD_ARGUMENTS(word));
    if (!isfinite(*number))
        return meso_text_wrong(piece, line->begin, "%s '%.*s' is too large", what, MESO_WORD_ARGUMENTS(word));
    return MESO_OK;
}

bool meso_word_integer(MesoWord word, int64_t *integer)
{
    return meso_text_integer(word.text, integer) == word.text + word.size;
}
