#include "libcore/mesh/cut/border_loops.h"
#include "libcore/mesh/cut/chain_samples.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

enum { MOST = 100 };

static MesoVec3 place(const MesoTriangulation *mesh, const MesoMeshPoint *point)
{
    MesoVec3 sum = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        sum = meso_vec3_mad(sum, point->weight[k], mesh->positions[mesh->corners[3 * point->triangle + k]]);
    return sum;
}

/* Along the outline of a square of side 4: place by place. */
static void test_closed(void)
{
    MesoArena arena;
    MesoBorderLoops loops;
    MesoMeshPoint points[MOST];
    MesoTriangulation mesh = meso_fixture_sheet(4, 4, 1);
    meso_arena_init(&arena);
    CHECK(meso_border_loops_find(&loops, &arena, &mesh, NULL, false, NULL) == MESO_OK);
    MesoEdgeChain chain = {loops.side_count, true, loops.half_edges, loops.vertices};
    CHECK(meso_chain_length(&mesh, &chain) == 16);
    meso_chain_sample(&mesh, &chain, 8, 0, false, points);
    const float expected[8][2] = {{0, 0}, {2, 0}, {4, 0}, {4, 2}, {4, 4}, {2, 4}, {0, 4}, {0, 2}};
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec3 p = place(&mesh, &points[i]);
        CHECK(p.x == expected[i][0] && p.y == expected[i][1]);
    }
    meso_chain_sample(&mesh, &chain, 64, 0.5, false, points);
    for (uint32_t i = 0; i < 64; i++) {
        MesoVec3 p = place(&mesh, &points[i]), q = place(&mesh, &points[(i + 1) % 64]);
        CHECK(fabsf(fabsf(p.x - q.x) + fabsf(p.y - q.y) - 0.25f) < 1e-6f);
        CHECK(points[i].weight[0] + points[i].weight[1] + points[i].weight[2] == 1);
    }
    meso_arena_release(&arena);
    meso_triangulation_release(&mesh);
}

/* An open chain with both of its ends, and walked against its half-edge. */
static void test_open(void)
{
    const uint32_t half_edges[2] = {0, 6}, forth[2] = {0, 1}, backward[1] = {1};
    MesoMeshPoint points[5];
    MesoTriangulation mesh = meso_fixture_sheet(2, 1, 1);
    MesoEdgeChain chain = {2, false, half_edges, forth}, back = {1, false, half_edges, backward};
    meso_chain_sample(&mesh, &chain, 5, 0, true, points);
    for (uint32_t i = 0; i < 5; i++)
        CHECK(place(&mesh, &points[i]).x == 0.5f * (float)i && place(&mesh, &points[i]).y == 0);
    meso_chain_sample(&mesh, &back, 4, 0.5, false, points);
    for (uint32_t i = 0; i < 4; i++)
        CHECK(place(&mesh, &points[i]).x == 0.875f - 0.25f * (float)i);
    meso_triangulation_release(&mesh);
}

static void test_count(void)
{
    CHECK(meso_chain_sample_count(10, 3, 1) == 3 && meso_chain_sample_count(10, 4, 1) == 3);
    CHECK(meso_chain_sample_count(10, 100, 1) == 1 && meso_chain_sample_count(0, 1, 2) == 2);
    CHECK(meso_chain_sample_count(1e30, 1, 1) == UINT32_MAX / 2);
}

int main(void)
{
    test_closed();
    test_open();
    test_count();
    return 0;
}
