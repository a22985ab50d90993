/* Arena, errors, random numbers, bit sets, maps of numbers, parallel loops. */
#include <stdint.h>
#include <string.h>

#include "libcore/base/arena.h"
#include "libcore/base/bits.h"
#include "libcore/base/check.h"
#include "libcore/base/index_map.h"
#include "libcore/base/large_pages.h"
#include "libcore/base/parallel.h"
#include "libcore/base/random.h"
#include "libcore/base/team.h"

static void test_arena(void)
{
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);

    CHECK(MESO_NEW(&arena, uint64_t, SIZE_MAX / 4, &error) == NULL);
    CHECK(error.status == MESO_ERR_MEMORY);
    CHECK(MESO_NEW(&arena, int, 0, &error) != NULL);

    unsigned char *first = MESO_NEW(&arena, unsigned char, 100, &error);
    CHECK((uintptr_t)first % 64 == 0);
    MesoArenaMark mark = meso_arena_mark(&arena);
    unsigned char *scratch = MESO_NEW(&arena, unsigned char, 1000, &error);
    memset(scratch, 0xff, 1000);
    CHECK(MESO_NEW(&arena, char, 1 << 20, &error) != NULL);
    meso_arena_rewind(&arena, mark);

    /* The same bytes again, and they are zero again. */
    unsigned char *again = MESO_NEW(&arena, unsigned char, 2000, &error);
    CHECK(again == scratch);
    for (int i = 0; i < 2000; i++)
        CHECK(again[i] == 0);
    mark = meso_arena_mark(&arena);
    CHECK(meso_arena_adopt(&arena, malloc(100), &error) && meso_arena_adopt(&arena, malloc(1), &error));
    memset(MESO_NEW(&arena, char, 50, &error), 1, 50);
    meso_arena_rewind(&arena, mark);
    CHECK(meso_arena_adopt(&arena, malloc(1), &error));
    CHECK(strcmp(meso_arena_print(&arena, &error, "%d-%s", 7, "x"), "7-x") == 0);
    meso_arena_release(&arena);
    CHECK(arena.head == NULL && arena.used == 0);
}

/* Bare memory stands among zeroed memory, which is zero also where the bare one has been written to. */
static void test_arena_bare(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    for (size_t round = 0; round < 20; round++) {
        size_t size = 1 + 5000 * round;
        MesoArenaMark mark = meso_arena_mark(&arena);
        unsigned char *bare = MESO_NEW_BARE(&arena, unsigned char, size, NULL);
        CHECK(bare && (uintptr_t)bare % 64 == 0 && arena.used >= size);
        memset(bare, 0xff, size);
        unsigned char *zeroed = MESO_NEW(&arena, unsigned char, size, NULL);
        for (size_t i = 0; i < size; i++)
            CHECK(zeroed[i] == 0 && bare[i] == 0xff);
        memset(zeroed, 0xff, size);
        if (round % 3)
            meso_arena_rewind(&arena, mark);
    }
    MesoError error;
    CHECK(!MESO_NEW_BARE(&arena, uint64_t, SIZE_MAX / 4, &error) && error.status == MESO_ERR_MEMORY);
    meso_arena_release(&arena);
}

/* What comes again after a clear finds one block that has room for all of it, small or from the system; and zeros. */
static void test_arena_clear(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    meso_arena_clear(&arena);
    CHECK(arena.head == NULL);
    const size_t sizes[] = {100, 1 << 18, 3 << 20, 5000};
    MesoArenaBlock *block = NULL;
    for (int round = 0; round < 4; round++) {
        for (int i = 0; i < 4; i++) {
            unsigned char *data = MESO_NEW(&arena, unsigned char, sizes[i], NULL);
            CHECK(data && data[0] == 0 && data[sizes[i] - 1] == 0);
            memset(data, 7, sizes[i]);
        }
        CHECK(round == 0 || arena.head == block);
        meso_arena_clear(&arena);
        block = arena.head;
        CHECK(block && arena.used == 0);
    }
    CHECK(meso_arena_adopt(&arena, malloc(10), NULL) && MESO_NEW(&arena, char, 10, NULL));
    meso_arena_clear(&arena);
    meso_arena_release(&arena);
    CHECK(arena.head == NULL && arena.used == 0);
}

/* What is reserved is one block, which is kept for what comes next, and goes with a rewind. */
static void test_arena_reserve(void)
{
    enum { SIZE = 300 << 10 };
    MesoArena arena;
    meso_arena_init(&arena);
    meso_arena_reserve(&arena, 1000);
    CHECK(arena.head == NULL);
    unsigned char *before = MESO_NEW(&arena, unsigned char, 100, NULL);
    MesoArenaMark mark = meso_arena_mark(&arena);
    meso_arena_reserve(&arena, 4 * SIZE);
    MesoArenaBlock *block = arena.head;
    unsigned char *first = MESO_NEW(&arena, unsigned char, SIZE, NULL);
    meso_arena_reserve(&arena, 3 * SIZE);
    CHECK(before && first && arena.head == block && block != mark.block);
    for (int i = 1; i < 4; i++) {
        unsigned char *next = MESO_NEW(&arena, unsigned char, SIZE, NULL);
        CHECK(next == first + i * SIZE && next[0] == 0 && next[SIZE - 1] == 0);
        memset(next, 7, SIZE);
    }
    meso_arena_rewind(&arena, mark);
    CHECK(arena.head == mark.block && arena.used == mark.used);
    meso_arena_reserve(&arena, SIZE_MAX);
    CHECK(arena.head == mark.block);
    meso_arena_release(&arena);
}

/* What is left of a large block's last page is room for more. */
static void test_arena_pages(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    unsigned char *first = MESO_NEW(&arena, unsigned char, 13 << 17, NULL);
    MesoArenaBlock *block = arena.head;
    unsigned char *second = MESO_NEW(&arena, unsigned char, 1 << 18, NULL);
    CHECK(first && second == first + (13 << 17) && arena.head == block && second[(1 << 18) - 1] == 0);
    CHECK(MESO_NEW(&arena, unsigned char, 1 << 20, NULL) && arena.head != block);
    meso_arena_release(&arena);
}

/* Whole large pages where that is nearly all of them, and never less than is asked for; zeros, and all can be used. */
static void test_large_pages(void)
{
    enum { LARGE = 1 << 21 };
    static const struct {
        size_t wanted, given;
    } sizes[] = {{1, 4096}, {4096, 4096}, {1 << 20, 1 << 20}, {3 << 19, LARGE}, {LARGE, LARGE},
                 {LARGE + 1, LARGE + 4096}, {3 << 20, 2 * LARGE}, {10 * LARGE + 1, 11 * LARGE}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        size_t size = sizes[i].wanted;
        unsigned char *memory = meso_large_take(&size);
        CHECK(memory && size == sizes[i].given && (size < LARGE || (uintptr_t)memory % LARGE == 0));
        CHECK(memory[0] == 0 && memory[size / 2] == 0 && memory[size - 1] == 0);
        memset(memory, 1, size);
        meso_large_give(memory, size);
    }
    size_t most = SIZE_MAX - 5;
    CHECK(meso_large_take(&most) == NULL);
    meso_large_give(NULL, 0);
}

static void test_error(void)
{
    MesoError error;
    CHECK(meso_fail(&error, MESO_ERR_INPUT, "no '%s'", "a\nb\033[2J") == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "no 'a?b?[2J'") == 0);
    CHECK(meso_fail_prefix(&error, "file") == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "file: no 'a?b?[2J'") == 0);
    CHECK(meso_fail(NULL, MESO_ERR_LIMIT, "x") == MESO_ERR_LIMIT);
}

/* The reference numbers of SplitMix64(0) seed the state; the first output is
 * computed here by hand from them: rotl(s1 * 5, 7) * 9. */
static void test_random(void)
{
    MesoRandom a, b, c;
    meso_random_init(&a, 1, 0);
    meso_random_init(&b, 1, 0);
    meso_random_init(&c, 1, 1);
    uint64_t s1 = a.state[1] * 5;
    CHECK(meso_random_next(&a) == ((s1 << 7) | (s1 >> 57)) * 9);
    meso_random_next(&b);
    CHECK(meso_random_next(&a) == meso_random_next(&b));
    CHECK(meso_random_next(&a) != meso_random_next(&c));

    uint32_t seen[7] = {0};
    for (int i = 0; i < 70000; i++)
        seen[meso_random_below(&a, 7)]++;
    for (int i = 0; i < 7; i++)
        CHECK(seen[i] > 9500 && seen[i] < 10500);   /* 5 sigma is 463 */
    CHECK(meso_random_below(&a, 1) == 0);
}

static void test_bits(void)
{
    uint64_t bits[3] = {0};
    CHECK(meso_bits_words(64) == 1 && meso_bits_words(65) == 2 && meso_bits_words(0) == 0);
    CHECK(meso_bits_first(bits, 3) == 192);
    meso_bits_set(bits, 130);
    meso_bits_set(bits, 63);
    CHECK(meso_bits_test(bits, 130) && !meso_bits_test(bits, 131));
    CHECK(meso_bits_count(bits, 3) == 2 && meso_bits_first(bits, 3) == 63);
    meso_bits_clear(bits, 63);
    CHECK(meso_bits_first(bits, 3) == 130);
    CHECK(meso_bits_rank(bits, 130) == 0 && meso_bits_rank(bits, 131) == 1 && meso_bits_rank(bits, 191) == 1);
}

static void test_index_map(void)
{
    MesoArena arena;
    MesoIndexMap map = {0};
    meso_arena_init(&arena);
    CHECK(meso_index_map_find(&map, 7) == MESO_NO_INDEX);
    for (uint32_t i = 0; i < 5000; i++) {    /* the last key is MESO_NO_INDEX - 1 */
        uint32_t *value = meso_index_map_at(&map, &arena, MESO_NO_INDEX - 1 - i * i * 160, NULL);
        CHECK(value && *value == MESO_NO_INDEX);
        *value = i;
    }
    CHECK(map.count == 5000 && map.room == 16384);
    for (uint32_t i = 0; i < 5000; i++) {
        CHECK(meso_index_map_find(&map, MESO_NO_INDEX - 1 - i * i * 160) == i);
        CHECK(meso_index_map_find(&map, MESO_NO_INDEX - 2 - i * i * 160) == MESO_NO_INDEX);
    }
    CHECK(*meso_index_map_at(&map, &arena, MESO_NO_INDEX - 1 - 160, NULL) == 1 && map.count == 5000);
    meso_arena_release(&arena);
}

static void add_range(void *context, uint64_t begin, uint64_t end)
{
    uint8_t *touched = context;
    for (uint64_t i = begin; i < end; i++)
        touched[i]++;
}

static void test_parallel(void)
{
    for (uint32_t threads = 0; threads < 4; threads++) {
        uint8_t touched[1003] = {0};
        meso_parallel_for(threads, 1003, 10, add_range, touched);
        for (int i = 0; i < 1003; i++)
            CHECK(touched[i] == 1);
    }
    meso_parallel_for(2, 0, 1, add_range, NULL);
}

typedef struct Team {
    uint8_t touched[1003], busy[4];
} Team;

static void add_range_alone(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Team *team = context;
    CHECK(worker < 4 && team->busy[worker]++ == 0);
    add_range(team->touched, begin, end);
    team->busy[worker]--;
}

static void test_team(void)
{
    for (uint32_t workers = 1; workers <= 4; workers++) {
        Team team = {{0}, {0}};
        meso_parallel_team(workers, 1003, 10, add_range_alone, &team);
        for (int i = 0; i < 1003; i++)
            CHECK(team.touched[i] == 1);
    }
    meso_parallel_team(2, 0, 1, add_range_alone, NULL);
}

/* Many short loops: threads come late, or not at all. */
static void test_team_that_stays(void)
{
    for (uint32_t threads = 0; threads < 5; threads++) {
        MesoTeam *team = meso_team_begin(threads);
        CHECK((team == NULL) == (threads == 1 || (threads == 0 && meso_parallel_cores() == 1)));
        for (uint32_t loop = 0; loop < 500; loop++) {
            uint8_t touched[1003] = {0};
            uint32_t count = 1003 - loop;
            meso_team_for(team, count, 10, add_range, touched);
            for (uint32_t i = 0; i < 1003; i++)
                CHECK(touched[i] == (i < count));
        }
        meso_team_for(team, 0, 1, add_range, NULL);
        meso_team_end(team);
    }
}

static void test_team_that_counts(void)
{
    for (uint32_t threads = 1; threads <= 4; threads++) {
        MesoTeam *team = meso_team_begin(threads);
        CHECK(meso_team_size(team) >= 1 && meso_team_size(team) <= threads);
        for (uint32_t loop = 0; loop < 500; loop++) {
            Team work = {{0}, {0}};
            meso_team_work(team, 1003, 10, add_range_alone, &work);
            for (uint32_t i = 0; i < 1003; i++)
                CHECK(work.touched[i] == 1);
        }
        Team one = {{0}, {1, 1, 1, 1}};
        one.busy[0] = 0;
        meso_team_work(team, 10, 10, add_range_alone, &one);    /* a single range is the caller's, who is the first */
        meso_team_work(team, 0, 1, add_range_alone, NULL);
        meso_team_end(team);
    }
}

/* Pages that this process has in memory; 0 where the system does not tell. */
static long resident_pages(void)
{
    long size, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file)
        return 0;
    if (fscanf(file, "%ld %ld", &size, &resident) != 2)
        resident = 0;
    fclose(file);
    return resident;
}

/* What was allocated stays as it is; what comes after is zero again, and takes no room until it does. */
static void test_arena_trim(void)
{
    enum { ALL = 12 << 20, KEPT = 3 << 20 };
    MesoArena arena;
    meso_arena_init(&arena);
    meso_arena_trim(&arena);
    CHECK(MESO_NEW(&arena, unsigned char, ALL, NULL));
    meso_arena_clear(&arena);
    unsigned char *kept = MESO_NEW(&arena, unsigned char, KEPT, NULL);
    CHECK(kept);
    memset(kept, 1, KEPT);
    MesoArenaMark mark = meso_arena_mark(&arena);
    unsigned char *scratch = MESO_NEW(&arena, unsigned char, ALL - KEPT - 4096, NULL);
    CHECK(scratch);
    memset(scratch, 2, ALL - KEPT - 4096);
    meso_arena_rewind(&arena, mark);
    long before = resident_pages();
    meso_arena_trim(&arena);
    CHECK(!before || resident_pages() <= before - (6 << 20 >> 12));
    for (size_t i = 0; i < KEPT; i++)
        CHECK(kept[i] == 1);
    CHECK(MESO_NEW(&arena, unsigned char, ALL - KEPT - 4096, NULL) == scratch);
    for (size_t i = 0; i < ALL - KEPT - 4096; i++)
        CHECK(scratch[i] == 0);
    meso_arena_release(&arena);
}

int main(void)
{
    test_arena();
    test_arena_trim();
    test_arena_clear();
    test_arena_bare();
    test_arena_reserve();
    test_arena_pages();
    test_large_pages();
    test_error();
    test_random();
    test_bits();
    test_index_map();
    test_parallel();
    test_team_that_stays();
    test_team_that_counts();
    test_team();
    return 0;
}
