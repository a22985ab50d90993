/* The checker of assignments: every rule, broken once. */
#include "libcore/tiling/problem/assignment.h"

#include <string.h>

#include "libcore/tiling/fixture/solve_fixture.h"

static MesoArena arena;

static void expect(const MesoAssignment *assignment, const MesoTileSet *set,
                   const MesoSlotGraph *graph, const char *message)
{
    MesoError error;
    CHECK(meso_assignment_check(assignment, set, graph, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
}

/*
 * Two slots side by side, and a tile that shows a, b, a flipped, b flipped on
 * its sides 0 to 3: copies of it match everywhere.
 *
 *     +---+---+
 *     | 0 | 1 |
 *     +---+---+
 */
int main(void)
{
    static const int32_t labels[3][4] = {{1, 2, -1, -2}, {1, 2, -1, -2}, {1, 1, 1, 1}};
    MesoError error;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 3, labels, true, false, false);
    MesoSlotGraph graph = fixture_grid(&arena, 2, 1, false, false, false);
    uint32_t tile[2] = {0, 0};
    MesoTransform transform[2] = {0, 0};
    MesoAssignment assignment = {2, tile, transform};
    CHECK(meso_assignment_check(&assignment, &set, &graph, &error) == MESO_OK);

    assignment.slot_count = 1;
    expect(&assignment, &set, &graph, "the assignment has 1 slots, but the surface has 2 faces");
    assignment.slot_count = 2;

    tile[1] = 3;
    expect(&assignment, &set, &graph, "slot 1: no tile 3; the set has 3");
    tile[1] = MESO_NO_INDEX;
    expect(&assignment, &set, &graph, "slot 1: no tile 4294967295; the set has 3");
    tile[1] = 1;
    CHECK(meso_assignment_check(&assignment, &set, &graph, &error) == MESO_OK);
    set.tiles[1].ignored = true;
    expect(&assignment, &set, &graph, "slot 1: tile 't1' is marked as ignored");
    tile[1] = 0;

    transform[0] = 4;
    expect(&assignment, &set, &graph, "slot 0: tile 't0' does not allow transform 4");
    transform[0] = 8;
    expect(&assignment, &set, &graph, "slot 0: tile 't0' does not allow transform 8");
    transform[0] = 0;

    /* A quarter turn brings side 3 to side 0; a half turn side 2. */
    transform[0] = 1;
    expect(&assignment, &set, &graph,
           "slot 0, side 0: shows 'b' flipped, but slot 1, side 2 shows 'a' flipped");
    transform[0] = 2;
    expect(&assignment, &set, &graph,
           "slot 0, side 0: shows 'a' flipped, but slot 1, side 2 shows 'a' flipped");
    transform[1] = 2;
    CHECK(meso_assignment_check(&assignment, &set, &graph, &error) == MESO_OK);
    transform[0] = transform[1] = 0;
    tile[0] = 2;
    tile[1] = 2;
    expect(&assignment, &set, &graph, "slot 0, side 0: shows 'a', but slot 1, side 2 shows 'a'");
    tile[0] = tile[1] = 0;

    set.interfaces[1].border_exempt = true;
    expect(&assignment, &set, &graph, "slot 0, side 1: interface 'b' must not lie on a border");
    set.interfaces[1].border_exempt = false;
    set.interfaces[1].border_only = true;
    CHECK(meso_assignment_check(&assignment, &set, &graph, &error) == MESO_OK);
    set.interfaces[0].border_only = true;
    expect(&assignment, &set, &graph, "slot 0, side 0: interface 'a' may lie on a border only");

    MesoSlotGraph nothing = {0};
    assignment.slot_count = 0;
    CHECK(meso_assignment_check(&assignment, &set, &nothing, &error) == MESO_OK);
    meso_arena_release(&arena);
    return 0;
}
