#include "libcore/base/team.h"

#include <assert.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

#include "libcore/base/parallel.h"

/*
 * Looks before a thread sleeps, for the next loop, or for the others to be done with this one: some hundred microseconds.
 * To wake a thread can take as long as a short loop does, and on virtual machines much longer; and between loops what
 * only one thread can do takes no longer as a rule.
 */
enum { LOOKS = 4000, MOST_THREADS = 1024 };

/* Of a gate, which else counts the threads beside the caller that are in the loop: more may come. */
static const uint32_t open_bit = 0x80000000u;

typedef struct Loop {
    uint64_t count, grain;
    void (*body)(void *context, uint32_t worker, uint64_t begin, uint64_t end);
    void *context;
} Loop;

/* Ranges of a thread: of loops of one length always the same, whose memory is near it then. */
typedef struct Share {
    _Alignas(64) atomic_uint_fast64_t next;     /* that nobody has taken yet */
    uint64_t end;
} Share;

typedef struct Worker {
    pthread_t thread;
    struct MesoTeam *team;
    uint32_t number;                /* from 1 on; the caller is 0 */
} Worker;

struct MesoTeam {
    Loop loop;                      /* does not change, nor do ends of shares, while the gate is open, or any is in */
    Share *shares;                  /* [1 + thread_count] */
    atomic_uint_fast64_t loops;     /* begun so far */
    _Atomic uint32_t gate;
    atomic_bool over;
    _Atomic uint32_t sleepers;      /* threads that wait for `begins` */
    atomic_bool caller_sleeps;      /* and the caller for `ends` */
    pthread_mutex_t lock;           /* to sleep, and to wake */
    pthread_cond_t begins, ends;    /* of loops */
    uint32_t thread_count;
    Worker workers[];
};

static void take_share(const Loop *loop, Share *share, uint32_t worker)
{
    while (atomic_load_explicit(&share->next, memory_order_relaxed) < share->end) {
        uint64_t range = atomic_fetch_add(&share->next, 1);
        if (range >= share->end)
            return;
        uint64_t begin = range * loop->grain, rest = loop->count - begin;
        loop->body(loop->context, worker, begin, begin + (rest < loop->grain ? rest : loop->grain));
    }
}

/* A thread's own, and then what others have not come to. */
static void take_ranges(MesoTeam *team, uint32_t number)
{
    uint32_t count = team->thread_count + 1;
    for (uint32_t i = 0; i < count; i++)
        take_share(&team->loop, &team->shares[(number + i) % count], number);
}

static bool is_called(MesoTeam *team, uint64_t seen)
{
    return atomic_load(&team->over) || (atomic_load(&team->gate) & open_bit && atomic_load(&team->loops) != seen);
}

/* Until there is a loop that has not been seen. */
static void wait_for_loop(MesoTeam *team, uint64_t seen)
{
    for (int i = 0; i < LOOKS; i++) {
        if (is_called(team, seen))
            return;
        meso_relax();
    }
    pthread_mutex_lock(&team->lock);
    atomic_fetch_add(&team->sleepers, 1);
    while (!is_called(team, seen))
        pthread_cond_wait(&team->begins, &team->lock);
    atomic_fetch_sub(&team->sleepers, 1);
    pthread_mutex_unlock(&team->lock);
}

/* False where the gate has closed meanwhile. */
static bool enter(MesoTeam *team)
{
    uint32_t gate = atomic_load(&team->gate);
    while (gate & open_bit)
        if (atomic_compare_exchange_weak(&team->gate, &gate, gate + 1))
            return true;
    return false;
}

static void leave(MesoTeam *team)
{
    if (atomic_fetch_sub(&team->gate, 1) != 1 || !atomic_load(&team->caller_sleeps))
        return;
    pthread_mutex_lock(&team->lock);
    pthread_cond_signal(&team->ends);
    pthread_mutex_unlock(&team->lock);
}

static void *serve(void *argument)
{
    const Worker *worker = argument;
    MesoTeam *team = worker->team;
    uint64_t seen = 0;
    for (;;) {
        wait_for_loop(team, seen);
        if (atomic_load(&team->over))
            return NULL;
        if (!enter(team))
            continue;
        seen = atomic_load(&team->loops);
        take_ranges(team, worker->number);
        leave(team);
    }
}

MesoTeam *meso_team_begin(uint32_t thread_count)
{
    uint32_t wanted = thread_count ? thread_count : meso_parallel_cores();
    wanted = (wanted < MOST_THREADS ? wanted : MOST_THREADS) - 1;
    MesoTeam *team = wanted ? calloc(1, sizeof *team + wanted * sizeof *team->workers) : NULL;
    if (!team)
        return NULL;
    team->shares = aligned_alloc(_Alignof(Share), (wanted + 1) * sizeof *team->shares);
    if (!team->shares) {
        free(team);
        return NULL;
    }
    pthread_mutex_init(&team->lock, NULL);
    pthread_cond_init(&team->begins, NULL);
    pthread_cond_init(&team->ends, NULL);
    for (; team->thread_count < wanted; team->thread_count++) {
        Worker *worker = &team->workers[team->thread_count];
        worker->team = team;
        worker->number = team->thread_count + 1;
        if (pthread_create(&worker->thread, NULL, serve, worker) != 0)
            break;
    }
    return team;
}

uint32_t meso_team_size(const MesoTeam *team)
{
    return team ? team->thread_count + 1 : 1;
}

static void wake_sleepers(MesoTeam *team)
{
    if (!atomic_load(&team->sleepers))
        return;
    pthread_mutex_lock(&team->lock);
    pthread_cond_broadcast(&team->begins);
    pthread_mutex_unlock(&team->lock);
}

void meso_team_end(MesoTeam *team)
{
    if (!team)
        return;
    atomic_store(&team->over, true);
    wake_sleepers(team);
    for (uint32_t i = 0; i < team->thread_count; i++)
        pthread_join(team->workers[i].thread, NULL);
    pthread_cond_destroy(&team->ends);
    pthread_cond_destroy(&team->begins);
    pthread_mutex_destroy(&team->lock);
    free(team->shares);
    free(team);
}

static void open_loop(MesoTeam *team, Loop loop)
{
    uint64_t ranges = loop.count / loop.grain + (loop.count % loop.grain != 0), next = 0;
    team->loop = loop;
    for (uint32_t i = 0, count = team->thread_count + 1; i < count; i++) {
        team->shares[i].end = ranges * (i + 1) / count;
        atomic_store_explicit(&team->shares[i].next, next, memory_order_relaxed);
        next = team->shares[i].end;
    }
    atomic_fetch_add(&team->loops, 1);
    atomic_store(&team->gate, open_bit);
    wake_sleepers(team);
}

static void close_loop(MesoTeam *team)
{
    atomic_fetch_and(&team->gate, ~open_bit);
    for (int i = 0; i < LOOKS && atomic_load(&team->gate); i++)
        meso_relax();
    if (!atomic_load(&team->gate))
        return;
    pthread_mutex_lock(&team->lock);
    atomic_store(&team->caller_sleeps, true);
    while (atomic_load(&team->gate))
        pthread_cond_wait(&team->ends, &team->lock);
    atomic_store(&team->caller_sleeps, false);
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
