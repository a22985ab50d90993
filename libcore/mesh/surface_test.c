/* What a surface knows of its mesh, and what it is asked for. */
#include "libcore/mesh/surface.h"

#include <math.h>
#include <string.h>

#include "libcore/base/check.h"

static MesoArena arena;
static MesoError error;
static MesoSurface surface;

/* Two triangles of a unit square, wound alike or not, and what stands on their common edge. */
static MesoVec3 positions[5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};

static void build(uint32_t face_count, uint32_t *corners)
{
    MesoPolygonMesh mesh = {.vertex_count = 5, .face_count = face_count, .corner_count = 3 * face_count,
                            .side_count = 3, .positions = positions, .corners = corners};
    CHECK(meso_surface_build(&surface, &arena, &mesh, 0, &error) == MESO_OK);
}

static void expect(unsigned needs, uint32_t face, const char *message)
{
    uint32_t found;
    CHECK(meso_surface_require(&surface, needs, &found, &error) == MESO_ERR_INPUT);
    CHECK(found == face && strcmp(error.message, message) == 0);
}

static void test_triangles(void)
{
    build(2, (uint32_t[]){0, 1, 2, 0, 2, 3});
    CHECK(surface.edges.edge_count == 5 && surface.edges.border_count == 4 && surface.edges.twin[2] == 3);
    CHECK(fabsf(surface.mean_edge_length - (4 + 2 * sqrtf(2)) / 6) < 1e-6f);
    CHECK(meso_surface_require(&surface, MESO_NEEDS_TRIANGLES | MESO_NEEDS_MANIFOLD | MESO_NEEDS_ORIENTED, NULL,
                               &error) ==
          MESO_OK);
    expect(MESO_NEEDS_QUADS, 0, "face 1 has 3 sides; every face of a macrosurface must be a quad: meso-mesh quads makes them");
    build(2, (uint32_t[]){0, 1, 2, 2, 0, 3});
    CHECK(surface.edges.reversed_count == 1 && surface.edges.twin[2] == 3);
    expect(MESO_NEEDS_TRIANGLES | MESO_NEEDS_ORIENTED, 0, "face 1 is wound against its neighbour, face 2");
    build(3, (uint32_t[]){0, 1, 2, 0, 2, 3, 0, 2, 4});
    CHECK(surface.edges.crowded_count == 1 && surface.edges.edge_count == 7);
    expect(MESO_NEEDS_MANIFOLD, MESO_NO_INDEX, "edge between vertices 1 and 3 joins more than two faces (1, 2, 3)");
}

/* Sums of blocks: the same on any number of threads, and the plain sum where there is one block. */
static void test_mean_edge(void)
{
    enum { FACES = 200000 };
    static uint32_t corners[3 * FACES];
    static MesoVec3 points[FACES + 2];
    for (uint32_t v = 0; v < FACES + 2; v++)
        points[v] = (MesoVec3){(float)v * 0.37f, sinf((float)v), cosf(3 * (float)v)};
    for (uint32_t c = 0; c < 3 * FACES; c++)
        corners[c] = c / 3 + c % 3;
    MesoPolygonMesh mesh = {.vertex_count = FACES + 2, .face_count = FACES, .corner_count = 3 * FACES, .side_count = 3,
                            .positions = points, .corners = corners};
    CHECK(meso_polygon_mean_edge(&mesh, 1) == meso_polygon_mean_edge(&mesh, 3));
    mesh.face_count = 1000;
    mesh.corner_count = 3000;
    double sum = 0;
    for (uint32_t c = 0; c < 3000; c++) {
        MesoVec3 a = points[corners[c]], b = points[corners[c % 3 == 2 ? c - 2 : c + 1]];
        double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z;
        sum += sqrt(x * x + y * y + z * z);
    }
    CHECK(meso_polygon_mean_edge(&mesh, 2) == sum / 3000);
}

int main(void)
{
    meso_arena_init(&arena);
    test_triangles();
    test_mean_edge();
    meso_arena_release(&arena);
    return 0;
}
