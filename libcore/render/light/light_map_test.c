/*
 * Places looked up in many light maps at once against each map's texels one by one, for any number of maps, in the
 * sphere and far beside it.
 */
#include "libcore/render/light/light_map.h"

#include "libcore/base/check.h"
#include "libcore/base/random.h"

enum { SIZE = 64, MOST = 70 };

static MesoArena arena;
static MesoError error;

static float between(MesoRandom *random, float low, float high)
{
    return low + (high - low) * (float)meso_random_below(random, 1 << 24) / (1 << 24);
}

static MesoVec3 direction(MesoRandom *random)
{
    MesoVec3 v = {between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)};
    return meso_vec3_unit(v, (MesoVec3){0, 0, 1});
}

/* What is on a map is random, but for the two texels at its sides, which nothing reaches. */
static void fill(MesoLightMaps *maps, MesoRandom *random)
{
    for (uint32_t m = 0; m < maps->count; m++)
        for (uint32_t y = 0; y < SIZE; y++)
            for (uint32_t x = 0; x < SIZE; x++) {
                bool inner = x >= 2 && y >= 2 && x < SIZE - 2 && y < SIZE - 2;
                size_t cell = (size_t)(y / 4) * (SIZE / 4) + x / 4;
                maps->maps[m].nearness[16 * cell + (y % 4) * 4 + x % 4] = inner ? between(random, -1, 1) : -INFINITY;
            }
}

static float texel_lit(const MesoLightMap *map, int x, int y, float nearness)
{
    if (x < 0 || y < 0 || x >= SIZE || y >= SIZE)
        return 1;
    size_t cell = (size_t)(y / 4) * (SIZE / 4) + (size_t)(x / 4);
    return nearness >= map->nearness[16 * cell + (size_t)((y % 4) * 4 + x % 4)];
}

static float one_by_one(const MesoLightMaps *maps, uint32_t m, MesoVec3 p, MesoVec3 n)
{
    const MesoLightMap *map = &maps->maps[m];
    float facing = meso_vec3_dot(n, map->toward);
    if (facing <= 0)
        return 0;
    MesoVec3 lifted = meso_vec3_mad(p, maps->texel * (1 + 2 * (1 - facing)), n);
    MesoVec3 q = meso_raster_from_eye(&map->view, lifted);
    float x = map->view.middle_x + map->view.focal * q.x - 0.5f, y = map->view.middle_y + map->view.focal * q.y - 0.5f;
    float floor_x = floorf(x), floor_y = floorf(y), mine = maps->texel - q.z;
    int ix = (int)floor_x, iy = (int)floor_y;
    float top = texel_lit(map, ix, iy, mine) * (1 - (x - floor_x)) + texel_lit(map, ix + 1, iy, mine) * (x - floor_x);
    float bottom = texel_lit(map, ix, iy + 1, mine) * (1 - (x - floor_x)) +
                   texel_lit(map, ix + 1, iy + 1, mine) * (x - floor_x);
    return top * (1 - (y - floor_y)) + bottom * (y - floor_y);
}

static void test_maps(uint32_t count, MesoRandom *random)
{
    MesoVec3 towards[MOST], middle = {0.3f, -2, 1};
    float facing[MOST], lit[MOST], shades = 0;
    MesoLightMaps maps;
    for (uint32_t m = 0; m < count; m++)
        towards[m] = direction(random);
    CHECK(meso_light_maps_init(&maps, &arena, towards, count, middle, 1.5f, SIZE, &error) == MESO_OK);
    fill(&maps, random);
    for (int k = 0; k < 400; k++) {
        float far = k % 4 ? 1.5f : 40;
        MesoVec3 p = meso_vec3_mad(middle, between(random, 0, far), direction(random)), n = direction(random);
        meso_light_maps_lit(&maps, p, n, facing, lit);
        for (uint32_t m = 0; m < count; m++) {
            CHECK(fabsf(facing[m] - fmaxf(meso_vec3_dot(n, towards[m]), 0)) < 1e-6f);
            CHECK(fabsf(lit[m] - one_by_one(&maps, m, p, n)) < 2e-3f);
            shades += lit[m] > 0 && lit[m] < 1;
        }
    }
    CHECK(shades > 20 * (float)count);
}

int main(void)
{
    MesoRandom random;
    meso_random_init(&random, 7, 0);
    meso_arena_init(&arena);
    test_maps(1, &random);
    test_maps(12, &random);
    test_maps(32, &random);
    test_maps(MOST, &random);
    meso_arena_release(&arena);
    return 0;
}
