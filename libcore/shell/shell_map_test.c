#include "libcore/shell/shell_map.h"

#include "libcore/shell/shell_fixture.h"

static MesoArena arena;

typedef struct Mapped {
    MesoTriangulation mesh;
    MesoAtlas atlas;
    MesoVec3 *directions;
    MesoShellMap map;
    MesoShellMapReport report;
} Mapped;

static MesoAtlas charts_of(const MesoTriangulation *mesh, float radius)
{
    MesoAtlas atlas;
    MesoError error;
    CHECK(meso_atlas_build(&atlas, &arena, mesh, &(MesoChartOptions){radius, 4, 4}, &error) == MESO_OK);
    return atlas;
}

/* In place: the map keeps a pointer to the mesh. */
static void build(Mapped *mapped, MesoTriangulation mesh, float low, float high, float radius, bool plain)
{
    MesoError error;
    mapped->mesh = mesh;
    mapped->atlas = charts_of(&mapped->mesh, radius);
    mapped->directions = malloc(mesh.vertex_count * sizeof(MesoVec3));
    CHECK(mapped->directions);
    CHECK(meso_prisms_build(mapped->directions, NULL, &arena, &mapped->mesh, &(MesoPrismOptions){low, high, false, 0},
                            &error) == MESO_OK);
    CHECK(meso_shell_map_build(&mapped->map, &mapped->report, &arena, &mapped->mesh, &mapped->atlas,
                               mapped->directions, &(MesoShellMapOptions){low, high, 0, plain}, &error) == MESO_OK);
    CHECK(mapped->report.inverted_count == 0);
    CHECK(mapped->report.stretch_after <= mapped->report.stretch_before && mapped->report.stretch_after > 0.999999);
    CHECK(!plain || mapped->report.stretch_after == mapped->report.stretch_before);
}

static void drop(Mapped *mapped)
{
    free(mapped->directions);
    meso_triangulation_release(&mapped->mesh);
    meso_arena_release(&arena);
}

static void check_near(MesoVec3 a, MesoVec3 b, float size)
{
    CHECK(meso_vec3_length(meso_vec3_sub(a, b)) < 2e-5f * size);
}

static MesoVec3 side_point(const Mapped *mapped, uint32_t half_edge, float at, float height)
{
    float b[3] = {0, 0, 0};
    b[half_edge % 3] = 1 - at;
    b[(half_edge + 1) % 3] = at;
    return meso_shell_map_point(&mapped->map, half_edge / 3, b[1], b[2], height);
}

/* Both triangles of a side tell the same, also where charts meet: prisms have one wall there. */
static void check_continuous(const Mapped *mapped)
{
    const MesoShellMap *map = &mapped->map;
    for (uint32_t h = 0; h < 3 * mapped->mesh.triangle_count; h++) {
        uint32_t twin = mapped->mesh.twins[h];
        for (float share = 0.1f; share < 1 && twin != MESO_NO_INDEX; share += 0.4f) {
            float height = (float)(map->low + (double)share * (map->high - map->low));
            check_near(side_point(mapped, h, 0.3f, height), side_point(mapped, twin, 0.7f, height), 1);
        }
    }
}

/* All tetrahedra of the texture are positive, and points in them are found, and go to the same weights in the shell. */
static void check_tetrahedra(const Mapped *mapped)
{
    const MesoShellMap *map = &mapped->map;
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    for (uint32_t t = 0; t < 3 * mapped->mesh.triangle_count; t++) {
        MesoShellPrism prism = meso_shell_prism(map, t / 3);
        MesoVec3d texture[4], at = {0, 0, 0}, expected = {0, 0, 0};
        double weights[4], sum = 0;
        for (uint32_t k = 0; k < 4; k++) {
            texture[k] = prism.texture[prism.tetrahedra[t % 3][k]];
            sum += weights[k] = 1.001 + meso_fixture_signed(&random);
        }
        CHECK(meso_tetrahedron_det(texture) > 0);
        for (uint32_t k = 0; k < 4; k++) {
            at = meso_vec3d_mad(at, weights[k] / sum, texture[k]);
            expected = meso_vec3d_mad(expected, weights[k] / sum, prism.shell[prism.tetrahedra[t % 3][k]]);
        }
        /* weights in the triangle below, where the point need not be */
        const MesoVec3d *p = prism.texture;
        double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
        double b1 = ((at.x - p[0].x) * (p[2].y - p[0].y) - (at.y - p[0].y) * (p[2].x - p[0].x)) / area;
        double b2 = ((p[1].x - p[0].x) * (at.y - p[0].y) - (p[1].y - p[0].y) * (at.x - p[0].x)) / area;
        check_near(meso_shell_map_point(map, t / 3, (float)b1, (float)b2, (float)at.z), meso_vec3d_narrow(expected), 1);
    }
}

static void check_map(MesoTriangulation mesh, float low, float high, float radius)
{
    Mapped mapped;
    build(&mapped, mesh, low, high, radius, false);
    check_continuous(&mapped);
    check_tetrahedra(&mapped);
    for (uint32_t v = 0; v < mapped.map.vertex_count; v++)
        if (mapped.map.held[v])
            CHECK(mapped.map.low_uv[2 * v] == mapped.map.high_uv[2 * v] &&
                  mapped.map.low_uv[2 * v + 1] == mapped.map.high_uv[2 * v + 1]);
    drop(&mapped);
}

static void test_surfaces(void)
{
    check_map(meso_fixture_flat(12, 12, 0.1f), 0, 0.3f, 0);
    check_map(meso_fixture_sphere(6, 0.3f, 3), 0, 0.3f, 0);
    check_map(meso_fixture_sphere(6, 0.3f, 3), -0.2f, 0.1f, 0);
    check_map(meso_fixture_cylinder(24, 20, 0.1f, false), 0, 0.2f, 0);
    check_map(meso_fixture_groove(1.5707963f, 0.2f), 0, 0.3f, 0);
    check_map(meso_fixture_groove(-1.5707963f, 0.2f), 0, 0.3f, 10);
    check_map(meso_fixture_dented(7, 1.4f), 0, 0.3f, 0);
    check_map(meso_fixture_saddle(0.8f), 0, 0.4f, 10);
    check_map(meso_fixture_bumpy(20, 20, 0.5f), 0, 0.4f, 10);
}

/* Without optimisation vertices go straight up, and the points of the surface stay. */
static void test_plain(void)
{
    Mapped mapped;
    build(&mapped, meso_fixture_bumpy(16, 16, 0.4f), 0, 0.2f, 0, true);
    for (uint32_t c = 0; c < 3 * mapped.mesh.triangle_count; c++) {
        uint32_t v = mapped.mesh.corners[c];
        for (uint32_t level = 0; level < 5; level++) {
            float h = 0.05f * (float)level;
            MesoVec3 expected = meso_vec3_mad(mapped.mesh.positions[v], h, mapped.directions[v]);
            check_near(meso_shell_map_point(&mapped.map, c / 3, c % 3 == 1, c % 3 == 2, h), expected, 1);
        }
        check_near(meso_shell_map_point(&mapped.map, c / 3, 0.3f, 0.5f, 0),
                   meso_prism_point(&mapped.mesh, mapped.directions, c / 3, 0.3f, 0.5f, 0), 1);
    }
    drop(&mapped);
}

/* A patch as in the paper's figure 7, more strongly bent; both measures fall. */
static void test_less_stretch(void)
{
    Mapped mapped;
    build(&mapped, meso_fixture_bumpy(22, 22, 0.5f), 0, 0.4f, 10, false);
    CHECK(mapped.atlas.chart_count == 1);
    CHECK(mapped.report.stretch_before > 1.15 && mapped.report.stretch_after < 1.14);
    CHECK(mapped.report.stretch_after_inverse < mapped.report.stretch_before_inverse);
    drop(&mapped);
}

/* By hand: one triangle, whose layer is sheared by its height: a square of 2 instead of 1, of three. */
static void test_shear(void)
{
    const MesoVec3 positions[3] = {{0, 0, 0}, {1, 0, 0}, {0.2f, 0.7f, 0}};
    const MesoVec3 directions[3] = {{1, 0, 1}, {1, 0, 1}, {1, 0, 1}};
    const uint32_t corners[3] = {0, 1, 2};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 3, corners, 1);
    MesoAtlas atlas = charts_of(&mesh, 0);
    MesoShellMap map;
    MesoShellMapReport report;
    MesoError error;
    CHECK(meso_shell_map_build(&map, &report, &arena, &mesh, &atlas, directions,
                               &(MesoShellMapOptions){.high = 0.5f}, &error) == MESO_OK);
    CHECK(fabs(report.stretch_before - sqrt(4.0 / 3)) < 1e-5 && report.stretch_after == report.stretch_before);
    CHECK(fabs(report.stretch_before_inverse - sqrt(4.0 / 3)) < 1e-5);
    check_near(meso_shell_map_point(&map, 0, 0.25f, 0.5f, 0.3f), (MesoVec3){0.35f + 0.3f, 0.35f, 0.3f}, 1);
    for (uint32_t i = 0; i < 3; i++) {
        const MesoShellMapOptions wrong[] = {{.low = 1, .high = 1}, {.high = NAN}, {.low = -INFINITY, .high = 1}};
        CHECK(meso_shell_map_build(&map, NULL, &arena, &mesh, &atlas, directions, &wrong[i], &error) == MESO_ERR_INPUT);
    }
    meso_triangulation_release(&mesh);
    meso_arena_release(&arena);
}

/* By hand: a layer that is folded goes by its prism; one without thickness at a vertex is flat, and no more. */
static void test_no_layer(void)
{
    const MesoVec3 positions[3] = {{0, 0, 0}, {1, 0, 0}, {0.2f, 0.7f, 0}};
    const MesoVec3 directions[2][3] = {{{2, 0, 1}, {-2, 0, 1}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, 1}, {0, 0, 1}}};
    const uint32_t corners[3] = {0, 1, 2};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 3, corners, 1);
    MesoAtlas atlas = charts_of(&mesh, 0);
    for (int flat = 0; flat < 2; flat++) {
        MesoShellMap map;
        MesoShellMapReport report;
        MesoError error;
        CHECK(meso_shell_map_build(&map, &report, &arena, &mesh, &atlas, directions[flat],
                                   &(MesoShellMapOptions){.high = 1}, &error) == MESO_OK);
        CHECK(report.inverted_count == 0 && report.plain_count == !flat && (report.flat_count > 0) == flat);
        MesoVec3 prism = meso_prism_point(&mesh, directions[flat], 0, 0.25f, 0.5f, 1);
        check_near(meso_shell_map_point(&map, 0, 0.25f, 0.5f, 1), prism, 1);
    }
    meso_triangulation_release(&mesh);
    meso_arena_release(&arena);
}

int main(void)
{
    meso_arena_init(&arena);
    test_surfaces();
    test_plain();
    test_less_stretch();
    test_shear();
    test_no_layer();
    meso_arena_release(&arena);
    return 0;
}
