/* What the tests of exact distances share. */
#ifndef MESO_EXACT_FIXTURE_H
#define MESO_EXACT_FIXTURE_H

#include "libcore/geodesic/exact/exact_geodesic.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

/* Solves, and stops the test where that fails; the caller frees. */
static inline double *meso_fixture_exact_query(const MesoTriangulation *mesh, const MesoExactGeodesicQuery *query)
{
    MesoArena arena;
    MesoExactGeodesicField field;
    MesoError error;
    double *distance = malloc((mesh->vertex_count + 1) * sizeof *distance);
    CHECK(distance);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        distance[v] = -1;
    meso_arena_init(&arena);
    CHECK(meso_exact_geodesic(mesh, NULL, query, &arena, distance, &field, &error) == MESO_OK);
    for (uint32_t i = 1; i < field.touched_count; i++)
        CHECK(distance[field.touched[i - 1]] <= distance[field.touched[i]]);
    meso_arena_release(&arena);
    return distance;
}

/* From one vertex, in all of the mesh. */
static inline double *meso_fixture_exact(const MesoTriangulation *mesh, uint32_t vertex)
{
    MesoExactGeodesicSeed seed = {vertex, 0, false};
    return meso_fixture_exact_query(mesh, &(MesoExactGeodesicQuery){.seeds = &seed, .seed_count = 1,
                                                            .target = MESO_NO_INDEX});
}

static inline bool meso_is_near(double a, double b, double tolerance)
{
    return fabs(a - b) <= tolerance * (1 + fabs(b));
}

/* The straight distance of two vertices. */
static inline double meso_fixture_straight(const MesoTriangulation *mesh, uint32_t a, uint32_t b)
{
    MesoVec3 p = mesh->positions[a], q = mesh->positions[b];
    double x = (double)p.x - q.x, y = (double)p.y - q.y, z = (double)p.z - q.z;
    return sqrt(x * x + y * y + z * z);
}

/* Nine by nine squares, of which the region 1 lacks three columns from the top down to row 3: a U. */
static inline MesoTriangulation meso_fixture_u(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(9, 9, 1);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        uint32_t column = t / 2 % 9, row = t / 18;
        mesh.labels[t] = row < 3 || column < 3 || column >= 6;
    }
    for (uint32_t h = 0; h < 3 * mesh.triangle_count; h++)
        if (mesh.twins[h] != MESO_NO_INDEX && mesh.labels[h / 3] != mesh.labels[mesh.twins[h] / 3])
            mesh.walls[h / 3] |= (uint8_t)(1u << h % 3);
    CHECK(meso_triangulation_check(&mesh, NULL) == MESO_OK);
    return mesh;
}

#endif
