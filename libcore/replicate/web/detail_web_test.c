/* Webs of details: on surfaces of any genus, with borders, that move and get more details. */
#include "libcore/mesh/point/vertex_normals.h"
#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/replicate/web/detail_web.h"
#include "libcore/replicate/statistics/points_fixture.h"

typedef struct Stage {
    MesoArena arena;
    MesoTriangulation mesh;
    MesoVec3 *normals;
    MesoWeb web;
} Stage;

static Stage start(MesoTriangulation mesh, const MesoMeshPoint *points, uint32_t count)
{
    Stage s = {.mesh = mesh};
    meso_arena_init(&s.arena);
    s.normals = MESO_NEW(&s.arena, MesoVec3, mesh.vertex_count, NULL);
    meso_vertex_normals(s.normals, &s.mesh);
    CHECK(meso_web_build(&s.web, &s.arena, &s.mesh, s.normals, points, count, NULL) == MESO_OK);
    return s;
}

static void end(Stage *s)
{
    meso_triangulation_release(&s->mesh);
    meso_arena_release(&s->arena);
}

static void check_web(const Stage *s, int64_t euler)
{
    MesoError error;
    if (meso_web_check(&s->web, euler, &error) != MESO_OK)
        fprintf(stderr, "%s\n", error.message);
    CHECK(meso_web_check(&s->web, euler, &error) == MESO_OK);
}

static double area_of(const MesoWeb *web)
{
    double area = 0;
    for (uint32_t t = 0; t < web->triangle_count; t++)
        area += meso_web_area(web, t);
    return area;
}

/* On surfaces of several kinds, few details and many: what a triangulation is, as large as the surface. */
static void test_surfaces(void)
{
    const uint32_t counts[3] = {40, 600, 5000};
    for (int shape = 0; shape < 6; shape++)
        for (int i = 0; i < 3; i++) {
            MesoTriangulation mesh = shape == 0 ? meso_fixture_sheet(20, 20, 0.05f) : shape == 1
                ? meso_fixture_tube(30, 12, 3) : shape == 2 ? meso_fixture_ball(20) : shape == 3
                ? meso_fixture_torus(60, 24, 0.4f) : shape == 4 ? meso_fixture_sheet(1, 1, 1) : meso_fixture_ball(3);
            const int64_t euler[6] = {1, 0, 2, 0, 1, 2};
            uint32_t count = counts[i];
            MesoMeshPoint *points = meso_strew_discs(&mesh, &count, 0.6, 3);
            Stage s = start(mesh, points, count);
            CHECK(s.web.node_count == s.web.fixed_count + count);
        CHECK(shape == 0 || shape == 1 || shape == 4 || i == 0 || s.web.fixed_count == 0);
            CHECK(shape != 0 || s.web.fixed_count == 80);
            check_web(&s, euler[shape]);
            double area = meso_surface_area(&s.mesh, s.mesh.positions);
            CHECK(fabs(area_of(&s.web) - area) < (i == 0 ? 0.12 : 0.012) * area);
            free(points);
            end(&s);
        }
}

/* In the plane: no node in the circle around any triangle. */
static bool is_delaunay(const MesoWeb *web)
{
    for (uint32_t t = 0; t < web->triangle_count; t++) {
        double p[3][2];
        for (uint32_t k = 0; k < 3; k++) {
            p[k][0] = (double)web->positions[web->corners[3 * t + k]].x;
            p[k][1] = (double)web->positions[web->corners[3 * t + k]].y;
        }
        double a = p[1][0] - p[0][0], b = p[1][1] - p[0][1], c = p[2][0] - p[0][0], d = p[2][1] - p[0][1];
        double e = a * (p[0][0] + p[1][0]) + b * (p[0][1] + p[1][1]);
        double f = c * (p[0][0] + p[2][0]) + d * (p[0][1] + p[2][1]);
        double g = 2 * (a * d - b * c);
        if (!(g > 0))
            return false;
        double x = (d * e - b * f) / g, y = (a * f - c * e) / g, r = hypot(p[0][0] - x, p[0][1] - y);
        for (uint32_t n = 0; n < web->node_count; n++)
            if (hypot((double)web->positions[n].x - x, (double)web->positions[n].y - y) < r * (1 - 1e-5))
                return false;
    }
    return true;
}

/* The web of all details, and that of half of them into which the others are put, and after stretches, are Delaunay. */
static void test_delaunay(void)
{
    uint32_t count = 1500;
    MesoTriangulation mesh = meso_fixture_sheet(12, 12, 1 / 12.0f);
    MesoMeshPoint *points = meso_strew_freely(&mesh, count, 9);
    Stage s = start(mesh, points, count);
    CHECK(is_delaunay(&s.web));
    MesoVec3 *moved = MESO_NEW(&s.arena, MesoVec3, mesh.vertex_count, NULL);
    for (int k = 1; k <= 8; k++) {
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            moved[v] = (MesoVec3){mesh.positions[v].x * (1 + 0.3f * (float)k), mesh.positions[v].y, 0};
        meso_web_place(&s.web, &s.mesh, moved, s.normals, 2);
        CHECK(meso_web_settle(&s.web, 0, 1) > 0);
        CHECK(is_delaunay(&s.web));
        check_web(&s, 1);
    }
    MesoWebEdges edges = meso_web_edges(&s.web);
    CHECK(edges.count > 4000 && edges.mean > 0.03 && edges.deviation > 0);
    MesoRandom random;
    meso_random_init(&random, 2, 2);
    for (int i = 0; i < 300; i++) {
        uint32_t t = meso_random_below(&random, s.web.triangle_count);
        MesoVec3 p = {0, 0, 0};
        for (uint32_t k = 0; k < 3; k++)
            p = meso_vec3_mad(p, k ? 0.3f : 0.4f, s.web.positions[s.web.corners[3 * t + k]]);
        CHECK(meso_web_insert(&s.web, t, points[0], p, (MesoVec3){0, 0, 1}, NULL) == MESO_OK);
    }
    meso_web_settle(&s.web, 0, 1);
    CHECK(is_delaunay(&s.web));
    check_web(&s, 1);
    free(points);
    end(&s);
}

/* Bent without a stretch, lengths are as they were, but for what an arc is not. */
static void test_bent(void)
{
    uint32_t count = 2000;
    MesoTriangulation mesh = meso_fixture_sheet(100, 10, 0.01f);
    MesoMeshPoint *points = meso_strew_discs(&mesh, &count, 0.7, 9);
    Stage s = start(mesh, points, count);
    MesoWebEdges flat = meso_web_edges(&s.web);
    MesoVec3 *normals = MESO_NEW(&s.arena, MesoVec3, mesh.vertex_count, NULL), *flat_positions = s.mesh.positions;
    s.mesh.positions = MESO_NEW(&s.arena, MesoVec3, mesh.vertex_count, NULL);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        float a = 5 * flat_positions[v].x;
        s.mesh.positions[v] = (MesoVec3){sinf(a) / 5, flat_positions[v].y, cosf(a) / 5};
    }
    meso_vertex_normals(normals, &s.mesh);
    meso_web_place(&s.web, &s.mesh, s.mesh.positions, normals, 1);
    MesoWebEdges bent = meso_web_edges(&s.web);
    CHECK(fabs(bent.mean - flat.mean) < 1e-3 * flat.mean);
    CHECK(meso_web_settle(&s.web, 0, 1) < count / 50);
    s.mesh.positions = flat_positions;
    free(points);
    end(&s);
}

static MesoVec3 on_band(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    float a = 6.2831853f * (float)column / (float)squares->columns;
    float w = 0.6f * ((float)row / (float)squares->rows - 0.5f), r = 1 + w * cosf(a / 2);
    return (MesoVec3){r * cosf(a), r * sinf(a), w * sinf(a / 2)};
}

/* A band with one side is cut open: then it is a strip. */
static void test_moebius(void)
{
    MesoTriangulation mesh = meso_fixture_squares(&(MesoFixtureSquares){60, 8, MESO_SEAM_TWISTED, false, {0, 0},
                                                                       on_band});
    uint32_t count = 800;
    MesoMeshPoint *points = meso_strew_discs(&mesh, &count, 0.7, 3);
    Stage s = start(mesh, points, count);
    check_web(&s, 1);
    CHECK(s.web.fixed_count == 2 * 60 + 2 * 9 - 2);
    free(points);
    end(&s);
}

/* Details on top of each other, on corners and on sides; none. */
static void test_odd(void)
{
    MesoTriangulation mesh = meso_fixture_ball(4);
    MesoMeshPoint points[40];
    for (uint32_t i = 0; i < 40; i++) {
        float half = i % 4 == 1 ? 0.5f : 0;
        points[i] = (MesoMeshPoint){i / 4, {i % 4 == 0, half + (i % 4 == 2), half + (i % 4 == 3)}};
    }
    Stage s = start(mesh, points, 40);
    check_web(&s, 2);
    end(&s);
    s = start(meso_fixture_ball(4), points, 0);
    check_web(&s, 2);
    end(&s);
    s = start(meso_fixture_torus(12, 7, 0.3f), points, 1);
    check_web(&s, 0);
    end(&s);
}

int main(void)
{
    test_surfaces();
    test_delaunay();
    test_bent();
    test_moebius();
    test_odd();
    return 0;
}
