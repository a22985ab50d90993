/*
 * Places looked up in many light maps at once against each map's texels one by one, for any number of maps, in the
 * sphere and far beside it. And of thousands of squares each one is in the maps, as high as it is, whoever drew it.
 */
#include "libcore/render/light/light_map.h"

#include <string.h>

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

/* ---- drawn ---- */

enum { SIDE = 90, SQUARES = SIDE * SIDE, FINE = 512 };

/* Squares beside each other over the plane, each a body of its own; higher ones after lower ones, and not. */
typedef struct Squares {
    MesoVec3 positions[4], normals[4];
    uint32_t corners[4], ids;
    MesoMaterial material;
    MesoBody body;
    MesoFrame frames[SQUARES];
    MesoPlacedBody placed[SQUARES];
    MesoScene scene;
    MesoShapes shapes;
} Squares;

static MesoVec3 middle_of(uint32_t square)
{
    float height = (float)(square * 37 % 101) / 101;
    return (MesoVec3){(float)(square % SIDE) / SIDE - 0.5f, (float)(square / SIDE) / SIDE - 0.5f, height};
}

static void make_squares(Squares *s)
{
    const float half = 0.45f / SIDE;
    *s = (Squares){0};
    for (uint32_t k = 0; k < 4; k++) {
        s->positions[k] = (MesoVec3){k == 1 || k == 2 ? half : -half, k >= 2 ? half : -half, 0};
        s->normals[k] = (MesoVec3){0, 0, 1};
        s->corners[k] = k;
    }
    s->body = (MesoBody){4, 1, 4, s->positions, s->normals, NULL, NULL, s->corners};
    for (uint32_t i = 0; i < SQUARES; i++) {
        MesoVec3 at = middle_of(i);
        s->frames[i] = (MesoFrame){{1, 0, 0, at.x, 0, 1, 0, at.y, 0, 0, 1, at.z}};
        s->placed[i] = (MesoPlacedBody){.frame = i, .place = MESO_PLACED_IN_FRAME};
    }
    s->scene = (MesoScene){.material_count = 1, .materials = &s->material, .id_row_count = 1, .ids = &s->ids,
                           .section_scale = 1, .body_count = 1, .bodies = &s->body, .placed_count = SQUARES,
                           .placed = s->placed, .frame_count = SQUARES, .frames = s->frames};
    meso_scene_measure(&s->scene);
    CHECK(meso_shapes_init(&s->shapes, &arena, &s->scene, (MesoVec3){0, 0, 0}, 1, &error) == MESO_OK);
}

static float nearness_at(const MesoLightMaps *maps, uint32_t m, MesoVec3 p)
{
    const MesoLightMap *map = &maps->maps[m];
    MesoVec3 q = meso_raster_from_eye(&map->view, p);
    uint32_t x = (uint32_t)(map->view.middle_x + map->view.focal * q.x);
    uint32_t y = (uint32_t)(map->view.middle_y + map->view.focal * q.y);
    return map->nearness[16 * ((size_t)(y / 4) * (maps->size / 4) + x / 4) + y % 4 * 4 + x % 4];
}

static void test_drawn(void)
{
    static Squares squares;
    static const MesoVec3 up = {0, 0, 1}, middle = {0, 0, 0.5f};
    const MesoVec3 towards[3] = {up, meso_vec3_unit((MesoVec3){0.1f, 0, 1}, up), {0, 1, 0}};
    MesoLightMaps first[2] = {{0}};
    make_squares(&squares);
    for (uint32_t threads = 1; threads <= 5; threads += 2) {
        MesoLightMaps maps[2], *const sets[2] = {&maps[0], &maps[1]};
        CHECK(meso_light_maps_init(&maps[0], &arena, towards, 3, middle, 1, 64, &error) == MESO_OK);
        CHECK(meso_light_maps_init(&maps[1], &arena, towards, 1, middle, 1, FINE, &error) == MESO_OK);
        CHECK(meso_light_maps_draw(sets, 2, &squares.shapes, threads, &error) == MESO_OK);
        for (uint32_t i = 0; i < SQUARES; i++) {
            MesoVec3 at = middle_of(i);
            CHECK(fabsf(nearness_at(&maps[1], 0, at) - (at.z - middle.z)) < 1e-4f);
        }
        if (threads == 1)
            memcpy(first, maps, sizeof first);
        for (uint32_t s = 0; s < 2; s++)
            CHECK(memcmp(first[s].nearness, maps[s].nearness,
                         (size_t)maps[s].count * maps[s].size * maps[s].size * sizeof(float)) == 0);
    }
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
    test_drawn();
    meso_arena_release(&arena);
    return 0;
}
