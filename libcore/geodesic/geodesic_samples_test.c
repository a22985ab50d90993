#include "libcore/geodesic/geodesic_samples.h"

#include <string.h>

#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/mesh/cut/mesh_domain.h"

static MesoArena arena;

static MesoGeodesicSolver *solver_of(const MesoTriangulation *mesh)
{
    MesoGeodesicSolver *solver;
    CHECK(meso_geodesic_init(&solver, mesh, MESO_GEODESIC_FRONTS, NULL) == MESO_OK);
    return solver;
}

static MesoSamples sample(const MesoTriangulation *mesh, MesoGeodesicSolver *solver, MesoSampleQuery query,
                          float *distance)
{
    MesoSamples samples;
    CHECK(meso_geodesic_sample(&samples, distance, &arena, mesh, solver, &query, NULL) == MESO_OK);
    return samples;
}

/* Of a strip of eight squares: its ends, the middle, and then halves of what is between. */
static void test_strip(void)
{
    float distance[18];
    MesoTriangulation mesh = meso_fixture_sheet(8, 1, 1);
    MesoGeodesicSolver *solver = solver_of(&mesh);
    MesoSampleQuery query = {.start = MESO_NO_INDEX, .count = 3};
    MesoSamples samples = sample(&mesh, solver, query, distance);
    CHECK(samples.count == 3 && samples.vertices[0] == 0 && samples.vertices[1] == 17);
    CHECK(samples.vertices[2] == 4 || samples.vertices[2] == 13);   /* equally far, but for rounding */
    CHECK(samples.radii[0] == INFINITY && fabsf(samples.radii[1] - sqrtf(65)) < 1e-5f);
    CHECK(fabsf(samples.radii[2] - 4) < 1e-5f);
    query.start = 4;
    query.count = 100;
    query.radius = 4.05f;
    samples = sample(&mesh, solver, query, distance);
    CHECK(samples.count == 3 && samples.vertices[0] == 4 && samples.vertices[1] + samples.vertices[2] == 26);
    CHECK(samples.radius < 4.05f && distance[9] == 0 && distance[17] == 0);
    query.radius = 0;       /* all vertices, each once */
    samples = sample(&mesh, solver, query, distance);
    CHECK(samples.count == 18 && samples.radius == 0);
    for (uint32_t v = 0; v < 18; v++)
        CHECK(distance[v] == 0);
    query.count = 0;
    CHECK(sample(&mesh, solver, query, distance).count == 0);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

static bool is_candidate(const MesoTriangulation *mesh, const MesoDomain *domain, bool border_only, uint32_t vertex)
{
    uint32_t count = meso_domain_size(domain, mesh);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t = meso_domain_triangle(domain, i);
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            bool at_end = mesh->corners[h] == vertex || mesh->corners[meso_next_corner(h)] == vertex;
            if (at_end && (!border_only || meso_domain_across(domain, mesh, h) == MESO_NO_INDEX))
                return true;
        }
    }
    return false;
}

/* Each sample is what looking at all vertices finds, and radii descend. */
static void check_greedy(const MesoTriangulation *mesh, MesoGeodesicSolver *solver, MesoSampleQuery query)
{
    uint32_t n = mesh->vertex_count;
    float *distance = malloc(n * sizeof *distance), *slow = malloc(n * sizeof *slow);
    bool *candidate = malloc(n * sizeof *candidate);
    CHECK(distance && slow && candidate);
    for (uint32_t v = 0; v < n; v++) {
        candidate[v] = is_candidate(mesh, query.domain, query.border_only, v);
        distance[v] = slow[v] = -1;
    }
    MesoSamples samples = sample(mesh, solver, query, distance);
    MesoGeodesicQuery solve = {.domain = query.domain, .seeds = query.given, .seed_count = query.given_count,
                               .target = MESO_NO_INDEX};
    CHECK(samples.count == query.count);
    CHECK(meso_geodesic_solve(solver, &solve, slow, NULL, NULL, NULL) == MESO_OK);
    for (uint32_t i = 0; i <= samples.count; i++) {
        uint32_t farthest = MESO_NO_INDEX;
        for (uint32_t v = 0; v < n; v++)
            if (candidate[v] && (farthest == MESO_NO_INDEX || slow[v] > slow[farthest]))
                farthest = v;
        if (i == samples.count) {
            CHECK(samples.radius == slow[farthest]);
            break;
        }
        CHECK(samples.vertices[i] == farthest && samples.radii[i] == slow[farthest]);
        CHECK(i == 0 || samples.radii[i] <= samples.radii[i - 1]);
        MesoGeodesicSeed seed = {farthest, 0, false};
        solve = (MesoGeodesicQuery){.domain = query.domain, .seeds = &seed, .seed_count = 1, .target = MESO_NO_INDEX,
                                    .keep = true};
        CHECK(meso_geodesic_solve(solver, &solve, slow, NULL, NULL, NULL) == MESO_OK);
    }
    CHECK(!memcmp(slow, distance, n * sizeof *slow));
    free(distance);
    free(slow);
    free(candidate);
}

/* On a sphere of several blocks; from its border in one of its regions, and of two pieces. */
static void test_greedy(void)
{
    enum { MOST = 1000 };
    MesoGeodesicSeed border[MOST];
    uint32_t border_count = 0;
    MesoTriangulation mesh = meso_fixture_sphere(18, 0.3f, 3);
    uint32_t *triangles = malloc(mesh.triangle_count * sizeof *triangles);
    CHECK(triangles);
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        mesh.labels[t] = mesh.positions[mesh.corners[3 * t]].z > 0.6f    ? 1
                         : mesh.positions[mesh.corners[3 * t]].z < -0.9f ? 2 : 0;
    for (uint32_t h = 0; h < 3 * mesh.triangle_count; h++)
        if (mesh.labels[h / 3] != mesh.labels[mesh.twins[h] / 3]) {
            mesh.walls[h / 3] |= (uint8_t)(1u << h % 3);
            CHECK(border_count < MOST);
            if (mesh.labels[h / 3] == 1)
                border[border_count++] = (MesoGeodesicSeed){mesh.corners[h], 0, true};
        }
    MesoGeodesicSolver *solver = solver_of(&mesh);
    check_greedy(&mesh, solver, (MesoSampleQuery){.start = MESO_NO_INDEX, .count = 300});
    MesoDomain domain = {(const uint8_t[3]){0, 1, 1}, 0, triangles};
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        if (mesh.labels[t])
            triangles[domain.triangle_count++] = t;
    MesoSampleQuery query = {.domain = &domain, .start = MESO_NO_INDEX, .count = 30};
    check_greedy(&mesh, solver, query);
    query.border_only = true;
    check_greedy(&mesh, solver, query);
    query.border_only = false;
    query.given = border;
    query.given_count = border_count;
    check_greedy(&mesh, solver, query);
    free(triangles);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

/* How far from the border and from each other the samples of a sheet come at least, in squares. */
static void measure_slack(const MesoTriangulation *mesh, MesoGeodesicSolver *solver, MesoSampleQuery query,
                          uint32_t *count, double *from_border, double *apart)
{
    float *distance = malloc(mesh->vertex_count * sizeof *distance);
    CHECK(distance);
    MesoSamples samples = sample(mesh, solver, query, distance);
    *count = samples.count;
    *from_border = *apart = INFINITY;
    for (uint32_t i = 0; i < samples.count; i++) {
        MesoVec3 p = mesh->positions[samples.vertices[i]];
        *from_border = fmin(*from_border, (double)fminf(fminf(p.x, 40 - p.x), fminf(p.y, 8 - p.y)));
        for (uint32_t k = 0; k < i; k++)
            *apart = fmin(*apart, (double)meso_vec3_length(meso_vec3_sub(p, mesh->positions[samples.vertices[k]])));
    }
    free(distance);
}

/* A strip of 40 x 8 squares, whose border all samples keep from at first, then less and less. */
static void test_slack(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(40, 8, 1);
    MesoGeodesicSolver *solver = solver_of(&mesh);
    MesoGeodesicSeed border[96];
    MesoSampleQuery query = {.given = border, .start = MESO_NO_INDEX, .count = 1000, .radius = 4.5f};
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        if (v % 41 == 0 || v % 41 == 40 || v < 41 || v >= 8 * 41)
            border[query.given_count++] = (MesoGeodesicSeed){v, 0, true};
    CHECK(query.given_count == 96);
    const uint32_t least[] = {0, 5, 6, 14};
    for (int i = 0; i < 4; i++) {
        static const float slacks[] = {0, 0.25f, 0.75f, 1};
        uint32_t count;
        double from_border, apart;
        query.slack = slacks[i];
        measure_slack(&mesh, solver, query, &count, &from_border, &apart);
        CHECK(i > 0 ? count >= least[i] : count == 0);
        CHECK(from_border >= 4.5 * (1 - (double)slacks[i]) - 1e-4 && apart >= 4.5 - 1e-3);
        CHECK(i < 3 || from_border == 0);
        /* the first is the one in the middle; it is alone where no more are wanted */
        query.count = 1;
        measure_slack(&mesh, solver, query, &count, &from_border, &apart);
        CHECK(count == (i > 0) && (i == 0 || from_border == 4));
        query.count = 1000;
    }
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

/* No two are nearer to each other than the last radius, and none of the surface is farther than that from all. */
static void test_spread(void)
{
    MesoTriangulation mesh = meso_fixture_sphere(40, 0.3f, 3);
    MesoGeodesicSolver *solver = solver_of(&mesh);
    float *distance = malloc(mesh.vertex_count * sizeof *distance);
    CHECK(distance);
    MesoSamples samples = sample(&mesh, solver, (MesoSampleQuery){.start = 5, .count = 1000, .radius = 0.2f}, distance);
    CHECK(samples.count > 100 && samples.count < 600 && samples.radius < 0.2f);
    for (uint32_t i = 0; i < samples.count; i++)
        for (uint32_t k = 0; k < i; k++) {
            float cosine = meso_vec3_dot(mesh.positions[samples.vertices[i]], mesh.positions[samples.vertices[k]]);
            CHECK(acosf(fminf(cosine, 1)) > 0.199f);
        }
    free(distance);
    meso_geodesic_release(solver);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    meso_arena_init(&arena);
    test_strip();
    test_greedy();
    test_slack();
    test_spread();
    meso_arena_release(&arena);
    return 0;
}
