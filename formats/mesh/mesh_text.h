/*
 * Text of mesh files in pieces: whole lines that threads read beside each other, with words, and errors that
 * find their line once all is read. Lines end with a line feed, after a carriage return or not; those of a file
 * without any line feed end with a carriage return. A byte order mark is passed over.
 */
#ifndef MESO_MESH_TEXT_H
#define MESO_MESH_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "formats/file/input.h"
#include "libcore/base/arena.h"
#include "libcore/base/index.h"

/*
 * Whole lines, which all end with the text's line end; MESO_TEXT_PADDING bytes or more that can be read follow. Where
 * no line end is the file's last byte, the last piece is a copy that has one.
 */
typedef struct MesoTextPiece {
    const char *begin, *end;
    size_t offset;              /* of `begin` in the file */
    MesoStatus status;          /* of what went wrong in this piece first, in the line that begins at */
    size_t wrong;               /* this offset in the file */
    MesoError error;            /* without the name of the file */
} MesoTextPiece;

enum { MESO_TEXT_PADDING = 64, MESO_TEXT_PIECE = 1 << 18 };

typedef struct MesoMeshText {
    const char *path, *data;
    size_t size;
    char line_end;
    char comment;               /* what begins one, or 0 */
    bool joined;                /* lines that end with a backslash go on in the next; comments do not */
    uint32_t piece_count;
    MesoTextPiece *pieces;
} MesoMeshText;

/*
 * Cuts `input` from byte `begin` on into pieces of some MESO_TEXT_PIECE bytes, the same for any number of threads;
 * joined lines are not cut. The input must outlive the text. O(pieces). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_mesh_text_init(MesoMeshText *text, MesoArena *arena, const MesoInput *input, size_t begin, char comment,
                               bool joined, MesoError *error);

/* Calls `body` as meso_parallel_for() does, with one piece at a time. */
void meso_mesh_text_for(const MesoMeshText *text, uint32_t thread_count,
                        void (*body)(void *context, uint64_t begin, uint64_t end), void *context);

/* A line, as far as its words have not been taken yet, without comment and line end. */
typedef struct MesoTextLine {
    const char *begin, *at, *end;
    const char *next;           /* the line behind it */
    char line_end;
} MesoTextLine;

/* The line that begins at `at` in `piece`; false at its end. The second one passes over lines without words. */
bool meso_text_line(const MesoMeshText *text, const MesoTextPiece *piece, const char *at, MesoTextLine *line);
bool meso_text_filled_line(const MesoMeshText *text, const MesoTextPiece *piece, const char *at, MesoTextLine *line);

typedef struct MesoWord {
    const char *text;
    size_t size;
} MesoWord;

/* Takes the next word; false where there is none. */
bool meso_text_word(MesoTextLine *line, MesoWord *word);
bool meso_word_is(MesoWord word, const char *expected);

/* `word` for "%.*s", cut at a length that leaves room for the message. */
#define MESO_WORD_ARGUMENTS(word) (int)((word).size < 40 ? (word).size : 40), (word).text

static inline bool meso_is_blank(char c)
{
    return c == ' ' || (unsigned char)(c - '\t') <= '\r' - '\t';
}

/*
 * Notes what is wrong in the line that begins at `line`, where nothing before it in the piece was. `piece` stops
 * there: what follows is not looked at.
 */
MesoStatus meso_text_wrong(MesoTextPiece *piece, const char *line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* A decimal number, whole and finite as a float; `what` is for the message. */
MesoStatus meso_word_number(MesoTextPiece *piece, const MesoTextLine *line, MesoWord word, const char *what,
                            float *number);

/* A decimal integer of either sign; false for anything else. Beyond +-10^15 it stays there. */
bool meso_word_integer(MesoWord word, int64_t *integer);

/* The first thing that was wrong, with "PATH:LINE: " before it; MESO_OK where nothing was. */
MesoStatus meso_mesh_text_status(const MesoMeshText *text, MesoError *error);

/* Number, from 1, of the line that begins at `offset`; of the file's size, one more than there are lines. */
uint32_t meso_mesh_text_line_number(const MesoMeshText *text, size_t offset);

/* Offset in the file of a place in `piece`. */
static inline size_t meso_text_offset(const MesoTextPiece *piece, const char *at)
{
    return piece->offset + (size_t)(at - piece->begin);
}

#endif
