/* Sketches alone and in a scene that was there: what their parts are, lie and measure. Letters; colours of ids. */
#include "libcore/sketch/sketch.h"

#include <string.h>

#include "libcore/base/check.h"
#include "libcore/sketch/id_color.h"
#include "libcore/scene/parts.h"
#include "libcore/sketch/stroke_font.h"

static const float RED[3] = {1, 0, 0}, BLUE[3] = {0, 0, 1};
static const MesoVec3 ORIGIN = {0, 0, 0}, RIGHT = {1, 0, 0}, UP = {0, 1, 0};

static MesoArena arena;
static MesoError error;

/* Half of a square, a bar, and nothing. */
static MesoSketch draw(void)
{
    const MesoVec3 corners[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, up[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    MesoSketch sketch = {0};
    meso_sketch_part(&sketch, "half", RED);
    meso_sketch_face(&sketch, 3, corners, up);
    meso_sketch_part(&sketch, "bar", BLUE);
    meso_sketch_bar(&sketch, ORIGIN, (MesoVec3){0, 0, 3}, 0.25f);
    meso_sketch_bar(&sketch, RIGHT, RIGHT, 0.25f);
    meso_sketch_part(&sketch, "none", RED);
    return sketch;
}

static void test_alone(void)
{
    MesoScene scene = {0};
    MesoSketch sketch = draw();
    CHECK(meso_sketch_finish(&sketch, &scene, &arena, &error) == MESO_OK && sketch.part_count == 0);
    CHECK(scene.channel_count == 1 && strcmp(scene.channels[0].name, "part") == 0 && scene.channels[0].count == 3);
    CHECK(strcmp(scene.channels[0].names[1], "bar") == 0 && strcmp(scene.material_names[2], "none") == 0);
    CHECK(scene.body_count == 1 && scene.placed_count == 1 && scene.sweep_count == 1 && scene.kind_count == 1);
    CHECK(meso_scene_id(&scene, scene.placed[0].ids, 0) == 0 && meso_scene_id(&scene, scene.sweeps[0].ids, 0) == 1);
    CHECK(scene.materials[scene.kinds[0].start_material].albedo[2] == 1);
    CHECK(scene.box.high.z >= 3 && scene.box.high.x >= 1);
}

/* In one whose drawings are of another size, with a channel without names, one with, and one without channels. */
static void test_added(void)
{
    for (int channels = 0; channels <= 2; channels++) {
        const char *names[1] = {"thing"};
        uint32_t ids[2] = {6, 0};
        MesoMaterial material = {{1, 1, 1}, 1, 0};
        const char *material_names[1] = {"white"};
        MesoScene scene = {.channel_count = (uint32_t)channels, .channels = {{"slot", 7, NULL}, {"tile", 1, names}},
                           .id_row_count = 1, .ids = ids, .section_scale = 4, .materials = &material,
                           .material_count = 1,
                           .material_names = material_names};
        MesoSketch sketch = draw();
        CHECK(meso_sketch_finish(&sketch, &scene, &arena, &error) == MESO_OK);
        CHECK(scene.channel_count == (channels ? (uint32_t)channels : 1) && scene.id_row_count == 4);
        uint32_t row = scene.sweeps[0].ids;
        CHECK(row == 2 && meso_scene_id(&scene, row, 0) == (channels ? 8u : 2u));
        CHECK(channels == 0 || meso_scene_id(&scene, 0, 0) == 6);
        if (channels == 0)
            CHECK(strcmp(scene.channels[0].names[0], "shown") == 0);
        if (channels == 2)
            CHECK(meso_scene_id(&scene, row, 1) == 2 && strcmp(scene.channels[1].names[2], "bar") == 0);
        CHECK(scene.kinds[0].start_material == 2);
        /* 0.25 from its line, whatever the drawings' size */
        MesoMeshVertex vertices[64];
        MesoSceneParts parts;
        CHECK(meso_scene_parts_init(&parts, &arena, &scene, &error) == MESO_OK && parts.vertex_begin[1] <= 64);
        meso_scene_vertices(&parts, 0, 1, vertices);
        for (uint64_t v = 0; v < parts.vertex_begin[1]; v++)
            CHECK(fabsf(hypotf(vertices[v].position.x, vertices[v].position.y) - 0.25f) < 1e-6f);
    }
}

/* A minus is one stroke: 4 wide and a stroke's width, and as high. A box stands for what is not ASCII. */
static void test_text(void)
{
    MesoScene scene = {0};
    MesoSketch sketch = {0};
    meso_sketch_part(&sketch, "text", RED);
    meso_sketch_text(&sketch, ORIGIN, RIGHT, UP, 2, " -");
    CHECK(sketch.face_count == 1 && sketch.normals[0].z == 1);
    float low = INFINITY, high = -INFINITY;
    for (uint32_t v = 0; v < sketch.vertex_count; v++) {
        low = fminf(low, sketch.positions[v].x);
        high = fmaxf(high, sketch.positions[v].x);
        CHECK(fabsf(fabsf(sketch.positions[v].y - 2 * (5 - MESO_STROKE_BASE)) - MESO_STROKE_WIDTH) < 1e-5f);
    }
    CHECK(fabsf(low - 2 * (MESO_STROKE_ADVANCE - MESO_STROKE_WIDTH / 2)) < 1e-5f);
    CHECK(fabsf(high - low - 2 * (4 + MESO_STROKE_WIDTH)) < 1e-5f);
    CHECK(meso_sketch_finish(&sketch, &scene, &arena, &error) == MESO_OK);
    CHECK(meso_stroke_count("a\xc3\xa4\xe2\x82\xac") == 3);
    CHECK(strcmp(meso_stroke_letter(200), meso_stroke_letter(127)) == 0 && *meso_stroke_letter(200));
    for (unsigned char c = '!'; c < 127; c++)
        for (const char *p = meso_stroke_letter(c); *p; p++)
            CHECK(*p == ' ' || (*p >= '0' && *p <= '8'));
}

/* Of 64 things no two are alike. */
static void test_colors(void)
{
    float colors[64][3];
    for (uint32_t i = 0; i < 64; i++) {
        meso_id_color(colors[i], i);
        float most = 0;
        for (int c = 0; c < 3; c++) {
            CHECK(colors[i][c] >= 0 && colors[i][c] <= 1);
            most = fmaxf(most, colors[i][c]);
        }
        CHECK(most > 0.2f);
        for (uint32_t j = 0; j < i; j++)
            CHECK(fabsf(colors[i][0] - colors[j][0]) + fabsf(colors[i][1] - colors[j][1]) +
                  fabsf(colors[i][2] - colors[j][2]) > 0.005f);
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_alone();
    test_added();
    test_text();
    test_colors();
    meso_arena_release(&arena);
    return 0;
}
