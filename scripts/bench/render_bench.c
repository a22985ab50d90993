/*
 * Time to draw: a generated field of bent sweeps, and the .meso files that are
 * given as arguments. 1280 x 720, 4 samples, all AOVs; best of 3. The first
 * drawing of a driver compiles its shaders, and each drawing does so anew.
 */
#include <math.h>
#include <stdio.h>

#include "formats/model/model_file.h"
#include "libcore/base/check.h"
#include "libcore/base/clock.h"
#include "libcore/render/gl/context.h"
#include "libcore/render/picture/painter.h"
#include "libcore/tiling/strand/expansion.h"

enum { FIELD = 128, SIDES = 16, REPEATS = 3 };

typedef struct Field {
    MesoMaterial material;
    MesoSweepColumn columns[SIDES + 1];
    MesoSweptKind kind;
    MesoScene scene;
} Field;

/* Threads that go over and under, on a square of side 2. */
static void make_field(Field *field, MesoArena *arena)
{
    MesoError error;
    uint32_t count = FIELD * FIELD;
    float step = 2.0f / FIELD;
    *field = (Field){.material = {{0.7f, 0.5f, 0.3f}, 0.5f, 0}};
    for (uint32_t i = 0; i <= SIDES; i++) {
        double angle = -2 * 3.14159265358979323846 * (i % SIDES) / SIDES;
        MesoVec2 n = {(float)cos(angle), (float)sin(angle)}, s = {0.3f * n.x, 0.3f * n.y};
        field->columns[i] = (MesoSweepColumn){.start = s, .end = s, .start_normal = n, .end_normal = n,
                                              .joins_next = i < SIDES};
    }
    MesoSweepInstance *instances = MESO_NEW(arena, MesoSweepInstance, count, &error);
    CHECK(instances);
    for (uint32_t i = 0; i < count; i++) {
        float x = -1 + step * (float)(i % FIELD), y = -1 + step * (float)(i / FIELD);
        float lift = (i + i / FIELD) % 2 ? step : -step;
        instances[i] = (MesoSweepInstance){
            {{x, y, 0}, {x + step / 3, y, lift}, {x + 2 * step / 3, y, lift}, {x + step, y, 0}},
            {{0, 0, 1}, {0, 0, 1}}, {{1, 0, 0}, {1, 0, 0}}, i, {1, 1}, 0, 0, 0, {{0}, {0}}};
    }
    uint32_t *ids = MESO_NEW(arena, uint32_t, count, &error);
    CHECK(ids);
    for (uint32_t i = 0; i < count; i++)
        ids[i] = i;
    field->kind = (MesoSweptKind){.column_count = SIDES + 1, .joint_count = SIDES,
                                  .division_count = 12, .instance_count = count};
    field->scene = (MesoScene){.channel_count = 1, .channels = {{"thread", count, NULL}},
        .id_row_count = count, .ids = ids, .material_count = 1, .materials = &field->material,
        .section_scale = step, .thickness = step, .kind_count = 1, .column_count = SIDES + 1,
        .sweep_count = count, .kinds = &field->kind, .columns = field->columns, .sweeps = instances};
    meso_scene_measure(&field->scene);
}

static void measure(const char *name, MesoGlContext *context, const MesoScene *scene)
{
    double best = INFINITY;
    MesoRenderOptions options = {.width = 1280, .height = 720, .samples = 4};
    options.camera = meso_camera_frame_scene(scene, (MesoVec3){0, 1, 0}, 30, 1280.0f / 720);
    for (int i = 0; i < REPEATS; i++) {
        MesoArena arena;
        MesoImage image;
        MesoError error;
        meso_arena_init(&arena);
        double start = meso_seconds();
        CHECK(meso_gl_picture(&image, &arena, context, scene, &options, 0, &error) == MESO_OK);
        best = fmin(best, meso_seconds() - start);
        meso_arena_release(&arena);
    }
    printf("render %s, %u sweeps, 1280x720: %.0f ms (%s)\n", name, scene->sweep_count,
           1e3 * best, context->renderer);
}

static void measure_file(const char *path, MesoGlContext *context)
{
    MesoArena arena;
    MesoInput input;
    MesoModel model;
    MesoScene scene;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_model_read(&model, NULL, &arena, &input, &error) == MESO_OK);
    CHECK(meso_model_expand(&scene, NULL, &arena, &model, 0, &error) == MESO_OK);
    measure(path, context, &scene);
    meso_input_close(&input);
    meso_arena_release(&arena);
}

int main(int argc, char **argv)
{
    MesoArena arena;
    MesoGlContext context;
    MesoError error;
    Field field;
    meso_arena_init(&arena);
    CHECK(meso_gl_context_init(&context, "osmesa", 0, &error) == MESO_OK);
    make_field(&field, &arena);
    measure("field", &context, &field.scene);
    for (int i = 1; i < argc; i++)
        measure_file(argv[i], &context);
    meso_gl_context_release(&context);
    meso_arena_release(&arena);
    return 0;
}
