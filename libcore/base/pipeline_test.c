/* Pipelines: each item is made once and taken in turn, no two at one place, and nothing after a refusal. */
#include "libcore/base/pipeline.h"

#include <stdatomic.h>

#include "libcore/base/check.h"

enum { ITEMS = 500, ROOM = 3 };

typedef struct Goods {
    uint64_t refused;           /* item */
    uint64_t taken;
    atomic_uint made[ITEMS], held[ROOM], working[8];
    uint64_t at[ROOM];
} Goods;

static void make(void *context, uint32_t worker, uint64_t item)
{
    Goods *goods = context;
    CHECK(atomic_fetch_add(&goods->working[worker], 1) == 0);
    CHECK(atomic_fetch_add(&goods->made[item], 1) == 0);
    CHECK(atomic_fetch_add(&goods->held[item % ROOM], 1) == 0);
    goods->at[item % ROOM] = item * item;
    atomic_fetch_sub(&goods->working[worker], 1);
}

static bool take(void *context, uint64_t item)
{
    Goods *goods = context;
    CHECK(item == goods->taken++ && atomic_load(&goods->made[item]) == 1);
    CHECK(goods->at[item % ROOM] == item * item);
    atomic_fetch_sub(&goods->held[item % ROOM], 1);
    return item != goods->refused;
}

static void run(Goods *goods, uint32_t workers, uint64_t count, uint64_t refused)
{
    *goods = (Goods){.refused = refused};
    const MesoPipeline pipeline = {.count = count, .room = ROOM, .context = goods, .make = make, .take = take};
    meso_pipeline_run(&pipeline, workers);
}

int main(void)
{
    static Goods goods;
    for (uint32_t workers = 1; workers <= 7; workers++) {
        run(&goods, workers, ITEMS, ITEMS);
        CHECK(goods.taken == ITEMS);
        run(&goods, workers, 0, 0);
        CHECK(goods.taken == 0);
        run(&goods, workers, 2, ITEMS);
        CHECK(goods.taken == 2);
        run(&goods, workers, ITEMS, 41);
        CHECK(goods.taken == 42);
        for (uint64_t item = 42 + ROOM; item < ITEMS; item++)
            CHECK(atomic_load(&goods.made[item]) == 0);
    }
    return 0;
}
