#include "formats/json/json_value.h"

#include <math.h>
#include <string.h>

#include "libcore/base/nearest.h"

void meso_json_refuse(const MesoJsonField *field, const char *what, const char *text, const char *const *words)
{
    char list[200];
    MesoNearest nearest = meso_nearest(text, strlen(text));
    for (const char *const *word = words; *word; word++)
        meso_nearest_try(&nearest, *word);
    meso_json_list_words(words, list, sizeof list);
    if (nearest.best)
        meso_json_wrong(field, "no %s '%.40s'; did you mean '%.80s'?", what, text, nearest.best);
    else
        meso_json_wrong(field, "no %s '%.40s'; there are %s", what, text, list);
}

uint32_t meso_json_word(const MesoJsonField *field, const char *what, const char *const *words, uint32_t fallback)
{
    if (!field->value || !meso_json_good(field))
        return fallback;
    const char *text = json_string_value(field->value);
    for (uint32_t i = 0; text && words[i]; i++)
        if (strcmp(text, words[i]) == 0)
            return i;
    if (text) {
        meso_json_refuse(field, what, text, words);
        return fallback;
    }
    char list[200];
    meso_json_list_words(words, list, sizeof list);
    meso_json_wrong(field, "a %s is needed here, one of %s", what, list);
    return fallback;
}

const char *meso_json_short_text(const MesoJsonField *field, size_t most)
{
    size_t length = json_string_length(field->value);
    if (json_is_string(field->value) && length == 0)
        meso_json_wrong(field, "empty");
    else if (length > most)
        meso_json_wrong(field, "%zu characters; at most %zu are possible", length, most);
    return meso_json_good(field) ? meso_json_text(field) : "";
}

float meso_json_float_in(const MesoJsonField *field, float low, float high, bool open, float fallback)
{
    if (!field->value)
        return fallback;
    float value = meso_json_float(field, fallback);
    if (!meso_json_good(field))
        return fallback;
    if (open ? value > low && value < high : value >= low && value <= high)
        return value;
    if (open && high == INFINITY)
        meso_json_wrong(field, "%g; it must be above %g", (double)value, (double)low);
    else if (high == INFINITY)
        meso_json_wrong(field, "%g; it must be %g or more", (double)value, (double)low);
    else
        meso_json_wrong(field, "%g; it must be %s %g %s %g", (double)value, open ? "between" : "from", (double)low,
                        open ? "and" : "to", (double)high);
    return fallback;
}

/* ---- colours ---- */

/* The inverse of the curve of sRGB (IEC 61966-2-1). */
static float decode_srgb(uint32_t byte)
{
    float x = (float)byte / 255;
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

static uint32_t hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? (uint32_t)(c - '0')
           : c >= 'a' && c <= 'f' ? (uint32_t)(c - 'a' + 10)
           : c >= 'A' && c <= 'F' ? (uint32_t)(c - 'A' + 10)
                                  : 16;
}

/* "#rrggbb" or "#rgb", as of pictures. */
static bool read_hex(const char *text, float color[3])
{
    size_t digits = strlen(text) - (*text != 0);
    if (*text != '#' || (digits != 3 && digits != 6))
        return false;
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t high = hex_digit(text[digits == 3 ? 1 + i : 1 + 2 * i]);
        uint32_t low = hex_digit(text[digits == 3 ? 1 + i : 2 + 2 * i]);
        if (high > 15 || low > 15)
            return false;
        color[i] = decode_srgb(16 * high + low);
    }
    return true;
}

void meso_json_color(const MesoJsonField *field, float color[3])
{
    if (json_is_string(field->value)) {
        if (!read_hex(json_string_value(field->value), color))
            meso_json_wrong(field, "'%.40s' is no colour; \"#rrggbb\" is", json_string_value(field->value));
        return;
    }
    if (field->value && !json_is_array(field->value))
        meso_json_wrong(field, "a colour is needed here, \"#rrggbb\" or three numbers from 0 to 1");
    uint32_t count = meso_json_count(field, 3, 3);
    for (uint32_t i = 0; i < count; i++) {
        MesoJsonField item = meso_json_item(field, i);
        color[i] = meso_json_float_in(&item, 0, 1, false, color[i]);
    }
}
