/* Rate of the slot graph on a grid of a million faces. */
#include <stdio.h>

#include "libcore/base/check.h"
#include "libcore/base/clock.h"
#include "libcore/mesh/slot_graph.h"

enum { SIDE = 1000, ROUNDS = 7 };

static void make_grid(MesoQuadMesh *mesh, MesoArena *arena)
{
    MesoError error;
    uint32_t row = SIDE + 1;
    MesoVec3 *positions = MESO_NEW(arena, MesoVec3, (size_t)row * row, &error);
    uint32_t *faces = MESO_NEW(arena, uint32_t, (size_t)4 * SIDE * SIDE, &error);
    CHECK(positions && faces);
    for (uint32_t v = 0; v < row * row; v++)
        positions[v] = (MesoVec3){(float)(v % row), (float)(v / row), 0};
    for (uint32_t f = 0; f < SIDE * SIDE; f++) {
        uint32_t corner = f / SIDE * row + f % SIDE, *v = faces + 4 * (size_t)f;
        v[0] = corner;
        v[1] = corner + 1;
        v[2] = corner + row + 1;
        v[3] = corner + row;
    }
    CHECK(meso_quad_mesh_build(mesh, arena, row * row, positions, 0, NULL, SIDE * SIDE, faces, NULL,
                               &error) == MESO_OK);
}

int main(void)
{
    MesoArena arena;
    MesoQuadMesh mesh;
    MesoSlotGraph graph;
    MesoError error;
    double best = 1e9;
    meso_arena_init(&arena);
    make_grid(&mesh, &arena);
    for (int i = 0; i < ROUNDS; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        double start = meso_seconds();
        CHECK(meso_slot_graph_build(&graph, &arena, &mesh, &error) == MESO_OK);
        double took = meso_seconds() - start;
        best = took < best ? took : best;
        meso_arena_rewind(&arena, mark);
    }
    CHECK(graph.border_count == 4 * SIDE);
    printf("slot graph, grid of 1 M faces: %.1f million faces/s\n", 1e-6 * SIDE * SIDE / best);
    meso_arena_release(&arena);
    return 0;
}
