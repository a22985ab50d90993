/* Hot spots: exact while slots are few, and within their bound when they are not. */
#include "libcore/tiling/search/hot_spots.h"

#include <stdbool.h>

#include "libcore/base/check.h"
#include "libcore/base/random.h"

static void test_exact(void)
{
    MesoArena arena;
    MesoHotSpots spots = {0};
    MesoHotSpot top[3];
    meso_arena_init(&arena);
    CHECK(meso_hot_spots_top(&spots, top, 3) == 0);
    CHECK(meso_hot_spots_reserve_one(&spots, &arena, NULL) == MESO_OK);
    CHECK(meso_hot_spots_top(&spots, top, 3) == 0);
    meso_hot_spots_add(&spots, 8);
    meso_hot_spots_add(&spots, UINT32_MAX - 1);
    CHECK(meso_hot_spots_top(&spots, top, 3) == 2 && top[0].slot == 8 && top[1].slot == UINT32_MAX - 1);
    for (uint32_t i = 0; i < MESO_HOT_SPOT_ENTRIES - 2; i++)
        for (uint32_t times = 0; times < (i == 700 ? 3u : i == 5 ? 2u : 1u); times++) {
            CHECK(meso_hot_spots_reserve_one(&spots, &arena, NULL) == MESO_OK);
            meso_hot_spots_add(&spots, 1000 * i);
        }
    CHECK(spots.total == MESO_HOT_SPOT_ENTRIES + 3);
    CHECK(meso_hot_spots_top(&spots, top, 3) == 3);
    CHECK(top[0].slot == 700000 && top[0].dead_ends == 3 && top[1].slot == 5000 && top[1].dead_ends == 2);
    CHECK(top[2].slot == 0 && top[2].dead_ends == 1);
    meso_arena_release(&arena);
}

/* One dead end in ten at slot 3, the others all over a million slots. */
static void test_crowd(void)
{
    enum { DEAD_ENDS = 300000 };
    MesoArena arena;
    MesoRandom random;
    MesoHotSpots spots = {0};
    MesoHotSpot top[2];
    uint64_t counts = 0;
    meso_arena_init(&arena);
    meso_random_init(&random, 1, 1);
    CHECK(meso_hot_spots_reserve(&spots, &arena, NULL) == MESO_OK);
    for (uint32_t i = 0; i < DEAD_ENDS; i++) {
        bool hot = meso_random_below(&random, 10) == 0;
        counts += hot;
        meso_hot_spots_add(&spots, hot ? 3 : 4 + meso_random_below(&random, 1000000));
    }
    CHECK(meso_hot_spots_top(&spots, top, 2) == 2 && top[0].slot == 3);
    CHECK(top[0].dead_ends <= counts && top[0].dead_ends + DEAD_ENDS / MESO_HOT_SPOT_ENTRIES >= counts);
    CHECK(spots.total == DEAD_ENDS && spots.count <= MESO_HOT_SPOT_ENTRIES);
    meso_arena_release(&arena);
}

int main(void)
{
    test_exact();
    test_crowd();
    return 0;
}
