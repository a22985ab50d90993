#include "formats/model/model_scene.h"

#include <stddef.h>

#include "formats/mesh/mesh_read.h"
#include "formats/model/model_body.h"
#include "formats/model/model_file.h"
#include "formats/quilt/quilt_move.h"
#include "libcore/quilt/embed/quilt_scene.h"
#include "libcore/tiling/strand/expansion.h"

typedef struct Opened {
    const MesoContainer *file;
    const MesoInput *input;
    MesoArena *arena;
    MesoSceneReading *reading;
} Opened;

static MesoStatus expand_tiles(MesoScene *scene, const Opened *opened, MesoError *error)
{
    MesoSceneReading *reading = opened->reading;
    MesoModel *model = MESO_NEW(opened->arena, MesoModel, 1, error);
    if (!model)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_model_take(model, opened->arena, opened->file, opened->input->path, error);
    if (status)
        return status;
    const MesoMapOptions stored = model->options;
    if (reading->remap)
        reading->remap(reading->context, &model->options);
    model->options = meso_map_options_resolve(model->options, model->surface.mean_edge_length);
    if (!meso_map_options_same_form(&model->options, &stored))
        status = meso_model_relax(model, &reading->relaxed, opened->arena, reading->thread_count, error);
    if (status)
        return status == MESO_ERR_INPUT ? meso_fail_prefix(error, opened->input->path) : status;
    reading->tiling = model;
    status = meso_model_expand_to_draw(scene, opened->arena, model, reading->stored_sweeps, reading->thread_count,
                                       error);
    if (status == MESO_ERR_INPUT)
        meso_fail_prefix(error, opened->input->path);
    return status;
}

static MesoStatus expand_body(MesoScene *scene, const Opened *opened, MesoError *error)
{
    return meso_body_read(scene, opened->arena, opened->file, opened->input->path, error);
}

static const struct {
    const char *chunk;
    MesoStatus (*expand)(MesoScene *scene, const Opened *opened, MesoError *error);
} METHODS[] = {{"tiles", expand_tiles}, {"body", expand_body}};
enum { METHOD_COUNT = sizeof METHODS / sizeof *METHODS };

static MesoStatus read_quilt(MesoScene *scene, MesoArena *arena, const MesoInput *input, MesoSceneReading *reading,
                             MesoError *error)
{
    uint32_t face;
    MesoQuiltFile file;
    MesoStatus status = meso_quilt_read(&file, &reading->provenance, arena, input, error);
    if (!status && reading->surface) {
        status = meso_quilt_move(&file, arena, reading->surface, &face, error);
        if (status)
            return meso_mesh_fail_at_face(reading->surface_input, face, error);
    }
    if (status)
        return status;
    MesoQuiltEmbedding how = reading->embedding ? meso_quilt_embedding_named(reading->embedding) : file.embedding;
    return meso_quilt_show(scene, arena, &file.quilt, &file.swatch, &file.base, how, reading->thread_count, error);
}

MesoStatus meso_scene_read(MesoScene *scene, MesoArena *arena, const MesoInput *input, MesoSceneReading *reading,
                           MesoError *error)
{
    MesoContainer file;
    uint64_t size;
    reading->tiling = NULL;
    reading->quilt = meso_quilt_recognise(input);
    if (reading->quilt)
        return read_quilt(scene, arena, input, reading, error);
    MesoStatus status = meso_container_read(&file, input, "model", MESO_MODEL_MAJOR, error);
    if (!status)
        status = meso_model_provenance(&reading->provenance, arena, &file, input->path, error);
    if (status)
        return status;
    const Opened opened = {&file, input, arena, reading};
    for (uint32_t m = 0; m < METHOD_COUNT; m++)
        if (meso_container_find(&file, METHODS[m].chunk, &size))
            return METHODS[m].expand(scene, &opened, error);
    return meso_fail(error, MESO_ERR_INPUT, "%s: the model has neither a chunk 'tiles' nor 'body'", input->path);
}
