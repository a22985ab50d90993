/* Rates and errors of the distances. */
#include <stdio.h>

#include "libcore/base/clock.h"
#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/geodesic/geodesic_solver.h"

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int argc, char **argv)
{
    uint32_t n = argc > 1 ? (uint32_t)atoi(argv[1]) : 122;
    MesoError error;
    double t0 = cpu_seconds();
    MesoTriangulation mesh = meso_fixture_sphere(n, 0.3f, 7);
    CHECK(meso_triangulation_check(&mesh, &error) == MESO_OK);
    double t1 = cpu_seconds();
    MesoGeodesicSolver *solver;
    CHECK(meso_geodesic_init(&solver, &mesh, MESO_GEODESIC_FRONTS, &error) == MESO_OK);
    double t2 = cpu_seconds();
    printf("%u triangles: made in %.2f s, build %.3f s\n", mesh.triangle_count, t1 - t0, t2 - t1);
    float *distance = malloc(mesh.vertex_count * sizeof *distance);
    CHECK(distance);
    MesoGeodesicSeed seed = {(uint32_t)(0.37 * mesh.vertex_count), 0, false};
    MesoGeodesicQuery query = {.seeds = &seed, .seed_count = 1, .target = MESO_NO_INDEX};
    for (int plain = 0; plain < (getenv("A") ? 1 : 2); plain++) {
    solver->plain = plain;
    double best = 1e9;
    for (int round = 0; round < (getenv("A") ? 40 : 5); round++) {
        double start = cpu_seconds();
        CHECK(meso_geodesic_solve(solver, &query, distance, NULL, NULL, &error) == MESO_OK);
        double took = cpu_seconds() - start;
        best = took < best ? took : best;
    }
    double squares = 0, worst = 0;
    MesoVec3 s = mesh.positions[seed.vertex];
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        MesoVec3 p = mesh.positions[v], c = meso_vec3_cross(s, p);
        double exact = atan2(sqrt((double)c.x * c.x + (double)c.y * c.y + (double)c.z * c.z), meso_vec3_dot(s, p));
        if (v == seed.vertex)
            continue;
        double off = (distance[v] - exact) / exact;
        squares += off * off;
        if (exact > 0.06)
            worst = fabs(off) > worst ? fabs(off) : worst;
    }
    printf("solve %.4f s, RMS %.4f %%, max %.3f %%\n", best, 100 * sqrt(squares / mesh.vertex_count), 100 * worst);
    }
    return 0;
}
