/* Rate of the cut: contours on a torus of a million triangles, at once and one by one; many lines in one triangle. */
#include <stdio.h>
#include <time.h>

#include "libcore/base/random.h"
#include "libcore/mesh/cut/mesh_cut.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

enum { COLUMNS = 1000, ROWS = 500, LEVELS = 100, ROUNDS = 3 };

static const float TUBE = 0.4f;

static float level_value(uint32_t level)
{
    return TUBE * (2 * ((float)level + 0.5f) / LEVELS - 1);
}

/* The height, a little off, so that contours are as crooked as the mesh allows. */
static void set_heights(MesoTriangulation *mesh)
{
    MesoRandom random;
    free(mesh->vertex_values);
    mesh->vertex_width = 1;
    mesh->vertex_values = malloc(mesh->vertex_room * sizeof *mesh->vertex_values);
    CHECK(mesh->vertex_values);
    meso_random_init(&random, 1, 0);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        mesh->vertex_values[v] = mesh->positions[v].z + 1e-6f * (float)meso_random_below(&random, 1000);
}

static bool between(float value, float a, float b)
{
    return (a < value) != (b < value);
}

static uint32_t node_on(MesoCutLines *lines, MesoArena *arena, const MesoTriangulation *mesh, uint32_t half_edge,
                        float value)
{
    uint32_t node, h = mesh->twins[half_edge] < half_edge ? mesh->twins[half_edge] : half_edge;
    float a = mesh->vertex_values[mesh->corners[h]], b = mesh->vertex_values[mesh->corners[meso_next_corner(h)]];
    MesoCutNode added = {MESO_ON_EDGE, h, {(value - a) / (b - a), 0}};
    CHECK(meso_cut_add_node(lines, arena, added, &node, NULL) == MESO_OK);
    return node;
}

/* Contours of the levels [first, end), triangle by triangle. */
static void make_contours(MesoCutLines *lines, MesoArena *arena, const MesoTriangulation *mesh, uint32_t first,
                          uint32_t end)
{
    const float *values = mesh->vertex_values;
    *lines = (MesoCutLines){0};
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (uint32_t level = first; level < end; level++) {
            MesoCutSegment segment = {{0, 0}, t, level};
            uint32_t count = 0;
            float value = level_value(level);
            for (uint32_t h = 3 * t; h < 3 * t + 3; h++)
                if (between(value, values[mesh->corners[h]], values[mesh->corners[meso_next_corner(h)]]))
                    segment.node[count++] = node_on(lines, arena, mesh, h, value);
            if (count == 2)
                CHECK(meso_cut_add_segment(lines, arena, segment, NULL) == MESO_OK);
        }
}

/* Processor time: a single thread, on machines that have more to do. */
static double seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* The time of all cuts, with so many contours each. */
static double time_cuts(uint32_t levels_each)
{
    MesoError error;
    MesoTriangulation mesh = meso_fixture_torus(COLUMNS, ROWS, TUBE);
    uint32_t before = mesh.triangle_count, segment_count = 0;
    double took = 0;
    set_heights(&mesh);
    for (uint32_t level = 0; level < LEVELS; level += levels_each) {
        MesoArena arena;
        MesoCutLines lines;
        MesoCutReport report;
        meso_arena_init(&arena);
        make_contours(&lines, &arena, &mesh, level, level + levels_each);
        segment_count += lines.segment_count;
        double start = seconds();
        CHECK(meso_mesh_cut(&mesh, &lines, &report, &arena, &error) == MESO_OK);
        meso_arena_release(&arena);
        took += seconds() - start;
    }
    printf("cut, torus of 1 M triangles, %d contours, %u at once: %.3f s, %u segments, %u triangles more\n", LEVELS,
           levels_each, took, segment_count, mesh.triangle_count - before);
    CHECK(meso_triangulation_check(&mesh, &error) == MESO_OK);
    meso_triangulation_release(&mesh);
    return took;
}

static uint32_t random_node_on(MesoCutLines *lines, MesoArena *arena, MesoRandom *random, uint32_t half_edge)
{
    uint32_t node;
    MesoCutNode added = {MESO_ON_EDGE, half_edge, {(float)meso_random_below(random, 1000000) * 1e-6f, 0}};
    CHECK(meso_cut_add_node(lines, arena, added, &node, NULL) == MESO_OK);
    return node;
}

/* Lines from side to side of one triangle, each of which crosses a third of the others. */
static void time_one_triangle(uint32_t line_count)
{
    MesoArena arena;
    MesoRandom random;
    MesoError error;
    MesoCutReport report;
    MesoCutLines lines = {0};
    MesoTriangulation mesh = meso_fixture_sheet(1, 1, 1);
    meso_arena_init(&arena);
    meso_random_init(&random, 1, 0);
    for (uint32_t l = 0; l < line_count; l++) {
        uint32_t side = meso_random_below(&random, 3);
        MesoCutSegment segment = {{0, 0}, 0, l};
        segment.node[0] = random_node_on(&lines, &arena, &random, side);
        segment.node[1] = random_node_on(&lines, &arena, &random, (side + 1) % 3);
        CHECK(meso_cut_add_segment(&lines, &arena, segment, NULL) == MESO_OK);
    }
    double start = seconds();
    CHECK(meso_mesh_cut(&mesh, &lines, &report, &arena, &error) == MESO_OK);
    printf("cut, one triangle, %u lines across it: %.3f s, %u triangles\n", line_count, seconds() - start,
           mesh.triangle_count);
    CHECK(meso_triangulation_check(&mesh, &error) == MESO_OK);
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    for (uint32_t round = 0; round < ROUNDS; round++)
        time_cuts(LEVELS);
    time_cuts(1);
    for (uint32_t line_count = 500; line_count <= 8000; line_count *= 4)
        time_one_triangle(line_count);
    return 0;
}
