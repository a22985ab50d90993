/* A sphere for tests and benchmarks. */
#ifndef MESO_SPHERE_FIXTURE_H
#define MESO_SPHERE_FIXTURE_H

#include "libcore/mesh/cut/triangulation_fixture.h"

/* Of ring `i` of 2 n + 1 from pole to pole, which has four quadrants of as many vertices as it is rings from a pole. */
static inline uint32_t meso_fixture_sphere_vertex(uint32_t n, uint32_t i, uint32_t quadrant, uint32_t j)
{
    uint32_t steps = i <= n ? i : 2 * n - i;
    uint32_t before = i == 0 ? 0 : i <= n ? 1 + 2 * i * (i - 1) : 4 * n * n + 1 - 2 * steps * (steps + 1);
    return steps == 0 ? before : before + (quadrant * steps + j) % (4 * steps);
}

/* Radius 1, an octahedron of 8 n^2 triangles whose rings are circles of latitude; vertices 0 and 4 n^2 + 1 are poles. */
static inline MesoTriangulation meso_fixture_sphere(uint32_t n)
{
    uint32_t vertex_count = 4 * n * n + 2, count = 0;
    MesoVec3 *positions = malloc(vertex_count * sizeof *positions);
    uint32_t *corners = malloc(24 * sizeof *corners * n * n);
    CHECK(positions && corners);
    for (uint32_t i = 0; i <= 2 * n; i++) {
        uint32_t steps = i <= n ? i : 2 * n - i;
        double theta = MESO_PI / 2 * i / n;
        for (uint32_t j = 0; j < (steps ? 4 * steps : 1); j++) {
            double phi = MESO_PI / 2 * j / (steps ? steps : 1);
            positions[meso_fixture_sphere_vertex(n, i, 0, j)] = (MesoVec3){
                (float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta)};
        }
    }
    for (uint32_t side = 0; side < 2; side++)
        for (uint32_t i = 1; i <= n; i++)
            for (uint32_t q = 0; q < 4; q++)
                for (uint32_t j = 0; j < i; j++) {
                    uint32_t outer = side ? 2 * n - i : i, inner = side ? outer + 1 : i - 1;
                    uint32_t a = meso_fixture_sphere_vertex(n, outer, q, j);
                    uint32_t b = meso_fixture_sphere_vertex(n, outer, q, j + 1);
                    uint32_t c = meso_fixture_sphere_vertex(n, inner, q, j);
                    uint32_t d = meso_fixture_sphere_vertex(n, inner, q, j + 1);
                    uint32_t two[6] = {a, side ? c : b, side ? b : c, b, side ? c : d, side ? d : c};
                    for (uint32_t k = 0; k < (j + 1 < i ? 6 : 3); k++)
                        corners[count++] = two[k];
                }
    CHECK(count == 24 * n * n);
    MesoTriangulation mesh = meso_fixture_triangulation(positions, vertex_count, corners, count / 3);
    free(positions);
    free(corners);
    return mesh;
}

#endif
