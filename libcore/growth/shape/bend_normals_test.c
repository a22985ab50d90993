/* Bending: normals against differences of places; what has no direction; threads, lanes, folds, bodies. */
#include "libcore/growth/shape/bend_fixture.h"
#include "libcore/growth/shape/bend_kernel.h"

/* The point (t, y, z) and four around it, at `h` both ways along two directions of the plane across `n`. */
static void differ(const MesoJoint joints[2], MesoVec3 at, MesoVec3 n, float h, MesoVec3 *normal, MesoVec3 *difference)
{
    MesoVec3 a = meso_vec3_unit(meso_vec3_cross((MesoVec3){0, fabsf(n.y) < 0.7f, fabsf(n.y) >= 0.7f}, n), n);
    MesoVec3 b = meso_vec3_cross(n, a), places[5], normals[5] = {n, n, n, n, n}, bent[5], bent_normals[5];
    float along[5];
    uint32_t ring_begin[6] = {0, 1, 2, 3, 4, 5};
    places[0] = at;
    places[1] = meso_vec3_mad(at, -h, a);
    places[2] = meso_vec3_mad(at, h, a);
    places[3] = meso_vec3_mad(at, -h, b);
    places[4] = meso_vec3_mad(at, h, b);
    for (uint32_t v = 0; v < 5; v++)
        along[v] = places[v].x;
    MesoTerminalShape shape = {{5, 0, 3, places, normals, NULL, NULL, NULL}, 5, along, ring_begin};
    meso_test_bend(&shape, joints[0], joints[1], bent, bent_normals);
    MesoVec3 cross = meso_vec3_cross(meso_vec3_sub(bent[2], bent[1]), meso_vec3_sub(bent[4], bent[3]));
    *normal = bent_normals[0];
    *difference = meso_vec3_unit(cross, n);
}

static void test_normals(void)
{
    enum { JOINTS = 60 };
    MesoJoint joints[JOINTS];
    MesoRandom random;
    double sum = 0;
    float worst = 0;
    meso_random_init(&random, 3, 0);
    meso_test_strand(joints, JOINTS, 11, 0.25f);
    for (uint32_t i = 0; i < JOINTS; i++)
        joints[i].flare = 0.2f * meso_test_number(&random);
    for (uint32_t i = 0; i < 100 * (JOINTS - 1); i++) {
        float t = 0.5f + 0.45f * meso_test_number(&random);
        MesoVec3 at = {t, 0.5f * meso_test_number(&random), 0.5f * meso_test_number(&random)};
        MesoVec3 normal, difference;
        differ(&joints[i / 100], at, meso_test_direction(&random), 0.01f, &normal, &difference);
        float apart = meso_test_apart(normal, difference);
        worst = fmaxf(worst, apart);
        sum += apart;
    }
    CHECK(worst < 2e-3f);
    CHECK(sum / (100 * (JOINTS - 1)) < 2e-4);
}

/* What has no direction somewhere: joints in one place, opposite tangents and normals, no width, hardly a length. */
static void test_degenerate(void)
{
    MesoVec3 o = {0, 0, 0}, x = {1, 0, 0}, z = {0, 0, 1}, back = {-1, 0, 0}, down = {0, 0, -1};
    const MesoJoint joints[] = {
        {o, x, z, 1, 0}, {o, back, z, 1, 0}, {x, x, down, 0, 0}, {x, back, z, 0, -5}, {x, back, down, 2, 0},
        {{1e-20f, 0, 0}, x, z, 1e-20f, 0}, {back, x, z, 1, 5}, {{0, 0, 1e15f}, z, x, 1e10f, 0},
    };
    enum { COUNT = sizeof joints / sizeof *joints, MOST = 64 };
    for (MesoBuiltinShape kind = 0; kind < MESO_BUILTIN_SHAPES; kind++) {
        MesoVec3 positions[MOST], normals[MOST];
        MesoArena arena;
        MesoTerminalShape shape;
        meso_arena_init(&arena);
        CHECK(!meso_builtin_shape(&shape, &arena, kind, 0, NULL));
        CHECK(shape.body.vertex_count <= MOST);
        for (uint32_t pair = 0; pair < COUNT * COUNT; pair++) {
            meso_test_bend(&shape, joints[pair / COUNT], joints[pair % COUNT], positions, normals);
            for (uint32_t v = 0; v < shape.body.vertex_count; v++) {
                CHECK(meso_vec3_finite(positions[v]));
                CHECK(fabsf(meso_vec3_length(normals[v]) - 1) < 0.01f);
            }
        }
        meso_arena_release(&arena);
    }
}

/* Of as many spans as a thread takes at once, and of what is left. */
static void check_boxes(const MesoBending *bending)
{
    uint32_t vertices = bending->shape->body.vertex_count, count = meso_bend_box_count(bending->span_count);
    CHECK(count == (bending->span_count + MESO_BEND_GRAIN - 1) / MESO_BEND_GRAIN);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t first = i * MESO_BEND_GRAIN, rest = bending->span_count - first;
        uint32_t spans = rest < MESO_BEND_GRAIN ? rest : MESO_BEND_GRAIN;
        MesoBox box = meso_box_of(bending->positions + (size_t)first * vertices, spans * vertices);
        CHECK(!memcmp(&box, &bending->boxes[i], sizeof box));
    }
}

/* The same bytes for any number of threads, and in whatever order spans are asked for. */
static void test_threads(void)
{
    enum { JOINTS = 5000, SPANS = JOINTS - 1 };
    MesoArena arena;
    MesoTerminalShape shape;
    meso_arena_init(&arena);
    CHECK(!meso_builtin_shape(&shape, &arena, MESO_BUILTIN_LEAF, 0, NULL));
    MesoJoint *joints = MESO_NEW(&arena, MesoJoint, JOINTS, NULL);
    MesoSpan *spans = MESO_NEW(&arena, MesoSpan, SPANS, NULL);
    uint32_t vertices = shape.body.vertex_count;
    MesoBending runs[4];
    CHECK(joints && spans);
    meso_test_strand(joints, JOINTS, 1, 0.2f);
    for (uint32_t run = 0; run < 4; run++) {
        const uint32_t threads[4] = {1, 2, 7, 2};
        for (uint32_t i = 0; i < SPANS; i++) {
            uint32_t from = run == 3 ? SPANS - 1 - i : i;
            spans[i] = (MesoSpan){from, from + 1};
        }
        runs[run] = (MesoBending){.shape = &shape, .joints = joints, .spans = spans, .span_count = SPANS};
        runs[run].positions = MESO_NEW(&arena, MesoVec3, (size_t)SPANS * vertices, NULL);
        runs[run].normals = MESO_NEW(&arena, MesoVec3, (size_t)SPANS * vertices, NULL);
        runs[run].folds = MESO_NEW(&arena, uint8_t, SPANS, NULL);
        runs[run].boxes = MESO_NEW(&arena, MesoBox, meso_bend_box_count(SPANS), NULL);
        CHECK(runs[run].positions && runs[run].normals && runs[run].folds && runs[run].boxes);
        meso_bend(&runs[run], threads[run]);
        check_boxes(&runs[run]);
    }
    for (uint32_t i = 0; i < SPANS; i++) {
        for (uint32_t run = 1; run < 4; run++) {
            size_t here = (size_t)i * vertices, there = (size_t)(run == 3 ? SPANS - 1 - i : i) * vertices;
            CHECK(!memcmp(runs[0].positions + here, runs[run].positions + there, vertices * sizeof(MesoVec3)));
            CHECK(!memcmp(runs[0].normals + here, runs[run].normals + there, vertices * sizeof(MesoVec3)));
            CHECK(runs[0].folds[i] == runs[run].folds[there / vertices]);
        }
    }
    meso_arena_release(&arena);
}

/* The same bytes, whatever registers the machine has. */
static void test_registers(void)
{
    enum { MOST = 64 };
    MesoJoint joints[MESO_LANES + 1];
    MesoSpan spans[MESO_LANES];
    MesoVec3 positions[2][MESO_LANES * MOST], normals[2][MESO_LANES * MOST];
    MesoArena arena;
    MesoTerminalShape shape;
    MesoBendGroup group;
    meso_arena_init(&arena);
    CHECK(!meso_builtin_shape(&shape, &arena, MESO_BUILTIN_LINK, 0, NULL));
    uint32_t vertices = shape.body.vertex_count;
    CHECK(vertices <= MOST);
    meso_test_strand(joints, MESO_LANES + 1, 9, 0.4f);
    for (uint32_t i = 0; i < MESO_LANES; i++) {
        spans[i] = (MesoSpan){i, i + 1};
        group.from[i] = &joints[i];
        group.to[i] = &joints[i + 1];
        group.positions[i] = positions[1] + i * vertices;
        group.normals[i] = normals[1] + i * vertices;
    }
    MesoBending bending = {&shape, joints, MESO_LANES, spans, positions[0], normals[0], NULL, NULL};
    meso_bend(&bending, 1);
    meso_bend_group(&shape, &group);
    CHECK(!memcmp(positions[0], positions[1], MESO_LANES * vertices * sizeof(MesoVec3)));
    CHECK(!memcmp(normals[0], normals[1], MESO_LANES * vertices * sizeof(MesoVec3)));
    meso_arena_release(&arena);
}

/* Around a quarter of a circle of radius 1: what is narrower than twice the radius does not go through itself. */
static void test_folds(void)
{
    const float widths[2] = {1.8f, 2.4f};
    for (uint32_t i = 0; i < 2; i++) {
        MesoVec3 o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1}, positions[64], normals[64];
        MesoVec3 corner = {1, 1, 0};
        MesoJoint joints[2] = {meso_joint(o, z, x, x, widths[i], 0), meso_joint(corner, z, y, y, widths[i], 0)};
        MesoSpan span = {0, 1};
        uint8_t folds = 2;
        MesoArena arena;
        MesoTerminalShape shape;
        meso_arena_init(&arena);
        CHECK(!meso_builtin_shape(&shape, &arena, MESO_BUILTIN_TUBE, 0, NULL));
        MesoBending bending = {&shape, joints, 1, &span, positions, normals, &folds, NULL};
        meso_bend(&bending, 1);
        CHECK(folds == i);
        meso_arena_release(&arena);
    }
}

/* As bodies for each span, and as one. */
static void test_bodies(void)
{
    enum { SPANS = 5 };
    MesoJoint joints[SPANS + 1];
    MesoSpan spans[SPANS];
    MesoBody each[SPANS], all;
    MesoArena arena;
    MesoTerminalShape shape;
    meso_arena_init(&arena);
    CHECK(!meso_builtin_shape(&shape, &arena, MESO_BUILTIN_SCALE, 0, NULL));
    meso_test_strand(joints, SPANS + 1, 2, 0.2f);
    for (uint32_t i = 0; i < SPANS; i++)
        spans[i] = (MesoSpan){i, i + 1};
    uint32_t vertices = shape.body.vertex_count, corners = 3 * shape.body.face_count;
    MesoBending bending = {&shape, joints, SPANS, spans, MESO_NEW(&arena, MesoVec3, SPANS * vertices, NULL),
                           MESO_NEW(&arena, MesoVec3, SPANS * vertices, NULL), NULL, NULL};
    meso_bend(&bending, 1);
    meso_bent_bodies(&bending, each);
    CHECK(!meso_bent_body(&bending, &arena, &all, NULL));
    CHECK(all.vertex_count == SPANS * vertices && all.face_count == SPANS * shape.body.face_count);
    for (uint32_t i = 0; i < SPANS; i++) {
        CHECK(each[i].vertex_count == vertices && each[i].corners == shape.body.corners);
        for (uint32_t k = 0; k < corners; k++) {
            uint32_t v = each[i].corners[k], w = all.corners[i * corners + k];
            CHECK(!memcmp(&each[i].positions[v], &all.positions[w], sizeof(MesoVec3)));
            CHECK(!memcmp(&each[i].normals[v], &all.normals[w], sizeof(MesoVec3)));
            CHECK(!memcmp(&each[i].uvs[v], &all.uvs[w], sizeof(MesoVec2)));
        }
    }
    bending.span_count = UINT32_MAX;
    CHECK(meso_bent_body(&bending, &arena, &all, NULL) == MESO_ERR_LIMIT);
    bending.span_count = 0;
    CHECK(!meso_bent_body(&bending, &arena, &all, NULL) && all.vertex_count == 0 && all.face_count == 0);
    meso_bend(&bending, 1);
    meso_arena_release(&arena);
}

int main(void)
{
    test_normals();
    test_degenerate();
    test_threads();
    test_registers();
    test_folds();
    test_bodies();
    return 0;
}
