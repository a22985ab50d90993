/* Options of the mapping on the fixture's small surfaces: turns, sizes of sections, tangent scales. */
#include <math.h>

#include "libcore/tiling/strand/expansion_fixture.h"

static float ring_area(const MesoMeshVertex *ring, uint32_t count)
{
    MesoVec3 sum = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < count; i++)
        sum = meso_vec3_add(sum, meso_vec3_cross(meso_vec3_sub(ring[i].position, ring[0].position),
                                                 meso_vec3_sub(ring[i + 1].position, ring[0].position)));
    return meso_vec3_length(sum) / 2;
}

/* However the ends of a strand are turned against each other, it stays as wide in the middle. */
static void test_turns(MesoArena *arena)
{
    static const float turns[] = {0, 0.13f, 0.25f, 0.5f, 0.75f};
    uint32_t turning = 0;
    for (uint32_t i = 0; i < 10; i++) {
        Case s = {0};
        uint32_t tile[1] = {0};
        MesoTransform transform[1] = {i % 3 == 0 ? meso_transform_make(true, false, 0) : 0};
        make_tile_set(&s);
        make_grid(&s, arena, 1, tile, transform);
        for (uint32_t k = 0; k < 3; k++) {
            s.sweeps[k].turn = turns[i / 2];
            s.sweeps[k].half_turn = i % 2;
            s.sweeps[k].turns = k == 1 ? 2 : 0;
        }
        MesoExpansion expansion;
        MesoScene scene = expand(&s.model, &expansion, arena);
        MesoSceneParts t;
        MesoMeshFace *faces;
        MesoMeshVertex *v = make_polygons(&scene, arena, &t, &faces);
        for (uint32_t part = 0; part < scene.sweep_count; part++) {
            const MesoSweptKind *kind = &scene.kinds[meso_scene_kind(&scene, part)];
            const MesoKindOrigin *origin = &expansion.origins[kind - scene.kinds];
            uint32_t count = kind->column_count, last = kind->division_count - 1;
            if (kind->cap)
                continue;
            const MesoMeshVertex *ring = v + t.vertex_begin[part];
            float start = ring_area(ring, count), end = ring_area(ring + last * count, count);
            CHECK(ring_area(ring + last / 2 * count, count) > 0.8f * fminf(start, end));
            CHECK((fabsf(kind->turn) > 3 * (float)MESO_PI) == (origin->sweep == 1));
            turning += kind->turn != 0;
        }
    }
    CHECK(turning > 15);
}

/* Sections on walls are as large as both slots say, in the middle between their sizes. */
static void test_section_sizes(MesoArena *arena)
{
    const MesoVec3 points[6] = {{0, 0, 0}, {1, 0, 0}, {4, 0, 0}, {0, 1, 0}, {1, 1, 0}, {4, 1, 0}};
    const uint32_t corners[8] = {1, 4, 3, 0, 2, 5, 4, 1};
    Case s = {0};
    uint32_t tile[2] = {0, 0};
    MesoTransform transform[2] = {0, 0};
    make_tile_set(&s);
    make_grid(&s, arena, 1, tile, transform);
    CHECK(meso_quad_mesh_build(&s.model.surface, arena, 6, points, 0, NULL, 2, corners, NULL, NULL) == MESO_OK);
    CHECK(meso_slot_graph_build(&s.model.graph, arena, &s.model.surface, NULL) == MESO_OK);
    s.model.assignment.slot_count = 2;
    s.model.options.section_size = MESO_SECTION_SLOT;
    MesoExpansion expansion;
    MesoScene scene = expand(&s.model, &expansion, arena);
    float mean = s.model.surface.mean_edge_length;
    for (uint32_t i = 0; i < scene.sweep_count; i++) {
        const MesoKindOrigin *origin = &expansion.origins[meso_scene_kind(&scene, i)];
        const MesoSweepInstance *sweep = &scene.sweeps[i];
        bool far_slot = sweep->ids == 1;
        for (uint32_t end = 0; end < 2; end++) {
            uint32_t side = end ? origin->end_side : origin->start_side;
            bool shared = side == (far_slot ? 2 : 0);
            CHECK(fabsf(sweep->size[end] * mean - (shared ? 1.5f : far_slot ? 2 : 1)) < 1e-5f);
        }
    }
}

/* Of the tile and the sweep, on top of that of all. */
static void test_tangent_scales(MesoArena *arena)
{
    float lengths[2][3];
    for (uint32_t k = 0; k < 2; k++) {
        Case s = {0};
        uint32_t tile[1] = {0};
        MesoTransform transform[1] = {0};
        make_tile_set(&s);
        make_grid(&s, arena, 1, tile, transform);
        s.tiles[0].tangent_scale = k ? 0.5f : 0;
        s.sweeps[1].tangent_scale = k ? 3 : 0;
        MesoExpansion expansion;
        MesoScene scene = expand(&s.model, &expansion, arena);
        for (uint32_t i = 0; i < scene.sweep_count; i++) {
            uint32_t sweep = expansion.origins[meso_scene_kind(&scene, i)].sweep;
            if (sweep != MESO_NO_INDEX)
                lengths[k][sweep] = meso_vec3_length(meso_vec3_sub(scene.sweeps[i].p[1], scene.sweeps[i].p[0]));
        }
    }
    for (uint32_t sweep = 0; sweep < 3; sweep++)
        CHECK(fabsf(lengths[1][sweep] / lengths[0][sweep] - (sweep == 1 ? 1.5f : 0.5f)) < 1e-4f);
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_turns(&arena);
    test_section_sizes(&arena);
    test_tangent_scales(&arena);
    meso_arena_release(&arena);
    return 0;
}
