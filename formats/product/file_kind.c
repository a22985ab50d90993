#include "formats/product/file_kind.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

#include "formats/file/container.h"
#include "formats/product/product_file.h"

static bool begins_at(const MesoInput *input, size_t at, const char *text)
{
    size_t length = strlen(text);
    return input->size - at >= length && memcmp(input->data + at, text, length) == 0;
}

static size_t skip_blanks(const MesoInput *input, size_t at)
{
    while (at < input->size && isspace(input->data[at]))
        at++;
    return at;
}

/* ---- JSON ---- */

/* From the opening quote at `at` to behind the closing one. */
static size_t skip_string(const MesoInput *input, size_t at)
{
    for (at++; at < input->size && input->data[at] != '"'; at++)
        at += input->data[at] == '\\';
    return at < input->size ? at + 1 : input->size;
}

static bool is_string(const MesoInput *input, size_t begin, size_t end, const char *text)
{
    size_t length = strlen(text);
    return end - begin == length + 2 && memcmp(input->data + begin + 1, text, length) == 0;
}

/* Keys of the outermost object that tell kinds apart. */
typedef struct Keys {
    bool tile_types, edge_types, asset, seed, verdict;
    MesoFileKind format;        /* by its value; MESO_FILE_UNKNOWN for another or none */
} Keys;

static MesoFileKind kind_of_format(const MesoInput *input, size_t at)
{
    static const struct {
        const char *name;
        MesoFileKind kind;
    } formats[] = {{"meso-tiles", MESO_FILE_TILES}, {"meso-constraints", MESO_FILE_CONSTRAINTS},
                   {"meso-report", MESO_FILE_REPORT}, {"meso-slots", MESO_FILE_LISTING},
                   {"meso-pattern", MESO_FILE_PATTERN}, {"meso-macros", MESO_FILE_MACROS},
                   {"meso-regions", MESO_FILE_REGIONS}, {"meso-details", MESO_FILE_DETAILS},
                   {"meso-deform", MESO_FILE_DEFORM}};
    if (at == input->size || input->data[at] != '"')
        return MESO_FILE_UNKNOWN;
    size_t end = skip_string(input, at);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (is_string(input, at, end, formats[i].name))
            return formats[i].kind;
    return MESO_FILE_UNKNOWN;
}

/* The string from `begin` to `end` is a key of the outermost object, whose value begins at `value`. */
static void note_key(Keys *keys, const MesoInput *input, size_t begin, size_t end, size_t value)
{
    keys->tile_types |= is_string(input, begin, end, "tileTypes");
    keys->edge_types |= is_string(input, begin, end, "edgeTypes");
    keys->asset |= is_string(input, begin, end, "asset");
    keys->seed |= is_string(input, begin, end, "seed");
    keys->verdict |= is_string(input, begin, end, "verdict");
    if (is_string(input, begin, end, "format"))
        keys->format = kind_of_format(input, value);
}

/* Strings, brackets and colons are all that is looked at. */
static Keys find_keys(const MesoInput *input, size_t at)
{
    Keys keys = {0};
    size_t depth = 0;
    while (at < input->size && !keys.format) {
        uint8_t byte = input->data[at];
        if (byte == '"') {
            size_t end = skip_string(input, at), colon = skip_blanks(input, end);
            if (depth == 1 && colon < input->size && input->data[colon] == ':')
                note_key(&keys, input, at, end, skip_blanks(input, colon + 1));
            at = end;
            continue;
        }
        depth += byte == '{' || byte == '[';
        depth -= (byte == '}' || byte == ']') && depth > 0;
        if (depth == 0 && (byte == '}' || byte == ']'))
            break;
        at++;
    }
    return keys;
}

static MesoFileKind kind_of_json(const MesoInput *input, size_t at)
{
    if (input->data[at] == '[')
        return MESO_FILE_JSON;
    Keys keys = find_keys(input, at);
    if (keys.format)
        return keys.format;
    if (keys.tile_types && keys.edge_types)
        return MESO_FILE_PROTOTYPE;
    if (keys.seed && keys.verdict)
        return MESO_FILE_SEED_LINES;
    return keys.asset ? MESO_FILE_GLTF : MESO_FILE_JSON;
}

/* ---- the others ---- */

/* To the first line that is no comment. */
static size_t skip_comments(const MesoInput *input, size_t at)
{
    at = skip_blanks(input, at);
    while (at < input->size && input->data[at] == '#') {
        while (at < input->size && input->data[at] != '\n' && input->data[at] != '\r')
            at++;
        at = skip_blanks(input, at);
    }
    return at;
}

static bool begins_obj(const MesoInput *input, size_t at)
{
    static const char *const statements[] = {"v ", "v\t", "vn ", "vt ", "o ", "g ", "s ", "mtllib ", "usemtl "};
    for (size_t i = 0; i < sizeof statements / sizeof *statements; i++)
        if (begins_at(input, at, statements[i]))
            return true;
    return false;
}

static bool begins_off(const MesoInput *input, size_t at)
{
    static const char *const keywords[] = {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++)
        if (begins_at(input, at, keywords[i]))
            return true;
    return false;
}

static MesoFileKind kind_of_text(const MesoInput *input)
{
    size_t mark = meso_input_mark(input), at = skip_blanks(input, mark);
    if (begins_at(input, mark, "ply\n") || begins_at(input, mark, "ply\r"))
        return MESO_FILE_PLY;
    if (at < input->size && (input->data[at] == '{' || input->data[at] == '['))
        return kind_of_json(input, at);
    if (begins_at(input, 0, "#?RADIANCE") || begins_at(input, 0, "#?RGBE"))
        return MESO_FILE_HDR;
    if (begins_at(input, mark, "slot,tile"))
        return MESO_FILE_CSV;
    at = skip_comments(input, at);
    if (begins_at(input, at, "meso-grow "))
        return MESO_FILE_GRAMMAR;
    if (begins_off(input, at))
        return MESO_FILE_OFF;
    return begins_obj(input, at) ? MESO_FILE_OBJ : MESO_FILE_UNKNOWN;
}

/* The kind stands behind the magic. */
static MesoFileKind kind_of_container(const MesoInput *input)
{
    const char *kind = input->size >= 16 ? (const char *)input->data + 8 : "";
    return strncmp(kind, "model", 8) == 0 ? MESO_FILE_MODEL
        : strncmp(kind, "quilt", 8) == 0 ? MESO_FILE_QUILT
        : strncmp(kind, "state", 8) == 0 ? MESO_FILE_STATE
        : strncmp(kind, "plan", 8) == 0 ? MESO_FILE_PLAN : MESO_FILE_SLOTS;
}

MesoFileKind meso_file_kind(const MesoInput *input)
{
    if (meso_container_recognise(input))
        return kind_of_container(input);
    switch (meso_product_recognise(input)) {
    case MESO_PRODUCT_EXR: return MESO_FILE_EXR;
    case MESO_PRODUCT_PNG: return MESO_FILE_PNG;
    case MESO_PRODUCT_GLB: return MESO_FILE_GLB;
    case MESO_PRODUCT_DRC: return MESO_FILE_DRC;
    case MESO_PRODUCT_PLY: return MESO_FILE_PLY;
    case MESO_PRODUCT_OBJ: return MESO_FILE_OBJ;
    case MESO_PRODUCT_NONE: break;
    }
    return kind_of_text(input);
}

const char *meso_file_kind_phrase(MesoFileKind kind)
{
    switch (kind) {
    case MESO_FILE_TILES: return "a tile set";
    case MESO_FILE_PROTOTYPE: return "a tile set of the prototype";
    case MESO_FILE_CONSTRAINTS: return "a file of constraints";
    case MESO_FILE_REPORT: return "a report";
    case MESO_FILE_SEED_LINES: return "a list of seeds";
    case MESO_FILE_GLTF: return "a glTF scene";
    case MESO_FILE_JSON: return "JSON of another kind";
    case MESO_FILE_SLOTS: return "an assignment (.slots)";
    case MESO_FILE_MODEL: return "a model (.meso)";
    case MESO_FILE_QUILT: return "a quilt (.quilt)";
    case MESO_FILE_GRAMMAR: return "a grammar (.grammar)";
    case MESO_FILE_OBJ: return "an OBJ mesh";
    case MESO_FILE_PLY: return "a PLY mesh";
    case MESO_FILE_OFF: return "an OFF mesh";
    case MESO_FILE_GLB: return "a GLB scene";
    case MESO_FILE_DRC: return "a Draco mesh";
    case MESO_FILE_EXR: return "an EXR image";
    case MESO_FILE_PNG: return "a PNG image";
    case MESO_FILE_HDR: return "a Radiance picture";
    case MESO_FILE_LISTING: return "a listing of slots";
    case MESO_FILE_PATTERN: return "a pattern";
    case MESO_FILE_MACROS: return "a file of macros";
    case MESO_FILE_REGIONS: return "a tree of regions";
    case MESO_FILE_DETAILS: return "details";
    case MESO_FILE_DEFORM: return "a deformation";
    case MESO_FILE_STATE: return "a state of details (.state)";
    case MESO_FILE_PLAN: return "a plan of details (.plan)";
    case MESO_FILE_CSV: return "a listing of slots (CSV)";
    case MESO_FILE_UNKNOWN: break;
    }
    return "of no kind that is known here";
}
