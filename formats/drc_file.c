/* Draco (.drc): all parts as one mesh. */
#include <string.h>

#include "formats/draco_mesh.h"
#include "formats/mesh_file.h"
#include "formats/mesh_window.h"

static MesoStatus check(const MesoTessellation *t, MesoError *error)
{
    MesoStatus status = meso_mesh_check_counts(t, "a Draco file", error);
    if (status == MESO_OK && t->triangle_count > MESO_DRACO_TRIANGLES)
        return meso_fail(error, MESO_ERR_LIMIT,
                         "too large for one Draco mesh: %llu triangles, at most %u: "
                         "lower --divisions, raise --section-step or write .glb",
                         (unsigned long long)t->triangle_count, MESO_DRACO_TRIANGLES);
    return status;
}

static void report(const MesoMeshWriteOptions *options, uint64_t done, uint64_t total)
{
    if (options->progress)
        options->progress(options->progress_context, done, total);
}

static MesoStatus encode(const MesoTessellation *t, const MesoMeshWriteOptions *options,
                         MesoArena *arena, MesoDracoResult *result, MesoError *error)
{
    MesoDracoOptions draco;
    MesoDracoText texts[] = {
        {"tiles", meso_mesh_tile_names(t, arena, error)},
        {"materials", meso_mesh_material_names(t, arena, error)},
        {"provenance", meso_mesh_provenance(options, arena, error)},
    };
    if (!texts[0].value || !texts[1].value || !texts[2].value)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_draco_options_make(&draco, t, options, error);
    if (status != MESO_OK)
        return status;
    draco.texts = texts;
    draco.text_count = *texts[2].value ? 3 : 2;
    MesoPartRange all = {0, t->part_count};
    return meso_draco_encode_parts(t, 1, &all, &draco, result, error);
}

MesoStatus meso_drc_write(const MesoTessellation *tessellation, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    MesoDracoResult result = {0};
    meso_arena_init(&arena);
    report(options, 0, tessellation->triangle_count);
    MesoStatus status = check(tessellation, error);
    if (status == MESO_OK)
        status = encode(tessellation, options, &arena, &result, error);
    if (status == MESO_OK)
        status = meso_output_write(output, result.data, result.size, error);
    report(options, tessellation->triangle_count, tessellation->triangle_count);
    meso_draco_result_release(&result);
    meso_arena_release(&arena);
    return status;
}
