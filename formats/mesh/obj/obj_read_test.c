/* OBJ: what is tolerated, what is refused, and that every element arrives as written. */
#include "formats/mesh/surface_read_fixture.h"

static MesoStatus read(const char *text)
{
    return read_file("t.obj", text, strlen(text));
}

static void check_message(const char *text, const char *message)
{
    check_refused("t.obj", text, message);
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void check_square(const char *text)
{
    const MesoVec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    if (read(text))
        fprintf(stderr, "%s\n", error.message);
    CHECK(read(text) == MESO_OK);
    CHECK(mesh.vertex_count == 4 && mesh.face_count == 1 && mesh.mean_edge_length == 1);
    CHECK(memcmp(mesh.positions, corners, sizeof corners) == 0);
    for (uint32_t i = 0; i < 4; i++)
        CHECK(mesh.face_vertices[i] == i);
}

static void test_tolerated(void)
{
    check_square(SQUARE "f 1 2 3 4\n");
    check_square(SQUARE "f 1 2 3 4");
    check_square("v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\n\r\nf 1 2 3 4\r\n");
    check_square("# c\n\n  v\t0 0 0\n v +1 0 0 \nv 1. 1e0 0\nv .0 10E-1 0\n  f  1 2\t3 4 # all\n");
    check_square("f 1 2 3 4\n" SQUARE);
    check_square(SQUARE "f 1/1 2/2 3/3 4/4\n");
    check_square(SQUARE "vt 0 0\nf 1/1/ 2/1/ 3// 4/\n");
    check_square(SQUARE "f -4 -3 -2 -1\n");
    check_square("v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    check_square("mtllib /dev/zero\ng a b\no c\nusemtl d\ns off\nl 1 2\np 1\n" SQUARE "f 1 2 3 4\n");
    check_square("v 0 \\\n0 0\nv 1 0 \\\r\n0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\n\\\n3 4\n");
    check_square("# not continued \\\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    check_square("g name \\\nv of two lines\n" SQUARE "f 1 2 3 4 \\");
}

/* Two squares side by side, each face right behind its vertices. */
static void test_relative(void)
{
    const uint32_t expected[8] = {0, 1, 2, 3, 1, 4, 5, 2};
    CHECK(read(SQUARE "f -4 -3 -2 -1\nv 2 0 0\nv 2 1 0\nf -5 -2 -1 -4\n") == MESO_OK);
    CHECK(mesh.face_count == 2 && memcmp(mesh.face_vertices, expected, sizeof expected) == 0);
    check_message(SQUARE "f -4 -3 -2 -5\n", "t.obj:5: vertex index -5 goes back beyond the first of 4");
}

static bool is(MesoVec3 a, float x, float y, float z)
{
    return a.x == x && a.y == y && a.z == z;
}

/* Corners keep the normals of their own; the ones without share the vertex normal. */
static void test_normals(void)
{
    CHECK(read(SQUARE "v 2 0 0\nv 2 1 0\nvn 2 0 0\nvn 0 -1 0\n"
               "f 1//1 2//2 3//-1 4//1\nf 2//1 5/7/2 6 3\n") == MESO_OK);
    const uint32_t *n = mesh.face_normals;
    CHECK(mesh.normal_count == 4 && is(mesh.normals[0], 1, 0, 0) && is(mesh.normals[1], 0, -1, 0));
    CHECK(n[0] == 0 && n[1] == 1 && n[2] == 1 && n[3] == 0 && n[4] == 0 && n[5] == 1);
    CHECK(is(mesh.normals[n[6]], 0, 0, 1) && is(mesh.normals[n[7]], 0, 0, 1) && n[6] != n[7]);
    check_message(SQUARE "vn 0 0 1\nf 1//1 2//1 3//2 4//1\n", "t.obj:6: face 1 uses normal 2 of 1");
    check_message(SQUARE "vn 0 nan 1\nf 1 2 3 4\n", "t.obj:5: normal 'nan' is not a finite number");
    check_message(SQUARE "vn 0 1\nf 1 2 3 4\n", "t.obj:5: normal has 2 numbers instead of 3");
}

static void test_refused(void)
{
    check_message(SQUARE "f 1 2 3\n", "t.obj:5: face 1 has 3 sides; every face of a macrosurface must be a quad: meso-mesh quads makes them");
    check_message(SQUARE "v 2 2 2\nf 1 2 3 4\n\nf 1 2 3 4 5\n",
                  "t.obj:8: face 2 has 5 sides; every face of a macrosurface must be a quad: meso-mesh quads makes them");
    check_message(SQUARE "f 1 2\n", "t.obj:5: face 1 has 2 sides; a face has at least 3");
    check_message(SQUARE "f\n", "t.obj:5: face 1 has 0 sides; a face has at least 3");
    check_message(SQUARE "f 1 2 3 5\n", "t.obj:5: face 1 uses vertex 5 of 4");
    check_message(SQUARE "f 1 2 3 4294967296\n", "t.obj:5: vertex index 4294967296 is too large");
    check_message(SQUARE "f 1 2 3 99999999999999999999\n", "t.obj:5: vertex index 99999999999999999999 is too large");
    check_message(SQUARE "f 1 2 3 -99999999999999999999/1\n",
                  "t.obj:5: vertex index -99999999999999999999 goes back beyond the first of 4");
    check_message(SQUARE "f 1 2 3 0\n", "t.obj:5: vertex index is 0; indices start at 1");
    check_message(SQUARE "f 1 2 3 2\n", "t.obj:5: face 1 uses vertex 2 twice");
    check_message(SQUARE "f 1 2 3 x\n", "t.obj:5: face corner 'x' is not v, v/vt, v//vn or v/vt/vn");
    check_message(SQUARE "f 1 2 3 4/1/1/1\n", "t.obj:5: face corner '4/1/1/1' is not v, v/vt, v//vn or v/vt/vn");
    check_message(SQUARE "f 1 2 3 4.0\n", "t.obj:5: face corner '4.0' is not v, v/vt, v//vn or v/vt/vn");
    check_message("v 0 0\n", "t.obj:1: coordinate has 2 numbers instead of 3");
    check_message("\nv 0 inf 0\n", "t.obj:2: coordinate 'inf' is not a finite number");
    check_message("v 0 0x10 0\n", "t.obj:1: coordinate '0x10' is not a finite number");
    check_message("v 0 1.5.2 0\n", "t.obj:1: coordinate '1.5.2' is not a finite number");
    check_message("v 0 1e99 0\n", "t.obj:1: coordinate '1e99' is too large");
    check_message("v \\\n0 \\\n0 0\nv 0 ? 0\n", "t.obj:4: coordinate '?' is not a finite number");
    check_message(SQUARE, "t.obj: mesh has no faces");
    check_message(SQUARE "curv 0 1 1 2\n", "t.obj:5: unknown statement 'curv'");
    check_message("v 0 0 1e19\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4",
                  "t.obj: vertex 1 lies beyond the largest coordinate, 1e+18");
    check_message(SQUARE "v 2 2 2\nv 2 3 4\nf 1 2 3 4\nf 2 1 5 6\nf 1 2 6 5\n",
                  "t.obj: edge between vertices 1 and 2 joins more than two faces (1, 2, 3)");
}

/* What OpenMesh would put on duplicated vertices: the same face twice, one of them turned over. */
static void test_odd_topology(void)
{
    CHECK(read(SQUARE "f 1 2 3 4\nf 1 2 3 4\n") == MESO_OK);
    CHECK(mesh.face_count == 2 && mesh.vertex_count == 4 && mesh.face_vertices[7] == 3);
    CHECK(read(SQUARE "v 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 3 6 5\n") == MESO_OK);
    CHECK(mesh.face_count == 2 && mesh.vertex_count == 6);
    /* Two faces that meet in one vertex only, and a vertex that no face uses. */
    CHECK(read(SQUARE "v 2 1 0\nv 2 2 0\nv 1 2 0\nv 9 9 9\nf 1 2 3 4\nf 3 5 6 7\n") == MESO_OK);
    CHECK(mesh.face_count == 2 && mesh.vertex_count == 8);
}

int main(void)
{
    meso_arena_init(&arena);
    test_tolerated();
    test_relative();
    test_normals();
    test_refused();
    test_odd_topology();
    meso_arena_release(&arena);
    return 0;
}
