/* What is written comes back from our readers: shape, attributes, seams, names; on disk it is what it should be. */
#include "formats/mesh/write/mesh_write.h"

#include <unistd.h>

#include "formats/mesh/mesh_read.h"
#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;
static char folder[] = "/tmp/meso-mesh-write-XXXXXX";

/* Writes to a file, and reads that; its text goes to `text`, cut off at `size`. */
static MesoPolygonMesh round_trip(const MesoPolygonMesh *mesh, const char *name, char *text, size_t size)
{
    char path[80];
    MesoOutput *output;
    MesoInput input;
    MesoPolygonMesh read;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_polygon_mesh_write(mesh, meso_mesh_kind_of(path), NULL, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    snprintf(text, size, "%.*s", (int)input.size, (const char *)input.data);
    CHECK(meso_polygon_mesh_read(&read, &arena, &input, 1, &error) == MESO_OK);
    meso_input_close(&input);
    CHECK(unlink(path) == 0);
    return read;
}

static void check_shape(const MesoPolygonMesh *a, const MesoPolygonMesh *b)
{
    CHECK(a->vertex_count == b->vertex_count && a->face_count == b->face_count && a->corner_count == b->corner_count);
    CHECK(memcmp(a->positions, b->positions, a->vertex_count * sizeof *a->positions) == 0);
    CHECK(memcmp(a->corners, b->corners, a->corner_count * sizeof *a->corners) == 0);
    for (uint32_t f = 0; f < a->face_count; f++)
        CHECK(meso_polygon_sides(a, f) == meso_polygon_sides(b, f));
}

static void test_shapes(void)
{
    static const char *const names[] = {"a.ply", "b.OBJ", "c.off"};
    char text[64];
    for (uint32_t seed = 0; seed < 9; seed++) {
        MesoRandom random;
        meso_random_init(&random, seed, 0);
        MesoPolygonMesh torus = make_torus(&arena, 7, 5, seed < 6 ? &random : NULL);
        move_randomly(&torus, &random, 1);
        torus.positions[0] = (MesoVec3){1e-38f, -1e18f, 16777216};
        MesoPolygonMesh read = round_trip(&torus, names[seed % 3], text, sizeof text);
        check_shape(&torus, &read);
    }
}

/*
 *     3---2---5      two quads; materials; a seam of the texture between them
 *     | 0 | 1 |
 *     0---1---4
 */
static MesoVec3 positions[6] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
static uint32_t corners[8] = {0, 1, 2, 3, 1, 4, 5, 2};

static MesoPolygonMesh two_quads(MesoAttribute *attributes, uint32_t count)
{
    return (MesoPolygonMesh){.vertex_count = 6, .face_count = 2, .corner_count = 8, .side_count = 4,
                             .positions = positions,
                             .corners = corners, .attributes = attributes, .attribute_count = count};
}

static void check_numbers(const MesoAttribute *a, const MesoAttribute *b, uint32_t count, bool exact)
{
    CHECK(b && a->width == b->width && a->domain == b->domain && (!exact || a->scalar == b->scalar));
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < a->width; c++)
            CHECK(meso_attribute_number(a, meso_attribute_entry(a, i), c) ==
                  meso_attribute_number(b, meso_attribute_entry(b, i), c));
}

static double doubles[12] = {1.0 / 3, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 1e300};
static float uv[16] = {0, 0, 1, 0, 1, 1, 0, 1, .25f, 0, 1, 0, 1, 1, .25f, 1};
static uint32_t uv_of[8] = {0, 1, 2, 3, 4, 5, 6, 7};
static float normals[6] = {0, 0, 1, 0, 0, 2};
static uint32_t normal_of[8] = {0, 0, 0, 0, 1, 1, 1, 0};
static uint8_t colors[18] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 4, 5, 6, 51, 102, 153};
static int16_t heights[2] = {-3, 500};
static const char *materials[2] = {"red oak", "iron"};
static uint32_t material_of[2] = {1, 0};

static void test_ply(void)
{
    char text[2000];
    MesoAttribute attributes[] = {
        {.name = "flow", .domain = MESO_ON_VERTICES, .scalar = MESO_SCALAR_DOUBLE, .width = 2, .entry_count = 6,
         .values = doubles},
        {.name = "uv", .domain = MESO_ON_CORNERS, .width = 2, .entry_count = 8, .values = uv, .entry_of = uv_of},
        {.name = "color", .domain = MESO_ON_VERTICES, .scalar = MESO_SCALAR_UINT8, .normalized = true, .width = 3,
         .entry_count = 6, .values = colors},
        {.name = "height", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_INT16, .width = 1, .entry_count = 2,
         .values = heights},
        {.name = "material", .domain = MESO_ON_FACES, .entry_count = 2, .names = materials, .entry_of = material_of},
        {.name = "normal", .domain = MESO_ON_CORNERS, .width = 3, .entry_count = 2, .values = normals,
         .entry_of = normal_of},
        {.name = "color", .domain = MESO_ON_VERTICES, .width = 4, .entry_count = 1, .values = doubles},
    };
    MesoPolygonMesh mesh = two_quads(attributes, 7), read = round_trip(&mesh, "x.ply", text, sizeof text);
    check_shape(&mesh, &read);
    CHECK(meso_mesh_kind_holds(MESO_MESH_PLY, &mesh, &attributes[0]) &&
          !meso_mesh_kind_holds(MESO_MESH_PLY, &mesh, &attributes[6]));
    uint32_t component;
    const MesoAttribute *flow = meso_polygon_number_on(&read, "flow_1", MESO_ON_VERTICES, &component);
    CHECK(flow && flow->scalar == MESO_SCALAR_DOUBLE && meso_attribute_number(flow, 0, component) == 2);
    flow = meso_polygon_number_on(&read, "flow_0", MESO_ON_VERTICES, &component);
    CHECK(flow && meso_attribute_number(flow, 0, component) == 1.0 / 3);
    check_numbers(&attributes[1], meso_polygon_attribute_on(&read, "uv", MESO_ON_CORNERS), 8, true);
    check_numbers(&attributes[2], meso_polygon_attribute_on(&read, "color", MESO_ON_VERTICES), 6, true);
    check_numbers(&attributes[3], meso_polygon_attribute_on(&read, "height", MESO_ON_FACES), 2, true);
    check_numbers(&attributes[5], meso_polygon_attribute_on(&read, "normal", MESO_ON_CORNERS), 8, true);
    const MesoAttribute *material = meso_polygon_attribute_on(&read, "material", MESO_ON_FACES);
    CHECK(material && material->width == 0 && strcmp(material->names[meso_attribute_entry(material, 0)], "iron") == 0);
    CHECK(strcmp(material->names[meso_attribute_entry(material, 1)], "red oak") == 0);
    CHECK(strstr(text, "\ncomment material 0 red oak\ncomment material 1 iron\n"));
    CHECK(strstr(text, "\nproperty list uchar float texcoord\n") &&
          strstr(text, "\nproperty list uchar float normal\n"));
}

/* Where corners agree around each vertex, its number is one of the vertex. */
static void test_agreement(void)
{
    char text[1000];
    uint32_t agreeing[8];
    memcpy(agreeing, corners, sizeof agreeing);
    MesoAttribute attribute = {.name = "uv", .domain = MESO_ON_CORNERS, .width = 2, .entry_count = 8, .values = uv,
                               .entry_of = agreeing};
    MesoPolygonMesh mesh = two_quads(&attribute, 1), read = round_trip(&mesh, "x.ply", text, sizeof text);
    const MesoAttribute *found = meso_polygon_attribute_on(&read, "uv", MESO_ON_VERTICES);
    CHECK(found && read.attribute_count == 1 && !strstr(text, "texcoord"));
    for (uint32_t v = 0; v < 6; v++)
        CHECK(meso_attribute_number(found, v, 0) == (double)uv[2 * v]);
}

static void test_obj(void)
{
    char text[2000];
    MesoAttribute attributes[] = {
        {.name = "uv", .domain = MESO_ON_CORNERS, .width = 2, .entry_count = 8, .values = uv, .entry_of = uv_of},
        {.name = "normal", .domain = MESO_ON_CORNERS, .width = 3, .entry_count = 2, .values = normals,
         .entry_of = normal_of},
        {.name = "color", .domain = MESO_ON_VERTICES, .scalar = MESO_SCALAR_UINT8, .normalized = true, .width = 3,
         .entry_count = 6, .values = colors},
        {.name = "material", .domain = MESO_ON_FACES, .entry_count = 2, .names = materials, .entry_of = material_of},
        {.name = "height", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_INT16, .width = 1, .entry_count = 2,
         .values = heights},
    };
    MesoPolygonMesh mesh = two_quads(attributes, 5), read = round_trip(&mesh, "x.obj", text, sizeof text);
    check_shape(&mesh, &read);
    check_numbers(&attributes[0], meso_polygon_attribute_on(&read, "uv", MESO_ON_CORNERS), 8, false);
    check_numbers(&attributes[1], meso_polygon_attribute_on(&read, "normal", MESO_ON_CORNERS), 8, false);
    CHECK(meso_polygon_attribute_on(&read, "normal", MESO_ON_CORNERS)->entry_count == 2);
    const MesoAttribute *material = meso_polygon_attribute_on(&read, "material", MESO_ON_FACES);
    CHECK(strcmp(material->names[meso_attribute_entry(material, 0)], "iron") == 0);
    CHECK(strcmp(material->names[meso_attribute_entry(material, 1)], "red oak") == 0);
    const MesoAttribute *color = meso_polygon_attribute_on(&read, "color", MESO_ON_VERTICES);
    CHECK(color && meso_attribute_number(color, 5, 0) == (double)0.2f);
    for (uint32_t i = 0; i < 5; i++)
        CHECK(meso_mesh_kind_holds(MESO_MESH_OBJ, &mesh, &attributes[i]) == (i < 4));
    CHECK(strstr(text, "\nusemtl iron\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl red oak\nf 2/5/2"));
    normal_of[2] = MESO_NO_INDEX;       /* a face has normals at all corners or at none; as here the second alone */
    round_trip(&mesh, "x.obj", text, sizeof text);
    CHECK(strstr(text, "\nf 1/1 2/2 3/3 4/4\n"));
}

/* Faces of more sides than a byte counts. */
static void test_large_face(void)
{
    char text[400];
    MesoVec3 circle[300];
    uint32_t around[300], face_begin[3] = {0, 297, 300};
    for (uint32_t i = 0; i < 300; i++) {
        circle[i] = (MesoVec3){(float)cos(i / 48.0), (float)sin(i / 48.0), 0};
        around[i] = i;
    }
    MesoPolygonMesh mesh = {.vertex_count = 300, .face_count = 2, .corner_count = 300, .positions = circle,
                            .face_begin = face_begin, .corners = around};
    MesoPolygonMesh read = round_trip(&mesh, "x.ply", text, sizeof text);
    check_shape(&mesh, &read);
    CHECK(strstr(text, "property list int uint vertex_indices"));
}

/* A face that has a vertex twice is refused, or read as its loops; what is wrong beside is refused in any case. */
static void test_loops(void)
{
    static const char bad[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 2 3\nf 1 2\nf 1 2 3\n", worse[] = "v 0 0 0\nv 1 0 0\nf 1 2 2\nf 1 2 3\n";
    MesoInput input;
    MesoPolygonMesh mesh;
    uint32_t looped;
    meso_input_wrap(&input, "bad.obj", bad, sizeof bad - 1);
    CHECK(meso_polygon_mesh_read(&mesh, &arena, &input, 1, &error) == MESO_ERR_INPUT);
    CHECK(meso_polygon_mesh_read_loops(&mesh, &looped, &arena, &input, 1, &error) == MESO_OK);
    CHECK(looped == 2 && mesh.face_count == 2 && mesh.side_count == 3);
    meso_input_wrap(&input, "worse.obj", worse, sizeof worse - 1);
    CHECK(meso_polygon_mesh_read_loops(&mesh, &looped, &arena, &input, 1, &error) == MESO_ERR_INPUT);
}

int main(void)
{
    meso_arena_init(&arena);
    CHECK(mkdtemp(folder));
    test_shapes();
    test_ply();
    test_agreement();
    test_obj();
    test_large_face();
    test_loops();
    CHECK(meso_mesh_kind_of("a/b.ply") == MESO_MESH_PLY && meso_mesh_kind_of(".ply") == MESO_MESH_KINDS);
    CHECK(meso_mesh_kind_of("-") == MESO_MESH_PLY && meso_mesh_kind_of("x.stl") == MESO_MESH_KINDS);
    CHECK(rmdir(folder) == 0);
    meso_arena_release(&arena);
    return 0;
}
