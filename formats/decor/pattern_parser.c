#include "formats/decor/pattern_parser.h"

#include <math.h>
#include <string.h>

#include "libcore/mesh/polygon_mesh.h"

void *meso_pattern_allocate(MesoPatternParser *parser, uint64_t count, size_t size)
{
    MesoJsonReader *reader = parser->reader;
    void *array = meso_arena_alloc(reader->arena, count, size, reader->error);
    if (!array && !reader->status)
        reader->status = meso_fail(reader->error, MESO_ERR_MEMORY, "%s: out of memory", reader->path);
    return array;
}

const MesoInput *meso_pattern_open(MesoPatternParser *parser, const MesoJsonField *field)
{
    MesoJsonReader *reader = parser->reader;
    const char *name = meso_pattern_text(field, 4096);
    MesoError error;
    if (!meso_json_good(field))
        return NULL;
    if (!parser->files) {
        meso_json_wrong(field, "other files cannot be read here");
        return NULL;
    }
    const MesoInput *input = parser->files->open(parser->files->context, name, &error);
    if (!input && error.status == MESO_ERR_INPUT)
        meso_json_wrong(field, "%s", error.message);
    else if (!input)
        reader->status = meso_fail(reader->error, error.status, "%s", error.message);
    return input;
}

void meso_pattern_refuse(const MesoJsonField *field, const char *what, const char *text, const char *const *words)
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

uint32_t meso_pattern_word(const MesoJsonField *field, const char *what, const char *const *words, uint32_t fallback)
{
    if (!field->value || !meso_json_good(field))
        return fallback;
    const char *text = json_string_value(field->value);
    for (uint32_t i = 0; text && words[i]; i++)
        if (strcmp(text, words[i]) == 0)
            return i;
    if (text) {
        meso_pattern_refuse(field, what, text, words);
        return fallback;
    }
    char list[200];
    meso_json_list_words(words, list, sizeof list);
    meso_json_wrong(field, "a %s is needed here, one of %s", what, list);
    return fallback;
}

const char *meso_pattern_text(const MesoJsonField *field, size_t most)
{
    size_t length = json_string_length(field->value);
    if (json_is_string(field->value) && length == 0)
        meso_json_wrong(field, "empty");
    else if (length > most)
        meso_json_wrong(field, "%zu characters; at most %zu are possible", length, most);
    return meso_json_good(field) ? meso_json_text(field) : "";
}

float meso_pattern_float(const MesoJsonField *field, float low, float high, bool open, float fallback)
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

MesoVec3 meso_pattern_point(const MesoJsonField *field)
{
    float x[3] = {0};
    meso_json_floats(field, 3, x);
    for (int k = 0; k < 3; k++)
        if (!(fabsf(x[k]) <= MESO_COORDINATE_LIMIT) && meso_json_good(field))
            meso_json_wrong(field, "%g lies beyond the largest coordinate, %g", (double)x[k], (double)MESO_COORDINATE_LIMIT);
    return (MesoVec3){x[0], x[1], x[2]};
}
