/* Draco (.drc): all parts as one mesh. */
#include <string.h>

#include "formats/scene/draco_mesh.h"
#include "formats/scene/mesh_file.h"
#include "formats/scene/mesh_window.h"

static MesoStatus check(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoError *error)
{
    MesoStatus status = meso_mesh_check_counts(parts, options, "a Draco file", error);
    if (!status && parts->triangle_count > MESO_DRACO_TRIANGLES)
        return meso_fail(error, MESO_ERR_LIMIT, "too large for one Draco mesh: %llu triangles, at most %u%s%s",
                         (unsigned long long)parts->triangle_count, MESO_DRACO_TRIANGLES,
                         MESO_MESH_SMALLER(options));
    return status;
}

static void report(const MesoMeshWriteOptions *options, uint64_t done, uint64_t total)
{
    if (options->progress)
        options->progress(options->progress_context, done, total);
}

/* Names of the channels, and of the materials; where there is one, the provenance. */
static MesoStatus make_texts(MesoDracoText *texts, uint32_t *count, const MesoScene *scene,
                             const MesoMeshWriteOptions *options, MesoArena *arena, MesoError *error)
{
    *count = 0;
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        const MesoIdChannel *channel = &scene->channels[c];
        if (channel->names)
            texts[(*count)++] = (MesoDracoText){meso_mesh_names_key(channel, arena, error),
                                                meso_mesh_names(channel->names, channel->count, arena, error)};
    }
    texts[(*count)++] = (MesoDracoText){"materials", meso_mesh_material_names(scene, arena, error)};
    if (options->strand_count)
        texts[(*count)++] = (MesoDracoText){"strand_lengths", meso_mesh_strand_array(options, arena, error)};
    texts[(*count)++] = (MesoDracoText){"provenance", meso_mesh_provenance(options, arena, error)};
    for (uint32_t i = 0; i < *count; i++)
        if (!texts[i].key || !texts[i].value)
            return MESO_ERR_MEMORY;
    *count -= *texts[*count - 1].value == 0;
    return MESO_OK;
}

static MesoStatus encode(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                         MesoArena *arena, MesoDracoResult *result, MesoError *error)
{
    MesoDracoOptions draco;
    MesoDracoText texts[MESO_ID_CHANNELS + 3];
    uint32_t text_count;
    MesoStatus status = make_texts(texts, &text_count, parts->scene, options, arena, error);
    if (!status)
        status = meso_draco_options_make(&draco, parts, options, error);
    if (status)
        return status;
    draco.texts = texts;
    draco.text_count = text_count;
    MesoPartRange all = {0, parts->part_count};
    return meso_draco_encode_parts(parts, 1, &all, &draco, result, error);
}

MesoStatus meso_drc_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    MesoDracoResult result = {0};
    meso_arena_init(&arena);
    report(options, 0, parts->triangle_count);
    MesoStatus status = check(parts, options, error);
    if (!status)
        status = encode(parts, options, &arena, &result, error);
    if (!status)
        status = meso_output_write(output, result.data, result.size, error);
    report(options, parts->triangle_count, parts->triangle_count);
    meso_draco_result_release(&result);
    meso_arena_release(&arena);
    return status;
}
