/* Bundles from the nearest to the farthest; and what maps hide: what changes none of their texels. */
#include "libcore/render/light/light_order.h"

#include <stdlib.h>

#include "libcore/base/check.h"

enum { SIZE = 16 };

static MesoBox box_at(MesoVec3 middle, float half)
{
    const MesoVec3 reach = {half, half, half};
    return (MesoBox){meso_vec3_sub(middle, reach), meso_vec3_add(middle, reach)};
}

static void fill(MesoLightMaps *maps, float nearness)
{
    for (uint32_t i = 0; i < maps->count * SIZE * SIZE; i++)
        maps->nearness[i] = nearness;
}

/* On both sides of the middle and in it, twice at one place, and one that has none. */
static void test_order(MesoArena *arena)
{
    static const float heights[] = {-1, 0.5f, -0.0f, 3, 0, 0.5f, -40, 1e-6f, -2, NAN, 70000, -1e-6f};
    static const uint32_t expected[] = {10, 3, 1, 5, 7, 2, 4, 11, 0, 8, 6, 9};
    enum { COUNT = sizeof heights / sizeof *heights };
    const MesoVec3 up = {0, 0, 1}, origin = {0, 0, 0};
    MesoBox bounds[COUNT];
    MesoLightMaps maps;
    bool failed = false;
    CHECK(meso_light_maps_init(&maps, arena, &up, 1, origin, 1, SIZE, NULL) == MESO_OK);
    for (uint32_t i = 0; i < COUNT; i++)
        bounds[i] = (MesoBox){{0, 0, heights[i]}, {0, 0, heights[i]}};
    const MesoShapes shapes = {.bundle_count = COUNT, .bundle_bounds = bounds}, stored = {.bundle_count = COUNT};
    uint32_t *order = meso_light_order(&maps, &shapes, &failed);
    CHECK(order && !failed);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK(order[i] == expected[i]);
    free(order);
    CHECK(meso_light_order(&maps, &stored, &failed) == NULL && !failed);
}

int main(void)
{
    MesoArena arena;
    MesoLightMaps maps;
    const MesoVec3 towards[2] = {{0, 0, 1}, {1, 0, 0}}, origin = {0, 0, 0};
    meso_arena_init(&arena);
    CHECK(meso_light_maps_init(&maps, &arena, towards, 2, origin, 1, SIZE, NULL) == MESO_OK);
    float texel = maps.texel;
    test_order(&arena);

    /* Nothing is there yet: all is seen, but for what has no texel's middle and what is beside both maps. */
    fill(&maps, -INFINITY);
    MesoBox box = box_at(origin, 0.3f), small = box_at((MesoVec3){0, 0, 0}, 0.2f * texel);
    MesoBox beside = box_at((MesoVec3){0, 5, 0}, 0.3f);
    CHECK(!meso_light_maps_hide(&maps, &box));
    CHECK(meso_light_maps_hide(&maps, &small) && meso_light_maps_hide(&maps, &beside));

    /* Behind what is there, and as soon as it may be nearer not any more, in either map. */
    fill(&maps, 0.5f);
    MesoBox touching = box_at((MesoVec3){0, 0, 0.21f}, 0.3f), aside = box_at((MesoVec3){0.21f, 0, 0}, 0.3f);
    CHECK(meso_light_maps_hide(&maps, &box));
    CHECK(!meso_light_maps_hide(&maps, &touching) && !meso_light_maps_hide(&maps, &aside));

    /* One texel where nothing is: at the middle, whose cell is (2, 2) of four by four. */
    maps.maps[1].nearness[16 * (2 * SIZE / 4 + 2)] = -INFINITY;
    CHECK(!meso_light_maps_hide(&maps, &box));

    /* What is no number is not hidden. */
    MesoBox none = box_at((MesoVec3){NAN, 0, 0}, 0.3f);
    CHECK(!meso_light_maps_hide(&maps, &none));
    meso_arena_release(&arena);
    return 0;
}
