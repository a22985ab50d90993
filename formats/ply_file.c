/*
 * Binary PLY, little-endian: vertices as they come out of the tessellator,
 * then faces with the slot, the tile and the material that they belong to.
 */
#include <string.h>

#include "formats/mesh_file.h"
#include "formats/mesh_window.h"

_Static_assert(sizeof(MesoMeshVertex) == 32 && sizeof(MesoMeshFace) == 16, "layout of the rows");
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "rows are written as they lie in memory");

/* Count, corners, slot, tile, material. */
enum { QUAD_BYTES = 1 + 16 + 4 + 2 + 2, TRIANGLE_BYTES = QUAD_BYTES - 4 };

static size_t format_vertices(const void *context, const MesoTessellation *t, uint32_t begin,
                              uint32_t end, uint8_t *out, uint8_t *scratch)
{
    (void)context;
    (void)scratch;
    meso_tessellation_vertices(t, begin, end, (MesoMeshVertex *)(void *)out);
    return (size_t)(t->vertex_begin[end] - t->vertex_begin[begin]) * sizeof(MesoMeshVertex);
}

/* `tail` is what follows the corners in each row of a part. */
static uint8_t *format_part(const MesoMeshFace *faces, uint64_t count, const uint8_t tail[8], uint8_t *out)
{
    for (uint64_t i = 0; i < count; i++) {
        bool quad = faces[i].v[3] != MESO_NO_INDEX;
        size_t corners = quad ? 16 : 12;
        *out = quad ? 4 : 3;
        memcpy(out + 1, faces[i].v, 16);
        memcpy(out + 1 + corners, tail, 8);
        out += corners + 9;
    }
    return out;
}

static size_t format_faces(const void *context, const MesoTessellation *t, uint32_t begin,
                           uint32_t end, uint8_t *out, uint8_t *scratch)
{
    (void)context;
    MesoMeshFace *faces = (MesoMeshFace *)(void *)scratch;
    uint8_t *next = out;
    meso_tessellation_faces(t, begin, end, (uint32_t)t->vertex_begin[begin], faces);
    for (uint32_t part = begin; part < end; part++) {
        MesoMeshPart of = meso_tessellation_part(t, part);
        uint16_t tile = (uint16_t)of.tile, material = (uint16_t)of.material;
        uint8_t tail[8];
        memcpy(tail, &of.slot, 4);
        memcpy(tail + 4, &tile, 2);
        memcpy(tail + 6, &material, 2);
        next = format_part(faces + (t->face_begin[part] - t->face_begin[begin]),
                           t->face_begin[part + 1] - t->face_begin[part], tail, next);
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
    const MesoStructure *structure = stream->tessellation->structure;
    const MesoTileSet *set = &structure->model->tile_set;
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; status == MESO_OK && i < set->tile_count; i++)
        status = put(stream, comment(arena, "tile", i, set->tiles[i].name, error), error);
    uint32_t count = meso_structure_material_count(structure);
    for (uint32_t i = 0; status == MESO_OK && i < count; i++) {
        char name[MESO_MESH_NAME];
        meso_mesh_material_name(stream->tessellation, i, name);
        status = put(stream, comment(arena, "material", i, name, error), error);
    }
    return status;
}

static MesoStatus put_header(MesoMeshStream *stream, MesoArena *arena, MesoError *error)
{
    const MesoTessellation *t = stream->tessellation;
    const char *provenance = meso_mesh_provenance_lines(stream->options, "comment ", arena, error);
    if (!provenance)
        return MESO_ERR_MEMORY;
    MesoStatus status = put(stream, "ply\nformat binary_little_endian 1.0\n", error);
    if (status == MESO_OK)
        status = put(stream, provenance, error);
    if (status == MESO_OK)
        status = put_names(stream, arena, error);
    if (status != MESO_OK)
        return status;
    return put(stream,
               meso_arena_print(arena, error,
                                "element vertex %llu\n"
                                "property float x\nproperty float y\nproperty float z\n"
                                "property float nx\nproperty float ny\nproperty float nz\n"
                                "property float s\nproperty float t\n"
                                "element face %llu\n"
                                "property list uchar uint vertex_indices\n"
                                "property uint slot\nproperty ushort tile\nproperty ushort material\n"
                                "end_header\n",
                                (unsigned long long)t->vertex_begin[t->part_count],
                                (unsigned long long)t->face_begin[t->part_count]),
               error);
}

MesoStatus meso_ply_write(const MesoTessellation *tessellation, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error)
{
    static const MesoMeshPass vertices = {.format = format_vertices, .vertex_bytes = 32};
    /* A row of a triangle is written with one corner too many, over which the tail goes. */
    static const MesoMeshPass faces = {.format = format_faces, .face_bytes = QUAD_BYTES, .face_scratch = 16};

    uint64_t vertex_count = tessellation->vertex_begin[tessellation->part_count];
    uint64_t face_count = tessellation->face_begin[tessellation->part_count];
    MesoMeshStream stream = {tessellation, options, output, 0, 0, vertex_count + face_count};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = meso_mesh_check_counts(tessellation, "a PLY file", error);
    if (status == MESO_OK)
        status = put_header(&stream, &arena, error);
    if (status == MESO_OK)
        status = meso_mesh_stream_run(&stream, &vertices, vertex_count, error);
    if (status == MESO_OK)
        status = meso_mesh_stream_run(&stream, &faces, face_count, error);
    meso_arena_release(&arena);
    return status;
}
