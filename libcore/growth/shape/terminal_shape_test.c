/* Shapes that come with the library are closed and look outward; those of meshes are turned, scaled, and in rings. */
#include "libcore/base/check.h"
#include "libcore/growth/shape/terminal_shape.h"

static bool is_same_place(MesoVec3 a, MesoVec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* The first vertex at the place of `v`. */
static uint32_t place_of(const MesoBody *body, uint32_t v)
{
    uint32_t first = 0;
    while (!is_same_place(body->positions[first], body->positions[v]))
        first++;
    return first;
}

/* How often the side from a to b is a triangle's. */
static uint32_t count_sides(const MesoBody *body, uint32_t a, uint32_t b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < 3 * body->face_count; i++) {
        uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
        count += place_of(body, body->corners[i]) == a && place_of(body, body->corners[next]) == b;
    }
    return count;
}

static MesoVec3 triangle_cross(const MesoBody *body, uint32_t t)
{
    const uint32_t *c = body->corners + 3 * t;
    return meso_vec3_cross(meso_vec3_sub(body->positions[c[1]], body->positions[c[0]]),
                           meso_vec3_sub(body->positions[c[2]], body->positions[c[0]]));
}

/* Each side has its opposite once; those of a tube's ends have none. */
static void check_sides(const MesoBody *body, bool open)
{
    for (uint32_t i = 0; i < 3 * body->face_count; i++) {
        uint32_t a = place_of(body, body->corners[i]);
        uint32_t b = place_of(body, body->corners[i % 3 == 2 ? i - 2 : i + 1]);
        float x = body->positions[a].x;
        bool is_border = open && x == body->positions[b].x && (x == 0 || x == 1);
        CHECK(count_sides(body, a, b) == 1);
        CHECK(count_sides(body, b, a) == (is_border ? 0 : 1));
    }
}

/* No corner's normal looks away from its triangle, and the volume within is positive. */
static void check_outward(const MesoBody *body)
{
    double volume = 0;
    for (uint32_t t = 0; t < body->face_count; t++) {
        MesoVec3 cross = triangle_cross(body, t);
        float length = meso_vec3_length(cross);
        CHECK(length > 1e-5f);
        for (uint32_t k = 0; k < 3; k++) {
            MesoVec3 n = body->normals[body->corners[3 * t + k]];
            CHECK(fabsf(meso_vec3_length(n) - 1) < 1e-6f);
            CHECK(meso_vec3_dot(n, cross) > 0.2f * length);
        }
        volume += meso_vec3_dot(body->positions[body->corners[3 * t]], cross) / 6;
    }
    CHECK(volume > 0.004);
}

static void check_rings(const MesoTerminalShape *shape)
{
    CHECK(shape->along[0] == 0 && shape->along[shape->ring_count - 1] == 1);
    CHECK(shape->ring_begin[0] == 0 && shape->ring_begin[shape->ring_count] == shape->body.vertex_count);
    for (uint32_t ring = 0; ring < shape->ring_count; ring++) {
        CHECK(ring == 0 || shape->along[ring] > shape->along[ring - 1]);
        for (uint32_t v = shape->ring_begin[ring]; v < shape->ring_begin[ring + 1]; v++)
            CHECK(shape->body.positions[v].x == shape->along[ring]);
    }
}

static void test_builtin(MesoBuiltinShape kind, uint32_t detail)
{
    MesoArena arena;
    MesoTerminalShape shape;
    float widest[2] = {0, 0}, lowest = 0;
    meso_arena_init(&arena);
    CHECK(!meso_builtin_shape(&shape, &arena, kind, detail, NULL));
    check_rings(&shape);
    check_sides(&shape.body, kind == MESO_BUILTIN_TUBE);
    check_outward(&shape.body);
    for (uint32_t v = 0; v < shape.body.vertex_count; v++) {
        MesoVec3 p = shape.body.positions[v];
        MesoVec2 uv = shape.body.uvs[v];
        widest[p.y > 0] = fmaxf(widest[p.y > 0], fabsf(p.y));
        lowest = fminf(lowest, p.z);
        CHECK(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
    }
    CHECK(fabsf(widest[0] - 0.5f) < 1e-6f && fabsf(widest[1] - 0.5f) < 1e-6f);
    if (kind == MESO_BUILTIN_LEAF || kind == MESO_BUILTIN_SCALE)
        CHECK(lowest == 0);
    if (detail == 0)
        CHECK(shape.body.face_count <= 64);
    meso_arena_release(&arena);
}

/* Of what is round, all normals are those of the ball or the tube, and lie apart by the fineness alone. */
static void test_round(void)
{
    MesoArena arena;
    MesoTerminalShape bead, tube;
    meso_arena_init(&arena);
    CHECK(!meso_builtin_shape(&bead, &arena, MESO_BUILTIN_BEAD, 3, NULL));
    CHECK(!meso_builtin_shape(&tube, &arena, MESO_BUILTIN_TUBE, 3, NULL));
    for (uint32_t v = 0; v < bead.body.vertex_count; v++) {
        MesoVec3 p = bead.body.positions[v], n = bead.body.normals[v];
        MesoVec3 exact = {2 * p.x - 1, 2 * p.y, 2 * p.z};
        CHECK(meso_vec3_length(meso_vec3_sub(exact, n)) < 1e-5f);
    }
    for (uint32_t v = 0; v < tube.body.vertex_count; v++) {
        MesoVec3 p = tube.body.positions[v], n = tube.body.normals[v];
        MesoVec3 exact = {0, 2 * p.y, 2 * p.z};
        CHECK(meso_vec3_length(meso_vec3_sub(exact, n)) < 1e-6f);
    }
    meso_arena_release(&arena);
}

/*
 *   3 --- 2     a quad that stands on z = -2 and goes up to z = 6: 4 wide,
 *   |     |     with one corner a little below the other
 *   0 --- 1
 */
static void test_mesh(void)
{
    MesoVec3 positions[4] = {{-1, 0, -2}, {3, 0, -2 + 2e-6f}, {3, 0, 6}, {-1, 0, 6}};
    MesoVec3 slope = {0, -0.6f, 0.8f}, normals[4] = {slope, slope, slope, slope};
    MesoVec2 uvs[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    uint32_t corners[8] = {2, 3, 0, 1, 0, 1, 2, MESO_NO_INDEX};
    MesoBody mesh = {4, 2, 4, positions, normals, uvs, NULL, corners};
    MesoArena arena;
    MesoTerminalShape shape;
    meso_arena_init(&arena);
    CHECK(!meso_terminal_shape_build(&shape, &arena, &mesh, MESO_SHAPE_ALONG_Z, NULL));
    check_rings(&shape);
    CHECK(shape.ring_count == 2 && shape.ring_begin[1] == 2);
    CHECK(is_same_place(shape.body.positions[0], (MesoVec3){0, -0.25f, 0}));
    CHECK(is_same_place(shape.body.positions[2], (MesoVec3){1, 0.75f, 0}));
    CHECK(shape.body.uvs[2].x == 1 && shape.body.uvs[2].y == 1);
    CHECK(!memcmp(shape.body.corners, corners, sizeof corners));

    /* Along z, left, up: the slope of 0.8 over 8 to 0.6 over 4. */
    MesoVec3 n = shape.body.normals[0], exact = meso_vec3_unit((MesoVec3){6.4f, 0, -2.4f}, n);
    CHECK(meso_vec3_length(meso_vec3_sub(n, exact)) < 1e-6f);
    meso_arena_release(&arena);
}

static void check_refused(MesoBody mesh, MesoShapeAxis axis, const char *message)
{
    MesoArena arena;
    MesoTerminalShape shape;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(meso_terminal_shape_build(&shape, &arena, &mesh, axis, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
    meso_arena_release(&arena);
}

static void test_refused(void)
{
    MesoVec3 flat[3] = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, line[2] = {{0, 2, 3}, {1, 2, 3}};
    MesoVec3 lost[1] = {{0, NAN, 0}}, normals[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    check_refused((MesoBody){.face_width = 3}, MESO_SHAPE_ALONG_X, "the shape has no vertices");
    check_refused((MesoBody){.vertex_count = 3, .face_width = 3, .positions = flat, .normals = normals},
                  MESO_SHAPE_ALONG_Z, "the shape has no length along z");
    check_refused((MesoBody){.vertex_count = 2, .face_width = 3, .positions = line, .normals = normals},
                  MESO_SHAPE_ALONG_X, "the shape is a line along x");
    check_refused((MesoBody){.vertex_count = 1, .face_width = 3, .positions = lost, .normals = normals},
                  MESO_SHAPE_ALONG_X, "vertex 0 of the shape is not finite");
}

int main(void)
{
    for (MesoBuiltinShape kind = 0; kind < MESO_BUILTIN_SHAPES; kind++)
        for (uint32_t detail = 0; detail < 3; detail++)
            test_builtin(kind, detail);
    test_round();
    test_mesh();
    test_refused();
    return 0;
}
