/* Points from tables and mesh files. */
#include "formats/mesh/point_file.h"

#include <string.h>

#include "libcore/base/check.h"

static MesoArena arena;
static const MesoVec3 *points;
static uint32_t count;
static MesoError error;

static MesoStatus read(const char *path, const char *text)
{
    MesoInput input;
    meso_input_wrap(&input, path, text, strlen(text));
    return meso_points_read(&points, &count, &arena, &input, &error);
}

static void expect(const char *path, const char *text)
{
    if (read(path, text) != MESO_OK)
        fprintf(stderr, "%s\n", error.message);
    CHECK(read(path, text) == MESO_OK && count == 2);
    CHECK(points[0].x == 1 && points[0].y == 2.5f && points[0].z == -3 && points[1].x == 4 && points[1].y == 5 && points[1].z == 6);
}

static void refuse(const char *path, const char *text, const char *message)
{
    CHECK(read(path, text) == MESO_ERR_INPUT);
    if (strcmp(error.message, message) != 0)
        fprintf(stderr, "%s\n", error.message);
    CHECK(strcmp(error.message, message) == 0);
}

static void test_tables(void)
{
    expect("p.csv", "1,2.5,-3\n4,5,6\n");
    expect("p.csv", "\xef\xbb\xbfx;y;z;name\r\n1; 2.5; -3; first\r\n4;5;6;second");
    expect("p.txt", "# points\n\n  1 2.5 -3 # the first\n\t4\t5\t6 7 8\n\n");
    expect("p.xyz", "1 2.5 -3\r4 5 6\r");
    refuse("p.csv", "1,2,3\n1,2\n", "p.csv:2: a row is three finite numbers");
    refuse("p.csv", "1,2,3\nx,y,z\n", "p.csv:2: a row is three finite numbers");
    refuse("p.csv", "x\ny\n1,2,3", "p.csv:2: a row is three finite numbers");
    refuse("p.csv", "1,2,3x", "p.csv:1: a row is three finite numbers");
    refuse("p.csv", "1,2,1e99", "p.csv:1: a row is three finite numbers");
    refuse("p.csv", "1,2,3\n1,-1e20,3\n", "p.csv:2: -1e+20 lies beyond the largest coordinate, 1e+18");
    refuse("p.csv", "x,y,z\n", "p.csv: no points");
    refuse("p.csv", "", "p.csv: no points");
}

static void test_meshes(void)
{
    expect("p.obj", "v 1 2.5 -3\nv 4 5 6\n");
    expect("p.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
           "1 2.5 -3\n4 5 6\n");
    CHECK(read("p.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") == MESO_OK && count == 3);
    refuse("p.obj", "v 1 2\n", "p.obj:1: coordinate has 2 numbers instead of 3");
    refuse("p.obj", "v 1 2 1e19\n", "p.obj: vertex 1 lies beyond the largest coordinate, 1e+18");
    refuse("p.obj", "# nothing\n", "p.obj: no points");
    refuse("p.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n", "p.obj:3: face 1 uses vertex 3 of 2");
}

int main(void)
{
    meso_arena_init(&arena);
    test_tables();
    test_meshes();
    meso_arena_release(&arena);
}
