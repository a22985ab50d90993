/* Exact distances against formulas. */
#include "libcore/geodesic/exact/exact_fixture.h"

/* ---- surfaces that unfold ---- */

/* The straight distances of the plane, whatever the triangles. */
static void test_plane(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(13, 9, 0.7f);
    double *distance = meso_fixture_exact(&mesh, 31);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(meso_is_near(distance[v], meso_fixture_straight(&mesh, v, 31), 1e-12));
    free(distance);
    meso_triangulation_release(&mesh);
}

static MesoTriangulation make_cube(void)
{
    MesoVec3 positions[8];
    const uint32_t corners[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    for (uint32_t v = 0; v < 8; v++)
        positions[v] = (MesoVec3){(float)(v & 1), (float)(v >> 1 & 1), (float)(v >> 2)};
    return meso_fixture_triangulation(positions, 8, corners, 12);
}

/* The farthest corner of a cube is across two unfolded faces. */
static void test_cube(void)
{
    MesoTriangulation mesh = make_cube();
    double *distance = meso_fixture_exact(&mesh, 0);
    const double by_axes[4] = {0, 1, sqrt(2), sqrt(5)};
    for (uint32_t v = 0; v < 8; v++)
        CHECK(meso_is_near(distance[v], by_axes[(v & 1) + (v >> 1 & 1) + (v >> 2)], 1e-12));
    free(distance);
    /* from the middle of the bottom to the top's corners, across one side */
    MesoExactGeodesicPoint middle = {{0, {0, 0.5f, 0.5f}}, 0.25};
    distance = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.points = &middle, .point_count = 1,
                                                                 .target = MESO_NO_INDEX});
    for (uint32_t v = 0; v < 8; v++)
        CHECK(meso_is_near(distance[v], 0.25 + (v < 4 ? sqrt(0.5) : sqrt(2.5)), 1e-12));
    free(distance);
    meso_triangulation_release(&mesh);
}

/* A regular tetrahedron unrolls without end into the triangular lattice: the faces' middles are 2/sqrt(3) apart. */
static void test_tetrahedron(void)
{
    const MesoVec3 positions[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    const uint32_t corners[12] = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 4, corners, 4);
    double side = sqrt(8), *distance = meso_fixture_exact(&mesh, 3);
    for (uint32_t v = 0; v < 3; v++)
        CHECK(meso_is_near(distance[v], side, 1e-12));
    free(distance);
    /* from the middle of a side; the second point is too late everywhere */
    MesoExactGeodesicPoint points[2] = {{{0, {0, 0.5f, 0.5f}}, 0}, {{0, {0.25f, 0.375f, 0.375f}}, 10}};
    distance = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.points = points, .point_count = 2,
                                                                 .target = MESO_NO_INDEX});
    CHECK(meso_is_near(distance[0], side * sqrt(0.75), 1e-12) && meso_is_near(distance[3], side * sqrt(0.75), 1e-12));
    CHECK(meso_is_near(distance[1], side / 2, 1e-12) && meso_is_near(distance[2], side / 2, 1e-12));
    free(distance);
    meso_triangulation_release(&mesh);
}

/*
 * Cones over a rim of equal triangles: by the law of cosines where the turn between two corners of the rim is less
 * than half a circle, else through the tip. `turn` is of one triangle at the tip.
 */
static void test_cone(uint32_t rim, float height_even, float height_odd)
{
    MesoVec3 positions[25] = {{0, 0, 0}};
    uint32_t corners[72];
    CHECK(rim <= 24 && rim % 2 == 0);
    for (uint32_t i = 0; i < rim; i++) {
        double a = 2 * MESO_PI * i / rim;
        positions[1 + i] = (MesoVec3){(float)cos(a), (float)sin(a), i % 2 ? height_odd : height_even};
        const uint32_t triangle[3] = {0, 1 + i, 1 + (i + 1) % rim};
        for (uint32_t k = 0; k < 3; k++)
            corners[3 * i + k] = triangle[k];
    }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, rim + 1, corners, rim);
    double *distance = meso_fixture_exact(&mesh, 1);
    double r0 = meso_fixture_straight(&mesh, 0, 1), r1 = meso_fixture_straight(&mesh, 0, 2);
    double side = meso_fixture_straight(&mesh, 1, 2), turn = acos((r0 * r0 + r1 * r1 - side * side) / (2 * r0 * r1));
    for (uint32_t i = 1; i < rim; i++) {
        double angle = fmin(i, rim - i) * turn, r = i % 2 ? r1 : r0;
        double expected = angle < MESO_PI ? sqrt(r0 * r0 + r * r - 2 * r0 * r * cos(angle)) : r0 + r;
        /* the rim is convex: the straight line stays inside */
        CHECK(meso_is_near(distance[1 + i], expected, 1e-6));
    }
    CHECK(meso_is_near(distance[0], r0, 1e-12));
    free(distance);
    meso_triangulation_release(&mesh);
}

/* Unrolled, a prism is flat: the shorter way around. */
static void test_tube(void)
{
    const uint32_t columns = 17, rows = 11;
    const float height = 3;
    MesoTriangulation mesh = meso_fixture_tube(columns, rows, height);
    double *distance = meso_fixture_exact(&mesh, 5);
    double side = 2 * sin(MESO_PI / columns);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        uint32_t turn = (v + columns - 5) % columns;
        double x = side * fmin(turn, columns - turn), y = height * (double)(v / columns) / rows;
        CHECK(meso_is_near(distance[v], sqrt(x * x + y * y), 1e-6));
    }
    free(distance);
    meso_triangulation_release(&mesh);
}

/* Two regular polygons glued at their rims: from the middle of one to the other's, across the middle of a side. */
static void test_doubled_disk(void)
{
    enum { RIM = 9 };
    MesoVec3 positions[RIM + 2] = {{0, 0, 0}, {0, 0, 0}};
    uint32_t corners[6 * RIM];
    for (uint32_t i = 0; i < RIM; i++) {
        double a = 2 * MESO_PI * i / RIM;
        uint32_t v = 2 + i, next = 2 + (i + 1) % RIM;
        const uint32_t two[6] = {0, v, next, 1, next, v};
        positions[v] = (MesoVec3){(float)cos(a), (float)sin(a), 0};
        for (uint32_t k = 0; k < 6; k++)
            corners[6 * i + k] = two[k];
    }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, RIM + 2, corners, 2 * RIM);
    double *distance = meso_fixture_exact(&mesh, 0);
    CHECK(meso_is_near(distance[1], 2 * cos(MESO_PI / RIM), 1e-6));
    free(distance);
    meso_triangulation_release(&mesh);
}

/* ---- curved surfaces ---- */

/* The greatest deviation from the angle, which falls with the square of the sides. */
static double sphere_error(uint32_t frequency)
{
    MesoTriangulation mesh = meso_fixture_ball(frequency);
    uint32_t source = 0;
    double *distance = meso_fixture_exact(&mesh, source), worst = 0;
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        double chord = meso_fixture_straight(&mesh, v, source);
        double angle = 2 * asin(fmin(0.5 * chord, 1));
        CHECK(distance[v] <= angle * (1 + 1e-6) && distance[v] >= chord * (1 - 1e-12));
        worst = fmax(worst, fabs(distance[v] - angle));
    }
    free(distance);
    meso_triangulation_release(&mesh);
    return worst;
}

static void test_sphere(void)
{
    double coarse = sphere_error(10), fine = sphere_error(20), finest = sphere_error(40);
    CHECK(finest < 1e-3);
    CHECK(coarse / fine > 3.6 && coarse / fine < 4.4);
    CHECK(fine / finest > 3.6 && fine / finest < 4.4);
}

/* A bumpy torus: as a metric, and never longer than a path of edges. */
static void test_metric(void)
{
    MesoTriangulation mesh = meso_fixture_torus(15, 9, 0.4f);
    uint32_t n = mesh.vertex_count;
    for (uint32_t v = 0; v < n; v++)
        mesh.positions[v].z += 0.12f * sinf(7.1f * (float)v);
    double **from = malloc(n * sizeof *from);
    CHECK(from);
    for (uint32_t v = 0; v < n; v++)
        from[v] = meso_fixture_exact(&mesh, v);
    for (uint32_t h = 0; h < 3 * mesh.triangle_count; h++) {
        uint32_t a = mesh.corners[h], b = mesh.corners[meso_next_corner(h)];
        double length = meso_fixture_straight(&mesh, a, b);
        for (uint32_t v = 0; v < n; v++)
            CHECK(fabs(from[v][a] - from[v][b]) <= length * (1 + 1e-12));
    }
    for (uint32_t a = 0; a < n; a++)
        for (uint32_t b = 0; b < n; b++) {
            CHECK(meso_is_near(from[a][b], from[b][a], 1e-11));
            for (uint32_t c = 0; c < n; c += 7)
                CHECK(from[a][b] <= from[a][c] + from[c][b] + 1e-11);
        }
    for (uint32_t v = 0; v < n; v++)
        free(from[v]);
    free(from);
    meso_triangulation_release(&mesh);
}

/* ---- seeds ---- */

/* To the nearest point of the polyline of lattice points in the plane. */
static double to_polyline(MesoVec3 p, const MesoVec3 *line, uint32_t count)
{
    double least = INFINITY;
    for (uint32_t i = 0; i + 1 < count; i++) {
        double ex = line[i + 1].x - line[i].x, ey = line[i + 1].y - line[i].y;
        double dx = p.x - line[i].x, dy = p.y - line[i].y;
        double s = fmin(fmax((dx * ex + dy * ey) / (ex * ex + ey * ey), 0), 1);
        least = fmin(least, hypot(dx - s * ex, dy - s * ey));
    }
    return least;
}

/* A line of seeds with corners in the plane, along edges that are straight, upright and diagonal. */
static void test_line(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(12, 12, 1);
    MesoVec3 line[8];
    MesoExactGeodesicSeed seeds[8];
    const uint32_t path[8] = {42, 43, 44, 58, 72, 85, 98, 99};
    for (uint32_t i = 0; i < 8; i++) {
        seeds[i] = (MesoExactGeodesicSeed){path[i], 0.5f, true};
        line[i] = mesh.positions[path[i]];
    }
    double *distance = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.seeds = seeds, .seed_count = 8,
                                                                         .target = MESO_NO_INDEX});
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(meso_is_near(distance[v], 0.5 + to_polyline(mesh.positions[v], line, 8), 1e-12));
    free(distance);
    meso_triangulation_release(&mesh);
}

/* The border of the plane, where the triangles of two corners have three seeds each: to the nearest of four sides. */
static void test_border_line(void)
{
    const uint32_t side = 9;
    MesoTriangulation mesh = meso_fixture_sheet(side, side, 1);
    MesoExactGeodesicSeed seeds[100];
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        uint32_t x = v % (side + 1), y = v / (side + 1);
        if (x == 0 || y == 0 || x == side || y == side)
            seeds[count++] = (MesoExactGeodesicSeed){v, 0, true};
    }
    double *distance = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.seeds = seeds, .seed_count = count,
                                                                         .target = MESO_NO_INDEX});
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        uint32_t x = v % (side + 1), y = v / (side + 1);
        CHECK(meso_is_near(distance[v], fmin(fmin(x, side - x), fmin(y, side - y)), 1e-12));
    }
    free(distance);
    meso_triangulation_release(&mesh);
}

/* Needles 20000 times as long as they are wide: fronts that run along them are rounded to below nothing. It ends. */
static void test_needles(void)
{
    enum { SIDE = 5, COUNT = 18 };
    static const MesoVec3 places[COUNT] = {
        {3, 5, 0}, {0, 2, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 100000}, {2, 0.5, 50000}, {0, 1, 100000}, {1, 1, 100000},
        {2, 1, 100000}, {3, 1, 100000}, {4, 1, 100000}, {5, 1, 100000}, {0, 2, 100000}, {1, 2, 100000}, {2, 2,
        100000}, {3, 2, 100000}, {4, 2, 100000}, {3, 5, 0}
    };
    MesoTriangulation mesh = meso_fixture_sheet(SIDE, SIDE, 1);
    MesoExactGeodesicSeed seeds[4 * SIDE];
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        uint32_t x = v % (SIDE + 1), y = v / (SIDE + 1);
        mesh.positions[v] = meso_vec3_scale(v < COUNT ? places[v] : (MesoVec3){v > 33 ? (float)x : 3, 5, 0}, 1e12f);
        if (x == 0 || y == 0 || x == SIDE || y == SIDE)
            seeds[count++] = (MesoExactGeodesicSeed){v, 0, true};
    }
    mesh.positions[33] = (MesoVec3){4e12f, 0, 1e17f};
    double *distance = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.seeds = seeds, .seed_count = count,
                                                                         .target = MESO_NO_INDEX});
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(distance[v] >= 0 && distance[v] < 1e18);
    free(distance);
    meso_triangulation_release(&mesh);
}

/* A line whose ends start differently sends a front at an angle: sine 0.6 along it. */
static void test_slanted_line(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(20, 10, 1);
    MesoExactGeodesicSeed seeds[21];
    for (uint32_t i = 0; i <= 20; i++)
        seeds[i] = (MesoExactGeodesicSeed){i, 0.625f * (float)i, true};
    double *distance = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.seeds = seeds, .seed_count = 21,
                                                                         .target = MESO_NO_INDEX});
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        double x = v % 21, y = (double)(v / 21), foot = x - y * 0.625 / sqrt(1 - 0.625 * 0.625);
        if (foot >= 0)
            CHECK(meso_is_near(distance[v], 0.625 * x + sqrt(1 - 0.625 * 0.625) * y, 1e-12));
        else
            CHECK(meso_is_near(distance[v], hypot(x, y), 1e-12));
    }
    free(distance);
    meso_triangulation_release(&mesh);
}

/* Points within triangles, on sides and on a corner of the plane: the nearest of them, with its start. */
static void test_points(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(9, 9, 1);
    const MesoExactGeodesicPoint points[4] = {
        {{17, {0.25f, 0.25f, 0.5f}}, 0.5}, {{60, {0, 0.25f, 0.75f}}, 0}, {{100, {0.5f, 0, 0.5f}}, 0.25},
        {{140, {0, 1, 0}}, 1},
    };
    double *distance = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.points = points, .point_count = 4,
                                                                         .target = MESO_NO_INDEX});
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        double least = INFINITY;
        for (uint32_t i = 0; i < 4; i++) {
            double x = -mesh.positions[v].x, y = -mesh.positions[v].y;
            for (uint32_t k = 0; k < 3; k++) {
                MesoVec3 corner = mesh.positions[mesh.corners[3 * points[i].at.triangle + k]];
                x += points[i].at.weight[k] * corner.x;
                y += points[i].at.weight[k] * corner.y;
            }
            least = fmin(least, points[i].distance + hypot(x, y));
        }
        CHECK(meso_is_near(distance[v], least, 1e-12));
    }
    free(distance);
    meso_triangulation_release(&mesh);
}

/* ---- what ends a search ---- */

/* From one arm of the U to the tip of the other, around both inner corners. */
static void test_domain(void)
{
    const uint8_t member[2] = {0, 1};
    MesoDomain domain = {.member = member};
    MesoTriangulation mesh = meso_fixture_u();
    MesoExactGeodesicSeed seed = {91, 0, false};     /* (1,9) */
    double *distance = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.domain = &domain, .seeds = &seed,
                                                                         .seed_count = 1, .target = MESO_NO_INDEX});
    CHECK(meso_is_near(distance[98], 2 * hypot(2, 6) + 3, 1e-12));         /* (8,9) */
    CHECK(meso_is_near(distance[36], hypot(2, 6) + 3, 1e-12));             /* (6,3) */
    CHECK(meso_is_near(distance[4], hypot(3, 9), 1e-12));                  /* (4,0) is in sight */
    CHECK(meso_is_near(distance[26], hypot(2, 6) + hypot(3, 1), 1e-12));   /* (6,2) */
    CHECK(distance[74] == -1);                                             /* (4,7) is outside */
    free(distance);
    meso_triangulation_release(&mesh);
}

/* Near the seed as without a limit or a target; beyond, nothing that is not final. */
static void test_ends(void)
{
    MesoTriangulation mesh = meso_fixture_torus(24, 16, 0.4f);
    MesoExactGeodesicSeed seed = {7, 0, false};
    MesoExactGeodesicQuery query = {.seeds = &seed, .seed_count = 1, .limit = 0.8, .target = MESO_NO_INDEX};
    double *all = meso_fixture_exact(&mesh, 7), *some = meso_fixture_exact_query(&mesh, &query);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(all[v] <= 0.8 ? some[v] == all[v] : some[v] == INFINITY);
    free(some);
    query.limit = 0;
    query.target = 100;
    some = meso_fixture_exact_query(&mesh, &query);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(all[v] < all[100] || v == 100 ? some[v] == all[v] : some[v] == INFINITY || some[v] == all[v]);
    free(some);
    free(all);
    meso_triangulation_release(&mesh);
}

/* One seed after the other, kept, are as all at once. */
static void test_keep(void)
{
    MesoTriangulation mesh = meso_fixture_torus(24, 16, 0.4f);
    MesoExactGeodesicSeed seeds[4] = {{7, 0, false}, {200, 0.125f, false}, {301, 0, false}, {9, 0.0625f, false}};
    double *once = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.seeds = seeds, .seed_count = 4,
                                                                     .target = MESO_NO_INDEX});
    double *kept = meso_fixture_exact(&mesh, 7);
    MesoArena arena;
    MesoExactGeodesicField field;
    meso_arena_init(&arena);
    for (uint32_t i = 1; i < 4; i++) {
        MesoExactGeodesicQuery query = {.seeds = &seeds[i], .seed_count = 1, .target = MESO_NO_INDEX, .keep = true};
        CHECK(meso_exact_geodesic(&mesh, NULL, &query, &arena, kept, &field, NULL) == MESO_OK);
        CHECK(field.touched_count < mesh.vertex_count);
    }
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(meso_is_near(kept[v], once[v], 1e-12));
    meso_arena_release(&arena);
    free(once);
    free(kept);
    meso_triangulation_release(&mesh);
}

/* ---- what goes wrong ---- */

static void test_window_limit(void)
{
    MesoTriangulation mesh = meso_fixture_torus(24, 16, 0.4f);
    MesoExactGeodesicSeed seed = {7, 0, false};
    MesoArena arena;
    MesoExactGeodesicField field;
    MesoError error;
    double *distance = malloc(mesh.vertex_count * sizeof *distance);
    meso_arena_init(&arena);
    MesoExactGeodesicQuery query = {.seeds = &seed, .seed_count = 1, .target = MESO_NO_INDEX, .window_limit = 20};
    CHECK(distance && meso_exact_geodesic(&mesh, NULL, &query, &arena, distance, &field, &error) == MESO_ERR_LIMIT);
    free(distance);
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
}

/* Vertices that lie on each other, slivers and a triangle of one point: the plane's distances all the same. */
static void test_degenerate(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(8, 8, 1);
    const uint32_t moved[5][2] = {{40, 41}, {20, 30}, {50, 51}, {64, 74}, {13, 3}};
    for (uint32_t i = 0; i < 5; i++)
        mesh.positions[moved[i][0]] = mesh.positions[moved[i][1]];
    mesh.positions[67].x += 0.9999999f;
    for (uint32_t source = 0; source < mesh.vertex_count; source += 10) {
        double *distance = meso_fixture_exact(&mesh, source);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            CHECK(meso_is_near(distance[v], meso_fixture_straight(&mesh, v, source), 1e-9));
        free(distance);
    }
    meso_triangulation_release(&mesh);
}

/* No endless loop, and no NaN. */
static void test_not_finite(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(8, 8, 1);
    mesh.positions[40].x = NAN;
    mesh.positions[22].y = INFINITY;
    double *distance = meso_fixture_exact(&mesh, 0);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(distance[v] >= 0 && (v == 40 || v == 22 ? distance[v] == INFINITY : distance[v] < 20));
    free(distance);
    meso_triangulation_release(&mesh);
}

static void test_no_seeds(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(2, 2, 1);
    double *distance = meso_fixture_exact_query(&mesh, &(MesoExactGeodesicQuery){.target = MESO_NO_INDEX});
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(distance[v] == INFINITY);
    free(distance);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    test_plane();
    test_cube();
    test_tetrahedron();
    test_cone(8, -1, -1);
    test_cone(24, -0.25f, -0.25f);
    test_cone(12, 0.5f, -0.5f);
    test_cone(24, 0.25f, -0.25f);
    test_tube();
    test_doubled_disk();
    test_sphere();
    test_metric();
    test_line();
    test_border_line();
    test_needles();
    test_slanted_line();
    test_points();
    test_domain();
    test_ends();
    test_keep();
    test_window_limit();
    test_degenerate();
    test_not_finite();
    test_no_seeds();
    return 0;
}
