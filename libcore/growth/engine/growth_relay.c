/*
 * Turns of several threads, where no rule looks for what has grown. A batch stays with one thread, which runs its
 * rules, judges its walks, admits its turns and writes down what they have grown: what comes from the memory of another
 * thread takes as long as a turn does.
 *
 * Batches are numbered through all windows. They are judged when all of the window before are admitted, and admitted
 * one after another when all of their own are judged: so they are judged by what does not change meanwhile, and what
 * has grown since is known. While others are admitted a thread writes down what its last batch has grown, or runs the
 * rules of its next, which ask for nothing that grows.
 *
 * The batch of one place in its window is one thread's as a rule, whose memory its tips are in then. What a thread does
 * not come to, since the machine has other things to do, is taken over by others.
 */
#define _DEFAULT_SOURCE
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "libcore/base/parallel.h"
#include "libcore/growth/engine/growth_work.h"

/* Looks before a thread lets others run, and before it takes over what a thread that is there has not begun. */
enum { LOOKS = 2000, LOOKS_BETWEEN = 100, PATIENCE = 4000, LINE = 64 };

/* Windows. */
enum { MANY = 3 };

/* Of a window: who has what. */
typedef struct Place {
    _Alignas(LINE) _Atomic uint32_t taken;      /* windows whose batch here somebody has */
    _Atomic uint64_t holders[2];        /* of the windows in turn: number of the window, and below it of the thread */
    atomic_bool present;                /* the thread whose place it is has come */
} Place;

typedef struct Relay {
    MesoGrowthWork *work;
    uint32_t place_count, batch_count, window_count;
    uint32_t each;                      /* turns of a batch, but for the last, which may have less */
    Place *places;                      /* [place_count] */
    _Alignas(LINE) _Atomic uint32_t judged;     /* batches */
    _Alignas(LINE) _Atomic uint32_t opened;     /* windows that are judged, and have room for what they grow */
    _Alignas(LINE) _Atomic uint32_t admitted;   /* batches, in order */
    _Alignas(LINE) _Atomic uint32_t written;    /* batches */
    _Alignas(LINE) atomic_bool over;
} Relay;

/* ---- batches ---- */

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Batches of all windows before one. */
static uint32_t batches_before(const Relay *relay, uint32_t window)
{
    return least(window * relay->place_count, relay->batch_count);
}

static uint32_t place_count(const Relay *relay, uint32_t window)
{
    return batches_before(relay, window + 1) - batches_before(relay, window);
}

static MesoGrowthWindow *window_at(const Relay *relay, uint32_t window)
{
    return &relay->work->windows[window % 2];
}

/* Behind the last turn of a batch, within its window. */
static uint32_t end_of(const Relay *relay, uint32_t window, uint32_t place)
{
    return least((place + 1) * relay->each, relay->work->active_count - window * relay->place_count * relay->each);
}

static uint64_t holder(uint32_t window, uint32_t thread)
{
    return (uint64_t)window << 32 | thread;
}

static bool is_held(const Relay *relay, uint32_t window, uint32_t place, uint32_t thread)
{
    return atomic_load_explicit(&relay->places[place].holders[window % 2], memory_order_relaxed) ==
           holder(window, thread);
}

/* Takes a batch, and runs its rules. False where somebody has it. */
static bool take(Relay *relay, uint32_t window, uint32_t place, uint32_t thread)
{
    Place *of = &relay->places[place];
    uint32_t taken = window;
    if (window >= relay->window_count || place >= place_count(relay, window) ||
        !atomic_compare_exchange_strong(&of->taken, &taken, window + 1))
        return false;
    atomic_store_explicit(&of->holders[window % 2], holder(window, thread), memory_order_relaxed);
    meso_growth_run_rules(relay->work, window_at(relay, window), place * relay->each, end_of(relay, window, place));
    return true;
}

/* ---- waiting ---- */

static bool is_below(_Atomic uint32_t *counter, uint32_t count)
{
    return atomic_load_explicit(counter, memory_order_acquire) < count;
}

static void look_again(uint32_t *looks)
{
    if (++*looks > LOOKS && *looks % LOOKS_BETWEEN == 0)
        sched_yield();
    else
        meso_relax();
}

/* False where growth is over. */
static bool wait_for(Relay *relay, _Atomic uint32_t *counter, uint32_t count)
{
    for (uint32_t looks = 0; is_below(counter, count); look_again(&looks))
        if (atomic_load(&relay->over))
            return false;
    return !atomic_load(&relay->over);
}

/* ---- windows ---- */

/* Of the next window, before its first rule runs. */
static void begin_window(const Relay *relay, uint32_t window)
{
    window_at(relay, window)->begin = window * relay->place_count * relay->each;
    window_at(relay, window)->each = relay->each;
}

/* Room for all that a window may grow, while nobody else does anything. */
static void open_window(Relay *relay, uint32_t number)
{
    MesoGrowthWork *work = relay->work;
    MesoGrowthWindow *window = window_at(relay, number);
    uint32_t shoots = 0, places = place_count(relay, number);
    for (uint32_t looks = 0; is_below(&relay->written, batches_before(relay, number));)
        look_again(&looks);
    for (uint32_t i = 0; i < places; i++)
        shoots += window->batches[i].shoot_count;
    meso_growth_begin_window(work, window);
    begin_window(relay, number + 1);
    if (!meso_growth_make_rooms(work, end_of(relay, number, places - 1), shoots, shoots))
        atomic_store(&relay->over, true);
    atomic_store_explicit(&relay->opened, number + 1, memory_order_release);
}

static void judge(Relay *relay, uint32_t window, uint32_t place)
{
    meso_growth_judge_walks(relay->work, window_at(relay, window), place * relay->each);
    if (atomic_fetch_add(&relay->judged, 1) + 1 == batches_before(relay, window + 1))
        open_window(relay, window);
}

/* Those that the thread has, and what nobody comes to. */
static void judge_all(Relay *relay, uint32_t window, uint32_t thread)
{
    uint32_t places = place_count(relay, window), looks = 0;
    for (uint32_t i = 0; i < places; i++)
        if (is_held(relay, window, i, thread))
            judge(relay, window, i);
    for (; is_below(&relay->judged, batches_before(relay, window + 1)); look_again(&looks))
        for (uint32_t i = 0; i < places; i++)
            if ((looks >= PATIENCE || !atomic_load_explicit(&relay->places[i].present, memory_order_relaxed)) &&
                take(relay, window, i, thread))
                judge(relay, window, i);
}

/* How many turns of a batch are; where not all, growth is over with its window. */
static uint32_t admit_batch(Relay *relay, uint32_t number, uint32_t place)
{
    MesoGrowthWork *work = relay->work;
    MesoGrowthWindow *window = window_at(relay, number);
    uint32_t begin = place * relay->each, end = end_of(relay, number, place), at = begin;
    if (!work->stops && !work->status)
        at = meso_growth_admit_range(work, window, begin, end);
    if (place + 1 == place_count(relay, number)) {
        meso_growth_end_window(work, window);
        if (work->stops || work->status)
            atomic_store(&relay->over, true);
    }
    return at - begin;
}

/* Those that the thread has, each as soon as the one before it is; until then its next batch begins. */
static void admit_all(Relay *relay, uint32_t window, uint32_t thread)
{
    for (uint32_t i = 0, places = place_count(relay, window); i < places; i++) {
        uint32_t number = batches_before(relay, window) + i;
        if (!is_held(relay, window, i, thread))
            continue;
        if (is_below(&relay->admitted, number))
            take(relay, window + 1, thread, thread);
        for (uint32_t looks = 0; is_below(&relay->admitted, number);)
            look_again(&looks);
        uint32_t begin = i * relay->each, count = admit_batch(relay, window, i);
        atomic_store_explicit(&relay->admitted, number + 1, memory_order_release);
        if (count)
            meso_growth_accept(relay->work, window_at(relay, window), begin, begin + count);
        atomic_fetch_add(&relay->written, 1);
    }
}

/* What has come as the thread of one place. Whoever comes late finds less to do, or nothing. */
static void run(void *context, uint64_t begin, uint64_t end)
{
    Relay *relay = context;
    uint32_t thread = (uint32_t)begin;
    (void)end;
    atomic_store_explicit(&relay->places[thread].present, true, memory_order_relaxed);
    for (uint32_t window = 0; window < relay->window_count; window++) {
        take(relay, window, thread, thread);
        if (!wait_for(relay, &relay->admitted, batches_before(relay, window)))
            return;
        judge_all(relay, window, thread);
        if (!wait_for(relay, &relay->opened, window + 1))
            return;
        admit_all(relay, window, thread);
    }
}

/*
 * As many places as threads can run at once: they wait for each other. Batches about alike, where they are few; where
 * they are many always of one length, so that branches stay in them.
 */
static bool plan(Relay *relay, MesoGrowthWork *work)
{
    uint32_t places = least(meso_team_size(work->team), meso_parallel_cores()), active = work->active_count;
    uint32_t windows = (active + places * MESO_GROWTH_BATCH - 1) / (places * MESO_GROWTH_BATCH);
    relay->work = work;
    relay->place_count = places;
    relay->each = windows < MANY ? (active + windows * places - 1) / (windows * places) : MESO_GROWTH_BATCH;
    relay->batch_count = (active + relay->each - 1) / relay->each;
    relay->window_count = (relay->batch_count + places - 1) / places;
    relay->places = aligned_alloc(LINE, places * sizeof *relay->places);
    for (uint32_t i = 0; relay->places && i < places; i++) {
        atomic_init(&relay->places[i].taken, 0);
        atomic_init(&relay->places[i].holders[0], UINT64_MAX);
        atomic_init(&relay->places[i].holders[1], UINT64_MAX);
        atomic_init(&relay->places[i].present, false);
    }
    return relay->places != NULL;
}

bool meso_growth_relay(MesoGrowthWork *work)
{
    Relay relay = {.window_count = 0};
    if (!plan(&relay, work)) {
        work->status = meso_fail(work->error, MESO_ERR_MEMORY, "out of memory: %u branches", work->tip_count);
        return false;
    }
    work->in_relay = true;
    begin_window(&relay, 0);
    meso_team_for(work->team, relay.place_count, 1, run, &relay);
    work->in_relay = false;
    free(relay.places);
    return !work->stops && !work->status;
}
