/* Tubes and spheres for tests of seams, and what a mesh of triangles is. */
#ifndef MESO_STRAND_FIXTURE_H
#define MESO_STRAND_FIXTURE_H

#include <stdlib.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/math/vec.h"

typedef struct MesoFixtureMesh {
    uint32_t vertex_count, triangle_count;
    MesoVec3 *positions;
    uint32_t *corners;
} MesoFixtureMesh;

/* A tube along x from 0 to 1, bent by sines, of `rings` x `sides` vertices; open at both ends. */
static inline MesoFixtureMesh meso_fixture_tube(uint32_t rings, uint32_t sides, float radius, float bend)
{
    MesoFixtureMesh mesh = {.vertex_count = rings * sides};
    mesh.positions = malloc(mesh.vertex_count * sizeof *mesh.positions);
    mesh.corners = malloc(6 * (size_t)mesh.vertex_count * sizeof *mesh.corners);
    CHECK(mesh.positions && mesh.corners);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        float x = (float)(v / sides) / (float)(rings - 1), a = 6.2831853f * (float)(v % sides) / (float)sides;
        mesh.positions[v] = (MesoVec3){x, radius * cosf(a) + bend * sinf(5 * x), radius * sinf(a) + bend * cosf(7 * x)};
    }
    for (uint32_t r = 0; r + 1 < rings; r++)
        for (uint32_t k = 0; k < sides; k++) {
            uint32_t a = r * sides + k, b = r * sides + (k + 1) % sides, quad[6] = {a, b + sides, a + sides, a, b, b + sides};
            memcpy(&mesh.corners[3 * (size_t)mesh.triangle_count], quad, sizeof quad);
            mesh.triangle_count += 2;
        }
    return mesh;
}

static inline void meso_fixture_mesh_release(MesoFixtureMesh *mesh)
{
    free(mesh->positions);
    free(mesh->corners);
}

typedef struct MesoFixtureEdge {
    uint32_t low, high;
    int direction;
} MesoFixtureEdge;

static inline int meso_fixture_compare_edges(const void *a, const void *b)
{
    const MesoFixtureEdge *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    return x->high < y->high ? -1 : x->high > y->high;
}

/* Edges with one triangle. Stops the test where an edge has three, or two that run along it the same way. */
static inline uint32_t meso_fixture_open_edges(const uint32_t *corners, uint32_t triangle_count)
{
    size_t count = 3 * (size_t)triangle_count;
    uint32_t open = 0;
    MesoFixtureEdge *edges = malloc(count * sizeof *edges + 1);
    CHECK(edges);
    for (size_t h = 0; h < count; h++) {
        uint32_t a = corners[h], b = corners[h % 3 == 2 ? h - 2 : h + 1];
        CHECK(a != b);
        edges[h] = a < b ? (MesoFixtureEdge){a, b, 1} : (MesoFixtureEdge){b, a, -1};
    }
    qsort(edges, count, sizeof *edges, meso_fixture_compare_edges);
    for (size_t i = 0; i < count;) {
        size_t j = i + 1;
        while (j < count && meso_fixture_compare_edges(&edges[i], &edges[j]) == 0)
            j++;
        CHECK(j - i <= 2);
        CHECK(j - i == 1 || edges[i].direction == -edges[i + 1].direction);
        open += j - i == 1;
        i = j;
    }
    free(edges);
    return open;
}

static inline float meso_fixture_random(MesoRandom *random)
{
    return (float)meso_random_below(random, 1 << 24) / (1 << 23) - 1;
}

#endif
