/*
 * Wavefront OBJ: part by part, its vertices and then its faces. The first
 * channel with names is `o` and the materials are `usemtl`, where they change;
 * comment lines give the other ids of each part.
 */
#include <string.h>

#include "formats/file/float_text.h"
#include "formats/scene/mesh_file.h"
#include "formats/scene/mesh_window.h"

enum {
    NUMBER_TEXT = 10,                       /* digits of a 32-bit number */
    VECTOR_TEXT = 3 + 3 * (MESO_FLOAT_TEXT + 1),
    VERTEX_TEXT = 3 * VECTOR_TEXT,
    COLOR_TEXT = 3 * (MESO_FLOAT_TEXT + 1),
    FACE_TEXT = 2 + 4 * (3 * NUMBER_TEXT + 3),
    LINE_TEXT = MESO_MESH_NAME + 16,            /* `o` or `usemtl` */
    ID_TEXT = MESO_CHANNEL_NAME + NUMBER_TEXT + 8
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

static char *put_floats(char *out, const float *v, int count)
{
    for (int i = 0; i < count; i++) {
        *out++ = ' ';
        out = meso_float_text(v[i], out);
    }
    return out;
}

static char *put_vector(char *out, const char *key, const float *v, int count)
{
    out = put_floats(put_text(out, key), v, count);
    *out++ = '\n';
    return out;
}

/* `v x y z r g b` is not of the format's first days, but what many programs read. */
static char *put_position(char *out, MesoVec3 p, const MesoMeshColor *color)
{
    out = put_floats(put_text(out, "v"), (const float[]){p.x, p.y, p.z}, 3);
    if (color)
        out = put_floats(out, (const float[]){(float)color->r / 255, (float)color->g / 255, (float)color->b / 255}, 3);
    *out++ = '\n';
    return out;
}

/* `colors` may be NULL. */
static char *put_vertices(char *out, const MesoMeshVertex *vertices, const MesoMeshColor *colors, uint64_t count)
{
    for (uint64_t i = 0; i < count; i++) {
        const MesoMeshVertex *v = &vertices[i];
        out = put_position(out, v->position, colors ? &colors[i] : NULL);
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

/* What the passes share. */
typedef struct Objects {
    bool colored;
    uint32_t channel;   /* the one whose names are `o`, or MESO_NO_INDEX */
} Objects;

static char *put_line(char *out, const char *key, const char *name)
{
    out = put_name(put_text(out, key), name, MESO_MESH_NAME);
    *out++ = '\n';
    return out;
}

static char *put_ids(char *out, const MesoScene *scene, uint32_t row, uint32_t object_channel)
{
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        const MesoIdChannel *channel = &scene->channels[c];
        uint32_t id = meso_scene_id(scene, row, c);
        if (c == object_channel)
            continue;
        out = put_text(out, "# ");
        out = put_name(out, channel->name, MESO_CHANNEL_NAME);
        *out++ = ' ';
        out = put_number(out, id);
        if (channel->names) {
            *out++ = ' ';
            out = put_name(out, channel->names[id], MESO_MESH_NAME);
        }
        *out++ = '\n';
    }
    return out;
}

/* What changes against the part before, whichever range that one was in. */
static char *put_part(char *out, const Objects *objects, const MesoSceneParts *parts, uint32_t part)
{
    const MesoScene *scene = parts->scene;
    MesoPart of = meso_scene_part(parts, part);
    MesoPart before = part > 0 ? meso_scene_part(parts, part - 1) : of;
    if (objects->channel != MESO_NO_INDEX) {
        uint32_t id = meso_scene_id(scene, of.ids, objects->channel);
        if (part == 0 || id != meso_scene_id(scene, before.ids, objects->channel))
            out = put_line(out, "o ", scene->channels[objects->channel].names[id]);
    }
    if (part == 0 || of.material != before.material) {
        char name[MESO_MESH_NAME];
        meso_mesh_material_name(scene, of.material, name);
        out = put_line(out, "usemtl ", name);
    }
    return put_ids(out, scene, of.ids, objects->channel);
}

static size_t format_parts(const void *context, const MesoSceneParts *parts, uint32_t begin,
                           uint32_t end, uint8_t *out, uint8_t *scratch)
{
    const Objects *objects = context;
    uint64_t vertex_count = parts->vertex_begin[end] - parts->vertex_begin[begin];
    uint64_t face_count = parts->face_begin[end] - parts->face_begin[begin];
    MesoMeshVertex *vertices = (MesoMeshVertex *)(void *)scratch;
    MesoMeshFace *faces = (MesoMeshFace *)(void *)(vertices + vertex_count);
    MesoMeshColor *colors = objects->colored ? (MesoMeshColor *)(void *)(faces + face_count) : NULL;
    meso_scene_vertices(parts, begin, end, vertices);
    meso_scene_faces(parts, begin, end, (uint32_t)parts->vertex_begin[begin] + 1, faces);
    if (colors)
        meso_scene_colors(parts, begin, end, colors);

    char *next = (char *)out;
    for (uint32_t part = begin; part < end; part++) {
        uint64_t first = parts->vertex_begin[part] - parts->vertex_begin[begin];
        next = put_part(next, objects, parts, part);
        next = put_vertices(next, vertices + first, colors ? colors + first : NULL,
                            parts->vertex_begin[part + 1] - parts->vertex_begin[part]);
        next = put_faces(next, faces + (parts->face_begin[part] - parts->face_begin[begin]),
                         parts->face_begin[part + 1] - parts->face_begin[part]);
    }
    return (size_t)(next - (char *)out);
}

static MesoStatus put_header(MesoMeshStream *stream, MesoArena *arena, MesoError *error)
{
    const char *text = meso_provenance_lines(stream->options->provenance, "# ", arena, error);
    const char *lengths = text ? meso_mesh_strand_lines(stream->options, "# ", arena, error) : NULL;
    if (lengths)
        text = meso_arena_print(arena, error, "%s%s", text, lengths);
    if (!text || !lengths)
        return MESO_ERR_MEMORY;
    const char *file = stream->options->materials;
    if (file)
        text = meso_arena_print(arena, error, "%smtllib %s\n", text, file);
    if (!text)
        return MESO_ERR_MEMORY;
    stream->offset = strlen(text);
    return meso_output_write(stream->output, text, strlen(text), error);
}

MesoStatus meso_mtl_write(const MesoScene *scene, const MesoProvenance *provenance, MesoOutput *output,
                          MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    const char *head = meso_provenance_lines(provenance, "# ", &arena, error);
    MesoStatus status = head ? meso_output_write(output, head, strlen(head), error) : MESO_ERR_MEMORY;
    for (uint32_t m = 0; m < scene->material_count && !status; m++) {
        const MesoMaterial *look = &scene->materials[m];
        char name[MESO_MESH_NAME], text[LINE_TEXT + 8 * (MESO_FLOAT_TEXT + 8)], *end = text;
        meso_mesh_material_name(scene, m, name);
        end = put_line(end, "newmtl ", name);
        end = put_vector(end, "Kd", look->albedo, 3);
        end = put_vector(end, "Pr", &look->roughness, 1);
        end = put_vector(end, "Pm", &look->metallic, 1);
        status = meso_output_write(output, text, (size_t)(end - text), error);
    }
    meso_arena_release(&arena);
    return status;
}

static Objects find_objects(const MesoScene *scene)
{
    Objects objects = {meso_scene_is_colored(scene), MESO_NO_INDEX};
    for (uint32_t c = scene->channel_count; c-- > 0;)
        if (scene->channels[c].names)
            objects.channel = c;
    return objects;
}

static uint32_t part_text_bound(const MesoScene *scene, const Objects *objects)
{
    uint32_t bound = 2 * LINE_TEXT;
    for (uint32_t c = 0; c < scene->channel_count; c++)
        if (c != objects->channel)
            bound += scene->channels[c].names ? ID_TEXT + MESO_MESH_NAME : ID_TEXT;
    return bound;
}

MesoStatus meso_obj_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error)
{
    const Objects objects = find_objects(parts->scene);
    const MesoMeshPass pass = {
        .format = format_parts,
        .context = &objects,
        .part_bytes = part_text_bound(parts->scene, &objects),
        .vertex_bytes = VERTEX_TEXT + (objects.colored ? COLOR_TEXT : 0),
        .face_bytes = FACE_TEXT,
        .vertex_scratch = sizeof(MesoMeshVertex) + (objects.colored ? sizeof(MesoMeshColor) : 0),
        .face_scratch = sizeof(MesoMeshFace),
    };
    uint64_t vertex_count = parts->vertex_begin[parts->part_count];
    MesoMeshStream stream = {.parts = parts, .options = options, .output = output, .total = vertex_count};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = meso_mesh_check_counts(parts, options, "an OBJ file", error);
    if (!status)
        status = put_header(&stream, &arena, error);
    if (!status)
        status = meso_mesh_stream_run(&stream, &pass, vertex_count, error);
    meso_arena_release(&arena);
    return status;
}
