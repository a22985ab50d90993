#include "libcore/mesh/boundary.h"

#include "libcore/base/check.h"

typedef struct Case {
    MesoArena arena;
    MesoSlotGraph graph;
    MesoBoundary boundary;
} Case;

static void trace(Case *c, uint32_t vertex_count, uint32_t face_count, const uint32_t *faces)
{
    MesoQuadMesh mesh;
    MesoVec3 positions[32];
    CHECK(vertex_count <= 32);
    for (uint32_t i = 0; i < vertex_count; i++)
        positions[i] = (MesoVec3){(float)i, (float)(i * i), (float)(i % 3)};
    meso_arena_init(&c->arena);
    CHECK(meso_quad_mesh_build(&mesh, &c->arena, vertex_count, positions, 0, NULL, face_count, faces, NULL,
                               NULL) == MESO_OK);
    CHECK(meso_slot_graph_build(&c->graph, &c->arena, &mesh, NULL) == MESO_OK);
    CHECK(meso_boundary_build(&c->boundary, &c->arena, &mesh, &c->graph, NULL) == MESO_OK);
}

static void end(Case *c)
{
    uint32_t total = c->boundary.loop_count ? c->boundary.loop_begin[c->boundary.loop_count] : 0;
    CHECK(total == c->graph.border_count);
    for (uint32_t i = 0; i < total; i++)
        CHECK(c->graph.twin[c->boundary.half_edges[i]] == MESO_NO_INDEX);
    meso_arena_release(&c->arena);
}

static uint32_t length(const Case *c, uint32_t loop)
{
    return c->boundary.loop_begin[loop + 1] - c->boundary.loop_begin[loop];
}

/*
 *     3---4---5
 *     | 0 | 1 |
 *     0---1---2
 */
static void test_strip(void)
{
    static const uint32_t faces[8] = {0, 1, 4, 3, 1, 2, 5, 4}, turned[8] = {0, 1, 4, 3, 4, 5, 2, 1};
    static const uint32_t expected[6] = {0, 4, 5, 6, 2, 3}, expected_turned[6] = {0, 6, 5, 4, 2, 3};
    Case c;
    trace(&c, 6, 2, faces);
    CHECK(c.boundary.loop_count == 1 && length(&c, 0) == 6);
    for (uint32_t i = 0; i < 6; i++)
        CHECK(c.boundary.half_edges[i] == expected[i]);
    end(&c);

    /* The same with the second face turned over. */
    trace(&c, 6, 2, turned);
    CHECK(c.graph.reversed_count == 1 && c.boundary.loop_count == 1);
    for (uint32_t i = 0; i < 6; i++)
        CHECK(c.boundary.half_edges[i] == expected_turned[i]);
    end(&c);
}

/* Two faces that touch at vertex 2 alone: two loops. */
static void test_touching(void)
{
    static const uint32_t faces[8] = {0, 1, 2, 3, 2, 4, 5, 6};
    Case c;
    trace(&c, 7, 2, faces);
    CHECK(c.boundary.loop_count == 2 && length(&c, 0) == 4 && length(&c, 1) == 4);
    CHECK(c.boundary.half_edges[0] == 0 && c.boundary.half_edges[4] == 4);
    end(&c);
}

/* A band of `n` faces: two loops, or one where its end is turned over before it is closed. */
static void test_bands(void)
{
    for (uint32_t twist = 0; twist < 2; twist++) {
        uint32_t faces[20];
        for (uint32_t i = 0; i < 5; i++) {
            uint32_t next = (i + 1) % 5;
            bool turn = twist && i == 4;
            faces[4 * i] = 2 * i;
            faces[4 * i + 1] = 2 * next + turn;
            faces[4 * i + 2] = 2 * next + !turn;
            faces[4 * i + 3] = 2 * i + 1;
        }
        Case c;
        trace(&c, 10, 5, faces);
        CHECK(c.boundary.loop_count == 2 - twist);
        CHECK(length(&c, 0) == (twist ? 10 : 5));
        CHECK(c.boundary.half_edges[0] == 0);
        end(&c);
    }
}

static void test_closed(void)
{
    static const uint32_t cube[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    Case c;
    trace(&c, 8, 6, cube);
    CHECK(c.boundary.loop_count == 0);
    end(&c);
}

int main(void)
{
    test_strip();
    test_touching();
    test_bands();
    test_closed();
    return 0;
}
