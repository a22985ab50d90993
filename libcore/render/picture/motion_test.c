/*
 * Motion of bent tubes with a cap, of such tubes with sections bent into a cage, and of a body: under a camera that
 * moves, and with a model that grows and turns about the origin. What a pixel shows is known by its position, and where that goes by the formula. Nothing moves
 * where nothing does; scenes of another structure are told.
 */
#include "libcore/render/picture/motion.h"

#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/render/picture/painter.h"

enum { SIDES = 12, TUBES = 6, CAPS = 3, WIDTH = 96, HEIGHT = 72 };

/* x' = size R x, R about the axis y. */
typedef struct Turn {
    float size, angle;
} Turn;

typedef struct Bundle {
    MesoMaterial materials[1];
    MesoSweepColumn columns[SIDES + 1];
    MesoSweptKind kinds[2];
    MesoSweepInstance instances[TUBES + CAPS];
    uint32_t ids[1];
    MesoVec3 positions[7], normals[7];
    uint32_t corners[8];
    MesoBody bodies[1];
    MesoPlacedBody placed[1];
    MesoCage cage;
    MesoScene scene;
} Bundle;

static MesoArena arena;
static MesoError error;

static MesoVec3 turned(Turn t, MesoVec3 p)
{
    float c = cosf(t.angle), s = sinf(t.angle);
    return (MesoVec3){t.size * (c * p.x + s * p.z), t.size * p.y, t.size * (c * p.z - s * p.x)};
}

static MesoVec3 turned_only(Turn t, MesoVec3 p)
{
    t.size = 1;
    return turned(t, p);
}

static void make_sweep(Bundle *b, uint32_t number, MesoRandom *random, Turn turn)
{
    MesoSweepInstance *sweep = &b->instances[number];
    MesoVec3 p[4], up = {0.2f, 1, 0.1f};
    for (uint32_t k = 0; k < 4; k++) {
        float r[3];
        for (int c = 0; c < 3; c++)
            r[c] = (float)meso_random_below(random, 1000) / 500 - 1;
        p[k] = (MesoVec3){1.5f * r[0], r[1], r[2]};
    }
    MesoVec3 ends[2] = {meso_vec3_unit(meso_vec3_sub(p[1], p[0]), up), meso_vec3_unit(meso_vec3_sub(p[3], p[2]), up)};
    for (uint32_t k = 0; k < 4; k++)
        sweep->p[k] = turned(turn, p[k]);
    for (uint32_t k = 0; k < 2; k++) {
        sweep->up[k] = turned_only(turn, up);
        sweep->direction[k] = turned_only(turn, ends[k]);
        sweep->size[k] = 1;
    }
}

/* Two quads that are not flat, and a triangle. */
static void make_body(Bundle *b, Turn turn)
{
    static const float points[7][3] = {{-1, -1, 0}, {0, -1, 0.3f}, {0, 0.2f, 0}, {-1, 0, 0.4f}, {1, -1, 0},
                                       {1, 0, 0.5f}, {0, 0, 0}};
    static const uint32_t corners[8] = {0, 1, 2, 3, 1, 4, 5, 2};
    for (uint32_t v = 0; v < 7; v++) {
        b->positions[v] = turned(turn, (MesoVec3){points[v][0], points[v][1], points[v][2]});
        b->normals[v] = turned_only(turn, (MesoVec3){0, 0, 1});
    }
    memcpy(b->corners, corners, sizeof corners);
    b->bodies[0] = (MesoBody){.vertex_count = 7, .face_count = 2, .face_width = 4, .positions = b->positions,
                              .normals = b->normals, .corners = b->corners};
}

static void make_bundle(Bundle *b, Turn turn)
{
    MesoRandom random;
    meso_random_init(&random, 5, 0);
    *b = (Bundle){.materials = {{{0.5f, 0.5f, 0.5f}, 0.5f, 0}}};
    for (uint32_t i = 0; i <= SIDES; i++) {
        double angle = -2 * 3.14159265358979 * (i % SIDES) / SIDES;
        MesoVec2 n = {(float)cos(angle), (float)sin(angle)}, s = {0.12f * n.x, 0.12f * n.y};
        b->columns[i] = (MesoSweepColumn){s, s, n, n, (float)i / SIDES, i < SIDES, .absent = 0};
    }
    MesoSweptKind kind = {.column_count = SIDES + 1, .joint_count = SIDES, .division_count = 16,
                          .instance_count = TUBES};
    b->kinds[0] = b->kinds[1] = kind;
    b->kinds[1].cap = true;
    b->kinds[1].instance_begin = TUBES;
    b->kinds[1].instance_count = CAPS;
    for (uint32_t i = 0; i < TUBES + CAPS; i++)
        make_sweep(b, i, &random, turn);
    make_body(b, turn);
    b->scene = (MesoScene){.channel_count = 1, .channels = {{"slot", 1, NULL}}, .material_count = 1,
        .materials = b->materials, .id_row_count = 1, .ids = b->ids, .section_scale = turn.size, .thickness = 0.5f,
        .kind_count = 2, .column_count = SIDES + 1, .sweep_count = TUBES + CAPS, .kinds = b->kinds,
        .columns = b->columns,
        .sweeps = b->instances, .body_count = 1, .bodies = b->bodies, .placed_count = 1, .placed = b->placed};
    meso_scene_measure(&b->scene);
}

/* The tubes of an unturned bundle in a cell, with a cage that is twisted and tapered, and turned: all goes with it. */
static void put_in_cage(Bundle *b, Turn turn)
{
    static const MesoVec3 base[4] = {{2, -1, 0}, {1.5f, 0.6f, 0.3f}, {-1.5f, 1, 0}, {-2, -0.8f, 0.5f}};
    for (uint32_t i = 0; i < TUBES + CAPS; i++) {
        MesoSweepInstance *sweep = &b->instances[i];
        for (uint32_t k = 0; k < 4; k++)
            sweep->p[k] = (MesoVec3){sweep->p[k].x / 3 + 0.5f, sweep->p[k].y / 3 + 0.5f, sweep->p[k].z / 3 + 0.25f};
        sweep->size[0] = sweep->size[1] = 1.f / 3;
        sweep->cage = 0;
    }
    for (uint32_t k = 0; k < 4; k++) {
        b->cage.base[k] = turned(turn, base[k]);
        b->cage.rise[k] = turned(turn, (MesoVec3){k < 2 ? 0.5f : 0, 0, k % 2 ? 2 : 1.5f});
    }
    b->cage.high = 1;
    b->scene.deform = MESO_SWEEP_SHAPE;
    b->scene.cages = &b->cage;
    b->scene.cage_count = 1;
    b->scene.section_scale = 1;
    make_body(b, turn);
    meso_scene_measure(&b->scene);
}

/* Pixels from the left and from the bottom. */
static void project(const MesoCamera *camera, MesoVec3 p, double place[2])
{
    MesoView view;
    CHECK(meso_view_build(&view, camera, &error) == MESO_OK);
    MesoVec3 q = meso_vec3_sub(p, view.eye);
    double scale = camera->height > 0 ? HEIGHT / (double)camera->height
                 : 0.5 * HEIGHT / tan(camera->fov_degrees * 3.14159265358979 / 360) / meso_vec3_dot(q, view.forward);
    place[0] = 0.5 * WIDTH + scale * meso_vec3_dot(q, view.right);
    place[1] = 0.5 * HEIGHT + scale * meso_vec3_dot(q, view.up);
}

/* The largest motion; all of it as the formula says, where `turn` is what the model does. */
static double check(const MesoScene *now, const MesoScene *next, Turn turn, MesoCamera next_camera)
{
    MesoImage image;
    MesoRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = 1,
                                 .camera = {.eye = {1, 2, 5}, .up = {0, 1, 0}, .fov_degrees = 40,
                                            .height = next_camera.height > 0 ? 3.5f : 0},
                                 .extras = MESO_EXTRA_MOTION | MESO_EXTRA_POSITION, .next_camera = next_camera,
                                 .next_scene = next};
    CHECK(meso_tile_picture(&image, &arena, now, &options, 2, &error) == MESO_OK);
    uint32_t seen = 0;
    double most = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        const float *p = image.position + 3 * i, *m = image.motion + 2 * i;
        if (isinf(image.depth[i])) {
            CHECK(m[0] == 0 && m[1] == 0);
            continue;
        }
        double from[2], to[2];
        MesoVec3 here = {p[0], p[1], p[2]};
        project(&options.camera, here, from);
        project(&options.next_camera, turned(turn, here), to);
        for (int c = 0; c < 2; c++) {
            CHECK(fabs(to[c] - from[c] - m[c]) < 2e-3);
            most = fmax(most, fabs((double)m[c]));
        }
        seen++;
    }
    CHECK(seen > 500);
    return most;
}

int main(void)
{
    static Bundle now, then, other, caged, caged_then;
    const MesoCamera here = {.eye = {1, 2, 5}, .up = {0, 1, 0}, .fov_degrees = 40};
    const MesoCamera there = {.eye = {1.5f, 2, 4.5f}, .target = {0, 0.1f, 0}, .up = {0.1f, 1, 0}, .fov_degrees = 42};
    const MesoCamera flat = {.eye = {1.5f, 2, 4.5f}, .up = {0.1f, 1, 0}, .fov_degrees = 42, .height = 3.8f};
    const Turn none = {1, 0}, grown = {1.1f, 0.2f};
    meso_arena_init(&arena);
    make_bundle(&now, none);
    make_bundle(&then, grown);
    make_bundle(&other, grown);
    CHECK(check(&now.scene, NULL, none, here) == 0);
    CHECK(check(&now.scene, &now.scene, none, here) == 0);
    CHECK(check(&now.scene, NULL, none, there) > 1);
    CHECK(check(&now.scene, &then.scene, grown, here) > 1);
    CHECK(check(&now.scene, &then.scene, grown, there) > 1);
    CHECK(check(&now.scene, &then.scene, grown, flat) > 1);
    CHECK(meso_motion_alike(&now.scene, &then.scene));
    make_bundle(&caged, none);
    put_in_cage(&caged, none);
    make_bundle(&caged_then, none);
    put_in_cage(&caged_then, grown);
    CHECK(check(&caged.scene, &caged_then.scene, grown, here) > 1);
    CHECK(check(&caged.scene, &caged_then.scene, grown, there) > 1);
    other.corners[3] = 0;
    CHECK(!meso_motion_alike(&now.scene, &other.scene));
    other.corners[3] = 3;
    other.kinds[0].instance_count--;
    CHECK(!meso_motion_alike(&now.scene, &other.scene));
    meso_arena_release(&arena);
    return 0;
}
