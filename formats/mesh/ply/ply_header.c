/* PLY 1.0 (Turk, "The PLY Polygon File Format", 1994), with the type names in use since. */
#include "formats/mesh/ply/ply_header.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "formats/mesh/mesh_text.h"
#include "libcore/base/grow.h"

static const char *const type_names[MESO_SCALAR_KINDS][2] = {
    [MESO_SCALAR_INT8] = {"char", "int8"},     [MESO_SCALAR_UINT8] = {"uchar", "uint8"},
    [MESO_SCALAR_INT16] = {"short", "int16"},  [MESO_SCALAR_UINT16] = {"ushort", "uint16"},
    [MESO_SCALAR_INT32] = {"int", "int32"},    [MESO_SCALAR_UINT32] = {"uint", "uint32"},
    [MESO_SCALAR_FLOAT] = {"float", "float32"}, [MESO_SCALAR_DOUBLE] = {"double", "float64"},
};

static const struct {
    const char *name;
    MesoPlyRole role;
} roles[] = {
    {"x", MESO_PLY_X},   {"y", MESO_PLY_Y},   {"z", MESO_PLY_Z},
    {"nx", MESO_PLY_NX}, {"ny", MESO_PLY_NY}, {"nz", MESO_PLY_NZ},
    {"vertex_indices", MESO_PLY_INDICES}, {"vertex_index", MESO_PLY_INDICES}, {"texcoord", MESO_PLY_TEXCOORD},
};

typedef struct HeaderReader {
    MesoPly *ply;
    MesoArena *arena;
    MesoTextLine line;
    const char *next, *limit;
    uint32_t number;            /* of the line */
    MesoError *error;
} HeaderReader;

__attribute__((format(printf, 2, 3)))
static MesoStatus fail(const HeaderReader *reader, const char *format, ...)
{
    char message[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return meso_fail(reader->error, MESO_ERR_INPUT, "%s:%u: %s", reader->ply->path, reader->number, message);
}

/* A line ends with a line feed, or with a carriage return in a header whose first line does. */
static bool next_line(HeaderReader *reader)
{
    reader->number++;
    if (reader->next == reader->limit)
        return false;
    const char *end = memchr(reader->next, reader->line.line_end, (size_t)(reader->limit - reader->next));
    reader->line.begin = reader->line.at = reader->next;
    reader->line.end = end ? end : reader->limit;
    reader->next = end ? end + 1 : reader->limit;
    return true;
}

static char first_line_end(const char *at, const char *limit)
{
    while (at < limit && *at != '\n' && *at != '\r')
        at++;
    return limit - at > 1 && at[0] == '\r' && at[1] != '\n' ? '\r' : '\n';
}

static MesoStatus read_form(HeaderReader *reader)
{
    static const char *const names[] = {[MESO_PLY_ASCII] = "ascii", [MESO_PLY_LITTLE] = "binary_little_endian",
                                        [MESO_PLY_BIG] = "binary_big_endian"};
    MesoWord form = {0}, version = {0};
    if (reader->ply->form)
        return fail(reader, "format comes twice");
    meso_text_word(&reader->line, &form);
    meso_text_word(&reader->line, &version);
    for (MesoPlyForm f = MESO_PLY_ASCII; f <= MESO_PLY_BIG; f++)
        if (meso_word_is(form, names[f]) && meso_word_is(version, "1.0")) {
            reader->ply->form = f;
            return MESO_OK;
        }
    return fail(reader, "format '%.*s %.*s' is not ascii, binary_little_endian or binary_big_endian 1.0",
                MESO_WORD_ARGUMENTS(form), MESO_WORD_ARGUMENTS(version));
}

static bool read_count(MesoWord word, int64_t *count)
{
    char text[24];  /* the word may be the last of the file, with nothing behind it */
    size_t size = word.size < sizeof text - 1 ? word.size : sizeof text - 1;
    memcpy(text, word.text, size);
    text[size] = 0;
    for (size_t i = size; i < word.size; i++)
        if (word.text[i] < '0' || word.text[i] > '9')
            return false;
    return meso_word_integer((MesoWord){text, size}, count);
}

static MesoStatus read_element(HeaderReader *reader)
{
    MesoPly *ply = reader->ply;
    MesoWord name = {.text = ""}, number = {.text = ""};
    int64_t count;
    meso_text_word(&reader->line, &name);
    meso_text_word(&reader->line, &number);
    if (!read_count(number, &count) || count < 0)
        return fail(reader, "count '%.*s' of the element is not a number of items", MESO_WORD_ARGUMENTS(number));
    if (count >= UINT32_MAX - 1)
        return fail(reader, "count %.*s of the element is too large", MESO_WORD_ARGUMENTS(number));
    if (ply->element_count == MESO_PLY_ELEMENTS)
        return fail(reader, "more than %d kinds of elements", MESO_PLY_ELEMENTS);

    MesoPlyElement *element = &ply->elements[ply->element_count++];
    size_t length = name.size < sizeof element->name - 1 ? name.size : sizeof element->name - 1;
    memcpy(element->name, name.text, length);
    element->kind = meso_word_is(name, "vertex") ? MESO_PLY_VERTICES
                  : meso_word_is(name, "face")   ? MESO_PLY_FACES
                                                 : MESO_PLY_UNKNOWN;
    element->count = (uint32_t)count;
    element->properties = element->properties_end = ply->properties + ply->property_count;
    for (MesoPlyElement *other = ply->elements; other < element; other++)
        if (element->kind != MESO_PLY_UNKNOWN && other->kind == element->kind)
            return fail(reader, "element '%s' comes twice", element->name);
    return MESO_OK;
}

static MesoStatus read_type(HeaderReader *reader, MesoWord word, MesoScalar *type)
{
    for (MesoScalar t = 0; t < MESO_SCALAR_KINDS; t++)
        if (meso_word_is(word, type_names[t][0]) || meso_word_is(word, type_names[t][1])) {
            *type = t;
            return MESO_OK;
        }
    return fail(reader, "unknown type '%.*s' of a property", MESO_WORD_ARGUMENTS(word));
}

static bool is_integer(MesoScalar type)
{
    return type != MESO_SCALAR_FLOAT && type != MESO_SCALAR_DOUBLE;
}

static MesoPlyRole find_role(MesoPlyKind kind, MesoWord name)
{
    for (size_t i = 0; i < sizeof roles / sizeof *roles; i++) {
        MesoPlyKind of = roles[i].role == MESO_PLY_INDICES || roles[i].role == MESO_PLY_TEXCOORD ? MESO_PLY_FACES : MESO_PLY_VERTICES;
        if (kind == of && meso_word_is(name, roles[i].name))
            return roles[i].role;
    }
    return MESO_PLY_OTHER;
}

/* Texture coordinates that are none are like any other property. */
static MesoStatus set_role(HeaderReader *reader, MesoPlyElement *element, MesoPlyProperty *property, MesoWord name)
{
    property->role = find_role(element->kind, name);
    if (property->role == MESO_PLY_TEXCOORD &&
        (!property->list || is_integer(property->type) || element->roles & 1u << MESO_PLY_TEXCOORD))
        property->role = MESO_PLY_OTHER;
    if (property->role == MESO_PLY_OTHER && property->list && element->kind == MESO_PLY_FACES) {
        property->role = MESO_PLY_CORNERS;
        element->roles |= 1u << MESO_PLY_CORNERS;
    }
    if (property->role >= MESO_PLY_CORNERS)
        return MESO_OK;
    if (element->roles & 1u << property->role)
        return fail(reader, "property '%.*s' comes twice", MESO_WORD_ARGUMENTS(name));
    if (property->list != (property->role >= MESO_PLY_INDICES))
        return fail(reader, "property '%.*s' must%s be a list", MESO_WORD_ARGUMENTS(name),
                    property->list ? " not" : "");
    if (property->role == MESO_PLY_INDICES && !is_integer(property->type))
        return fail(reader, "vertex indices are not integers");
    element->roles |= 1u << property->role;
    return MESO_OK;
}

static MesoStatus read_types(HeaderReader *reader, MesoPlyProperty *property)
{
    MesoWord word = {.text = ""};
    meso_text_word(&reader->line, &word);
    property->list = meso_word_is(word, "list");
    if (property->list) {
        meso_text_word(&reader->line, &word);
        MesoStatus status = read_type(reader, word, &property->count_type);
        if (status)
            return status;
        if (!is_integer(property->count_type))
            return fail(reader, "count of a list is not an integer");
        meso_text_word(&reader->line, &word);
    }
    return read_type(reader, word, &property->type);
}

static MesoStatus read_property(HeaderReader *reader)
{
    MesoPly *ply = reader->ply;
    if (ply->element_count == 0)
        return fail(reader, "property before the first element");
    if (ply->property_count == MESO_PLY_PROPERTIES)
        return fail(reader, "more than %d properties", MESO_PLY_PROPERTIES);
    MesoPlyElement *element = &ply->elements[ply->element_count - 1];
    MesoPlyProperty *property = &ply->properties[ply->property_count++];
    element->properties_end = property + 1;

    MesoStatus status = read_types(reader, property);
    if (status)
        return status;
    MesoWord word;
    if (!meso_text_word(&reader->line, &word))
        return fail(reader, "property without a name");
    char *name = MESO_NEW(reader->arena, char, word.size + 1, reader->error);
    if (!name)
        return MESO_ERR_MEMORY;
    property->name = memcpy(name, word.text, word.size);
    element->lists |= property->list;
    if (!property->list)
        element->size += meso_scalar_size(property->type);
    return set_role(reader, element, property, word);
}

static const char *copy_range(MesoArena *arena, const char *begin, const char *end, MesoError *error)
{
    char *copy = MESO_NEW(arena, char, (size_t)(end - begin) + 1, error);
    if (copy)
        memcpy(copy, begin, (size_t)(end - begin));
    return copy;
}

/* What is behind the number and one blank, blanks among it; other comments are passed over. */
static MesoStatus read_comment(HeaderReader *reader)
{
    MesoPly *ply = reader->ply;
    MesoTextLine *line = &reader->line;
    MesoWord property, number;
    int64_t value;
    if (!meso_text_word(line, &property) || !meso_text_word(line, &number) || !read_count(number, &value) ||
        value < 0 || value >= UINT32_MAX)
        return MESO_OK;
    const char *begin = line->at < line->end ? line->at + 1 : line->end, *end = line->end;
    end -= end > begin && end[-1] == '\r';
    MesoPlyName name = {.number = (uint32_t)value, .name = copy_range(reader->arena, begin, end, reader->error)};
    name.property = copy_range(reader->arena, property.text, property.text + property.size, reader->error);
    ply->names = MESO_GROW(reader->arena, ply->names, ply->name_count, ply->name_room, 16, reader->error);
    if (!name.name || !name.property || !ply->names)
        return MESO_ERR_MEMORY;
    ply->names[ply->name_count++] = name;
    return MESO_OK;
}

/* An element without properties takes no bytes: any count would fit any file. */
static MesoStatus check_header(const MesoPly *ply, MesoError *error)
{
    const uint32_t position = 1u << MESO_PLY_X | 1u << MESO_PLY_Y | 1u << MESO_PLY_Z;
    bool vertices = false;
    if (ply->form == MESO_PLY_NONE)
        return meso_fail(error, MESO_ERR_INPUT, "%s: header has no format line", ply->path);
    for (uint32_t e = 0; e < ply->element_count; e++) {
        const MesoPlyElement *element = &ply->elements[e];
        if (element->properties == element->properties_end)
            return meso_fail(error, MESO_ERR_INPUT, "%s: element '%s' has no properties", ply->path, element->name);
        if (element->kind == MESO_PLY_VERTICES && (element->roles & position) != position)
            return meso_fail(error, MESO_ERR_INPUT, "%s: vertices lack a property x, y or z", ply->path);
        if (element->kind == MESO_PLY_FACES && !(element->roles & 1u << MESO_PLY_INDICES))
            return meso_fail(error, MESO_ERR_INPUT, "%s: faces lack the list vertex_indices", ply->path);
        vertices |= element->kind == MESO_PLY_VERTICES;
    }
    if (!vertices)
        return meso_fail(error, MESO_ERR_INPUT, "%s: mesh has no element 'vertex'", ply->path);
    return MESO_OK;
}

static MesoStatus read_statements(HeaderReader *reader)
{
    MesoWord word = {0};
    if (!next_line(reader) || !meso_text_word(&reader->line, &word) || !meso_word_is(word, "ply"))
        return fail(reader, "not a PLY file: the first line is not 'ply'");
    while (next_line(reader)) {
        MesoStatus status = MESO_OK;
        if (!meso_text_word(&reader->line, &word) || meso_word_is(word, "obj_info"))
            continue;
        if (meso_word_is(word, "end_header"))
            return check_header(reader->ply, reader->error);
        if (meso_word_is(word, "comment"))
            status = read_comment(reader);
        else if (meso_word_is(word, "format"))
            status = read_form(reader);
        else if (meso_word_is(word, "element"))
            status = read_element(reader);
        else if (meso_word_is(word, "property"))
            status = read_property(reader);
        else
            status = fail(reader, "unknown statement '%.*s' in the header", MESO_WORD_ARGUMENTS(word));
        if (status)
            return status;
    }
    return fail(reader, "file ends in the header");
}

MesoStatus meso_ply_header_read(MesoPly *ply, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    const char *data = (const char *)input->data;
    HeaderReader reader = {.ply = ply, .arena = arena, .next = data + meso_input_mark(input),
                           .limit = data + input->size, .error = error};
    *ply = (MesoPly){.path = input->path};
    reader.line.line_end = first_line_end(reader.next, reader.limit);
    MesoStatus status = read_statements(&reader);
    ply->body = (size_t)(reader.next - data);
    return status;
}
