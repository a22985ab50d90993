/*
 * Wavefront OBJ: part by part, its vertices and then its faces. Comment lines
 * give the slots; `o` the tiles and `usemtl` the materials, where they change.
 */
#include <string.h>

#include "formats/float_text.h"
#include "formats/mesh_file.h"
#include "formats/mesh_window.h"

enum {
    NUMBER_TEXT = 10,                       /* digits of a 32-bit number */
    VECTOR_TEXT = 3 + 3 * (MESO_FLOAT_TEXT + 1),
    VERTEX_TEXT = 3 * VECTOR_TEXT,
    FACE_TEXT = 2 + 4 * (3 * NUMBER_TEXT + 3),
    PART_TEXT = 64 + 2 * (MESO_MESH_NAME + 16)
};

static char *put_text(char *out, const char *text)
{
    size_t size = strlen(text);
    memcpy(out, text, size);
    return out + size;
}

static char *put_number(char *out, uint32_t value)
{
    char digits[NUMBER_TEXT];
    int count = 0;
    do
        digits[count++] = (char)('0' + value % 10);
    while ((value /= 10) > 0);
    while (count > 0)
        *out++ = digits[--count];
    return out;
}

/* Readers end a name at white space; at most `limit` bytes of it. */
static char *put_name(char *out, const char *name, size_t limit)
{
    for (size_t i = 0; name[i] && i < limit; i++)
        *out++ = (unsigned char)name[i] <= 0x20 || name[i] == 0x7f ? '_' : name[i];
    return out;
}

static char *put_vector(char *out, const char *key, const float *v, int count)
{
    out = put_text(out, key);
    for (int i = 0; i < count; i++) {
        *out++ = ' ';
        out = meso_float_text(v[i], out);
    }
    *out++ = '\n';
    return out;
}

static char *put_vertices(char *out, const MesoMeshVertex *vertices, uint64_t count)
{
    for (uint64_t i = 0; i < count; i++) {
        const MesoMeshVertex *v = &vertices[i];
        out = put_vector(out, "v", (const float[]){v->position.x, v->position.y, v->position.z}, 3);
        out = put_vector(out, "vt", (const float[]){v->uv.x, v->uv.y}, 2);
        out = put_vector(out, "vn", (const float[]){v->normal.x, v->normal.y, v->normal.z}, 3);
    }
    return out;
}

/* Each corner's three numbers are the same: position, uv and normal go together. */
static char *put_faces(char *out, const MesoMeshFace *faces, uint64_t count)
{
    for (uint64_t i = 0; i < count; i++) {
        *out++ = 'f';
        for (int k = 0; k < 4 && faces[i].v[k] != MESO_NO_INDEX; k++) {
            *out++ = ' ';
            char *number = out;
            out = put_number(out, faces[i].v[k]);
            size_t size = (size_t)(out - number);
            for (int again = 0; again < 2; again++) {
                *out++ = '/';
                memcpy(out, number, size);
                out += size;
            }
        }
        *out++ = '\n';
    }
    return out;
}

/* What changes against the part before, whichever range that one was in. */
static char *put_part(char *out, const MesoTessellation *t, uint32_t part)
{
    const MesoTileSet *set = &t->structure->model->tile_set;
    MesoMeshPart of = meso_tessellation_part(t, part);
    MesoMeshPart before = part > 0 ? meso_tessellation_part(t, part - 1)
                                   : (MesoMeshPart){MESO_NO_INDEX, MESO_NO_INDEX, MESO_NO_INDEX};
    if (of.tile != before.tile) {
        out = put_text(out, "o ");
        out = put_name(out, set->tiles[of.tile].name, MESO_MESH_NAME);
        *out++ = '\n';
    }
    if (of.material != before.material) {
        char name[MESO_MESH_NAME];
        meso_mesh_material_name(t, of.material, name);
        out = put_text(out, "usemtl ");
        out = put_name(out, name, MESO_MESH_NAME);
        *out++ = '\n';
    }
    out = put_text(out, "# slot ");
    out = put_number(out, of.slot);
    *out++ = '\n';
    return out;
}

static size_t format_parts(const void *context, const MesoTessellation *t, uint32_t begin,
                           uint32_t end, uint8_t *out, uint8_t *scratch)
{
    (void)context;
    uint64_t vertex_count = t->vertex_begin[end] - t->vertex_begin[begin];
    MesoMeshVertex *vertices = (MesoMeshVertex *)(void *)scratch;
    MesoMeshFace *faces = (MesoMeshFace *)(void *)(vertices + vertex_count);
    meso_tessellation_vertices(t, begin, end, vertices);
    meso_tessellation_faces(t, begin, end, (uint32_t)t->vertex_begin[begin] + 1, faces);

    char *next = (char *)out;
    for (uint32_t part = begin; part < end; part++) {
        next = put_part(next, t, part);
        next = put_vertices(next, vertices + (t->vertex_begin[part] - t->vertex_begin[begin]),
                            t->vertex_begin[part + 1] - t->vertex_begin[part]);
        next = put_faces(next, faces + (t->face_begin[part] - t->face_begin[begin]),
                         t->face_begin[part + 1] - t->face_begin[part]);
    }
    return (size_t)(next - (char *)out);
}

static MesoStatus put_header(MesoMeshStream *stream, MesoArena *arena, MesoError *error)
{
    const char *text = meso_mesh_provenance_lines(stream->options, "# ", arena, error);
    if (!text)
        return MESO_ERR_MEMORY;
    stream->offset = strlen(text);
    return meso_output_write(stream->output, text, strlen(text), error);
}

MesoStatus meso_obj_write(const MesoTessellation *tessellation, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error)
{
    static const MesoMeshPass pass = {
        .format = format_parts,
        .part_bytes = PART_TEXT,
        .vertex_bytes = VERTEX_TEXT,
        .face_bytes = FACE_TEXT,
        .vertex_scratch = sizeof(MesoMeshVertex),
        .face_scratch = sizeof(MesoMeshFace),
    };
    uint64_t vertex_count = tessellation->vertex_begin[tessellation->part_count];
    MesoMeshStream stream = {tessellation, options, output, 0, 0, vertex_count};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = meso_mesh_check_counts(tessellation, "an OBJ file", error);
    if (status == MESO_OK)
        status = put_header(&stream, &arena, error);
    if (status == MESO_OK)
        status = meso_mesh_stream_run(&stream, &pass, vertex_count, error);
    meso_arena_release(&arena);
    return status;
}
