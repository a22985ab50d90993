/*
 * Cameras of glTF: of both kinds, under turned, moved and sized nodes, by names, in .gltf and .glb; what is broken, and
 * names that are not there. View matrices there and back, and what is none.
 */
#include "formats/camera/gltf_camera.h"

#include <stdio.h>
#include <string.h>

#include "formats/camera/view_matrices.h"
#include "libcore/base/check.h"

static MesoArena arena;
static MesoError error;

static MesoStatus read_bytes(MesoCamera *camera, const void *data, size_t size, const char *name)
{
    MesoInput input;
    meso_input_wrap(&input, "some.glb", data, size);
    error = (MesoError){0};
    return meso_gltf_camera_read(camera, &arena, &input, name, &error);
}

static MesoStatus read_text(MesoCamera *camera, const char *text, const char *name)
{
    return read_bytes(camera, text, strlen(text), name);
}

static bool near(MesoVec3 a, float x, float y, float z)
{
    return meso_vec3_length(meso_vec3_sub(a, (MesoVec3){x, y, z})) < 1e-5f;
}

static MesoVec3 forward(const MesoCamera *c)
{
    return meso_vec3_unit(meso_vec3_sub(c->target, c->eye), (MesoVec3){0, 0, 0});
}

/* A quarter turn about y, under a move and a size of 2; and one of a matrix that looks down. */
static const char SCENE[] =
    "{\"asset\": {\"version\": \"2.0\"}, \"cameras\": [{\"type\": \"perspective\", \"perspective\": {\"yfov\": 0.5, "
    "\"znear\": 1}},"
    " {\"name\": \"flat\", \"type\": \"orthographic\", \"orthographic\": {\"xmag\": 3, \"ymag\": 2, \"znear\": 0, "
    "\"zfar\": 9}}],"
    " \"nodes\": [{\"name\": \"mesh\"}, {\"name\": \"side\", \"camera\": 0, \"translation\": [1, 0, 2]},"
    " {\"rotation\": [0, 0.70710678, 0, 0.70710678], \"scale\": [2, 2, 2], \"translation\": [10, 0, 0], \"children\": "
    "[1]},"
    " {\"name\": \"top\", \"camera\": 1, \"matrix\": [1,0,0,0, 0,0,-1,0, 0,1,0,0, 5,6,7,1]}]}";

static void check_scene(const void *data, size_t size)
{
    MesoCamera c;
    CHECK(read_bytes(&c, data, size, NULL) == MESO_OK);
    CHECK(near(c.eye, 10 + 4, 0, -2) && near(forward(&c), -1, 0, 0) && near(c.up, 0, 1, 0));
    CHECK(fabsf(c.fov_degrees - 28.6478897f) < 1e-4f && c.height == 0);
    for (int i = 0; i < 2; i++) {
        CHECK(read_bytes(&c, data, size, i ? "flat" : "top") == MESO_OK);
        CHECK(near(c.eye, 5, 6, 7) && near(forward(&c), 0, -1, 0) && near(c.up, 0, 0, -1) && c.height == 4);
    }
    CHECK(read_bytes(&c, data, size, "none") == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "some.glb") && strstr(error.message, "no camera 'none'; there are 'side', 'top'"));
}

static void test_scene(void)
{
    static uint8_t glb[2048];
    const uint32_t text = (uint32_t)strlen(SCENE), words[5] = {0x46546c67, 2, 20 + text, text, 0x4e4f534a};
    memcpy(glb, words, sizeof words);
    memcpy(glb + 20, SCENE, text);
    check_scene(SCENE, text);
    check_scene(glb, 20 + text);
    for (size_t size = 0; size < 20 + text; size++) {
        MesoCamera c;
        CHECK(read_bytes(&c, glb, size, NULL) == MESO_ERR_INPUT);
    }
}

static void test_wrong_scenes(void)
{
    static const struct {
        const char *text, *words;
    } wrong[] = {
        {"{\"nodes\": []}", "no node has a camera"},
        {"{\"nodes\": [{\"camera\": 0}]}", "camera"},
        {"{\"nodes\": [{\"camera\": 0}], \"cameras\": [{\"type\": \"fisheye\"}]}", "fisheye"},
        {"{\"nodes\": [{\"camera\": 0}], \"cameras\": [{\"type\": \"perspective\"}]}", "yfov"},
        {"{\"nodes\": [{\"camera\": 0}], \"cameras\": [{\"type\": \"perspective\", \"perspective\": {\"yfov\": 4}}]}",
         "yfov"},
        {"{\"nodes\": [{\"camera\": 0, \"children\": [1]}, {\"children\": [0]}], \"cameras\": [{\"type\": "
         "\"perspective\", "
         "\"perspective\": {\"yfov\": 1}}]}", "in a circle"},
        {"{\"nodes\": [{\"camera\": 0, \"children\": [7]}], \"cameras\": [{\"type\": \"perspective\", "
         "\"perspective\": {\"yfov\": 1}}]}", "children"},
        {"{\"nodes\": [{\"camera\": 0}], \"cameras\": [{\"type\": \"orthographic\", \"orthographic\": {\"ymag\": 0}}]}",
         "no height"},
        {"[]", "some.glb"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        MesoCamera c;
        CHECK(read_text(&c, wrong[i].text, NULL) == MESO_ERR_INPUT);
        CHECK(strstr(error.message, wrong[i].words));
    }
}

/* As GL has it: column by column. */
static void put_matrix(float out[16], const MesoCamera *camera)
{
    MesoView view;
    CHECK(meso_view_build(&view, camera, &error) == MESO_OK);
    const MesoVec3 axes[3] = {view.right, view.up, meso_vec3_scale(view.forward, -1)};
    for (int a = 0; a < 3; a++) {
        out[a] = axes[a].x, out[4 + a] = axes[a].y, out[8 + a] = axes[a].z;
        out[12 + a] = -meso_vec3_dot(axes[a], view.eye);
    }
    out[3] = out[7] = out[11] = 0;
    out[15] = 1;
}

static void test_matrices(void)
{
    const MesoCamera usual = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 35, 0};
    const MesoCamera cameras[2] = {{{1, 2, 3}, {0, 0.5f, 0}, {0, 1, 0}, 30, 0},
                                   {{-4, 5, 1}, {2, 0, 0}, {0, 0, 1}, 30, 0}};
    float matrices[32];
    MesoCameraKey *keys;
    MesoInput input;
    uint32_t count;
    for (int i = 0; i < 2; i++)
        put_matrix(matrices + 16 * i, &cameras[i]);
    meso_input_wrap(&input, "some.bin", matrices, sizeof matrices);
    CHECK(meso_view_matrices_read(&keys, &count, &arena, &input, &usual, &error) == MESO_OK && count == 2);
    for (int i = 0; i < 2; i++) {
        const MesoCamera *c = &keys[i].camera;
        MesoVec3 f = forward(&cameras[i]);
        CHECK(keys[i].frame == i + 1 && near(c->eye, cameras[i].eye.x, cameras[i].eye.y, cameras[i].eye.z));
        CHECK(near(forward(c), f.x, f.y, f.z) && c->fov_degrees == 35 && meso_vec3_dot(c->up, cameras[i].up) > 0.5f);
    }
    for (size_t size = 0; size < sizeof matrices; size++) {
        meso_input_wrap(&input, "some.bin", matrices, size);
        CHECK(size == 64 || meso_view_matrices_read(&keys, &count, &arena, &input, &usual, &error) == MESO_ERR_INPUT);
    }
    meso_input_wrap(&input, "some.bin", matrices, sizeof matrices);
    for (int i = 16; i < 32; i++) {     /* twice as long, mirrored or sheared, or not of a view at all */
        float was = matrices[i];
        matrices[i] = i % 4 == 3 ? 0.5f : i < 28 ? was + 0.7f : NAN;
        CHECK(meso_view_matrices_read(&keys, &count, &arena, &input, &usual, &error) == MESO_ERR_INPUT);
        CHECK(strstr(error.message, "some.bin: frame 2 is not a view matrix"));
        matrices[i] = was;
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_scene();
    test_wrong_scenes();
    test_matrices();
    meso_arena_release(&arena);
    return 0;
}
