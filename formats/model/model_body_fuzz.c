/* Reader of bodies: a good file with chunks replaced; what is read goes through the polygons of a scene. */
#include "formats/file/container_memory.h"
#include "formats/model/model_body.h"
#include "formats/model/model_fixture.h"
#include "formats/model/model_scene.h"
#include "formats/scene/scene_fixture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static MesoStatus write_example(MesoOutput *output, MesoError *error)
{
    ColoredFixture fixture;
    MesoProvenance provenance = model_fixture_provenance();
    colored_fixture_init(&fixture);
    return meso_body_write(&fixture.scene, &provenance, output, error);
}

static void check_sound(const MesoScene *scene, MesoArena *arena)
{
    MesoSceneParts parts;
    MesoError error;
    CHECK(meso_scene_parts_init(&parts, arena, scene, &error) == MESO_OK);
    uint64_t vertex_count = parts.vertex_begin[parts.part_count], face_count = parts.face_begin[parts.part_count];
    MesoMeshVertex *vertices = MESO_NEW(arena, MesoMeshVertex, vertex_count, &error);
    MesoMeshFace *faces = MESO_NEW(arena, MesoMeshFace, face_count, &error);
    CHECK(vertices && faces);
    meso_scene_vertices(&parts, 0, parts.part_count, vertices);
    meso_scene_faces(&parts, 0, parts.part_count, 0, faces);
    for (uint64_t f = 0; f < face_count; f++)
        for (int k = 0; k < 4; k++)
            CHECK(faces[f].v[k] < vertex_count || (k == 3 && faces[f].v[k] == MESO_NO_INDEX));
    for (uint32_t p = 0; p < parts.part_count; p++) {
        MesoPart part = meso_scene_part(&parts, p);
        CHECK(part.material < scene->material_count && scene->material_names[part.material]);
        for (uint32_t c = 0; c < scene->channel_count; c++)
            CHECK(meso_scene_id(scene, part.ids, c) < scene->channels[c].count);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static MesoContainer example;
    if (example.chunk_count == 0)
        example = container_example("model", write_example);
    MesoContainer container = example;
    MesoSceneReading reading = {.thread_count = 1};
    MesoScene scene;
    MesoArena arena;
    MesoInput input;
    MesoError error;
    size_t length;
    container_replace_chunks(&container, data, size);
    uint8_t *bytes = container_to_memory(&container, &length);
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", bytes, length);
    if (meso_scene_read(&scene, &arena, &input, &reading, &error) == MESO_OK)
        check_sound(&scene, &arena);
    meso_arena_release(&arena);
    free(bytes);
    return 0;
}
