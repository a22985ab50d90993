/* The chunk 'mapping': there and back, absent keys and chunks, unknown keys, wrong words; models with and without. */
#include "formats/model/model_mapping.h"

#include "formats/file/container_fixture.h"
#include "formats/model/model_fixture.h"

static MesoArena arena;
static TestFolder folder;

static MesoStatus read_text(MesoMapOptions *options, const char *text, MesoError *error)
{
    MesoInput input;
    meso_input_wrap(&input, "chunk 'mapping'", text, strlen(text));
    return meso_mapping_read(options, &input, &arena, error);
}

static void test_text(void)
{
    MesoMapOptions options = {.frame = MESO_FRAME_MINIMAL, .normals = MESO_NORMALS_FLAT, .side = MESO_SHELL_BOTH,
                              .limit_folds = 1, .section_size = MESO_SECTION_SLOT,
                              .tolerance = 0.001f, .tolerance_in = MESO_TOLERANCE_SCENE, .deform = MESO_SWEEP_SHAPE,
                              .bends = MESO_BENDS_DRAWN, .relax = 20, .divisions = 7};
    MesoMapOptions back = {.divisions = 7};
    MesoError error;
    char *text;
    CHECK(meso_mapping_text(&text, &options, &error) == MESO_OK);
    CHECK_TEXT(text, "{\"frame\":\"minimal\",\"deform\":\"shape\",\"normals\":\"flat\",\"side\":\"both\",\"limit_folds\":1,"
                     "\"section_size\":\"slot\",\"tolerance\":0.001,\"tolerance_in\":\"scene\",\"bends\":\"drawn\",\"relax\":20}");
    CHECK(read_text(&back, text, &error) == MESO_OK);
    CHECK(memcmp(&back, &options, sizeof options) == 0);
    free(text);

    CHECK(read_text(&back, "{\"comment\": \"as it was\"}", &error) == MESO_OK && back.frame == MESO_FRAME_PAPER &&
          back.limit_folds == 0);
    CHECK(meso_mapping_text(&text, &back, &error) == MESO_OK && !text);
}

#define KEYS "\"frame\", \"deform\", \"normals\", \"side\", \"limit_folds\", \"section_size\", \"tolerance\", " \
             "\"tolerance_in\", \"bends\", \"relax\""

static void test_wrong_text(void)
{
    static const char *const wrong[][2] = {
        {"{", "chunk 'mapping':1:1: string or '}' expected near end of file"},
        {"[]", "chunk 'mapping': an object is needed here, not an array"},
        {"{\"frames\": 1}", "chunk 'mapping': unknown key \"frames\"; there are " KEYS},
        {"{\"frame\": 1}", "chunk 'mapping': frame: a frame is needed here, one of \"paper\", \"minimal\""},
        {"{\"deform\": \"shapes\"}", "chunk 'mapping': deform: no deform 'shapes'; did you mean 'shape'?"},
        {"{\"frame\": \"minimum\"}", "chunk 'mapping': frame: no frame 'minimum'; did you mean 'minimal'?"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        MesoMapOptions options = {0};
        MesoError error;
        CHECK(read_text(&options, wrong[i][0], &error) == MESO_ERR_INPUT);
        CHECK_TEXT(error.message, wrong[i][1]);
    }
}

static MesoInput write_model(const MesoModel *model)
{
    MesoProvenance provenance = model_fixture_provenance();
    const char *path = test_path(&folder, "a.meso");
    MesoOutput *output;
    MesoInput input;
    MesoError error;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_model_write(model, &provenance, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    return input;
}

static void check_minor(const MesoInput *input, uint16_t minor, bool chunk)
{
    MesoContainer container;
    uint64_t size;
    MesoError error;
    CHECK(meso_container_read(&container, input, "model", MESO_MODEL_MAJOR, &error) == MESO_OK);
    CHECK(container.minor == minor && (meso_container_find(&container, "mapping", &size) != NULL) == chunk);
}

/* Models without such an option stay what they were. */
static void test_models(void)
{
    MesoModel model = model_fixture(&arena), back;
    MesoError error;
    MesoInput input = write_model(&model);
    check_minor(&input, 0, false);
    CHECK(meso_model_read(&back, NULL, &arena, &input, &error) == MESO_OK && back.options.frame == MESO_FRAME_PAPER);
    meso_input_close(&input);

    model.options.frame = MESO_FRAME_MINIMAL;
    input = write_model(&model);
    check_minor(&input, 2, true);
    CHECK(meso_model_read(&back, NULL, &arena, &input, &error) == MESO_OK && back.options.frame == MESO_FRAME_MINIMAL);
    meso_input_close(&input);
}

static MesoStatus read_quietly(const MesoInput *input, MesoError *error)
{
    MesoModel model;
    return meso_model_read(&model, NULL, &arena, input, error);
}

static const ContainerFixture fixture = {&folder, "a.meso", "model", 1, read_quietly};

int main(void)
{
    folder = test_folder_make();
    meso_arena_init(&arena);
    test_text();
    test_wrong_text();
    test_models();
    container_fixture_expect(&fixture, "mapping", "{\"frame\":1}", 11,
                             "file: chunk 'mapping': frame: a frame is needed here, one of \"paper\", \"minimal\"");
    container_fixture_expect(&fixture, "mapping", "{\"fame\":1}", 10,
                             "file: chunk 'mapping': unknown key \"fame\"; there are " KEYS);
    container_fixture_damage(&fixture);
    meso_arena_release(&arena);
    test_folder_remove(&folder);
    return 0;
}
