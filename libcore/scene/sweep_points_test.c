/* Points of sweeps without their normals, one by one and many at once: those of vertices. */
#include <string.h>

#include "libcore/scene/sweep_fixture.h"

/* Bare vertices have the places of whole ones: turned, of two sizes, bent into a cage or not. */
static void test_bare(void)
{
    static MesoMeshVertex bare[MOST_COLUMNS * MOST_RINGS];
    MesoCage cage = {{{1, 0, 0}, {1.2f, 1, 0.1f}, {0, 1.5f, 0}, {0, 0, 0.2f}},
                     {{0, 0, 1}, {0, 0.1f, 1}, {0, 0, 1}, {0, 0, 1}}, 0, 1};
    uint32_t kept[64];
    MesoVec2 box[64];
    uint32_t count = make_box(box, 16, 0.2f, 0.1f);
    make_tube(box, count, count / 2, 33);
    tube.scene.cages = &cage;
    tube.scene.cage_count = 1;
    tube.sweep.size[1] = 1.5f;
    for (uint32_t c = 0; c < count; c++)
        kept[c] = c;
    for (uint32_t i = 0; i < 4; i++) {
        tube.kind.turn = i & 1 ? (float)MESO_PI : 0;
        tube.scene.deform = i & 2 ? MESO_SWEEP_SHAPE : MESO_SWEEP_CURVES;
        MesoSweepGrid grid = {.columns = kept, .column_count = count, .ring_count = 9};
        meso_sweep_grid(&tube.scene, &tube.kind, &tube.sweep, &grid, tube.vertices);
        grid.bare = true;
        meso_sweep_grid(&tube.scene, &tube.kind, &tube.sweep, &grid, bare);
        for (uint32_t v = 0; v < count * 9; v++) {
            MesoVec3 a = bare[v].position, b = tube.vertices[v].position;
            CHECK(a.x == b.x && a.y == b.y && a.z == b.z);
        }
    }
}

static void check_points(uint32_t count, uint32_t rings)
{
    static float lines[4][72], x[72 * 9], y[72 * 9], z[72 * 9];
    const MesoSweepGrid grid = {.column_count = count, .ring_count = rings, .bare = true};
    CHECK(count <= 64 && rings <= 9);
    for (uint32_t c = 0; c < count; c++) {
        lines[0][c] = tube.columns[c].start.x;
        lines[1][c] = tube.columns[c].start.y;
        lines[2][c] = tube.columns[c].end.x;
        lines[3][c] = tube.columns[c].end.y;
    }
    meso_sweep_grid(&tube.scene, &tube.kind, &tube.sweep, &grid, tube.vertices);
    meso_sweep_points(&tube.scene, &tube.kind, &tube.sweep,
                      &(MesoSweepPlaces){count, lines[0], lines[1], lines[2], lines[3]}, rings, x, y, z);
    for (uint32_t v = 0; v < count * rings; v++) {
        const float at[3] = {x[v], y[v], z[v]};
        CHECK(memcmp(at, &tube.vertices[v].position, sizeof at) == 0);
    }
}

/* To the bit those of a grid, of any number: straight and turned, mitred and creased, of two sizes; and caps. */
static void test_points(void)
{
    MesoVec2 disc[64];
    uint32_t creased = 0;
    for (uint32_t i = 0; i < 96; i++) {
        uint32_t count = make_disc(disc, 3 + i % 13, i & 16 ? 0.24f : 0.15f);
        make_tube(disc, count, i % 3, 9);
        tube.kind.turn = i & 1 ? 1.3f : 0;
        tube.sweep = (MesoSweepInstance){{{0.1f, 0.2f, 0}, {0.2f, 0, 0}, {0.2f, 0.35f, 0}, {0, 0.35f, 0.1f}},
                                         {{0, 0, 1}, {0, 0.1f, 1}}, {{1, 0, 0}, {-1, 0, 0}}, 0,
                                         {1, i & 4 ? 1.4f : 1}, i & 2 ? 0.7f : 0, 0, 0, {{0}, {0}}};
        if (i & 8)
            add_mitre();
        creased += tube.sweep.mitre >= MESO_CREASED;
        if (i & 32)
            tube.sweep.mitre = 0.5f;
        tube.kind.cap = i % 8 == 7;
        check_points(count, 2 + i % 8);
    }
    CHECK(creased > 24);
}

int main(void)
{
    test_bare();
    test_points();
    return 0;
}
