/* "did you mean": the word nearest to one that is not known. */
#ifndef MESO_NEAREST_H
#define MESO_NEAREST_H

#include <stddef.h>

typedef struct MesoNearest {
    const char *text;       /* [length] what was written */
    size_t length;
    const char *best;       /* a word that `text` begins, or the nearest, where half of it is right; NULL: none */
    size_t least;
} MesoNearest;

MesoNearest meso_nearest(const char *text, size_t length);

/* Compares one of the words that there are; of two that are as near, the first one stays. O(length of both). */
void meso_nearest_try(MesoNearest *nearest, const char *word);

#endif
