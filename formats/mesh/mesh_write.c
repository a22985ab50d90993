#include "formats/mesh/mesh_write.h"

#include <stdlib.h>
#include <strings.h>

#include "formats/mesh/mesh_sink.h"
#include "formats/mesh_window.h"

/* ---- sinks ---- */

void meso_mesh_sink_flush(MesoMeshSink *sink)
{
    if (!sink->status && sink->used)
        sink->status = meso_output_write(sink->output, sink->bytes, sink->used, sink->error);
    sink->used = 0;
}

void meso_mesh_sink_put(MesoMeshSink *sink, const void *data, size_t size)
{
    const char *from = data;
    while (size > 0) {
        if (sink->used >= MESO_SINK_BYTES)
            meso_mesh_sink_flush(sink);
        size_t piece = size < MESO_SINK_BYTES - sink->used ? size : MESO_SINK_BYTES - sink->used;
        memcpy(sink->bytes + sink->used, from, piece);
        sink->used += piece;
        from += piece;
        size -= piece;
    }
}

void meso_mesh_sink_number(MesoMeshSink *sink, uint64_t number)
{
    char digits[20], *out = meso_mesh_sink_room(sink);
    size_t count = 0;
    do
        digits[count++] = (char)('0' + number % 10);
    while ((number /= 10) > 0);
    sink->used += count;
    while (count > 0)
        *out++ = digits[--count];
}

void meso_mesh_sink_name(MesoMeshSink *sink, const char *name, char blank)
{
    for (; *name; name++) {
        unsigned char c = (unsigned char)*name;
        meso_mesh_sink_character(sink, c == ' ' ? blank : c < 0x20 || c == 0x7f ? '?' : *name);
    }
}

void meso_mesh_sink_provenance(MesoMeshSink *sink, const MesoProvenance *provenance, const char *mark)
{
    MesoMeshWriteOptions options = {.provenance = provenance};
    const char *lines = meso_mesh_provenance_lines(&options, mark, sink->scratch, sink->error);
    if (lines)
        meso_mesh_sink_text(sink, lines);
    else
        sink->status = MESO_ERR_MEMORY;
}

/* ---- OFF ---- */

void meso_mesh_write_off(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance)
{
    meso_mesh_sink_text(sink, "OFF\n");
    meso_mesh_sink_provenance(sink, provenance, "# ");
    meso_mesh_sink_number(sink, mesh->vertex_count);
    meso_mesh_sink_character(sink, ' ');
    meso_mesh_sink_number(sink, mesh->face_count);
    meso_mesh_sink_text(sink, " 0\n");
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float p[3] = {mesh->positions[v].x, mesh->positions[v].y, mesh->positions[v].z};
        for (int k = 0; k < 3; k++) {
            meso_mesh_sink_float(sink, p[k]);
            meso_mesh_sink_character(sink, k < 2 ? ' ' : '\n');
        }
    }
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), end = begin + meso_polygon_sides(mesh, f);
        meso_mesh_sink_number(sink, end - begin);
        for (uint32_t c = begin; c < end; c++) {
            meso_mesh_sink_character(sink, ' ');
            meso_mesh_sink_number(sink, mesh->corners[c]);
        }
        meso_mesh_sink_character(sink, '\n');
    }
}

static bool off_holds(const MesoPolygonMesh *mesh, const MesoAttribute *attribute)
{
    (void)mesh;
    (void)attribute;
    return false;
}

/* ---- kinds ---- */

static const struct {
    const char *extension;
    void (*write)(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance);
    bool (*holds)(const MesoPolygonMesh *mesh, const MesoAttribute *attribute);
} kinds[MESO_MESH_KINDS] = {
    [MESO_MESH_PLY] = {".ply", meso_mesh_write_ply, meso_mesh_ply_holds},
    [MESO_MESH_OBJ] = {".obj", meso_mesh_write_obj, meso_mesh_obj_holds},
    [MESO_MESH_OFF] = {".off", meso_mesh_write_off, off_holds},
};

const char *meso_mesh_kind_names(void)
{
    return "ply, obj or off";
}

MesoMeshKind meso_mesh_kind_of(const char *path)
{
    size_t length = strlen(path);
    if (strcmp(path, "-") == 0)
        return MESO_MESH_PLY;
    for (int kind = 0; kind < MESO_MESH_KINDS; kind++)
        if (length > 4 && strcasecmp(path + length - 4, kinds[kind].extension) == 0)
            return (MesoMeshKind)kind;
    return MESO_MESH_KINDS;
}

bool meso_mesh_kind_holds(MesoMeshKind kind, const MesoPolygonMesh *mesh, const MesoAttribute *attribute)
{
    return kinds[kind].holds(mesh, attribute);
}

MesoStatus meso_polygon_mesh_write(const MesoPolygonMesh *mesh, MesoMeshKind kind, const MesoProvenance *provenance,
                                   MesoOutput *output, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoMeshSink *sink = MESO_NEW(&scratch, MesoMeshSink, 1, error);
    MesoStatus status = MESO_ERR_MEMORY;
    if (sink) {
        sink->output = output;
        sink->error = error;
        sink->scratch = &scratch;
        kinds[kind].write(sink, mesh, provenance);
        meso_mesh_sink_flush(sink);
        status = sink->status;
    }
    meso_arena_release(&scratch);
    return status;
}
