#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/geodesic/geodesic_solver.h"
#include "libcore/mesh/cut/mesh_cut_fixture.h"

/* ---- every field keeps this ---- */

static float spoke_length(const MesoVec3 *positions, uint32_t a, uint32_t b)
{
    return meso_vec3_length(meso_vec3_sub(positions[b], positions[a]));
}

/* No NaN, nothing below 0, and neighbours differ by no more than the side between them, but for rounding. */
static void check_field(const MesoTriangulation *mesh, const float *distance)
{
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        uint32_t a = mesh->corners[h], b = mesh->corners[meso_next_corner(h)];
        float da = distance[a], db = distance[b];
        CHECK(da >= 0 && db >= 0);
        CHECK((da == INFINITY) == (db == INFINITY));
        CHECK(da == INFINITY || fabsf(da - db) <= spoke_length(mesh->positions, a, b) + 1e-6f * (da + db));
    }
}

/* The plain kernel and that of the machine say the same. */
static float *solve(const MesoTriangulation *mesh, MesoGeodesicEngine engine, const MesoGeodesicQuery *query)
{
    MesoGeodesicSolver *solver;
    float *distance[2];
    for (int plain = 0; plain < 2; plain++) {
        distance[plain] = calloc(mesh->vertex_count, sizeof(float));
        CHECK(distance[plain]);
        CHECK(meso_geodesic_init(&solver, mesh, engine, NULL) == MESO_OK);
        solver->plain = plain;
        CHECK(meso_geodesic_solve(solver, query, distance[plain], NULL, NULL, NULL) == MESO_OK);
        meso_geodesic_release(solver);
    }
    CHECK(memcmp(distance[0], distance[1], mesh->vertex_count * sizeof(float)) == 0);
    free(distance[1]);
    return distance[0];
}

static float *solve_everywhere(const MesoTriangulation *mesh, MesoGeodesicEngine engine, const MesoGeodesicSeed *seeds,
                               uint32_t seed_count)
{
    float *distance = solve(mesh, engine, &(MesoGeodesicQuery){.seeds = seeds, .seed_count = seed_count,
                                                              .target = MESO_NO_INDEX});
    check_field(mesh, distance);
    return distance;
}

/* ---- from borders ---- */

static MesoVec3 place_on_plane(float column, float row, const void *context)
{
    (void)context;
    return (MesoVec3){column, row, 0.5f * column};
}

/* 40 flat facets around; the radius falls from 1 at row 0 with `slope`: a prism at 0, a pyramid above. */
static MesoVec3 place_around(float column, float row, const void *slope)
{
    float a = 6.2831853f * column / 40, r = 1 - *(const float *)slope * row;
    return (MesoVec3){r * cosf(a), r * sinf(a), 0.1f * row};
}

static void check_border(const MesoTriangulation *mesh, uint32_t seed_count, double unit, float (*height)(MesoVec3))
{
    MesoGeodesicSeed *seeds = malloc(seed_count * sizeof *seeds);
    CHECK(seeds);
    for (uint32_t i = 0; i < seed_count; i++)
        seeds[i] = (MesoGeodesicSeed){i, 0, true};
    float *distance = solve_everywhere(mesh, MESO_GEODESIC_FRONTS, seeds, seed_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        double exact = unit * (double)height(mesh->positions[v]);
        CHECK(fabs(distance[v] - exact) <= 1e-5 * exact + 1e-7);
    }
    free(distance);
    free(seeds);
}

static float height_y(MesoVec3 p)
{
    return p.y;
}

static float height_z(MesoVec3 p)
{
    return p.z;
}

static void test_borders(void)
{
    MesoTriangulation mesh = meso_fixture_place_sheet(&(MesoFixtureSheet){
        .columns = 120, .rows = 150, .jitter_x = 0.2f, .jitter_y = 0.2f, .seed = 1, .place = place_on_plane});
    meso_fixture_flip_sides(&mesh, 1, 0);
    check_border(&mesh, 121, 1, height_y);
    meso_triangulation_release(&mesh);

    float slopes[2] = {0, 0.005f};
    for (int i = 0; i < 2; i++) {
        mesh = meso_fixture_place_sheet(&(MesoFixtureSheet){.columns = 40, .rows = 150, .wraps = true, .jitter_y = 0.3f,
                                                            .seed = 2, .place = place_around, .context = &slopes[i]});
        /* along a facet, across its sides: what the middle of a side of the base comes nearer by */
        double inwards = (double)slopes[i] * cos(3.14159265358979 / 40);
        check_border(&mesh, 40, sqrt(0.01 + inwards * inwards) / 0.1, height_z);
        meso_triangulation_release(&mesh);
    }
}

/* Straight beside an open line, round beyond its ends. */
static void test_open_line(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(60, 60, 1);
    MesoGeodesicSeed seeds[21];
    for (uint32_t i = 0; i < 21; i++)
        seeds[i] = (MesoGeodesicSeed){30 * 61 + 20 + i, 0, true};
    float *distance = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, seeds, 21);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        float x = mesh.positions[v].x, y = mesh.positions[v].y - 30;
        x = x < 20 ? 20 - x : x > 40 ? x - 40 : 0;
        float exact = sqrtf(x * x + y * y);
        CHECK(fabsf(distance[v] - exact) <= 2e-5f * exact);
    }
    free(distance);
    meso_triangulation_release(&mesh);
}

/* A square, from its sides: the front is round beyond its corners. Their inner side has chords of the grid. */
static void test_square(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(60, 60, 1);
    MesoGeodesicSeed seeds[80];
    for (uint32_t i = 0; i < 20; i++) {
        seeds[4 * i] = (MesoGeodesicSeed){20 * 61 + 20 + i, 0, true};
        seeds[4 * i + 1] = (MesoGeodesicSeed){40 * 61 + 21 + i, 0, true};
        seeds[4 * i + 2] = (MesoGeodesicSeed){(21 + i) * 61 + 20, 0, true};
        seeds[4 * i + 3] = (MesoGeodesicSeed){(20 + i) * 61 + 40, 0, true};
    }
    float *distance = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, seeds, 80);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        float x = mesh.positions[v].x, y = mesh.positions[v].y;
        x = x < 20 ? 20 - x : x > 40 ? x - 40 : 0;
        y = y < 20 ? 20 - y : y > 40 ? y - 40 : 0;
        float exact = sqrtf(x * x + y * y);
        CHECK((x == 0 && y == 0) || fabsf(distance[v] - exact) <= 2e-5f * exact);
    }
    free(distance);
    meso_triangulation_release(&mesh);
}

/* ---- from points ---- */

static double plane_distance(const MesoTriangulation *mesh, uint32_t a, uint32_t b)
{
    MesoVec3 p = mesh->positions[a], q = mesh->positions[b];
    double x = (double)p.x - q.x, y = (double)p.y - q.y, z = (double)p.z - q.z;
    return sqrt(x * x + y * y + z * z);
}

/* The graph is too long by what its directions allow, and never too short. */
static void test_point_on_plane(void)
{
    MesoTriangulation mesh = meso_fixture_place_sheet(&(MesoFixtureSheet){
        .columns = 100, .rows = 100, .jitter_x = 0.2f, .jitter_y = 0.2f, .seed = 3, .place = place_on_plane});
    meso_fixture_flip_sides(&mesh, 3, 1);
    const uint32_t vertices[3] = {0, 50 * 101 + 47, 101 * 101 - 1};
    for (uint32_t s = 0; s < 3; s++) {
        MesoGeodesicSeed seed = {vertices[s], 0, false};
        float *fronts = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, &seed, 1);
        float *graph = solve_everywhere(&mesh, MESO_GEODESIC_GRAPH, &seed, 1);
        for (uint32_t v = 0; v < mesh.vertex_count; v++) {
            double exact = plane_distance(&mesh, seed.vertex, v);
            CHECK(fabs(fronts[v] - exact) <= 1e-5 * exact);
            CHECK(graph[v] >= exact * (1 - 1e-6) && graph[v] <= 1.1 * exact);
        }
        free(fronts);
        free(graph);
    }
    meso_triangulation_release(&mesh);
}

static double sphere_distance(MesoVec3 a, MesoVec3 b)
{
    MesoVec3 c = meso_vec3_cross(a, b);
    return atan2((double)meso_vec3_length(c), (double)meso_vec3_dot(a, b));
}

/* Root of the mean square of the relative error. */
static double sphere_error(const MesoTriangulation *mesh, uint32_t seed, const float *distance, double *least)
{
    double sum = 0;
    *least = INFINITY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        double exact = sphere_distance(mesh->positions[seed], mesh->positions[v]);
        double off = exact > 0 ? distance[v] / exact - 1 : 0;
        sum += off * off;
        *least = off < *least ? off : *least;
    }
    return sqrt(sum / mesh->vertex_count);
}

/* A chord is shorter than its arc by a share of l^2 / 24. */
static void test_point_on_sphere(void)
{
    double least;
    for (uint32_t n = 20; n <= 40; n += 20) {
        MesoTriangulation mesh = meso_fixture_sphere(n, 0.3f, 4);
        MesoGeodesicSeed seed = {n, 0, false};
        float *distance = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, &seed, 1);
        CHECK(sphere_error(&mesh, n, distance, &least) < 0.06 / n);
        free(distance);
        distance = solve_everywhere(&mesh, MESO_GEODESIC_GRAPH, &seed, 1);
        CHECK(sphere_error(&mesh, n, distance, &least) < 0.03 && least > -0.2 / (n * n));
        free(distance);
        meso_triangulation_release(&mesh);
    }
}

/* The unrolled cylinder: nothing of the graph is shorter. */
static void test_point_on_cylinder(void)
{
    float slope = 0;
    MesoTriangulation mesh = meso_fixture_place_sheet(&(MesoFixtureSheet){
        .columns = 40, .rows = 60, .wraps = true, .jitter_y = 0.3f, .seed = 5, .place = place_around, .context = &slope});
    MesoGeodesicSeed seed = {30 * 40, 0, false};
    float *graph = solve_everywhere(&mesh, MESO_GEODESIC_GRAPH, &seed, 1);
    float *fronts = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, &seed, 1);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        uint32_t column = v % 40 < 20 ? v % 40 : 40 - v % 40;
        double x = 2 * sin(3.14159265358979 / 40) * column;
        double z = (double)mesh.positions[v].z - mesh.positions[seed.vertex].z;
        double exact = sqrt(x * x + z * z);
        CHECK(graph[v] >= exact * (1 - 2e-6));
        /* paths of both ways around meet at column 20 */
        CHECK(column > 18 || fabs(fronts[v] - exact) <= 1e-5 * exact);
    }
    free(graph);
    free(fronts);
    meso_triangulation_release(&mesh);
}

/* Seeds are the corners of a triangle with the point between them; and many neighbours that have nothing in common. */
static void test_many_points(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(30, 30, 1);
    MesoGeodesicSeed seeds[15];
    MesoVec3 point = {10.3f, 10.6f, 0};
    const uint32_t around[3] = {10 * 31 + 10, 11 * 31 + 10, 11 * 31 + 11};
    for (uint32_t k = 0; k < 3; k++)
        seeds[k] = (MesoGeodesicSeed){around[k], meso_vec3_length(meso_vec3_sub(mesh.positions[around[k]], point)),
                                      false};
    float *distance = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, seeds, 3);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        float exact = meso_vec3_length(meso_vec3_sub(mesh.positions[v], point));
        CHECK(fabsf(distance[v] - exact) <= 1e-5f * exact);
    }
    free(distance);
    for (uint32_t k = 0; k < 15; k++)
        seeds[k] = (MesoGeodesicSeed){15 * 31 + 2 * k, 0.1f * (float)(k % 3), k == 7};
    distance = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, seeds, 15);
    for (uint32_t k = 0; k < 15; k++)
        CHECK(distance[15 * 31 + 2 * k] <= seeds[k].distance);
    free(distance);
    meso_triangulation_release(&mesh);
}

/* A ring of 300 triangles around one vertex: more than any vector takes in, and than a byte counts. */
static void test_long_ring(void)
{
    enum { COUNT = 300 };
    MesoVec3 positions[COUNT + 1] = {{0, 0, 0}};
    uint32_t corners[3 * COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        float a = 6.2831853f * (float)i / COUNT;
        positions[i + 1] = (MesoVec3){cosf(a), sinf(a), 0};
        corners[3 * i] = 0;
        corners[3 * i + 1] = i + 1;
        corners[3 * i + 2] = (i + 1) % COUNT + 1;
    }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, COUNT + 1, corners, COUNT);
    MesoGeodesicSeed seed = {0, 0.25f, false};
    float *distance = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, &seed, 1);
    for (uint32_t i = 1; i <= COUNT; i++)
        CHECK(fabsf(distance[i] - 1.25f) < 1e-6f);
    free(distance);
    for (uint32_t k = 0; k < 3; k++) {
        seed = (MesoGeodesicSeed){1 + 7 * k, 0, false};
        distance = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, &seed, 1);
        CHECK(fabsf(distance[0] - 1) < 1e-6f);
        free(distance);
    }
    meso_triangulation_release(&mesh);
}

/* The exact engine behind the same interface: fronts are near it, the graph is above it. */
static void test_engines(void)
{
    MesoTriangulation mesh = meso_fixture_sphere(16, 0.3f, 9);
    MesoGeodesicSeed seed = {50, 0, false};
    float *exact = solve_everywhere(&mesh, MESO_GEODESIC_EXACT, &seed, 1);
    float *fronts = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, &seed, 1);
    float *graph = solve_everywhere(&mesh, MESO_GEODESIC_GRAPH, &seed, 1);
    double sum = 0;
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        double off = exact[v] > 0 ? fronts[v] / (double)exact[v] - 1 : 0;
        sum += off * off;
        CHECK(graph[v] >= exact[v] * (1 - 1e-6f));
    }
    CHECK(sqrt(sum / mesh.vertex_count) < 0.005);
    free(exact);
    free(fronts);
    free(graph);
    meso_triangulation_release(&mesh);
}

/* ---- what comes out of files ---- */

static void test_hard_meshes(void)
{
    for (uint32_t round = 0; round < 60; round++) {
        MesoChoices choices = {0};
        meso_random_init(&choices.random, round, 0);
        MesoTriangulation mesh = meso_fixture_crumpled(&choices, 12);
        if (round % 3 == 0)         /* needles of a height of 1e-9 */
            for (uint32_t v = 0; v < mesh.vertex_count; v++)
                mesh.positions[v].y *= 1e-9f;
        float size = round % 4 == 1 ? 1e30f : round % 4 == 2 ? 1e-30f : 1;
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            mesh.positions[v] = meso_vec3_scale(mesh.positions[v], size);
        MesoGeodesicSeed seeds[20];
        for (uint32_t i = 0; i < 20; i++)
            seeds[i] = (MesoGeodesicSeed){meso_choose(&choices, mesh.vertex_count),
                                          size * (float)meso_choose(&choices, 3), meso_choose(&choices, 2)};
        for (MesoGeodesicEngine engine = MESO_GEODESIC_FRONTS; engine <= MESO_GEODESIC_GRAPH; engine++) {
            float *distance = solve(&mesh, engine, &(MesoGeodesicQuery){.seeds = seeds, .seed_count = 1 + round % 20,
                                                                        .target = MESO_NO_INDEX});
            for (uint32_t v = 0; v < mesh.vertex_count; v++)
                CHECK(distance[v] >= 0 && distance[v] < INFINITY);
            if (size == 1)
                check_field(&mesh, distance);
            free(distance);
        }
        meso_triangulation_release(&mesh);
    }
}

/* All vertices in one place. */
static void test_no_size(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(5, 5, 0);
    MesoGeodesicSeed seed = {7, 0, false};
    float *distance = solve_everywhere(&mesh, MESO_GEODESIC_FRONTS, &seed, 1);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        CHECK(distance[v] == 0);
    free(distance);
    meso_triangulation_release(&mesh);
}

static void test_two_pieces(void)
{
    const MesoVec3 positions[7] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {9, 9, 9}};
    const uint32_t corners[6] = {0, 1, 2, 3, 4, 5};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 7, corners, 2);
    MesoGeodesicSeed seeds[2] = {{1, 0.5f, false}, {6, 0, false}};
    for (MesoGeodesicEngine engine = MESO_GEODESIC_FRONTS; engine <= MESO_GEODESIC_GRAPH; engine++) {
        float *distance = solve_everywhere(&mesh, engine, seeds, 1);
        CHECK(distance[0] == 1.5f && distance[1] == 0.5f);
        for (uint32_t v = 3; v < 7; v++)
            CHECK(distance[v] == INFINITY);
        free(distance);
        distance = solve_everywhere(&mesh, engine, seeds, 2);
        CHECK(distance[6] == 0 && distance[3] == INFINITY);
        free(distance);
        distance = solve_everywhere(&mesh, engine, seeds, 0);
        for (uint32_t v = 0; v < 7; v++)
            CHECK(distance[v] == INFINITY);
        free(distance);
    }
    meso_triangulation_release(&mesh);
}

/* ---- threads ---- */

typedef struct Race {
    const MesoTriangulation *mesh;
    float *distance[8];
} Race;

static void run_race(void *context, uint64_t begin, uint64_t end)
{
    Race *race = context;
    for (uint64_t i = begin; i < end; i++) {
        MesoGeodesicSeed seed = {17, 0, false};
        race->distance[i] = solve(race->mesh, MESO_GEODESIC_FRONTS,
                                  &(MesoGeodesicQuery){.seeds = &seed, .seed_count = 1, .target = MESO_NO_INDEX});
    }
}

static void test_threads(void)
{
    MesoTriangulation mesh = meso_fixture_sphere(30, 0.3f, 6);
    Race race = {.mesh = &mesh};
    meso_parallel_for(2, 8, 1, run_race, &race);
    for (uint32_t i = 0; i < 8; i++)
        CHECK(memcmp(race.distance[0], race.distance[i], mesh.vertex_count * sizeof(float)) == 0);
    for (uint32_t i = 0; i < 8; i++)
        free(race.distance[i]);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    test_borders();
    test_open_line();
    test_square();
    test_point_on_plane();
    test_point_on_sphere();
    test_point_on_cylinder();
    test_many_points();
    test_long_ring();
    test_engines();
    test_hard_meshes();
    test_no_size();
    test_two_pieces();
    test_threads();
    return 0;
}
