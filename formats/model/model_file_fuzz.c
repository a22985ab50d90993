/* Reader of models: a good file with chunks replaced; what is read must be a sound model, of finite geometry. */
#include "formats/file/container_memory.h"
#include "formats/model/model_fixture.h"
#include "libcore/scene/parts.h"
#include "libcore/tiling/relax/relax.h"
#include "libcore/tiling/strand/expansion.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static MesoArena fixed;

static MesoStatus write_example(MesoOutput *output, MesoError *error)
{
    MesoModel model = model_fixture(&fixed);
    model.options.relax = 2;
    CHECK(meso_model_relax(&model, NULL, &fixed, 1, error) == MESO_OK);
    MesoProvenance provenance = model_fixture_provenance();
    return meso_model_write(&model, &provenance, output, error);
}

static void check_sound(const MesoModel *model)
{
    if (!(model->options.thickness > 0) || model->options.divisions < 2 ||
        model->assignment.slot_count != model->surface.face_count)
        abort();
    for (uint32_t i = 0; i < model->tile_set.inner_count; i++) {
        const MesoTriangleMesh *mesh = &model->inner_meshes[i];
        for (uint64_t t = 0; t < 3 * (uint64_t)mesh->triangle_count; t++)
            if (!meso_vec3_finite(mesh->positions[mesh->triangles[t]]))
                abort();
    }
}

static void check_geometry(const MesoModel *model, MesoArena *arena)
{
    enum { MOST_VERTICES = 1 << 16 };
    MesoScene scene;
    MesoSceneParts t;
    MesoError error;
    if (meso_model_expand(&scene, NULL, arena, model, 1, &error) != MESO_OK ||
        meso_scene_parts_init(&t, arena, &scene, &error) != MESO_OK || t.vertex_begin[t.part_count] > MOST_VERTICES)
        return;
    uint64_t count = t.vertex_begin[t.part_count];
    MesoMeshVertex *vertices = MESO_NEW(arena, MesoMeshVertex, count, &error);
    CHECK(vertices);
    meso_scene_vertices(&t, 0, t.part_count, vertices);
    for (uint64_t v = 0; v < count; v++)
        CHECK(meso_vec3_finite(vertices[v].position) && meso_vec3_finite(vertices[v].normal));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static MesoContainer example;
    if (example.chunk_count == 0) {
        meso_arena_init(&fixed);
        example = container_example("model", write_example);
    }
    MesoContainer container = example;
    const char *provenance;
    MesoModel model;
    MesoArena arena;
    MesoInput input;
    MesoError error;
    size_t length;
    container_replace_chunks(&container, data, size);
    uint8_t *bytes = container_to_memory(&container, &length);
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", bytes, length);
    if (meso_model_read(&model, &provenance, &arena, &input, &error) == MESO_OK) {
        check_sound(&model);
        check_geometry(&model, &arena);
    }
    meso_arena_release(&arena);
    free(bytes);
    return 0;
}
