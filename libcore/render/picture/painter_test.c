/*
 * Pictures of a bundle of bent tubes and a ball: what a ray through each pixel meets first, the same as GL draws, at any
 * number of threads, in bands, from inside, far from the origin; light that nothing holds off, and shadows where they
 * must fall.
 */
#include "libcore/render/gl/context.h"
#include "libcore/render/picture/painter.h"

#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/render/light/light_rig.h"
#include "libcore/render/light/vary.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/parts.h"

enum { SIDES = 12, TUBES = 9, RINGS = 24, WIDTH = 120, HEIGHT = 90, BALL = 16 };

typedef struct Bundle {
    MesoMaterial materials[2];
    MesoSweepColumn columns[SIDES + 1];
    MesoSweptKind kinds[1];
    MesoSweepInstance instances[TUBES];
    MesoCage cage;
    uint32_t ids[TUBES + 1];
    MesoVec3 positions[(BALL + 1) * (BALL + 1)], normals[(BALL + 1) * (BALL + 1)];
    uint32_t corners[4 * BALL * BALL];
    MesoBody bodies[1];
    MesoPlacedBody placed[1];
    MesoScene scene;
} Bundle;

static MesoArena arena;
static MesoError error;

static void make_ball(Bundle *b, MesoVec3 middle, float radius)
{
    for (uint32_t j = 0; j <= BALL; j++)
        for (uint32_t i = 0; i <= BALL; i++) {
            double a = 2 * 3.14159265358979 * (i % BALL) / BALL, t = 3.14159265358979 * j / BALL;
            MesoVec3 n = {(float)(sin(t) * cos(a)), (float)cos(t), (float)(-sin(t) * sin(a))};
            b->normals[j * (BALL + 1) + i] = n;
            b->positions[j * (BALL + 1) + i] = meso_vec3_mad(middle, radius, n);
        }
    for (uint32_t j = 0; j < BALL; j++)
        for (uint32_t i = 0; i < BALL; i++) {
            uint32_t v = j * (BALL + 1) + i, *c = &b->corners[4 * (j * BALL + i)];
            c[0] = v, c[1] = v + BALL + 1, c[2] = v + BALL + 2, c[3] = v + 1;
        }
}

static void make_bundle(Bundle *b, MesoVec3 at)
{
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    *b = (Bundle){0};
    b->materials[0] = (MesoMaterial){{0.75f, 0.25f, 0.125f}, 0.5f, 0};
    b->materials[1] = (MesoMaterial){{0.125f, 0.25f, 0.75f}, 0.25f, 1};
    for (uint32_t i = 0; i <= SIDES; i++) {
        double angle = -2 * 3.14159265358979 * (i % SIDES) / SIDES;
        MesoVec2 n = {(float)cos(angle), (float)sin(angle)}, s = {0.12f * n.x, 0.12f * n.y};
        b->columns[i] = (MesoSweepColumn){s, s, n, n, (float)i / SIDES, i < SIDES, .absent = 0};
    }
    b->kinds[0] = (MesoSweptKind){.column_count = SIDES + 1, .joint_count = SIDES, .division_count = RINGS,
                                  .instance_count = TUBES, .end_material = 1};
    for (uint32_t t = 0; t < TUBES; t++) {
        MesoSweepInstance *sweep = &b->instances[t];
        for (uint32_t k = 0; k < 4; k++) {
            float r[3];
            for (int c = 0; c < 3; c++)
                r[c] = (float)meso_random_below(&random, 1000) / 500 - 1;
            sweep->p[k] = meso_vec3_add(at, (MesoVec3){1.5f * r[0], r[1], r[2]});
        }
        sweep->up[0] = sweep->up[1] = (MesoVec3){0.2f, 1, 0.1f};
        sweep->direction[0] = meso_vec3_unit(meso_vec3_sub(sweep->p[1], sweep->p[0]), sweep->up[0]);
        sweep->direction[1] = meso_vec3_unit(meso_vec3_sub(sweep->p[3], sweep->p[2]), sweep->up[0]);
        sweep->ids = t;
        sweep->size[0] = sweep->size[1] = 1;
    }
    for (uint32_t i = 0; i <= TUBES; i++)
        b->ids[i] = 3 * i + 1;
    make_ball(b, meso_vec3_add(at, (MesoVec3){0.3f, -0.2f, 0.1f}), 0.5f);
    b->bodies[0] = (MesoBody){.vertex_count = (BALL + 1) * (BALL + 1), .face_count = BALL * BALL, .face_width = 4,
                              .positions = b->positions, .normals = b->normals, .corners = b->corners};
    b->placed[0] = (MesoPlacedBody){.material = 1, .ids = TUBES, .place = MESO_PLACED_HERE};
    b->scene = (MesoScene){.channel_count = 1, .channels = {{"slot", 3 * TUBES + 2, NULL}}, .material_count = 2,
        .materials = b->materials, .id_row_count = TUBES + 1, .ids = b->ids, .section_scale = 1, .thickness = 0.5f,
        .kind_count = 1, .column_count = SIDES + 1, .sweep_count = TUBES, .kinds = b->kinds, .columns = b->columns,
        .sweeps = b->instances, .body_count = 1, .bodies = b->bodies, .placed_count = 1, .placed = b->placed};
    meso_scene_measure(&b->scene);
}

/* Takes the sweeps of a bundle at the origin for ones in a cell, and bends it a little, to somewhere else. */
static void bend_bundle(Bundle *b, MesoVec3 at)
{
    static const MesoVec3 base[4] = {{1, 0.1f, 0}, {1.1f, 1, 0.1f}, {0, 1.1f, 0}, {0, 0, 0}};
    for (uint32_t i = 0; i < 4; i++) {
        b->cage.base[i] = meso_vec3_add(base[i], at);
        b->cage.rise[i] = (MesoVec3){i == 2 ? 0.1f : 0, 0, i == 3 ? 0.9f : 1};
    }
    b->cage.high = MESO_CELL_HEIGHT;
    b->scene.deform = MESO_SWEEP_SHAPE;
    b->scene.cage_count = 1;
    b->scene.cages = &b->cage;
    b->scene.placed_count = 0;
    meso_scene_measure(&b->scene);
}

static MesoRenderOptions look(MesoVec3 at, MesoVec3 eye, uint32_t samples)
{
    return (MesoRenderOptions){.width = WIDTH, .height = HEIGHT, .samples = samples, .full_detail = true,
                               .camera = {meso_vec3_add(at, eye), at, {0, 1, 0}, 40, 0}};
}

static MesoImage draw(const Bundle *b, const MesoRenderOptions *options, uint32_t threads)
{
    MesoImage image;
    CHECK(meso_tile_picture(&image, &arena, &b->scene, options, threads, &error) == MESO_OK);
    return image;
}

/* ---- by rays ---- */

typedef struct Hit {
    double depth;
    uint32_t part;              /* + 1; 0: nothing */
} Hit;

/* Depth where the ray from the eye along `d`, of depth 1, meets a triangle, or infinity. */
static double meet(MesoVec3 eye, MesoVec3 d, MesoVec3 a, MesoVec3 b, MesoVec3 c)
{
    MesoVec3 p[3] = {meso_vec3_sub(a, eye), meso_vec3_sub(b, eye), meso_vec3_sub(c, eye)};
    double v[3], sum = 0, depth = 0;
    for (int k = 0; k < 3; k++) {
        MesoVec3 x = p[(k + 1) % 3], y = p[(k + 2) % 3];
        v[k] = ((double)x.y * y.z - (double)x.z * y.y) * d.x + ((double)x.z * y.x - (double)x.x * y.z) * d.y +
               ((double)x.x * y.y - (double)x.y * y.x) * d.z;
        sum += v[k];
    }
    double along = (double)meso_vec3_dot(d, d);
    for (int k = 0; k < 3; k++) {
        if (v[k] * sum < 0)
            return INFINITY;
        depth += v[k] / sum * (double)meso_vec3_dot(p[k], d) / along;
    }
    return depth > 0 ? depth : INFINITY;
}

static Hit cast(const MesoSceneParts *parts, const MesoMeshVertex *v, const MesoMeshFace *f, MesoVec3 eye, MesoVec3 d)
{
    Hit hit = {INFINITY, 0};
    for (uint32_t p = 0; p < parts->part_count; p++)
        for (uint64_t i = parts->face_begin[p]; i < parts->face_begin[p + 1]; i++)
            for (int half = 0; half < (f[i].v[3] == MESO_NO_INDEX ? 1 : 2); half++) {
                double depth = meet(eye, d, v[f[i].v[0]].position, v[f[i].v[1 + half]].position,
                                    v[f[i].v[2 + half]].position);
                if (depth < hit.depth)
                    hit = (Hit){depth, p + 1};
            }
    return hit;
}

/* `height`: of an orthographic view, or 0. */
static void test_rays(const Bundle *b, MesoVec3 at, MesoVec3 eye, float height)
{
    MesoRenderOptions options = look(at, eye, 1);
    options.camera.height = height;
    MesoImage image = draw(b, &options, 2);
    MesoSceneParts parts;
    MesoView view;
    CHECK(meso_scene_parts_init(&parts, &arena, &b->scene, &error) == MESO_OK);
    CHECK(meso_view_build(&view, &options.camera, &error) == MESO_OK);
    MesoMeshVertex *v = MESO_NEW(&arena, MesoMeshVertex, parts.vertex_begin[parts.part_count], &error);
    MesoMeshFace *f = MESO_NEW(&arena, MesoMeshFace, parts.face_begin[parts.part_count], &error);
    meso_scene_vertices(&parts, 0, parts.part_count, v);
    meso_scene_faces(&parts, 0, parts.part_count, 0, f);
    float pixel = 2 * view.half_height / HEIGHT;
    uint32_t wrong = 0, covered = 0, deep = 0;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = y % 5; x < WIDTH; x += 5) {
            MesoVec3 aside = meso_vec3_scale(view.right, ((float)x + 0.5f - WIDTH / 2) * pixel);
            aside = meso_vec3_mad(aside, (HEIGHT / 2 - (float)y - 0.5f) * pixel, view.up);
            Hit hit = height > 0 ? cast(&parts, v, f, meso_vec3_add(view.eye, aside), view.forward)
                                 : cast(&parts, v, f, view.eye, meso_vec3_add(view.forward, aside));
            size_t i = (size_t)y * WIDTH + x;
            uint32_t id = hit.part == 0 ? 0 : b->ids[meso_scene_part(&parts, hit.part - 1).ids] + 1;
            wrong += image.ids[0][i] != id;
            covered += id > 0;
            deep += id > 0 && image.ids[0][i] == id && fabs((double)image.depth[i] - hit.depth) > 0.02 * hit.depth;
            CHECK((image.ids[0][i] == 0) == (isinf(image.depth[i]) != 0));
            CHECK(image.ids[0][i] == 0 || fabs((double)meso_vec3_length((MesoVec3){image.normal[3 * i],
                                               image.normal[3 * i + 1], image.normal[3 * i + 2]}) - 1) < 1e-3);
        }
    CHECK(covered > WIDTH * HEIGHT / 50);
    CHECK(wrong <= covered / 200 && deep <= covered / 200);     /* rims, on which a pixel's middle lies by chance */
}

/* ---- beside GL ---- */

static MesoGlContext context;

/* `bends`: shaders bend the sweeps, as a GPU's do. */
static void test_gl_by(bool bends, const Bundle *b, MesoVec3 at, MesoVec3 eye, float height, uint32_t samples)
{
    context.bends = bends;
    MesoRenderOptions options = look(at, eye, samples);
    options.camera.height = height;
    options.ground = true;
    options.vary = 0.5f;
    options.extras = MESO_EXTRA_POSITION | MESO_EXTRA_UV | MESO_EXTRA_OCCLUSION | MESO_EXTRA_MATTES;
    MesoImage ours = draw(b, &options, 2), gl;
    CHECK(meso_gl_picture(&gl, &arena, &context, &b->scene, &options, 2, &error) == MESO_OK);
    uint32_t covered = 0, wrong = 0;
    double normals = 0, colors = 0, depths = 0, alpha = 0, light = 0, places = 0, uvs = 0, openness = 0;
    CHECK(memcmp(ours.mattes[0].seen, gl.mattes[0].seen, sizeof *gl.mattes[0].seen) == 0);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        wrong += ours.ids[0][i] != gl.ids[0][i];
        alpha += fabs((double)(ours.color[4 * i + 3] - gl.color[4 * i + 3]));
        if (ours.ids[0][i] == 0 || ours.ids[0][i] != gl.ids[0][i])
            continue;
        covered++;
        depths += fabs((double)(ours.depth[i] - gl.depth[i]));
        for (size_t c = 0; c < 3; c++) {
            normals += pow((double)(ours.normal[3 * i + c] - gl.normal[3 * i + c]), 2);
            colors += pow((double)(ours.albedo[3 * i + c] - gl.albedo[3 * i + c]), 2);
            light += fabs((double)(ours.color[4 * i + c] - gl.color[4 * i + c])) / 3;
            places += fabs((double)(ours.position[3 * i + c] - gl.position[3 * i + c])) / 3;
        }
        uvs += fmin(fabs((double)(ours.uv[2 * i] - gl.uv[2 * i])), 1) +
               fmin(fabs((double)(ours.uv[2 * i + 1] - gl.uv[2 * i + 1])), 1);
        openness += fabs((double)(ours.openness[i] - gl.openness[i]));
    }
    CHECK(covered > WIDTH * HEIGHT / 10 && wrong <= covered / 100);
    CHECK(sqrt(normals / covered) < 0.05 && sqrt(colors / covered) < 0.01);
    CHECK(depths / covered < 0.01 && alpha / covered < 0.02);
    CHECK(light / covered < 3e-4 && places / covered < 3e-5 && uvs / covered < 5e-5 && openness / covered < 2e-3);
    CHECK(bends || wrong <= 2);     /* the same triangles */
}

static void test_gl(const Bundle *b, MesoVec3 at, MesoVec3 eye, float height, uint32_t samples)
{
    test_gl_by(false, b, at, eye, height, samples);
    test_gl_by(true, b, at, eye, height, samples);
}

static bool same_pixels(const MesoImage *a, const MesoImage *b)
{
    size_t n = (size_t)a->width * a->height;
    return memcmp(a->color, b->color, 16 * n) == 0 && memcmp(a->depth, b->depth, 4 * n) == 0 &&
           memcmp(a->normal, b->normal, 12 * n) == 0 && memcmp(a->albedo, b->albedo, 12 * n) == 0 &&
           memcmp(a->ids[0], b->ids[0], 4 * n) == 0;
}

static void test_threads(const Bundle *b, MesoVec3 at)
{
    for (uint32_t samples = 1; samples <= 16; samples *= 4) {
        MesoRenderOptions options = look(at, (MesoVec3){1, 2, 5}, samples);
        options.full_detail = false;
        options.ground = true;
        MesoImage one = draw(b, &options, 1);
        for (uint32_t threads = 2; threads <= 7; threads += 5) {
            MesoImage other = draw(b, &options, threads);
            CHECK(same_pixels(&one, &other));
        }
        for (size_t i = 0; i < WIDTH * HEIGHT; i++)
            CHECK(one.color[4 * i + 3] >= 0 && one.color[4 * i + 3] <= 1.0001f && one.color[4 * i] >= 0);
    }
}

/* Rows of `whole` from that row on. */
static MesoImage rows_from(const MesoImage *whole, uint32_t row, uint32_t height)
{
    MesoImage part = *whole;
    size_t first = (size_t)row * whole->width;
    part.height = height;
    part.color += 4 * first;
    part.depth += first;
    part.normal += 3 * first;
    part.albedo += 3 * first;
    part.ids[0] += first;
    return part;
}

/* In bands of half a tile, and of one: every pixel as in the whole picture, what is seen, too. */
static void test_bands(const Bundle *b, MesoVec3 at)
{
    for (uint32_t rows = 32; rows <= 64; rows += 32) {
        MesoRenderOptions options = look(at, (MesoVec3){1, 2, 5}, 4);
        options.ground = true;
        options.extras = MESO_EXTRA_POSITION | MESO_EXTRA_MATTES;
        options.band_rows = rows;
        MesoImage whole = draw(b, &options, 2), band;
        MesoPainter *painter;
        CHECK(meso_painter_init(&painter, &band, &arena, &b->scene, &options, 2, &error) == MESO_OK);
        CHECK(band.height == rows && band.mattes[0].seen[0] == whole.mattes[0].seen[0] && whole.mattes[0].seen[0] != 0);
        for (uint32_t row = 0; row < HEIGHT; row += band.height) {
            CHECK(meso_paint(painter, &band, row, &error) == MESO_OK);
            MesoImage part = rows_from(&whole, row, band.height);
            size_t first = (size_t)row * WIDTH, count = (size_t)band.height * WIDTH;
            CHECK(same_pixels(&band, &part));
            CHECK(memcmp(band.position, whole.position + 3 * first, 12 * count) == 0);
            CHECK(memcmp(band.mattes[1].ranks, whole.mattes[1].ranks + 2 * MESO_MATTE_RANKS * first,
                         2 * MESO_MATTE_RANKS * 4 * count) == 0);
        }
    }
}

/* What a band takes is bounded, and is whole tiles where those fit. */
static void test_plan(const Bundle *b)
{
    for (uint32_t samples = 1; samples <= 16; samples *= 4) {
        MesoRenderOptions options = {.width = 16384, .height = 16384, .samples = samples};
        uint32_t rows = meso_paint_band_rows(&b->scene, &options);
        CHECK(rows == 64 && rows % 16 == 0 && 48.0 * 16384 * rows <= MESO_BAND_BYTES);
        options.extras = ~0u;
        rows = meso_paint_band_rows(&b->scene, &options);
        CHECK(rows >= 16 && rows % 16 == 0 && 176.0 * 16384 * rows <= MESO_BAND_BYTES);
        options.width = 1280, options.height = 720, options.extras = 0;
        CHECK(meso_paint_band_rows(&b->scene, &options) == 720);
    }
}

/* Of an image's ground: where nothing stands before it. */
static double ground_difference(const MesoImage *a, const MesoImage *b)
{
    double sum = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        if (a->ids[0][i] == 0 && b->ids[0][i] == 0)
            sum += fabs((double)(a->color[4 * i + 3] - b->color[4 * i + 3]));
    return sum / (WIDTH * HEIGHT);
}

/* A camera that is told another up sees the same, and the ground where the world has it. */
static void test_up(const Bundle *b)
{
    MesoRenderOptions options = look((MesoVec3){0, 0, 0}, (MesoVec3){0, 4, 4}, 1);
    options.ground = true;
    MesoImage level = draw(b, &options, 2);
    options.camera.up = (MesoVec3){0, 1, -1};
    MesoImage tilted = draw(b, &options, 2);
    options.up = (MesoVec3){0, 2, 0};
    MesoImage told = draw(b, &options, 2);
    CHECK(ground_difference(&level, &told) < 1e-3 && ground_difference(&level, &tilted) > 1e-2);
}

/* ---- light ---- */

/* A ball over nothing: all of the sky is seen from its top, half of it from its side. Below it lies its shadow. */
static void test_light(void)
{
    static Bundle b;
    make_bundle(&b, (MesoVec3){0, 0, 0});
    make_ball(&b, (MesoVec3){0, 0, 0}, 0.5f);
    b.scene.sweep_count = b.scene.kind_count = 0;
    meso_scene_measure(&b.scene);
    MesoShapes shapes;
    MesoView view;
    MesoLightRig rig;
    MesoRenderOptions options = look((MesoVec3){0, 0, 0}, (MesoVec3){0, 0, 5}, 16);
    CHECK(meso_view_build(&view, &options.camera, &error) == MESO_OK);
    CHECK(meso_shapes_init(&shapes, &arena, &b.scene, (MesoVec3){0, 0, 0}, 1, &error) == MESO_OK);
    const MesoLightQuality quality = {256, 256, 16, 512, 0.5f};
    CHECK(meso_light_rig_init(&rig, &arena, &shapes, &view, options.camera.up, NULL, &quality, 2,
                              &error) == MESO_OK);
    const MesoVec3 ways[3] = {{0, 1, 0}, {1, 0, 0}, {0, -1, 0}};
    for (int i = 0; i < 3; i++) {
        MesoLitSurface s = {.position = meso_vec3_scale(ways[i], 0.5f), .normal = ways[i], .to_eye = {0, 0, 1},
                            .albedo = {0.5f, 0.5f, 0.5f}, .roughness = 0.5f};
        float radiance[3], openness;
        meso_light_on(&rig, &s, radiance, &openness);
        CHECK(openness > 0.97f && radiance[0] > 0);
    }
}

/* A rig around a ball over nothing, of one colour of sky and ground, and without lights. */
static void make_furnace(MesoLightRig *rig, Bundle *b, MesoShapes *shapes)
{
    MesoView view;
    MesoRenderOptions options = look((MesoVec3){0, 0, 0}, (MesoVec3){0, 0, 5}, 16);
    const MesoLightQuality quality = {256, 256, 16, 512, 0.5f};
    make_bundle(b, (MesoVec3){0, 0, 0});
    make_ball(b, (MesoVec3){0, 0, 0}, 0.5f);
    b->scene.sweep_count = b->scene.kind_count = 0;
    meso_scene_measure(&b->scene);
    CHECK(meso_view_build(&view, &options.camera, &error) == MESO_OK);
    CHECK(meso_shapes_init(shapes, &arena, &b->scene, (MesoVec3){0, 0, 0}, 1, &error) == MESO_OK);
    CHECK(meso_light_rig_init(rig, &arena, shapes, &view, options.camera.up, NULL, &quality, 2, &error) == MESO_OK);
    rig->colors = (MesoLightColors){.sky = {1, 1, 1}, .ground = {1, 1, 1}};
    for (uint32_t i = 0; i < 3 * rig->sky.count; i++)
        rig->sky_colors[i] = 1;
}

/* Radiance of a white surface that `normal` is of, far above the ball. */
static float white(const MesoLightRig *rig, MesoVec3 normal, float cosine, float roughness, float metallic)
{
    MesoVec3 across = meso_vec3_unit(meso_vec3_cross(normal, (MesoVec3){0.3f, 0.5f, -0.7f}), normal);
    MesoLitSurface s = {.position = meso_vec3_scale(normal, 0.6f), .normal = normal, .albedo = {1, 1, 1},
                        .roughness = roughness, .metallic = metallic};
    s.to_eye = meso_vec3_mad(meso_vec3_scale(normal, cosine), sqrtf(1 - cosine * cosine), across);
    float radiance[3];
    meso_light_on(rig, &s, radiance, NULL);
    return radiance[0];
}

/*
 * White under a sky that is 1 everywhere gives back no more than that, and most of it; and from all directions of a key
 * light together, which is 1 over pi for each of a sphere's.
 */
static void test_furnace(void)
{
    enum { WAYS = 1000 };
    static Bundle b;
    MesoShapes shapes;
    MesoLightRig rig;
    make_furnace(&rig, &b, &shapes);
    for (int k = 0; k < 5 * 4 * 2; k++) {
        float cosine = 0.1f + 0.225f * (float)(k % 5), roughness = 0.25f + 0.25f * (float)(k / 5 % 4);
        float metallic = (float)(k / 20);
        for (uint32_t i = 0; i < 3; i++) {
            float sky = white(&rig, (MesoVec3){i == 0, i == 1, i == 2}, fminf(cosine, 1), roughness, metallic);
            CHECK(sky < 1.02f && sky > (metallic > 0 ? 0.44f : 0.85f));
        }
    }
    rig.colors = (MesoLightColors){.key = {1, 1, 1}};
    for (uint32_t i = 0; i < 3 * rig.sky.count; i++)
        rig.sky_colors[i] = 0;
    MesoVec3 normal = rig.to_key;
    for (int k = 0; k < 3 * 3 * 2; k++) {
        float cosine = 0.3f + 0.35f * (float)(k % 3), roughness = fminf(0.4f + 0.3f * (float)(k / 3 % 3), 1);
        float metallic = (float)(k / 9);
        double sum = 0;
        for (uint32_t i = 0; i < WAYS; i++) {
            float z = 1 - (2 * (float)i + 1) / WAYS, r = sqrtf(1 - z * z), a = 2.39996323f * (float)i;
            rig.to_key = (MesoVec3){r * cosf(a), r * sinf(a), z};
            sum += (double)white(&rig, normal, fminf(cosine, 1), roughness, metallic);
        }
        double whole = sum / WAYS * 4 * 3.14159265358979;
        CHECK(whole < 1.02 && whole > (metallic > 0 ? 0.3 : 0.98));
        /* Of facets that look anywhere, seen from above: the integral of x / (1 + x). */
        CHECK(!(cosine >= 1 && roughness >= 1 && metallic > 0) || fabs(whole - (1 - log(2))) < 1e-3);
    }
}

static void test_vary(const Bundle *b)
{
    float same[3] = {0.2f, 0.4f, 0.1f}, again[3];
    uint32_t apart = 0;
    meso_vary(same, 7, 0);
    CHECK(same[0] == 0.2f && same[1] == 0.4f && same[2] == 0.1f && meso_vary_channel(&b->scene) == 0);
    meso_vary(same, 7, 0.5f);
    for (uint32_t id = 0; id < 1000; id++) {
        float color[3] = {0.2f, 0.4f, 0.1f};
        meso_vary(color, id, 0.5f);
        float factor = (color[0] + color[1] + color[2]) / 0.7f;
        CHECK(factor > 0.706f && factor < 1.415f && color[1] > color[0] && color[0] > color[2]);
        apart += memcmp(color, same, sizeof color) != 0;
        for (int c = 0; c < 3; c++)
            again[c] = color[c] = 1;
        meso_vary(again, id, 1);
        CHECK(again[0] <= 1 && again[1] <= 1 && again[2] <= 1);
    }
    CHECK(apart == 999);

    /* Colour alone differs, in things, and not in the variables. */
    MesoRenderOptions options = look((MesoVec3){0, 0, 0}, (MesoVec3){1, 2, 5}, 1);
    MesoImage plain = draw(b, &options, 2);
    options.vary = 0.5f;
    MesoImage varied = draw(b, &options, 1);
    size_t n = WIDTH * HEIGHT;
    CHECK(memcmp(plain.albedo, varied.albedo, 12 * n) == 0 && memcmp(plain.ids[0], varied.ids[0], 4 * n) == 0);
    CHECK(memcmp(plain.color, varied.color, 16 * n) != 0);
    for (size_t i = 0; i < n; i++)
        CHECK(plain.color[4 * i + 3] == varied.color[4 * i + 3]);
}

int main(void)
{
    static Bundle b;
    const MesoVec3 origin = {0, 0, 0}, far = {1e5f, -2e5f, 3e4f};
    meso_arena_init(&arena);
    CHECK(meso_gl_context_init(&context, "osmesa", 2, &error) == MESO_OK);
    make_bundle(&b, origin);
    const MesoVec3 outside = {1, 2, 5}, inside = {0.4f, 0.5f, 0.9f};
    test_rays(&b, origin, outside, 0);
    test_rays(&b, origin, inside, 0);       /* the near plane cuts */
    test_rays(&b, origin, outside, 2.5f);
    test_rays(&b, origin, (MesoVec3){0.04f, 0.05f, 0.09f}, 2.5f);       /* the eye's plane cuts */
    test_gl(&b, origin, outside, 0, 1);
    test_gl(&b, origin, outside, 2.5f, 4);
    test_gl(&b, origin, outside, 0, 16);
    test_gl(&b, origin, (MesoVec3){0.04f, 0.05f, 0.09f}, 2.5f, 1);
    test_threads(&b, origin);
    test_bands(&b, origin);
    test_plan(&b);
    test_vary(&b);
    test_up(&b);
    make_bundle(&b, far);
    test_gl(&b, far, outside, 0, 1);
    make_bundle(&b, origin);
    bend_bundle(&b, (MesoVec3){200, 0, 0});
    test_rays(&b, (MesoVec3){200, 0, 0}, (MesoVec3){1, 2, 5}, 0);
    test_gl(&b, (MesoVec3){200, 0, 0}, outside, 0, 1);
    meso_gl_context_release(&context);
    test_light();
    test_furnace();
    meso_arena_release(&arena);
    return 0;
}
