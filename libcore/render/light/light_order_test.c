/* What maps hide: what changes none of their texels. */
#include "libcore/render/light/light_order.h"

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

int main(void)
{
    MesoArena arena;
    MesoLightMaps maps;
    const MesoVec3 towards[2] = {{0, 0, 1}, {1, 0, 0}}, origin = {0, 0, 0};
    meso_arena_init(&arena);
    CHECK(meso_light_maps_init(&maps, &arena, towards, 2, origin, 1, SIZE, NULL) == MESO_OK);
    float texel = maps.texel;

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
