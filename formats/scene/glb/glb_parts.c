#include "formats/scene/glb/glb_parts.h"

#include <string.h>

#include "formats/scene/surface_frame.h"

/* Runs in the order of the parts; `runs` NULL only counts. */
static uint32_t cut_runs(const MesoSceneParts *parts, uint64_t most_faces, uint32_t apart, MesoGlbRun *runs)
{
    uint32_t count = 0;
    for (uint32_t part = 0; part < parts->part_count;) {
        MesoGlbRun run = {{part, part}, meso_scene_part(parts, part).material, 0};
        uint64_t first = parts->face_begin[part];
        do
            part++;
        while (part < parts->part_count && part < apart && parts->face_begin[part + 1] - first <= most_faces &&
               meso_scene_part(parts, part).material == run.material);
        run.range.end = part;
        run.face_count = parts->face_begin[part] - first;
        if (run.face_count == 0)
            continue;
        if (runs)
            runs[count] = run;
        count++;
    }
    return count;
}

/* Puts runs of one material next to each other, otherwise in the order that they had. */
static void sort_runs(const MesoGlbRun *runs, uint32_t count, uint32_t *bins, uint32_t bin_count, MesoGlbRun *sorted)
{
    memset(bins, 0, ((size_t)bin_count + 1) * sizeof *bins);
    for (uint32_t i = 0; i < count; i++)
        bins[runs[i].material + 1]++;
    for (uint32_t m = 0; m < bin_count; m++)
        bins[m + 1] += bins[m];
    for (uint32_t i = 0; i < count; i++)
        sorted[bins[runs[i].material]++] = runs[i];
}

MesoStatus meso_glb_runs(MesoGlbRun **runs, uint32_t *count, const MesoSceneParts *parts, uint64_t most_faces,
                         uint32_t apart, MesoArena *arena, MesoError *error)
{
    uint32_t material_count = parts->scene->material_count;
    *count = cut_runs(parts, most_faces, apart, NULL);
    *runs = MESO_NEW(arena, MesoGlbRun, *count, error);
    MesoArenaMark mark = meso_arena_mark(arena);
    MesoGlbRun *unsorted = MESO_NEW(arena, MesoGlbRun, *count, error);
    uint32_t *bins = MESO_NEW(arena, uint32_t, (size_t)material_count + 1, error);
    if (!*runs || !unsorted || !bins)
        return MESO_ERR_MEMORY;
    cut_runs(parts, most_faces, apart, unsorted);
    sort_runs(unsorted, *count, bins, material_count, *runs);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

uint32_t meso_glb_stride(const MesoScene *scene, const MesoMeshWriteOptions *options)
{
    return (uint32_t)sizeof(MesoMeshVertex) + (meso_scene_is_colored(scene) ? 4 : 0) + 4 * scene->channel_count +
           (options->lengths ? (uint32_t)sizeof(MesoVec2) : 0) +
           (options->tangents ? (uint32_t)sizeof(MesoTangent) : 0);
}

MesoStatus meso_glb_heads(uint32_t head[5], uint32_t binary_head[2], size_t json_size, uint64_t size,
                          const MesoMeshWriteOptions *options, MesoError *error)
{
    uint64_t total = MESO_GLB_HEAD + json_size + MESO_GLB_BINARY_HEAD + size;
    if (size > UINT32_MAX || total > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "too large for a GLB file: over 4 GiB%s%s", MESO_MESH_SMALLER(options));
    const uint32_t heads[] = {0x46546c67, 2, (uint32_t)total, (uint32_t)json_size, 0x4e4f534a, (uint32_t)size,
                              0x004e4942};
    memcpy(head, heads, MESO_GLB_HEAD);
    memcpy(binary_head, heads + 5, MESO_GLB_BINARY_HEAD);
    return MESO_OK;
}

MesoStatus meso_glb_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                          MesoError *error)
{
    MesoStatus status = meso_mesh_check_counts(parts, options, "a GLB file", error);
    if (status)
        return status;
    switch (options->compression) {
    case MESO_GLB_DRACO: return meso_glb_write_draco(parts, options, output, error);
    case MESO_GLB_MESHOPT: return meso_glb_write_meshopt(parts, options, output, error);
    case MESO_GLB_PLAIN: break;
    }
    return meso_glb_write_plain(parts, options, output, error);
}
