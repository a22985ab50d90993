/* Orientation of slots: grids whose corner lists are scrambled, cubes, bands, exact small cases. */
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/mesh/orientation.h"

enum { MOST_FACES = 64 };

static MesoArena arena;
static MesoError error;

static MesoQuadMesh build(uint32_t vertex_count, const MesoVec3 *positions, uint32_t face_count,
                          const uint32_t *faces)
{
    MesoQuadMesh mesh;
    CHECK(meso_quad_mesh_build(&mesh, &arena, vertex_count, positions, 0, NULL, face_count, faces, NULL,
                               &error) == MESO_OK);
    return mesh;
}

static MesoSlotGraph graph_of(const MesoQuadMesh *mesh)
{
    MesoSlotGraph graph;
    CHECK(meso_slot_graph_build(&graph, &arena, mesh, &error) == MESO_OK);
    return graph;
}

/*
 * Grid in the plane of x and y, face y * width + x; face corners (x+1,y), (x+1,y+1), (x,y+1), (x,y),
 * so that side 0 is towards +x. With `wrap`, rows and columns close.
 */
static MesoQuadMesh grid(uint32_t width, uint32_t height, bool wrap)
{
    uint32_t across = wrap ? width : width + 1, up = wrap ? height : height + 1;
    MesoVec3 positions[MOST_FACES * 2];
    uint32_t faces[4 * MOST_FACES];
    for (uint32_t v = 0; v < across * up; v++)
        positions[v] = (MesoVec3){(float)(v % across), (float)(v / across), 0};
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint32_t x1 = (x + 1) % across, y1 = (y + 1) % up;
            uint32_t face[4] = {y * across + x1, y1 * across + x1, y1 * across + x, y * across + x};
            memcpy(faces + 4 * (y * width + x), face, sizeof face);
        }
    return build(across * up, positions, width * height, faces);
}

/* Corner i of vertex number is bit 0: x, 1: y, 2: z; faces run counter-clockwise from outside. */
static MesoQuadMesh cube(void)
{
    const uint32_t faces[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    MesoVec3 positions[8];
    for (uint32_t v = 0; v < 8; v++)
        positions[v] = (MesoVec3){(float)(v & 1), (float)(v >> 1 & 1), (float)(v >> 2)};
    return build(8, positions, 6, faces);
}

static void scramble(MesoQuadMesh *mesh, uint64_t seed)
{
    uint8_t quarters[MOST_FACES];
    MesoRandom random;
    meso_random_init(&random, seed, 0);
    for (uint32_t f = 0; f < mesh->face_count; f++)
        quarters[f] = (uint8_t)meso_random_below(&random, 4);
    CHECK(meso_orientation_turn_mesh(mesh, &arena, quarters, &error) == MESO_OK);
}

/* Turning the graph gives what building it from the turned mesh does. */
static void check_turn(MesoQuadMesh mesh, const uint8_t *quarters)
{
    MesoSlotGraph turned = graph_of(&mesh);
    CHECK(meso_orientation_turn_graph(&turned, &arena, quarters, &error) == MESO_OK);
    CHECK(meso_orientation_turn_mesh(&mesh, &arena, quarters, &error) == MESO_OK);
    MesoSlotGraph built = graph_of(&mesh);
    CHECK(memcmp(turned.twin, built.twin, 16 * (size_t)mesh.face_count) == 0);
}

/* Where all can agree they do, however the corner lists begin; slot 0 stays. */
static void test_flat(void)
{
    for (uint32_t seed = 0; seed < 20; seed++) {
        MesoQuadMesh mesh = grid(5 + seed % 3, 4, seed % 2);
        uint8_t quarters[MOST_FACES];
        uint32_t singular, vertices[8];
        scramble(&mesh, seed);
        MesoVec3 first = mesh.positions[mesh.face_vertices[0]];
        MesoSlotGraph graph = graph_of(&mesh);
        CHECK(meso_orientation_comb(quarters, &arena, &graph, &error) == MESO_OK);
        CHECK(quarters[0] == 0);
        CHECK(meso_orientation_disagreeing(&graph, quarters) == 0);
        CHECK(meso_orientation_singular(&singular, vertices, 8, &arena, &mesh, &graph, &error) == MESO_OK);
        CHECK(singular == 0);
        check_turn(mesh, quarters);
        CHECK(meso_orientation_turn_mesh(&mesh, &arena, quarters, &error) == MESO_OK);
        MesoVec3 same = mesh.positions[mesh.face_vertices[0]];
        CHECK(first.x == same.x && first.y == same.y);
        meso_arena_release(&arena);
    }
}

/* On a cube, eight singular corners; no orientation has fewer than six disagreeing edges. */
static uint32_t least_of_cube(const MesoSlotGraph *graph)
{
    uint32_t least = graph->edge_count;
    for (uint32_t code = 0; code < 1u << 12; code++) {
        uint8_t quarters[6];
        for (uint32_t f = 0; f < 6; f++)
            quarters[f] = (uint8_t)(code >> 2 * f & 3);
        uint32_t count = meso_orientation_disagreeing(graph, quarters);
        least = count < least ? count : least;
    }
    return least;
}

static void test_cube(void)
{
    MesoQuadMesh mesh = cube();
    MesoSlotGraph graph = graph_of(&mesh);
    uint8_t quarters[6];
    uint32_t singular, vertices[5] = {0};
    CHECK(meso_orientation_comb(quarters, &arena, &graph, &error) == MESO_OK);
    CHECK(meso_orientation_disagreeing(&graph, quarters) == least_of_cube(&graph));
    CHECK(meso_orientation_singular(&singular, vertices, 5, &arena, &mesh, &graph, &error) == MESO_OK);
    CHECK(singular == 8);
    for (uint32_t i = 0; i < 5; i++)
        CHECK(vertices[i] == i);
    check_turn(mesh, quarters);
    meso_arena_release(&arena);
}

/*
 * A band of three faces, closed after half a turn: the last column meets the
 * first upside down. No vertex is inside; across the band all agree.
 */
static void test_band(void)
{
    const uint32_t faces[12] = {2, 3, 1, 0, 4, 5, 3, 2, 1, 0, 5, 4};
    MesoVec3 positions[6];
    for (uint32_t v = 0; v < 6; v++)
        positions[v] = (MesoVec3){(float)(v / 2), (float)(v % 2), (float)(v == 5)};
    MesoQuadMesh mesh = build(6, positions, 3, faces);
    MesoSlotGraph graph = graph_of(&mesh);
    uint8_t quarters[3];
    uint32_t singular, vertex;
    CHECK(graph.reversed_count == 1 && graph.border_count == 6);
    CHECK(meso_orientation_comb(quarters, &arena, &graph, &error) == MESO_OK);
    CHECK(meso_orientation_disagreeing(&graph, quarters) == 0);
    CHECK(meso_orientation_singular(&singular, &vertex, 1, &arena, &mesh, &graph, &error) == MESO_OK);
    CHECK(singular == 0);
    check_turn(mesh, quarters);
    meso_arena_release(&arena);
}

/* Three faces around vertex 0, one of them wound the other way: singular all the same. */
static void test_reversed(void)
{
    const uint32_t faces[12] = {0, 1, 2, 3, 0, 5, 4, 3, 0, 5, 6, 1};
    const MesoVec3 positions[7] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {-2, 2, 0}, {-1, 0, 0}, {1, -2, 0}};
    MesoQuadMesh mesh = build(7, positions, 3, faces);
    MesoSlotGraph graph = graph_of(&mesh);
    uint32_t singular, vertex = 9;
    CHECK(graph.reversed_count == 2);
    CHECK(meso_orientation_singular(&singular, &vertex, 1, &arena, &mesh, &graph, &error) == MESO_OK);
    CHECK(singular == 1 && vertex == 0);
    meso_arena_release(&arena);
}

/* A field of one direction, with faces that it does not help. */
static void test_along(void)
{
    MesoQuadMesh mesh = grid(4, 2, false);
    const MesoVec3 to[8] = {{1, 0.9f, 0}, {0.9f, 1, 0}, {-5, 0, 3}, {0.1f, -1, 7},
                            {0, 0, 0},    {0, 0, 1},    {NAN, 1, 0}, {1, 1, 0}};
    const uint8_t expected[8] = {0, 1, 2, 3, 0, 0, 0, 0};
    uint8_t quarters[8];
    CHECK(meso_orientation_along(quarters, &mesh, to) == 3);
    CHECK(memcmp(quarters, expected, 8) == 0);
    scramble(&mesh, 7);
    meso_orientation_along(quarters, &mesh, to);
    CHECK(meso_orientation_turn_mesh(&mesh, &arena, quarters, &error) == MESO_OK);
    CHECK(meso_orientation_along(quarters, &mesh, to) == 3);
    for (uint32_t f = 0; f < 4; f++)
        CHECK(quarters[f] == 0);
    meso_arena_release(&arena);
}

/* The gradient of a linear function is what it is, on sheared faces and for either winding. */
static void test_gradient(void)
{
    const MesoVec3 positions[6] = {{0, 0, 0}, {3, 0, 0}, {5, 2, 0}, {2, 2, 0}, {2, 2, 3}, {5, 2, 3}};
    const uint32_t faces[8] = {0, 1, 2, 3, 3, 2, 5, 4};
    MesoQuadMesh mesh = build(6, positions, 2, faces);
    float values[8];
    MesoVec3 directions[2];
    for (uint32_t c = 0; c < 8; c++) {
        MesoVec3 p = mesh.positions[mesh.face_vertices[c]];
        values[c] = 0.2f * p.x - 0.7f * p.y + 0.4f * p.z;
    }
    meso_orientation_gradient(directions, &mesh, values);
    MesoVec3 first = meso_vec3_unit(directions[0], (MesoVec3){0, 0, 0});
    MesoVec3 second = meso_vec3_unit(directions[1], (MesoVec3){0, 0, 0});
    CHECK(fabsf(first.x / first.y + 2.0f / 7) < 1e-5f && first.x > 0 && first.z == 0);
    CHECK(fabsf(second.x / second.z - 0.5f) < 1e-5f && second.x > 0 && fabsf(second.y) < 1e-6f);

    memset(values, 0, sizeof values);
    uint8_t quarters[2];
    meso_orientation_gradient(directions, &mesh, values);
    CHECK(meso_orientation_along(quarters, &mesh, directions) == 2);
    meso_arena_release(&arena);
}

int main(void)
{
    meso_arena_init(&arena);
    test_flat();
    test_cube();
    test_band();
    test_reversed();
    test_along();
    test_gradient();
    meso_arena_release(&arena);
    return 0;
}
