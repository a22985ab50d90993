/* Animated glTF: morph targets, skins and nodes at known times, and every truncation of the file. */
#include "formats/mesh/gltf/gltf_clip.h"

#include <math.h>

#include "formats/mesh/gltf/gltf_clip_fixture.h"
#include "formats/mesh/mesh_kinds.h"

static uint8_t bytes[8192];

static MesoGltfClip *open_clip(const char *interpolation)
{
    MesoInput input;
    MesoError error;
    MesoGltfClip *clip;
    meso_input_wrap(&input, "a.glb", bytes, make_animated_glb(bytes, interpolation));
    if (meso_gltf_clip_open(&clip, &input, &error) != MESO_OK) {
        fprintf(stderr, "%s\n", error.message);
        CHECK(false);
    }
    return clip;
}

static void expect_at(const MesoGltfClip *clip, double time, uint32_t vertex, float x, float y)
{
    MesoVec3 positions[6];
    MesoError error;
    CHECK(meso_gltf_clip_positions(clip, time, positions, &error) == MESO_OK);
    MesoVec3 p = positions[vertex];
    if (fabsf(p.x - x) > 1e-6f || fabsf(p.y - y) > 1e-6f || p.z != 0) {
        fprintf(stderr, "at %g vertex %u is at (%g, %g, %g), not at (%g, %g, 0)\n", time, vertex, (double)p.x,
                (double)p.y, (double)p.z, (double)x, (double)y);
        CHECK(false);
    }
}

static void test_linear(void)
{
    MesoGltfClip *clip = open_clip("LINEAR");
    CHECK(meso_gltf_clip_vertex_count(clip) == 6 && meso_gltf_clip_duration(clip) == 2);
    expect_at(clip, 0, 2, 0, 1);
    expect_at(clip, 0.5, 2, 1, 1.5f);
    expect_at(clip, 1, 2, 2, 2);
    expect_at(clip, 1.75, 2, 3.5f, 1.25f);
    expect_at(clip, 9, 1, 5, 0);
    expect_at(clip, 0, 3, 0, 0);            /* its node is a hundred away, which does not count */
    expect_at(clip, 0, 4, 1, 0);
    expect_at(clip, 0.5, 4, 0.5f + 0.5f * HALF_ROOT, 0.5f * HALF_ROOT);     /* 45 degrees: turned at constant speed */
    expect_at(clip, 1, 4, 0.5f, 0.5f);
    expect_at(clip, 1, 5, 0, 0.5f);
    expect_at(clip, 2, 5, 0, 0.5f);
    meso_gltf_clip_release(clip);
}

/* A step keeps its value to the next key; the other channels go on as before. */
static void test_step(void)
{
    MesoGltfClip *clip = open_clip("STEP");
    expect_at(clip, 0.99, 2, 1.98f, 1);
    expect_at(clip, 1, 2, 2, 2);
    expect_at(clip, 1.5, 2, 3, 2);
    expect_at(clip, 2, 2, 4, 1);
    meso_gltf_clip_release(clip);
}

/* Three values a key are wanted there. */
static void test_broken(void)
{
    MesoInput input;
    MesoError error;
    MesoGltfClip *clip;
    size_t size = make_animated_glb(bytes, "CUBICSPLINE");
    meso_input_wrap(&input, "a.glb", bytes, size);
    CHECK(meso_gltf_clip_open(&clip, &input, &error) == MESO_ERR_INPUT && !clip);
    CHECK_TEXT(error.message, "a.glb: broken glTF: accessor 3 is not of 9 elements with 1 numbers");
    size = make_animated_glb(bytes, "LINEAR");
    for (size_t cut = 1; cut < size; cut += 7) {
        uint8_t *exact = malloc(cut);
        CHECK(exact);
        memcpy(exact, bytes, cut);
        meso_input_wrap(&input, "a.glb", exact, cut);
        CHECK(meso_gltf_clip_open(&clip, &input, &error) == MESO_ERR_INPUT && !clip);
        free(exact);
    }
    /* a time that is no number, a weight that is none, and joint 7 of 2 */
    uint8_t *binary = bytes + size - 416;
    const float nan = NAN;
    const uint16_t seven = 7;
    memcpy(binary + 72 + 4, &nan, sizeof nan);
    meso_input_wrap(&input, "a.glb", bytes, size);
    CHECK(meso_gltf_clip_open(&clip, &input, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.glb: broken glTF: times of an animation do not ascend");
    make_animated_glb(bytes, "LINEAR");
    memcpy(binary + 392, &seven, sizeof seven);
    CHECK(meso_gltf_clip_open(&clip, &input, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.glb: broken glTF: a vertex follows joint 7 of 2");
    make_animated_glb(bytes, "LINEAR");
    memcpy(binary + 84 + 4, &nan, sizeof nan);
    CHECK(meso_gltf_clip_open(&clip, &input, &error) == MESO_OK);
    MesoVec3 positions[6];
    CHECK(meso_gltf_clip_positions(clip, 1, positions, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.glb: at 1 s, vertex 1: coordinates that are not finite, or beyond 1e18");
    meso_gltf_clip_release(clip);
}

/* The mesh that is read has the same vertices. */
static void test_mesh(void)
{
    MesoArena arena;
    MesoInput input;
    MesoError error;
    MesoPolygonMesh mesh;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "a.glb", bytes, make_animated_glb(bytes, "LINEAR"));
    CHECK(meso_gltf_read(&mesh, &arena, &input, 1, &error) == MESO_OK);
    CHECK(mesh.vertex_count == 6 && mesh.face_count == 2 && mesh.corners[5] == 5);
    meso_arena_release(&arena);
}

int main(void)
{
    test_linear();
    test_step();
    test_broken();
    test_mesh();
    return 0;
}
