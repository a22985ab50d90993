/* The queue against a list of sizes: what it draws, how often, and what it counts. */
#include "libcore/tiling/propagate/bucket_queue.h"

#include "libcore/base/check.h"

enum { SLOTS = 300, LARGEST = 9 };

typedef struct Sizes {
    uint32_t now[SLOTS], stocked[SLOTS];
} Sizes;

static uint32_t size_now(const void *context, uint32_t slot)
{
    const Sizes *sizes = context;
    return sizes->now[slot];
}

static uint32_t least_size(const Sizes *sizes, uint32_t *open)
{
    uint32_t least = LARGEST + 1;
    *open = 0;
    for (uint32_t s = 0; s < SLOTS; s++) {
        *open += sizes->now[s] > 1;
        if (sizes->now[s] > 1 && sizes->now[s] < least)
            least = sizes->now[s];
    }
    return least;
}

static void check_draw(MesoBucketQueue *queue, const Sizes *sizes, MesoRandom *random)
{
    uint32_t open, least = least_size(sizes, &open);
    CHECK(queue->count == open);
    if (open)
        CHECK(sizes->now[meso_bucket_queue_draw(queue, random)] == least);
}

static void resize(MesoBucketQueue *queue, Sizes *sizes, uint32_t slot, uint32_t size)
{
    if (sizes->now[slot] > 1)
        meso_bucket_queue_remove(queue, slot, sizes->now[slot]);
    sizes->now[slot] = size;
    if (size > 1)
        CHECK(meso_bucket_queue_insert(queue, slot, size, NULL) == MESO_OK);
}

/* Moves at random, with restarts, and stocks anew. */
static void test_moves(uint64_t seed)
{
    MesoArena arena;
    MesoRandom random;
    MesoBucketQueue queue;
    Sizes sizes;
    meso_arena_init(&arena);
    meso_random_init(&random, seed, 0);
    CHECK(meso_bucket_queue_init(&queue, &arena, SLOTS, LARGEST, NULL) == MESO_OK);
    for (uint32_t round = 0; round < 4; round++) {
        for (uint32_t s = 0; s < SLOTS; s++)
            sizes.now[s] = sizes.stocked[s] = meso_random_below(&random, LARGEST + 1);
        meso_bucket_queue_stock(&queue, size_now, &sizes);
        for (uint32_t restart = 0; restart < 3; restart++) {
            uint32_t moves = meso_random_below(&random, 2000);
            for (uint32_t i = 0; i < moves; i++) {
                resize(&queue, &sizes, meso_random_below(&random, SLOTS), meso_random_below(&random, LARGEST + 1));
                check_draw(&queue, &sizes, &random);
            }
            for (uint32_t s = 0; s < SLOTS; s++) {
                meso_bucket_queue_restock(&queue, s, sizes.now[s], sizes.stocked[s]);
                sizes.now[s] = sizes.stocked[s];
            }
            meso_bucket_queue_refill(&queue);
            check_draw(&queue, &sizes, &random);
        }
    }
    meso_arena_release(&arena);
}

/* Of twelve slots of the least size, half in the stock, and others that have left it: each as often. */
static void test_frequencies(void)
{
    enum { DRAWS = 120000 };
    MesoArena arena;
    MesoRandom random;
    MesoBucketQueue queue;
    Sizes sizes;
    uint32_t drawn[SLOTS] = {0};
    meso_arena_init(&arena);
    meso_random_init(&random, 5, 0);
    CHECK(meso_bucket_queue_init(&queue, &arena, SLOTS, LARGEST, NULL) == MESO_OK);
    for (uint32_t i = 0; i < DRAWS / 12; i++) {
        for (uint32_t s = 0; s < SLOTS; s++)
            sizes.now[s] = s % 10 < 2 ? 4 : 7;
        meso_bucket_queue_stock(&queue, size_now, &sizes);
        for (uint32_t s = 0; s < SLOTS; s++)
            if (s >= 30)
                resize(&queue, &sizes, s, s % 10 < 2 ? 5 : s % 50 == 49 ? 4 : 8);
        for (uint32_t k = 0; k < 12; k++)
            drawn[meso_bucket_queue_draw(&queue, &random)]++;
    }
    double chi_squared = 0, expected = 0;
    uint32_t candidates = 0;
    for (uint32_t s = 0; s < SLOTS; s++)
        candidates += sizes.now[s] == 4;
    expected = (double)DRAWS / candidates;
    for (uint32_t s = 0; s < SLOTS; s++) {
        CHECK(sizes.now[s] == 4 || drawn[s] == 0);
        if (sizes.now[s] == 4)
            chi_squared += (drawn[s] - expected) * (drawn[s] - expected) / expected;
    }
    CHECK(candidates == 12);
    CHECK(chi_squared < 31.3);      /* one in a thousand, with eleven degrees of freedom */
    meso_arena_release(&arena);
}

int main(void)
{
    for (uint64_t seed = 0; seed < 20; seed++)
        test_moves(seed);
    test_frequencies();
    return 0;
}
