/* What writers of meshes write to: bytes gathered up before they go out. For the writers alone. */
#ifndef MESO_MESH_SINK_H
#define MESO_MESH_SINK_H

#include <string.h>

#include "formats/float_text.h"
#include "formats/mesh/mesh_write.h"

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

/* The writers. */
void meso_mesh_write_ply(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance);
void meso_mesh_write_obj(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance);
void meso_mesh_write_off(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance);
bool meso_mesh_ply_holds(const MesoPolygonMesh *mesh, const MesoAttribute *attribute);
bool meso_mesh_obj_holds(const MesoPolygonMesh *mesh, const MesoAttribute *attribute);

#endif
