/* Lists of seeds: every form, every mistake, and where a seed stands. */
#include "cmd/common/seed_list.h"

#include <stdio.h>
#include <string.h>

#include "libcore/base/check.h"

static MesoArena arena;

static MesoSeedList parse(const char *text)
{
    MesoSeedList list;
    MesoError error;
    CHECK(meso_seed_list_parse(&list, &arena, text, &error) == MESO_OK);
    return list;
}

static void expect_failure(const char *text, const char *message)
{
    MesoSeedList list;
    MesoError error;
    CHECK(meso_seed_list_parse(&list, &arena, text, &error) == MESO_ERR_USAGE);
    if (!strstr(error.message, message))
        fprintf(stderr, "%s\n", error.message);
    CHECK(strstr(error.message, message) != NULL);
}

static void test_ranges(void)
{
    MesoSeedList list = parse("7");
    CHECK(list.range_count == 1 && list.seed_count == 1 && list.ranges[0].first == 7 && !list.ranges[0].attempts);
    list = parse("30-40x3,1-10,20,9223372036854775807");
    CHECK(list.range_count == 4 && list.seed_count == 23);
    static const MesoSeedRange ranges[4] = {{1, 10, 0, 0}, {20, 1, 0, 10}, {30, 11, 3, 11}, {INT64_MAX, 1, 0, 22}};
    for (uint32_t i = 0; i < 4; i++)
        CHECK(list.ranges[i].first == ranges[i].first && list.ranges[i].count == ranges[i].count &&
              list.ranges[i].attempts == ranges[i].attempts && list.ranges[i].begin == ranges[i].begin);
    CHECK(parse("2,1").seed_count == 2);
    CHECK(parse("0-9999999").seed_count == 10000000);
}

static void test_places(void)
{
    MesoSeedList list = parse("5-7,9,20-21x4");
    static const uint64_t in[6] = {5, 6, 7, 9, 20, 21}, out[7] = {0, 4, 8, 10, 19, 22, INT64_MAX};
    for (uint32_t i = 0; i < 6; i++)
        CHECK(meso_seed_list_find(&list, in[i]) && meso_seed_list_index(&list, in[i]) == i);
    for (uint32_t i = 0; i < 7; i++)
        CHECK(!meso_seed_list_find(&list, out[i]));
    CHECK(meso_seed_list_find(&list, 21)->attempts == 4 && meso_seed_list_find(&list, 9)->attempts == 0);
}

static void test_wrong(void)
{
    static const char *const parts[] = {"", "1-", "-1", "3-1", "1x", "1x0", "1x1000000001", " 1", "1 ", "1--2", "1-2-3",
                                        "9223372036854775808", "x2", "a", "1x2x3"};
    char text[80], message[80];
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        snprintf(message, sizeof message, "--seeds: '%s' is not A, A-B", parts[i]);
        expect_failure(parts[i], message);
        snprintf(text, sizeof text, "50,%s", parts[i]);
        expect_failure(text, message);
        snprintf(text, sizeof text, "%s,50", parts[i]);
        expect_failure(text, message);
    }
    expect_failure("0-10000000", "0-10000000 are over 10000000 seeds");
    expect_failure("0-9999999,10000000", "over 10000000 seeds");
    expect_failure("1,1", "seed 1 is named twice");
    expect_failure("5-9,1-5x2", "seed 5 is named twice");
    expect_failure("1-10,3", "seed 3 is named twice");
}

int main(void)
{
    meso_arena_init(&arena);
    test_ranges();
    test_places();
    test_wrong();
    meso_arena_release(&arena);
    return 0;
}
