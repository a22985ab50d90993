/* Frames of details as USD and as GLB: rotations, what is shown, ids, and each piece where the JSON says it is. */
#include "formats/replicate/instance_scene.h"

#include <jansson.h>
#include <math.h>

#include "formats/file/test_folder.h"
#include "formats/replicate/animation_glb.h"
#include "formats/replicate/instance_glb.h"
#include "formats/replicate/usda_file.h"

static const MesoMaterial horn = {{0.5f, 0.25f, 0.125f}, 0.5f, 0};
static const MesoVec3 corners_of_triangle[] = {{-0.5f, -0.5f, 0}, {0.5f, 0, 0}, {-0.5f, 0.5f, 0}};
static const MesoVec3 up[] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
static const uint32_t one_triangle[] = {0, 1, 2};
static const MesoVec3 square[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
static const uint32_t two_triangles[] = {0, 1, 2, 0, 2, 3};

static const MesoInstanceShape shapes[] = {
    {"scale 1", &horn, 3, 1, corners_of_triangle, up, one_triangle},
    {"hole", &horn, 0, 0, NULL, NULL, NULL},
    {"2nd \"scale\"", &horn, 3, 1, corners_of_triangle, NULL, one_triangle},
};
static const MesoInstanceShape surface = {"surface", &horn, 4, 2, square, up, two_triangles};
static const MesoInstanceScene scene = {.shape_count = 3, .shapes = shapes, .surface = &surface};

enum { COUNT = 5 };

/* Number 1 is a hole, number 2 has not grown yet. */
static MesoDetail details[COUNT] = {
    {.kind = 0, .born = MESO_DETAIL_ORIGINAL}, {.kind = 1, .born = MESO_DETAIL_ORIGINAL}, {.kind = 0, .born = 7},
    {.kind = 2, .born = 5}, {.kind = 0, .born = 6},
};
static MesoPlacedDetail placed[COUNT] = {
    {{1, 2, 3}, {0, 0, 1}, {1, 0, 0}, 1, 1}, {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 1, 1},
    {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 0, 0}, {{4, 5, 6}, {0, 0, 1}, {0, 1, 0}, 4, 1},
    {{7, 8, 9}, {1, 0, 0}, {0, 0, 1}, 0.5f, 0.5f},
};
static const MesoInstanceFrame frame = {COUNT, details, placed, square, up};

/* ---- rotations ---- */

static MesoVec3 turned(const float q[4], MesoVec3 v)
{
    MesoVec3 u = {q[0], q[1], q[2]};
    MesoVec3 t = meso_vec3_scale(meso_vec3_cross(u, v), 2);
    return meso_vec3_add(meso_vec3_mad(v, q[3], t), meso_vec3_cross(u, t));
}

static bool are_near(MesoVec3 a, MesoVec3 b) { return meso_vec3_length(meso_vec3_sub(a, b)) < 1e-5f; }

static void check_rotation(MesoVec3 normal, MesoVec3 toward)
{
    MesoPlacedDetail p = {.normal = meso_vec3_unit(normal, up[0]), .size = 2, .width = 0.5f};
    p.tangent = meso_vec3_unit(meso_vec3_mad(toward, -meso_vec3_dot(toward, p.normal), p.normal), up[0]);
    MesoInstance instance = meso_instance_of(&p);
    CHECK(are_near(turned(instance.rotation, (MesoVec3){1, 0, 0}), p.tangent));
    CHECK(are_near(turned(instance.rotation, (MesoVec3){0, 0, 1}), p.normal));
    CHECK(instance.rotation[3] >= 0 && instance.scale.x == 2 && instance.scale.y == 0.5f && instance.scale.z == 1);
}

static void test_rotations(void)
{
    for (int i = 0; i < 1000; i++) {
        float a = (float)i, b = 0.37f * (float)(i * i % 1013);
        check_rotation((MesoVec3){cosf(a) * sinf(b), sinf(a) * sinf(b), cosf(b)},
                       (MesoVec3){cosf(b + 1), sinf(a + 2), cosf(3 * a)});
    }
    /* half turns, of which w is 0, and a quarter */
    check_rotation((MesoVec3){0, 0, -1}, (MesoVec3){1, 0, 0});
    check_rotation((MesoVec3){0, 0, -1}, (MesoVec3){-1, 0, 0});
    check_rotation((MesoVec3){0, 0, 1}, (MesoVec3){-1, 0, 0});
    check_rotation((MesoVec3){1, 0, 0}, (MesoVec3){0, 1, 0});
}

static void test_names(void)
{
    char name[12];
    meso_instance_name("2nd \"scale\"", 3, name, sizeof name);
    CHECK_TEXT(name, "_2nd__sca_3");
    meso_instance_name("", 12, name, sizeof name);
    CHECK_TEXT(name, "__12");
}

/* ---- GLB ---- */

static json_t *file_json(const MesoInput *input)
{
    uint32_t words[5];
    memcpy(words, input->data, sizeof words);
    CHECK(words[0] == 0x46546c67 && words[1] == 2 && words[2] == input->size && words[3] % 4 == 0);
    json_t *root = json_loadb((const char *)input->data + 20, words[3], 0, NULL);
    CHECK(root);
    return root;
}

/* The words of an accessor, of which there are `count`. */
static void read_accessor(const MesoInput *input, const json_t *root, json_int_t number, uint32_t count, void *words)
{
    uint32_t json_size;
    memcpy(&json_size, input->data + 12, 4);
    const json_t *accessor = json_array_get(json_object_get(root, "accessors"), (size_t)number);
    const json_t *view = json_array_get(json_object_get(root, "bufferViews"),
                                        (size_t)json_integer_value(json_object_get(accessor, "bufferView")));
    CHECK(json_integer_value(json_object_get(view, "byteLength")) == 4 * (json_int_t)count);
    size_t at = 28 + json_size + (size_t)json_integer_value(json_object_get(view, "byteOffset"));
    CHECK(at + 4 * (size_t)count <= input->size);
    memcpy(words, input->data + at, 4 * (size_t)count);
}

static void read_attribute(const MesoInput *input, const json_t *root, size_t node, const char *name, uint32_t count,
                           void *words)
{
    const json_t *extensions = json_object_get(json_array_get(json_object_get(root, "nodes"), node), "extensions");
    const json_t *attributes = json_object_get(json_object_get(extensions, "EXT_mesh_gpu_instancing"), "attributes");
    const json_t *number = json_object_get(attributes, name);
    CHECK(number);
    read_accessor(input, root, json_integer_value(number), count, words);
}

static void write_glb(const char *path, const MesoInstanceScene *of, MesoStatus expected)
{
    MesoOutput *output;
    MesoError error;
    MesoStatus status = meso_output_open(&output, path, &error);
    if (!status)
        status = meso_instance_glb_write(of, &frame, output, &error);
    CHECK(meso_output_finish(output, status, &error) == expected);
}

static void test_glb(const TestFolder *folder)
{
    const char *path = test_path(folder, "f.glb");
    MesoInput input;
    MesoError error;
    write_glb(path, &scene, MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    json_t *root = file_json(&input);
    CHECK(json_array_size(json_object_get(root, "nodes")) == 3);    /* the surface, and two kinds */
    uint32_t ids[2];
    float numbers[8];
    read_attribute(&input, root, 1, "_ID", 2, ids);
    CHECK(ids[0] == 0 && ids[1] == 4);
    read_attribute(&input, root, 1, "_BIRTH", 2, numbers);
    CHECK(numbers[0] == -1 && numbers[1] == 6);
    read_attribute(&input, root, 1, "TRANSLATION", 6, numbers);
    CHECK(numbers[0] == 1 && numbers[5] == 9);
    read_attribute(&input, root, 1, "ROTATION", 8, numbers);
    CHECK(numbers[0] == 0 && numbers[3] == 1);
    read_attribute(&input, root, 2, "_ID", 1, ids);
    CHECK(ids[0] == 3);
    read_attribute(&input, root, 2, "SCALE", 3, numbers);
    CHECK(numbers[0] == 4 && numbers[1] == 1 && numbers[2] == 2);
    json_decref(root);
    meso_input_close(&input);

    const MesoInstanceScene holes = {.shape_count = 3, .shapes = (const MesoInstanceShape[]){shapes[1], shapes[1],
                                                                                             shapes[1]}};
    write_glb(test_path(folder, "none.glb"), &holes, MESO_ERR_INPUT);
}

/* ---- USD ---- */

static void expect_text(const MesoInput *input, const char *text)
{
    size_t length = strlen(text);
    for (size_t at = 0; at + length <= input->size; at++)
        if (memcmp(input->data + at, text, length) == 0)
            return;
    fprintf(stderr, "no '%s' in\n%.*s\n", text, (int)input->size, (const char *)input->data);
    CHECK(false);
}

static void test_usda(const TestFolder *folder)
{
    MesoInstanceScene turned = scene;
    turned.z_up = true;
    turned.unit = 0.5f;
    const char *path = test_path(folder, "clip.usda");
    MesoInstanceFrame none = frame;
    MesoUsda *usda;
    MesoOutput *output;
    MesoError error;
    none.count = 0;
    CHECK(meso_usda_begin(&usda, &turned, 24, path, &error) == MESO_OK);
    CHECK(meso_usda_frame(usda, 3, &none, &error) == MESO_OK);
    CHECK(meso_usda_frame(usda, 5, &frame, &error) == MESO_OK);
    CHECK(test_folder_count(folder) == 1);      /* what waits has no name */
    MesoStatus status = meso_output_open(&output, path, &error);
    if (!status)
        status = meso_usda_write(usda, output, &error);
    CHECK(meso_output_finish(output, status, &error) == MESO_OK);
    meso_usda_release(usda);

    MesoInput input;
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    expect_text(&input, "#usda 1.0\n");
    expect_text(&input, "    startTimeCode = 3\n    endTimeCode = 5\n    timeCodesPerSecond = 24\n");
    expect_text(&input, "    metersPerUnit = 0.5\n    upAxis = \"Z\"\n");
    expect_text(&input, "rel prototypes = [</World/Details/Prototypes/scale_1_0>, </World/Details/Prototypes/hole_1>, "
                        "</World/Details/Prototypes/_2nd__scale__2>]\n");
    expect_text(&input, "        int[] protoIndices.timeSamples = {\n            3: [],\n            5: [0, 2, 0],\n");
    expect_text(&input, "        int64[] ids.timeSamples = {\n            3: [],\n            5: [0, 3, 4],\n");
    expect_text(&input, "        int[] primvars:birth.timeSamples = {\n            3: [],\n            5: [-1, 5, 6],"
                        "\n");
    expect_text(&input, "            5: [(1, 2, 3), (4, 5, 6), (7, 8, 9)],\n");
    expect_text(&input, "            5: [(1, 0, 0, 0), (0.7071, 0, 0, 0.7071), (0");
    expect_text(&input, "            5: [(1, 1, 1), (4, 1, 2), (0.5, 0.5, 0.5)],\n");
    expect_text(&input, "        int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]\n");
    meso_input_close(&input);
}

/* Weights of targets are as many as frames by frames: they are refused before they cannot be counted. */
static void test_frames(void)
{
    MesoAnimation *animation;
    MesoError error;
    const MesoInstanceFrame bare = {0, details, placed, square, up};
    CHECK(!meso_animation_begin(&animation, &scene, 24, &error));
    for (int32_t i = 0; i < MESO_ANIMATION_SHAPES; i++)
        CHECK(!meso_animation_frame(animation, i, &bare, &error));
    CHECK(meso_animation_frame(animation, MESO_ANIMATION_SHAPES, &bare, &error) == MESO_ERR_LIMIT);
    meso_animation_release(animation);
}

int main(void)
{
    TestFolder folder = test_folder_make();
    test_rotations();
    test_names();
    test_glb(&folder);
    test_usda(&folder);
    if (getenv("KEEP"))
        puts(folder.path);
    else
        test_folder_remove(&folder);
    test_frames();
    return 0;
}
