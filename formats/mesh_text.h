/*
 * Lines, words and numbers of text mesh files, with line numbers. The text is
 * a copy that ends with a zero byte, so that readers can blank out what the
 * next reader of it must not see.
 */
#ifndef MESO_MESH_TEXT_H
#define MESO_MESH_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "formats/file/input.h"
#include "libcore/base/arena.h"

typedef struct MesoMeshText {
    const char *path;
    char comment;           /* what begins a comment, or 0 */
    char *bytes;            /* [size + 1] */
    size_t size;
    char *at, *end;         /* what is left of the current line, without its end */
    char *next;             /* the line after it */
    uint32_t line;          /* number of the current line, from 1 */
    uint32_t next_line;
} MesoMeshText;

typedef struct MesoWord {
    char *text;
    size_t size;
} MesoWord;

/*
 * Copies the text without its byte order mark. Where lines end in carriage returns alone, these become
 * newlines; in a binary PLY those of the header. `comment` is 0 for PLY.
 */
MesoStatus meso_mesh_text_init(MesoMeshText *text, MesoArena *arena, const MesoInput *input,
                               char comment, MesoError *error);

/*
 * Goes to the next line; false at the end. Comments are blanked out. With
 * `joined`, a line that ends with a backslash goes on in the next one (comments
 * do not); backslash and line end become blanks.
 */
bool meso_mesh_text_line(MesoMeshText *text, bool joined);

/* Goes to the next line that has a word. */
bool meso_mesh_text_filled_line(MesoMeshText *text);

/* Takes the next word of the line; false where there is none. */
bool meso_mesh_text_word(MesoMeshText *text, MesoWord *word);

bool meso_word_is(MesoWord word, const char *expected);

/* Fails with "PATH:LINE: " before the message. */
MesoStatus meso_mesh_text_fail(const MesoMeshText *text, MesoError *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* A decimal number, whole and finite as a float; `what` is for the message. */
MesoStatus meso_word_number(const MesoMeshText *text, MesoWord word, const char *what, float *number,
                            MesoError *error);

/* A decimal integer of either sign; false for anything else. Beyond +-10^15 it stays there. */
bool meso_word_integer(MesoWord word, int64_t *integer);

/* `word` for "%.*s", cut at a length that leaves room for the message. */
#define MESO_WORD_ARGUMENTS(word) (int)((word).size < 40 ? (word).size : 40), (word).text

#endif
