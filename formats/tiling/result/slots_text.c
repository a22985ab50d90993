#include "formats/tiling/result/slots_text.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_field.h"
#include "formats/json/json_text.h"
#include "libcore/base/grow.h"
#include "libcore/base/names.h"

enum { VERSION = 1 };
enum { SLOT, TILE, TURN, FLIP, CORNER, OVER, COLUMN_COUNT };

static const char *const columns[COLUMN_COUNT] = {"slot", "tile", "turn", "flip", "corner", "over"};

/* The most that a number of each column can be, of slots the last. */
static const uint32_t most[COLUMN_COUNT] = {UINT32_MAX / 4 - 1, 0, 3, 1, 3, 1};

/* ---- writing ---- */

static MesoStatus write_text(MesoOutput *output, const char *text, MesoError *error)
{
    return meso_output_write(output, text, strlen(text), error);
}

static MesoStatus write_name(MesoOutput *output, const char *name, MesoError *error)
{
    size_t length = strlen(name);
    bool plain = strcspn(name, ",\"") == length && name[0] != ' ' && name[length - 1] != ' ';
    if (plain)
        return write_text(output, name, error);
    MesoStatus status = write_text(output, "\"", error);
    for (; !status && *name; name += length) {
        length = strcspn(name, "\"");
        length += name[length] == '"';
        status = meso_output_write(output, name, length, error);
        if (!status && name[length - 1] == '"')
            status = write_text(output, "\"", error);
    }
    return status ? status : write_text(output, "\"", error);
}

MesoStatus meso_slots_write_csv(const MesoSlotsFile *slots, MesoOutput *output, MesoError *error)
{
    const MesoAssignment *a = &slots->assignment;
    char header[40];
    snprintf(header, sizeof header, "slot,tile,turn,flip%s%s\n", slots->quarters ? ",corner" : "",
             slots->over ? ",over" : "");
    MesoStatus status = write_text(output, header, error);
    for (uint32_t s = 0; s < a->slot_count && !status; s++) {
        char number[16], rest[16];
        snprintf(number, sizeof number, "%" PRIu32 ",", s);
        int used = snprintf(rest, sizeof rest, ",%u,%u", a->transform[s] & 3u, a->transform[s] >> 2);
        if (slots->quarters)
            used += snprintf(rest + used, sizeof rest - (size_t)used, ",%u", slots->quarters[s]);
        if (slots->over)
            used += snprintf(rest + used, sizeof rest - (size_t)used, ",%u", slots->over[s]);
        snprintf(rest + used, sizeof rest - (size_t)used, "\n");
        status = write_text(output, number, error);
        if (!status)
            status = write_name(output, slots->tile_names[a->tile[s]], error);
        if (!status)
            status = write_text(output, rest, error);
    }
    return status;
}

static json_t *slot_json(const MesoSlotsFile *slots, uint32_t s)
{
    const MesoAssignment *a = &slots->assignment;
    json_t *object = json_object();
    int failed = json_object_set_new(object, "slot", json_integer(s));
    failed |= json_object_set_new(object, "tile", meso_json_string(slots->tile_names[a->tile[s]]));
    failed |= json_object_set_new(object, "turn", json_integer(a->transform[s] & 3));
    failed |= json_object_set_new(object, "flip", json_boolean(a->transform[s] >> 2));
    if (slots->quarters)
        failed |= json_object_set_new(object, "corner", json_integer(slots->quarters[s]));
    if (slots->over)
        failed |= json_object_set_new(object, "over", json_boolean(slots->over[s]));
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}

static json_t *hash_json(const uint64_t hash[2])
{
    return json_sprintf("%016" PRIx64 "%016" PRIx64, hash[0], hash[1]);
}

json_t *meso_slots_to_json(const MesoSlotsFile *slots)
{
    json_t *root = json_object(), *list = json_array(), *inputs = NULL;
    int failed = json_object_set_new(root, "format", json_string("meso-slots"));
    failed |= json_object_set_new(root, "version", json_integer(VERSION));
    if (!slots->anonymous) {
        failed |= json_object_set_new(root, "inputs", inputs = json_object());
        failed |= json_object_set_new(inputs, "tiles", hash_json(slots->tiles_hash));
        failed |= json_object_set_new(inputs, "surface", hash_json(slots->surface_hash));
    }
    failed |= json_object_set_new(root, "slots", list);
    for (uint32_t s = 0; s < slots->assignment.slot_count && !failed; s++)
        failed |= json_array_append_new(list, slot_json(slots, s));
    if (!failed)
        return root;
    json_decref(root);
    return NULL;
}

/* ---- reading ---- */

typedef struct Reader {
    MesoSlotsFile *slots;
    MesoArena *arena;
    MesoNames names;
    uint32_t name_room;
    uint8_t *quarters, *over;   /* [slot_count] */
    bool oriented;              /* one of the quarters is not 0 */
    bool wound;                 /* the listing says which faces are turned over, if only that none is */
    const char *path;
    MesoError *error;
} Reader;

/* A place for each slot, none of which is taken. */
static MesoStatus make_room(Reader *reader, uint32_t count)
{
    MesoAssignment *a = &reader->slots->assignment;
    *a = (MesoAssignment){.slot_count = count};
    a->tile = MESO_NEW(reader->arena, uint32_t, count, reader->error);
    a->transform = a->tile ? MESO_NEW(reader->arena, MesoTransform, count, reader->error) : NULL;
    reader->quarters = a->transform ? MESO_NEW(reader->arena, uint8_t, count, reader->error) : NULL;
    reader->over = reader->quarters ? MESO_NEW(reader->arena, uint8_t, count, reader->error) : NULL;
    for (uint32_t s = 0; reader->over && s < count; s++)
        a->tile[s] = MESO_NO_INDEX;
    return reader->over ? MESO_OK : MESO_ERR_MEMORY;
}

/* Number of the tile with this name, which may be new; MESO_NO_INDEX where memory is out. `name` outlives the
 * reader. */
static uint32_t tile_number(Reader *reader, const char *name)
{
    MesoSlotsFile *slots = reader->slots;
    uint32_t number = meso_names_add(&reader->names, reader->arena, name, strlen(name), slots->tile_count,
                                     reader->error);
    if (number != slots->tile_count)
        return number;
    slots->tile_names = MESO_GROW(reader->arena, slots->tile_names, slots->tile_count, reader->name_room, 16,
                                  reader->error);
    if (!slots->tile_names)
        return MESO_NO_INDEX;
    slots->tile_names[slots->tile_count++] = name;
    return number;
}

/* Names as tile sets have them. */
static bool is_name(const char *name)
{
    if (!*name)
        return false;
    for (; *name; name++)
        if ((unsigned char)*name < 0x20 || *name == 0x7f)
            return false;
    return true;
}

/* `values` are in range, and the slot's place is free. */
static MesoStatus put_slot(Reader *reader, const char *name, const uint32_t values[COLUMN_COUNT])
{
    MesoAssignment *a = &reader->slots->assignment;
    uint32_t slot = values[SLOT], tile = tile_number(reader, name);
    if (tile == MESO_NO_INDEX)
        return MESO_ERR_MEMORY;
    a->tile[slot] = tile;
    a->transform[slot] = (MesoTransform)(values[TURN] + 4 * values[FLIP]);
    reader->quarters[slot] = (uint8_t)values[CORNER];
    reader->over[slot] = (uint8_t)values[OVER];
    reader->oriented |= values[CORNER] != 0;
    return MESO_OK;
}

/* --- CSV --- */

typedef struct Line {
    char *text;                 /* without its end, and with a zero byte there */
    uint32_t number;            /* from 1 */
} Line;

typedef struct Lines {
    char *next, *end;
    uint32_t number;            /* of the last line taken */
} Lines;

/* The next line that is not empty; false at the end. */
static bool take_line(Lines *lines, Line *line)
{
    while (lines->next < lines->end) {
        char *text = lines->next, *stop = memchr(text, '\n', (size_t)(lines->end - text));
        if (!stop)
            stop = lines->end;
        lines->next = stop + 1;
        lines->number++;
        if (stop > text && stop[-1] == '\r')
            stop--;
        *stop = 0;
        *line = (Line){text, lines->number};
        if (stop > text)
            return true;
    }
    return false;
}

static MesoStatus fail_at(const Reader *reader, const Line *line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static MesoStatus fail_at(const Reader *reader, const Line *line, const char *format, ...)
{
    char text[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return meso_fail(reader->error, MESO_ERR_INPUT, "%.250s:%" PRIu32 ": %s", reader->path, line->number, text);
}

/* Ends the field at `text` with a zero byte, where its quotes are undone; `*rest` is what follows
 * the comma, or NULL. False for a quote in the wrong place. */
static bool cut_field(char *text, char **rest)
{
    char *out = text, *in = text;
    if (*in != '"') {
        in += strcspn(in, ",\"");
        out = in;
    } else {
        for (in++; *in && (*in != '"' || in[1] == '"'); in++) {
            in += *in == '"';
            *out++ = *in;
        }
        if (*in++ != '"')
            return false;
    }
    *rest = *in == ',' ? in + 1 : NULL;
    if (*in && *in != ',')
        return false;
    *out = 0;
    return true;
}

/* Fields of a line, `most_fields` at most; their number, or 0 with the error filled. */
static uint32_t split(const Reader *reader, const Line *line, char *fields[], uint32_t most_fields)
{
    uint32_t count = 0;
    for (char *text = line->text; text; count++) {
        if (count == most_fields) {
            fail_at(reader, line, "more than %" PRIu32 " fields", most_fields);
            return 0;
        }
        fields[count] = text;
        if (!cut_field(text, &text)) {
            fail_at(reader, line, "field %" PRIu32 ": a quote in the wrong place", count + 1);
            return 0;
        }
    }
    return count;
}

typedef struct Header {
    uint32_t count;
    uint32_t of[COLUMN_COUNT];  /* [count] the column that each field is */
} Header;

static uint32_t find_column(const char *name)
{
    uint32_t column = 0;
    while (column < COLUMN_COUNT && strcmp(columns[column], name) != 0)
        column++;
    return column;
}

static MesoStatus fail_kind(const Reader *reader)
{
    return meso_fail(reader->error, MESO_ERR_INPUT,
                     "%s: neither an assignment nor a listing of slots, whose first line "
                     "names its columns: slot,tile and perhaps turn,flip,corner,over", reader->path);
}

static MesoStatus read_header(Reader *reader, const Line *line, Header *header)
{
    bool given[COLUMN_COUNT] = {false};
    char *fields[COLUMN_COUNT];
    header->count = split(reader, line, fields, COLUMN_COUNT);
    for (uint32_t i = 0; i < header->count; i++) {
        uint32_t column = find_column(fields[i]);
        if (column == COLUMN_COUNT || given[column])
            break;
        given[header->of[i] = column] = true;
    }
    uint32_t sum = 0;
    for (uint32_t c = 0; c < COLUMN_COUNT; c++)
        sum += given[c];
    reader->wound = given[OVER];
    if (header->count && sum == header->count && given[SLOT] && given[TILE])
        return MESO_OK;
    return fail_kind(reader);
}

static bool parse_number(const char *text, uint32_t high, uint32_t *number)
{
    size_t length = strlen(text);
    if (length == 0 || length > 10 || strspn(text, "0123456789") != length)
        return false;
    uint64_t value = strtoull(text, NULL, 10);
    *number = (uint32_t)value;
    return value <= high;
}

static MesoStatus read_row(Reader *reader, const Line *line, const Header *header)
{
    const MesoAssignment *a = &reader->slots->assignment;
    uint32_t values[COLUMN_COUNT] = {0};
    char *fields[COLUMN_COUNT];
    const char *name = "";
    uint32_t count = split(reader, line, fields, header->count);
    if (!count)
        return MESO_ERR_INPUT;
    if (count != header->count)
        return fail_at(reader, line, "%" PRIu32 " fields; the first line names %" PRIu32, count, header->count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t column = header->of[i];
        if (column == TILE)
            name = fields[i];
        else if (!parse_number(fields[i], most[column], &values[column]))
            return fail_at(reader, line, "%s '%.40s' is not a whole number from 0 to %" PRIu32, columns[column],
                           fields[i], most[column]);
    }
    if (!is_name(name))
        return fail_at(reader, line, "tile '%.40s' is no name", name);
    if (values[SLOT] >= a->slot_count)
        return fail_at(reader, line, "slot %" PRIu32 " of %" PRIu32 ": each slot from 0 must be listed once",
                       values[SLOT], a->slot_count);
    if (a->tile[values[SLOT]] != MESO_NO_INDEX)
        return fail_at(reader, line, "slot %" PRIu32 " is listed twice", values[SLOT]);
    return put_slot(reader, name, values);
}

static uint64_t count_lines(Lines lines)
{
    uint64_t count = 0;
    for (char *text = lines.next; text < lines.end; text++) {
        char *stop = memchr(text, '\n', (size_t)(lines.end - text));
        stop = stop ? stop : lines.end;
        count += stop > text && (stop > text + 1 || *text != '\r');
        text = stop;
    }
    return count;
}

static MesoStatus read_csv(Reader *reader, const MesoInput *input)
{
    Header header;
    Line line;
    char *copy = MESO_NEW(reader->arena, char, input->size + 1, reader->error);
    if (!copy)
        return MESO_ERR_MEMORY;
    memcpy(copy, input->data, input->size);
    Lines lines = {.next = copy + meso_input_mark(input), .end = copy + input->size};
    if (memchr(copy, 0, input->size) || !take_line(&lines, &line))
        return fail_kind(reader);
    MesoStatus status = read_header(reader, &line, &header);
    uint64_t count = status ? 0 : count_lines(lines);
    if (!status && (count == 0 || count > most[SLOT]))
        return meso_fail(reader->error, MESO_ERR_INPUT, "%s: lists %" PRIu64 " slots, which is no possible number",
                         reader->path, count);
    if (!status)
        status = make_room(reader, (uint32_t)count);
    while (!status && take_line(&lines, &line))
        status = read_row(reader, &line, &header);
    return status;
}

/* --- JSON --- */

static void read_hash(uint64_t hash[2], const MesoJsonField *object, const char *key)
{
    MesoJsonField field = meso_json_key(object, key);
    const char *text = meso_json_text(&field);
    if (!meso_json_good(object))
        return;
    if (strlen(text) != 32 || strspn(text, "0123456789abcdef") != 32) {
        meso_json_wrong(&field, "32 hexadecimal digits are needed");
        return;
    }
    char high[17] = "";
    memcpy(high, text, 16);
    hash[0] = strtoull(high, NULL, 16);
    hash[1] = strtoull(text + 16, NULL, 16);
}

static uint32_t read_number(const MesoJsonField *object, int column, uint32_t high)
{
    MesoJsonField field = meso_json_key(object, columns[column]);
    if (column == SLOT)
        meso_json_require(&field);
    return column == FLIP || column == OVER ? meso_json_bool(&field, false) : (uint32_t)meso_json_whole(&field, 0, high, 0);
}

static void read_item(Reader *reader, const MesoJsonField *item)
{
    static const char *const keys[] = {"slot", "tile", "turn", "flip", "corner", "over", NULL};
    const MesoAssignment *a = &reader->slots->assignment;
    uint32_t values[COLUMN_COUNT] = {0};
    if (!meso_json_object(item, keys))
        return;
    MesoJsonField tile = meso_json_key(item, "tile"), over = meso_json_key(item, "over");
    reader->wound |= over.value != NULL;
    const char *name = meso_json_text(&tile);
    for (int c = 0; c < COLUMN_COUNT; c++)
        if (c != TILE)
            values[c] = read_number(item, c, c == SLOT ? a->slot_count - 1 : most[c]);
    if (!meso_json_good(item))
        return;
    if (!is_name(name))
        meso_json_wrong(&tile, "is no name");
    else if (a->tile[values[SLOT]] != MESO_NO_INDEX)
        meso_json_wrong(item, "slot %" PRIu32 " is listed twice", values[SLOT]);
    else
        item->reader->status = put_slot(reader, name, values);
}

static void read_root(Reader *reader, const MesoJsonField *root)
{
    static const char *const keys[] = {"format", "version", "provenance", "inputs", "slots", NULL};
    static const char *const roles[] = {"tiles", "surface", NULL};
    MesoSlotsFile *slots = reader->slots;
    if (!meso_json_object(root, keys))
        return;
    MesoJsonField inputs = meso_json_key(root, "inputs"), list = meso_json_key(root, "slots");
    if (inputs.value && meso_json_object(&inputs, roles)) {
        slots->anonymous = false;
        read_hash(slots->tiles_hash, &inputs, "tiles");
        read_hash(slots->surface_hash, &inputs, "surface");
    }
    uint32_t count = meso_json_count(&list, 1, most[SLOT] + 1);
    if (!meso_json_good(root))
        return;
    root->reader->status = make_room(reader, count);
    for (uint32_t i = 0; i < count && meso_json_good(root); i++) {
        MesoJsonField item = meso_json_item(&list, i);
        read_item(reader, &item);
    }
}

static MesoStatus read_json(Reader *reader, const MesoInput *input)
{
    json_t *json;
    MesoStatus status = meso_json_parse(&json, input, reader->error);
    if (status)
        return status;
    status = meso_json_check_format(json, input->path, "meso-slots", VERSION, reader->error);
    if (!status) {
        MesoJsonReader fields = {.path = input->path, .arena = reader->arena, .error = reader->error};
        MesoJsonField root = meso_json_root(&fields, json);
        read_root(reader, &root);
        status = fields.status;
    }
    json_decref(json);
    return status;
}

static bool begins_json(const MesoInput *input)
{
    size_t i = meso_input_mark(input);
    while (i < input->size && isspace(input->data[i]))
        i++;
    return i < input->size && input->data[i] == '{';
}

MesoStatus meso_slots_text_read(MesoSlotsFile *slots, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    Reader reader = {.slots = slots, .arena = arena, .path = input->path, .error = error};
    *slots = (MesoSlotsFile){.anonymous = true, .provenance = "{}"};
    MesoStatus status = begins_json(input) ? read_json(&reader, input) : read_csv(&reader, input);
    slots->quarters = reader.oriented ? reader.quarters : NULL;
    slots->over = reader.wound ? reader.over : NULL;
    return status;
}
