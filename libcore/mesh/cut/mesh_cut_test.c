#include "libcore/mesh/cut/mesh_cut_fixture.h"

static uint32_t put(MesoCutLines *lines, MesoArena *arena, MesoNodeKind kind, uint32_t element, float x, float y)
{
    uint32_t node;
    CHECK(meso_cut_add_node(lines, arena, (MesoCutNode){kind, element, {x, y}}, &node, NULL) == MESO_OK);
    return node;
}

static void join(MesoCutLines *lines, MesoArena *arena, uint32_t a, uint32_t b, uint32_t triangle)
{
    CHECK(meso_cut_add_segment(lines, arena, (MesoCutSegment){{a, b}, triangle, 0}, NULL) == MESO_OK);
}

/*
 *  2--n--3      one segment through both triangles of a square, across the diagonal 0-3
 *  |  | /|
 *  |  c  |
 *  | /|  |
 *  0--m--1
 */
static void test_square(void)
{
    MesoArena arena;
    MesoCutLines lines = {0};
    MesoCutReport report;
    MesoTriangulation mesh = meso_fixture_sheet(1, 1, 1);   /* (0, 1, 3), (0, 3, 2) */
    meso_arena_init(&arena);
    uint32_t m = put(&lines, &arena, MESO_ON_EDGE, 0, 0.5f, 0), c = put(&lines, &arena, MESO_ON_EDGE, 3, 0.5f, 0);
    uint32_t n = put(&lines, &arena, MESO_ON_EDGE, 4, 0.5f, 0);
    join(&lines, &arena, m, c, 0);
    join(&lines, &arena, c, n, 1);
    meso_fixture_cut(&mesh, &lines, &report, &arena);
    CHECK(mesh.vertex_count == 7 && mesh.triangle_count == 6 && report.part_count == 6);
    CHECK(report.node_vertex[m] == 4 && report.node_vertex[c] == 5 && report.node_vertex[n] == 6);
    CHECK(mesh.positions[5].x == 0.5f && mesh.positions[5].y == 0.5f);
    meso_triangulation_release(&mesh);
    meso_arena_release(&arena);
}

static void test_random(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    for (uint32_t seed = 0; seed < 3000; seed++) {
        MesoChoices choices = {0};
        MesoCutLines lines;
        MesoCutReport report;
        meso_random_init(&choices.random, seed, 0);
        MesoTriangulation mesh = seed % 4 == 0   ? meso_fixture_sheet(3, 3, 1)
                                 : seed % 4 == 1 ? meso_fixture_torus(4, 3, 0.4f)
                                 : seed % 4 == 2 ? meso_fixture_moebius(7)
                                                 : meso_fixture_crumpled(&choices, 3);
        for (uint32_t round = 0; round < 3; round++) {
            MesoArenaMark mark = meso_arena_mark(&arena);
            meso_choose_lines(&lines, &arena, &choices, &mesh, 1 + meso_choose(&choices, 12));
            meso_fixture_cut(&mesh, &lines, &report, &arena);
            meso_arena_rewind(&arena, mark);
        }
        meso_triangulation_release(&mesh);
    }
    meso_arena_release(&arena);
}

int main(void)
{
    test_square();
    test_random();
    return 0;
}
