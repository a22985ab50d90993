/*
 * The renderer on one bar of eight sides along x, closed at one end by a cap:
 *
 *        ________________
 *      (|________________|      cap at x = -1, bar from -1 to 1
 *
 * seen from +z. Every AOV is compared with the geometry's own numbers.
 */
#include <math.h>
#include <string.h>

#include "libcore/base/arena.h"
#include "libcore/base/check.h"
#include "libcore/render/gl/context.h"
#include "libcore/render/gl/gl_visibility.h"
#include "libcore/render/gl/renderer_name.h"
#include "libcore/render/picture/painter.h"

enum { SIDES = 64, WIDTH = 160, HEIGHT = 90 };

static const float RADIUS = 0.25f;

typedef struct Bar {
    MesoMaterial materials[2];
    MesoSweepColumn columns[SIDES + 1];
    MesoSweptKind kinds[2];
    MesoSweepInstance instances[2];
    uint32_t ids[4];
    MesoScene scene;
} Bar;

static void make_bar(Bar *bar)
{
    *bar = (Bar){0};
    bar->materials[0] = (MesoMaterial){{0.75f, 0.25f, 0.125f}, 0.5f, 0};
    bar->materials[1] = (MesoMaterial){{0.125f, 0.25f, 0.75f}, 0.5f, 0};
    for (uint32_t i = 0; i <= SIDES; i++) {     /* clockwise around the tangent */
        double angle = -2 * 3.14159265358979323846 * (i % SIDES) / SIDES;
        MesoVec2 n = {(float)cos(angle), (float)sin(angle)};
        MesoVec2 s = {RADIUS * n.x, RADIUS * n.y};
        bar->columns[i] = (MesoSweepColumn){s, s, n, n, (float)i / SIDES, i < SIDES, .absent = 0};
    }
    bar->kinds[0] = (MesoSweptKind){.column_count = SIDES + 1, .joint_count = SIDES,
        .division_count = 9, .instance_count = 1, .start_material = 0, .end_material = 1};
    bar->kinds[1] = (MesoSweptKind){.column_count = SIDES + 1, .joint_count = SIDES,
        .division_count = 9, .instance_begin = 1, .instance_count = 1, .cap = true};
    bar->instances[0] = (MesoSweepInstance){
        {{-1, 0, 0}, {-0.25f, 0, 0}, {0.25f, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 1, 0}},
        {{1, 0, 0}, {1, 0, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}};
    bar->instances[1] = (MesoSweepInstance){
        {{-1, 0, 0}, {-1.1f, 0, 0}, {-1.1f, 0, 0}, {-1.1f, 0, 0}}, {{0, 1, 0}, {0, 1, 0}},
        {{-1, 0, 0}, {-1, 0, 0}}, 1, {1, 1}, 0, 0, 0, {{0}, {0}}};
    const uint32_t ids[4] = {40, 6, 41, 8};
    memcpy(bar->ids, ids, sizeof ids);
    bar->scene = (MesoScene){.channel_count = 2, .channels = {{"slot", 42, NULL}, {"tile", 9, NULL}},
        .material_count = 2, .materials = bar->materials, .id_row_count = 2, .ids = bar->ids,
        .section_scale = 1, .thickness = 0.5f, .kind_count = 2, .column_count = SIDES + 1,
        .sweep_count = 2, .kinds = bar->kinds, .columns = bar->columns, .sweeps = bar->instances};
    meso_scene_measure(&bar->scene);
}

/* At 10 units the picture is 4 x 2.25 units wide: 40 pixels a unit. */
static MesoRenderOptions look(uint32_t samples)
{
    float fov = 2 * atanf(1.125f / 10) * (float)(180 / 3.14159265358979323846);
    return (MesoRenderOptions){.width = WIDTH, .height = HEIGHT, .samples = samples,
                               .camera = {{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, fov}};
}

static MesoImage draw_by(bool bends, MesoArena *arena, const MesoScene *scene, const MesoRenderOptions *options,
                         const char *maker, uint32_t threads)
{
    MesoGlContext context;
    MesoError error = {0};
    MesoImage image = {0};
    MesoStatus status = meso_gl_context_init(&context, maker, threads, &error);
    context.bends = context.bends || bends;
    if (status || meso_gl_picture(&image, arena, &context, scene, options, threads, &error))
        fprintf(stderr, "%s\n", error.message);
    CHECK(error.status == MESO_OK);
    meso_gl_context_release(&context);
    return image;
}

static MesoImage draw(MesoArena *arena, const MesoScene *scene, const MesoRenderOptions *options,
                      const char *maker, uint32_t threads)
{
    return draw_by(false, arena, scene, options, maker, threads);
}

static bool same_pixels(const MesoImage *a, const MesoImage *b)
{
    size_t n = (size_t)a->width * a->height;
    return a->width == b->width && a->height == b->height
        && memcmp(a->color, b->color, 16 * n) == 0 && memcmp(a->depth, b->depth, 4 * n) == 0
        && memcmp(a->normal, b->normal, 12 * n) == 0 && memcmp(a->albedo, b->albedo, 12 * n) == 0
        && memcmp(a->ids[0], b->ids[0], 4 * n) == 0 && memcmp(a->ids[1], b->ids[1], 4 * n) == 0;
}

/* Pixel (x, y) sees the point ((x + 0.5 - 80) / 40, (45 - y - 0.5) / 40) of the plane z = 0. */
static void test_values(const MesoImage *image)
{
    size_t covered = 0;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            size_t i = (size_t)y * WIDTH + x;
            bool empty = image->ids[0][i] == 0;
            CHECK(empty == (image->ids[1][i] == 0) && empty == (isinf(image->depth[i]) != 0));
            CHECK(empty == (image->normal[3 * i] == 0 && image->normal[3 * i + 1] == 0
                            && image->normal[3 * i + 2] == 0));
            CHECK(image->color[4 * i + 3] >= 0 && image->color[4 * i + 3] <= 1);
            covered += !empty;

            /* The bar's front, by the ray through the pixel. */
            double px = (x + 0.5 - 80) / 40, py = (45 - (y + 0.5)) / 40, slope = py / 10;
            double a = 1 + slope * slope, b = -10 * slope * slope;
            double c = 100 * slope * slope - (double)RADIUS * RADIUS;
            double z = (-b + sqrt(fmax(b * b - a * c, 0))) / a;
            double world_x = px * (10 - z) / 10;
            bool inside = b * b - a * c > 0.002 && fabs(world_x) < 0.98;
            if (!inside)
                continue;
            CHECK(image->ids[0][i] == 41 && image->ids[1][i] == 7);
            CHECK(fabs(image->depth[i] - (10 - z)) < 0.25 / 40 * (double)RADIUS / z + 1e-3);
            CHECK(fabs(image->normal[3 * i]) < 1e-3);
            CHECK(fabs(image->normal[3 * i + 1] - (10 - z) * slope / (double)RADIUS) < 0.05);
            CHECK(image->normal[3 * i + 2] > 0);
            double v = (world_x + 1) / 2, w = v * v * (3 - 2 * v);
            /* Handles of a quarter: B(v) is not v, so ask only for the middle and the order. */
            CHECK(fabs(image->albedo[3 * i + 1] - 0.25) < 1e-3);
            if (fabs(world_x) < 0.01)
                CHECK(fabs(image->albedo[3 * i] - (0.75 - 0.625 * w)) < 0.02);
            CHECK(image->albedo[3 * i] + image->albedo[3 * i + 2] > 0.87f);
            CHECK(image->color[4 * i + 3] == 1 && image->color[4 * i] > 0);
        }
    /* The bar's 80 x 20 pixels, nearer than the plane by its radius, and the cap's dome. */
    CHECK(covered > 1600 && covered < 1800);
    size_t cap = (size_t)(HEIGHT / 2) * WIDTH + 37;     /* world x = -1.06 */
    CHECK(image->ids[0][cap] == 42 && image->ids[1][cap] == 9 && image->albedo[3 * cap] == 0.75f);
    CHECK(image->normal[3 * cap] < 0);
}

/*
 * Thinned geometry changes a picture by less than half a pixel; and the row of
 * the top is first: a bar above the axis is seen in the upper half.
 */
static void test_detail(MesoArena *arena)
{
    Bar bar;
    make_bar(&bar);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 4; k++) {
            bar.instances[i].p[k].x += 0.5f;
            bar.instances[i].p[k].y += 0.5f;
        }
    meso_scene_measure(&bar.scene);
    MesoRenderOptions options = look(1);
    MesoImage thin = draw(arena, &bar.scene, &options, "osmesa", 0);
    options.full_detail = true;
    MesoImage full = draw(arena, &bar.scene, &options, "osmesa", 0);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        if (thin.ids[0][i] && full.ids[0][i] && full.normal[3 * i + 2] > 0.2f)
            CHECK(fabsf(thin.depth[i] - full.depth[i]) < 0.5f / 40 / full.normal[3 * i + 2]);
    CHECK(!same_pixels(&thin, &full));
    CHECK(full.ids[0][(HEIGHT / 2 - 20) * WIDTH + WIDTH / 2 + 50] == 41);
    CHECK(full.ids[0][(HEIGHT / 2 + 20) * WIDTH + WIDTH / 2 + 50] == 0);
    CHECK(full.ids[0][(HEIGHT / 2 - 20) * WIDTH + WIDTH / 2 - 30] == 0);
}

/* An image of several windows is the same as one drawn at once, but for rounding at the seams. */
static void test_windows(MesoArena *arena)
{
    Bar bar;
    make_bar(&bar);
    MesoRenderOptions options = look(1);
    options.width = 2400;
    options.height = 64;
    options.camera.fov_degrees = 1;
    MesoImage image = draw(arena, &bar.scene, &options, "osmesa", 0);
    float pixel = 2 * tanf((float)(3.14159265358979323846 / 360)) * 10 / 64;
    for (uint32_t x = 0; x < 2400; x++) {
        float world_x = ((float)x + 0.5f - 1200) * pixel * (10 - RADIUS) / 10;
        if (fabsf(world_x) < 0.98f)
            CHECK(image.ids[0][32 * 2400 + x] == 41);
        else if (fabsf(world_x) > 1.2f)
            CHECK(image.ids[0][32 * 2400 + x] == 0);
    }
}

/* A million units away, where floats are a sixteenth apart, the picture of what fits those is the same. */
static void test_far(MesoArena *arena, const MesoImage *expected)
{
    const MesoVec3 place = {1e6f + 8, -1e6f, 5e5f};
    Bar bar;
    make_bar(&bar);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 4; k++)
            bar.instances[i].p[k] = meso_vec3_add(bar.instances[i].p[k], place);
    meso_scene_measure(&bar.scene);
    MesoRenderOptions options = look(1);
    options.camera.eye = meso_vec3_add(options.camera.eye, place);
    options.camera.target = meso_vec3_add(options.camera.target, place);
    MesoImage image = draw(arena, &bar.scene, &options, "osmesa", 0);
    size_t other = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        other += image.ids[0][i] != expected->ids[0][i];
        if (image.ids[0][i] && image.ids[0][i] == expected->ids[0][i])
            CHECK(fabsf(image.depth[i] - expected->depth[i]) < 1e-3f);
    }
    CHECK(other < 10);

    options.camera = meso_camera_frame_scene(&bar.scene, (MesoVec3){0, 1, 0}, 30, 16 / 9.0f);
    image = draw(arena, &bar.scene, &options, "osmesa", 0);
    size_t covered = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        covered += image.ids[0][i] != 0;
    CHECK(covered > 2000);      /* the bar reaches over most of the width */
}

/* A square of two units in the plane z = 0: red on its left, green on its right; its colours times the material's. */
static void test_colors(MesoArena *arena)
{
    static const MesoVec3 positions[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    static const MesoVec3 normals[4] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    static const MesoMeshColor colors[4] = {{255, 0, 51}, {0, 255, 51}, {0, 255, 51}, {255, 0, 51}};
    static const uint32_t corners[4] = {0, 1, 2, 3};
    Bar bar;
    make_bar(&bar);
    MesoBody body = {4, 1, 4, positions, normals, NULL, colors, corners};
    MesoPlacedBody placed = {.material = 0, .ids = 1};
    bar.scene.kind_count = bar.scene.sweep_count = 0;
    bar.scene.body_count = bar.scene.placed_count = 1;
    bar.scene.bodies = &body;
    bar.scene.placed = &placed;
    meso_scene_measure(&bar.scene);
    for (uint32_t samples = 1; samples <= 4; samples += 3) {
        MesoRenderOptions options = look(samples);
        MesoImage image = draw(arena, &bar.scene, &options, "osmesa", 0);
        size_t covered = 0;
        for (uint32_t x = 0; x < WIDTH; x++) {
            size_t i = (size_t)(HEIGHT / 2) * WIDTH + x;
            float share = ((float)x + 0.5f - 40) / 80;
            if (!image.ids[0][i])
                continue;
            covered++;
            CHECK(image.ids[0][i] == 42 && image.ids[1][i] == 9 && fabsf(image.depth[i] - 10) < 1e-4f);
            CHECK(fabsf(image.albedo[3 * i] - 0.75f * (1 - share)) < 2e-3f);
            CHECK(fabsf(image.albedo[3 * i + 1] - 0.25f * share) < 2e-3f);
            CHECK(fabsf(image.albedo[3 * i + 2] - 0.125f * 0.2f) < 1e-4f);
        }
        CHECK(covered == 80);
        size_t left = (size_t)(HEIGHT / 2) * WIDTH + 45, right = left + 70;
        CHECK(image.color[4 * left] > image.color[4 * right] && image.color[4 * left + 1] < image.color[4 * right + 1]);
    }

    /* A scene without channels is drawn as well. */
    bar.scene.channel_count = 0;
    MesoRenderOptions options = look(1);
    MesoImage image = draw(arena, &bar.scene, &options, "osmesa", 0);
    CHECK(image.channel_count == 0 && !isinf(image.depth[(size_t)(HEIGHT / 2) * WIDTH + WIDTH / 2]));
}

static void test_nothing(MesoArena *arena)
{
    Bar bar;
    make_bar(&bar);
    bar.scene.kind_count = bar.scene.sweep_count = 0;
    meso_scene_measure(&bar.scene);
    MesoRenderOptions options = look(4);
    MesoImage image = draw(arena, &bar.scene, &options, "osmesa", 0);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        CHECK(image.ids[0][i] == 0 && isinf(image.depth[i]) && image.color[4 * i + 3] == 0);
}

static void test_refusals(MesoArena *arena)
{
    Bar bar;
    make_bar(&bar);
    MesoGlContext context;
    MesoError error;
    MesoImage image;
    CHECK(meso_gl_context_init(&context, "glx", 0, &error) == MESO_ERR_USAGE);
    CHECK(meso_gl_context_init(&context, "osmesa", 0, &error) == MESO_OK);
    MesoRenderOptions options = look(2);
    CHECK(meso_gl_picture(&image, arena, &context, &bar.scene, &options, 0, &error) == MESO_ERR_USAGE);
    options = look(1);
    options.width = 16385;
    CHECK(meso_gl_picture(&image, arena, &context, &bar.scene, &options, 0, &error) == MESO_ERR_LIMIT);
    options = look(1);
    options.camera.eye.z = 0;
    CHECK(meso_gl_picture(&image, arena, &context, &bar.scene, &options, 0, &error) == MESO_ERR_USAGE);
    options.camera.eye.z = NAN;
    CHECK(meso_gl_picture(&image, arena, &context, &bar.scene, &options, 0, &error) == MESO_ERR_USAGE);
    meso_gl_context_release(&context);
    CHECK(meso_gl_is_software("llvmpipe (LLVM 15.0.6, 256 bits)") && !meso_gl_is_software("NVIDIA H200"));
    CHECK(meso_gl_is_software("virgl (LLVMPIPE (LLVM 15.0.6, 256 bits))"));
    CHECK(meso_gl_is_software("D3D12 (Microsoft Basic Render Driver)"));
    CHECK(!meso_gl_is_software("AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.7)"));
}

/* A framebuffer with a place for each sample, two targets of four words and a depth; and what is read from it. */
static void test_bytes(void)
{
    const size_t pixel = 4 * (2 * 4 + 1 + 2 * 4);
    CHECK(meso_gl_window_side(16) == 256 && meso_gl_window_side(1) == 1024);
    CHECK(meso_gl_window_bytes(64, 48, 1) == pixel * 64 * 48);
    CHECK(meso_gl_window_bytes(64, 48, 16) == pixel * 16 * 64 * 48);
    CHECK(meso_gl_window_bytes(1280, 720, 4) == pixel * 1024 * 1024);
    CHECK(meso_gl_window_bytes(16384, 100, 1) == pixel * 1024 * 100);
}

/* EGL may offer nothing; where it is software, it agrees, for another number of threads too. */
static void test_makers(MesoArena *arena, const MesoScene *scene, const MesoImage *expected)
{
    MesoGlContext context;
    if (meso_gl_context_init(&context, "egl", 0, NULL) != MESO_OK)
        return;
    bool software = meso_gl_is_software(context.renderer);
    meso_gl_context_release(&context);
    MesoRenderOptions options = look(4);
    MesoImage image = draw(arena, scene, &options, "egl", 2);
    if (software)
        CHECK(same_pixels(&image, expected));
    else
        test_values(&image);
    CHECK(meso_gl_context_init(&context, "auto", 0, NULL) == MESO_OK);
    CHECK(meso_gl_is_software(context.renderer) || !software);
    meso_gl_context_release(&context);
    MesoStatus status = meso_gl_context_init(&context, "gpu", 0, NULL);
    CHECK(status || !meso_gl_is_software(context.renderer));
    CHECK(status == (software ? MESO_ERR_INTERNAL : MESO_OK));
    if (!status)
        meso_gl_context_release(&context);
}

int main(void)
{
    MesoArena arena;
    Bar bar;
    meso_arena_init(&arena);
    make_bar(&bar);
    MesoRenderOptions options = look(1);
    MesoImage one = draw(&arena, &bar.scene, &options, "osmesa", 0);
    test_values(&one);
    MesoImage bent = draw_by(true, &arena, &bar.scene, &options, "osmesa", 0);  /* by shaders, as a GPU does */
    test_values(&bent);
    options = look(4);
    MesoImage four = draw(&arena, &bar.scene, &options, "osmesa", 1);
    test_values(&four);
    CHECK(memcmp(one.depth, four.depth, 4 * WIDTH * HEIGHT) == 0);
    MesoImage again = draw(&arena, &bar.scene, &options, "osmesa", 2);
    CHECK(same_pixels(&four, &again));

    test_makers(&arena, &bar.scene, &four);
    test_detail(&arena);
    test_windows(&arena);
    test_far(&arena, &one);
    test_colors(&arena);
    test_nothing(&arena);
    test_refusals(&arena);
    test_bytes();
    meso_arena_release(&arena);
    return 0;
}
