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

/* ---- grids of squares, each cut along a diagonal ---- */

typedef enum MesoFixtureSeam { MESO_SEAM_NONE, MESO_SEAM_JOINED, MESO_SEAM_TWISTED } MesoFixtureSeam;

typedef struct MesoFixtureSquares {
    uint32_t columns, rows;
    MesoFixtureSeam around;     /* of the last column and the first; twisted: upside down */
    bool over;                  /* the last row and the first are joined */
    float size[2];              /* for `place` */
    MesoVec3 (*place)(const struct MesoFixtureSquares *squares, uint32_t column, uint32_t row);
} MesoFixtureSquares;

/* Vertex row * (columns, one more where there is no seam) + column. */
static inline MesoTriangulation meso_fixture_squares(const MesoFixtureSquares *squares)
{
    uint32_t columns = squares->columns, rows = squares->rows, n = 0;
    uint32_t width = columns + (squares->around == MESO_SEAM_NONE), height = rows + !squares->over;
    MesoVec3 *positions = malloc(width * height * sizeof *positions);
    uint32_t *corners = malloc(6 * sizeof *corners * columns * rows);
    CHECK(positions && corners);
    for (uint32_t v = 0; v < width * height; v++)
        positions[v] = squares->place(squares, v % width, v / width);
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t c = 0; c < columns; c++) {
            bool turned = squares->around == MESO_SEAM_TWISTED && c + 1 == columns;
            uint32_t right = (c + 1) % width, low = r * width, high = (r + 1) % height * width;
            uint32_t far_low = turned ? (rows - r) * width : low, far_high = turned ? (rows - r - 1) * width : high;
            uint32_t quad[6] = {low + c, far_low + right, far_high + right, low + c, far_high + right, high + c};
            for (uint32_t k = 0; k < 6; k++)
                corners[n++] = quad[k];
        }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, width * height, corners, n / 3);
    free(positions);
    free(corners);
    return mesh;
}

static inline MesoVec3 meso_fixture_on_sheet(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    return (MesoVec3){squares->size[0] * (float)column, squares->size[0] * (float)row, 0};
}

/* Columns x rows squares of the given side in z = 0, each cut in two; vertex row * (columns + 1) + column. */
static inline MesoTriangulation meso_fixture_sheet(uint32_t columns, uint32_t rows, float side)
{
    return meso_fixture_squares(&(MesoFixtureSquares){columns, rows, MESO_SEAM_NONE, false, {side, 0},
                                                      meso_fixture_on_sheet});
}

static inline MesoVec3 meso_fixture_on_tube(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    double a = 2 * MESO_PI * column / squares->columns;
    return (MesoVec3){(float)cos(a), (float)sin(a), squares->size[0] * (float)row / (float)squares->rows};
}

/* A tube of `columns` x `rows` squares around the third axis, radius 1 at its corners, without lids. */
static inline MesoTriangulation meso_fixture_tube(uint32_t columns, uint32_t rows, float height)
{
    return meso_fixture_squares(&(MesoFixtureSquares){columns, rows, MESO_SEAM_JOINED, false, {height, 0},
                                                      meso_fixture_on_tube});
}

static inline MesoVec3 meso_fixture_on_torus(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    float a = 6.2831853f * (float)column / (float)squares->columns;
    float b = 6.2831853f * (float)row / (float)squares->rows;
    float tube = squares->size[0], r = 1 + tube * cosf(b);
    return (MesoVec3){r * cosf(a), r * sinf(a), tube * sinf(b)};
}

/* A closed torus of columns x rows squares, radii 1 and `tube`, each cut along a diagonal. */
static inline MesoTriangulation meso_fixture_torus(uint32_t columns, uint32_t rows, float tube)
{
    return meso_fixture_squares(&(MesoFixtureSquares){columns, rows, MESO_SEAM_JOINED, true, {tube, 0},
                                                      meso_fixture_on_torus});
}

/* ---- a sphere ---- */

/* The unit sphere from an octahedron whose sides are cut into `frequency` parts; vertex 0 is a pole. */
static inline MesoTriangulation meso_fixture_ball(uint32_t frequency)
{
    uint32_t f = frequency, ring_count = 2 * f + 1, vertex_count = 4 * f * f + 2, n = 0;
    MesoVec3 *positions = malloc(vertex_count * sizeof *positions);
    uint32_t *corners = malloc(3 * sizeof *corners * 8 * f * f), *first = malloc((ring_count + 1) * sizeof *first);
    CHECK(positions && corners && first);
    first[0] = 0;
    for (uint32_t r = 0; r < ring_count; r++) {
        uint32_t part = r <= f ? r : 2 * f - r, size = part ? 4 * part : 1;
        for (uint32_t i = 0; i < size; i++) {
            /* on the octahedron |x| + |y| + |z| = 1 */
            double z = 1 - (double)r / f, s = part ? (double)(i % part) / part : 0, rim = (double)part / f;
            double x = rim * (1 - s), y = rim * s, l = sqrt(x * x + y * y + z * z);
            double turned[4][2] = {{x, y}, {-y, x}, {-x, -y}, {y, -x}}, *xy = turned[part ? i / part : 0];
            positions[first[r] + i] = (MesoVec3){(float)(xy[0] / l), (float)(xy[1] / l), (float)(z / l)};
        }
        first[r + 1] = first[r] + size;
    }
    for (uint32_t r = 0; r < ring_count - 1; r++) {
        bool grows = r < f;
        uint32_t wide = grows ? r + 1 : r, narrow = grows ? r : r + 1, part = grows ? r + 1 : 2 * f - r;
        uint32_t wide_size = 4 * part, narrow_size = part > 1 ? 4 * (part - 1) : 1;
        for (uint32_t i = 0; i < wide_size; i++) {
            uint32_t a = first[wide] + i, b = first[wide] + (i + 1) % wide_size, in = i - i / part;
            uint32_t c = first[narrow] + in % narrow_size, d = first[narrow] + (in + narrow_size - 1) % narrow_size;
            uint32_t flat[3] = {a, grows ? b : c, grows ? c : b}, tip[3] = {a, grows ? c : d, grows ? d : c};
            for (uint32_t k = 0; k < 3; k++)
                corners[n++] = flat[k];
            for (uint32_t k = 0; k < 3 && i % part != 0; k++)
                corners[n++] = tip[k];
        }
    }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, vertex_count, corners, n / 3);
    free(positions);
    free(corners);
    free(first);
    return mesh;
}

#endif
