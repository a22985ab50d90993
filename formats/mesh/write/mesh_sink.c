#include "formats/mesh/write/mesh_sink.h"

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
    const char *lines = meso_provenance_lines(provenance, mark, sink->scratch, sink->error);
    if (lines)
        meso_mesh_sink_text(sink, lines);
    else
        sink->status = MESO_ERR_MEMORY;
}
