/* Attributes on their way: combined, copied, missing, joined again. */
#include "libcore/mesh/edit/origins.h"

#include "libcore/mesh/edit/mesh_fixture.h"

static MesoArena arena;
static MesoError error;

/*
 * Two old vertices and one old triangle become three vertices: the first from the third, which comes
 * from the two old ones.
 */
static uint64_t begin[4] = {0, 1, 2, 4};
static uint32_t sources[4] = {2 + 2, 0, 0, 1};
static float weights[4] = {1, 1, 1, 3};
static const MesoMeshOrigins origins = {.of = {[MESO_ON_VERTICES] = {begin, sources, weights}}};

static MesoPolygonMesh carry(MesoAttribute *attribute)
{
    static MesoVec3 positions[2] = {{0, 0, 0}, {4, 8, -4}};
    MesoPolygonMesh from = {.vertex_count = 2, .positions = positions, .attribute_count = 1, .attributes = attribute};
    MesoPolygonMesh mesh = {.vertex_count = 3, .side_count = 3};
    CHECK(meso_mesh_carry(&mesh, &arena, &from, &origins, &error) == MESO_OK);
    CHECK(mesh.positions[0].x == 3 && mesh.positions[1].x == 0 && mesh.positions[2].y == 6 &&
          mesh.positions[2].z == -3);
    return mesh;
}

static void test_floats(void)
{
    double values[4] = {0, 1, 10, 21};
    MesoAttribute a = {.name = "a", .scalar = MESO_SCALAR_DOUBLE, .width = 2, .entry_count = 2, .values = values};
    MesoPolygonMesh mesh = carry(&a);
    const double *out = mesh.attributes[0].values;
    CHECK(!mesh.attributes[0].entry_of && mesh.attributes[0].entry_count == 3);
    CHECK(out[0] == 7.5 && out[1] == 16 && out[2] == 0 && out[3] == 1 && out[4] == 7.5 && out[5] == 16);
}

static void test_integers(void)
{
    uint8_t bytes[2] = {1, 200};
    MesoAttribute a = {.name = "a", .scalar = MESO_SCALAR_UINT8, .width = 1, .entry_count = 2, .values = bytes};
    MesoPolygonMesh mesh = carry(&a);
    const uint8_t *out = mesh.attributes[0].values;
    CHECK(out[0] == 200 && out[1] == 1 && out[2] == 200);
    a.normalized = true;
    mesh = carry(&a);
    out = mesh.attributes[0].values;
    CHECK(out[0] == 150 && out[1] == 1 && out[2] == 150);
}

static void test_names(void)
{
    const char *names[2] = {"iron", "wood"};
    MesoAttribute a = {.name = "material", .entry_count = 2, .names = names};
    MesoPolygonMesh mesh = carry(&a);
    CHECK(mesh.attributes[0].names == names && mesh.attributes[0].entry_of[0] == 1 &&
          mesh.attributes[0].entry_of[1] == 0);
}

static void test_missing(void)
{
    float values[1] = {5};
    uint32_t entry_of[2] = {MESO_NO_INDEX, 0};
    MesoAttribute a = {.name = "a", .width = 1, .entry_count = 1, .values = values, .entry_of = entry_of};
    MesoPolygonMesh mesh = carry(&a);
    const MesoAttribute *out = &mesh.attributes[0];
    CHECK(out->entry_count == 1 && out->entry_of[0] == 0 && out->entry_of[1] == MESO_NO_INDEX && out->entry_of[2] == 0);
    CHECK(meso_attribute_number(out, 0, 0) == 5);
    entry_of[1] = MESO_NO_INDEX;
    CHECK(carry(&a).attributes[0].entry_of[2] == MESO_NO_INDEX);
}

/* Nothing is left of the mesh before. */
static void test_detaching(void)
{
    char name[] = "uv", u[] = "u", v[] = "v", iron[] = "iron", *none = NULL;
    const char *components[2] = {u, v}, *names[2] = {none, iron};
    float values[2] = {3, 4};
    uint32_t entry_of[2] = {0, 0};
    MesoAttribute old[2] = {{.name = name, .components = components, .width = 2, .entry_count = 1, .values = values,
                             .entry_of = entry_of},
                            {.name = name, .entry_count = 2, .names = names, .entry_of = entry_of}};
    MesoPolygonMesh from = {.vertex_count = 2, .positions = (MesoVec3[2]){{0, 0, 0}, {1, 0, 0}}, .attribute_count = 2,
                            .attributes = old};
    MesoPolygonMesh mesh = {.vertex_count = 2, .side_count = 3, .corners = entry_of};
    CHECK(meso_mesh_carry(&mesh, &arena, &from, &(MesoMeshOrigins){0}, &error) == MESO_OK);
    const MesoAttribute *a = mesh.attributes;
    CHECK(a[0].values == values && meso_mesh_detach(&mesh, &arena, &from, &error) == MESO_OK);
    memset(name, 'x', 2);
    memset(u, 'x', 1);
    memset(v, 'x', 1);
    memset(iron, 'x', 4);
    memset(values, 0, sizeof values);
    components[0] = components[1] = names[0] = names[1] = NULL;
    CHECK(strcmp(a[0].name, "uv") == 0 && strcmp(a[0].components[1], "v") == 0 && strcmp(a[1].name, "uv") == 0);
    CHECK(((float *)a[0].values)[1] == 4 && !a[1].names[0] && strcmp(a[1].names[1], "iron") == 0);
    CHECK(strcmp(a[0].components[0], "u") == 0);
}

static void test_sides(void)
{
    uint32_t face_begin[3] = {0, 4, 8}, corners[8] = {0, 1, 0, 1, 0, 1, 0, 1};
    MesoVec3 positions[2] = {{0, 0, 0}, {1, 0, 0}};
    MesoPolygonMesh from = {.vertex_count = 2, .positions = positions};
    MesoPolygonMesh mesh = {.vertex_count = 2, .face_count = 2, .corner_count = 8, .face_begin = face_begin,
                            .corners = corners};
    CHECK(meso_mesh_carry(&mesh, &arena, &from, &(MesoMeshOrigins){0}, &error) == MESO_OK);
    CHECK(mesh.side_count == 4 && !mesh.face_begin && mesh.positions != positions && mesh.positions[1].x == 1);
}

int main(void)
{
    meso_arena_init(&arena);
    test_floats();
    test_integers();
    test_names();
    test_missing();
    test_detaching();
    test_sides();
    CHECK(meso_mesh_counts_check("x", UINT32_MAX, 0, 0, &error) == MESO_ERR_LIMIT);
    CHECK(meso_mesh_counts_check("x", UINT32_MAX - 1, 0, 0, &error) == MESO_OK);
    meso_arena_release(&arena);
    return 0;
}
