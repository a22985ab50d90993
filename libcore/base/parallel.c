/*
 * Plain threads rather than OpenMP, whose runtime ends the process, with the
 * status that means 'no' here, where the system refuses it a thread.
 */
#define _GNU_SOURCE     /* sched_getaffinity: the cores that taskset and containers leave us */
#include "libcore/base/parallel.h"

#include <assert.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

enum { MAX_THREADS = 1024 };

typedef struct Loop {
    uint64_t count, grain;
    void (*body)(void *context, uint32_t worker, uint64_t begin, uint64_t end);
    void *context;
    atomic_uint_fast64_t next;      /* range that nobody has taken yet */
    atomic_uint_fast32_t workers;   /* that have come */
} Loop;

uint32_t meso_parallel_cores(void)
{
    cpu_set_t cores;
    if (sched_getaffinity(0, sizeof cores, &cores) != 0)
        return 1;       /* over 1024 of them; say --threads there */
    int count = CPU_COUNT(&cores);
    return count > 1 ? (uint32_t)count : 1;
}

static void *take_ranges(void *argument)
{
    Loop *loop = argument;
    uint32_t worker = (uint32_t)atomic_fetch_add(&loop->workers, 1);
    uint64_t range_count = loop->count / loop->grain + (loop->count % loop->grain != 0);
    for (;;) {
        uint64_t range = atomic_fetch_add(&loop->next, 1);
        if (range >= range_count)
            return NULL;
        uint64_t begin = range * loop->grain, rest = loop->count - begin;
        loop->body(loop->context, worker, begin, begin + (rest < loop->grain ? rest : loop->grain));
    }
}

void meso_parallel_team(uint32_t worker_count, uint64_t count, uint64_t grain,
                        void (*body)(void *context, uint32_t worker, uint64_t begin, uint64_t end), void *context)
{
    assert(grain > 0 && worker_count > 0);
    Loop loop = {.count = count, .grain = grain, .body = body, .context = context};
    pthread_t threads[MAX_THREADS];
    uint32_t wanted = worker_count;
    if (wanted > MAX_THREADS)
        wanted = MAX_THREADS;
    if (wanted > 1 && wanted > (count + grain - 1) / grain)
        wanted = (uint32_t)((count + grain - 1) / grain);

    /* This thread works too; those that cannot be had are done without. */
    uint32_t started = 0;
    while (started + 1 < wanted && pthread_create(&threads[started], NULL, take_ranges, &loop) == 0)
        started++;
    take_ranges(&loop);
    for (uint32_t i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
}

/* A loop whose body does not ask who runs it. */
typedef struct PlainLoop {
    void (*body)(void *context, uint64_t begin, uint64_t end);
    void *context;
} PlainLoop;

static void run_plain(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    const PlainLoop *loop = context;
    (void)worker;
    loop->body(loop->context, begin, end);
}

void meso_parallel_for(uint32_t thread_count, uint64_t count, uint64_t grain,
                       void (*body)(void *context, uint64_t begin, uint64_t end), void *context)
{
    PlainLoop loop = {body, context};
    meso_parallel_team(thread_count ? thread_count : meso_parallel_cores(), count, grain, run_plain, &loop);
}
