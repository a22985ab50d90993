#include "libcore/base/nearest.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { LONGEST = 32 };

/* Levenshtein's distance of short words, by one row of his table. */
static size_t word_distance(const char *a, size_t a_length, const char *b)
{
    size_t row[LONGEST + 1], b_length = strlen(b);
    if (a_length > LONGEST || b_length > LONGEST)
        return SIZE_MAX;
    for (size_t j = 0; j <= b_length; j++)
        row[j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        size_t corner = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t changed = corner + (a[i - 1] != b[j - 1]), longer = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
            corner = row[j];
            row[j] = changed < longer ? changed : longer;
        }
    }
    return row[b_length];
}

MesoNearest meso_nearest(const char *text, size_t length)
{
    return (MesoNearest){.text = text, .length = length, .least = length / 2 + 1};
}

void meso_nearest_try(MesoNearest *nearest, const char *word)
{
    bool begins = nearest->length >= 2 && strncmp(word, nearest->text, nearest->length) == 0;
    size_t distance = begins ? 0 : word_distance(nearest->text, nearest->length, word);
    if (distance < nearest->least) {
        nearest->least = distance;
        nearest->best = word;
    }
}
