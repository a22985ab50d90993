#include "formats/product/product_file.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_text.h"

/* Bytes not looked at yet; a read beyond the end sets `broken`. */
typedef struct Cursor {
    const uint8_t *next;
    size_t left;
    bool broken;
} Cursor;

static const char exr_magic[] = "\x76\x2f\x31\x01", png_magic[] = "\x89PNG\r\n\x1a\n";
static const char obj_mark[] = "# provenance ", ply_mark[] = "comment provenance ";
static const char obj_more[] = "# provenance+ ", ply_more[] = "comment provenance+ ";

static bool begins(const MesoInput *input, const char *text)
{
    size_t length = strlen(text);
    return input->size >= length && memcmp(input->data, text, length) == 0;
}

MesoProductKind meso_product_recognise(const MesoInput *input)
{
    if (begins(input, exr_magic))
        return MESO_PRODUCT_EXR;
    if (begins(input, png_magic))
        return MESO_PRODUCT_PNG;
    if (begins(input, "glTF"))
        return MESO_PRODUCT_GLB;
    if (begins(input, "DRACO"))
        return MESO_PRODUCT_DRC;
    if (begins(input, "ply\n") || begins(input, "ply\r"))
        return MESO_PRODUCT_PLY;
    return begins(input, obj_mark) ? MESO_PRODUCT_OBJ : MESO_PRODUCT_NONE;
}

const char *meso_product_name(MesoProductKind kind)
{
    static const char *const names[] = {"none", "exr", "png", "glb", "drc", "ply", "obj"};
    return names[kind];
}

static const uint8_t *take(Cursor *cursor, size_t size)
{
    static const uint8_t nothing[64];
    if (size > cursor->left) {
        cursor->broken = true;
        cursor->left = 0;
        return size <= sizeof nothing ? nothing : NULL;
    }
    const uint8_t *bytes = cursor->next;
    cursor->next += size;
    cursor->left -= size;
    return bytes;
}

static uint32_t take_little(Cursor *cursor)
{
    const uint8_t *b = take(cursor, 4);
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static uint32_t take_big(Cursor *cursor)
{
    return __builtin_bswap32(take_little(cursor));
}

/* Text up to its zero byte; "" and broken where there is none. */
static const char *take_text(Cursor *cursor)
{
    const uint8_t *end = cursor->left ? memchr(cursor->next, 0, cursor->left) : NULL;
    if (!end) {
        cursor->broken = true;
        cursor->left = 0;
        return "";
    }
    return (const char *)take(cursor, (size_t)(end - cursor->next) + 1);
}

/* Sets "provenance" where the bytes are the JSON of one; anything else is not ours. */
static int put_provenance(json_t *facts, const void *text, size_t size)
{
    MesoInput input;
    json_t *root;
    meso_input_wrap(&input, "provenance", text, size);
    MesoStatus status = meso_json_parse(&root, &input, NULL);
    if (status)
        return status == MESO_ERR_MEMORY;
    if (json_is_string(json_object_get(root, "tool")))
        return json_object_set_new(facts, "provenance", root);
    json_decref(root);
    return 0;
}

static int put_count(json_t *facts, const char *key, uint64_t count)
{
    return json_object_set_new(facts, key, json_integer((json_int_t)count));
}

/* Attributes of the first part: name, type, size, value; an empty name ends them. */
static int describe_exr(json_t *facts, Cursor *cursor)
{
    json_t *channels = json_array();
    int failed = 0;
    take(cursor, 8);
    for (const char *name = take_text(cursor); *name && !failed; name = take_text(cursor)) {
        take_text(cursor);
        size_t size = take_little(cursor);
        Cursor value = {take(cursor, size), size, cursor->broken};
        if (cursor->broken)
            break;
        if (strcmp(name, "dataWindow") == 0) {
            uint32_t box[4];
            for (int i = 0; i < 4; i++)
                box[i] = take_little(&value);
            failed |= put_count(facts, "width", box[2] - box[0] + 1);
            failed |= put_count(facts, "height", box[3] - box[1] + 1);
        } else if (strcmp(name, "channels") == 0) {
            for (const char *c = take_text(&value); *c && !value.broken; c = take_text(&value)) {
                failed |= json_array_append_new(channels, meso_json_string(c));
                take(&value, 16);
            }
        } else if (strcmp(name, "meso:provenance") == 0)
            failed |= put_provenance(facts, value.next, size);
        cursor->broken |= value.broken;
    }
    return failed | json_object_set_new(facts, "channels", channels);
}

/* iTXt: keyword, two flags (0: not compressed), language, translated keyword, text. */
static int describe_png_text(json_t *facts, Cursor text)
{
    if (strcmp(take_text(&text), "meso:provenance") != 0 || take(&text, 2)[0] != 0)
        return 0;
    take_text(&text);
    take_text(&text);
    return text.broken ? 0 : put_provenance(facts, text.next, text.left);
}

static int describe_png(json_t *facts, Cursor *cursor)
{
    int failed = 0;
    take(cursor, 8);
    for (bool end = false; !end && !cursor->broken && !failed;) {
        size_t size = take_big(cursor);
        const uint8_t *type = take(cursor, 4);
        Cursor data = {take(cursor, size), size, cursor->broken};
        take(cursor, 4);
        if (cursor->broken)
            break;
        if (memcmp(type, "IHDR", 4) == 0) {
            failed |= put_count(facts, "width", take_big(&data));
            failed |= put_count(facts, "height", take_big(&data));
            cursor->broken |= data.broken;
        } else if (memcmp(type, "iTXt", 4) == 0)
            failed |= describe_png_text(facts, data);
        end = memcmp(type, "IEND", 4) == 0;
    }
    return failed;
}

static int describe_gltf(json_t *facts, const json_t *root)
{
    uint64_t triangles = 0, primitives = 0;
    const json_t *asset = json_object_get(root, "asset");
    const json_t *accessors = json_object_get(root, "accessors");
    const char *generator = json_string_value(json_object_get(asset, "generator"));
    const char *provenance = json_string_value(json_object_get(json_object_get(asset, "extras"), "provenance"));
    size_t m, p;
    json_t *mesh, *primitive;
    json_array_foreach(json_object_get(root, "meshes"), m, mesh)
        json_array_foreach(json_object_get(mesh, "primitives"), p, primitive) {
            const json_t *indices = json_object_get(primitive, "indices");
            json_int_t i = json_is_integer(indices) ? json_integer_value(indices) : -1;
            const json_t *accessor = i < 0 ? NULL : json_array_get(accessors, (size_t)i);
            json_int_t count = json_integer_value(json_object_get(accessor, "count"));
            triangles += count > 0 ? (uint64_t)count / 3 : 0;
            primitives++;
        }
    int failed = generator ? json_object_set_new(facts, "generator", json_string(generator)) : 0;
    failed |= put_count(facts, "primitives", primitives);
    failed |= put_count(facts, "materials", json_array_size(json_object_get(root, "materials")));
    failed |= put_count(facts, "triangles", triangles);
    return provenance ? failed | put_provenance(facts, provenance, strlen(provenance)) : failed;
}

/* The JSON chunk follows the header of 12 bytes. */
static MesoStatus describe_glb(json_t *facts, Cursor *cursor, const char *path, int *failed,
                               MesoError *error)
{
    take(cursor, 12);
    size_t size = take_little(cursor);
    uint32_t type = take_little(cursor);
    const uint8_t *text = take(cursor, size);
    if (cursor->broken || type != 0x4e4f534a)
        return meso_fail(error, MESO_ERR_INPUT, "%s: truncated or broken: has no JSON chunk", path);
    MesoInput input;
    json_t *root;
    meso_input_wrap(&input, path, text, size);
    MesoStatus status = meso_json_parse(&root, &input, error);
    if (!status)
        *failed |= describe_gltf(facts, root);
    json_decref(root);
    return status;
}

/* Sizes in Draco's metadata: seven bits a byte, lowest first. */
static size_t take_varint(Cursor *cursor)
{
    size_t value = 0;
    for (unsigned shift = 0; shift < 35 && !cursor->broken; shift += 7) {
        uint8_t byte = *take(cursor, 1);
        value |= (size_t)(byte & 0x7f) << shift;
        if (byte < 0x80)
            break;
    }
    return value;
}

/* Metadata lie before the geometry: length and name of an entry, length and text of its value. */
static int describe_drc(json_t *facts, Cursor *cursor)
{
    static const char key[] = "\012provenance";
    const size_t length = sizeof key - 1, far = 1 << 20;
    const uint8_t *header = take(cursor, 11);
    bool metadata = header[10] & 0x80;
    int failed = json_object_set_new(facts, "encoding", json_string(header[8] == 1 ? "edgebreaker" : "sequential"));
    if (header[7] != 1)
        cursor->broken = true;
    for (size_t i = 0; metadata && i < far && i + length < cursor->left; i++)
        if (memcmp(cursor->next + i, key, length) == 0) {
            take(cursor, i + length);
            size_t size = take_varint(cursor);
            const uint8_t *text = take(cursor, size);
            return cursor->broken ? failed : failed | put_provenance(facts, text, size);
        }
    return failed;
}

static bool line_begins(const char *line, size_t length, const char *text)
{
    return length >= strlen(text) && memcmp(line, text, strlen(text)) == 0;
}

/* The next line without its end. */
static const char *take_line(Cursor *cursor, size_t *length)
{
    const char *line = (const char *)cursor->next;
    const uint8_t *end = cursor->left ? memchr(cursor->next, '\n', cursor->left) : NULL;
    *length = end ? (size_t)(end - cursor->next) : cursor->left;
    take(cursor, end ? *length + 1 : *length);
    if (*length > 0 && line[*length - 1] == '\r')
        --*length;
    return line;
}

/* Bytes of the pieces on the lines that follow, each with `mark` before it; copied to `out` unless NULL. */
static size_t join_pieces(Cursor *cursor, const char *mark, char *out)
{
    size_t total = 0, length;
    for (Cursor next = *cursor;; *cursor = next) {
        const char *line = next.left ? take_line(&next, &length) : NULL;
        if (!line || !line_begins(line, length, mark))
            return total;
        length -= strlen(mark);
        if (out)
            memcpy(out + total, line + strlen(mark), length);
        total += length;
    }
}

/* A provenance that begins on `line`, after its own mark, and may go on in lines with `mark`. */
static int put_lines(json_t *facts, Cursor *cursor, const char *line, size_t length, const char *mark)
{
    Cursor ahead = *cursor;
    size_t more = join_pieces(&ahead, mark, NULL);
    if (more == 0)
        return put_provenance(facts, line, length);
    char *text = malloc(length + more);
    if (!text)
        return 1;
    memcpy(text, line, length);
    join_pieces(cursor, mark, text + length);
    int failed = put_provenance(facts, text, length + more);
    free(text);
    return failed;
}

/* "element vertex 12" gives "vertex": 12, and so on for every element. */
static int describe_ply(json_t *facts, Cursor *cursor)
{
    json_t *elements = json_object();
    int failed = 0;
    bool end = false;
    while (!end && cursor->left > 0 && !failed) {
        size_t length;
        const char *line = take_line(cursor, &length);
        end = length == 10 && memcmp(line, "end_header", 10) == 0;
        char name[64], text[128] = "";
        unsigned long long count;
        if (line_begins(line, length, ply_mark))
            failed |= put_lines(facts, cursor, line + strlen(ply_mark), length - strlen(ply_mark), ply_more);
        else if (line_begins(line, length, "element ") && length < sizeof text) {
            memcpy(text, line, length);
            for (char *c = text; *c; c++)
                *c = (unsigned char)*c < 0x80 ? *c : '?';
            if (sscanf(text, "element %63s %llu", name, &count) == 2 && count <= INT64_MAX)
                failed |= json_object_set_new(elements, name, json_integer((json_int_t)count));
        }
    }
    cursor->broken = !end;
    return failed | json_object_set_new(facts, "elements", elements);
}

static int describe_obj_head(json_t *facts, Cursor *cursor)
{
    size_t length;
    const char *line = take_line(cursor, &length);
    return put_lines(facts, cursor, line + strlen(obj_mark), length - strlen(obj_mark), obj_more);
}

static int describe_obj(json_t *facts, Cursor *cursor)
{
    uint64_t vertices = 0, faces = 0;
    size_t length;
    const char *line;
    int failed = describe_obj_head(facts, cursor);
    while (cursor->left > 0) {
        line = take_line(cursor, &length);
        vertices += line_begins(line, length, "v ");
        faces += line_begins(line, length, "f ");
    }
    failed |= put_count(facts, "vertices", vertices);
    return failed | put_count(facts, "faces", faces);
}

MesoStatus meso_product_provenance(json_t **found, MesoProductKind kind, const MesoInput *input)
{
    Cursor cursor = {input->data, input->size, false};
    MesoError error = {0};
    json_t *facts = json_object();
    MesoStatus status = MESO_OK;
    if (!facts)
        status = MESO_ERR_MEMORY;
    else if (kind == MESO_PRODUCT_OBJ)      /* the rest need not be counted */
        status = describe_obj_head(facts, &cursor) ? MESO_ERR_MEMORY : MESO_OK;
    else
        status = meso_product_describe(facts, kind, input, &error);
    *found = json_incref(json_object_get(facts, "provenance"));
    json_decref(facts);
    return status == MESO_ERR_MEMORY ? status : MESO_OK;
}

MesoStatus meso_product_describe(json_t *facts, MesoProductKind kind, const MesoInput *input,
                                 MesoError *error)
{
    Cursor cursor = {input->data, input->size, false};
    MesoStatus status = MESO_OK;
    int failed = 0;
    switch (kind) {
    case MESO_PRODUCT_EXR: failed = describe_exr(facts, &cursor); break;
    case MESO_PRODUCT_PNG: failed = describe_png(facts, &cursor); break;
    case MESO_PRODUCT_GLB: status = describe_glb(facts, &cursor, input->path, &failed, error); break;
    case MESO_PRODUCT_DRC: failed = describe_drc(facts, &cursor); break;
    case MESO_PRODUCT_PLY: failed = describe_ply(facts, &cursor); break;
    case MESO_PRODUCT_OBJ: failed = describe_obj(facts, &cursor); break;
    case MESO_PRODUCT_NONE: break;
    }
    if (status)
        return status;
    if (cursor.broken)
        return meso_fail(error, MESO_ERR_INPUT, "%s: truncated or broken: its header does not end",
                         input->path);
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory") : MESO_OK;
}
