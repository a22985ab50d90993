/* Numbers of vertices from attributes of each domain, and from names; what is refused. */
#include <string.h>

#include "formats/mesh/mesh_read.h"
#include "formats/mesh/surface_number.h"
#include "libcore/base/check.h"

static MesoArena arena;
static MesoError error;

/* Two squares beside each other in the plane, 0 1 2 3 and 1 4 5 2. */
#define PLY(vertex_properties, face_properties, rest)                                                        \
    "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"        \
    vertex_properties "element face 2\n" face_properties "property list uchar int vertex_indices\nend_header\n" rest
#define OBJ "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\ng left\nf 1 2 3 4\ng right\nf 2 5 6 3\n"

static const char on_vertices[] = PLY("property float fat\n", "",
    "0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n2 0 0 5\n2 1 0 6\n4 0 1 2 3\n4 1 4 5 2\n");
static const char on_faces[] = PLY("", "property float fat\n",
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 0\n1 4 0 1 2 3\n2 4 1 4 5 2\n");

static MesoStatus take(float **numbers, const char *path, const char *text, const char *what)
{
    MesoInput input;
    MesoPolygonMesh mesh;
    const MesoNumberWish wish = {.what = what, .option = "thickness-by", .otherwise = 1, .low = 0.5f, .high = 8};
    meso_input_wrap(&input, path, text, strlen(text));
    CHECK(meso_polygon_mesh_read(&mesh, &arena, &input, 1, &error) == MESO_OK);
    return meso_surface_numbers(numbers, &arena, &mesh, &wish, path, &error);
}

static void expect(const char *path, const char *text, const char *what, const float expected[6])
{
    float *numbers;
    CHECK(take(&numbers, path, text, what) == MESO_OK);
    CHECK(memcmp(numbers, expected, 6 * sizeof *numbers) == 0);
}

static void expect_failure(const char *path, const char *text, const char *what, const char *message)
{
    float *numbers;
    CHECK(take(&numbers, path, text, what) != MESO_OK);
    if (strcmp(error.message, message) != 0)
        fprintf(stderr, "got '%s'\n", error.message);
    CHECK(strcmp(error.message, message) == 0);
}

int main(void)
{
    meso_arena_init(&arena);
    expect("a.ply", on_vertices, "fat", (const float[]){1, 2, 3, 4, 5, 6});
    expect("a.ply", on_faces, "fat", (const float[]){1, 1.5f, 1.5f, 1, 2, 2});
    expect("a.obj", OBJ, "group:right=2", (const float[]){1, 1.5f, 1.5f, 1, 2, 2});
    expect("a.obj", OBJ, "group:left=3,right=2", (const float[]){3, 2.5f, 2.5f, 3, 2, 2});
    expect("a.obj", OBJ, "group:", (const float[]){1, 1, 1, 1, 1, 1});
    expect_failure("a.ply", on_vertices, "thin", "a.ply: has no attribute 'thin' of numbers (--thickness-by)");
    expect_failure("a.obj", OBJ, "group", "a.obj: has no attribute 'group' of numbers (--thickness-by)");
    expect_failure("a.ply", on_vertices, "fat:a=1", "a.ply: has no attribute 'fat' of names (--thickness-by)");
    expect_failure("a.obj", OBJ, "group:top=1", "a.obj: no group is named 'top' (--thickness-by)");
    expect_failure("a.obj", OBJ, "group:left=1,right", "--thickness-by: 'right' is not NAME=NUMBER from 0.5 to 8");
    expect_failure("a.obj", OBJ, "group:left=9,right=1", "--thickness-by: 'left=9' is not NAME=NUMBER from 0.5 to 8");
    expect_failure("a.obj", OBJ, "group:left=nan", "--thickness-by: 'left=nan' is not NAME=NUMBER from 0.5 to 8");
    expect_failure("a.ply", PLY("property float fat\n", "", "0 0 0 1\n1 0 0 2\n1 1 0 9\n0 1 0 4\n2 0 0 5\n2 1 0 6\n"
                   "4 0 1 2 3\n4 1 4 5 2\n"), "fat",
                   "a.ply: 'fat' is 9 at vertex 3; from 0.5 to 8 is possible (--thickness-by)");
    meso_arena_release(&arena);
    return 0;
}
