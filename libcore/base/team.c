#include "libcore/base/team.h"

#include <assert.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

#include "libcore/base/parallel.h"

/* Looks for the next loop before a thread sleeps: about as long as waking it takes. */
enum { LOOKS = 400, MOST_THREADS = 1024 };

typedef struct Loop {
    uint64_t count, grain;
    void (*body)(void *context, uint32_t worker, uint64_t begin, uint64_t end);
    void *context;
} Loop;

struct MesoTeam {
    pthread_mutex_t lock;
    pthread_cond_t begins, ends;    /* of loops */
    Loop loop;
    atomic_uint_fast64_t next;      /* range of it that nobody has taken yet */
    atomic_uint_fast64_t loops;     /* begun so far */
    atomic_uint_fast32_t numbers;   /* of threads that have come into being; the caller is number 0 */
    uint32_t working;               /* threads beside the caller that are in the loop */
    bool open;                      /* threads may come to it */
    bool over;
    uint32_t thread_count;
    pthread_t threads[];
};

static void relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
}

static void take_ranges(MesoTeam *team, uint32_t worker)
{
    const Loop *loop = &team->loop;
    for (;;) {
        uint64_t begin = atomic_fetch_add(&team->next, 1) * loop->grain;
        if (begin >= loop->count)
            return;
        uint64_t rest = loop->count - begin;
        loop->body(loop->context, worker, begin, begin + (rest < loop->grain ? rest : loop->grain));
    }
}

static void *serve(void *argument)
{
    MesoTeam *team = argument;
    uint32_t worker = (uint32_t)atomic_fetch_add(&team->numbers, 1) + 1;
    uint64_t seen = 0;
    for (;;) {
        for (int i = 0; i < LOOKS && atomic_load_explicit(&team->loops, memory_order_relaxed) == seen; i++)
            relax();
        pthread_mutex_lock(&team->lock);
        while (!team->over && !(team->open && atomic_load(&team->loops) != seen))
            pthread_cond_wait(&team->begins, &team->lock);
        bool over = team->over;
        seen = atomic_load(&team->loops);
        team->working += !over;
        pthread_mutex_unlock(&team->lock);
        if (over)
            return NULL;
        take_ranges(team, worker);
        pthread_mutex_lock(&team->lock);
        if (--team->working == 0)
            pthread_cond_signal(&team->ends);
        pthread_mutex_unlock(&team->lock);
    }
}

MesoTeam *meso_team_begin(uint32_t thread_count)
{
    uint32_t wanted = thread_count ? thread_count : meso_parallel_cores();
    wanted = (wanted < MOST_THREADS ? wanted : MOST_THREADS) - 1;
    MesoTeam *team = wanted ? calloc(1, sizeof *team + wanted * sizeof *team->threads) : NULL;
    if (!team)
        return NULL;
    pthread_mutex_init(&team->lock, NULL);
    pthread_cond_init(&team->begins, NULL);
    pthread_cond_init(&team->ends, NULL);
    while (team->thread_count < wanted &&
           pthread_create(&team->threads[team->thread_count], NULL, serve, team) == 0)
        team->thread_count++;
    return team;
}

uint32_t meso_team_size(const MesoTeam *team)
{
    return team ? team->thread_count + 1 : 1;
}

void meso_team_end(MesoTeam *team)
{
    if (!team)
        return;
    pthread_mutex_lock(&team->lock);
    team->over = true;
    atomic_fetch_add(&team->loops, 1);
    pthread_cond_broadcast(&team->begins);
    pthread_mutex_unlock(&team->lock);
    for (uint32_t i = 0; i < team->thread_count; i++)
        pthread_join(team->threads[i], NULL);
    pthread_cond_destroy(&team->ends);
    pthread_cond_destroy(&team->begins);
    pthread_mutex_destroy(&team->lock);
    free(team);
}

static void open_loop(MesoTeam *team, Loop loop)
{
    pthread_mutex_lock(&team->lock);
    team->loop = loop;
    atomic_store(&team->next, 0);
    atomic_fetch_add(&team->loops, 1);
    team->open = true;
    pthread_cond_broadcast(&team->begins);
    pthread_mutex_unlock(&team->lock);
}

static void close_loop(MesoTeam *team)
{
    pthread_mutex_lock(&team->lock);
    team->open = false;
    while (team->working)
        pthread_cond_wait(&team->ends, &team->lock);
    pthread_mutex_unlock(&team->lock);
}

void meso_team_work(MesoTeam *team, uint64_t count, uint64_t grain,
                    void (*body)(void *context, uint32_t worker, uint64_t begin, uint64_t end), void *context)
{
    assert(grain > 0);
    if (!team || count <= grain) {
        for (uint64_t begin = 0; begin < count; begin += grain)
            body(context, 0, begin, begin + (count - begin < grain ? count - begin : grain));
        return;
    }
    open_loop(team, (Loop){count, grain, body, context});
    take_ranges(team, 0);
    close_loop(team);
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

void meso_team_for(MesoTeam *team, uint64_t count, uint64_t grain,
                   void (*body)(void *context, uint64_t begin, uint64_t end), void *context)
{
    PlainLoop loop = {body, context};
    meso_team_work(team, count, grain, run_plain, &loop);
}
