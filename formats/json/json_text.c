#include "formats/json/json_text.h"

#include <assert.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 512, LINE_WIDTH = 100 };

/* Bytes to parse; messages count lines from `first_line`. */
typedef struct Text {
    const char *path, *data;
    size_t size, first_line;
} Text;

/*
 * Jansson allows 2048 levels; so deep a file is an attack on whoever walks it
 * by recursion. Brackets inside strings do not count. It also passes over a zero
 * byte behind a number, where whoever takes the bytes as a string finds their end.
 */
static MesoStatus check_text(const Text *text, MesoError *error)
{
    uint32_t depth = 0;
    size_t line = text->first_line, column = 0;
    bool quoted = false;

    for (size_t i = 0; i < text->size; i++) {
        uint8_t byte = (uint8_t)text->data[i];
        column += (byte & 0xc0) != 0x80;    /* characters, as Jansson counts */
        if (byte == 0)
            return meso_fail(error, MESO_ERR_INPUT, "%s:%zu:%zu: a zero byte, which is not text", text->path, line,
                             column);
        if (byte == '\n') {
            line++;
            column = 0;
        } else if (quoted) {
            if (byte == '\\' && i + 1 < text->size && text->data[i + 1] != '\n' && text->data[i + 1] != 0) {
                i++;
                column++;
            } else if (byte == '"')
                quoted = false;
        } else if (byte == '"')
            quoted = true;
        else if ((byte == '[' || byte == '{') && ++depth > DEEPEST)
            return meso_fail(error, MESO_ERR_INPUT, "%s:%zu:%zu: more than %d levels of nesting",
                             text->path, line, column, DEEPEST);
        else if ((byte == ']' || byte == '}') && depth > 0)
            depth--;
    }
    return MESO_OK;
}

static MesoStatus parse(json_t **root, const Text *text, MesoError *error)
{
    *root = NULL;
    MesoStatus status = check_text(text, error);
    if (status)
        return status;

    json_error_t where;
    *root = json_loadb(text->data, text->size, JSON_REJECT_DUPLICATES, &where);
    if (*root)
        return MESO_OK;
    if (json_error_code(&where) == json_error_out_of_memory)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the JSON of '%s'", text->path);
    size_t line = text->first_line + (where.line > 1 ? (size_t)where.line - 1 : 0);
    return meso_fail(error, MESO_ERR_INPUT, "%s:%zu:%d: %s", text->path, line, where.column > 0 ? where.column : 1,
                     where.text);
}

MesoStatus meso_json_parse(json_t **root, const MesoInput *input, MesoError *error)
{
    size_t mark = meso_input_mark(input);
    return parse(root, &(Text){input->path, (const char *)input->data + mark, input->size - mark, 1}, error);
}

MesoStatus meso_json_parse_line(json_t **root, const char *path, uint64_t number, const char *text, size_t size,
                                MesoError *error)
{
    return parse(root, &(Text){path, text, size, number}, error);
}

json_t *meso_json_string(const char *text)
{
    json_t *value = json_string(text);
    if (value)
        return value;
    size_t size = strlen(text) + 1;
    char *plain = malloc(size);
    if (!plain)
        return NULL;
    for (size_t i = 0; i < size; i++)
        plain[i] = (unsigned char)text[i] < 0x80 ? text[i] : '?';
    value = json_string(plain);
    free(plain);
    return value;
}

json_t *meso_json_shortest(float value)
{
    char text[32];
    double shortest = (double)value;
    for (int digits = 1; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        shortest = strtod(text, NULL);
        if ((float)shortest == value)
            break;
    }
    return json_real(shortest + 0.0);   /* no -0.0 */
}

/* Text of one value on one line while it fits; then `overflow` is set. */
typedef struct Line {
    char text[LINE_WIDTH + 1];
    size_t length;
    bool overflow;
} Line;

static void line_add(Line *line, const char *text, size_t length)
{
    if (line->overflow || length > LINE_WIDTH - line->length) {
        line->overflow = true;
        return;
    }
    memcpy(line->text + line->length, text, length);
    line->length += length;
}

/* 17 digits always read back to the same double; most need fewer. */
static void format_real(double value, char out[32])
{
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(out, 32, "%.*g", digits, value);
        if (strtod(out, NULL) == value)
            break;
    }
    if (!strpbrk(out, ".e"))
        strcat(out, ".0");  /* stays a real number when it is read back */
}

/* Scalars and strings. `text` is freed by the caller where it is not NULL. */
static const char *format_scalar(const json_t *value, char number[32], char **text)
{
    *text = NULL;
    switch (json_typeof(value)) {
    case JSON_TRUE:
        return "true";
    case JSON_FALSE:
        return "false";
    case JSON_NULL:
        return "null";
    case JSON_INTEGER:
        snprintf(number, 32, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
        return number;
    case JSON_REAL:
        format_real(json_real_value(value), number);
        return number;
    default:
        return *text = json_dumps(value, JSON_ENCODE_ANY);
    }
}

static bool is_container(const json_t *value)
{
    return json_is_array(value) || json_is_object(value);
}

/* "key": into a fresh string that the caller frees; NULL when memory is out. */
static char *format_key(const char *key)
{
    json_t *string = json_string(key);
    char *quoted = string ? json_dumps(string, JSON_ENCODE_ANY) : NULL;
    json_decref(string);
    return quoted;
}

static bool line_add_value(Line *line, const json_t *value, bool nested);

static bool line_add_array(Line *line, const json_t *value)
{
    size_t index;
    json_t *item;
    line_add(line, "[", 1);
    json_array_foreach(value, index, item) {
        if (is_container(item))
            line->overflow = true;
        if (line->overflow)
            return true;
        line_add(line, ", ", index > 0 ? 2 : 0);
        if (!line_add_value(line, item, true))
            return false;
    }
    line_add(line, "]", 1);
    return true;
}

static bool line_add_object(Line *line, const json_t *value)
{
    const char *key;
    json_t *item;
    bool first = true;
    line_add(line, "{", 1);
    json_object_foreach((json_t *)value, key, item) {
        if (json_is_object(item))
            line->overflow = true;
        if (line->overflow)
            return true;
        char *quoted = format_key(key);
        if (!quoted)
            return false;
        line_add(line, ", ", first ? 0 : 2);
        line_add(line, quoted, strlen(quoted));
        line_add(line, ": ", 2);
        free(quoted);
        if (!line_add_value(line, item, true))
            return false;
        first = false;
    }
    line_add(line, "}", 1);
    return true;
}

/* Scalars, arrays of scalars, objects of both; false when memory is out. */
static bool line_add_value(Line *line, const json_t *value, bool nested)
{
    if (json_is_array(value))
        return line_add_array(line, value);
    if (json_is_object(value)) {
        line->overflow |= nested;
        return line->overflow || line_add_object(line, value);
    }
    char number[32], *owned;
    const char *text = format_scalar(value, number, &owned);
    if (text)
        line_add(line, text, strlen(text));
    free(owned);
    return text != NULL;
}

static MesoStatus write_text(MesoOutput *output, const char *text, MesoError *error)
{
    return meso_output_write(output, text, strlen(text), error);
}

static MesoStatus write_break(MesoOutput *output, uint32_t level, MesoError *error)
{
    MesoStatus status = write_text(output, "\n", error);
    for (uint32_t i = 0; i < level && !status; i++)
        status = write_text(output, "  ", error);
    return status;
}

static MesoStatus memory_is_out(MesoError *error)
{
    return meso_fail(error, MESO_ERR_MEMORY, "out of memory for JSON text");
}

static MesoStatus write_value(const json_t *value, uint32_t level, size_t column,
                              MesoOutput *output, MesoError *error);

static MesoStatus write_item(const char *key, const json_t *item, bool first, uint32_t level,
                             MesoOutput *output, MesoError *error)
{
    MesoStatus status = first ? MESO_OK : write_text(output, ",", error);
    if (!status)
        status = write_break(output, level, error);
    size_t column = 2 * (size_t)level;
    if (!status && key) {
        char *quoted = format_key(key);
        if (!quoted)
            return memory_is_out(error);
        column += strlen(quoted) + 2;
        status = write_text(output, quoted, error);
        if (!status)
            status = write_text(output, ": ", error);
        free(quoted);
    }
    return status ? status : write_value(item, level, column, output, error);
}

static MesoStatus write_container(const json_t *value, uint32_t level, size_t column,
                                  MesoOutput *output, MesoError *error)
{
    Line line = {.length = 0};
    if (!line_add_value(&line, value, false))
        return memory_is_out(error);
    if (!line.overflow && (column + line.length < LINE_WIDTH || line.length == 2))
        return meso_output_write(output, line.text, line.length, error);

    bool array = json_is_array(value), first = true;
    MesoStatus status = write_text(output, array ? "[" : "{", error);
    size_t index;
    const char *key;
    json_t *item;
    if (array)
        json_array_foreach(value, index, item) {
            if (!status)
                status = write_item(NULL, item, first, level + 1, output, error);
            first = false;
        }
    else
        json_object_foreach((json_t *)value, key, item) {
            if (!status)
                status = write_item(key, item, first, level + 1, output, error);
            first = false;
        }
    if (!status)
        status = write_break(output, level, error);
    return status ? status : write_text(output, array ? "]" : "}", error);
}

static MesoStatus write_value(const json_t *value, uint32_t level, size_t column,
                              MesoOutput *output, MesoError *error)
{
    if (is_container(value))
        return write_container(value, level, column, output, error);
    char number[32], *owned;
    const char *text = format_scalar(value, number, &owned);
    MesoStatus status = text ? write_text(output, text, error) : memory_is_out(error);
    free(owned);
    return status;
}

MesoStatus meso_json_write(const json_t *value, MesoOutput *output, MesoError *error)
{
    if (!value)
        return memory_is_out(error);
    MesoStatus status = write_value(value, 0, 0, output, error);
    return status ? status : write_text(output, "\n", error);
}

MesoStatus meso_json_write_file(const json_t *value, const char *path, MesoError *error)
{
    MesoOutput *output;
    MesoStatus status = meso_output_open(&output, path ? path : "-", error);
    if (!status)
        status = meso_json_write(value, output, error);
    return meso_output_finish(output, status, error);
}

MesoStatus meso_json_check_format(const json_t *root, const char *path, const char *format,
                                  int newest_version, MesoError *error)
{
    assert(newest_version >= 1);
    const json_t *name = json_object_get(root, "format");
    const json_t *version = json_object_get(root, "version");
    if (!json_is_string(name))
        return meso_fail(error, MESO_ERR_INPUT, "%s: no \"format\"; a '%s' file is needed here",
                         path, format);
    if (strcmp(json_string_value(name), format) != 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: is a '%.40s' file; a '%s' file is needed here",
                         path, json_string_value(name), format);
    if (!json_is_integer(version) || json_integer_value(version) < 1)
        return meso_fail(error, MESO_ERR_INPUT, "%s: \"version\" must be a whole number from 1",
                         path);
    if (json_integer_value(version) > newest_version)
        return meso_fail(error, MESO_ERR_INPUT,
                         "%s: version %" JSON_INTEGER_FORMAT
                         " is newer than this program reads (%d)",
                         path, json_integer_value(version), newest_version);
    return MESO_OK;
}
