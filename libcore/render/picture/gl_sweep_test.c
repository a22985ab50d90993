/*
 * Pictures of sweeps, that the shader bends or the processors, are those of the polygons that the mapper makes of them.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/render/gl/context.h"
#include "libcore/render/picture/painter.h"
#include "libcore/scene/parts.h"

enum {
    SIDES = 32, RINGS = 65, WIDTH = 160, HEIGHT = 135, SWEEPS = 2,
    VERTICES = SWEEPS * (SIDES + 1) * RINGS, FACES = SWEEPS * SIDES * (RINGS - 1)
};

typedef struct Case {
    MesoMaterial material;
    MesoSweepColumn columns[SIDES + 1];
    MesoSweptKind kind;
    MesoSweepInstance sweeps[SWEEPS];
    MesoCage cage;
    uint32_t ids[1];
    MesoMeshVertex vertices[VERTICES];
    MesoVec3 positions[VERTICES], normals[VERTICES];
    MesoMeshFace faces[FACES];
    MesoBody body;
    MesoPlacedBody placed;
    MesoScene swept, bodies;
} Case;

/*
 * Flat ellipses that turn, on trajectories that bend in space, larger at their ends: one above the other. Some columns
 * have normals of their own between the ends.
 */
static void make_sweeps(Case *c)
{
    *c = (Case){.material = {{0.75f, 0.25f, 0.125f}, 0.5f, 0}};
    for (uint32_t i = 0; i <= SIDES; i++) {
        double angle = -2 * MESO_PI * (i % SIDES) / SIDES;
        MesoVec2 s = {0.3f * (float)cos(angle), 0.1f * (float)sin(angle)};
        MesoVec2 n = {0.1f * (float)cos(angle), 0.3f * (float)sin(angle)};
        c->columns[i] = (MesoSweepColumn){s, {-s.x, -s.y}, n, {-n.x, -n.y}, (float)i / SIDES, i < SIDES, .absent = 0};
        if (i % 8 == 3) {
            c->columns[i].own = 1;
            c->columns[i].own_normals[0] = (MesoVec2){n.x - 0.4f * n.y, n.y + 0.4f * n.x};
            c->columns[i].own_normals[1] = (MesoVec2){-n.x - 0.2f * n.y, -n.y + 0.2f * n.x};
        }
    }
    c->kind = (MesoSweptKind){.column_count = SIDES + 1, .joint_count = SIDES, .division_count = RINGS,
                              .instance_count = SWEEPS, .turn = (float)(3 * MESO_PI),
                              .middle = {{0.05f, 0}, {-0.05f, 0}}};
    for (uint32_t i = 0; i < SWEEPS; i++) {
        float low = i == 0 ? 0.45f : -1.45f, high = low + 1;
        MesoSweepInstance *sweep = &c->sweeps[i];
        *sweep = (MesoSweepInstance){{{-1.5f, low, 0}, {0, low, 0.5f}, {0, high, -0.5f}, {1.5f, high, 0}},
                                     {{0, 1, 0}, {0, 0.3f, 1}}, {{0, 0, 0}, {0, 0, 0}}, 0, {0.8f, 1.3f}, 0, 0, 0, {{0}, {0}}};
        for (uint32_t end = 0; end < 2; end++)
            sweep->direction[end] = meso_vec3_direction(meso_vec3_sub(sweep->p[1 + 2 * end], sweep->p[2 * end]),
                                                        (MesoVec3){0, 0, 0});
    }
    c->swept = (MesoScene){.channel_count = 1, .channels = {{"slot", 1, NULL}}, .material_count = 1,
        .materials = &c->material, .id_row_count = 1, .ids = c->ids, .section_scale = 1, .thickness = 0.5f,
        .kind_count = 1, .column_count = SIDES + 1, .sweep_count = SWEEPS, .kinds = &c->kind, .columns = c->columns,
        .sweeps = c->sweeps};
}

static void make_body(Case *c, MesoArena *arena)
{
    MesoSceneParts parts;
    CHECK(meso_scene_parts_init(&parts, arena, &c->swept, NULL) == MESO_OK);
    CHECK(parts.vertex_begin[SWEEPS] == VERTICES && parts.face_begin[SWEEPS] == FACES);
    meso_scene_vertices(&parts, 0, SWEEPS, c->vertices);
    meso_scene_faces(&parts, 0, SWEEPS, 0, c->faces);
    for (uint32_t i = 0; i < VERTICES; i++) {
        c->positions[i] = c->vertices[i].position;
        c->normals[i] = c->vertices[i].normal;
    }
    c->body = (MesoBody){.vertex_count = VERTICES, .face_count = FACES, .face_width = 4, .positions = c->positions,
                         .normals = c->normals, .corners = c->faces[0].v};
    c->placed = (MesoPlacedBody){0};
    c->bodies = c->swept;
    c->bodies.kind_count = c->bodies.column_count = c->bodies.sweep_count = 0;
    c->bodies.body_count = c->bodies.placed_count = 1;
    c->bodies.bodies = &c->body;
    c->bodies.placed = &c->placed;
}

static MesoImage draw(MesoArena *arena, const MesoScene *scene, bool full_detail, bool bends)
{
    MesoGlContext context;
    MesoError error = {0};
    MesoImage image;
    MesoRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = 1, .full_detail = full_detail,
                                 .camera = {{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 22}};
    CHECK(meso_gl_context_init(&context, "osmesa", 0, &error) == MESO_OK);
    CHECK(!context.bends);
    context.bends = bends;
    if (meso_gl_picture(&image, arena, &context, scene, &options, 0, &error))
        fprintf(stderr, "%s\n", error.message);
    CHECK(error.status == MESO_OK);
    meso_gl_context_release(&context);
    return image;
}

/* Pixels that only one picture covers, or where they differ by more than rounding. */
static uint32_t count_different(const MesoImage *a, const MesoImage *b, float depth, float normal, uint32_t *covered)
{
    uint32_t different = 0;
    *covered = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        bool in_a = a->ids[0][i], in_b = b->ids[0][i], same = in_a == in_b;
        for (uint32_t k = 0; k < 3 && same && in_a; k++)
            same = fabsf(a->normal[3 * i + k] - b->normal[3 * i + k]) <= normal;
        same = same && (!in_a || fabsf(a->depth[i] - b->depth[i]) <= depth);
        different += !same;
        *covered += in_a;
    }
    return different;
}

/* The same in a cell, whose cage is twisted and tapered. */
static void put_in_cell(Case *c)
{
    static const MesoVec3 base[4] = {{2, -1, 0}, {1.5f, 0.6f, 0.3f}, {-1.5f, 1, 0}, {-2, -0.8f, 0.5f}};
    for (uint32_t i = 0; i < 4 * SWEEPS; i++) {
        MesoVec3 *p = &c->sweeps[i / 4].p[i % 4];
        *p = (MesoVec3){p->x / 3 + 0.5f, p->y / 3 + 0.5f, p->z / 3 + 0.25f};
    }
    for (uint32_t k = 0; k < 4; k++) {
        c->cage.base[k] = base[k];
        c->cage.rise[k] = (MesoVec3){k < 2 ? 0.5f : 0, 0, k % 2 ? 2 : 1.5f};
    }
    c->cage.high = 1;
    for (uint32_t end = 0; end < 2 * SWEEPS; end++)
        c->sweeps[end / 2].size[end % 2] /= 3;
    c->swept.deform = MESO_SWEEP_SHAPE;
    c->swept.cages = &c->cage;
    c->swept.cage_count = 1;
}

/* The camera frames what is there, so both scenes get one box. */
static void test_rule(MesoArena *arena, MesoFrameRule rule, float twist, float mitre, float other, bool in_cell)
{
    static Case c;
    uint32_t covered;
    make_sweeps(&c);
    if (in_cell)
        put_in_cell(&c);
    c.swept.frame_rule = rule;
    for (uint32_t i = 0; i < SWEEPS; i++) {
        c.sweeps[i].twist = twist;
        c.sweeps[i].mitre = i == 0 ? mitre : other;
    }
    meso_scene_measure(&c.swept);
    make_body(&c, arena);
    MesoImage body = draw(arena, &c.bodies, true, false);
    for (int bends = 0; bends < 2; bends++) {
        MesoImage swept = draw(arena, &c.swept, true, bends);
        CHECK(count_different(&swept, &body, 1e-3f, 0.02f, &covered) <= 8 && covered > 2000);
        MesoImage coarse = draw(arena, &c.swept, false, bends);
        CHECK(count_different(&coarse, &body, 0.05f, 0.5f, &covered) <= covered / 20);
    }
}

/* Of what does not bend, both draw the same triangles. */
static void test_bodies(MesoArena *arena)
{
    static Case c;
    uint32_t covered;
    make_sweeps(&c);
    meso_scene_measure(&c.swept);
    make_body(&c, arena);
    MesoImage body = draw(arena, &c.bodies, true, false), uploaded = draw(arena, &c.bodies, true, true);
    CHECK(count_different(&uploaded, &body, 1e-5f, 1e-3f, &covered) == 0);
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_rule(&arena, MESO_FRAME_PAPER, 0, 0, 0.75f, false);
    test_rule(&arena, MESO_FRAME_MINIMAL, 1.2f, 0, 0.75f, false);
    test_rule(&arena, MESO_FRAME_MINIMAL, 1.2f, 0.25f, 0, true);
    test_rule(&arena, MESO_FRAME_MINIMAL, 1.2f, MESO_CREASED, 2 * MESO_CREASED + 0.75f, false);
    test_rule(&arena, MESO_FRAME_PAPER, -1.2f, MESO_CREASED + 0.25f, 0.75f, true);
    test_rule(&arena, MESO_FRAME_PAPER, 0.6f, MESO_CREASE_EASES * MESO_CREASED + 0.5f, 3 * MESO_CREASED, false);
    test_bodies(&arena);
    meso_arena_release(&arena);
    return 0;
}
