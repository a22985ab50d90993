#include "libcore/chart/chart_fixture.h"

static MesoArena arena;

static const MesoChartOptions usual = {.radius = 1, .largest_ratio = 4, .relaxations = 4};

static MesoChart grow(MesoChartMaker *maker, uint32_t seed, MesoChartOptions options)
{
    MesoChart chart;
    MesoError error;
    CHECK(meso_chart_grow(&chart, &arena, maker, seed, &options, &error) == MESO_OK);
    CHECK(chart.triangles[0] == seed && chart.radius <= options.radius);
    CHECK(chart.area_ratio >= 1 && chart.area_ratio <= (options.largest_ratio > 0 ? options.largest_ratio : 4));
    meso_fixture_check_disk(&chart);
    meso_fixture_check_places(&chart, maker->mesh);
    return chart;
}

static MesoChartMaker make(const MesoTriangulation *mesh)
{
    MesoChartMaker maker;
    CHECK(meso_chart_maker_init(&maker, mesh, NULL) == MESO_OK);
    return maker;
}

/* Largest difference between distances of vertices on the chart and in space, for surfaces that are flat. */
static double distance_error(const MesoChart *chart, const MesoTriangulation *mesh)
{
    double largest = 0;
    for (uint32_t v = 0; v < chart->vertex_count; v++)
        for (uint32_t w = 0; w < v; w++) {
            MesoVec3 a = mesh->positions[chart->vertices[v]], b = mesh->positions[chart->vertices[w]];
            double there = meso_vec3_length(meso_vec3_sub(a, b));
            double here = meso_vec2_length(meso_vec2_sub(chart->places[v], chart->places[w]));
            largest = fmax(largest, fabs(there - here));
        }
    return largest;
}

/* A plane stays what it is, with and without rigid steps, in the middle and at the border. */
static void test_plane(void)
{
    MesoTriangulation mesh = meso_fixture_flat(30, 30, 0.1f);
    MesoChartMaker maker = make(&mesh);
    const uint32_t seeds[] = {30 * 30, 0, 59, 1799};
    for (uint32_t i = 0; i < 12; i++) {
        MesoChartOptions options = usual;
        options.relaxations = i < 4 || i >= 8 ? 4 : 0;
        maker.unfolds = i >= 8;
        MesoChart chart = grow(&maker, seeds[i % 4], options);
        CHECK(chart.radius == 1 && chart.area_ratio < 1.001f);
        CHECK(distance_error(&chart, &mesh) < 1e-5);
        /* 3 x 3 of the plane: a quarter of a circle at least */
        CHECK(chart.triangle_count > 120 && chart.triangle_count < 630);
        for (uint32_t v = 0; v < chart.vertex_count; v++)
            CHECK(meso_vec2_length(chart.places[v]) < 1.00001f);
    }
    meso_chart_maker_release(&maker);
    meso_triangulation_release(&mesh);
}

/* All triangles whose corners lie within the radius: distances on a plane are exact, but around obtuse angles. */
static void test_plane_is_filled(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(40, 40, 0.1f);
    MesoChartMaker maker = make(&mesh);
    MesoChart chart = grow(&maker, 2 * (40 * 20 + 20), usual);
    MesoVec3 centre = {(20.0f + 2.0f / 3) * 0.1f, (20.0f + 1.0f / 3) * 0.1f, 0};
    uint32_t inside = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        uint32_t near = 0;
        for (uint32_t c = 3 * t; c < 3 * t + 3; c++)
            near += meso_vec3_length(meso_vec3_sub(mesh.positions[mesh.corners[c]], centre)) < 0.9999f;
        inside += near == 3;
    }
    CHECK(chart.triangle_count >= inside - inside / 50 && chart.triangle_count <= inside + 2);
    meso_chart_maker_release(&maker);
    meso_triangulation_release(&mesh);
}

/* A tube less than the radius around: a slit is left, and it is unrolled without distortion. */
static void test_tube(void)
{
    MesoTriangulation mesh = meso_fixture_cylinder(24, 60, 0.1f, false);
    MesoChartMaker maker = make(&mesh);
    for (uint32_t seed = 0; seed < mesh.triangle_count; seed += 311) {
        for (int unfold = 0; unfold < 2; unfold++) {
            maker.unfolds = unfold;
            MesoChart chart = grow(&maker, seed, (MesoChartOptions){2, 4, 6});
            CHECK(chart.radius == 2 && chart.triangle_count > 500);
            CHECK(chart.area_ratio < 1.2f);
        }
    }
    meso_chart_maker_release(&maker);
    meso_triangulation_release(&mesh);
}

static void check_charts(const MesoTriangulation *mesh, MesoChartOptions options, uint32_t step, uint32_t least)
{
    MesoChartMaker maker = make(mesh);
    uint32_t largest = 0;
    for (uint32_t seed = 0; seed < mesh->triangle_count; seed += step) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        maker.unfolds = seed / step % 2;
        uint32_t count = grow(&maker, seed, options).triangle_count;
        largest = count > largest ? count : largest;
        meso_arena_rewind(&arena, mark);
    }
    CHECK(largest >= least);
    meso_chart_maker_release(&maker);
}

static void test_curved(void)
{
    MesoTriangulation sphere = meso_fixture_sphere(10, 0.3f, 3);
    check_charts(&sphere, usual, 97, 300);
    check_charts(&sphere, (MesoChartOptions){10, 4, 4}, 307, 500);      /* all of it is asked for */
    check_charts(&sphere, (MesoChartOptions){10, 1.5f, 0}, 307, 50);
    MesoTriangulation torus = meso_fixture_torus(40, 16, 0.3f);
    check_charts(&torus, usual, 97, 200);
    check_charts(&torus, (MesoChartOptions){10, 4, 4}, 307, 300);       /* around both ways */
    MesoTriangulation bumpy = meso_fixture_bumpy(30, 30, 0.5f);
    check_charts(&bumpy, usual, 171, 200);
    check_charts(&bumpy, (MesoChartOptions){5, 0, 10}, 523, 200);
    MesoTriangulation spikes = meso_fixture_bumpy(16, 16, 20);
    check_charts(&spikes, (MesoChartOptions){5, 4, 4}, 47, 2);
    meso_triangulation_release(&sphere);
    meso_triangulation_release(&torus);
    meso_triangulation_release(&bumpy);
    meso_triangulation_release(&spikes);
}

/* A triangle by itself, of any size; one without area has a place all the same. */
static void test_one_triangle(void)
{
    const uint32_t corners[3] = {0, 1, 2};
    const float sizes[] = {1e-12f, 1, 1e12f};
    for (uint32_t i = 0; i < 3; i++) {
        float s = sizes[i];
        MesoVec3 positions[3] = {{s, s, 0}, {s, 4 * s, 0}, {s, s, 4 * s}};
        MesoTriangulation mesh = meso_fixture_triangulation(positions, 3, corners, 1);
        MesoChartMaker maker = make(&mesh);
        MesoChart chart = grow(&maker, 0, (MesoChartOptions){s, 4, 4});
        CHECK(chart.triangle_count == 1 && fabsf(chart.places[1].x - chart.places[0].x - 3 * s) < 1e-5f * s);
        MesoVec2 along = meso_chart_direction(&chart, &mesh, 0, (MesoVec3){0, 0, 2});
        CHECK(fabsf(along.x) < 1e-5f && fabsf(along.y - 2) < 1e-5f);
        meso_chart_maker_release(&maker);
        meso_triangulation_release(&mesh);
    }
    MesoVec3 thin[4] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
    const uint32_t thin_corners[9] = {0, 1, 2, 0, 2, 3, 0, 1, 2};
    for (uint32_t count = 1; count < 3; count++) {
        MesoTriangulation mesh = meso_fixture_triangulation(thin, 4, thin_corners, count);
        MesoChartMaker maker = make(&mesh);
        MesoChart chart;
        CHECK(meso_chart_grow(&chart, &arena, &maker, 0, &usual, NULL) == MESO_OK);
        MesoVec2 *p = chart.places;
        CHECK(meso_turn(p[chart.corners[0]], p[chart.corners[1]], p[chart.corners[2]]) > 0);
        meso_chart_maker_release(&maker);
        meso_triangulation_release(&mesh);
    }
}

/* Five triangles around a ring with half a turn: what is wound against the seed is not joined. */
static void test_moebius(void)
{
    MesoVec3 positions[5];
    uint32_t corners[15];
    for (uint32_t v = 0; v < 5; v++) {
        float a = 6.2831853f * (float)v / 5;
        positions[v] = (MesoVec3){cosf(2 * a), sinf(2 * a), 0.3f * (float)v};
        for (uint32_t k = 0; k < 3; k++)
            corners[3 * v + k] = (v + k) % 5;
    }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 5, corners, 5);
    check_charts(&mesh, (MesoChartOptions){100, 100, 4}, 1, 1);
    meso_triangulation_release(&mesh);
}

/* The direction of a surface's side is that of its image. */
static void test_directions(void)
{
    MesoTriangulation mesh = meso_fixture_bumpy(20, 20, 0.3f);
    MesoChartMaker maker = make(&mesh);
    MesoChart chart = grow(&maker, 400, usual);
    for (uint32_t t = 0; t < chart.triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = chart.corners[3 * t + k], b = chart.corners[3 * t + (k + 1) % 3];
            MesoVec3 side = meso_vec3_sub(mesh.positions[chart.vertices[b]], mesh.positions[chart.vertices[a]]);
            MesoVec2 there = meso_chart_direction(&chart, &mesh, t, side);
            MesoVec2 here = meso_vec2_sub(chart.places[b], chart.places[a]);
            CHECK(meso_vec2_length(meso_vec2_sub(there, here)) < 1e-5f);
        }
    meso_chart_maker_release(&maker);
    meso_triangulation_release(&mesh);
}

/* What is taken is left out; a maker gives the same bytes whatever it made before. */
static void test_taken(void)
{
    MesoTriangulation mesh = meso_fixture_flat(20, 20, 0.1f);
    MesoChartMaker maker = make(&mesh);
    MesoChart first = grow(&maker, 400, usual);
    uint8_t *taken = MESO_NEW(&arena, uint8_t, mesh.triangle_count, NULL);
    for (uint32_t i = 1; i < first.triangle_count; i += 2)
        taken[first.triangles[i]] = 1;
    maker.taken = taken;
    MesoChart second = grow(&maker, 400, usual);
    CHECK(second.triangle_count < first.triangle_count);
    for (uint32_t i = 0; i < second.triangle_count; i++)
        CHECK(!taken[second.triangles[i]]);
    maker.taken = NULL;
    MesoChart third = grow(&maker, 400, usual);
    CHECK(third.vertex_count == first.vertex_count && third.triangle_count == first.triangle_count);
    CHECK(memcmp(third.places, first.places, first.vertex_count * sizeof *first.places) == 0);
    meso_chart_maker_release(&maker);
    meso_triangulation_release(&mesh);
}

static bool is_simple(const MesoVec2 *places, uint32_t count)
{
    bool simple;
    uint32_t border[16];
    for (uint32_t i = 0; i < count; i++) {
        border[2 * i] = i;
        border[2 * i + 1] = (i + 1) % count;
    }
    CHECK(meso_border_is_simple(&simple, &arena, places, border, count, NULL) == MESO_OK);
    return simple;
}

static void test_simple_border(void)
{
    CHECK(is_simple((MesoVec2[]){{0, 0}, {1, 0}, {0, 1}}, 3));
    CHECK(!is_simple((MesoVec2[]){{0, 0}, {1, 0}, {2, 0}}, 3));
    CHECK(is_simple((MesoVec2[]){{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 4));
    CHECK(!is_simple((MesoVec2[]){{0, 0}, {1, 0}, {0, 1}, {1, 1}}, 4));
    CHECK(is_simple((MesoVec2[]){{0, 0}, {2, 0}, {2, 2}, {1, 0.001f}, {0, 2}}, 5));
    CHECK(!is_simple((MesoVec2[]){{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}, 5));     /* touches a side */
    CHECK(is_simple((MesoVec2[]){{0, 0}, {1, 0}, {2, 0}, {2, 1}}, 4));              /* straight on */
    CHECK(!is_simple((MesoVec2[]){{0, 0}, {2, 0}, {1, 0}, {1, 1}}, 4));             /* back */
}

int main(void)
{
    meso_arena_init(&arena);
    test_simple_border();
    test_one_triangle();
    test_plane();
    test_plane_is_filled();
    test_tube();
    test_curved();
    test_moebius();
    test_directions();
    test_taken();
    meso_arena_release(&arena);
    return 0;
}
