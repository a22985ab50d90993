/* Geodesic paths against formulas and exact distances. */
#include "libcore/geodesic/exact/geodesic_path.h"

#include "libcore/base/random.h"
#include "libcore/geodesic/exact/exact_fixture.h"
#include "libcore/mesh/cut/mesh_cut.h"

/* ---- what a path must be ---- */

/* Whether a node is at a corner, on a side or inside of a triangle. */
static bool lies_in(const MesoTriangulation *mesh, const MesoCutNode *node, uint32_t triangle)
{
    for (uint32_t c = 3 * triangle; c < 3 * triangle + 3; c++) {
        if (node->kind == MESO_AT_VERTEX && mesh->corners[c] == node->element)
            return true;
        if (node->kind == MESO_ON_EDGE && (c == node->element || mesh->twins[c] == node->element))
            return true;
    }
    return node->kind == MESO_IN_TRIANGLE && node->element == triangle;
}

/* One chain of segments in the domain, as long as it says. */
static void check_lines(const MesoTriangulation *mesh, const MesoDomain *domain, const MesoCutLines *lines,
                        const MesoGeodesicPath *path)
{
    double length = 0;
    CHECK(lines->node_count == lines->segment_count + 1);
    for (uint32_t i = 0; i < lines->segment_count; i++) {
        const MesoCutSegment *segment = &lines->segments[i];
        const MesoCutNode *a = &lines->nodes[i], *b = &lines->nodes[i + 1];
        CHECK(segment->node[0] == i && segment->node[1] == i + 1 && segment->line == 7);
        CHECK(lies_in(mesh, a, segment->triangle) && lies_in(mesh, b, segment->triangle));
        CHECK(!domain || meso_domain_has(domain, mesh, segment->triangle));
        CHECK(a->kind != MESO_ON_EDGE || (a->share[0] > 0 && a->share[0] < 1));
        length += meso_vec3_length(meso_vec3_sub(meso_cut_node_position(mesh, a), meso_cut_node_position(mesh, b)));
    }
    CHECK(meso_is_near(length, path->length, 1e-5));
}

static bool strict = true;     /* whether all paths must become geodesics: on surfaces without sides of no length */

static double path_length(const MesoTriangulation *mesh, const MesoDomain *domain, MesoCutNode from, MesoCutNode to)
{
    MesoArena arena;
    MesoCutLines lines = {0};
    MesoGeodesicPath path;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(meso_geodesic_path(mesh, domain, from, to, 7, &arena, &lines, &path, &error) == MESO_OK);
    check_lines(mesh, domain, &lines, &path);
    CHECK(path.straight || !strict);
    meso_arena_release(&arena);
    return path.length;
}

static MesoCutNode at(uint32_t vertex)
{
    return (MesoCutNode){MESO_AT_VERTEX, vertex, {0, 0}};
}

/* INFINITY where it contracts. */
static double shortened_length(const MesoTriangulation *mesh, const uint32_t *vertices, uint32_t count, bool closed)
{
    MesoArena arena;
    MesoCutLines lines = {0};
    MesoGeodesicPath path;
    MesoError error;
    meso_arena_init(&arena);
    MesoStatus status = meso_geodesic_shorten(mesh, NULL, vertices, count, closed, 7, &arena, &lines, &path, &error);
    CHECK(status == MESO_OK || (closed && status == MESO_ERR_NO));
    if (!status)
        check_lines(mesh, NULL, &lines, &path);
    CHECK(status || path.straight || !strict);
    meso_arena_release(&arena);
    return status ? INFINITY : path.length;
}

/* ---- surfaces ---- */

static float draw(MesoRandom *random)
{
    return (float)(meso_random_below(random, 1 << 20)) / (1 << 20);
}

static MesoCutNode draw_node(const MesoTriangulation *mesh, MesoRandom *random)
{
    float a = 0.1f + 0.3f * draw(random), b = 0.1f + 0.3f * draw(random);
    switch (meso_random_below(random, 3)) {
    case 0: return at(meso_random_below(random, mesh->vertex_count));
    case 1: return (MesoCutNode){MESO_ON_EDGE, meso_random_below(random, 3 * mesh->triangle_count), {a, 0}};
    default: return (MesoCutNode){MESO_IN_TRIANGLE, meso_random_below(random, mesh->triangle_count), {a, b}};
    }
}

/* Straight between any two points of an irregular plane. */
static void test_plane(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(20, 15, 1);
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        if (v % 21 % 20 != 0 && v / 21 % 15 != 0) {
            mesh.positions[v].x += 0.4f * (draw(&random) - 0.5f);
            mesh.positions[v].y += 0.4f * (draw(&random) - 0.5f);
        }
    for (uint32_t i = 0; i < 300; i++) {
        MesoCutNode a = draw_node(&mesh, &random), b = draw_node(&mesh, &random);
        double straight = meso_vec3_length(meso_vec3_sub(meso_cut_node_position(&mesh, &a),
                                                         meso_cut_node_position(&mesh, &b)));
        CHECK(meso_is_near(path_length(&mesh, NULL, a, b), straight, 1e-6));
    }
    meso_triangulation_release(&mesh);
}

/* A helix is straight on the unrolled tube. */
static void test_helix(void)
{
    const uint32_t columns = 24, rows = 12;
    MesoTriangulation mesh = meso_fixture_tube(columns, rows, 4);
    double side = 2 * sin(MESO_PI / columns);
    for (uint32_t turn = 0; turn < 10; turn++) {
        double length = path_length(&mesh, NULL, at(3), at(rows * columns + (3 + turn) % columns));
        CHECK(meso_is_near(length, hypot(4, turn * side), 1e-6));
    }
    meso_triangulation_release(&mesh);
}

/* Near great circles on the sphere: most are the shortest, none is much longer: it passed a vertex on the other side. */
static void test_sphere(void)
{
    MesoTriangulation mesh = meso_fixture_ball(24);
    MesoRandom random;
    uint32_t shortest = 0, count = 0;
    meso_random_init(&random, 2, 0);
    for (uint32_t i = 0; i < 5; i++) {
        uint32_t source = meso_random_below(&random, mesh.vertex_count);
        double *distance = meso_fixture_exact(&mesh, source);
        for (uint32_t v = 0; v < mesh.vertex_count; v += 37, count++) {
            double length = v == source ? 0 : path_length(&mesh, NULL, at(source), at(v));
            CHECK(length >= distance[v] - 1e-9 && length <= distance[v] * 1.01);
            shortest += meso_is_near(length, distance[v], 1e-9);
        }
        free(distance);
    }
    CHECK(shortest > count * 6 / 10);
    meso_triangulation_release(&mesh);
}

/* On rough and on degenerate surfaces: between the exact distance and that of the edges it began with. */
static void test_rough(void)
{
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    for (uint32_t round = 0; round < 24; round++) {
        MesoTriangulation mesh = meso_fixture_torus(14, 9, 0.4f);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            for (float *x = &mesh.positions[v].x; x <= &mesh.positions[v].z; x++) {
                *x += 0.3f * (draw(&random) - 0.5f);
                *x = round % 3 == 2 ? roundf(*x * 4) / 4 : *x;
            }
        strict = round % 3 != 2;
        uint32_t source = meso_random_below(&random, mesh.vertex_count), vertices[24] = {source};
        double *distance = meso_fixture_exact(&mesh, source);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            if (v != source)
                CHECK(path_length(&mesh, NULL, at(source), at(v)) >= distance[v] - 1e-9);
        double along = 0;
        for (uint32_t i = 1; i < 24; i++) {     /* a walk without turning back */
            MesoFan fan = meso_fan_first(&mesh, vertices[i - 1]);
            for (uint32_t k = meso_random_below(&random, 6); k > 0; k--)
                meso_fan_next(&mesh, &fan);
            vertices[i] = mesh.corners[meso_next_corner(fan.corner)];
            along += meso_fixture_straight(&mesh, vertices[i - 1], vertices[i]);
        }
        if (vertices[23] != source) {
            double length = shortened_length(&mesh, vertices, 24, false);
            CHECK(length <= along * (1 + 1e-12) && length >= distance[vertices[23]] - 1e-9);
        }
        free(distance);
        meso_triangulation_release(&mesh);
    }
    strict = true;
}

/* ---- regions ---- */

/* In a U the path goes through both inner corners. */
static void test_u(void)
{
    const uint8_t member[2] = {0, 1};
    MesoDomain domain = {.member = member};
    MesoTriangulation mesh = meso_fixture_u();
    MesoArena arena;
    MesoCutLines lines = {0};
    MesoGeodesicPath path;
    meso_arena_init(&arena);
    CHECK(meso_geodesic_path(&mesh, &domain, at(91), at(98), 7, &arena, &lines, &path, NULL) == MESO_OK);
    check_lines(&mesh, &domain, &lines, &path);
    CHECK(meso_is_near(path.length, 2 * hypot(2, 6) + 3, 1e-9));
    uint32_t met = 0;
    for (uint32_t i = 0; i < lines.node_count; i++)
        met += lines.nodes[i].kind == MESO_AT_VERTEX && (lines.nodes[i].element == 33 || lines.nodes[i].element == 36);
    CHECK(met == 2);
    /* the two arms alone are apart */
    const uint8_t none[2] = {1, 0};
    domain.member = none;
    CHECK(meso_geodesic_path(&mesh, &domain, at(91), at(98), 7, &arena, &lines, &path, NULL) == MESO_ERR_NO);
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
}

/* Paths cut the mesh that they lie on. */
static void test_cut(void)
{
    MesoTriangulation mesh = meso_fixture_torus(40, 24, 0.4f);
    MesoRandom random;
    MesoArena arena;
    MesoCutLines lines = {0};
    MesoGeodesicPath path;
    MesoCutReport report;
    MesoError error;
    meso_random_init(&random, 4, 0);
    meso_arena_init(&arena);
    for (uint32_t i = 0; i < 12; i++) {
        MesoCutNode a = draw_node(&mesh, &random), b = draw_node(&mesh, &random);
        CHECK(meso_geodesic_path(&mesh, NULL, a, b, i, &arena, &lines, &path, &error) == MESO_OK);
    }
    CHECK(meso_mesh_cut(&mesh, &lines, &report, &arena, &error) == MESO_OK);
    CHECK(meso_triangulation_check(&mesh, &error) == MESO_OK);
    CHECK(mesh.vertex_count > 40 * 24 + 100);
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
}

/* ---- closed paths ---- */

/* Around a tube at any height; from a path that goes up and down. */
static void test_ring(void)
{
    enum { COLUMNS = 16 };
    MesoTriangulation mesh = meso_fixture_tube(COLUMNS, 8, 3);
    uint32_t vertices[2 * COLUMNS], count = 0;
    for (uint32_t c = 0; c < COLUMNS; c++) {
        uint32_t row = 2 + c % 4 / 2 * 2;
        vertices[count++] = row * COLUMNS + c;
        if (c % 4 == 1 || c % 4 == 3) {
            vertices[count++] = 3 * COLUMNS + c;
            vertices[count++] = (c % 4 == 1 ? 4u : 2u) * COLUMNS + c;
        }
    }
    CHECK(meso_is_near(shortened_length(&mesh, vertices, count, true), COLUMNS * 2 * sin(MESO_PI / COLUMNS), 1e-6));
    meso_triangulation_release(&mesh);
}

/* Around the tube of a torus, between two columns of vertices, where the section is least. */
static void test_torus_section(void)
{
    enum { COLUMNS = 20, ROWS = 12 };
    MesoTriangulation mesh = meso_fixture_torus(COLUMNS, ROWS, 0.4f);
    uint32_t vertices[ROWS];
    double least = 0, narrow = cos(MESO_PI / COLUMNS);
    for (uint32_t r = 0; r < ROWS; r++) {
        double a = 2 * MESO_PI * r / ROWS, b = 2 * MESO_PI * (r + 1) / ROWS;
        vertices[r] = r * COLUMNS + 4;
        least += 0.4 * hypot(narrow * (cos(b) - cos(a)), sin(b) - sin(a));
    }
    double length = shortened_length(&mesh, vertices, ROWS, true);
    CHECK(meso_is_near(length, least, 1e-5));
    meso_triangulation_release(&mesh);
}

/* The waist of a bumpy torus through its hole: never longer than the edges, and the same from any of them. */
static void test_waist(void)
{
    enum { COLUMNS = 20, ROWS = 12 };
    MesoTriangulation mesh = meso_fixture_torus(COLUMNS, ROWS, 0.4f);
    uint32_t vertices[COLUMNS];
    double along = 0, first = 0;
    for (uint32_t start = 0; start < COLUMNS; start += 3) {
        for (uint32_t c = 0; c < COLUMNS; c++)
            vertices[c] = (ROWS / 2 - 2) * COLUMNS + (start + c) % COLUMNS;
        double length = shortened_length(&mesh, vertices, COLUMNS, true);
        along = COLUMNS * 0.6 * 2 * sin(MESO_PI / COLUMNS);
        first = start == 0 ? length : first;
        CHECK(meso_is_near(length, along, 1e-6) && meso_is_near(length, first, 1e-6));
    }
    meso_triangulation_release(&mesh);
}

/* Along the middle of a band with one half turn. */
static void test_moebius(void)
{
    enum { COUNT = 15 };
    MesoVec3 positions[COUNT];
    uint32_t corners[3 * COUNT], vertices[COUNT];
    double along = 0;
    for (uint32_t v = 0; v < COUNT; v++) {
        float a = 6.2831853f * (float)v / COUNT;
        float r = 1 + 0.2f * cosf(a);
        positions[v] = (MesoVec3){r * cosf(2 * a), r * sinf(2 * a), 0.2f * sinf(a)};
        corners[3 * v] = v;
        corners[3 * v + 1] = (v + 1) % COUNT;
        corners[3 * v + 2] = (v + 2) % COUNT;
        vertices[v] = 2 * v % COUNT;
    }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, COUNT, corners, COUNT);
    for (uint32_t v = 0; v < COUNT; v++)
        along += meso_fixture_straight(&mesh, v, (v + 1) % COUNT);
    uint32_t once[COUNT];
    for (uint32_t v = 0; v < COUNT; v++)
        once[v] = v;
    double length = shortened_length(&mesh, once, COUNT, true);
    CHECK(length <= along && length > 6);
    /* the border runs around twice */
    CHECK(shortened_length(&mesh, vertices, COUNT, true) > length);
    meso_triangulation_release(&mesh);
}

/* Closed paths around nothing come to an end. */
static void test_contracting(void)
{
    MesoTriangulation sheet = meso_fixture_sheet(12, 12, 1), sphere = meso_fixture_ball(8);
    uint32_t vertices[32], count = 0;
    for (uint32_t i = 0; i < 8; i++)
        vertices[count++] = 2 * 13 + 2 + i;
    for (uint32_t i = 0; i < 8; i++)
        vertices[count++] = (2 + i) * 13 + 10;
    for (uint32_t i = 0; i < 8; i++)
        vertices[count++] = 10 * 13 + 10 - i;
    for (uint32_t i = 0; i < 8; i++)
        vertices[count++] = (10 - i) * 13 + 2;
    CHECK(shortened_length(&sheet, vertices, count, true) == INFINITY);
    for (uint32_t i = 0; i < 4; i++)    /* the ring next to the pole, and the first of it alone, there and back */
        vertices[i] = 1 + i;
    CHECK(shortened_length(&sphere, vertices, 4, true) == INFINITY);
    vertices[0] = 0;
    vertices[1] = 1;
    CHECK(shortened_length(&sphere, vertices, 2, true) == INFINITY);
    /* a circle of latitude slips off over the pole */
    for (uint32_t i = 0; i < 16; i++)
        vertices[i] = 1 + 4 + 8 + 12 + i;
    CHECK(shortened_length(&sphere, vertices, 16, true) == INFINITY);
    meso_triangulation_release(&sheet);
    meso_triangulation_release(&sphere);
}

int main(void)
{
    test_plane();
    test_helix();
    test_sphere();
    test_rough();
    test_u();
    test_cut();
    test_ring();
    test_torus_section();
    test_waist();
    test_moebius();
    test_contracting();
    return 0;
}
