/* Reader of quilts: a good file with chunks replaced; what is read must embed and be a scene of finite places. */
#include "formats/file/container_memory.h"
#include "formats/quilt/quilt_file_fixture.h"
#include "libcore/quilt/embed/quilt_scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static MesoArena fixed;

static MesoStatus write_example(MesoOutput *output, MesoError *error)
{
    MesoQuiltFile file = quilt_file_fixture(&fixed);
    MesoProvenance provenance = quilt_file_fixture_provenance();
    MesoStatus status = meso_quilt_write(&file, &provenance, output, error);
    meso_triangulation_release(&file.base);
    return status;
}

static void check_scene(const MesoQuiltFile *file, MesoArena *arena)
{
    MesoScene scene;
    MesoError error;
    CHECK(meso_quilt_show(&scene, arena, &file->quilt, &file->swatch, &file->base, file->embedding, 1,
                          &error) == MESO_OK);
    for (uint32_t b = 0; b < scene.body_count; b++) {
        const MesoBody *body = &scene.bodies[b];
        for (uint32_t c = 0; c < 3 * body->face_count; c++)
            CHECK(body->corners[c] < body->vertex_count);
        for (uint32_t v = 0; v < body->vertex_count; v++)
            CHECK(meso_vec3_finite(body->positions[v]) && meso_vec3_finite(body->normals[v]));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static MesoContainer example;
    if (example.chunk_count == 0) {
        meso_arena_init(&fixed);
        example = container_example("quilt", write_example);
    }
    MesoContainer container = example;
    const char *provenance;
    MesoQuiltFile file;
    MesoArena arena;
    MesoInput input;
    MesoError error;
    size_t length;
    container_replace_chunks(&container, data, size);
    uint8_t *bytes = container_to_memory(&container, &length);
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", bytes, length);
    if (meso_quilt_read(&file, &provenance, &arena, &input, &error) == MESO_OK)
        check_scene(&file, &arena);
    meso_arena_release(&arena);
    free(bytes);
    return 0;
}
