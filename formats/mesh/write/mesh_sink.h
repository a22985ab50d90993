/* What writers of meshes write to: bytes gathered up before they go out. */
#ifndef MESO_MESH_SINK_H
#define MESO_MESH_SINK_H

#include <string.h>

#include "formats/file/float_text.h"
#include "formats/file/output.h"
#include "formats/product/provenance.h"

enum { MESO_SINK_BYTES = 1 << 18, MESO_SINK_WORD = 64 };

typedef struct MesoMeshSink {
    MesoOutput *output;
    MesoError *error;
    MesoStatus status;          /* of the first failure; nothing is written after it */
    size_t used;
    MesoArena *scratch;
    char bytes[MESO_SINK_BYTES + MESO_SINK_WORD];
} MesoMeshSink;

void meso_mesh_sink_flush(MesoMeshSink *sink);
void meso_mesh_sink_put(MesoMeshSink *sink, const void *data, size_t size);

/* Room for MESO_SINK_WORD bytes more. */
static inline char *meso_mesh_sink_room(MesoMeshSink *sink)
{
    if (sink->used >= MESO_SINK_BYTES)
        meso_mesh_sink_flush(sink);
    return sink->bytes + sink->used;
}

static inline void meso_mesh_sink_character(MesoMeshSink *sink, char c)
{
    *meso_mesh_sink_room(sink) = c;
    sink->used++;
}

static inline void meso_mesh_sink_text(MesoMeshSink *sink, const char *text)
{
    meso_mesh_sink_put(sink, text, strlen(text));
}

static inline void meso_mesh_sink_float(MesoMeshSink *sink, float value)
{
    char *at = meso_mesh_sink_room(sink);
    sink->used += (size_t)(meso_float_text(value, at) - at);
}

void meso_mesh_sink_number(MesoMeshSink *sink, uint64_t number);

/* Text within a line: what would end it, or cannot be seen, becomes '?', and blanks `blank`. */
void meso_mesh_sink_name(MesoMeshSink *sink, const char *name, char blank);

/* The provenance in comments, each line beginning with `mark`. */
void meso_mesh_sink_provenance(MesoMeshSink *sink, const MesoProvenance *provenance, const char *mark);

#endif
