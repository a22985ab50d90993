/* Bending: what is straight, arcs and cones by formula; joints in the same floats; normals against differences. */
#include "libcore/growth/shape/bend_fixture.h"

enum { MOST = 512 };

static void make_shape(MesoTerminalShape *shape, MesoArena *arena, MesoBuiltinShape kind, uint32_t detail)
{
    CHECK(!meso_builtin_shape(shape, arena, kind, detail, NULL));
    CHECK(shape->body.vertex_count <= MOST);
}

/* Along x, from 0 to 1, one wide: every shape is as it was. */
static void test_straight(MesoBuiltinShape kind)
{
    MesoVec3 x = {1, 0, 0}, z = {0, 0, 1}, positions[MOST], normals[MOST];
    MesoArena arena;
    MesoTerminalShape shape;
    meso_arena_init(&arena);
    make_shape(&shape, &arena, kind, 1);
    MesoJoint from = meso_joint((MesoVec3){0, 0, 0}, z, x, x, 1, 0), to = meso_joint(x, z, x, x, 1, 0);
    meso_test_bend(&shape, from, to, positions, normals);
    for (uint32_t v = 0; v < shape.body.vertex_count; v++) {
        CHECK(meso_test_apart(positions[v], shape.body.positions[v]) < 3e-7f);
        CHECK(meso_test_apart(normals[v], shape.body.normals[v]) < 1e-6f);
    }
    meso_arena_release(&arena);
}

static MesoJoint circle_joint(float angle, float radius, float width)
{
    MesoVec3 normal = {0, -sinf(angle), cosf(angle)}, heading = {0, -cosf(angle), -sinf(angle)};
    return meso_joint(meso_vec3_scale(normal, radius), normal, heading, heading, width, 0);
}

/* A tube bent to an arc is a part of a torus, with its normals. */
static void test_arc(float angle, float tolerance)
{
    const float radius = 2, width = 0.5f;
    MesoVec3 positions[MOST], normals[MOST];
    MesoArena arena;
    MesoTerminalShape shape;
    meso_arena_init(&arena);
    make_shape(&shape, &arena, MESO_BUILTIN_TUBE, 4);
    meso_test_bend(&shape, circle_joint(0, radius, width), circle_joint(angle, radius, width), positions, normals);
    for (uint32_t v = 0; v < shape.body.vertex_count; v++) {
        MesoVec3 p = positions[v];
        MesoVec3 centre = meso_vec3_unit((MesoVec3){0, p.y, p.z}, p);
        MesoVec3 out = meso_vec3_mad(p, -radius, centre);
        CHECK(fabsf(meso_vec3_length(out) - width / 2) < tolerance * radius);
        CHECK(meso_test_apart(meso_vec3_unit(out, out), normals[v]) < 10 * tolerance);
    }
    MesoJoint from = circle_joint(0, radius, width), to = circle_joint(angle, radius, width);
    for (float t = 0; t <= 1; t += 0.0625f) {
        MesoBendFrame frame = meso_bend_frame(&from, &to, t);
        CHECK(fabsf(meso_vec3_length(frame.origin) - radius) < tolerance * radius);
        CHECK(meso_test_apart(frame.left, (MesoVec3){1, 0, 0}) < 1e-5f);
    }
    meso_arena_release(&arena);
}

/* Flares that go on as the width does: a straight cone. */
static void test_cone(void)
{
    MesoVec3 x = {1, 0, 0}, z = {0, 0, 1}, positions[MOST], normals[MOST];
    MesoArena arena;
    MesoTerminalShape shape;
    meso_arena_init(&arena);
    make_shape(&shape, &arena, MESO_BUILTIN_TUBE, 2);
    MesoJoint from = meso_joint((MesoVec3){0, 0, 0}, z, x, x, 1, 0);
    MesoJoint to = meso_joint((MesoVec3){2, 0, 0}, z, x, x, 0.4f, 0);
    from.flare = to.flare = -0.3f;
    meso_test_bend(&shape, from, to, positions, normals);
    for (uint32_t v = 0; v < shape.body.vertex_count; v++) {
        MesoVec3 p = positions[v], flat = {0, p.y, p.z};
        MesoVec3 exact = meso_vec3_unit(meso_vec3_add(meso_vec3_unit(flat, z), (MesoVec3){0.15f, 0, 0}), z);
        CHECK(fabsf(meso_vec3_length(flat) - 0.5f * (1 - 0.3f * p.x)) < 1e-6f);
        CHECK(meso_test_apart(exact, normals[v]) < 1e-6f);
    }
    meso_arena_release(&arena);
}

/* A quarter turn of the normal along a line: by half the way it is half done, and no twist is at the ends. */
static void test_roll(void)
{
    MesoVec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    MesoJoint from = meso_joint((MesoVec3){0, 0, 0}, z, x, x, 1, 0);
    MesoJoint to = meso_joint_roll(meso_joint(x, z, x, x, 1, 0), (float)MESO_PI / 2);
    CHECK(meso_test_apart(to.normal, meso_vec3_scale(y, -1)) < 1e-6f);
    MesoBendFrame half = meso_bend_frame(&from, &to, 0.5f);
    CHECK(meso_test_apart(half.normal, (MesoVec3){0, -sqrtf(0.5f), sqrtf(0.5f)}) < 1e-6f);
    CHECK(meso_test_apart(meso_bend_frame(&from, &to, 1e-3f).normal, z) < 1e-5f);
    CHECK(meso_test_apart(meso_bend_frame(&from, &to, 1 - 1e-3f).normal, to.normal) < 1e-5f);
}

/* A joint's tangent halves the angle of what comes and goes, in the tangent plane; the paper's where it is G1 too. */
static void test_joint(void)
{
    MesoVec3 o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 3, 0}, z = {0, 0, 1};
    MesoJoint corner = meso_joint(o, z, (MesoVec3){1, 0, 0.5f}, y, 2, 0.25f);
    CHECK(meso_test_apart(corner.tangent, (MesoVec3){sqrtf(0.5f), sqrtf(0.5f), 0}) < 1e-6f);
    CHECK(corner.position.z == 0.25f && corner.width == 2 && corner.flare == 0);
    CHECK(meso_test_apart(meso_joint(o, z, o, y, 1, 0).tangent, (MesoVec3){0, 1, 0}) < 1e-6f);
    CHECK(meso_test_apart(meso_joint(o, z, y, o, 1, 0).tangent, (MesoVec3){0, 1, 0}) < 1e-6f);
    CHECK(meso_test_apart(meso_joint(o, z, x, meso_vec3_scale(x, -2), 1, 0).tangent, x) < 1e-6f);
    MesoJoint lost = meso_joint(o, z, o, z, 1, 0);
    CHECK(fabsf(meso_vec3_length(lost.tangent) - 1) < 1e-6f && fabsf(lost.tangent.z) < 1e-6f);
}

/* The paper's inner points, where its condition holds: thirds of the chord, projected, are on our tangents. */
static void test_paper(void)
{
    MesoRandom random;
    meso_random_init(&random, 7, 0);
    for (uint32_t i = 0; i < 1000; i++) {
        MesoVec3 before = meso_test_direction(&random), after = meso_test_direction(&random);
        if (meso_vec3_dot(before, after) < -0.8f)
            continue;
        MesoVec3 sum = meso_vec3_unit(meso_vec3_add(before, after), before);
        MesoVec3 normal = meso_vec3_sub(after, before);
        normal = meso_vec3_unit(meso_vec3_mad(normal, -meso_vec3_dot(normal, sum), sum), sum);
        MesoVec3 o = {0, 0, 0};
        MesoJoint joint = meso_joint(o, normal, before, after, 1, 0), next = meso_joint(after, normal, after, o, 1, 0);
        MesoVec3 third = meso_vec3_scale(after, 1.0f / 3), p[4];
        MesoVec3 projected = meso_vec3_mad(third, -meso_vec3_dot(third, normal), normal);
        meso_bend_curve(&joint, &next, p);
        CHECK(meso_test_apart(meso_vec3_unit(projected, o), meso_vec3_unit(p[1], o)) < 1e-5f);
        CHECK(meso_vec3_length(p[1]) >= meso_vec3_length(projected) - 1e-6f);
    }
}

/* Along a strand: the end of each tube is the start of the next, float by float; normals and tangents agree to 1e-5. */
static void test_strand(uint64_t seed)
{
    enum { JOINTS = 40 };
    MesoJoint joints[JOINTS];
    MesoVec3 positions[2][MOST], normals[2][MOST];
    MesoArena arena;
    MesoTerminalShape tube;
    meso_arena_init(&arena);
    make_shape(&tube, &arena, MESO_BUILTIN_TUBE, 1);
    meso_test_strand(joints, JOINTS, seed, 0.2f);
    uint32_t around = tube.ring_begin[1], end = tube.body.vertex_count - around;
    for (uint32_t i = 0; i + 1 < JOINTS; i++) {
        uint32_t here = i & 1, before = here ^ 1;
        MesoVec3 p[4];
        meso_test_bend(&tube, joints[i], joints[i + 1], positions[here], normals[here]);
        meso_bend_curve(&joints[i], &joints[i + 1], p);
        CHECK(meso_test_apart(meso_vec3_unit(meso_vec3_sub(p[1], p[0]), p[0]), joints[i].tangent) < 1e-5f);
        CHECK(meso_test_apart(meso_vec3_unit(meso_vec3_sub(p[3], p[2]), p[0]), joints[i + 1].tangent) < 1e-5f);
        for (uint32_t k = 0; i > 0 && k < around; k++) {
            CHECK(!memcmp(&positions[before][end + k], &positions[here][k], sizeof(MesoVec3)));
            CHECK(meso_test_apart(normals[before][end + k], normals[here][k]) < 1e-5f);
        }
    }
    meso_arena_release(&arena);
}

/* A ribbon's normals agree at joints too, where its edges twist before and behind: tangents of edges by differences. */
static void test_ribbon(uint64_t seed)
{
    enum { JOINTS = 20 };
    const float h = 0.01f;
    float along[4] = {0, h, 1 - h, 1};
    uint32_t ring_begin[5] = {0, 2, 4, 6, 8};
    MesoVec3 places[8], up[8], positions[JOINTS][8], normals[JOINTS][8];
    for (uint32_t v = 0; v < 8; v++) {
        places[v] = (MesoVec3){along[v / 2], v & 1 ? 0.5f : -0.5f, 0};
        up[v] = (MesoVec3){0, 0, 1};
    }
    MesoTerminalShape ribbon = {{8, 0, 3, places, up, NULL, NULL, NULL}, 4, along, ring_begin};
    MesoJoint joints[JOINTS];
    meso_test_strand(joints, JOINTS, seed, 0.3f);
    for (uint32_t i = 0; i + 1 < JOINTS; i++) {
        meso_test_bend(&ribbon, joints[i], joints[i + 1], positions[i], normals[i]);
        for (uint32_t k = 0; i > 0 && k < 2; k++) {
            MesoVec3 in = meso_vec3_sub(positions[i - 1][6 + k], positions[i - 1][4 + k]);
            MesoVec3 out = meso_vec3_sub(positions[i][2 + k], positions[i][k]);
            CHECK(meso_test_apart(normals[i - 1][6 + k], normals[i][k]) < 1e-5f);
            CHECK(meso_test_apart(meso_vec3_unit(in, in), joints[i].tangent) < 0.1f);
            CHECK(meso_test_apart(meso_vec3_unit(out, out), joints[i].tangent) < 0.1f);
        }
    }
}

/* Swapped joints, with tangents turned: the same curve. */
static void test_reverse(void)
{
    MesoJoint joints[20];
    meso_test_strand(joints, 20, 5, 0.2f);
    for (uint32_t i = 0; i + 1 < 20; i++) {
        MesoJoint from = joints[i + 1], to = joints[i];
        from.tangent = meso_vec3_scale(from.tangent, -1);
        to.tangent = meso_vec3_scale(to.tangent, -1);
        for (float t = 0; t <= 1; t += 0.125f) {
            MesoBendFrame there = meso_bend_frame(&joints[i], &joints[i + 1], t);
            MesoBendFrame back = meso_bend_frame(&from, &to, 1 - t);
            CHECK(meso_test_apart(there.origin, back.origin) < 1e-5f);
            CHECK(meso_test_apart(there.normal, back.normal) < 1e-4f);
            CHECK(fabsf(there.width - back.width) < 1e-6f);
        }
    }
}

int main(void)
{
    for (MesoBuiltinShape kind = 0; kind < MESO_BUILTIN_SHAPES; kind++)
        test_straight(kind);
    test_arc((float)MESO_PI / 2, 3e-4f);
    test_arc((float)MESO_PI / 9, 1e-6f);
    test_cone();
    test_roll();
    test_joint();
    test_paper();
    for (uint64_t seed = 1; seed <= 20; seed++) {
        test_strand(seed);
        test_ribbon(seed);
    }
    test_reverse();
    return 0;
}
