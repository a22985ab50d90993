#include "libcore/chart/atlas.h"
#include "libcore/chart/box_pack.h"
#include "libcore/chart/chart_fixture.h"
#include "libcore/chart/surface_cells.h"

static MesoArena arena;

/* Each triangle in one chart and counter-clockwise in the square, no two overlap, areas as told. */
static MesoAtlas check_atlas(const MesoTriangulation *mesh, MesoChartOptions options)
{
    MesoAtlas atlas;
    CHECK(meso_atlas_build(&atlas, &arena, mesh, &options, NULL) == MESO_OK);
    uint32_t covered = 0;
    for (uint32_t c = 0; c < atlas.chart_count; c++) {
        const MesoChart *chart = &atlas.charts[c];
        meso_fixture_check_disk(chart);
        covered += chart->triangle_count;
        for (uint32_t i = 0; i < chart->triangle_count; i++)
            CHECK(atlas.triangle_chart[chart->triangles[i]] == c);
    }
    CHECK(covered == mesh->triangle_count);
    double image = 0, area = 0, least = INFINITY, largest = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const MesoVec2 *uv = &atlas.corner_uv[3 * t];
        for (uint32_t k = 0; k < 3; k++)
            CHECK(uv[k].x > 0 && uv[k].y > 0 && uv[k].x < 1 && uv[k].y < 1);
        double turn = 0.5 * meso_turn(uv[0], uv[1], uv[2]), own = meso_triangle_area(mesh, t);
        CHECK(turn > 0);
        image += turn;
        area += own;
        least = fmin(least, turn / own);
        largest = fmax(largest, turn / own);
        for (uint32_t s = 0; s < t; s++)
            CHECK(meso_fixture_are_apart(uv, &atlas.corner_uv[3 * s]));
    }
    CHECK(fabs(image / area / atlas.scale / atlas.scale - 1) < 1e-3);
    CHECK(fabs(largest / least / atlas.largest_ratio - 1) < 1e-3);
    CHECK(image > 0.3);
    return atlas;
}

/* Closed, with a handle, open at two ends, bumpy; cells small and large. */
static void test_surfaces(void)
{
    const MesoChartOptions usual = {0, 4, 4};
    MesoTriangulation sphere = meso_fixture_sphere(8, 0.3f, 3), torus = meso_fixture_torus(40, 16, 0.3f);
    MesoTriangulation tube = meso_fixture_cylinder(24, 30, 0.1f, false), bumpy = meso_fixture_bumpy(20, 30, 0.5f);
    MesoAtlas atlas = check_atlas(&sphere, usual);
    CHECK(atlas.chart_count >= 6 && atlas.chart_count < 60 && atlas.largest_ratio < 2);
    CHECK(check_atlas(&torus, usual).largest_ratio < 3);
    CHECK(check_atlas(&tube, usual).largest_ratio < 1.3f);
    CHECK(check_atlas(&bumpy, usual).largest_ratio < 4);
    check_atlas(&torus, (MesoChartOptions){0.1f, 4, 4});
    check_atlas(&torus, (MesoChartOptions){10, 2, 0});
    meso_triangulation_release(&sphere);
    meso_triangulation_release(&torus);
    meso_triangulation_release(&tube);
    meso_triangulation_release(&bumpy);
}

/* A plane is one chart and keeps its shape; nothing is nothing. */
static void test_plane(void)
{
    MesoTriangulation plane = meso_fixture_flat(20, 20, 0.1f);
    MesoAtlas atlas = check_atlas(&plane, (MesoChartOptions){3, 4, 4});
    CHECK(atlas.chart_count == 1 && atlas.largest_ratio < 1.001f);
    plane.triangle_count = 0;
    CHECK(meso_atlas_build(&atlas, &arena, &plane, &(MesoChartOptions){3, 4, 4}, NULL) == MESO_OK);
    CHECK(atlas.chart_count == 0);
    meso_triangulation_release(&plane);
}

/* Every triangle belongs to its nearest centre, within the radius; centres are apart by more than it. */
static void test_cells(void)
{
    MesoTriangulation mesh = meso_fixture_sphere(6, 0.3f, 3);
    MesoSurfaceCells cells;
    CHECK(meso_surface_cells(&cells, &arena, &mesh, 0.5, NULL) == MESO_OK);
    CHECK(cells.count > 10 && cells.count < 60);
    for (uint32_t c = 0; c < cells.count; c++)
        CHECK(cells.cells[cells.centres[c]] == c && cells.distances[cells.centres[c]] == 0);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        CHECK(cells.distances[t] <= 0.5);
        bool from_neighbour = cells.distances[t] == 0;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t other = mesh.twins[3 * t + k] / 3;
            from_neighbour = from_neighbour ||
                             (cells.cells[other] == cells.cells[t] && cells.distances[other] < cells.distances[t]);
        }
        CHECK(from_neighbour);
    }
    meso_triangulation_release(&mesh);
}

static void test_boxes(void)
{
    enum { COUNT = 60 };
    MesoRandom random;
    MesoVec2 sizes[COUNT], lows[COUNT];
    float side, area = 0;
    meso_random_init(&random, 4, 0);
    for (uint32_t i = 0; i < COUNT; i++) {
        sizes[i] = (MesoVec2){1.1f + meso_fixture_signed(&random), 1.1f + meso_fixture_signed(&random)};
        area += sizes[i].x * sizes[i].y;
    }
    CHECK(meso_boxes_pack(lows, &side, &arena, sizes, COUNT, 0.01f, NULL) == MESO_OK);
    CHECK(side * side < 1.9f * area);
    for (uint32_t i = 0; i < COUNT; i++) {
        CHECK(lows[i].x > 0 && lows[i].y > 0 && lows[i].x + sizes[i].x < side && lows[i].y + sizes[i].y < side);
        for (uint32_t j = 0; j < i; j++) {
            float x = fmaxf(lows[i].x - lows[j].x - sizes[j].x, lows[j].x - lows[i].x - sizes[i].x);
            float y = fmaxf(lows[i].y - lows[j].y - sizes[j].y, lows[j].y - lows[i].y - sizes[i].y);
            CHECK(fmaxf(x, y) > 0.0099f * side);
        }
    }
}

int main(void)
{
    meso_arena_init(&arena);
    test_boxes();
    test_cells();
    test_plane();
    test_surfaces();
    meso_arena_release(&arena);
    return 0;
}
