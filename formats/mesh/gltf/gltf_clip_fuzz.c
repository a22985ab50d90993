/* Any bytes as animated glTF: what is accepted can be asked for at any time, and has the vertices of the mesh. */
#include <math.h>
#include <stdlib.h>

#include "formats/mesh/gltf/gltf_clip.h"
#include "formats/mesh/mesh_kinds.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(bool right)
{
    if (!right)
        abort();
}

static void check_mesh(const MesoInput *input, uint32_t vertex_count)
{
    MesoArena arena;
    MesoError error;
    MesoPolygonMesh mesh;
    meso_arena_init(&arena);
    if (meso_gltf_read(&mesh, &arena, input, 1, &error) == MESO_OK)
        check(mesh.vertex_count == vertex_count);
    meso_arena_release(&arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double times[] = {0, 0.5, 1, 1e9};
    MesoInput input;
    MesoError error;
    MesoGltfClip *clip;
    if (size == 0)
        return 0;
    meso_input_wrap(&input, "fuzz", data, size);
    if (meso_gltf_clip_open(&clip, &input, &error))
        return 0;
    uint32_t count = meso_gltf_clip_vertex_count(clip);
    MesoVec3 *positions = malloc(((size_t)count + 1) * sizeof *positions);
    check(positions && meso_gltf_clip_duration(clip) >= 0 && isfinite(meso_gltf_clip_duration(clip)));
    for (size_t i = 0; i < sizeof times / sizeof *times; i++)
        if (meso_gltf_clip_positions(clip, times[i], positions, &error) == MESO_OK)
            for (uint32_t v = 0; v < count; v++)
                check(fabsf(positions[v].x) <= MESO_COORDINATE_LIMIT);
    check_mesh(&input, count);
    free(positions);
    meso_gltf_clip_release(clip);
    return 0;
}
