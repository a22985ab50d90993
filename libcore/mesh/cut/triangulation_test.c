#include "libcore/mesh/cut/triangulation_fixture.h"

static uint32_t fan_length(const MesoTriangulation *mesh, uint32_t vertex)
{
    MesoFan fan = meso_fan_first(mesh, vertex);
    uint32_t first = fan.corner, count = 1;
    CHECK(mesh->corners[first] == vertex);
    while (meso_fan_next(mesh, &fan) && fan.corner != first) {
        CHECK(mesh->corners[fan.corner] == vertex);
        count++;
    }
    return count;
}

/*
 *  6--7--8
 *  | /| /|      inner vertices have six triangles, corners one or two
 *  3--4--5
 *  | /| /|
 *  0--1--2
 */
static void test_sheet(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(2, 2, 1);
    const uint32_t expected[9] = {2, 3, 1, 3, 6, 3, 1, 3, 2};
    for (uint32_t v = 0; v < 9; v++)
        CHECK(fan_length(&mesh, v) == expected[v]);
    CHECK(mesh.walls[0] == 1 && mesh.walls[1] == 4);
    meso_triangulation_release(&mesh);
}

static void test_torus(void)
{
    MesoTriangulation mesh = meso_fixture_torus(5, 4, 0.3f);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(fan_length(&mesh, v) == 6);
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        CHECK(mesh.walls[t] == 0);
    meso_triangulation_release(&mesh);
}

/* Two triangles that touch in a vertex: it becomes two. */
static void test_bow_tie(void)
{
    const MesoVec3 positions[5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
    const uint32_t corners[6] = {0, 1, 2, 0, 3, 4};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 5, corners, 2);
    CHECK(mesh.vertex_count == 6 && mesh.corners[3] == 5);
    CHECK(fan_length(&mesh, 0) == 1 && fan_length(&mesh, 5) == 1);
    meso_triangulation_release(&mesh);
}

/* Two tetrahedra that touch in a vertex: fans that close are separated, too. */
static void test_hourglass(void)
{
    const MesoVec3 positions[7] = {{0, 0, 0}, {1, 0, 1}, {-1, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {-1, 1, -1}, {-1, -1, -1}};
    const uint32_t corners[24] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2, 0, 5, 4, 0, 6, 5, 0, 4, 6, 4, 5, 6};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 7, corners, 8);
    CHECK(mesh.vertex_count == 8 && mesh.origins[7] == 0);
    for (uint32_t v = 0; v < 8; v++)
        CHECK(fan_length(&mesh, v) == 3);
    meso_triangulation_release(&mesh);
}

/* Five triangles around a band with one half turn: every vertex has a fan of three, across reversed edges too. */
static void test_moebius(void)
{
    MesoVec3 positions[5];
    uint32_t corners[15];
    for (uint32_t v = 0; v < 5; v++) {
        float a = 6.2831853f * (float)v / 5;
        positions[v] = (MesoVec3){cosf(2 * a), sinf(2 * a), 0.3f * (float)v};
        corners[3 * v] = v;
        corners[3 * v + 1] = (v + 1) % 5;
        corners[3 * v + 2] = (v + 2) % 5;
    }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 5, corners, 5);
    for (uint32_t v = 0; v < 5; v++)
        CHECK(fan_length(&mesh, v) == 3);
    meso_triangulation_release(&mesh);
}

/* Three triangles at an edge are refused. */
static void test_crowded(void)
{
    MesoArena arena;
    MesoSurface surface;
    MesoTriangulation mesh;
    MesoError error;
    MesoVec3 positions[5] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    uint32_t corners[9] = {0, 1, 2, 1, 0, 3, 0, 1, 4};
    const MesoPolygonMesh polygons = {.vertex_count = 5, .face_count = 3, .corner_count = 9, .side_count = 3,
                                      .positions = positions, .corners = corners};
    meso_arena_init(&arena);
    CHECK(meso_surface_build(&surface, &arena, &polygons, 1, &error) == MESO_OK);
    CHECK(meso_triangulation_init(&mesh, &surface, 0, 0, &error) == MESO_ERR_INPUT);
    CHECK(mesh.positions == NULL);
    meso_arena_release(&arena);
}

/* Each promise of the check, broken. */
static void test_check(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(2, 1, 1);
    CHECK(meso_triangulation_check(&mesh, NULL) == MESO_OK);
    mesh.walls[0] ^= 4;
    CHECK(meso_triangulation_check(&mesh, NULL) != MESO_OK);
    mesh.walls[0] ^= 4;
    mesh.labels[1] = 1;
    CHECK(meso_triangulation_check(&mesh, NULL) != MESO_OK);
    mesh.labels[1] = 0;
    uint32_t twin = mesh.twins[2];
    mesh.twins[2] = MESO_NO_INDEX;
    CHECK(meso_triangulation_check(&mesh, NULL) != MESO_OK);
    mesh.twins[2] = twin;
    mesh.vertex_corner[0] = 1;
    CHECK(meso_triangulation_check(&mesh, NULL) != MESO_OK);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    test_sheet();
    test_torus();
    test_bow_tie();
    test_hourglass();
    test_moebius();
    test_crowded();
    test_check();
    return 0;
}
