#include "formats/json/json_field.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { PLACE_LENGTH = 160 };

MesoJsonField meso_json_root(MesoJsonReader *reader, const json_t *root)
{
    return (MesoJsonField){.reader = reader, .value = root};
}

MesoJsonField meso_json_key(const MesoJsonField *object, const char *key)
{
    return (MesoJsonField){
        .reader = object->reader,
        .parent = object,
        .key = key,
        .value = json_object_get(object->value, key),
    };
}

MesoJsonField meso_json_item(const MesoJsonField *array, size_t index)
{
    return (MesoJsonField){
        .reader = array->reader,
        .parent = array,
        .index = index,
        .value = json_array_get(array->value, index),
    };
}

static size_t add_place(const MesoJsonField *field, char *place, size_t size)
{
    if (!field->parent)
        return 0;
    size_t used = add_place(field->parent, place, size);
    int length = field->key ? snprintf(place + used, size - used, "%s%s", used ? "." : "", field->key)
                            : snprintf(place + used, size - used, "[%zu]", field->index);
    used += length > 0 ? (size_t)length : 0;
    return used < size ? used : size - 1;
}

void meso_json_place(const MesoJsonField *field, char *place, size_t size)
{
    place[0] = '\0';
    add_place(field, place, size);
}

void meso_json_wrong(const MesoJsonField *field, const char *format, ...)
{
    if (!meso_json_good(field))
        return;
    char place[PLACE_LENGTH], message[300];
    meso_json_place(field, place, sizeof place);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    MesoJsonReader *reader = field->reader;
    if (reader->report) {
        reader->reported++;
        reader->report(reader->report_context, "error", *place ? place : "file", message);
        return;
    }
    reader->status = meso_fail(reader->error, MESO_ERR_INPUT, "%s: %s%s%s", reader->path, place,
                               *place ? ": " : "", message);
}

void meso_json_require(const MesoJsonField *field)
{
    if (!field->value)
        meso_json_wrong(field, "missing");
}

static const char *type_name(const json_t *value)
{
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        return "an object";
    case JSON_ARRAY:
        return "an array";
    case JSON_STRING:
        return "a string";
    case JSON_INTEGER:
    case JSON_REAL:
        return "a number";
    case JSON_NULL:
        return "null";
    default:
        return "true or false";
    }
}

/* True if there is a value and it is as expected. */
static bool expect(const MesoJsonField *field, bool right, const char *expected)
{
    if (!meso_json_good(field) || !field->value)
        return false;
    if (!right)
        meso_json_wrong(field, "%s is needed here, not %s", expected, type_name(field->value));
    return right;
}

void meso_json_list_words(const char *const *words, char *list, size_t size)
{
    size_t used = 0;
    list[0] = '\0';
    for (; *words && used < size; words++) {
        int length = snprintf(list + used, size - used, "%s\"%s\"", used ? ", " : "", *words);
        used += length > 0 ? (size_t)length : 0;
    }
}

bool meso_json_is_note(const char *key)
{
    return strcmp(key, "$schema") == 0 || strcmp(key, "comment") == 0 || strcmp(key, "extras") == 0;
}

bool meso_json_object(const MesoJsonField *field, const char *const *keys)
{
    meso_json_require(field);
    if (!expect(field, json_is_object(field->value), "an object"))
        return false;
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)field->value, key, value) {
        uint32_t k = 0;
        while (keys && keys[k] && strcmp(keys[k], key) != 0)
            k++;
        if (keys && !keys[k] && !meso_json_is_note(key)) {
            char known[200];
            meso_json_list_words(keys, known, sizeof known);
            meso_json_wrong(field, "unknown key \"%.40s\"; there are %s", key, known);
            if (!field->reader->report)
                return false;
        }
    }
    return true;
}

uint32_t meso_json_count(const MesoJsonField *field, uint32_t low, uint32_t high)
{
    if (low > 0)
        meso_json_require(field);
    if (!expect(field, json_is_array(field->value), "an array"))
        return 0;
    size_t count = json_array_size(field->value);
    if (count >= low && count <= high)
        return (uint32_t)count;
    if (low == high)
        meso_json_wrong(field, "%zu items; %u are needed", count, low);
    else
        meso_json_wrong(field, "%zu items; from %u to %u are possible", count, low, high);
    return 0;
}

bool meso_json_bool(const MesoJsonField *field, bool fallback)
{
    if (!expect(field, json_is_boolean(field->value), "true or false"))
        return fallback;
    return json_is_true(field->value);
}

float meso_json_float(const MesoJsonField *field, float fallback)
{
    if (!expect(field, json_is_number(field->value), "a number"))
        return fallback;
    double value = json_number_value(field->value);
    if (!(fabs(value) <= (double)FLT_MAX)) {
        meso_json_wrong(field, "%g is too large a number", value);
        return fallback;
    }
    return (float)value + 0.0f;     /* no negative zero: it would differ from 0 in name only */
}

int64_t meso_json_whole(const MesoJsonField *field, int64_t low, int64_t high, int64_t fallback)
{
    if (!expect(field, json_is_integer(field->value), "a whole number"))
        return fallback;
    int64_t value = json_integer_value(field->value);
    if (value >= low && value <= high)
        return value;
    meso_json_wrong(field, "%lld; it must be from %lld to %lld", (long long)value, (long long)low,
                    (long long)high);
    return fallback;
}

void meso_json_floats(const MesoJsonField *field, uint32_t count, float *values)
{
    if (!field->value || meso_json_count(field, count, count) != count)
        return;
    for (uint32_t i = 0; i < count; i++) {
        MesoJsonField item = meso_json_item(field, i);
        values[i] = meso_json_float(&item, values[i]);
    }
}

const char *meso_json_text(const MesoJsonField *field)
{
    meso_json_require(field);
    if (!expect(field, json_is_string(field->value), "a string"))
        return "";
    MesoJsonReader *reader = field->reader;
    const char *text = meso_arena_copy_text(reader->arena, json_string_value(field->value),
                                            reader->error);
    if (!text)
        reader->status = MESO_ERR_MEMORY;
    return text ? text : "";
}
