/* OFF: its kinds and layouts, and what is refused. */
#include "formats/mesh/surface_read_fixture.h"

static MesoStatus read_bytes(const char *text, size_t size)
{
    return read_file("t.off", text, size);
}

static void check_message(const char *text, const char *message)
{
    check_refused("t.off", text, message);
}

static void check_square(const char *text)
{
    const MesoVec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5f}};
    if (read_bytes(text, strlen(text)))
        fprintf(stderr, "%s\n", error.message);
    CHECK(read_bytes(text, strlen(text)) == MESO_OK);
    CHECK(mesh.vertex_count == 4 && mesh.face_count == 1);
    CHECK(memcmp(mesh.positions, corners, sizeof corners) == 0);
    for (uint32_t i = 0; i < 4; i++)
        CHECK(mesh.face_vertices[i] == i);
}

#define VERTICES "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n"
#define SQUARE "OFF\n4 1 4\n" VERTICES "4 0 1 2 3\n"

static void test_kinds(void)
{
    check_square(SQUARE);
    check_square("OFF 4 1 0\n" VERTICES "4 0 1 2 3");
    check_square("# comment\n\nOFF # more\n# and more\n4 1 0\n\n" VERTICES "# faces\n4 0 1 2 3 255 0 0 # red\n\n");
    check_square("OFF\r\n4 1 4\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0.5\r\n4 0 1 2 3\r\n");
    check_square("COFF\n4 1 4\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n1 1 0 0 0 0 0\n0 1 .5 9 9 9 9\n4 0 1 2 3 1 0 0\n");
    check_square("STOFF\n4 1 4\n0 0 0 0 0\n1 0 0 0 0\n1 1 0 0 0\n0 1 .5 0 0\n4 0 1 2 3\n");
    check_square("NOFF\n4 1 4\n0 0 0 0 3 0\n1 0 0 0 0 1\n1 1 0 0 0 -1\n0 1 .5 1 0 0\n4 0 1 2 3\n");
    CHECK(mesh.normals[mesh.face_normals[0]].y == 1 && mesh.normals[mesh.face_normals[2]].z == -1);
    check_square("STCNOFF\n4 1 4\n0 0 0 0 3 0 1 1 1 1 0 0\n1 0 0 0 0 1 1 1 1 1 0 0\n1 1 0 0 0 -1 1 1 1 1 0 0\n"
                 "0 1 .5 1 0 0 1 1 1 1 0 0\n4 0 1 2 3\n");
    CHECK(mesh.normals[mesh.face_normals[3]].x == 1);
}

static void test_refused(void)
{
    check_message("OOF\n", "t.off:1: not an OFF file: the first word is not OFF");
    check_message("4OFF\n", "t.off:1: OFF of the kind '4OFF' is not read, only OFF with the prefixes ST, C and N");
    check_message("OFF BINARY\n", "t.off:1: binary OFF is not read; write it as ASCII, or as PLY");
    check_message("OFF\n4 1\n", "t.off:2: counts of vertices, faces and edges are missing");
    check_message("OFF\n4 -1 0\n", "t.off:2: count '-1' is not a number of elements");
    check_message("OFF\n4 1 0 9\n", "t.off:2: '9' follows the counts");
    check_message("OFF\n4000000000 4000000000 4000000000\n0 0 0\n", "t.off:4: file ends before vertex 2 of 4000000000");
    check_message("OFF\n99999999999 1 0\n", "t.off:2: count '99999999999' is not a number of elements");
    check_message("OFF\n4 1 0\n0 0\n", "t.off:3: vertex has 2 numbers instead of 3");
    check_message("OFF\n4 1 0\n0 0 0 0\n", "t.off:3: vertex has more than 3 numbers");
    check_message("OFF\n4 1 0\n0 0 -inf\n", "t.off:3: coordinate '-inf' is not a finite number");
    check_message("OFF\n4 1 0\n" VERTICES "x 0 1 2 3\n", "t.off:7: face has 'x' corners");
    check_message("OFF\n4 1 0\n" VERTICES "4 0 1 2\n", "t.off:7: face has 3 corners instead of 4");
    check_message("OFF\n4 1 0\n" VERTICES "99999999999999999999 0 1 2 3\n",
                  "t.off:7: face has 4 corners instead of 99999999999999999999");
    check_message("OFF\n4 1 0\n" VERTICES "4 0 1 2 4\n", "t.off:7: face 1 uses vertex 5 of 4");
    check_message("OFF\n4 1 0\n" VERTICES "4 0 1 2 -1\n", "t.off:7: face corner '-1' is not the index of a vertex");
    check_message("OFF\n4 1 0\n" VERTICES "4 0 1 2 1\n", "t.off:7: face 1 uses vertex 2 twice");
    check_message("OFF\n4 1 0\n" VERTICES "3 0 1 2\n",
                  "t.off:7: face 1 has 3 sides; every face of a macrosurface must be a quad: meso-mesh quads makes them");
    check_message(SQUARE "4 0 1 2 3\n", "t.off:8: more lines than the header counts");
    check_message("OFF\n4 0 0\n" VERTICES, "t.off: mesh has no faces");
}

/* Only the last line end may go. */
static void test_truncation(void)
{
    for (size_t size = 0; size < strlen(SQUARE) - 1; size++)
        CHECK(read_bytes(SQUARE, size) == MESO_ERR_INPUT);
    CHECK(read_bytes(SQUARE, strlen(SQUARE) - 1) == MESO_OK);
}

int main(void)
{
    meso_arena_init(&arena);
    test_kinds();
    test_refused();
    test_truncation();
    meso_arena_release(&arena);
    return 0;
}
