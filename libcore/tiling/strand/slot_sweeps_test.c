/* Scenes with a maker in place of sweeps: all that is made is what would be stored. */
#include "libcore/scene/sweep_maker.h"
#include "libcore/tiling/strand/expansion_fixture.h"

static MesoScene expand_to_draw(const MesoModel *model, MesoArena *arena, uint32_t stored)
{
    MesoScene scene;
    MesoError error;
    CHECK(meso_model_expand_to_draw(&scene, arena, model, stored, 2, &error) == MESO_OK);
    return scene;
}

static void check_sweep(const MesoScene *stored, const MesoScene *made, const MesoMadeSweep *sweep, bool *seen)
{
    CHECK(sweep->sweep < stored->sweep_count && !seen[sweep->sweep]);
    seen[sweep->sweep] = true;
    const MesoSweepInstance *there = &stored->sweeps[sweep->sweep];
    MesoSweepInstance alone = meso_scene_sweep(made, sweep->sweep);
    CHECK(sweep->kind == meso_scene_kind(stored, sweep->sweep));
    CHECK(memcmp(&sweep->instance, there, sizeof *there) == 0 && memcmp(&alone, there, sizeof *there) == 0);
    CHECK(meso_scene_sweep_ids(made, sweep->sweep) == there->ids);
}

/* What makes hulls to sweeps; returns whether that changes anything. */
static bool turn(const MesoScene *made, MesoMadeSweep *sweep)
{
    const MesoMadeSweep hull = *sweep;
    CHECK(hull.instance.twist == 0 && hull.instance.mitre == 0);
    made->maker->add_turns(made->maker->context, sweep);
    return memcmp(sweep, &hull, sizeof hull) != 0;
}

/* Within what a bundle is said to lie in, too. */
static uint32_t check_bundles(const MesoScene *stored, const MesoScene *made, MesoArena *arena)
{
    MesoMadeSweep sweeps[MESO_BUNDLE_SWEEPS];
    bool *seen = MESO_NEW(arena, bool, stored->sweep_count, NULL);
    uint32_t count = 0, turned = 0;
    for (uint32_t b = 0; b < made->maker->bundle_count; b++) {
        uint32_t here = made->maker->make_hulls(made->maker->context, b, sweeps);
        MesoBox box = meso_scene_bundle_box(made, b);
        CHECK(here <= MESO_BUNDLE_SWEEPS);
        count += here;
        for (uint32_t i = 0; i < here; i++) {
            turned += turn(made, &sweeps[i]);
            check_sweep(stored, made, &sweeps[i], seen);
            MesoBox own = meso_box_of(sweeps[i].instance.p, 4);
            own = meso_box_wider(own, meso_made_reach(made, sweeps[i].kind, &sweeps[i].instance));
            CHECK(!meso_box_sticks_out(&own, &box));
        }
    }
    CHECK(count == stored->sweep_count);
    return turned;
}

/* Returns how many sweeps have a twist or a mitre. */
static uint32_t check_same(const MesoModel *model, MesoArena *arena)
{
    MesoScene stored = expand(model, NULL, arena), made = expand_to_draw(model, arena, 1);
    CHECK(made.maker && !made.sweeps && made.sweep_count == stored.sweep_count);
    CHECK(memcmp(&made.box, &stored.box, sizeof stored.box) == 0);
    CHECK(made.id_row_count == stored.id_row_count && made.placed_count == stored.placed_count);
    CHECK(memcmp(made.kinds, stored.kinds, stored.kind_count * sizeof *stored.kinds) == 0);
    for (uint32_t k = 0; k < stored.kind_count; k++) {
        CHECK(meso_scene_kind_size(&made, &made.kinds[k]) == meso_scene_kind_size(&stored, &stored.kinds[k]));
        CHECK(meso_scene_kind_radius(&made, &made.kinds[k]) == meso_scene_kind_radius(&stored, &stored.kinds[k]));
    }
    uint32_t turned = check_bundles(&stored, &made, arena);
    CHECK(!expand_to_draw(model, arena, stored.sweep_count).maker && !expand_to_draw(model, arena, 0).maker);
    return turned;
}

static void test_what_is_made(MesoArena *arena)
{
    Case s = {0};
    uint32_t tile[49] = {0};
    MesoTransform transform[49];
    for (uint32_t i = 0; i < 49; i++)
        transform[i] = (MesoTransform)(i % MESO_TRANSFORM_COUNT);
    make_tile_set(&s);
    make_grid(&s, arena, 7, tile, transform);
    check_same(&s.model, arena);
    s.model.options.frame = MESO_FRAME_MINIMAL;
    s.model.options.section_size = MESO_SECTION_SLOT;
    CHECK(check_same(&s.model, arena) > 0);
}

/* A slot of more sweeps than a bundle holds has several. */
static void test_many_on_a_slot(MesoArena *arena)
{
    enum { MANY = 150 };
    Case s = {0};
    MesoSweep sweeps[MANY];
    uint32_t tile[4] = {0};
    MesoTransform transform[4] = {0, 1, 2, 3};
    make_tile_set(&s);
    for (uint32_t i = 0; i < MANY; i++)
        sweeps[i] = s.sweeps[i % 3];
    s.set.sweeps = sweeps;
    s.set.sweep_count = s.tiles[0].sweep_count = MANY;
    make_grid(&s, arena, 2, tile, transform);
    check_same(&s.model, arena);
}

/* Where sections deform, and where a tolerance chooses the steps, all are stored. */
static void test_what_is_stored(MesoArena *arena)
{
    Case s = {0};
    uint32_t tile[4] = {0};
    MesoTransform transform[4] = {0};
    make_tile_set(&s);
    make_grid(&s, arena, 2, tile, transform);
    s.model.options.deform = MESO_SWEEP_SHAPE;
    CHECK(!expand_to_draw(&s.model, arena, 1).maker);
    s.model.options.deform = MESO_SWEEP_CURVES;
    s.model.options.tolerance = 0.01f;
    CHECK(!expand_to_draw(&s.model, arena, 1).maker);
}

/* Slots without a wall: both ways say the same, on any number of threads. */
static void test_no_port(MesoArena *arena)
{
    Case s = {0};
    uint32_t tile[9] = {0};
    MesoTransform transform[9] = {0};
    make_tile_set(&s);
    make_grid(&s, arena, 3, tile, transform);
    MesoQuadMesh *mesh = &s.model.surface;
    for (uint32_t slot = 4; slot < 6; slot++)
        for (uint32_t i = 0; i < 4; i++)
            mesh->positions[mesh->face_vertices[4 * slot + i]] = (MesoVec3){0, 0, 0};
    for (uint32_t i = 0; i < mesh->normal_count; i++)
        mesh->normals[i] = (MesoVec3){0, 0, 1};
    for (uint32_t threads = 1; threads <= 4; threads++) {
        MesoScene scene;
        MesoError stored, made;
        MesoStatus status = meso_model_expand(&scene, NULL, arena, &s.model, threads, &stored);
        CHECK(status == MESO_ERR_INPUT);
        CHECK(meso_model_expand_to_draw(&scene, arena, &s.model, 1, threads, &made) == status);
        CHECK_TEXT(made.message, stored.message);
    }
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_what_is_made(&arena);
    test_many_on_a_slot(&arena);
    test_what_is_stored(&arena);
    test_no_port(&arena);
    meso_arena_release(&arena);
    return 0;
}
