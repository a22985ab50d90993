#include "formats/mesh/write/mesh_write.h"

#include <strings.h>

#include "formats/mesh/write/mesh_writers.h"

static bool off_holds(const MesoPolygonMesh *mesh, const MesoAttribute *attribute)
{
    (void)mesh;
    (void)attribute;
    return false;
}

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
    return "ply, obj, off";
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
