/* Triangulations for tests, benchmarks and fuzz entries. */
#ifndef MESO_TRIANGULATION_FIXTURE_H
#define MESO_TRIANGULATION_FIXTURE_H

#include "libcore/base/check.h"
#include "libcore/mesh/cut/triangulation.h"

/* Of the given vertices and triangles; stops the test where they are no manifold. */
static inline MesoTriangulation meso_fixture_triangulation(const MesoVec3 *positions, uint32_t vertex_count,
                                                           const uint32_t *corners, uint32_t triangle_count)
{
    MesoArena arena;
    MesoSurface surface;
    MesoTriangulation mesh;
    MesoError error;
    meso_arena_init(&arena);
    MesoPolygonMesh polygons = {
        .vertex_count = vertex_count, .face_count = triangle_count, .corner_count = 3 * triangle_count, .side_count = 3,
    };
    polygons.positions = MESO_NEW(&arena, MesoVec3, vertex_count, &error);
    polygons.corners = MESO_NEW(&arena, uint32_t, 3 * (size_t)triangle_count, &error);
    polygons.attributes = MESO_NEW(&arena, MesoAttribute, 0, &error);
    CHECK(polygons.positions && polygons.corners && polygons.attributes);
    for (uint32_t v = 0; v < vertex_count; v++)
        polygons.positions[v] = positions[v];
    for (uint32_t c = 0; c < 3 * triangle_count; c++)
        polygons.corners[c] = corners[c];
    CHECK(meso_polygon_mesh_check(&polygons, 1, NULL, &error) == MESO_OK);
    CHECK(meso_surface_build(&surface, &arena, &polygons, 1, &error) == MESO_OK);
    CHECK(meso_triangulation_init(&mesh, &surface, 0, 0, &error) == MESO_OK);
    CHECK(meso_triangulation_check(&mesh, &error) == MESO_OK);
    meso_arena_release(&arena);
    return mesh;
}

/* Columns x rows squares of the given side in z = 0, each cut in two; vertex row * (columns + 1) + column. */
static inline MesoTriangulation meso_fixture_sheet(uint32_t columns, uint32_t rows, float side)
{
    uint32_t width = columns + 1, vertex_count = width * (rows + 1), n = 0;
    MesoVec3 *positions = malloc(vertex_count * sizeof *positions);
    uint32_t *corners = malloc(6 * sizeof *corners * columns * rows);
    CHECK(positions && corners);
    for (uint32_t v = 0; v < vertex_count; v++)
        positions[v] = (MesoVec3){side * (float)(v % width), side * (float)(v / width), 0};
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t c = 0; c < columns; c++) {
            uint32_t a = r * width + c, quad[6] = {a, a + 1, a + width + 1, a, a + width + 1, a + width};
            for (uint32_t k = 0; k < 6; k++)
                corners[n++] = quad[k];
        }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, vertex_count, corners, n / 3);
    free(positions);
    free(corners);
    return mesh;
}

/* A closed torus of columns x rows squares, radii 1 and `tube`, each cut along a diagonal. */
static inline MesoTriangulation meso_fixture_torus(uint32_t columns, uint32_t rows, float tube)
{
    uint32_t vertex_count = columns * rows, n = 0;
    MesoVec3 *positions = malloc(vertex_count * sizeof *positions);
    uint32_t *corners = malloc(6 * sizeof *corners * columns * rows);
    CHECK(positions && corners);
    for (uint32_t v = 0; v < vertex_count; v++) {
        float a = 6.2831853f * (float)(v % columns) / (float)columns;
        float b = 6.2831853f * (float)(v / columns) / (float)rows;
        float r = 1 + tube * cosf(b);
        positions[v] = (MesoVec3){r * cosf(a), r * sinf(a), tube * sinf(b)};
    }
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t c = 0; c < columns; c++) {
            uint32_t right = (c + 1) % columns, up = (r + 1) % rows * columns, low = r * columns;
            uint32_t quad[6] = {low + c, low + right, up + right, low + c, up + right, up + c};
            for (uint32_t k = 0; k < 6; k++)
                corners[n++] = quad[k];
        }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, vertex_count, corners, n / 3);
    free(positions);
    free(corners);
    return mesh;
}

#endif
