#include "cmd/common/scene_input.h"

#include <string.h>
#include <strings.h>

#include "cmd/common/input_kind.h"
#include "formats/mesh/mesh_read.h"
#include "formats/model/scene_of_mesh.h"

/* What begins in no known way is what its name says: a mesh, or a model that is broken. */
static bool is_mesh(const MesoInput *input)
{
    static const char *const extensions[] = {".obj", ".ply", ".off"};
    MesoFileKind kind = meso_file_kind(input);
    const char *dot = strrchr(input->path, '.');
    bool named = false;
    for (size_t i = 0; dot && i < sizeof extensions / sizeof *extensions; i++)
        named = named || strcasecmp(dot, extensions[i]) == 0;
    return kind == MESO_FILE_UNKNOWN ? named : !(kind & (MESO_FILE_MODEL | MESO_FILE_QUILT));
}

static MesoStatus read_mesh(MesoTool *tool, MesoScene *scene, const MesoInput *input, MesoSceneReading *reading)
{
    MesoArena polygons;
    MesoPolygonMesh mesh;
    meso_arena_init(&polygons);
    reading->tiling = NULL;
    reading->quilt = false;
    reading->provenance = NULL;
    MesoStatus status = meso_polygon_mesh_read(&mesh, &polygons, input, reading->thread_count, &tool->error);
    if (!status && meso_scene_of_mesh(scene, &tool->arena, &mesh, &tool->error))
        status = meso_fail_prefix(&tool->error, input->path);
    meso_arena_release(&polygons);
    return status;
}

MesoStatus meso_tool_read_scene(MesoTool *tool, MesoScene *scene, MesoInput *input, const char *path,
                                MesoSceneReading *reading)
{
    uint32_t number = tool->provenance.input_count;
    MesoStatus status = meso_tool_open_place(tool, input, path, &MESO_PLACE_MODEL);
    if (status)
        return status;
    if (is_mesh(input))
        tool->provenance.inputs[number].role = "mesh";
    status = is_mesh(input) ? read_mesh(tool, scene, input, reading)
                            : meso_scene_read(scene, &tool->arena, input, reading, &tool->error);
    if (status) {
        meso_input_close(input);
        *input = (MesoInput){0};
    }
    return status;
}
