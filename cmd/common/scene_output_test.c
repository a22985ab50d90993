/* Scenes out: the kind that a name asks for, the file, the report. */
#include "cmd/common/scene_output.h"

#include <sys/stat.h>

#include "cmd/common/progress.h"
#include "formats/file/test_folder.h"
#include "formats/scene/scene_fixture.h"

typedef struct Frame {
    MesoTool tool;
    MesoProgress progress;
    MesoSceneOutput output;
} Frame;

static void frame_init(Frame *frame, const char *path)
{
    *frame = (Frame){.output = MESO_SCENE_OUTPUT_DEFAULTS};
    meso_arena_init(&frame->tool.arena);
    frame->tool.output = path;
    frame->tool.quiet = true;
    frame->tool.progress = &frame->progress;
    meso_progress_init(&frame->progress, "none", true);
    frame->tool.report = json_object();
    frame->tool.provenance = (MesoProvenance){.tool = "meso-try", .command_line = "meso-try"};
}

static void frame_release(Frame *frame)
{
    json_decref(frame->tool.report);
    meso_arena_release(&frame->tool.arena);
}

/* The kind's name; "" with the frame's error where there is none. */
static const char *kind_of(Frame *frame, const char *path, const char *to)
{
    frame->tool.output = path;
    frame->output.to = to;
    MesoStatus status = meso_tool_choose_scene_kind(&frame->tool, &frame->output);
    CHECK(status == MESO_OK || status == MESO_ERR_USAGE);
    return status ? "" : frame->output.kind->name;
}

static void test_kinds(void)
{
    Frame frame;
    frame_init(&frame, NULL);
    CHECK(strcmp(kind_of(&frame, "a.b/out.meso", NULL), "meso") == 0);
    CHECK(strcmp(kind_of(&frame, "out.GLB", NULL), "glb") == 0);
    CHECK(strcmp(kind_of(&frame, "out.glb", "drc"), "drc") == 0);
    CHECK(strcmp(kind_of(&frame, NULL, "ply"), "ply") == 0 && strcmp(frame.tool.output, "-") == 0);
    static const char *const others[] = {"-", "out", "ply", "a.ply/out", "out.ply.gz", "out."};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        CHECK(kind_of(&frame, others[i], NULL)[0] == 0);
        CHECK(strstr(frame.tool.error.message, others[i]) && strstr(frame.tool.error.message, "--to"));
    }
    frame_release(&frame);
}

static void test_options_of_another_writer(void)
{
    Frame frame;
    frame_init(&frame, NULL);
    frame.output.given.speed = true;
    CHECK(kind_of(&frame, "out.glb", NULL)[0] == 0 && strcmp(kind_of(&frame, "out.drc", NULL), "drc") == 0);
    frame.output.compress = "draco";
    CHECK(strcmp(kind_of(&frame, "out.glb", NULL), "glb") == 0);
    CHECK(kind_of(&frame, "out.meso", NULL)[0] == 0);
    CHECK(strcmp(frame.tool.error.message,
                 "--speed is for .drc, and for .glb with --compress draco; the output is .meso") == 0);
    frame.output.given.position_bits = true;
    CHECK(kind_of(&frame, "out.obj", NULL)[0] == 0 && strstr(frame.tool.error.message, "--position-bits"));
    frame_release(&frame);
}

static json_int_t number(const Frame *frame, const char *key)
{
    return json_integer_value(json_object_get(frame->tool.report, key));
}

/* Every kind of one scene: a file that is there, and its facts. */
static void test_products(const TestFolder *folder)
{
    ColoredFixture fixture;
    colored_fixture_init(&fixture);
    static const char *const names[] = {"out.meso", "out.ply", "out.obj", "out.glb", "out.drc", "out.stl"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        Frame frame;
        MesoInput input;
        frame_init(&frame, test_path(folder, names[i]));
        CHECK(meso_tool_choose_scene_kind(&frame.tool, &frame.output) == MESO_OK);
        CHECK(meso_tool_write_scene(&frame.tool, &frame.output, &(MesoSceneProduct){.scene = &fixture.scene}) == MESO_OK);
        CHECK(meso_input_open(&input, frame.tool.output, &frame.tool.error) == MESO_OK);
        CHECK(number(&frame, "bytes") == (json_int_t)input.size && input.size > 0);
        CHECK(number(&frame, "parts") == 1 && number(&frame, "vertices") == 3 && number(&frame, "faces") == 1);
        CHECK(number(&frame, "triangles") == 1 && number(&frame, "elements") == 70001);
        CHECK(strcmp(json_string_value(json_object_get(frame.tool.report, "kind")), names[i] + 4) == 0);
        meso_input_close(&input);
        CHECK(unlink(frame.tool.output) == 0);
        CHECK((unlink(test_path(folder, "out.mtl")) == 0) == (i == 2));
        frame_release(&frame);
    }
}

static MesoStatus write_word(const void *model, const MesoProvenance *provenance, MesoOutput *output, MesoError *error)
{
    CHECK(strcmp(provenance->tool, "meso-try") == 0);
    return meso_output_write(output, model, strlen(model), error);
}

static void test_model_of_the_method(const TestFolder *folder)
{
    Frame frame;
    SceneFixture fixture;
    scene_fixture_init(&fixture, 2, 3, 0.1f);
    frame_init(&frame, test_path(folder, "own.meso"));
    const MesoSceneProduct product = {.scene = &fixture.scene, .write_model = write_word, .model = "model"};
    CHECK(meso_tool_choose_scene_kind(&frame.tool, &frame.output) == MESO_OK);
    CHECK(meso_tool_write_scene(&frame.tool, &frame.output, &product) == MESO_OK);
    CHECK(test_file_is(frame.tool.output, "model", 5));
    CHECK(number(&frame, "parts") == fixture.parts.part_count && number(&frame, "slots") == 4);
    frame_release(&frame);
    scene_fixture_release(&fixture);
}

/* What cannot be written leaves no file, and no facts of one. */
static void test_nothing_to_write(const TestFolder *folder)
{
    Frame frame;
    const MesoScene empty = {0};
    frame_init(&frame, test_path(folder, "none.ply"));
    CHECK(meso_tool_choose_scene_kind(&frame.tool, &frame.output) == MESO_OK);
    CHECK(meso_tool_write_scene(&frame.tool, &frame.output, &(MesoSceneProduct){.scene = &empty}) == MESO_ERR_INPUT);
    CHECK(access(frame.tool.output, F_OK) != 0 && json_object_size(frame.tool.report) == 0);
    frame_release(&frame);
}

/* An OBJ and its materials come together, or neither does. */
static void test_materials(const TestFolder *folder)
{
    Frame frame;
    ColoredFixture fixture;
    colored_fixture_init(&fixture);
    frame_init(&frame, test_path(folder, "in.obj"));
    CHECK(mkdir(test_path(folder, "in.mtl"), 0700) == 0);
    CHECK(meso_tool_choose_scene_kind(&frame.tool, &frame.output) == MESO_OK);
    CHECK(meso_tool_write_scene(&frame.tool, &frame.output, &(MesoSceneProduct){.scene = &fixture.scene}) ==
          MESO_ERR_OUTPUT);
    CHECK(access(frame.tool.output, F_OK) != 0 && rmdir(test_path(folder, "in.mtl")) == 0);
    frame_release(&frame);
}

int main(void)
{
    TestFolder folder = test_folder_make();
    test_kinds();
    test_options_of_another_writer();
    test_products(&folder);
    test_model_of_the_method(&folder);
    test_materials(&folder);
    test_nothing_to_write(&folder);
    test_folder_remove(&folder);
    return 0;
}
