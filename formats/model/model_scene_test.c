/* Models of any method as scenes: bodies there and back to the bit, every kind of wrong chunk, every damaged byte. */
#include "formats/model/model_scene.h"

#include "formats/file/container_fixture.h"
#include "formats/model/model_body.h"
#include "formats/model/model_fixture.h"
#include "formats/scene/scene_fixture.h"

static MesoArena arena;
static TestFolder folder;

static void write_body(const MesoScene *scene, const char *path)
{
    MesoProvenance provenance = model_fixture_provenance();
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_body_write(scene, &provenance, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
}

static MesoInput open_file(const char *path)
{
    MesoInput input;
    MesoError error;
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    return input;
}

/* The fixture's triangle with texture coordinates, and once more a unit higher, in a frame and in another row. */
static void make_bodies(ColoredFixture *c, MesoPlacedBody placed[2], MesoFrame *frame)
{
    static const MesoVec2 uvs[3] = {{0, 0}, {1, 0}, {0, 1}};
    colored_fixture_init(c);
    c->material = (MesoMaterial){{0.1f, 0.2f, 0.3f}, 0.7f, 1};
    c->body.uvs = uvs;
    *frame = (MesoFrame){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1}};
    placed[0] = c->placed;
    placed[1] = (MesoPlacedBody){.place = MESO_PLACED_IN_FRAME};
    c->scene.placed_count = 2;
    c->scene.placed = placed;
    c->scene.frame_count = 1;
    c->scene.frames = frame;
}

static void test_round_trip(void)
{
    ColoredFixture c;
    MesoPlacedBody placed[2];
    MesoFrame frame;
    MesoScene back;
    MesoSceneReading reading = {.thread_count = 1};
    MesoError error;
    make_bodies(&c, placed, &frame);
    write_body(&c.scene, test_path(&folder, "a.meso"));
    MesoInput input = open_file(test_path(&folder, "a.meso"));
    CHECK(meso_scene_read(&back, &arena, &input, &reading, &error) == MESO_OK);
    CHECK(!reading.tiling && strstr(reading.provenance, "meso-try"));

    CHECK(back.channel_count == 3 && strcmp(back.channels[0].names[1], "stem one") == 0 && !back.channels[1].names);
    CHECK(back.channels[1].count == 70001 && back.id_row_count == 2 && memcmp(back.ids, c.ids, sizeof c.ids) == 0);
    CHECK(back.material_count == 1 && memcmp(back.materials, &c.material, sizeof c.material) == 0);
    CHECK(strcmp(back.material_names[0], "paint") == 0);
    CHECK(back.placed_count == 2 && back.placed[0].ids == 1 && back.placed[1].ids == 0);
    CHECK(memcmp(back.bodies[0].positions, c.positions, sizeof c.positions) == 0);
    CHECK(memcmp(back.bodies[1].colors, c.colors, sizeof c.colors) == 0);
    CHECK(back.bodies[1].positions[2].y == 1 && back.bodies[1].positions[2].z == 1 && back.bodies[1].uvs[2].y == 1);
    CHECK(back.bodies[1].corners[2] == 2 && back.bodies[1].corners[3] == MESO_NO_INDEX);
    CHECK(back.box.low.x == 0 && back.box.high.z == 1);

    /* A model of the model has the same bytes. */
    write_body(&back, test_path(&folder, "b.meso"));
    MesoInput again = open_file(test_path(&folder, "b.meso"));
    CHECK(again.size == input.size && memcmp(again.data, input.data, input.size) == 0);
    CHECK(meso_model_has_body(&again));
    meso_input_close(&again);
    meso_input_close(&input);

    c.scene.placed_count = 0;
    write_body(&c.scene, test_path(&folder, "b.meso"));
    input = open_file(test_path(&folder, "b.meso"));
    CHECK(meso_scene_read(&back, &arena, &input, &reading, &error) == MESO_OK && back.body_count == 0);
    meso_input_close(&input);
}

static void make_finer(void *context, MesoMapOptions *options)
{
    options->divisions = *(uint32_t *)context;
}

/* A model of tiles is the scene that it expands to, with the options that it is given. */
static void test_tiles(void)
{
    MesoModel model = model_fixture(&arena);
    MesoProvenance provenance = model_fixture_provenance();
    uint32_t divisions = 9;
    MesoSceneReading reading = {.thread_count = 1, .remap = make_finer, .context = &divisions};
    MesoScene expected, scene;
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, test_path(&folder, "b.meso"), &error) == MESO_OK);
    CHECK(meso_model_write(&model, &provenance, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    MesoInput input = open_file(test_path(&folder, "b.meso"));
    CHECK(!meso_model_has_body(&input));
    CHECK(meso_scene_read(&scene, &arena, &input, &reading, &error) == MESO_OK);
    model.options.divisions = divisions;
    CHECK(meso_model_expand(&expected, NULL, &arena, &model, 1, &error) == MESO_OK);
    CHECK(reading.tiling && reading.tiling->options.divisions == 9 && scene.kinds[0].division_count == 9);
    CHECK(scene.sweep_count == expected.sweep_count && scene.placed_count == expected.placed_count);
    CHECK(memcmp(scene.sweeps, expected.sweeps, scene.sweep_count * sizeof *scene.sweeps) == 0);
    CHECK(memcmp(&scene.box, &expected.box, sizeof scene.box) == 0);
    meso_input_close(&input);
}

static MesoStatus read_quietly(const MesoInput *input, MesoError *error)
{
    MesoScene scene;
    MesoSceneReading reading = {0};
    MesoArenaMark mark = meso_arena_mark(&arena);
    MesoStatus status = meso_scene_read(&scene, &arena, input, &reading, error);
    meso_arena_rewind(&arena, mark);
    return status;
}

static const ContainerFixture fixture = {&folder, "a.meso", "model", 1, read_quietly};

static void expect(const char *chunk, const void *data, uint64_t size, const char *message)
{
    container_fixture_expect(&fixture, chunk, data, size, message);
}

static void expect_text(const char *description, const char *message)
{
    expect("bodydesc", description, strlen(description), message);
}

static void test_wrong_chunks(void)
{
    static const char *const names[] = {"prov", "bodydesc", "bodyids", "bodypos", "bodynrm", "bodyuv", "bodycol",
                                        "bodyface"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char message[64];
        snprintf(message, sizeof message, "file: chunk '%s' is missing", names[i]);
        expect(names[i], NULL, UINT64_MAX, message);
    }
    expect("body", NULL, UINT64_MAX, "file: the model has neither a chunk 'tiles' nor 'body'");

    const uint32_t bodies[8] = {3, 1, 0, 1, 3, 1, 0, 2}, painted[8] = {3, 1, 1, 1, 3, 1, 0, 0};
    const uint32_t huge[8] = {UINT32_MAX, 1, 0, 1, UINT32_MAX, 1, 0, 0}, ids[6] = {0, 0, 2, 1, 0, 0};
    const uint32_t faces[8] = {0, 1, 2, MESO_NO_INDEX, 0, 1, MESO_NO_INDEX, MESO_NO_INDEX};
    const float far[18] = {[10] = NAN}, further[18] = {[17] = 2e18f};
    expect("body", bodies, 12, "file: chunk 'body' has 12 bytes, not 0 times 16");
    expect("body", bodies, 32, "file: body 1: no material 0 or row of ids 2");
    expect("body", painted, 32, "file: body 0: no material 1 or row of ids 1");
    expect("body", huge, 32, "file: chunk 'bodypos' has 72 bytes, not 8589934590 times 12");
    expect("bodyids", ids, 24, "file: no state 2; there are 2");
    expect("bodyids", ids, 20, "file: chunk 'bodyids' has 20 bytes, not 3 times 4");
    expect("bodyface", faces, 32, "file: body 1: no vertex 4294967295; it has 3");
    expect("bodypos", far, 72, "file: body 1: vertex 0 is not finite, or too far away");
    expect("bodypos", further, 72, "file: body 1: vertex 2 is not finite, or too far away");
    expect("bodyuv", far, 48, "file: body 1: vertex 2 is not finite, or too far away");
    expect("bodycol", far, 17, "file: chunk 'bodycol' has 17 bytes, not 6 times 3");

    expect_text("{", "file: chunk 'bodydesc':1:1: string or '}' expected near end of file");
    expect_text("{\"channels\": [{\"name\": \"A\", \"count\": 1}]}",
                "file: chunk 'bodydesc': channels[0].name: not 1 to 31 lower-case letters, digits and '_'");
    expect_text("{\"channels\": [{\"name\": \"a\", \"count\": 2, \"names\": [\"x\"]}]}",
                "file: chunk 'bodydesc': channels[0].names: 1 names for 2 ids");
}

int main(void)
{
    folder = test_folder_make();
    meso_arena_init(&arena);
    test_round_trip();
    test_tiles();
    test_wrong_chunks();
    container_fixture_damage(&fixture);
    meso_arena_release(&arena);
    test_folder_remove(&folder);
    return 0;
}
