/* Binary STL: triangles by themselves, which is what printers of solids read. */
#include <stdio.h>
#include <string.h>

#include "formats/scene/mesh_file.h"
#include "formats/scene/mesh_window.h"

enum { HEAD = 80, ROW = 50 };

static uint8_t *put_triangle(uint8_t *out, const MesoMeshVertex *vertices, uint32_t a, uint32_t b, uint32_t c)
{
    MesoVec3 row[4] = {{0, 0, 0}, vertices[a].position, vertices[b].position, vertices[c].position};
    MesoVec3 across = meso_vec3_cross(meso_vec3_sub(row[2], row[1]), meso_vec3_sub(row[3], row[1]));
    row[0] = meso_vec3_unit(across, row[0]);
    memcpy(out, row, sizeof row);
    memset(out + sizeof row, 0, ROW - sizeof row);
    return out + ROW;
}

/* Quads are cut along corners 0 and 2. */
static size_t format_triangles(const void *context, const MesoSceneParts *parts, uint32_t begin, uint32_t end,
                               uint8_t *out, uint8_t *scratch)
{
    uint64_t vertex_count = parts->vertex_begin[end] - parts->vertex_begin[begin];
    uint64_t face_count = parts->face_begin[end] - parts->face_begin[begin];
    MesoMeshVertex *vertices = (MesoMeshVertex *)(void *)scratch;
    MesoMeshFace *faces = (MesoMeshFace *)(void *)(vertices + vertex_count);
    uint8_t *next = out;
    (void)context;
    meso_scene_vertices(parts, begin, end, vertices);
    meso_scene_faces(parts, begin, end, 0, faces);
    for (uint64_t i = 0; i < face_count; i++) {
        const uint32_t *v = faces[i].v;
        next = put_triangle(next, vertices, v[0], v[1], v[2]);
        if (v[3] != MESO_NO_INDEX)
            next = put_triangle(next, vertices, v[0], v[2], v[3]);
    }
    return (size_t)(next - out);
}

/* Text that does not begin as the format's other form does. */
static MesoStatus put_head(MesoMeshStream *stream, MesoError *error)
{
    const MesoProvenance *provenance = stream->options->provenance;
    char head[HEAD + 1] = {0};
    uint32_t count = (uint32_t)stream->parts->triangle_count;
    snprintf(head, sizeof head, "%s %s", provenance ? provenance->tool : "meso", MESO_VERSION);
    MesoStatus status = meso_output_write(stream->output, head, HEAD, error);
    stream->offset = HEAD + sizeof count;
    return status ? status : meso_output_write(stream->output, &count, sizeof count, error);
}

MesoStatus meso_stl_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                          MesoError *error)
{
    static const MesoMeshPass pass = {.format = format_triangles, .face_bytes = 2 * ROW,
                                      .vertex_scratch = sizeof(MesoMeshVertex), .face_scratch = sizeof(MesoMeshFace)};
    MesoMeshStream stream = {.parts = parts, .options = options, .output = output, .total = parts->triangle_count};
    MesoStatus status = meso_mesh_check_counts(parts, options, "an STL file", error);
    if (!status && parts->triangle_count > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "too large for an STL file: %llu triangles, at most %u%s%s",
                         (unsigned long long)parts->triangle_count, UINT32_MAX, MESO_MESH_SMALLER(options));
    if (!status)
        status = put_head(&stream, error);
    return status ? status : meso_mesh_stream_run(&stream, &pass, parts->triangle_count, error);
}
