#include "libcore/mesh/cut/mesh_cut_fixture.h"

/* A mesh, lines on it, and what the cut reports. */
typedef struct Case {
    MesoArena arena;
    MesoTriangulation mesh;
    MesoCutLines lines;
    MesoCutReport report;
} Case;

static void begin(Case *c, MesoTriangulation mesh)
{
    *c = (Case){.mesh = mesh};
    meso_arena_init(&c->arena);
}

static void cut(Case *c)
{
    meso_fixture_cut(&c->mesh, &c->lines, &c->report, &c->arena);
    c->lines = (MesoCutLines){0};
}

static void end(Case *c)
{
    meso_triangulation_release(&c->mesh);
    meso_arena_release(&c->arena);
}

static uint32_t put(Case *c, MesoNodeKind kind, uint32_t element, float x, float y)
{
    uint32_t node;
    CHECK(meso_cut_add_node(&c->lines, &c->arena, (MesoCutNode){kind, element, {x, y}}, &node, NULL) == MESO_OK);
    return node;
}

static void join(Case *c, uint32_t a, uint32_t b, uint32_t triangle)
{
    CHECK(meso_cut_add_segment(&c->lines, &c->arena, (MesoCutSegment){{a, b}, triangle, 0}, NULL) == MESO_OK);
}

/* Half-edges between two vertices that are walls: 2 inside, 1 at a border, 0. */
static uint32_t walls_between(const MesoTriangulation *mesh, uint32_t a, uint32_t b)
{
    uint32_t count = 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        uint32_t p = mesh->corners[h], q = mesh->corners[meso_next_corner(h)];
        if (meso_side_is_wall(mesh, h) && ((p == a && q == b) || (p == b && q == a)))
            count++;
    }
    return count;
}

static uint32_t wall_count(const MesoTriangulation *mesh)
{
    uint32_t count = 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        count += meso_side_is_wall(mesh, h);
    return count;
}

static MesoTriangulation one_triangle(MesoVec3 a, MesoVec3 b, MesoVec3 c)
{
    const MesoVec3 positions[3] = {a, b, c};
    const uint32_t corners[3] = {0, 1, 2};
    return meso_fixture_triangulation(positions, 3, corners, 1);
}

static MesoTriangulation right_triangle(void)
{
    return one_triangle((MesoVec3){0, 0, 0}, (MesoVec3){1, 0, 0}, (MesoVec3){0, 1, 0});
}

/*
 *  2--n--3      a line through both triangles of a square, (0, 1, 3) and (0, 3, 2)
 *  |  | /|
 *  |  c  |
 *  | /|  |
 *  0--m--1
 */
static void test_square(void)
{
    Case c;
    begin(&c, meso_fixture_sheet(1, 1, 1));
    uint32_t m = put(&c, MESO_ON_EDGE, 0, 0.5f, 0), middle = put(&c, MESO_ON_EDGE, 3, 0.5f, 0);
    uint32_t n = put(&c, MESO_ON_EDGE, 4, 0.5f, 0);
    join(&c, m, middle, 0);
    join(&c, middle, n, 1);
    cut(&c);
    CHECK(c.mesh.vertex_count == 7 && c.mesh.triangle_count == 6 && c.report.part_count == 6);
    CHECK(c.report.node_vertex[m] == 4 && c.report.node_vertex[middle] == 5 && c.report.node_vertex[n] == 6);
    CHECK(c.mesh.positions[5].x == 0.5f && c.mesh.positions[5].y == 0.5f);
    CHECK(walls_between(&c.mesh, 4, 5) == 2 && walls_between(&c.mesh, 5, 6) == 2);
    CHECK(wall_count(&c.mesh) == 6 + 4);
    end(&c);
}

/*
 *  2            strips: two points a side, two lines from side to side
 *  | \
 *  d--b         (diagonals are not drawn)
 *  c---a
 *  0-----1
 */
static void test_strips(void)
{
    Case c;
    begin(&c, right_triangle());
    uint32_t a = put(&c, MESO_ON_EDGE, 1, 0.25f, 0), b = put(&c, MESO_ON_EDGE, 1, 0.5f, 0);
    uint32_t d = put(&c, MESO_ON_EDGE, 2, 0.5f, 0), e = put(&c, MESO_ON_EDGE, 2, 0.75f, 0);
    join(&c, b, d, 0);
    join(&c, e, a, 0);
    cut(&c);
    CHECK(c.mesh.vertex_count == 7 && c.mesh.triangle_count == 5 && wall_count(&c.mesh) == 7 + 4);
    end(&c);
}

/* A triangle inside the triangle: six parts around one. */
static void test_loop(void)
{
    Case c;
    begin(&c, right_triangle());
    uint32_t n[3] = {put(&c, MESO_IN_TRIANGLE, 0, 0.2f, 0.2f), put(&c, MESO_IN_TRIANGLE, 0, 0.5f, 0.2f),
                     put(&c, MESO_IN_TRIANGLE, 0, 0.2f, 0.5f)};
    for (uint32_t k = 0; k < 3; k++)
        join(&c, n[k], n[(k + 1) % 3], 0);
    cut(&c);
    CHECK(c.mesh.vertex_count == 6 && c.mesh.triangle_count == 7 && wall_count(&c.mesh) == 3 + 6);
    end(&c);
}

/*
 *  2
 *  | \          two lines that cross, and a third through the same point, almost
 *  a   b
 *  |  x  \
 *  0--c---1
 */
static void test_crossing(void)
{
    Case c;
    begin(&c, right_triangle());
    uint32_t a = put(&c, MESO_ON_EDGE, 2, 0.5f, 0), b = put(&c, MESO_ON_EDGE, 1, 0.5f, 0);
    uint32_t corner = put(&c, MESO_AT_VERTEX, 1, 0, 0), m = put(&c, MESO_ON_EDGE, 0, 0.334f, 0);
    uint32_t origin = put(&c, MESO_AT_VERTEX, 0, 0, 0), top = put(&c, MESO_AT_VERTEX, 2, 0, 0);
    join(&c, a, corner, 0);
    join(&c, origin, b, 0);
    join(&c, top, m, 0);
    cut(&c);
    /* the line from the top to m passes (1/3, 1/3) far off; it crosses both others elsewhere */
    CHECK(c.mesh.vertex_count == 3 + 3 + 3);
    CHECK(fabsf(c.mesh.positions[6].x - 1.0f / 3) < 1e-6f && fabsf(c.mesh.positions[6].y - 1.0f / 3) < 1e-6f);
    end(&c);

    begin(&c, right_triangle());
    a = put(&c, MESO_ON_EDGE, 2, 0.5f, 0), b = put(&c, MESO_ON_EDGE, 1, 0.5f, 0), m = put(&c, MESO_ON_EDGE, 0, 0.5f, 0);
    join(&c, a, put(&c, MESO_AT_VERTEX, 1, 0, 0), 0);
    join(&c, b, put(&c, MESO_AT_VERTEX, 0, 0, 0), 0);
    join(&c, m, put(&c, MESO_AT_VERTEX, 2, 0, 0), 0);
    cut(&c);
    CHECK(c.mesh.vertex_count == 7 && c.mesh.triangle_count == 6 && wall_count(&c.mesh) == 6 + 12);
    end(&c);
}

/* What is near becomes one, and what has become one is not joined. */
static void test_snapping(void)
{
    Case c;
    begin(&c, meso_fixture_sheet(1, 1, 1));
    uint32_t near_vertex = put(&c, MESO_ON_EDGE, 0, 0.001f, 0);
    uint32_t near_corner = put(&c, MESO_IN_TRIANGLE, 0, 0.002f, 0.001f);
    uint32_t low = put(&c, MESO_ON_EDGE, 3, 0.5f, 0), high = put(&c, MESO_ON_EDGE, 2, 0.497f, 0);   /* 0.503 of 3 */
    uint32_t near_side = put(&c, MESO_IN_TRIANGLE, 0, 0.001f, 0.499f);
    uint32_t inside = put(&c, MESO_IN_TRIANGLE, 0, 0.4f, 0.2f);
    uint32_t near_inside = put(&c, MESO_IN_TRIANGLE, 0, 0.401f, 0.201f);
    join(&c, near_vertex, near_corner, 0);
    join(&c, low, high, 0);
    join(&c, near_side, low, 1);
    join(&c, inside, near_inside, 0);
    cut(&c);
    const uint32_t *vertex = c.report.node_vertex;
    CHECK(vertex[near_vertex] == 0 && vertex[near_corner] == 0);
    CHECK(vertex[low] == 4 && vertex[high] == 4 && vertex[near_side] == 4);
    CHECK(vertex[inside] == 5 && vertex[near_inside] == 5);
    CHECK(c.mesh.vertex_count == 6 && wall_count(&c.mesh) == 4);
    end(&c);
}

/*
 *  2-----3      along the diagonal, all of it: no part is new, both are reported; then pieces of it that overlap
 *  |   / |
 *  0-----1
 */
static void test_along_side(void)
{
    Case c;
    begin(&c, meso_fixture_sheet(1, 1, 1));
    join(&c, put(&c, MESO_AT_VERTEX, 3, 0, 0), put(&c, MESO_AT_VERTEX, 0, 0, 0), 0);
    cut(&c);
    CHECK(c.mesh.triangle_count == 2 && c.report.part_count == 2 && walls_between(&c.mesh, 0, 3) == 2);
    end(&c);

    begin(&c, meso_fixture_sheet(1, 1, 1));
    uint32_t at[4];
    for (uint32_t i = 0; i < 4; i++)
        at[i] = put(&c, MESO_ON_EDGE, 3, 0.2f * (float)(i + 1), 0);
    join(&c, at[0], at[2], 0);
    join(&c, at[3], at[1], 1);
    cut(&c);
    CHECK(c.mesh.triangle_count == 10 && wall_count(&c.mesh) == 4 + 6);
    for (uint32_t i = 0; i < 3; i++)
        CHECK(walls_between(&c.mesh, 4 + i, 5 + i) == 2);
    CHECK(walls_between(&c.mesh, 0, 4) == 0 && walls_between(&c.mesh, 7, 3) == 0);
    end(&c);
}

/* The same place of every edge of a Moebius band, where both half-edges run the same way, by either: one vertex. */
static void test_reversed(void)
{
    Case c;
    begin(&c, meso_fixture_moebius(7));
    uint32_t count = 0;
    for (uint32_t h = 0; h < 21; h++) {
        uint32_t twin = c.mesh.twins[h];
        if (twin == MESO_NO_INDEX)
            continue;
        CHECK(c.mesh.corners[h] == c.mesh.corners[twin]);
        put(&c, MESO_ON_EDGE, h, 0.25f, 0);
        put(&c, MESO_ON_EDGE, twin, 0.25f, 0);
        count++;
    }
    MesoCutLines lines = c.lines;
    cut(&c);
    CHECK(c.mesh.vertex_count == 7 + 7 && count == 14);
    for (uint32_t n = 0; n < lines.node_count; n += 2)
        CHECK(c.report.node_vertex[n] == c.report.node_vertex[n + 1]);
    end(&c);
}

/* A triangle without area, with lines across it and a loop in it, is split like any other. */
static void test_flat(void)
{
    Case c;
    begin(&c, one_triangle((MesoVec3){0, 0, 0}, (MesoVec3){2, 0, 0}, (MesoVec3){1, 0, 0}));
    uint32_t n[3] = {put(&c, MESO_IN_TRIANGLE, 0, 0.2f, 0.2f), put(&c, MESO_IN_TRIANGLE, 0, 0.5f, 0.2f),
                     put(&c, MESO_IN_TRIANGLE, 0, 0.2f, 0.5f)};
    for (uint32_t k = 0; k < 3; k++)
        join(&c, n[k], n[(k + 1) % 3], 0);
    join(&c, put(&c, MESO_ON_EDGE, 0, 0.5f, 0), put(&c, MESO_ON_EDGE, 1, 0.9f, 0), 0);
    cut(&c);
    CHECK(c.mesh.vertex_count == 3 + 5 + 2);    /* the line crosses the loop twice */
    end(&c);
}

/* An edge that coordinates have no room on is not cut: nodes go to its ends. */
static void test_short_edge(void)
{
    Case c;
    begin(&c, one_triangle((MesoVec3){1, 0, 0}, (MesoVec3){1.000001f, 0, 0}, (MesoVec3){1, 1, 0}));
    uint32_t a = put(&c, MESO_ON_EDGE, 0, 0.25f, 0), b = put(&c, MESO_ON_EDGE, 0, 0.75f, 0);
    uint32_t d = put(&c, MESO_ON_EDGE, 1, 0.5f, 0);
    join(&c, a, d, 0);
    join(&c, b, d, 0);
    cut(&c);
    CHECK(c.report.node_vertex[a] == 0 && c.report.node_vertex[b] == 1 && c.mesh.triangle_count == 2);
    end(&c);
}

/* Nodes and segments that are not where they say: the mesh stays as it was. */
static void test_failures(void)
{
    MesoError error;
    for (uint32_t kind = 0; kind < 5; kind++) {
        Case c;
        begin(&c, meso_fixture_sheet(2, 2, 1));
        uint32_t a = put(&c, MESO_ON_EDGE, 0, 0.5f, 0), b = put(&c, MESO_ON_EDGE, 1, 0.5f, 0);
        join(&c, a, b, 0);
        switch (kind) {
        case 0: put(&c, MESO_ON_EDGE, 24, 0.5f, 0); break;
        case 1: put(&c, MESO_ON_EDGE, 1, NAN, 0); break;
        case 2: put(&c, MESO_IN_TRIANGLE, 0, 0.5f, NAN); break;
        case 3: join(&c, a, b, 5); break;
        default: join(&c, a, put(&c, MESO_AT_VERTEX, 8, 0, 0), 0); break;
        }
        MesoTriangulation before = meso_fixture_copy_mesh(&c.mesh);
        CHECK(meso_mesh_cut(&c.mesh, &c.lines, &c.report, &c.arena, &error) == MESO_ERR_INTERNAL);
        CHECK(c.mesh.vertex_count == before.vertex_count && c.mesh.triangle_count == before.triangle_count);
        CHECK(memcmp(c.mesh.corners, before.corners, 24 * sizeof *before.corners) == 0);
        CHECK(memcmp(c.mesh.twins, before.twins, 24 * sizeof *before.twins) == 0);
        CHECK(memcmp(c.mesh.walls, before.walls, 8) == 0);
        meso_triangulation_release(&before);
        end(&c);
    }
}

static void test_nothing(void)
{
    Case c;
    begin(&c, meso_fixture_sheet(1, 1, 1));
    cut(&c);
    CHECK(c.mesh.triangle_count == 2 && c.report.part_count == 0);
    end(&c);
}

/* A regular polygon inside a triangle, by its weights. */
static void add_ring(Case *c, uint32_t triangle, float x, float y, float radius, uint32_t sides)
{
    uint32_t first = c->lines.node_count;
    for (uint32_t i = 0; i < sides; i++) {
        float angle = 6.2831853f * (float)i / (float)sides;
        put(c, MESO_IN_TRIANGLE, triangle, x + radius * cosf(angle), y + radius * sinf(angle));
    }
    for (uint32_t i = 0; i < sides; i++)
        join(c, first + i, first + (i + 1) % sides, triangle);
}

/* Many rings in one triangle: lines are told apart, and the time is not the square of their number. */
static void test_dots(void)
{
    enum { SIDE = 24, SIDES = 8 };
    Case c;
    uint32_t rings = 0;
    begin(&c, right_triangle());
    for (uint32_t row = 0; row < SIDE; row++)
        for (uint32_t column = 0; row + column < SIDE; column++, rings++)
            add_ring(&c, 0, (0.7f + (float)column) / (SIDE + 1), (0.7f + (float)row) / (SIDE + 1), 0.012f, SIDES);
    MesoCutLines lines = c.lines;
    CHECK(meso_mesh_cut(&c.mesh, &lines, &c.report, &c.arena, NULL) == MESO_OK);
    CHECK(meso_triangulation_check(&c.mesh, NULL) == MESO_OK);
    CHECK(c.mesh.vertex_count == 3 + rings * SIDES && wall_count(&c.mesh) == 3 + 2 * rings * SIDES);
    end(&c);
}

/* Values to be carried along, and labels, which walls part. */
static void set_values(MesoTriangulation *mesh, MesoChoices *choices)
{
    free(mesh->vertex_values);
    free(mesh->corner_values);
    mesh->vertex_width = 2;
    mesh->corner_width = 3;
    mesh->vertex_values = malloc(2 * mesh->vertex_room * sizeof *mesh->vertex_values);
    mesh->corner_values = malloc(9 * mesh->triangle_room * sizeof *mesh->corner_values);
    CHECK(mesh->vertex_values && mesh->corner_values);
    for (uint32_t i = 0; i < 2 * mesh->vertex_count; i++)
        mesh->vertex_values[i] = (float)meso_choose(choices, 100) / 100;
    for (uint32_t i = 0; i < 9 * mesh->triangle_count; i++)
        mesh->corner_values[i] = (float)meso_choose(choices, 100) / 100;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        mesh->labels[t] = meso_choose(choices, 3) == 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->twins[h] != MESO_NO_INDEX && mesh->labels[h / 3] != mesh->labels[mesh->twins[h] / 3])
            mesh->walls[h / 3] |= (uint8_t)(1u << h % 3);
}

static MesoTriangulation random_mesh(MesoChoices *choices)
{
    switch (meso_choose(choices, 6)) {
    case 0: return meso_fixture_sheet(3, 3, 1);
    case 1: return meso_fixture_torus(4, 3, 0.4f);
    case 2: return meso_fixture_moebius(7);
    case 3: return meso_fixture_octahedron();
    case 4: return meso_fixture_pillow();
    default: return meso_fixture_crumpled(choices, 3);
    }
}

static void test_random(void)
{
    enum { SEEDS = 2000, ROUNDS = 3 };
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        Case c;
        MesoChoices choices = {0};
        meso_random_init(&choices.random, seed, 0);
        begin(&c, random_mesh(&choices));
        set_values(&c.mesh, &choices);
        for (uint32_t round = 0; round < ROUNDS; round++) {
            meso_choose_lines(&c.lines, &c.arena, &choices, &c.mesh, 1 + meso_choose(&choices, 12));
            cut(&c);
        }
        end(&c);
    }
}

/* The cotangent of the angle that faces a half-edge. */
static double facing_cotangent(const MesoTriangulation *mesh, uint32_t h)
{
    MesoVec3 apex = mesh->positions[mesh->corners[meso_previous_corner(h)]];
    MesoVec3 a = meso_vec3_sub(mesh->positions[mesh->corners[h]], apex);
    MesoVec3 b = meso_vec3_sub(mesh->positions[mesh->corners[meso_next_corner(h)]], apex);
    return (double)meso_vec3_dot(a, b) / (double)meso_vec3_length(meso_vec3_cross(a, b));
}

/* No edge inside a triangle that is no line faces more than half a turn: turning it would make the angles worse. */
static void test_angles(void)
{
    for (uint32_t seed = 0; seed < 200; seed++) {
        Case c;
        MesoChoices choices = {0};
        meso_random_init(&choices.random, seed, 2);
        begin(&c, meso_fixture_torus(4, 3, 0.4f));
        meso_choose_lines(&c.lines, &c.arena, &choices, &c.mesh, 10);
        cut(&c);
        uint32_t *parent = malloc(c.mesh.triangle_count * sizeof *parent);
        CHECK(parent);
        memset(parent, 0xff, c.mesh.triangle_count * sizeof *parent);
        for (uint32_t i = 0; i < c.report.part_count; i++)
            parent[c.report.parts[i].triangle] = c.report.parts[i].parent;
        for (uint32_t h = 0; h < 3 * c.mesh.triangle_count; h++) {
            uint32_t twin = c.mesh.twins[h];
            if (parent[h / 3] == parent[twin / 3] && parent[h / 3] != MESO_NO_INDEX && !meso_side_is_wall(&c.mesh, h))
                CHECK(facing_cotangent(&c.mesh, h) + facing_cotangent(&c.mesh, twin) > -0.01);
        }
        free(parent);
        end(&c);
    }
}

static double total_area(const MesoTriangulation *mesh)
{
    double total = 0, area[3];
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        meso_fixture_area(mesh, t, area);
        total += sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
    }
    return total;
}

/* The crossings of a plane a x + b y = c with the triangles of a sheet, as lines. */
static void add_plane(Case *c, float a, float b, float offset)
{
    for (uint32_t t = 0; t < c->mesh.triangle_count; t++) {
        uint32_t node[3], count = 0;
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            MesoVec3 p = c->mesh.positions[c->mesh.corners[h]];
            MesoVec3 q = c->mesh.positions[c->mesh.corners[meso_next_corner(h)]];
            float at_p = a * p.x + b * p.y - offset, at_q = a * q.x + b * q.y - offset;
            if ((at_p < 0) != (at_q < 0))
                node[count++] = put(c, MESO_ON_EDGE, h, at_p / (at_p - at_q), 0);
        }
        if (count == 2)
            join(c, node[0], node[1], t);
    }
}

/* Twenty cuts upon each other, down to what coordinates can tell apart: the sheet keeps its area and border. */
static void test_deep(void)
{
    enum { LEVELS = 20, LINES = 6 };
    for (uint32_t seed = 0; seed < 4; seed++) {
        Case c;
        MesoChoices choices = {0};
        meso_random_init(&choices.random, seed, 1);
        begin(&c, meso_fixture_sheet(2, 2, 0.5f));
        double border = meso_fixture_border_length(&c.mesh);
        for (uint32_t level = 0; level < LEVELS; level++) {
            for (uint32_t i = 0; i < LINES; i++) {
                float angle = 6.2831853f * (float)meso_choose(&choices, 1000) / 1000;
                float x = (float)meso_choose(&choices, 1000) / 1000, y = (float)meso_choose(&choices, 1000) / 1000;
                add_plane(&c, cosf(angle), sinf(angle), cosf(angle) * x + sinf(angle) * y);
            }
            cut(&c);
        }
        CHECK(fabs(total_area(&c.mesh) - 2) < 1e-5);
        CHECK(fabs(meso_fixture_border_length(&c.mesh) - border) < 1e-4);
        end(&c);
    }
}

int main(void)
{
    test_square();
    test_strips();
    test_loop();
    test_crossing();
    test_snapping();
    test_along_side();
    test_reversed();
    test_flat();
    test_short_edge();
    test_failures();
    test_nothing();
    test_dots();
    test_random();
    test_angles();
    test_deep();
    return 0;
}
