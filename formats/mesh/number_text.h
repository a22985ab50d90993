/* Decimal numbers in text, exact and fast. */
#ifndef MESO_NUMBER_TEXT_H
#define MESO_NUMBER_TEXT_H

#include <stdint.h>

/*
 * Each reads the number that begins at `at` and returns where it ends, or NULL where none begins there. Behind the
 * number there must be a character that belongs to none. A float is [+-] digits [. digits] [e [+-] digits], with
 * a digit before or behind the point; the result is the nearest one, ties to even, as strtof() and strtod() give in
 * the C locale, infinity included. O(length).
 */
const char *meso_text_float(const char *at, float *number);
const char *meso_text_double(const char *at, double *number);

/* [+-] digits; beyond +-10^15 it stays there. */
const char *meso_text_integer(const char *at, int64_t *number);

#endif
