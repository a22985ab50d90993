/*
 * Placed bodies against their formulas, and what parts give of a scene that
 * has a tube, a body here, one in a frame that mirrors, and one turned in a cage:
 *
 *     3---2
 *     |   | \       a quad and a triangle in z = 0
 *     0---1--4
 */
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/scene/parts.h"
#include "libcore/scene/placed.h"

enum { VERTICES = 5, TUBE_VERTICES = 6 };

typedef struct Case {
    MesoVec3 positions[VERTICES], normals[VERTICES];
    MesoVec2 uvs[VERTICES];
    MesoMeshColor colors[VERTICES];
    uint32_t corners[8];
    MesoBody bodies[2];
    MesoPlacedBody placed[3];
    MesoFrame frames[2];
    MesoCage cage;
    MesoSweepColumn columns[2];
    MesoSweptKind kind;
    MesoSweepInstance sweep;
    uint32_t ids[8];
    MesoScene scene;
} Case;

static void make_bodies(Case *c)
{
    const MesoVec3 positions[VERTICES] = {{0, 0, 0}, {0.5f, 0, 0}, {0.5f, 1, 0}, {0, 1, 0}, {1, 0, 0}};
    const uint32_t corners[8] = {0, 1, 2, 3, 1, 4, 2, MESO_NO_INDEX};
    memcpy(c->positions, positions, sizeof positions);
    memcpy(c->corners, corners, sizeof corners);
    for (uint32_t i = 0; i < VERTICES; i++) {
        c->normals[i] = (MesoVec3){0, 0, 1};
        c->uvs[i] = (MesoVec2){(float)i, 0.5f};
        c->colors[i] = (MesoMeshColor){(uint8_t)i, 100, 200};
    }
    c->bodies[0] = (MesoBody){VERTICES, 2, 4, c->positions, c->normals, c->uvs, c->colors, c->corners};
    c->bodies[1] = (MesoBody){VERTICES, 1, 3, c->positions, c->normals, NULL, NULL, c->corners + 4};
}

static void make_case(Case *c)
{
    *c = (Case){.ids = {0, 7, 1, 8, 2, 9, 3, 7}};
    make_bodies(c);
    c->frames[0] = (MesoFrame){{-2, 0, 0, 10, 0, 1, 0, 20, 0, 0, 1, 30}};
    c->frames[1] = (MesoFrame){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.25f}};
    c->cage = (MesoCage){{{2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 0}},
                         {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, 1, 5};
    c->placed[0] = (MesoPlacedBody){.body = 0, .material = 1, .ids = 1};
    c->placed[1] = (MesoPlacedBody){.body = 0, .ids = 2, .place = MESO_PLACED_IN_FRAME};
    c->placed[2] = (MesoPlacedBody){.body = 1, .ids = 3, .frame = 1, .place = MESO_PLACED_IN_CAGE, .turn = 1};
    c->columns[0] = (MesoSweepColumn){{1, 0}, {1, 0}, {1, 0}, {1, 0}, 0, 1, .absent = 0};
    c->columns[1] = (MesoSweepColumn){{0, 1}, {0, 1}, {0, 1}, {0, 1}, 1, 0, .absent = 0};
    c->kind = (MesoSweptKind){.column_count = 2, .joint_count = 1, .division_count = 3, .instance_count = 1};
    c->sweep = (MesoSweepInstance){{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}, {{0, 1, 0}, {0, 1, 0}},
                                   {{0, 0, 1}, {0, 0, 1}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}};
    c->scene = (MesoScene){.channel_count = 2, .channels = {{"element", 4, NULL}, {"rule", 10, NULL}},
        .material_count = 2, .id_row_count = 4, .ids = c->ids, .section_scale = 2,
        .kind_count = 1, .column_count = 2, .sweep_count = 1, .kinds = &c->kind, .columns = c->columns,
        .sweeps = &c->sweep, .body_count = 2, .placed_count = 3, .frame_count = 2, .cage_count = 1,
        .bodies = c->bodies, .placed = c->placed, .frames = c->frames, .cages = &c->cage};
    meso_scene_measure(&c->scene);
}

static bool same(MesoVec3 a, float x, float y, float z)
{
    return fabsf(a.x - x) < 1e-5f && fabsf(a.y - y) < 1e-5f && fabsf(a.z - z) < 1e-5f;
}

/* One quarter turn takes (x, y) to (1 - y, x); the cage is 2 wide and from 1 to 5 high. */
static void test_points(void)
{
    Case c;
    make_case(&c);
    MesoVec3 p = {0.5f, 1, 0};
    CHECK(same(meso_placed_point(&c.scene, &c.placed[0], p), 0.5f, 1, 0));
    CHECK(same(meso_placed_point(&c.scene, &c.placed[1], p), 9, 21, 30));
    CHECK(same(meso_placed_point(&c.scene, &c.placed[2], p), 0, 1, 3));
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec2 corner[4] = {{1, 0}, {1, 1}, {0, 1}, {0, 0}};
        MesoVec3 q = meso_cage_corner(&c.cage, i);
        CHECK(same(q, 2 * corner[i & 3].x, 2 * corner[i & 3].y, i & 4 ? 5 : 1));
    }
}

/* Faces look where the normals point, in frames that mirror too. */
static void test_parts(MesoArena *arena)
{
    Case c;
    MesoSceneParts parts;
    MesoMeshVertex v[TUBE_VERTICES + 3 * VERTICES];
    MesoMeshColor colors[TUBE_VERTICES + 3 * VERTICES];
    MesoMeshFace faces[2 + 2 + 2 + 1];
    make_case(&c);
    CHECK(meso_scene_parts_init(&parts, arena, &c.scene, NULL) == MESO_OK);
    CHECK(parts.part_count == 4 && parts.triangle_count == 4 + 3 + 3 + 1);
    CHECK(parts.vertex_begin[4] == TUBE_VERTICES + 3 * VERTICES && parts.face_begin[4] == 7);
    for (uint32_t i = 0; i < 4; i++) {
        MesoPart part = meso_scene_part(&parts, i);
        CHECK(part.ids == i && part.material == (i == 1));
        CHECK(meso_scene_id(&c.scene, part.ids, 0) == i);
    }
    CHECK(meso_scene_id(&c.scene, 2, 1) == 9);

    meso_scene_vertices(&parts, 0, 4, v);
    meso_scene_faces(&parts, 0, 4, 0, faces);
    meso_scene_colors(&parts, 0, 4, colors);
    CHECK(colors[0].r == 255 && colors[TUBE_VERTICES + 3].r == 3 && colors[TUBE_VERTICES + 2 * VERTICES].b == 255);
    CHECK(v[TUBE_VERTICES + 4].uv.x == 4 && v[TUBE_VERTICES + 2 * VERTICES].uv.x == 0);
    CHECK(faces[2].v[3] == TUBE_VERTICES + 3 && faces[3].v[3] == MESO_NO_INDEX);
    CHECK(faces[4].v[1] == TUBE_VERTICES + VERTICES + 3);       /* mirrored: 0, 3, 2, 1 */
    for (uint32_t f = 2; f < 7; f++) {
        const uint32_t *corner = faces[f].v;
        MesoVec3 across = meso_vec3_cross(meso_vec3_sub(v[corner[1]].position, v[corner[0]].position),
                                          meso_vec3_sub(v[corner[2]].position, v[corner[0]].position));
        CHECK(meso_vec3_dot(across, v[corner[0]].normal) > 0);
        CHECK(fabsf(meso_vec3_length(v[corner[0]].normal) - 1) < 1e-5f);
    }
}

static void test_boxes(MesoArena *arena)
{
    Case c;
    MesoSceneParts parts;
    MesoBox box;
    MesoError error;
    make_case(&c);
    CHECK(meso_scene_is_colored(&c.scene));
    CHECK(meso_scene_kind_radius(&c.scene, &c.kind) == 2);
    CHECK(same(c.scene.box.low, -2, -2, -2) && same(c.scene.box.high, 10, 21, 30));
    CHECK(meso_scene_parts_init(&parts, arena, &c.scene, NULL) == MESO_OK);
    CHECK(meso_scene_parts_box(&parts, 2, &box, &error) == MESO_OK);
    CHECK(same(box.low, 0, 0, 0) && same(box.high, 10, 21, 30));

    c.frames[1].m[3] = NAN;
    CHECK(meso_scene_parts_box(&parts, 2, &box, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "element 3: a vertex of its geometry is not finite") == 0);
    c.scene.channel_count = 0;
    CHECK(meso_scene_parts_box(&parts, 2, &box, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "part 3: a vertex of its geometry is not finite") == 0);

    MesoScene nothing = {0};
    meso_scene_measure(&nothing);
    CHECK(nothing.box.low.x > nothing.box.high.x && !meso_scene_is_colored(&nothing));
    CHECK(meso_scene_parts_init(&parts, arena, &nothing, NULL) == MESO_OK && parts.part_count == 0);
}

/* Straight sweeps in many kinds, the farthest of which are somewhere in their midst. */
static void test_threads(MesoArena *arena)
{
    enum { KINDS = 300, EACH = 64, SWEEPS = KINDS * EACH, FAR = 77 * EACH + 5 };
    Case c;
    make_case(&c);
    MesoSweptKind *kinds = MESO_NEW(arena, MesoSweptKind, KINDS, NULL);
    MesoSweepInstance *sweeps = MESO_NEW(arena, MesoSweepInstance, SWEEPS, NULL);
    CHECK(kinds && sweeps);
    for (uint32_t k = 0; k < KINDS; k++) {
        kinds[k] = c.kind;
        kinds[k].instance_begin = k * EACH;
        kinds[k].instance_count = EACH;
    }
    for (uint32_t i = 0; i < SWEEPS; i++) {
        sweeps[i] = c.sweep;
        for (uint32_t k = 0; k < 4; k++)
            sweeps[i].p[k] = (MesoVec3){(float)(i % 100), i == FAR ? -50 : 0, (float)(k + i % 7)};
    }
    MesoScene many = c.scene;
    many.placed_count = 0;
    many.kind_count = KINDS;
    many.sweep_count = SWEEPS;
    many.kinds = kinds;
    many.sweeps = sweeps;
    for (uint32_t threads = 0; threads < 9; threads++) {
        meso_scene_measure_by(&many, threads);
        CHECK(same(many.box.low, -2, -52, -2) && same(many.box.high, 101, 2, 11));
    }
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_points();
    test_parts(&arena);
    test_boxes(&arena);
    test_threads(&arena);
    meso_arena_release(&arena);
    return 0;
}
