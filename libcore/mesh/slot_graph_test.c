/* Slot graph: against exact tables, and against brute force on random meshes. */
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/mesh/slot_flood.h"

static MesoArena arena;
static MesoSlotGraph graph;
static MesoError error;

static MesoStatus build(uint32_t vertex_count, uint32_t face_count, const uint32_t *faces)
{
    MesoVec3 positions[64] = {{0}};
    for (uint32_t v = 0; v < vertex_count; v++)
        positions[v].x = (float)v;
    MesoQuadMesh mesh;
    MesoStatus status = meso_quad_mesh_build(&mesh, &arena, vertex_count, positions, 0, NULL,
                                             face_count, faces, NULL, &error);
    CHECK(status == MESO_OK);
    return meso_slot_graph_build(&graph, &arena, &mesh, &error);
}

/* One quad: four borders. */
static void test_one(void)
{
    uint32_t component;
    CHECK(build(4, 1, (uint32_t[]){0, 1, 2, 3}) == MESO_OK);
    CHECK(graph.slot_count == 1 && graph.edge_count == 4 && graph.border_count == 4);
    for (int k = 0; k < 4; k++)
        CHECK(graph.twin[k] == MESO_NO_INDEX);
    CHECK(meso_slot_graph_components(&graph, &component) == 1 && component == 0);
}

/*
 *   3-----2-----5     8-----7       face 1 is 1 4 5 2; face 2 stands alone;
 *   |  0  |  1  |     |  2  |       turned over, face 1 is 2 5 4 1
 *   0-----1-----4     9-----6
 */
static void test_two(void)
{
    uint32_t component[3];
    CHECK(build(10, 3, (uint32_t[]){0, 1, 2, 3, 1, 4, 5, 2, 6, 7, 8, 9}) == MESO_OK);
    CHECK(graph.edge_count == 11 && graph.border_count == 10 && graph.reversed_count == 0);
    for (uint32_t h = 0; h < 12; h++)
        CHECK(graph.twin[h] == (h == 1 ? 7 : h == 7 ? 1 : MESO_NO_INDEX));
    CHECK(meso_slot_graph_components(&graph, component) == 2);
    CHECK(component[0] == 0 && component[1] == 0 && component[2] == 1);

    CHECK(build(10, 3, (uint32_t[]){0, 1, 2, 3, 2, 5, 4, 1, 6, 7, 8, 9}) == MESO_OK);
    CHECK(graph.reversed_count == 1 && graph.twin[1] == 7 && graph.twin[7] == 1);
    CHECK(build(10, 3, (uint32_t[]){0, 1, 2, 3, 1, 2, 5, 4, 6, 7, 8, 9}) == MESO_OK);
    CHECK(graph.reversed_count == 1 && graph.twin[1] == 4 && graph.twin[4] == 1);
}

/* Two faces on the same four vertices: a pillow, and the same face twice. */
static void test_shared_edges(void)
{
    CHECK(build(4, 2, (uint32_t[]){0, 1, 2, 3, 3, 2, 1, 0}) == MESO_OK);
    CHECK(graph.edge_count == 4 && graph.border_count == 0 && graph.reversed_count == 0);
    CHECK(graph.twin[0] == 6 && graph.twin[1] == 5 && graph.twin[2] == 4 && graph.twin[3] == 7);
    CHECK(build(4, 2, (uint32_t[]){0, 1, 2, 3, 0, 1, 2, 3}) == MESO_OK);
    CHECK(graph.border_count == 0 && graph.reversed_count == 4);
}

static void test_three_faces(void)
{
    CHECK(build(8, 3, (uint32_t[]){0, 1, 2, 3, 1, 0, 4, 5, 6, 0, 1, 7}) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "edge between vertices 1 and 2 joins more than two faces (1, 2, 3)") == 0);
}

static void make_torus(uint32_t width, uint32_t height, uint32_t *faces)
{
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint32_t *f = faces + 4 * (y * width + x), x1 = (x + 1) % width, y1 = (y + 1) % height;
            f[0] = y * width + x;
            f[1] = y * width + x1;
            f[2] = y1 * width + x1;
            f[3] = y1 * width + x;
        }
}

/* The nearest first, by side; never more than there is room for, nor what is marked as met. */
static void test_flood(void)
{
    uint32_t faces[4 * 20], slots[20];
    bool met[20] = {false};
    make_torus(5, 4, faces);
    CHECK(build(20, 20, faces) == MESO_OK);
    MesoSlotFlood flood = {.graph = &graph, .slots = slots, .met = met, .most = 20};
    meso_slot_flood_all(&flood);
    CHECK(flood.count == 0);
    meso_slot_flood_meet(&flood, 0);
    meso_slot_flood_meet(&flood, 0);
    CHECK(flood.count == 1);
    meso_slot_flood_step(&flood);
    CHECK(flood.count == 5 && flood.followed == 1);
    CHECK(slots[0] == 0 && slots[1] == 15 && slots[2] == 1 && slots[3] == 5 && slots[4] == 4);
    meso_slot_flood_all(&flood);
    CHECK(flood.count == 20 && flood.followed == 20);

    memset(met, 0, sizeof met);
    met[1] = true;
    flood = (MesoSlotFlood){.graph = &graph, .slots = slots, .met = met, .most = 3};
    meso_slot_flood_meet(&flood, 0);
    meso_slot_flood_all(&flood);
    CHECK(flood.count == 3 && slots[1] == 15 && slots[2] == 5 && !met[4]);
}

/* Closed and orientable: Euler's V - E + F is 0. */
static void test_torus(void)
{
    uint32_t faces[4 * 56], component[56];
    make_torus(8, 7, faces);
    CHECK(build(56, 56, faces) == MESO_OK);
    CHECK(graph.edge_count == 112 && graph.border_count == 0 && graph.reversed_count == 0);
    CHECK(graph.twin[0] == 4 * 48 + 2);
    CHECK(meso_slot_graph_components(&graph, component) == 1);
}

/* A band of 5 quads, closed with a half turn. */
static void test_moebius(void)
{
    uint32_t faces[20];
    for (uint32_t i = 0; i < 5; i++)
        memcpy(faces + 4 * i, (uint32_t[]){2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1}, 16);
    faces[17] = 1;
    faces[18] = 0;
    CHECK(build(10, 5, faces) == MESO_OK);
    CHECK(graph.edge_count == 15 && graph.border_count == 10 && graph.reversed_count == 1);
}

typedef struct BruteForce {
    uint32_t edge_count, border_count, reversed_count;
    bool three;
} BruteForce;

static BruteForce count_edges(uint32_t face_count, const uint32_t *faces)
{
    BruteForce result = {0};
    for (uint32_t h = 0; h < 4 * face_count; h++) {
        uint32_t a = faces[h], b = faces[(h & ~3u) + ((h + 1) & 3)], same = 0, opposite = 0, before = 0;
        for (uint32_t g = 0; g < 4 * face_count; g++) {
            uint32_t c = faces[g], d = faces[(g & ~3u) + ((g + 1) & 3)];
            same += a == c && b == d;
            opposite += a == d && b == c;
            before += g < h && ((a == c && b == d) || (a == d && b == c));
        }
        result.three |= same + opposite > 2;
        if (before)
            continue;
        result.edge_count++;
        result.border_count += same + opposite == 1;
        result.reversed_count += same == 2;
    }
    return result;
}

static void check_twins(uint32_t face_count, const uint32_t *faces)
{
    for (uint32_t h = 0; h < 4 * face_count; h++) {
        uint32_t t = graph.twin[h];
        if (t == MESO_NO_INDEX)
            continue;
        uint32_t a = faces[h], b = faces[(h & ~3u) + ((h + 1) & 3)];
        uint32_t c = faces[t], d = faces[(t & ~3u) + ((t + 1) & 3)];
        CHECK(graph.twin[t] == h && t != h);
        CHECK((a == c && b == d) || (a == d && b == c));
    }
}

static void test_random(void)
{
    MesoRandom random;
    uint32_t accepted = 0, refused = 0;
    meso_random_init(&random, 5, 0);
    for (int round = 0; round < 3000; round++) {
        uint32_t vertex_count = 5 + meso_random_below(&random, 12), faces[4 * 12];
        uint32_t face_count = 1 + meso_random_below(&random, 12);
        for (uint32_t h = 0; h < 4 * face_count; h++) {
            bool fresh = false;
            while (!fresh) {
                faces[h] = meso_random_below(&random, vertex_count);
                fresh = true;
                for (uint32_t g = h & ~3u; g < h; g++)
                    fresh &= faces[g] != faces[h];
            }
        }
        BruteForce expected = count_edges(face_count, faces);
        MesoArenaMark mark = meso_arena_mark(&arena);
        MesoStatus status = build(vertex_count, face_count, faces);
        CHECK(status == (expected.three ? MESO_ERR_INPUT : MESO_OK));
        accepted += !status;
        refused += status != MESO_OK;
        if (!status) {
            CHECK(graph.edge_count == expected.edge_count);
            CHECK(graph.border_count == expected.border_count);
            CHECK(graph.reversed_count == expected.reversed_count);
            check_twins(face_count, faces);
        }
        meso_arena_rewind(&arena, mark);
    }
    CHECK(accepted > 300 && refused > 300);
}

int main(void)
{
    meso_arena_init(&arena);
    test_one();
    test_two();
    test_shared_edges();
    test_three_faces();
    test_torus();
    test_flood();
    test_moebius();
    test_random();
    meso_arena_release(&arena);
    return 0;
}
