/* Faces of corners, numbers of faces, and what the check finds first, on one thread and on several. */
#include "libcore/mesh/polygon_mesh.h"

#include <math.h>
#include <string.h>

#include "libcore/base/check.h"

static MesoError error;

/*
 *     3---2---5      a quad, a triangle on top of it, and a quad
 *     | 0 | 2 |
 *     0---1---4      6 above 3 and 2
 */
static MesoVec3 positions[7] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}, {.5f, 2, 0}};
static uint32_t corners[11] = {0, 1, 2, 3, 3, 2, 6, 1, 4, 5, 2};
static uint32_t face_begin[4] = {0, 4, 7, 11};

static MesoPolygonMesh three_faces(void)
{
    return (MesoPolygonMesh){.vertex_count = 7, .face_count = 3, .corner_count = 11, .positions = positions,
                             .face_begin = face_begin, .corners = corners};
}

static void test_faces(void)
{
    static const uint32_t face_of[11] = {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2};
    MesoPolygonMesh mesh = three_faces(), quads = {.face_count = 2, .corner_count = 8, .side_count = 4};
    for (uint32_t c = 0; c < 11; c++)
        CHECK(meso_polygon_face(&mesh, c) == face_of[c]);
    CHECK(meso_polygon_sides(&mesh, 1) == 3 && meso_polygon_begin(&mesh, 2) == 7);
    CHECK(meso_polygon_face(&quads, 3) == 0 && meso_polygon_face(&quads, 4) == 1 && meso_polygon_sides(&quads, 1) == 4);
    CHECK(meso_polygon_elements(&mesh, MESO_ON_CORNERS) == 11 && meso_polygon_elements(&mesh, MESO_ON_FACES) == 3);
}

static void test_numbers(void)
{
    static const char *rgb[3] = {"red", "green", "blue"};
    float heat[7] = {1, 2, 3, 4, 5, 6, 7}, of_faces[2] = {10, 20}, colors[6] = {0, 0, 1, .5f, 0, 0};
    uint32_t face_entries[3] = {1, MESO_NO_INDEX, 0}, color_of[7] = {0, 1, 1, 0, 0, 0, MESO_NO_INDEX};
    MesoAttribute attributes[3] = {
        {.name = "heat", .domain = MESO_ON_VERTICES, .width = 1, .entry_count = 7, .values = heat},
        {.name = "color", .components = rgb, .domain = MESO_ON_VERTICES, .width = 3, .entry_count = 2, .values = colors,
         .entry_of = color_of},
        {.name = "heat", .domain = MESO_ON_FACES, .width = 1, .entry_count = 2, .values = of_faces,
         .entry_of = face_entries},
    };
    MesoPolygonMesh mesh = three_faces();
    uint32_t component;
    mesh.attribute_count = 3;
    mesh.attributes = attributes;
    CHECK(meso_polygon_attribute(&mesh, "heat") == &attributes[2]);
    CHECK(meso_polygon_attribute_on(&mesh, "heat", MESO_ON_VERTICES) == &attributes[0]);
    CHECK(!meso_polygon_attribute(&mesh, "cold") && !meso_polygon_number(&mesh, "color", &component));
    CHECK(meso_polygon_number(&mesh, "blue", &component) == &attributes[1] && component == 2);
    CHECK(meso_polygon_number(&mesh, "heat", &component) == &attributes[2] && component == 0);
    CHECK(meso_polygon_face_number(&mesh, &attributes[2], 0, 0) == 20 &&
          isnan(meso_polygon_face_number(&mesh, &attributes[2], 0, 1)));
    CHECK(meso_polygon_face_number(&mesh, &attributes[0], 0, 1) == 14.0 / 3);
    CHECK(meso_polygon_face_number(&mesh, &attributes[1], 2, 0) == 0.5 &&
          isnan(meso_polygon_face_number(&mesh, &attributes[1], 0, 1)));
    CHECK(meso_polygon_mesh_check(&mesh, 1, NULL, &error) == MESO_OK && !meso_polygon_normals(&mesh));
}

static void expect(MesoPolygonMesh mesh, uint32_t face, const char *message)
{
    for (uint32_t threads = 1; threads <= 2; threads++) {
        uint32_t found;
        CHECK(meso_polygon_mesh_check(&mesh, threads, &found, &error) == MESO_ERR_INPUT);
        if (strcmp(error.message, message) != 0)
            fprintf(stderr, "got '%s'\n", error.message);
        CHECK(found == face && strcmp(error.message, message) == 0);
    }
}

static void test_refusals(void)
{
    uint32_t wrong[11], entries[11] = {0}, begin[4] = {0, 2, 7, 11}, found = 0;
    float number[2] = {0};
    MesoVec3 moved[7];
    MesoAttribute uv = {.name = "uv", .domain = MESO_ON_CORNERS, .width = 2, .entry_count = 1, .values = number,
                        .entry_of = entries};
    MesoPolygonMesh mesh = three_faces();
    CHECK(meso_polygon_mesh_check(&mesh, 1, &found, &error) == MESO_OK && found == MESO_NO_INDEX);
    memcpy(wrong, corners, sizeof wrong);
    mesh.corners = wrong;
    wrong[9] = 7;
    expect(mesh, 2, "face 3 uses vertex 8 of 7");
    wrong[6] = 3;
    expect(mesh, 1, "face 2 uses vertex 4 twice");
    mesh.attribute_count = 1;
    mesh.attributes = &uv;
    entries[2] = 1;
    expect(mesh, 0, "face 1 uses texture coordinate 2 of 1");
    entries[2] = MESO_NO_INDEX;
    expect(mesh, 1, "face 2 uses vertex 4 twice");
    mesh.face_begin = begin;
    expect(mesh, 0, "face 1 has 2 sides; a face has at least 3");

    mesh = three_faces();
    memcpy(moved, positions, sizeof moved);
    mesh.positions = moved;
    moved[4].y = -2e18f;
    expect(mesh, MESO_NO_INDEX, "vertex 5 lies beyond the largest coordinate, 1e+18");
    moved[3].z = NAN;
    expect(mesh, MESO_NO_INDEX, "vertex 4 is not finite");
}

/* A face of many sides is checked in linear time, and after a wrong one before it. */
static void test_large_face(void)
{
    enum { SIDES = 100000 };
    static MesoVec3 points[SIDES];
    static uint32_t ring[SIDES + 3];
    uint32_t begin[3] = {0, SIDES, SIDES + 3};
    MesoPolygonMesh mesh = {.vertex_count = SIDES, .face_count = 2, .corner_count = SIDES + 3, .positions = points,
                            .face_begin = begin, .corners = ring};
    for (uint32_t c = 0; c < SIDES + 3; c++)
        ring[c] = c % SIDES;
    CHECK(meso_polygon_mesh_check(&mesh, 2, NULL, &error) == MESO_OK);
    ring[SIDES + 2] = 0;
    expect(mesh, 1, "face 2 uses vertex 1 twice");
    ring[SIDES - 1] = 77;
    expect(mesh, 0, "face 1 uses vertex 78 twice");
}

int main(void)
{
    test_faces();
    test_numbers();
    test_refusals();
    test_large_face();
    return 0;
}
