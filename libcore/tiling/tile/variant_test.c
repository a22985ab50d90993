/*
 * Transforms and variants.
 *
 *        side 1
 *     2 --------- 1
 *     |           |
 *   2 |           | 0      corner numbers at the corners, side k from k to k + 1
 *     |           |
 *     3 --------- 0
 *        side 3
 */
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/tiling/tile/variant.h"

static const MesoVec2 corners[4] = {{1, 0}, {1, 1}, {0, 1}, {0, 0}};

static bool same_point(MesoVec2 a, MesoVec2 b)
{
    return a.x == b.x && a.y == b.y;
}

static void test_group(void)
{
    for (MesoTransform a = 0; a < MESO_TRANSFORM_COUNT; a++) {
        CHECK(meso_transform_compose(a, 0) == a && meso_transform_compose(0, a) == a);
        CHECK(meso_transform_compose(a, meso_transform_inverse(a)) == 0);
        CHECK(meso_transform_compose(meso_transform_inverse(a), a) == 0);
        uint32_t seen = 0;
        for (MesoTransform b = 0; b < MESO_TRANSFORM_COUNT; b++) {
            MesoTransform ab = meso_transform_compose(a, b);
            CHECK(ab < MESO_TRANSFORM_COUNT);
            seen |= 1u << ab;
            for (uint32_t side = 0; side < 6; side++)
                CHECK(meso_transform_side(ab, side) ==
                      meso_transform_side(a, meso_transform_side(b, side)));
            MesoVec2 p = {0.25f, 0.125f};
            CHECK(same_point(meso_transform_point(ab, p),
                             meso_transform_point(a, meso_transform_point(b, p))));
            for (MesoTransform c = 0; c < MESO_TRANSFORM_COUNT; c++)
                CHECK(meso_transform_compose(ab, c) ==
                      meso_transform_compose(a, meso_transform_compose(b, c)));
        }
        CHECK(seen == 0xff);
    }
}

/* Flips first: flip x adds 2 to an even direction, flip y to an odd one; then the orientation. */
static uint32_t prototype_side(uint32_t flip_x, uint32_t flip_y, uint32_t orientation, uint32_t side)
{
    if (flip_x && side % 2 == 0)
        side += 2;
    if (flip_y && side % 2 == 1)
        side += 2;
    return (side + orientation) % 4;
}

static void test_prototype_rule(void)
{
    uint32_t times[MESO_TRANSFORM_COUNT] = {0};
    MesoTile tile = {.labels = {1, -2, 3, 4}};
    for (uint32_t i = 0; i < 16; i++) {
        uint32_t flip_x = i & 1, flip_y = i >> 1 & 1, orientation = i >> 2;
        MesoTransform t = meso_transform_make(flip_x, flip_y, orientation);
        times[t]++;
        CHECK(meso_transform_flips(t) == (flip_x != flip_y));
        for (uint32_t side = 0; side < 4; side++) {
            uint32_t lies = prototype_side(flip_x, flip_y, orientation, side);
            CHECK(meso_transform_side(t, side) == lies);
            CHECK(meso_transform_source(t, lies) == side);
            int32_t label = tile.labels[side];
            label = flip_x ? -label : label;
            label = flip_y ? -label : label;
            CHECK(meso_tile_label(&tile, t, lies) == label);
        }
        CHECK(meso_transform_side(t, MESO_SIDE_TOP) == MESO_SIDE_TOP);
        CHECK(meso_transform_source(t, MESO_SIDE_BOTTOM) == MESO_SIDE_BOTTOM);
    }
    for (uint32_t t = 0; t < MESO_TRANSFORM_COUNT; t++)
        CHECK(times[t] == 2);
}

/* Each side, taken as its two corners, goes where its number goes; flips turn it round. */
static void test_points(void)
{
    for (MesoTransform t = 0; t < MESO_TRANSFORM_COUNT; t++)
        for (uint32_t side = 0; side < 4; side++) {
            MesoVec2 begin = meso_transform_point(t, corners[side]);
            MesoVec2 end = meso_transform_point(t, corners[(side + 1) % 4]);
            uint32_t lies = meso_transform_side(t, side);
            bool flips = meso_transform_flips(t);
            CHECK(same_point(flips ? end : begin, corners[lies]));
            CHECK(same_point(flips ? begin : end, corners[(lies + 1) % 4]));
        }
    MesoVec2 quarter = meso_transform_point(meso_transform_make(false, false, 1), (MesoVec2){1, 0.25f});
    CHECK(same_point(quarter, (MesoVec2){0.75f, 1}));
    MesoVec2 flip_y = meso_transform_point(meso_transform_make(false, true, 0), (MesoVec2){1, 0.25f});
    CHECK(same_point(flip_y, (MesoVec2){1, 0.75f}));
}

/* What a tile allows is the smallest subgroup that holds its generators. */
static void test_allows(void)
{
    static const uint32_t orders[8] = {1, 4, 2, 8, 2, 8, 4, 8};  /* bit 0 rotation, 1 flip x, 2 flip y */
    for (uint32_t flags = 0; flags < 8; flags++) {
        MesoTile tile = {.rotation = flags & 1, .flip_x = flags >> 1 & 1, .flip_y = flags >> 2 & 1};
        CHECK(meso_tile_allows(&tile, 0));
        CHECK(meso_tile_allows(&tile, meso_transform_make(false, false, 1)) == tile.rotation);
        if (tile.flip_x)
            CHECK(meso_tile_allows(&tile, meso_transform_make(true, false, 0)));
        if (tile.flip_y)
            CHECK(meso_tile_allows(&tile, meso_transform_make(false, true, 0)));
        uint32_t order = 0;
        for (MesoTransform a = 0; a < MESO_TRANSFORM_COUNT; a++) {
            order += meso_tile_allows(&tile, a);
            for (MesoTransform b = 0; b < MESO_TRANSFORM_COUNT; b++)
                if (meso_tile_allows(&tile, a) && meso_tile_allows(&tile, b))
                    CHECK(meso_tile_allows(&tile, meso_transform_compose(a, b)));
        }
        CHECK(order == orders[flags]);
    }
}

/* Number of variants of one tile, and its transforms as bits. */
static uint32_t count_variants(MesoTile tile, MesoSweep *sweeps, uint32_t sweep_count,
                               uint32_t *transforms)
{
    MesoArena arena;
    MesoError error;
    MesoVariantSet variants;
    MesoTile tiles[2] = {{.labels = {9, 9, 9, 9}, .ignored = true}, tile};
    tiles[1].sweep_count = sweep_count;
    MesoTileSet set = {.tile_count = 2, .tiles = tiles, .sweeps = sweeps, .sweep_count = sweep_count};

    meso_arena_init(&arena);
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
    *transforms = 0;
    for (uint32_t v = 0; v < variants.count; v++) {
        CHECK(variants.tile[v] == 1);
        CHECK(v == 0 || variants.transform[v] > variants.transform[v - 1]);
        *transforms |= 1u << variants.transform[v];
        for (uint32_t side = 0; side < 4; side++)
            CHECK(variants.labels[4 * v + side] ==
                  meso_tile_label(&tile, variants.transform[v], side));
    }
    meso_arena_release(&arena);
    return variants.count;
}

static void test_variants(void)
{
    uint32_t transforms;
    MesoTile all = {.rotation = true, .flip_x = true, .flip_y = true, .labels = {1, 2, 3, 4}};
    CHECK(count_variants(all, NULL, 0, &transforms) == 8);

    MesoTile flips = {.flip_x = true, .flip_y = true, .labels = {1, 2, 3, 4}};
    CHECK(count_variants(flips, NULL, 0, &transforms) == 4 && transforms == 0x55);

    /* Same labels all round: a turn changes nothing, a flip changes the sign. */
    MesoTile round = {.rotation = true, .flip_x = true, .labels = {1, 1, 1, 1}};
    CHECK(count_variants(round, NULL, 0, &transforms) == 2 && transforms == 0x11);

    /* ... but what it carries may tell them apart. */
    round.inner_count = 1;
    CHECK(count_variants(round, NULL, 0, &transforms) == 8);
    round.inner_count = 0;
    round.labels[MESO_SIDE_BOTTOM] = -1;
    CHECK(count_variants(round, NULL, 0, &transforms) == 8);
    round.labels[MESO_SIDE_BOTTOM] = 0;

    /* A straight sweep 0-2: half a turn brings it back with its ends exchanged. */
    MesoSweep straight = {.from_side = 0, .to_side = 2};
    CHECK(count_variants(round, &straight, 1, &transforms) == 4 && transforms == 0x33);
    straight.half_turn = true;
    CHECK(count_variants(round, &straight, 1, &transforms) == 8);
    straight.half_turn = false;
    straight.turn = 0.25f;
    CHECK(count_variants(round, &straight, 1, &transforms) == 8);
    straight.turn = 0;      /* turned all the way it looks the same from both ends, but not in a mirror */
    straight.turns = 1;
    CHECK(count_variants(round, &straight, 1, &transforms) == 4);

    /* A cross of two: as a set, whatever the order. */
    MesoSweep cross[2] = {{.from_side = 0, .to_side = 2}, {.from_side = 3, .to_side = 1}};
    CHECK(count_variants(round, cross, 2, &transforms) == 2);

    /* Four loops, each on one side, in a circle. The mirror image of a loop that turns turns back,
     * which shows where the labels are their own opposites. */
    MesoTile none = {.rotation = true, .flip_x = true};
    MesoSweep loops[4];
    for (uint32_t i = 0; i < 4; i++)
        loops[i] = (MesoSweep){.from_side = i, .to_side = i, .to_section = 1, .turn = 0.25f};
    CHECK(count_variants(none, loops, 4, &transforms) == 2 && transforms == 0x11);
    for (uint32_t i = 0; i < 4; i++)
        loops[i].turn = 0.5f;
    CHECK(count_variants(none, loops, 4, &transforms) == 1 && transforms == 0x01);
}

static void test_empty(void)
{
    MesoArena arena;
    MesoError error;
    MesoVariantSet variants;
    MesoTileSet set = {0};
    meso_arena_init(&arena);
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_OK);
    CHECK(variants.count == 0);
    set.tile_count = UINT32_MAX;
    CHECK(meso_variant_set_build(&variants, &arena, &set, &error) == MESO_ERR_LIMIT);
    meso_arena_release(&arena);
}

int main(void)
{
    test_group();
    test_prototype_rule();
    test_points();
    test_allows();
    test_variants();
    test_empty();
    return 0;
}
