/*
 * Binary PLY, little-endian: vertices as they lie in memory, with colours, then faces with
 * the ids and the material of the part that they belong to.
 */
#include <string.h>

#include "formats/scene/mesh_file.h"
#include "formats/scene/mesh_window.h"

_Static_assert(sizeof(MesoMeshVertex) == 32 && sizeof(MesoMeshFace) == 16, "layout of the rows");
_Static_assert(sizeof(MesoMeshColor) == 3, "layout of the rows");
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "rows are written as they lie in memory");

/* Count and corners of a quad; ids and material. */
enum { VERTEX_BYTES = sizeof(MesoMeshVertex) + sizeof(MesoMeshColor) };
enum { CORNERS_BYTES = 1 + 16, MAX_TAIL = 4 * MESO_ID_CHANNELS + 2 };

static uint8_t byte_of(float value)
{
    return (uint8_t)(value <= 0 ? 0 : value >= 1 ? 255 : value * 255 + 0.5f);
}

/* Colours of 255 are white. */
static MesoMeshColor tinted(const MesoMaterial *material, MesoMeshColor color)
{
    return (MesoMeshColor){byte_of(material->albedo[0] * (float)color.r / 255),
                           byte_of(material->albedo[1] * (float)color.g / 255),
                           byte_of(material->albedo[2] * (float)color.b / 255)};
}

/* Rows of one part: its vertices with one colour, or with their own. */
static uint8_t *put_rows(uint8_t *out, const MesoMeshVertex *vertices, const MesoMeshColor *colors, uint64_t count,
                         const MesoMaterial *material)
{
    MesoMeshColor color = tinted(material, (MesoMeshColor){255, 255, 255});
    for (uint64_t i = 0; i < count; i++, out += VERTEX_BYTES) {
        if (colors)
            color = tinted(material, colors[i]);
        memcpy(out, &vertices[i], sizeof *vertices);
        memcpy(out + sizeof *vertices, &color, sizeof color);
    }
    return out;
}

static size_t format_vertices(const void *context, const MesoSceneParts *parts, uint32_t begin,
                              uint32_t end, uint8_t *out, uint8_t *scratch)
{
    const bool *colored = context;
    uint64_t first = parts->vertex_begin[begin], count = parts->vertex_begin[end] - first;
    MesoMeshVertex *vertices = (MesoMeshVertex *)(void *)scratch;
    MesoMeshColor *colors = (MesoMeshColor *)(void *)(vertices + count);
    uint8_t *next = out;
    meso_scene_vertices(parts, begin, end, vertices);
    if (*colored)
        meso_scene_colors(parts, begin, end, colors);
    for (uint32_t part = begin; part < end; part++) {
        uint64_t at = parts->vertex_begin[part] - first;
        const MesoMaterial *material = &parts->scene->materials[meso_scene_part(parts, part).material];
        next = put_rows(next, vertices + at, *colored ? colors + at : NULL,
                        parts->vertex_begin[part + 1] - parts->vertex_begin[part], material);
    }
    return (size_t)(next - out);
}

/* What follows the corners in each row of a part; returns its size. */
static size_t format_tail(const MesoScene *scene, MesoPart part, uint8_t tail[MAX_TAIL])
{
    size_t size = 0;
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        uint32_t id = meso_scene_id(scene, part.ids, c);
        size_t bytes = scene->channels[c].names ? 2 : 4;
        memcpy(tail + size, &id, bytes);
        size += bytes;
    }
    memcpy(tail + size, &part.material, 2);
    return size + 2;
}

static uint8_t *format_part(const MesoMeshFace *faces, uint64_t count, const uint8_t *tail, size_t tail_size,
                            uint8_t *out)
{
    for (uint64_t i = 0; i < count; i++) {
        bool quad = faces[i].v[3] != MESO_NO_INDEX;
        size_t corners = quad ? 16 : 12;
        *out = quad ? 4 : 3;
        memcpy(out + 1, faces[i].v, 16);
        memcpy(out + 1 + corners, tail, tail_size);
        out += 1 + corners + tail_size;
    }
    return out;
}

static size_t format_faces(const void *context, const MesoSceneParts *parts, uint32_t begin,
                           uint32_t end, uint8_t *out, uint8_t *scratch)
{
    (void)context;
    MesoMeshFace *faces = (MesoMeshFace *)(void *)scratch;
    uint8_t *next = out;
    meso_scene_faces(parts, begin, end, (uint32_t)parts->vertex_begin[begin], faces);
    for (uint32_t part = begin; part < end; part++) {
        uint8_t tail[MAX_TAIL];
        size_t tail_size = format_tail(parts->scene, meso_scene_part(parts, part), tail);
        next = format_part(faces + (parts->face_begin[part] - parts->face_begin[begin]),
                           parts->face_begin[part + 1] - parts->face_begin[part], tail, tail_size, next);
    }
    return (size_t)(next - out);
}

/* A name within a comment line. */
static const char *comment(MesoArena *arena, const char *what, uint32_t number, const char *name,
                           MesoError *error)
{
    char *line = meso_arena_print(arena, error, "comment %s %u %s\n", what, number, name);
    for (char *c = line; c && c[0] && c[1]; c++)    /* the last byte is the line's own end */
        if ((unsigned char)*c < 0x20)
            *c = ' ';
    return line;
}

static MesoStatus put(MesoMeshStream *stream, const char *text, MesoError *error)
{
    if (!text)
        return MESO_ERR_MEMORY;
    size_t size = strlen(text);
    stream->offset += size;
    return meso_output_write(stream->output, text, size, error);
}

static MesoStatus put_names(MesoMeshStream *stream, MesoArena *arena, MesoError *error)
{
    const MesoScene *scene = stream->parts->scene;
    MesoStatus status = MESO_OK;
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        const MesoIdChannel *channel = &scene->channels[c];
        for (uint32_t i = 0; !status && channel->names && i < channel->count; i++)
            status = put(stream, comment(arena, channel->name, i, channel->names[i], error), error);
    }
    for (uint32_t i = 0; !status && i < scene->material_count; i++) {
        char name[MESO_MESH_NAME];
        meso_mesh_material_name(scene, i, name);
        status = put(stream, comment(arena, "material", i, name, error), error);
    }
    return status;
}

static MesoStatus put_face_properties(MesoMeshStream *stream, MesoArena *arena, MesoError *error)
{
    const MesoScene *scene = stream->parts->scene;
    MesoStatus status = MESO_OK;
    for (uint32_t c = 0; !status && c < scene->channel_count; c++)
        status = put(stream, meso_arena_print(arena, error, "property %s %s\n",
                                              scene->channels[c].names ? "ushort" : "uint",
                                              scene->channels[c].name), error);
    return status ? status : put(stream, "property ushort material\n", error);
}

static MesoStatus put_elements(MesoMeshStream *stream, MesoArena *arena, MesoError *error)
{
    const MesoSceneParts *parts = stream->parts;
    const char *text = meso_arena_print(arena, error,
                                        "element vertex %llu\n"
                                        "property float x\nproperty float y\nproperty float z\n"
                                        "property float nx\nproperty float ny\nproperty float nz\n"
                                        "property float s\nproperty float t\n"
                                        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                        "element face %llu\n"
                                        "property list uchar uint vertex_indices\n",
                                        (unsigned long long)parts->vertex_begin[parts->part_count],
                                        (unsigned long long)parts->face_begin[parts->part_count]);
    MesoStatus status = put(stream, text, error);
    if (!status)
        status = put_face_properties(stream, arena, error);
    return status ? status : put(stream, "end_header\n", error);
}

/* Where the rows lie in the whole, for what joins them. */
static MesoStatus put_selection(MesoMeshStream *stream, MesoArena *arena, MesoError *error)
{
    const MesoSelection *s = stream->options->selection;
    MesoStatus status = MESO_OK;
    if (s)
        status = put(stream, meso_arena_print(arena, error, "comment whole %u %llu %llu\n", s->part_count,
                                              (unsigned long long)s->vertex_count,
                                              (unsigned long long)s->face_count), error);
    for (uint32_t i = 0; s && i < s->run_count && !status; i++) {
        const MesoSelectedRun *run = &s->runs[i];
        status = put(stream, meso_arena_print(arena, error, "comment run %u %u %llu %llu %llu %llu\n", run->part,
                                              run->part_count, (unsigned long long)run->vertex,
                                              (unsigned long long)run->vertex_count, (unsigned long long)run->face,
                                              (unsigned long long)run->face_count), error);
    }
    return status;
}

static MesoStatus put_header(MesoMeshStream *stream, MesoArena *arena, MesoError *error)
{
    const char *provenance = meso_provenance_lines(stream->options->provenance, "comment ", arena, error);
    if (!provenance)
        return MESO_ERR_MEMORY;
    MesoStatus status = put(stream, "ply\nformat binary_little_endian 1.0\n", error);
    if (!status)
        status = put(stream, provenance, error);
    if (!status)
        status = put_names(stream, arena, error);
    if (!status)
        status = put(stream, meso_mesh_strand_lines(stream->options, "comment ", arena, error), error);
    if (!status)
        status = put_selection(stream, arena, error);
    return status ? status : put_elements(stream, arena, error);
}

MesoStatus meso_ply_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error)
{
    /* A row of a triangle is written with one corner too many, over which the tail goes. */
    static const MesoMeshPass faces = {.format = format_faces, .face_bytes = CORNERS_BYTES + MAX_TAIL,
                                       .face_scratch = 16};

    uint64_t vertex_count = parts->vertex_begin[parts->part_count];
    uint64_t face_count = parts->face_begin[parts->part_count];
    MesoMeshStream stream = {.parts = parts, .options = options, .output = output, .total = vertex_count + face_count};
    const bool colored = meso_scene_is_colored(parts->scene);
    const MesoMeshPass vertices = {.format = format_vertices, .context = &colored, .vertex_bytes = VERTEX_BYTES,
                                   .vertex_scratch = VERTEX_BYTES};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = meso_mesh_check_counts(parts, options, "a PLY file", error);
    if (!status)
        status = put_header(&stream, &arena, error);
    if (!status)
        status = meso_mesh_stream_run(&stream, &vertices, vertex_count, error);
    if (!status)
        status = meso_mesh_stream_run(&stream, &faces, face_count, error);
    meso_arena_release(&arena);
    return status;
}
