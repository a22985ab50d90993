/* Letters of strokes: ASCII on a grid, for names in pictures. */
#ifndef MESO_STROKE_FONT_H
#define MESO_STROKE_FONT_H

#include <stdint.h>

/* The grid: from one letter to the next, the height of capitals, where they stand, and a stroke's width. */
#define MESO_STROKE_ADVANCE 5.5f
#define MESO_STROKE_CAPITAL 6.0f
#define MESO_STROKE_BASE 2.0f
#define MESO_STROKE_WIDTH 0.75f

/*
 * The strokes of a letter: "x y" pairs of digits, x from 0 to 4 and y from 0 (the lowest descender) to 8, a line from
 * each to the next; a space ends a line. A box for what there is no letter for.
 */
const char *meso_stroke_letter(unsigned char letter);

/* Letters of a text in UTF-8: what is not ASCII is a box each. */
uint32_t meso_stroke_count(const char *text);

/* The next letter of a text in UTF-8, which moves on; 0 at its end, and 127 for what is not ASCII. */
unsigned char meso_stroke_next(const char **text);

#endif
