/* A ball of radius 1/2 about the origin, to be lit. */
#ifndef MESO_BALL_FIXTURE_H
#define MESO_BALL_FIXTURE_H

#include "libcore/base/check.h"
#include "libcore/render/light/light_rig.h"

enum { BALL = 64 };

static const float PI = 3.14159265f, RADIUS = 0.5f;

static MesoArena arena;
static MesoError error;

typedef struct Ball {
    MesoMaterial material;
    uint32_t ids;
    MesoVec3 positions[(BALL + 1) * (BALL + 1)], normals[(BALL + 1) * (BALL + 1)];
    uint32_t corners[4 * BALL * BALL];
    MesoBody body;
    MesoPlacedBody placed;
    MesoScene scene;
    MesoShapes shapes;
} Ball;

static void make_ball(Ball *b)
{
    *b = (Ball){0};
    for (uint32_t j = 0; j <= BALL; j++)
        for (uint32_t i = 0; i <= BALL; i++) {
            float a = 2 * PI * (float)(i % BALL) / BALL, t = PI * (float)j / BALL;
            MesoVec3 n = {sinf(t) * cosf(a), cosf(t), -sinf(t) * sinf(a)};
            b->normals[j * (BALL + 1) + i] = n;
            b->positions[j * (BALL + 1) + i] = meso_vec3_scale(n, RADIUS);
        }
    for (uint32_t j = 0; j < BALL; j++)
        for (uint32_t i = 0; i < BALL; i++) {
            uint32_t v = j * (BALL + 1) + i, *c = &b->corners[4 * (j * BALL + i)];
            c[0] = v, c[1] = v + BALL + 1, c[2] = v + BALL + 2, c[3] = v + 1;
        }
    b->body = (MesoBody){.vertex_count = (BALL + 1) * (BALL + 1), .face_count = BALL * BALL, .face_width = 4,
                         .positions = b->positions, .normals = b->normals, .corners = b->corners};
    b->placed = (MesoPlacedBody){.place = MESO_PLACED_HERE};
    b->scene = (MesoScene){.channel_count = 1, .channels = {{"slot", 1, NULL}}, .material_count = 1,
                           .materials = &b->material, .id_row_count = 1, .ids = &b->ids, .section_scale = 1,
                           .thickness = 0.5f, .body_count = 1, .bodies = &b->body, .placed_count = 1,
                           .placed = &b->placed};
    meso_scene_measure(&b->scene);
    CHECK(meso_shapes_init(&b->shapes, &arena, &b->scene, (MesoVec3){0, 0, 0}, 1, &error) == MESO_OK);
}

#endif
