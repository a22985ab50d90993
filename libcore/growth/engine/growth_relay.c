/*
 * Turns of several threads, where no rule looks for what has grown, as stages of batch_relay.h: a batch stays with one
 * thread, which runs its rules, judges its walks, admits its turns and writes down what they have grown. Walks are
 * judged by what windows before theirs have grown, where they ask for it; what has grown since is known, and looked at
 * when their turns are admitted.
 */
#include <assert.h>
#include <stdlib.h>

#include "libcore/base/batch_relay.h"
#include "libcore/growth/engine/growth_work.h"

/* Windows; and turns whose rules are run at a time, while a thread waits. */
enum { MANY = 3, PIECE = 32 };

/* Shares of a batch that go from thread to thread at a time, and that are left to one, and given to one, at most. */
enum { SHIFTS = 32, LEAST = 12, MOST = 52 };

/* By so many looks more another thread must wait for that. */
enum { MUCH = 32 };

static_assert(MOST * MESO_GROWTH_BATCH_UNSEEN <= SHIFTS * MESO_GROWTH_BATCH_MOST, "batches have no room for that");

typedef struct Relay {
    MesoGrowthWork *work;
    uint32_t place_count, window_count;
    uint32_t window_size;               /* turns, but for the last, which may have less */
    uint32_t *begins;                   /* [place_count * window_count] of batches: of the active tips */
    MesoBatchIdle *idle;                /* [place_count] */
    uint64_t *idle_before;              /* [place_count] when shares were weighed last */
} Relay;

/* A batch, and which turns of its window it has. */
typedef struct Part {
    MesoGrowthWindow *window;
    MesoGrowthBatch *batch;
    uint32_t number_of_window, first;   /* its first turn, of the active tips */
    uint32_t begin, end;
    bool begins, ends;                  /* its window */
} Part;

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* ---- batches ---- */

static Part part_of(const Relay *relay, uint32_t number)
{
    uint32_t place = number % relay->place_count, number_of_window = number / relay->place_count;
    uint32_t first = number_of_window * relay->window_size;
    MesoGrowthWindow *window = &relay->work->windows[number_of_window % 2];
    bool ends = place + 1 == relay->place_count;
    uint32_t end = ends ? least(first + relay->window_size, relay->work->active_count) : relay->begins[number + 1];
    return (Part){window, &window->batches[place], number_of_window, first, relay->begins[number] - first, end - first,
                  place == 0, ends};
}

/* Divides a window among its places, by their shares. */
static void divide(const Relay *relay, uint32_t window)
{
    uint64_t all = (uint64_t)relay->place_count * relay->work->relay_batch, before = 0;
    uint32_t first = window * relay->window_size;
    uint32_t count = least(relay->window_size, relay->work->active_count - first);
    for (uint32_t i = 0; i < relay->place_count; i++) {
        relay->begins[window * relay->place_count + i] = first + (uint32_t)(count * before / all);
        before += relay->work->shares[i];
    }
}

/* Turns go from the thread that has waited least to the one that has most, which is faster, or has more to itself. */
static void weigh(const Relay *relay)
{
    uint32_t *shares = relay->work->shares, shift = relay->work->relay_batch / SHIFTS, most = 0, fewest = 0;
    uint64_t waits[2] = {0, UINT64_MAX};
    for (uint32_t i = 0; i < relay->place_count; i++) {
        uint64_t looks = atomic_load_explicit(&relay->idle[i].looks, memory_order_relaxed);
        uint64_t wait = looks - relay->idle_before[i];
        relay->idle_before[i] = looks;
        if (wait >= waits[0] && shares[i] < MOST * shift) {
            waits[0] = wait;
            most = i;
        }
        if (wait < waits[1] && shares[i] > LEAST * shift) {
            waits[1] = wait;
            fewest = i;
        }
    }
    if (waits[0] > waits[1] && waits[0] - waits[1] > MUCH) {
        shares[most] += shift;
        shares[fewest] -= shift;
    }
}

/* ---- stages ---- */

static bool draft(void *context, uint32_t number)
{
    const Relay *relay = context;
    const Part part = part_of(relay, number);
    MesoGrowthBatch *batch = part.batch;
    if (batch->number != number) {
        meso_growth_begin_batch(relay->work, batch, part.first);
        batch->number = number;
        batch->drafted = part.begin;
    }
    uint32_t to = least(batch->drafted + PIECE, part.end);
    meso_growth_run_rules(relay->work, part.window, batch, batch->drafted, to);
    batch->drafted = to;
    return to == part.end;
}

static void judge(void *context, uint32_t number)
{
    const Relay *relay = context;
    const Part part = part_of(relay, number);
    meso_growth_judge_walks(relay->work, part.window, part.batch);
}

/* Branches that the window has begun, but for those of this batch. */
static uint32_t begun_before(const MesoGrowthWork *work, const Part *part)
{
    return part->begins ? 0 : work->branch_count - part->window->first_branch;
}

static bool has_room(void *context, uint32_t number)
{
    const Relay *relay = context;
    const Part part = part_of(relay, number);
    uint32_t shoots = part.batch->shoot_count;
    return meso_growth_has_rooms(relay->work, part.end - part.begin, shoots, begun_before(relay->work, &part) + shoots);
}

static bool make_room(void *context, uint32_t number)
{
    const Relay *relay = context;
    const Part part = part_of(relay, number);
    uint32_t shoots = part.batch->shoot_count;
    return meso_growth_make_rooms(relay->work, part.end - part.begin, shoots,
                                  begun_before(relay->work, &part) + shoots);
}

static bool admit(void *context, uint32_t number)
{
    const Relay *relay = context;
    const Part part = part_of(relay, number);
    MesoGrowthWork *work = relay->work;
    if (part.begins) {
        part.window->begin = part.first;
        meso_growth_begin_window(work, part.window);
    }
    part.batch->admitted = part.begin;
    if (part.begin < part.end)
        part.batch->admitted = meso_growth_admit_range(work, part.window, part.begin, part.end);
    bool goes_on = !work->stops && !work->status;
    if (part.ends || !goes_on)
        meso_growth_end_window(work, part.window);
    if (part.ends && part.number_of_window + 2 < relay->window_count) {
        weigh(relay);
        divide(relay, part.number_of_window + 2);
    }
    return goes_on;
}

static void write(void *context, uint32_t number)
{
    const Relay *relay = context;
    const Part part = part_of(relay, number);
    meso_growth_accept(relay->work, part.window, part.batch, part.begin, part.batch->admitted);
}

/* ---- all of it ---- */

/*
 * Windows about alike, where they are few; where
 * they are many always of one length, so that branches stay with their threads.
 */
static bool plan(Relay *relay, MesoGrowthWork *work)
{
    uint32_t places = work->relay_places, active = work->active_count;
    uint32_t most = places * work->relay_batch, windows = (active + most - 1) / most;
    uint32_t size = windows < MANY ? (active + windows - 1) / windows : most;
    *relay = (Relay){.work = work, .place_count = places, .window_count = windows, .window_size = size};
    relay->begins = malloc((size_t)places * windows * sizeof *relay->begins);
    relay->idle = aligned_alloc(sizeof *relay->idle, places * sizeof *relay->idle);
    relay->idle_before = calloc(places, sizeof *relay->idle_before);
    if (!relay->begins || !relay->idle || !relay->idle_before)
        return false;
    for (uint32_t i = 0; i < places; i++)
        atomic_init(&relay->idle[i].looks, 0);
    for (uint32_t i = 0; i < 2; i++) {
        for (uint32_t k = 0; k < places; k++)
            work->windows[i].batches[k].number = MESO_NO_INDEX;
        if (i < windows)
            divide(relay, i);
    }
    return true;
}

static bool run(Relay *relay)
{
    const MesoBatchRelay stages = {.context = relay, .place_count = relay->place_count,
                                   .batch_count = relay->place_count * relay->window_count,
                                   .is_read = relay->work->uses_space, .draft = draft, .judge = judge,
                                   .has_room = has_room, .make_room = make_room, .admit = admit, .write = write,
                                   .idle = relay->idle};
    return meso_batch_relay(relay->work->team, &stages);
}

bool meso_growth_relay(MesoGrowthWork *work)
{
    Relay relay;
    work->in_relay = true;
    bool done = plan(&relay, work) && run(&relay);
    if (!done && !work->status)
        work->status = meso_fail(work->error, MESO_ERR_MEMORY, "out of memory: %u branches", work->tip_count);
    work->in_relay = false;
    free(relay.begins);
    free(relay.idle);
    free(relay.idle_before);
    return !work->stops && !work->status;
}
