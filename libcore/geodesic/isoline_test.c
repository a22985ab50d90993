#include <string.h>

#include "libcore/geodesic/isoline.h"
#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/geodesic/regions_fixture.h"

static MesoArena arena;

static MesoCutLines trace(const MesoTriangulation *mesh, const MesoDomain *domain, const float *field,
                          const float *levels, uint32_t level_count)
{
    MesoCutLines lines = {0};
    MesoIsolineQuery query = {domain, field, levels, level_count};
    CHECK(meso_isolines_trace(&lines, &arena, mesh, &query, NULL) == MESO_OK);
    return lines;
}

static double length_of(const MesoTriangulation *mesh, const MesoCutLines *lines, uint32_t level)
{
    double length = 0;
    for (uint32_t s = 0; s < lines->segment_count; s++) {
        const MesoCutSegment *segment = &lines->segments[s];
        MesoVec3 a = meso_cut_node_position(mesh, &lines->nodes[segment->node[0]]);
        MesoVec3 b = meso_cut_node_position(mesh, &lines->nodes[segment->node[1]]);
        if (segment->line == level)
            length += meso_vec3_length(meso_vec3_sub(a, b));
    }
    return length;
}

/* Segments that begin and end at each node; counts nodes at which they do not balance, and those that none has. */
static void count_ends(const MesoCutLines *lines, uint32_t *open, uint32_t *unused)
{
    int *balance = calloc(lines->node_count + 1, sizeof *balance);
    uint32_t *degree = calloc(lines->node_count + 1, sizeof *degree);
    CHECK(balance && degree);
    for (uint32_t s = 0; s < lines->segment_count; s++)
        for (uint32_t k = 0; k < 2; k++) {
            balance[lines->segments[s].node[k]] += k == 0 ? 1 : -1;
            degree[lines->segments[s].node[k]]++;
        }
    *open = *unused = 0;
    for (uint32_t n = 0; n < lines->node_count; n++) {
        *open += balance[n] != 0;
        *unused += degree[n] == 0;
    }
    free(balance);
    free(degree);
}

/*
 *  2        one level half-way up to vertex 2: from side 1 to side 2, with what is above to the left
 *  | \
 *  0--1
 */
static void test_triangle(void)
{
    const MesoVec3 positions[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const uint32_t corners[3] = {0, 1, 2};
    const float field[3] = {0, 0, 1}, levels[3] = {0.25f, 0.5f, 0.75f};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 3, corners, 1);
    MesoCutLines lines = trace(&mesh, NULL, field, levels, 3);
    CHECK(lines.node_count == 6 && lines.segment_count == 3);
    for (uint32_t l = 0; l < 3; l++) {
        const MesoCutSegment *segment = &lines.segments[l];
        const MesoCutNode *a = &lines.nodes[segment->node[0]], *b = &lines.nodes[segment->node[1]];
        CHECK(segment->triangle == 0 && segment->line == l);
        CHECK(a->kind == MESO_ON_EDGE && a->element == 2 && a->share[0] == 1 - levels[l]);
        CHECK(b->kind == MESO_ON_EDGE && b->element == 1 && b->share[0] == levels[l]);
    }
    meso_triangulation_release(&mesh);
}

/* Levels at the lowest and the highest value, and beyond, have no line. */
static void test_extremes(void)
{
    const float levels[4] = {-1, 0, 4, 5};
    float field[25];
    MesoTriangulation mesh = meso_fixture_sheet(4, 4, 1);
    for (uint32_t v = 0; v < 25; v++)
        field[v] = (float)(v % 5);
    CHECK(trace(&mesh, NULL, field, levels, 4).segment_count == 0);
    for (uint32_t v = 0; v < 25; v++)
        field[v] = 4;
    CHECK(trace(&mesh, NULL, field, levels, 4).segment_count == 0);
    CHECK(trace(&mesh, NULL, field, levels, 0).segment_count == 0);
    meso_triangulation_release(&mesh);
}

/* Along edges on the level, and through vertices that are nearly on it: the same segments, each once. */
static void test_along_edges(void)
{
    float field[25], level = 2;
    MesoTriangulation mesh = meso_fixture_sheet(4, 4, 1);
    for (uint32_t round = 0; round < 3; round++) {
        for (uint32_t v = 0; v < 25; v++)
            field[v] = (float)(v % 5) + (v % 5 == 2 ? 0.003f * ((float)round - 1) * (v / 5 % 2 ? 1 : -1) : 0);
        MesoCutLines lines = trace(&mesh, NULL, field, &level, 1);
        CHECK(lines.node_count == 5 && lines.segment_count == 4);
        for (uint32_t n = 0; n < 5; n++)
            CHECK(lines.nodes[n].kind == MESO_AT_VERTEX && lines.nodes[n].element % 5 == 2);
        for (uint32_t s = 0; s < 4; s++) {    /* above, which is right, to the left: downwards */
            const uint32_t *node = lines.segments[s].node;
            CHECK(lines.nodes[node[0]].element == lines.nodes[node[1]].element + 5);
        }
    }
    meso_triangulation_release(&mesh);
}

/* A ridge and a valley on the level are no line; a plateau has one towards what is below alone. */
static void test_plateaus(void)
{
    const float profiles[4][7] = {
        {0, 1, 2, 3, 2, 1, 0}, {3, 2, 1, 0, 1, 2, 3}, {0, 1, 2, 2, 2, 3, 4}, {0, 1, 2, 2, 2, 1, 0}};
    const float levels[4] = {3, 0, 2, 2};
    const uint32_t segments[4] = {0, 0, 6, 12};
    MesoTriangulation mesh = meso_fixture_sheet(6, 6, 1);
    for (uint32_t i = 0; i < 4; i++) {
        float field[49];
        for (uint32_t v = 0; v < 49; v++)
            field[v] = profiles[i][v % 7];
        MesoCutLines lines = trace(&mesh, NULL, field, &levels[i], 1);
        CHECK(lines.segment_count == segments[i]);
        for (uint32_t n = 0; n < lines.node_count; n++) {
            uint32_t column = lines.nodes[n].element % 7;
            CHECK(lines.nodes[n].kind == MESO_AT_VERTEX && (column == 2 || column == 4));
        }
    }
    meso_triangulation_release(&mesh);
}

/*
 * The saddles -x y and x y at their own value: both axes, four segments at the middle; and where diagonals cut the
 * plateaus 0 0 0 off what is below, two lines past it.
 */
static void test_saddle(void)
{
    const uint32_t segments[2] = {8, 6}, at_middle[2] = {4, 0};
    float field[25], level = 0;
    MesoTriangulation mesh = meso_fixture_sheet(4, 4, 1);
    for (uint32_t round = 0; round < 2; round++) {
        for (uint32_t v = 0; v < 25; v++)
            field[v] = ((float)(v % 5) - 2) * ((float)(v / 5) - 2) * (round ? 1 : -1);
        MesoCutLines lines = trace(&mesh, NULL, field, &level, 1);
        uint32_t ends = 0;
        for (uint32_t s = 0; s < lines.segment_count; s++)
            for (uint32_t k = 0; k < 2; k++)
                ends += lines.nodes[lines.segments[s].node[k]].element == 12;
        CHECK(lines.segment_count == segments[round] && ends == at_middle[round]);
    }
    meso_triangulation_release(&mesh);
}

/* A vertex without a value stands above all, and lines pass it half-way. */
static void test_without_value(void)
{
    float field[9] = {0, 0, 0, 0, INFINITY, 0, 0, 0, 0}, level = 1000;
    MesoTriangulation mesh = meso_fixture_sheet(2, 2, 1);
    for (uint32_t round = 0; round < 2; round++) {
        MesoCutLines lines = trace(&mesh, NULL, field, &level, 1);
        CHECK(lines.node_count == 6 && lines.segment_count == 6);
        for (uint32_t n = 0; n < 6; n++)
            CHECK(lines.nodes[n].kind == MESO_ON_EDGE && lines.nodes[n].share[0] == 0.5f);
        field[4] = NAN;
    }
    for (uint32_t v = 0; v < 9; v++)
        field[v] = INFINITY;
    CHECK(trace(&mesh, NULL, field, &level, 1).segment_count == 0);
    meso_triangulation_release(&mesh);
}

/* Lines end at the border of a domain, and are those of the mesh inside. */
static void test_domain(void)
{
    enum { SIDE = 64, WIDTH = SIDE + 1 };
    static float field[WIDTH * WIDTH];
    static uint32_t triangles[2 * SIDE * SIDE];
    const uint8_t member[2] = {0, 1};
    const float level = 20.3f;
    uint32_t open, unused;
    MesoTriangulation mesh = meso_fixture_sheet(SIDE, SIDE, 1);
    for (uint32_t v = 0; v < WIDTH * WIDTH; v++)
        field[v] = hypotf((float)(v % WIDTH) - 32, (float)(v / WIDTH) - 32);
    for (uint32_t stripe = 1; stripe < 20; stripe += 5) {    /* one row of quads: scratch is numbered sparsely */
        MesoDomain domain = {member, 0, triangles};
        for (uint32_t t = 0; t < mesh.triangle_count; t++) {
            mesh.labels[t] = t / 2 / SIDE >= 32 && t / 2 / SIDE < 32 + stripe;
            if (mesh.labels[t])
                triangles[domain.triangle_count++] = t;
        }
        MesoCutLines lines = trace(&mesh, &domain, field, &level, 1);
        count_ends(&lines, &open, &unused);
        CHECK(open == 4 && unused == 0);
        CHECK(fabs(length_of(&mesh, &lines, 0) - 2.0 * level * asin((double)stripe / level)) < 0.01 * stripe);
        domain.triangles = NULL;
        domain.member = NULL;
        MesoCutLines all = trace(&mesh, &domain, field, &level, 1);
        count_ends(&all, &open, &unused);
        CHECK(open == 0 && unused == 0 && all.segment_count > lines.segment_count);
    }
    meso_triangulation_release(&mesh);
}

/* Circles around a point: 2 pi sin r, and nearer as the square of the triangles; closed; the same again. */
static void test_sphere(void)
{
    enum { LEVELS = 50 };
    float levels[LEVELS];
    double worst[2] = {0};
    for (uint32_t l = 0; l < LEVELS; l++)
        levels[l] = 0.05f + 0.06f * (float)l;
    for (uint32_t round = 0; round < 2; round++) {
        uint32_t open, unused;
        MesoTriangulation mesh = meso_fixture_sphere(round ? 50 : 25, 0.3f, 1);
        float *field = malloc(mesh.vertex_count * sizeof *field);
        CHECK(field);
        /* from a pole that is no vertex */
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            field[v] = acosf(meso_vec3_dot(mesh.positions[v], (MesoVec3){0.48f, 0.6f, 0.64f}));
        MesoCutLines lines = trace(&mesh, NULL, field, levels, LEVELS);
        count_ends(&lines, &open, &unused);
        CHECK(open == 0 && unused == 0);
        for (uint32_t l = 0; l < LEVELS; l++) {
            double error = length_of(&mesh, &lines, l) / (2 * MESO_PI * sin(levels[l])) - 1;
            worst[round] = fmax(worst[round], l >= 4 ? fabs(error) : 0);
        }
        MesoCutLines again = trace(&mesh, NULL, field, levels, LEVELS);
        CHECK(again.node_count == lines.node_count && again.segment_count == lines.segment_count);
        CHECK(!memcmp(again.nodes, lines.nodes, lines.node_count * sizeof *lines.nodes));
        CHECK(!memcmp(again.segments, lines.segments, lines.segment_count * sizeof *lines.segments));
        free(field);
        meso_triangulation_release(&mesh);
    }
    CHECK(worst[1] < 0.002 && worst[1] < 0.3 * worst[0]);
}

/* Random whole numbers, so that vertices, plateaus and saddles on the level abound: lines are closed all the same. */
static void test_plateaus_everywhere(void)
{
    float field[12 * 10], levels[3] = {1, 1.5f, 2};
    uint64_t random = 1;
    MesoTriangulation mesh = meso_fixture_torus(12, 10, 0.4f);
    for (uint32_t round = 0; round < 500; round++) {
        uint32_t open, unused;
        for (uint32_t v = 0; v < 120; v++) {
            random = random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            field[v] = random >> 62 == 3 && round % 2 ? INFINITY : (float)(random >> 62);
        }
        MesoCutLines lines = trace(&mesh, NULL, field, levels, 3);
        count_ends(&lines, &open, &unused);
        CHECK(open == 0 && unused == 0);
    }
    meso_triangulation_release(&mesh);
}

/* Cut along them, a sphere falls into one more band than there are levels, of the areas between circles. */
static void test_cut(void)
{
    enum { LEVELS = 30, ROOM = 200000 };
    float levels[LEVELS];
    double area[LEVELS + 1] = {0};
    MesoTriangulation mesh = meso_fixture_sphere(50, 0.3f, 1);
    float *field = MESO_NEW(&arena, float, mesh.vertex_count, NULL);
    uint32_t *region = MESO_NEW(&arena, uint32_t, ROOM, NULL);
    const MesoVec3 pole = {0.48f, 0.6f, 0.64f};
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        field[v] = acosf(meso_vec3_dot(mesh.positions[v], pole));
    for (uint32_t l = 0; l < LEVELS; l++)
        levels[l] = 0.1f * (float)(l + 1);
    MesoCutLines lines = trace(&mesh, NULL, field, levels, LEVELS);
    CHECK(meso_fixture_cut(&mesh, &lines, region, ROOM) == LEVELS + 1);
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        area[region[t]] += meso_fixture_area(&mesh, t);
    for (uint32_t l = 0; l <= LEVELS; l++) {    /* regions are numbered in any order: by the nearest area */
        double expected = 2 * MESO_PI * (cos(0.1 * l) - (l < LEVELS ? cos(0.1 * (l + 1)) : -1)), off = 1;
        for (uint32_t r = 0; r <= LEVELS; r++)
            off = fmin(off, fabs(area[r] / expected - 1));
        CHECK(off < (l == 0 || l == LEVELS ? 0.02 : 0.001));    /* the caps have few triangles */
    }
    meso_triangulation_release(&mesh);
}

int main(void)
{
    meso_arena_init(&arena);
    test_triangle();
    test_extremes();
    test_along_edges();
    test_plateaus();
    test_saddle();
    test_without_value();
    test_domain();
    test_sphere();
    test_plateaus_everywhere();
    test_cut();
    meso_arena_release(&arena);
    return 0;
}
