/* Any bytes as constraints on a small surface; what is accepted is solved under, and checked. */
#include <math.h>
#include <stdlib.h>

#include "formats/tiling/constraints/constraints_file.h"
#include "libcore/tiling/solve/solve.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static MesoInterface interfaces[2] = {{.name = "a", .section_count = 1}, {.name = "b"}};
    static MesoSection sections[1] = {{.name = "s"}};
    static MesoSweep sweeps[2] = {{.from_side = 0, .to_side = 1}, {.from_side = 2, .to_side = 3}};
    static MesoTile tiles[3] = {
        {.name = "t", .side_count = 4, .labels = {1, 1, -1, -1}, .rotation = true, .sweep_count = 2},
        {.name = "u", .side_count = 4, .labels = {2, 1, -2, -1}, .flip_x = true},
        {.name = "v", .side_count = 4, .labels = {1, 2, -1, -2}, .ignored = true}};
    static uint32_t twin[12] = {6, UINT32_MAX, UINT32_MAX, UINT32_MAX, 10, UINT32_MAX, 0, UINT32_MAX,
                                UINT32_MAX, UINT32_MAX, 4, UINT32_MAX};
    static uint32_t loop_begin[2] = {0, 8}, half_edges[8] = {1, 2, 3, 5, 7, 8, 9, 11};
    static const char *names[2] = {"left", "right wing"};
    static uint32_t of_face[3] = {0, 1, UINT32_MAX};
    static double values[3] = {0, 0.5, 1}, partial[3] = {-1e308, NAN, INFINITY};
    static MesoAttribute attributes[3] = {
        {.name = "red", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_DOUBLE, .width = 1, .entry_count = 3,
         .values = values},
        {.name = "heat", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_DOUBLE, .width = 1, .entry_count = 3,
         .values = partial},
        {.name = "group", .domain = MESO_ON_FACES, .entry_count = 2, .names = names, .entry_of = of_face}};
    const MesoTileSet set = {.interface_count = 2, .interfaces = interfaces, .tile_count = 3, .tiles = tiles,
                             .section_count = 1, .sections = sections, .sweep_count = 2, .sweeps = sweeps};
    const MesoSlotGraph graph = {.slot_count = 3, .edge_count = 10, .border_count = 8, .twin = twin};
    const MesoBoundary boundary = {.loop_count = 1, .loop_begin = loop_begin, .half_edges = half_edges};
    const MesoPolygonMesh mesh = {.face_count = 3, .corner_count = 12, .side_count = 4, .attribute_count = 3,
                                  .attributes = attributes};
    MesoArena arena;
    MesoError error;
    MesoInput input;
    MesoVariantSet variants;
    MesoConstraints constraints;
    MesoSolveResult result;

    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", data, size);
    if (meso_variant_set_build(&variants, &arena, &set, &error) != MESO_OK)
        abort();
    const MesoConstraintScope scope = {&set, &variants, &graph, &boundary, &mesh};
    const MesoSolveOptions options = {.max_attempts = 2, .max_dead_ends = 2};
    /* A wrong result is an internal error: the solver checks what it found. */
    if (meso_constraints_read(&constraints, &arena, &input, &scope, &error) == MESO_OK &&
        meso_solve(&result, &arena, &(MesoTilingProblem){&set, &variants, &graph, &constraints},
                   &options, &error) != MESO_OK)
        abort();
    meso_arena_release(&arena);
    return 0;
}
