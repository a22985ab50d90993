/* Irregular meshes whose distances are known by a formula, for tests and benchmarks. */
#ifndef MESO_GEODESIC_FIXTURE_H
#define MESO_GEODESIC_FIXTURE_H

#include "libcore/base/random.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

/* Uniform in [-1, 1). */
static inline float meso_fixture_signed(MesoRandom *random)
{
    return (float)(meso_random_next(random) >> 40) / 8388608.0f - 1;
}

/* ---- flips ---- */

static inline void meso_fixture_join(MesoTriangulation *mesh, uint32_t a, uint32_t b)
{
    mesh->twins[a] = b;
    if (b != MESO_NO_INDEX)
        mesh->twins[b] = a;
}

/* The corners of the two triangles at a side, the side's ends first and second; all are wound alike. */
static inline void meso_fixture_quad(const MesoTriangulation *mesh, uint32_t side, uint32_t quad[4])
{
    quad[0] = mesh->corners[side];
    quad[1] = mesh->corners[meso_next_corner(side)];
    quad[2] = mesh->corners[meso_previous_corner(side)];
    quad[3] = mesh->corners[meso_previous_corner(mesh->twins[side])];
}

/* Twice the cotangents that face a side, added: below 0 where a Delaunay flip is due. */
static inline float meso_fixture_cotangents(const MesoTriangulation *mesh, const uint32_t quad[4])
{
    float sum = 0;
    for (uint32_t k = 2; k < 4; k++) {
        MesoVec3 a = meso_vec3_sub(mesh->positions[quad[0]], mesh->positions[quad[k]]);
        MesoVec3 b = meso_vec3_sub(mesh->positions[quad[1]], mesh->positions[quad[k]]);
        sum += meso_vec3_dot(a, b) / (meso_vec3_length(meso_vec3_cross(a, b)) + 1e-30f);
    }
    return sum;
}

/* Whether the angles at both ends of the side stay below a straight one by `margin`, as a share of the lengths. */
static inline bool meso_fixture_convex(const MesoTriangulation *mesh, const uint32_t quad[4], float margin)
{
    for (uint32_t k = 0; k < 2; k++) {
        MesoVec3 at = mesh->positions[quad[k]], along = meso_vec3_sub(mesh->positions[quad[1 - k]], at);
        MesoVec3 a = meso_vec3_sub(mesh->positions[quad[2]], at), b = meso_vec3_sub(mesh->positions[quad[3]], at);
        float la = meso_vec3_length(along);
        float ax = meso_vec3_dot(a, along), ay = meso_vec3_length(meso_vec3_cross(a, along));
        float bx = meso_vec3_dot(b, along), by = meso_vec3_length(meso_vec3_cross(b, along));
        if (ax * by + ay * bx < margin * la * la * meso_vec3_length(a) * meso_vec3_length(b))
            return false;
    }
    return true;
}

static inline bool meso_fixture_are_joined(const MesoTriangulation *mesh, uint32_t a, uint32_t b)
{
    MesoFan fan = meso_fan_first(mesh, a);
    uint32_t first = fan.corner;
    do {
        if (mesh->corners[meso_next_corner(fan.corner)] == b || mesh->corners[meso_previous_corner(fan.corner)] == b)
            return true;
    } while (meso_fan_next(mesh, &fan) && fan.corner != first);
    return false;
}

/* Triangles a b c and b a d become c d b and d c a. */
static inline void meso_fixture_flip(MesoTriangulation *mesh, uint32_t side)
{
    uint32_t other = mesh->twins[side], quad[4];
    meso_fixture_quad(mesh, side, quad);
    uint32_t bc = mesh->twins[meso_next_corner(side)], ca = mesh->twins[meso_previous_corner(side)];
    uint32_t ad = mesh->twins[meso_next_corner(other)], db = mesh->twins[meso_previous_corner(other)];
    uint32_t s = side / 3 * 3, o = other / 3 * 3;
    const uint32_t corners[6] = {quad[2], quad[3], quad[1], quad[3], quad[2], quad[0]};
    for (uint32_t k = 0; k < 3; k++) {
        mesh->corners[s + k] = corners[k];
        mesh->corners[o + k] = corners[3 + k];
        mesh->vertex_corner[corners[k]] = s + k;
        mesh->vertex_corner[corners[3 + k]] = o + k;
    }
    meso_fixture_join(mesh, s, o);
    meso_fixture_join(mesh, s + 1, db);
    meso_fixture_join(mesh, s + 2, bc);
    meso_fixture_join(mesh, o + 1, ca);
    meso_fixture_join(mesh, o + 2, ad);
}

/* Flips an eighth of the sides at random, then `passes` times those that are not Delaunay. Walls are borders alone. */
static inline void meso_fixture_flip_sides(MesoTriangulation *mesh, uint64_t seed, uint32_t passes)
{
    MesoRandom random;
    meso_random_init(&random, seed, 1);
    for (uint32_t pass = 0; pass <= passes; pass++)
        for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
            bool due = pass > 0 || meso_random_below(&random, 8) == 0;
            uint32_t quad[4];
            if (!due || mesh->twins[h] == MESO_NO_INDEX || mesh->twins[h] < h)
                continue;
            meso_fixture_quad(mesh, h, quad);
            if (pass > 0 && !(meso_fixture_cotangents(mesh, quad) < 0))
                continue;
            if (meso_fixture_convex(mesh, quad, 0.02f) && !meso_fixture_are_joined(mesh, quad[2], quad[3]))
                meso_fixture_flip(mesh, h);
        }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        mesh->walls[t] = 0;
        for (uint32_t k = 0; k < 3; k++)
            if (mesh->twins[3 * t + k] == MESO_NO_INDEX)
                mesh->walls[t] |= (uint8_t)(1u << k);
    }
}

/* ---- sheets ---- */

typedef struct MesoFixtureSheet {
    uint32_t columns, rows;
    bool wraps;                 /* the last column is joined to the first */
    float jitter_x, jitter_y;   /* of a square's side, up to which inner vertices move; rows 0 and `rows` stay */
    uint64_t seed;
    MesoVec3 (*place)(float column, float row, const void *context);
    const void *context;
} MesoFixtureSheet;

/* Squares with random diagonals; vertex row * width + column, width = columns + 1, or columns where it wraps. */
static inline MesoTriangulation meso_fixture_place_sheet(const MesoFixtureSheet *sheet)
{
    uint32_t width = sheet->columns + !sheet->wraps, vertex_count = width * (sheet->rows + 1), n = 0;
    MesoVec3 *positions = malloc(vertex_count * sizeof *positions);
    uint32_t *corners = malloc(6 * sizeof *corners * sheet->columns * sheet->rows);
    CHECK(positions && corners);
    MesoRandom random;
    meso_random_init(&random, sheet->seed, 2);
    for (uint32_t v = 0; v < vertex_count; v++) {
        uint32_t c = v % width, r = v / width;
        float x = sheet->jitter_x * meso_fixture_signed(&random), y = sheet->jitter_y * meso_fixture_signed(&random);
        if (!sheet->wraps && (c == 0 || c == sheet->columns))
            x = 0;
        if (r == 0 || r == sheet->rows)
            y = 0;
        positions[v] = sheet->place((float)c + x, (float)r + y, sheet->context);
    }
    for (uint32_t r = 0; r < sheet->rows; r++)
        for (uint32_t c = 0; c < sheet->columns; c++) {
            uint32_t right = (c + 1) % width;
            uint32_t q[4] = {r * width + c, r * width + right, (r + 1) * width + right, (r + 1) * width + c};
            uint32_t turn = meso_random_below(&random, 2);
            for (uint32_t k = 0; k < 6; k++)
                corners[n++] = q[((k < 3 ? k : k == 3 ? 0 : k - 2) + turn) % 4];
        }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, vertex_count, corners, n / 3);
    free(positions);
    free(corners);
    return mesh;
}

/* ---- spheres ---- */

typedef struct MesoFixtureIcosahedron {
    MesoVec3 corners[12];
    uint32_t faces[20][3];
    uint32_t edges[12][12];     /* number of the edge between two corners */
} MesoFixtureIcosahedron;

static inline MesoFixtureIcosahedron meso_fixture_icosahedron(void)
{
    static const uint32_t faces[20][3] = {
        {0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6},
        {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7},
        {9, 8, 1}};
    const float g = 1.6180339887f;
    MesoFixtureIcosahedron solid = {.corners = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g},
                                                {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}}};
    uint32_t edge_count = 0;
    for (uint32_t f = 0; f < 20; f++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = faces[f][k], b = faces[f][(k + 1) % 3];
            solid.faces[f][k] = a;
            if (a < b)
                solid.edges[a][b] = solid.edges[b][a] = edge_count++;
        }
    return solid;
}

/* The vertex in row r and place c of a face that is divided `n` times: row 0 is its first corner. */
static inline uint32_t meso_fixture_sphere_vertex(const MesoFixtureIcosahedron *solid, uint32_t n, uint32_t face,
                                                  uint32_t r, uint32_t c)
{
    const uint32_t *f = solid->faces[face];
    if (r == 0)
        return f[0];
    if (r == n && (c == 0 || c == n))
        return f[c == 0 ? 1 : 2];
    uint32_t a = f[0], b = f[1], along = r;
    if (r == n)
        a = f[1], b = f[2], along = c;
    else if (c == r)
        b = f[2];
    if (r == n || c == 0 || c == r)
        return 12 + solid->edges[a][b] * (n - 1) + (a < b ? along : n - along) - 1;
    return 12 + 30 * (n - 1) + face * ((n - 1) * (n - 2) / 2) + (r - 1) * (r - 2) / 2 + c - 1;
}

static inline void meso_fixture_sphere_face(const MesoFixtureIcosahedron *solid, uint32_t n, uint32_t face,
                                            MesoVec3 *positions, uint32_t *corners)
{
    const uint32_t *f = solid->faces[face];
    for (uint32_t r = 0; r <= n; r++)
        for (uint32_t c = 0; c <= r; c++) {
            float wa = (float)(n - r) / (float)n, wb = (float)(r - c) / (float)n, wc = (float)c / (float)n;
            MesoVec3 p = meso_vec3_scale(solid->corners[f[0]], wa);
            p = meso_vec3_mad(p, wb, solid->corners[f[1]]);
            p = meso_vec3_mad(p, wc, solid->corners[f[2]]);
            positions[meso_fixture_sphere_vertex(solid, n, face, r, c)] = meso_vec3_unit(p, p);
        }
    for (uint32_t r = 0; r < n; r++)
        for (uint32_t c = 0; c <= r; c++) {
            uint32_t top = meso_fixture_sphere_vertex(solid, n, face, r, c);
            uint32_t left = meso_fixture_sphere_vertex(solid, n, face, r + 1, c);
            uint32_t right = meso_fixture_sphere_vertex(solid, n, face, r + 1, c + 1);
            *corners++ = top, *corners++ = left, *corners++ = right;
            if (c < r)
                *corners++ = top, *corners++ = right, *corners++ = meso_fixture_sphere_vertex(solid, n, face, r, c + 1);
        }
}

/* A unit sphere of 20 n^2 triangles; vertices are moved by up to `jitter` of a side. */
static inline MesoTriangulation meso_fixture_sphere(uint32_t n, float jitter, uint64_t seed)
{
    MesoFixtureIcosahedron solid = meso_fixture_icosahedron();
    uint32_t vertex_count = 10 * n * n + 2, triangle_count = 20 * n * n;
    MesoVec3 *positions = malloc(vertex_count * sizeof *positions);
    uint32_t *corners = malloc(3 * (size_t)triangle_count * sizeof *corners);
    CHECK(positions && corners);
    for (uint32_t face = 0; face < 20; face++)
        meso_fixture_sphere_face(&solid, n, face, positions, corners + 3 * (size_t)face * n * n);
    MesoRandom random;
    meso_random_init(&random, seed, 0);
    float size = jitter * 1.1f / (float)n;
    for (uint32_t v = 0; v < vertex_count; v++) {
        MesoVec3 by = {meso_fixture_signed(&random), meso_fixture_signed(&random), meso_fixture_signed(&random)};
        MesoVec3 moved = meso_vec3_mad(positions[v], size, by);
        positions[v] = meso_vec3_unit(moved, moved);
    }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, vertex_count, corners, triangle_count);
    free(positions);
    free(corners);
    if (jitter > 0)
        meso_fixture_flip_sides(&mesh, seed, 3);
    return mesh;
}

#endif
