/* Loops of a team: each item once, whether threads look for the next loop or sleep, and however few items there are. */
#define _GNU_SOURCE     /* usleep() */
#include "libcore/base/team.h"

#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "libcore/base/check.h"

enum { MOST = 3000 };

typedef struct Count {
    uint64_t count, grain;
    atomic_uint times[MOST];
    atomic_uint ranges;
} Count;

static void count_range(void *context, uint64_t begin, uint64_t end)
{
    Count *count = context;
    CHECK(begin % count->grain == 0 && begin < end && end <= count->count && end - begin <= count->grain);
    for (uint64_t i = begin; i < end; i++)
        atomic_fetch_add(&count->times[i], 1);
    atomic_fetch_add(&count->ranges, 1);
}

static void check_loop(MesoTeam *team, Count *count, uint64_t items, uint64_t grain)
{
    memset(count, 0, sizeof *count);
    count->count = items;
    count->grain = grain;
    meso_team_for(team, items, grain, count_range, count);
    for (uint64_t i = 0; i < items; i++)
        CHECK(atomic_load(&count->times[i]) == 1);
    CHECK(atomic_load(&count->ranges) == (items + grain - 1) / grain);
}

int main(void)
{
    static Count count;
    for (uint32_t threads = 1; threads <= 7; threads++) {
        MesoTeam *team = meso_team_begin(threads);
        CHECK((team == NULL) == (threads == 1));
        for (uint32_t i = 0; i < 400; i++) {
            check_loop(team, &count, i * 7919u % MOST, 1 + i % 130);
            if (i % 100 == 0)
                usleep(3000);   /* all sleep */
        }
        meso_team_end(team);
    }
    return 0;
}
