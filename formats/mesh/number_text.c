/*
 * A float has 24 bits, a double 53. So digits and power of ten are multiplied as doubles, and where the result is
 * not within their few roundings of the middle between two floats, it rounds to the same float as the exact value.
 * The rest, one text in some ten million, goes to strtof().
 */
#include "formats/mesh/number_text.h"

#include <float.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORD_DIGITS = 19, LARGEST_POWER = 64, EXACT_POWER = 22, LARGEST_EXPONENT = 100000 };

static const double powers[LARGEST_POWER + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22, 1e23, 1e24, 1e25, 1e26, 1e27, 1e28, 1e29, 1e30, 1e31, 1e32, 1e33,
    1e34, 1e35, 1e36, 1e37, 1e38, 1e39, 1e40, 1e41, 1e42, 1e43, 1e44, 1e45, 1e46, 1e47, 1e48, 1e49, 1e50,
    1e51, 1e52, 1e53, 1e54, 1e55, 1e56, 1e57, 1e58, 1e59, 1e60, 1e61, 1e62, 1e63, 1e64};

/* (-1)^negative * digits * 10^exponent; with more digits behind these where `cut`. */
typedef struct Decimal {
    uint64_t digits;
    int32_t exponent;
    bool negative, cut;
} Decimal;

static bool is_digit(char c)
{
    return (unsigned char)(c - '0') <= 9;
}

/* Behind the 'e'; NULL where no number follows. */
static const char *read_exponent(const char *at, Decimal *decimal)
{
    int32_t exponent = 0;
    bool negative = *at == '-';
    at += *at == '-' || *at == '+';
    if (!is_digit(*at))
        return NULL;
    for (; is_digit(*at); at++)
        if (exponent < LARGEST_EXPONENT)
            exponent = 10 * exponent + (*at - '0');
    decimal->exponent += negative ? -exponent : exponent;
    return at;
}

/* The first 19 digits that count, of more than that. */
static void cut_digits(const char *at, const char *end, Decimal *decimal)
{
    uint32_t taken = 0;
    int32_t exponent = 0;
    bool behind_point = false;
    decimal->digits = 0;
    for (; at < end; at++) {
        if (*at == '.') {
            behind_point = true;
            continue;
        }
        exponent -= behind_point;
        if (taken == WORD_DIGITS) {
            exponent += exponent < LARGEST_EXPONENT;
            decimal->cut |= *at != '0';
            continue;
        }
        decimal->digits = 10 * decimal->digits + (uint64_t)(*at - '0');
        taken += decimal->digits != 0;
    }
    decimal->exponent = exponent;
}

static const char *read_decimal(const char *at, Decimal *decimal)
{
    uint64_t digits = 0;
    decimal->negative = *at == '-';
    decimal->cut = false;
    at += *at == '-' || *at == '+';
    const char *begin = at, *point = NULL;
    for (; is_digit(*at); at++)
        digits = 10 * digits + (uint64_t)(*at - '0');
    if (*at == '.') {
        point = at++;
        for (; is_digit(*at); at++)
            digits = 10 * digits + (uint64_t)(*at - '0');
    }
    int64_t count = at - begin - (point != NULL);
    if (count == 0)
        return NULL;
    decimal->digits = digits;
    decimal->exponent = point ? (int32_t)(point + 1 - at) : 0;
    if (count > WORD_DIGITS)
        cut_digits(begin, at, decimal);
    return *at == 'e' || *at == 'E' ? read_exponent(at + 1, decimal) : at;
}

/*
 * No float or double needs more digits than these to be told from the middle between it and the next (770 for
 * doubles), but for whether anything but zeros follows, which a last 1 stands for.
 */
enum { SLOW_DIGITS = 800 };

/* The number at `at`, which read_decimal() has found good, without a point, so that no locale has a say. */
static void write_plain(const char *at, const Decimal *decimal, char text[SLOW_DIGITS + 32])
{
    uint32_t count = 0;
    int64_t exponent = 0;
    bool behind_point = false, more = false;
    Decimal written = {0};
    char *out = text;
    if (decimal->negative)
        *out++ = '-';
    at += *at == '-' || *at == '+';
    for (; is_digit(*at) || *at == '.'; at++) {
        if (*at == '.') {
            behind_point = true;
            continue;
        }
        exponent -= behind_point;
        if (count == 0 && *at == '0')
            continue;
        if (count == SLOW_DIGITS) {
            exponent++;
            more |= *at != '0';
        } else {
            *out++ = *at;
            count++;
        }
    }
    if (*at == 'e' || *at == 'E')
        read_exponent(at + 1, &written);
    if (count == 0)
        *out++ = '0';
    if (more) {
        *out++ = '1';
        exponent--;
    }
    sprintf(out, "e%lld", (long long)(exponent + written.exponent));
}

static float slow_float(const char *at, const Decimal *decimal)
{
    char text[SLOW_DIGITS + 32];
    write_plain(at, decimal, text);
    return strtof(text, NULL);
}

static double slow_double(const char *at, const Decimal *decimal)
{
    char text[SLOW_DIGITS + 32];
    write_plain(at, decimal, text);
    return strtod(text, NULL);
}

/*
 * Digits become a double with one rounding, the power of ten is one more, their product or quotient a third, and digits
 * that were cut off are less: the value is within 4 units in the last place of `value`. Below a float's 24 bits
 * a double has 29: their middle value is where floats are rounded the one way or the other.
 */
static bool rounds_safely(double value)
{
    enum { BITS = 29, MARGIN = 16 };
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint64_t below = bits & (((uint64_t)1 << BITS) - 1), middle = (uint64_t)1 << (BITS - 1);
    return below - (middle - MARGIN) > 2 * MARGIN && value >= (double)FLT_MIN && value <= (double)FLT_MAX;
}

const char *meso_text_float(const char *at, float *number)
{
    Decimal decimal;
    const char *end = read_decimal(at, &decimal);
    if (!end)
        return NULL;
    if (decimal.digits == 0) {
        *number = decimal.negative ? -0.0f : 0.0f;
        return end;
    }
    int32_t power = decimal.exponent;
    if (power < -LARGEST_POWER || power > LARGEST_POWER) {
        *number = slow_float(at, &decimal);
        return end;
    }
    double value = (double)decimal.digits;
    value = power < 0 ? value / powers[-power] : value * powers[power];
    if (rounds_safely(value))
        *number = (float)(decimal.negative ? -value : value);
    else
        *number = slow_float(at, &decimal);
    return end;
}

/* Exact operands, so that there is one rounding (Clinger, "How to Read Floating Point Numbers Accurately", 1990). */
const char *meso_text_double(const char *at, double *number)
{
    Decimal decimal;
    const char *end = read_decimal(at, &decimal);
    if (!end)
        return NULL;
    int32_t power = decimal.exponent;
    if (decimal.cut || decimal.digits > (uint64_t)1 << 53 || power < -EXACT_POWER || power > EXACT_POWER) {
        *number = slow_double(at, &decimal);
        return end;
    }
    double value = (double)decimal.digits;
    value = power < 0 ? value / powers[-power] : value * powers[power];
    *number = decimal.negative ? -value : value;
    return end;
}

const char *meso_text_integer(const char *at, int64_t *number)
{
    const int64_t limit = 1000000000000000;
    bool negative = *at == '-';
    at += *at == '-' || *at == '+';
    if (!is_digit(*at))
        return NULL;
    *number = 0;
    for (; is_digit(*at); at++) {
        *number = 10 * *number + (*at - '0');
        if (*number > limit)
            *number = limit;
    }
    if (negative)
        *number = -*number;
    return at;
}
