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

/* A tube of `columns` x `rows` squares around the third axis, radius 1 at its corners, without lids. */
static inline MesoTriangulation meso_fixture_tube(uint32_t columns, uint32_t rows, float height)
{
    uint32_t vertex_count = columns * (rows + 1), n = 0;
    MesoVec3 *positions = malloc(vertex_count * sizeof *positions);
    uint32_t *corners = malloc(6 * sizeof *corners * columns * rows);
    CHECK(positions && corners);
    for (uint32_t v = 0; v < vertex_count; v++) {
        double a = 2 * MESO_PI * (v % columns) / columns;
        positions[v] = (MesoVec3){(float)cos(a), (float)sin(a), height * (float)(v / columns) / (float)rows};
    }
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t c = 0; c < columns; c++) {
            uint32_t a = r * columns + c, b = r * columns + (c + 1) % columns;
            uint32_t quad[6] = {a, b, b + columns, a, b + columns, a + columns};
            for (uint32_t k = 0; k < 6; k++)
                corners[n++] = quad[k];
        }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, vertex_count, corners, n / 3);
    free(positions);
    free(corners);
    return mesh;
}

/* The unit sphere from an octahedron whose sides are cut into `frequency` parts; vertex 0 is a pole. */
static inline MesoTriangulation meso_fixture_sphere(uint32_t frequency)
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
