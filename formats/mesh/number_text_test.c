/* Against the C library: random floats, the middles between them, subnormals, long digit strings. */
#include "formats/mesh/number_text.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"

static MesoRandom source;

static uint32_t random_bits(void)
{
    return meso_random_below(&source, 1u << 16) << 16 | meso_random_below(&source, 1u << 16);
}

static void compare(const char *text)
{
    float single, expected = strtof(text, NULL);
    double number, wide = strtod(text, NULL);
    const char *end = meso_text_float(text, &single);
    bool same = end == text + strlen(text) && memcmp(&single, &expected, sizeof single) == 0 &&
                meso_text_double(text, &number) == end && memcmp(&number, &wide, sizeof number) == 0;
    if (!same)
        fprintf(stderr, "'%s': %a instead of %a\n", text, (double)single, (double)expected);
    CHECK(same);
}

/* Exactly the middle between two floats, a digit above and below it, and in fewer digits. */
static void compare_middle(uint32_t bits)
{
    float low, high;
    char text[200];
    uint32_t above = bits + 1;
    memcpy(&low, &bits, 4);
    memcpy(&high, &above, 4);
    if (!isfinite(low) || !isfinite(high))
        return;
    double middle = ((double)low + (double)high) / 2;
    int length = snprintf(text, sizeof text, "%.120e", middle);
    compare(text);
    char *last = strchr(text, 'e') - 1;
    char kept = *last;
    *last = '1';
    compare(text);
    *last = kept;
    CHECK(length < 190);
    for (int digits = 5; digits < 24; digits += 3) {
        snprintf(text, sizeof text, "%.*e", digits, middle);
        compare(text);
    }
    snprintf(text, sizeof text, "%.17g", nextafter(middle, 1e300));
    compare(text);
    snprintf(text, sizeof text, "%.17g", nextafter(middle, -1e300));
    compare(text);
}

static void test_floats(uint32_t count)
{
    char text[100];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bits = random_bits();
        float value;
        if (i % 3 == 0)
            bits = (bits & 0x81ffffff) | 0x3c000000;    /* near one, where meshes are */
        if (i % 16 == 1)
            bits &= 0x80ffffff;                         /* subnormal or little above */
        memcpy(&value, &bits, 4);
        if (!isfinite(value))
            continue;
        snprintf(text, sizeof text, "%.*g", 1 + (int)(i % 20), (double)value);
        compare(text);
        if (i % 8 == 0)
            compare_middle(bits);
        if (fabsf(value) < 1e20f) {
            snprintf(text, sizeof text, "%.*f", (int)(i % 12), (double)value);
            compare(text);
        }
    }
}

/* Digits, a point anywhere, exponents beyond all limits. */
static void test_digits(uint32_t count)
{
    char text[1300];
    for (uint32_t i = 0; i < count; i++) {
        char *at = text;
        uint32_t digits = 1 + meso_random_below(&source, i % 200 == 0 ? 1200 : 30);
        uint32_t point = meso_random_below(&source, digits + 2);
        if (i % 2)
            *at++ = "+-"[i / 2 % 2];
        for (uint32_t d = 0; d < digits; d++) {
            if (d == point)
                *at++ = '.';
            *at++ = (char)('0' + meso_random_below(&source, i % 5 ? 10 : 2));
        }
        *at = 0;
        if (i % 3 == 0)
            sprintf(at, "%c%s%u", "eE"[i % 2], (const char *[]){"", "+", "-"}[i / 3 % 3],
                    meso_random_below(&source, i % 7 ? 60 : 400));
        compare(text);
    }
}

static void test_given(void)
{
    static const char *const texts[] = {
        "0", "-0", "0.", ".5", "1e0", "10E-1", "3.4028235e38", "3.4028235677973366e38", "3.4028235677973367e38", "1e39",
        "-1e999999999999", "1e-999999999999", "0e999999999999", "1.17549435e-38", "1.401298464324817e-45", "7.0e-46",
        "7.006492321624085e-46", "7.006492321624086e-46", "1e-46", "16777217", "16777219", "33554434.000000001",
        "9007199254740993", "123456789012345678901234567890", "0.000000000000000000000000000000000000000000000000001e51",
        "1.00000005960464477539062500000000000000000000000000000000000000000000000000000000001",
        "100000000000000000000000000000000000000000000000000000000000000e-62", "18446744073709551615", "18446744073709551616"};
    static const char *const wrong[] = {"", ".", "-", "+.", "e5", "1e", "1e+", "-.e1", "x", "+-1", "nan", "inf"};
    float number;
    int64_t integer;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        compare(texts[i]);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        CHECK(!meso_text_float(wrong[i], &number));
    const char *hexadecimal = "0x10", *twice = "1.5.2";
    CHECK(meso_text_float(hexadecimal, &number) == hexadecimal + 1 && meso_text_float(twice, &number) == twice + 3);
    CHECK(meso_text_integer("-12/", &integer) && integer == -12 && !meso_text_integer("-", &integer));
    CHECK(meso_text_integer("99999999999999999999 ", &integer) && integer == 1000000000000000);
}

/* More digits than are looked at, with the one that decides far behind. */
static void test_long(void)
{
    static char text[5000];
    for (uint32_t length = 700; length < 4900; length += 300) {
        strcpy(text, "1.000000059604644775390625");
        memset(text + 26, '0', length);
        text[26 + length] = 0;
        compare(text);
        text[25 + length] = '1';
        compare(text);
    }
    memset(text, '0', 4000);
    strcpy(text + 4000, "1.5");
    compare(text);
}

int main(int argc, char **argv)
{
    uint32_t count = argc > 1 ? (uint32_t)atol(argv[1]) : 200000;
    meso_random_init(&source, 11, 0);
    test_given();
    test_long();
    test_floats(count);
    test_digits(count);
    return 0;
}
