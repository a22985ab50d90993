/* Seeds of cells, and what their borders must keep; for the tests of this folder. */
#ifndef MESO_VORONOI_FIXTURE_H
#define MESO_VORONOI_FIXTURE_H

#include "libcore/geodesic/cells/nearest_seeds.h"
#include "libcore/geodesic/cells/voronoi.h"
#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/geodesic/geodesic_solver.h"

static inline MesoGeodesicSolver *solver_of(const MesoTriangulation *mesh)
{
    MesoGeodesicSolver *solver;
    CHECK(meso_geodesic_init(&solver, mesh, MESO_GEODESIC_FRONTS, NULL) == MESO_OK);
    return solver;
}

static inline MesoMeshPoint random_point(const MesoTriangulation *mesh, MesoRandom *random)
{
    float a = 0.5f + 0.5f * meso_fixture_signed(random), b = 0.5f + 0.5f * meso_fixture_signed(random);
    if (a + b > 1)
        a = 1 - a, b = 1 - b;
    return (MesoMeshPoint){meso_random_below(random, mesh->triangle_count), {fmaxf(0, 1 - a - b), a, b}};
}

static inline MesoMeshPoint vertex_point(const MesoTriangulation *mesh, uint32_t vertex)
{
    uint32_t corner = mesh->vertex_corner[vertex];
    MesoMeshPoint point = {corner / 3, {0, 0, 0}};
    point.weight[corner % 3] = 1;
    return point;
}

/* Every node of a side has a segment in each of its triangles. */
static inline void check_no_gaps(const MesoTriangulation *mesh, const MesoDomain *domain, const MesoCutLines *lines)
{
    uint32_t *degree = calloc(lines->node_count + 1, sizeof *degree);
    CHECK(degree);
    for (uint32_t s = 0; s < lines->segment_count; s++)
        for (uint32_t k = 0; k < 2; k++)
            degree[lines->segments[s].node[k]]++;
    for (uint32_t n = 0; n < lines->node_count; n++) {
        const MesoCutNode *node = &lines->nodes[n];
        if (node->kind == MESO_IN_TRIANGLE) {
            CHECK(degree[n] >= 3 && node->share[0] >= 0 && node->share[1] >= 0);
            CHECK(node->share[0] + node->share[1] < 1.00001f);
            continue;
        }
        if (node->kind == MESO_AT_VERTEX) {
            CHECK(degree[n] >= 1);
            continue;
        }
        uint32_t across = mesh->twins[node->element];
        uint32_t sides = meso_domain_holds(domain, mesh, node->element / 3);
        sides += across != MESO_NO_INDEX && meso_domain_holds(domain, mesh, across / 3);
        CHECK(node->share[0] > 0 && node->share[0] < 1 && degree[n] == sides);
    }
    free(degree);
}

#endif
