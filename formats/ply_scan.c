/* PLY 1.0 (Turk, "The PLY Polygon File Format", 1994), with the type names in use since. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "formats/mesh_scan.h"
#include "formats/mesh_text.h"

enum { MAX_ELEMENTS = 64, MAX_PROPERTIES = 512 };

typedef enum PlyForm { FORM_NONE, FORM_ASCII, FORM_LITTLE, FORM_BIG } PlyForm;

typedef enum PlyType { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, TYPE_COUNT } PlyType;

static const struct {
    const char *names[2];
    uint32_t size;
} types[TYPE_COUNT] = {
    [INT8] = {{"char", "int8"}, 1},      [UINT8] = {{"uchar", "uint8"}, 1},
    [INT16] = {{"short", "int16"}, 2},   [UINT16] = {{"ushort", "uint16"}, 2},
    [INT32] = {{"int", "int32"}, 4},     [UINT32] = {{"uint", "uint32"}, 4},
    [FLOAT32] = {{"float", "float32"}, 4}, [FLOAT64] = {{"double", "float64"}, 8},
};

/* What a property is for; the first six in the order of a vertex's numbers. */
typedef enum PlyRole { ROLE_X, ROLE_Y, ROLE_Z, ROLE_NX, ROLE_NY, ROLE_NZ, ROLE_INDICES, ROLE_NONE } PlyRole;

static const struct {
    const char *name;
    PlyRole role;
} roles[] = {
    {"x", ROLE_X},   {"y", ROLE_Y},   {"z", ROLE_Z},
    {"nx", ROLE_NX}, {"ny", ROLE_NY}, {"nz", ROLE_NZ},
    {"vertex_indices", ROLE_INDICES}, {"vertex_index", ROLE_INDICES},
};

typedef enum PlyKind { KIND_VERTEX, KIND_FACE, KIND_OTHER } PlyKind;

typedef struct PlyProperty {
    PlyType type, count_type;
    bool list;
    PlyRole role;
    uint32_t column;            /* of the groups, or MESO_NO_INDEX */
} PlyProperty;

typedef struct PlyElement {
    char name[32];
    PlyKind kind;
    uint32_t count;
    uint32_t property_begin, property_end;
    uint32_t roles;             /* bit set of the roles that its properties have */
} PlyElement;

typedef struct Ply {
    MesoMeshScan *scan;
    MesoGroupsBuilder *groups;  /* or NULL */
    MesoMeshText text;          /* after the header of a binary file, `next` is where its bytes go on */
    PlyForm form;
    uint32_t element_count, property_count;
    PlyElement elements[MAX_ELEMENTS];
    PlyProperty properties[MAX_PROPERTIES];
    const PlyElement *element;  /* being read, with the number of its item */
    uint32_t item;
} Ply;

/* -- header ------------------------------------------------------------- */

static MesoStatus read_form(Ply *ply, MesoError *error)
{
    static const char *const names[] = {[FORM_ASCII] = "ascii", [FORM_LITTLE] = "binary_little_endian",
                                        [FORM_BIG] = "binary_big_endian"};
    MesoWord form = {0}, version = {0};
    if (ply->form)
        return meso_mesh_text_fail(&ply->text, error, "format comes twice");
    meso_mesh_text_word(&ply->text, &form);
    meso_mesh_text_word(&ply->text, &version);
    for (PlyForm f = FORM_ASCII; f <= FORM_BIG; f++)
        if (meso_word_is(form, names[f]) && meso_word_is(version, "1.0")) {
            ply->form = f;
            return MESO_OK;
        }
    return meso_mesh_text_fail(&ply->text, error,
                               "format '%.*s %.*s' is not ascii, binary_little_endian or "
                               "binary_big_endian 1.0", MESO_WORD_ARGUMENTS(form), MESO_WORD_ARGUMENTS(version));
}

static MesoStatus read_element(Ply *ply, MesoError *error)
{
    MesoWord name = {0}, number = {0};
    int64_t count;
    meso_mesh_text_word(&ply->text, &name);
    meso_mesh_text_word(&ply->text, &number);
    if (!meso_word_integer(number, &count) || count < 0)
        return meso_mesh_text_fail(&ply->text, error, "count '%.*s' of the element is not a number of items",
                                   MESO_WORD_ARGUMENTS(number));
    if (count >= UINT32_MAX - 1)
        return meso_mesh_text_fail(&ply->text, error, "count %.*s of the element is too large",
                                   MESO_WORD_ARGUMENTS(number));
    if (ply->element_count == MAX_ELEMENTS)
        return meso_mesh_text_fail(&ply->text, error, "more than %d kinds of elements", MAX_ELEMENTS);

    PlyElement *element = &ply->elements[ply->element_count++];
    size_t length = name.size < sizeof element->name - 1 ? name.size : sizeof element->name - 1;
    memcpy(element->name, name.text, length);
    element->kind = meso_word_is(name, "vertex") ? KIND_VERTEX : meso_word_is(name, "face") ? KIND_FACE : KIND_OTHER;
    element->count = (uint32_t)count;
    element->property_begin = element->property_end = ply->property_count;
    for (PlyElement *other = ply->elements; other < element; other++)
        if (element->kind != KIND_OTHER && other->kind == element->kind)
            return meso_mesh_text_fail(&ply->text, error, "element '%s' comes twice", element->name);
    return MESO_OK;
}

static MesoStatus read_type(Ply *ply, MesoWord word, PlyType *type, MesoError *error)
{
    for (PlyType t = 0; t < TYPE_COUNT; t++)
        if (meso_word_is(word, types[t].names[0]) || meso_word_is(word, types[t].names[1])) {
            *type = t;
            return MESO_OK;
        }
    return meso_mesh_text_fail(&ply->text, error, "unknown type '%.*s' of a property", MESO_WORD_ARGUMENTS(word));
}

static MesoStatus set_role(Ply *ply, PlyElement *element, PlyProperty *property, MesoWord name, MesoError *error)
{
    property->role = ROLE_NONE;
    for (size_t i = 0; i < sizeof roles / sizeof *roles; i++) {
        PlyKind kind = roles[i].role == ROLE_INDICES ? KIND_FACE : KIND_VERTEX;
        if (element->kind == kind && meso_word_is(name, roles[i].name))
            property->role = roles[i].role;
    }
    if (property->role == ROLE_NONE)
        return MESO_OK;
    if (element->roles & 1u << property->role)
        return meso_mesh_text_fail(&ply->text, error, "property '%.*s' comes twice", MESO_WORD_ARGUMENTS(name));
    if (property->list != (property->role == ROLE_INDICES))
        return meso_mesh_text_fail(&ply->text, error, "property '%.*s' must%s be a list", MESO_WORD_ARGUMENTS(name),
                                   property->list ? " not" : "");
    if (property->role == ROLE_INDICES && property->type >= FLOAT32)
        return meso_mesh_text_fail(&ply->text, error, "vertex indices are not integers");
    element->roles |= 1u << property->role;
    return MESO_OK;
}

/* A number of faces or vertices that has no part in their shape. Colours are fractions of the largest. */
static MesoStatus add_column(Ply *ply, const PlyElement *element, PlyProperty *property, MesoWord name,
                             MesoError *error)
{
    static const char *const colours[] = {"red", "green", "blue", "alpha"};
    double scale = 1;
    property->column = MESO_NO_INDEX;
    if (!ply->groups || property->list || property->role != ROLE_NONE || element->kind == KIND_OTHER)
        return MESO_OK;
    for (uint32_t c = 0; c < 4; c++)
        if (meso_word_is(name, colours[c]) && (property->type == UINT8 || property->type == UINT16))
            scale = property->type == UINT8 ? 1.0 / 255 : 1.0 / 65535;
    return meso_groups_column(ply->groups, name.text, name.size, element->kind == KIND_VERTEX, scale,
                              &property->column, error);
}

static MesoStatus read_property(Ply *ply, MesoError *error)
{
    if (ply->element_count == 0)
        return meso_mesh_text_fail(&ply->text, error, "property before the first element");
    if (ply->property_count == MAX_PROPERTIES)
        return meso_mesh_text_fail(&ply->text, error, "more than %d properties", MAX_PROPERTIES);
    PlyElement *element = &ply->elements[ply->element_count - 1];
    PlyProperty *property = &ply->properties[ply->property_count++];
    element->property_end = ply->property_count;

    MesoWord word = {0};
    MesoStatus status = MESO_OK;
    meso_mesh_text_word(&ply->text, &word);
    property->list = meso_word_is(word, "list");
    if (property->list) {
        meso_mesh_text_word(&ply->text, &word);
        status = read_type(ply, word, &property->count_type, error);
        if (!status && property->count_type >= FLOAT32)
            return meso_mesh_text_fail(&ply->text, error, "count of a list is not an integer");
        meso_mesh_text_word(&ply->text, &word);
    }
    if (!status)
        status = read_type(ply, word, &property->type, error);
    if (status)
        return status;
    if (!meso_mesh_text_word(&ply->text, &word))
        return meso_mesh_text_fail(&ply->text, error, "property without a name");
    status = set_role(ply, element, property, word, error);
    if (!status)
        status = add_column(ply, element, property, word, error);
    /* OpenMesh is to compare positions and faces: under this name it passes over the rest. */
    if (!status && property->role > ROLE_Z && property->role != ROLE_INDICES)
        word.text[0] = '_';
    return status;
}

/* An element without properties takes no bytes: any count would fit any file. */
static MesoStatus check_header(const Ply *ply, const char *path, MesoError *error)
{
    const uint32_t position = 1u << ROLE_X | 1u << ROLE_Y | 1u << ROLE_Z;
    bool vertices = false, faces = false;
    if (ply->form == FORM_NONE)
        return meso_fail(error, MESO_ERR_INPUT, "%s: header has no format line", path);
    for (uint32_t e = 0; e < ply->element_count; e++) {
        const PlyElement *element = &ply->elements[e];
        if (element->property_begin == element->property_end)
            return meso_fail(error, MESO_ERR_INPUT, "%s: element '%s' has no properties", path, element->name);
        if (element->kind == KIND_VERTEX && (element->roles & position) != position)
            return meso_fail(error, MESO_ERR_INPUT, "%s: vertices lack a property x, y or z", path);
        if (element->kind == KIND_FACE && !element->roles)
            return meso_fail(error, MESO_ERR_INPUT, "%s: faces lack the list vertex_indices", path);
        vertices |= element->kind == KIND_VERTEX;
        faces |= element->kind == KIND_FACE;
    }
    if (!vertices || !faces)
        return meso_fail(error, MESO_ERR_INPUT, "%s: mesh has no element '%s'", path, vertices ? "face" : "vertex");
    return MESO_OK;
}

/*
 * Whether OpenMesh knows the layout: it takes vertices before faces, nothing in
 * a face before the vertex indices, no list elsewhere before them, counts of two
 * types only, in binary files coordinates that are not integers, and in text no
 * property of one byte, which it reads as a character and never ends.
 */
static bool known_to_openmesh(const Ply *ply)
{
    bool vertices = false, indices = false;
    for (const PlyElement *element = ply->elements; element < ply->elements + ply->element_count; element++) {
        vertices |= element->kind == KIND_VERTEX;
        if (element->kind == KIND_FACE && !vertices)
            return false;
        for (uint32_t p = element->property_begin; p < element->property_end; p++) {
            const PlyProperty *property = &ply->properties[p];
            indices |= property->role == ROLE_INDICES;
            if (element->kind == KIND_FACE && !indices)
                return false;
            if (property->list && (!indices || (property->count_type != UINT8 && property->count_type != INT32)))
                return false;
            if (ply->form == FORM_ASCII && !property->list && types[property->type].size == 1)
                return false;
            if (ply->form != FORM_ASCII && property->role <= ROLE_Z && property->type < FLOAT32)
                return false;
        }
    }
    return true;
}

static MesoStatus read_header(Ply *ply, MesoError *error)
{
    MesoWord word = {0};
    if (!meso_mesh_text_line(&ply->text, false) || !meso_mesh_text_word(&ply->text, &word) || !meso_word_is(word, "ply"))
        return meso_mesh_text_fail(&ply->text, error, "not a PLY file: the first line is not 'ply'");
    while (meso_mesh_text_line(&ply->text, false)) {
        MesoStatus status = MESO_OK;
        if (!meso_mesh_text_word(&ply->text, &word) || meso_word_is(word, "comment") || meso_word_is(word, "obj_info"))
            continue;
        if (meso_word_is(word, "end_header"))
            return check_header(ply, ply->text.path, error);
        if (meso_word_is(word, "format"))
            status = read_form(ply, error);
        else if (meso_word_is(word, "element"))
            status = read_element(ply, error);
        else if (meso_word_is(word, "property"))
            status = read_property(ply, error);
        else
            status = meso_mesh_text_fail(&ply->text, error, "unknown statement '%.*s' in the header",
                                         MESO_WORD_ARGUMENTS(word));
        if (status)
            return status;
    }
    return meso_mesh_text_fail(&ply->text, error, "file ends in the header");
}

/* -- items -------------------------------------------------------------- */

/* Fails with the element and item (from 1) where a binary file has no line to name. */
static MesoStatus fail_item(const Ply *ply, MesoError *error, const char *what)
{
    if (ply->form == FORM_ASCII)
        return meso_mesh_text_fail(&ply->text, error, "%s %u %s", ply->element->name, ply->item + 1, what);
    return meso_fail(error, MESO_ERR_INPUT, "%s: %s %u %s", ply->text.path, ply->element->name, ply->item + 1, what);
}

static MesoStatus read_word_scalar(Ply *ply, PlyType type, double *value, MesoError *error)
{
    MesoWord word;
    int64_t integer;
    float number = 0;
    if (!meso_mesh_text_word(&ply->text, &word))
        return fail_item(ply, error, "has too few values");
    if (type >= FLOAT32) {
        MesoStatus status = meso_word_number(&ply->text, word, "value", &number, error);
        *value = (double)number;
        return status;
    }
    if (!meso_word_integer(word, &integer))
        return meso_mesh_text_fail(&ply->text, error, "value '%.*s' is not an integer", MESO_WORD_ARGUMENTS(word));
    *value = (double)integer;
    return MESO_OK;
}

static uint64_t load(const unsigned char *bytes, uint32_t size, bool big)
{
    uint64_t bits = 0;
    for (uint32_t i = 0; i < size; i++)
        bits |= (uint64_t)bytes[i] << 8 * (big ? size - 1 - i : i);
    return bits;
}

static double decode(PlyType type, uint64_t bits)
{
    float single;
    double value;
    uint32_t low = (uint32_t)bits;
    switch (type) {
    case INT8: return (int8_t)bits;
    case UINT8: return (uint8_t)bits;
    case INT16: return (int16_t)bits;
    case UINT16: return (uint16_t)bits;
    case INT32: return (int32_t)bits;
    case FLOAT32: memcpy(&single, &low, sizeof single); return (double)single;
    case FLOAT64: memcpy(&value, &bits, sizeof value); return value;
    default: return low;
    }
}

static MesoStatus read_scalar(Ply *ply, PlyType type, double *value, MesoError *error)
{
    if (ply->form == FORM_ASCII)
        return read_word_scalar(ply, type, value, error);
    uint32_t size = types[type].size;
    if ((size_t)(ply->text.bytes + ply->text.size - ply->text.next) < size)
        return meso_fail(error, MESO_ERR_INPUT, "%s: file ends in %s %u of %u", ply->text.path,
                         ply->element->name, ply->item + 1, ply->element->count);
    *value = decode(type, load((const unsigned char *)ply->text.next, size, ply->form == FORM_BIG));
    ply->text.next += size;
    return MESO_OK;
}

static MesoStatus read_list(Ply *ply, const PlyProperty *property, MesoError *error)
{
    double count = 0, value = 0;
    MesoStatus status = read_scalar(ply, property->count_type, &count, error);
    if (!status && count < 0)
        return fail_item(ply, error, "has a list of negative length");
    for (double i = 0; i < count && !status; i++) {
        status = read_scalar(ply, property->type, &value, error);
        if (status || property->role != ROLE_INDICES)
            continue;
        if (value < 0)
            return fail_item(ply, error, "has a negative vertex index");
        if (value >= UINT32_MAX)
            return fail_item(ply, error, "has a vertex index that is too large");
        status = meso_mesh_scan_corner(ply->scan, (uint32_t)value, MESO_NO_INDEX, error);
    }
    return status;
}

static MesoStatus add_vertex(Ply *ply, const double *numbers, MesoError *error)
{
    float narrow[6];
    for (int i = 0; i < 6; i++) {
        if (!(fabs(numbers[i]) <= (double)FLT_MAX))
            return fail_item(ply, error, i < 3 ? "is not finite" : "has a normal that is not finite");
        narrow[i] = (float)numbers[i];
    }
    const uint32_t normal = 1u << ROLE_NX | 1u << ROLE_NY | 1u << ROLE_NZ;
    MesoStatus status = meso_mesh_scan_vertex(ply->scan, (MesoVec3){narrow[0], narrow[1], narrow[2]}, error);
    if (!status && (ply->element->roles & normal) == normal)
        status = meso_mesh_scan_normal(ply->scan, (MesoVec3){narrow[3], narrow[4], narrow[5]}, error);
    return status;
}

static MesoStatus read_item(Ply *ply, MesoError *error)
{
    double numbers[ROLE_NONE + 1] = {0};
    MesoStatus status = MESO_OK;
    if (ply->form == FORM_ASCII && !meso_mesh_text_filled_line(&ply->text))
        return meso_mesh_text_fail(&ply->text, error, "file ends before %s %u of %u", ply->element->name,
                                   ply->item + 1, ply->element->count);
    for (uint32_t p = ply->element->property_begin; p < ply->element->property_end && !status; p++) {
        const PlyProperty *property = &ply->properties[p];
        status = property->list ? read_list(ply, property, error)
                                : read_scalar(ply, property->type, &numbers[property->role], error);
        if (!status && property->column != MESO_NO_INDEX)
            status = meso_groups_value(ply->groups, property->column, numbers[ROLE_NONE], error);
    }
    MesoWord more;
    if (!status && ply->form == FORM_ASCII && meso_mesh_text_word(&ply->text, &more))
        return fail_item(ply, error, "has too many values");
    if (!status && ply->element->kind == KIND_VERTEX)
        status = add_vertex(ply, numbers, error);
    if (!status && ply->element->kind == KIND_FACE)
        status = meso_mesh_scan_face(ply->scan, ply->form == FORM_ASCII ? ply->text.line : 0, error);
    return status;
}

static MesoStatus check_end(Ply *ply, MesoError *error)
{
    if (ply->form == FORM_ASCII && meso_mesh_text_filled_line(&ply->text))
        return meso_mesh_text_fail(&ply->text, error, "more lines than the header counts");
    if (ply->form != FORM_ASCII && ply->text.next != ply->text.bytes + ply->text.size)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %zu bytes more than the header counts", ply->text.path,
                         (size_t)(ply->text.bytes + ply->text.size - ply->text.next));
    return MESO_OK;
}

MesoStatus meso_ply_scan_groups(MesoMeshScan *scan, MesoGroupsBuilder *groups, MesoArena *arena,
                                const MesoInput *input, MesoError *error)
{
    Ply *ply = MESO_NEW(arena, Ply, 1, error);
    if (!ply)
        return MESO_ERR_MEMORY;
    *scan = (MesoMeshScan){.arena = arena};
    ply->scan = scan;
    ply->groups = groups;
    MesoStatus status = meso_mesh_text_init(&ply->text, arena, input, 0, error);
    if (!status)
        status = read_header(ply, error);
    for (uint32_t e = 0; e < ply->element_count && !status; e++) {
        ply->element = &ply->elements[e];
        for (ply->item = 0; ply->item < ply->element->count && !status; ply->item++)
            status = read_item(ply, error);
    }
    if (!status)
        status = check_end(ply, error);
    if (status)
        return status;
    scan->bytes = known_to_openmesh(ply) ? ply->text.bytes : NULL;
    scan->size = ply->text.size;
    if (scan->normal_count && scan->corner_count)
        memcpy(scan->corner_normals, scan->corner_vertices, scan->corner_count * sizeof *scan->corner_normals);
    return meso_mesh_scan_check(scan, input->path, error);
}

MesoStatus meso_ply_scan(MesoMeshScan *scan, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    return meso_ply_scan_groups(scan, NULL, arena, input, error);
}
