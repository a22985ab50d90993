/* Caches: what stands in them, every truncation; lists of frames and their names. */
#include <stdlib.h>
#include <string.h>

#include "formats/clip/frame_list.h"
#include "formats/clip/point_cache.h"
#include "libcore/base/check.h"

enum { FRAMES = 3, POINTS = 2 };

static void put(uint8_t **out, uint32_t value, bool big)
{
    for (int k = 0; k < 4; k++)
        *(*out)++ = (uint8_t)(value >> (big ? 24 - 8 * k : 8 * k));
}

static void put_float(uint8_t **out, float value, bool big)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(out, bits, big);
}

/* Coordinate c of point v of frame f is 100 f + 10 v + c. */
static size_t make_cache(uint8_t *bytes, MesoPointCacheKind kind)
{
    uint8_t *out = bytes;
    bool big = kind == MESO_CACHE_MDD;
    if (big) {
        put(&out, FRAMES, big);
        put(&out, POINTS, big);
        for (int f = 0; f < FRAMES; f++)
            put_float(&out, 0.25f * (float)f, big);
    } else {
        memcpy(out, "POINTCACHE2", 12);
        out += 12;
        put(&out, 1, big);
        put(&out, POINTS, big);
        put_float(&out, 5, big);
        put_float(&out, 0.5f, big);
        put(&out, FRAMES, big);
    }
    for (int f = 0; f < FRAMES; f++)
        for (int v = 0; v < POINTS; v++)
            for (int c = 0; c < 3; c++)
                put_float(&out, (float)(100 * f + 10 * v + c), big);
    return (size_t)(out - bytes);
}

static MesoStatus open_cache(MesoPointCache *cache, const uint8_t *bytes, size_t size, MesoPointCacheKind kind,
                             MesoInput *input, MesoError *error)
{
    meso_input_wrap(input, "a.cache", bytes, size);
    return meso_point_cache_open(cache, input, kind, error);
}

static void test_cache(MesoPointCacheKind kind)
{
    uint8_t bytes[256];
    size_t size = make_cache(bytes, kind);
    MesoInput input;
    MesoPointCache cache;
    MesoError error;
    MesoVec3 positions[POINTS];
    CHECK(open_cache(&cache, bytes, size, kind, &input, &error) == MESO_OK);
    CHECK(cache.frame_count == FRAMES && cache.point_count == POINTS);
    CHECK(meso_point_cache_is_pc2(&input) == (kind == MESO_CACHE_PC2));
    CHECK(meso_point_cache_time(&cache, 2) == (kind == MESO_CACHE_PC2 ? 6 : 0.5));
    for (uint32_t f = 0; f < FRAMES; f++) {
        CHECK(meso_point_cache_frame(&cache, f, positions, &error) == MESO_OK);
        CHECK(positions[1].x == (float)(100 * f + 10) && positions[1].z == (float)(100 * f + 12));
        CHECK(positions[0].y == (float)(100 * f + 1));
    }
    for (size_t cut = 1; cut < size; cut++) {
        uint8_t *exact = malloc(cut);
        CHECK(exact);
        memcpy(exact, bytes, cut);
        CHECK(open_cache(&cache, exact, cut, kind, &input, &error) == MESO_ERR_INPUT);
        free(exact);
    }
    uint8_t *last = bytes + size - 4;
    put_float(&last, NAN, kind == MESO_CACHE_MDD);
    CHECK(open_cache(&cache, bytes, size, kind, &input, &error) == MESO_OK);
    CHECK(meso_point_cache_frame(&cache, 1, positions, &error) == MESO_OK);
    CHECK(meso_point_cache_frame(&cache, 2, positions, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.cache: frame 3, vertex 2: coordinates that are not finite, or beyond 1e18");
}

/* Counts whose product does not fit in 64 bits. */
static void test_huge(void)
{
    uint8_t bytes[256];
    size_t size = make_cache(bytes, MESO_CACHE_MDD);
    MesoInput input;
    MesoPointCache cache;
    MesoError error;
    memset(bytes, 0xff, 8);
    CHECK(open_cache(&cache, bytes, size, MESO_CACHE_MDD, &input, &error) == MESO_ERR_INPUT);
    memset(bytes, 0, 8);
    CHECK(open_cache(&cache, bytes, size, MESO_CACHE_MDD, &input, &error) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "a.cache: a cache of 0 frames of 0 points");
}

static void expect_list(const char *text, uint32_t count, int32_t first, int32_t last)
{
    MesoArena arena;
    MesoFrameList list;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(meso_frame_list_parse(&list, &arena, text, &error) == MESO_OK);
    CHECK(list.count == count && list.frames[0] == first && list.frames[count - 1] == last);
    meso_arena_release(&arena);
}

static void expect_no_list(const char *text, MesoStatus status)
{
    MesoArena arena;
    MesoFrameList list;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(meso_frame_list_parse(&list, &arena, text, &error) == status);
    meso_arena_release(&arena);
}

static void test_lists(void)
{
    expect_list("7", 1, 7, 7);
    expect_list("1-100", 100, 1, 100);
    expect_list("1-99x2", 50, 1, 99);
    expect_list("10-1x3", 4, 10, 1);
    expect_list("3,10-20,0", 13, 3, 0);
    static const char *const bad[] = {"", "a", "1-", "-3", "1-5x0", "1-5x", "1,", "1,,2", "1-2-3", "1 2",
                                      "12345678901"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect_no_list(bad[i], MESO_ERR_USAGE);
    expect_no_list("0-999999999", MESO_ERR_LIMIT);
}

static void test_names(void)
{
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    CHECK_TEXT(meso_frame_path("a-%04d.obj", 17, &arena, &error), "a-0017.obj");
    CHECK_TEXT(meso_frame_path("100%%/%d.ply", 123456, &arena, &error), "100%/123456.ply");
    CHECK_TEXT(meso_frame_path("%02d", 123, &arena, &error), "123");
    meso_arena_release(&arena);
    CHECK(meso_frame_path_is_pattern("a-%04d.obj") && meso_frame_path_is_pattern("%d"));
    static const char *const bad[] = {"a.obj", "%d-%d", "%s", "%", "%4d", "%%", "%0d", "%x%d"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        CHECK(!meso_frame_path_is_pattern(bad[i]));
}

int main(void)
{
    test_cache(MESO_CACHE_PC2);
    test_cache(MESO_CACHE_MDD);
    test_huge();
    test_lists();
    test_names();
    return 0;
}
