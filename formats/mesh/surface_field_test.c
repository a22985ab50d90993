/* Vector attributes of PLY, texture coordinates of OBJ and PLY: values, gaps, what is refused. */
#include <stdio.h>
#include <string.h>

#include "formats/mesh/surface_field.h"
#include "libcore/base/check.h"

static MesoArena arena;
static MesoError error;

/* Reads the surface too, which the same file must give; NULL for texture coordinates. */
static MesoStatus read_field(MesoVec3 **directions, const char *path, const char *text, const char *attribute)
{
    MesoInput input;
    MesoQuadSurface surface;
    meso_input_wrap(&input, path, text, strlen(text));
    CHECK(meso_quad_surface_read(&surface, &arena, &input, 1, &error) == MESO_OK);
    return attribute ? meso_surface_attribute_field(directions, &arena, &surface, &input, attribute, &error)
                     : meso_surface_texture_field(directions, &arena, &surface, &input, &error);
}

static void expect(const char *path, const char *text, const char *attribute, uint32_t count, const MesoVec3 *expected)
{
    MesoVec3 *directions;
    CHECK(read_field(&directions, path, text, attribute) == MESO_OK);
    for (uint32_t f = 0; f < count; f++) {
        MesoVec3 is = meso_vec3_unit(directions[f], (MesoVec3){0, 0, 0});
        MesoVec3 should = meso_vec3_unit(expected[f], (MesoVec3){0, 0, 0});
        CHECK(meso_vec3_length(meso_vec3_sub(is, should)) < 1e-5f);
    }
}

static void expect_failure(const char *path, const char *text, const char *attribute, const char *message)
{
    MesoVec3 *directions;
    CHECK(read_field(&directions, path, text, attribute) == MESO_ERR_INPUT);
    if (!strstr(error.message, message))
        fprintf(stderr, "got '%s'\n", error.message);
    CHECK(strstr(error.message, message) != NULL);
}

/* Two squares beside each other in the plane, 0 1 2 3 and 1 4 5 2. */
#define PLY(vertex_properties, face_properties, rest)                                                        \
    "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"        \
    vertex_properties "element face 2\n" face_properties "property list uchar int vertex_indices\nend_header\n" rest

static void test_attributes(void)
{
    const char *of_vertices =
        PLY("property float flow_x\nproperty double flow_y\nproperty float flow_z\n", "",
            "0 0 0 1 0 0\n1 0 0 0 1 0\n1 1 0 0 1 0\n0 1 0 1 0 0\n2 0 0 0 3 0\n2 1 0 0 3 0\n4 0 1 2 3\n4 1 4 5 2\n");
    expect("a.ply", of_vertices, "flow", 2, (MesoVec3[]){{1, 1, 0}, {0, 1, 0}});

    const char *of_faces =
        PLY("property float dx\nproperty float dy\nproperty float dz\n",
            "property char dx\nproperty float dy\nproperty double dz\n",
            "0 0 0 1 1 1\n1 0 0 1 1 1\n1 1 0 1 1 1\n0 1 0 1 1 1\n2 0 0 1 1 1\n2 1 0 1 1 1\n"
            "-1 0 0 4 0 1 2 3\n0 1.5 -2 4 1 4 5 2\n");
    expect("a.ply", of_faces, "d", 2, (MesoVec3[]){{-1, 0, 0}, {0, 1.5f, -2}});

    expect_failure("a.ply", of_vertices, "wind", "a.ply: has no vector attribute 'wind'");
}

#define SQUARES "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"

static void test_textures(void)
{
    /* u grows with y in the first, against x in the second; then the second lacks one. */
    const char *obj = SQUARES "vt 0 0\nvt 0.5 0\nf 1/1 2/1 3/2 4/-1\nvt 0.75\nf 2/3 5/1 6/1 3/3\n";
    expect("a.obj", obj, NULL, 2, (MesoVec3[]){{0, 1, 0}, {-1, 0, 0}});
    const char *gap = SQUARES "f 1/1 2/1 3/2 4/2\nf 2/1 5 6/1 3/1\nvt 0 0\nvt 1 0\n";
    MesoVec3 *directions;
    CHECK(read_field(&directions, "a.obj", gap, NULL) == MESO_OK);
    CHECK(directions[0].y > 0 && !meso_vec3_finite(directions[1]));
    expect_failure("a.obj", SQUARES "f 1 2 3 4\nf 2 5 6 3\n", NULL, "a.obj: has no texture coordinates");
    expect_failure("a.obj", SQUARES "vt 0 0\nf 1/1 2/1 3/2 4/1\nf 2 5 6 3\n", NULL,
                   "a.obj:8: face 1 uses texture coordinate 2 of 1");
    expect_failure("a.obj", SQUARES "vt 0 0\nf 1/0 2/1 3/1 4/1\n", NULL, "texture coordinate index is 0");
    expect_failure("a.obj", SQUARES "vt x\nf 1/1 2/1 3/1 4/1\n", NULL, "texture coordinate");
    expect_failure("a.obj", SQUARES "vt\nf 1/1 2/1 3/1 4/1\n", NULL, "texture coordinate has no numbers");

    const char *ply = PLY("property float s\nproperty float t\n", "",
                          "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n2 0 0 0 3\n2 1 0 0 3\n4 0 1 2 3\n4 1 4 5 2\n");
    expect("a.ply", ply, NULL, 2, (MesoVec3[]){{1, 0, 0}, {-1, 0, 0}});
    expect_failure("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", NULL, "no texture coordinates");
}

int main(void)
{
    meso_arena_init(&arena);
    test_attributes();
    test_textures();
    meso_arena_release(&arena);
    return 0;
}
