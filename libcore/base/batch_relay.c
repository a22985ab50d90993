#define _DEFAULT_SOURCE
#include "libcore/base/batch_relay.h"

#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>

/* Looks before a thread lets others run, and before it takes over what a thread that is there has not begun. */
enum { LOOKS = 2000, LOOKS_BETWEEN = 100, PATIENCE = 4000, LINE = 64 };

/* Of a window: who has what. */
typedef struct Place {
    _Alignas(LINE) _Atomic uint32_t taken;      /* windows whose batch here somebody has */
    _Atomic uint64_t holders[2];        /* of the windows in turn: number of the window, and below it of the thread */
    atomic_bool present;                /* the thread whose place it is has come */
    _Alignas(LINE) atomic_bool busy;    /* that thread drafts or judges: it reads what make_room() moves */
} Place;

typedef struct Race {
    const MesoBatchRelay *relay;
    uint32_t window_count;
    Place *places;                      /* [place_count] */
    _Alignas(LINE) _Atomic uint32_t judged;     /* batches, where what is admitted is read */
    _Alignas(LINE) _Atomic uint32_t admitted;   /* batches, in order */
    _Alignas(LINE) _Atomic uint32_t written[2]; /* batches, of the windows in turn */
    _Alignas(LINE) atomic_bool moves;           /* somebody makes room, or waits until nobody is busy */
    atomic_bool over, failed;
} Race;

/* A thread, in the place that is its own. */
typedef struct Runner {
    Race *race;
    uint32_t place, window;
    uint32_t drafted;                   /* windows up to the last whose batch at its place it has drafted */
    uint32_t looks;                     /* of its wait */
    uint64_t idle;                      /* of all */
} Runner;

/* ---- batches ---- */

static uint32_t batches_before(const Race *race, uint32_t window)
{
    uint32_t count = window * race->relay->place_count;
    return count < race->relay->batch_count ? count : race->relay->batch_count;
}

static uint32_t places_of(const Race *race, uint32_t window)
{
    return batches_before(race, window + 1) - batches_before(race, window);
}

static uint64_t holder(uint32_t window, uint32_t place)
{
    return (uint64_t)window << 32 | place;
}

static bool is_held(const Runner *runner, uint32_t window, uint32_t place)
{
    return atomic_load_explicit(&runner->race->places[place].holders[window % 2], memory_order_relaxed) ==
           holder(window, runner->place);
}

/* Whether all of the window two before, whose memory it has, is written: it and those before it were full. */
static bool may_begin(Race *race, uint32_t window)
{
    uint32_t before = window / 2 * race->relay->place_count;
    return atomic_load_explicit(&race->written[window % 2], memory_order_acquire) >= before;
}

/* False where somebody has it. */
static bool take(Runner *runner, uint32_t window, uint32_t place)
{
    Place *of = &runner->race->places[place];
    uint32_t taken = window;
    if (!may_begin(runner->race, window) || !atomic_compare_exchange_strong(&of->taken, &taken, window + 1))
        return false;
    atomic_store_explicit(&of->holders[window % 2], holder(window, runner->place), memory_order_relaxed);
    return true;
}

/* ---- waiting ---- */

static bool is_over(Race *race)
{
    return atomic_load_explicit(&race->over, memory_order_relaxed);
}

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

/* ---- room ---- */

/* Until leave(), nothing that is read is moved. */
static void enter(Runner *runner)
{
    Race *race = runner->race;
    atomic_bool *busy = &race->places[runner->place].busy;
    uint32_t looks = 0;
    for (atomic_store(busy, true); atomic_load(&race->moves); atomic_store(busy, true)) {
        atomic_store(busy, false);
        while (atomic_load(&race->moves))
            look_again(&looks);
    }
}

static void leave(Runner *runner)
{
    atomic_store_explicit(&runner->race->places[runner->place].busy, false, memory_order_release);
}

/* For the next batch that is admitted, when all before it are written and nobody is busy. */
static bool make_room(Race *race, uint32_t batch)
{
    uint32_t looks = 0;
    atomic_store(&race->moves, true);
    for (uint32_t i = 0; i < race->relay->place_count; i++)
        while (atomic_load(&race->places[i].busy))
            look_again(&looks);
    while (atomic_load(&race->written[0]) + atomic_load(&race->written[1]) < batch)
        look_again(&looks);
    bool made = race->relay->make_room(race->relay->context, batch);
    atomic_store(&race->moves, false);
    if (!made)
        atomic_store(&race->failed, true);
    return made;
}

/* ---- stages ---- */

static void draft_all(Runner *runner, uint32_t window, uint32_t place)
{
    const MesoBatchRelay *relay = runner->race->relay;
    for (bool done = false; !done;) {
        enter(runner);
        done = relay->draft(relay->context, batches_before(runner->race, window) + place);
        leave(runner);
    }
}

static void judge(Runner *runner, uint32_t window, uint32_t place)
{
    const MesoBatchRelay *relay = runner->race->relay;
    enter(runner);
    relay->judge(relay->context, batches_before(runner->race, window) + place);
    leave(runner);
    if (relay->is_read)
        atomic_fetch_add(&runner->race->judged, 1);
}

/* A piece of the next batch at the runner's place; false where there is none that may be begun. */
static bool draft_ahead(Runner *runner)
{
    Race *race = runner->race;
    uint32_t next = runner->window + 1;
    if (runner->drafted > next || next >= race->window_count || runner->place >= places_of(race, next))
        return false;
    if (!is_held(runner, next, runner->place) && !take(runner, next, runner->place))
        return false;
    enter(runner);
    if (race->relay->draft(race->relay->context, batches_before(race, next) + runner->place))
        runner->drafted = next + 1;
    leave(runner);
    return true;
}

static void wait_a_little(Runner *runner)
{
    MesoBatchIdle *idle = runner->race->relay->idle;
    if (draft_ahead(runner))
        return;
    look_again(&runner->looks);
    if (idle)
        atomic_store_explicit(&idle[runner->place].looks, ++runner->idle, memory_order_relaxed);
}

/* The batch whose turn it is. */
static void admit(Runner *runner, uint32_t window, uint32_t place)
{
    Race *race = runner->race;
    const MesoBatchRelay *relay = race->relay;
    uint32_t batch = batches_before(race, window) + place;
    if (!relay->has_room(relay->context, batch) && !make_room(race, batch)) {
        atomic_store(&race->over, true);
        return;
    }
    if (relay->admit(relay->context, batch))
        atomic_store_explicit(&race->admitted, batch + 1, memory_order_release);
    else
        atomic_store(&race->over, true);
    relay->write(relay->context, batch);
    atomic_fetch_add(&race->written[window % 2], 1);
}

/* Whether a batch is to be done by whoever comes: its thread is not there, or this wait is long by now. */
static bool is_left(Runner *runner, uint32_t place)
{
    return runner->looks >= PATIENCE ||
           !atomic_load_explicit(&runner->race->places[place].present, memory_order_relaxed);
}

static void take_over(Runner *runner, uint32_t window, uint32_t place)
{
    if (!is_left(runner, place) || !take(runner, window, place))
        return;
    draft_all(runner, window, place);
    judge(runner, window, place);
}

/* Until all of a window are judged. */
static void judge_window(Runner *runner, uint32_t window)
{
    Race *race = runner->race;
    runner->looks = 0;
    while (!is_over(race) && is_below(&race->judged, batches_before(race, window + 1))) {
        for (uint32_t i = 0, places = places_of(race, window); i < places; i++)
            take_over(runner, window, i);
        wait_a_little(runner);
    }
}

/* Until all batches before one are admitted; the next of them is taken over where it is left. False: it is over. */
static bool wait_for_turn(Runner *runner, uint32_t batch)
{
    Race *race = runner->race;
    runner->looks = 0;
    for (uint32_t next; (next = atomic_load_explicit(&race->admitted, memory_order_acquire)) < batch;) {
        uint32_t window = next / race->relay->place_count, place = next % race->relay->place_count;
        if (is_over(race))
            return false;
        if (!race->relay->is_read) {
            take_over(runner, window, place);
            if (is_held(runner, window, place)) {
                admit(runner, window, place);
                continue;
            }
        }
        wait_a_little(runner);
    }
    return !is_over(race);
}

/* Those of a window that the runner has. */
static void admit_window(Runner *runner, uint32_t window)
{
    for (uint32_t i = 0, places = places_of(runner->race, window); i < places; i++)
        if (is_held(runner, window, i) && wait_for_turn(runner, batches_before(runner->race, window) + i))
            admit(runner, window, i);
}

static void begin_own(Runner *runner, uint32_t window)
{
    Race *race = runner->race;
    runner->looks = 0;
    while (!may_begin(race, window) && !is_over(race))
        look_again(&runner->looks);
    if (runner->place < places_of(race, window) && !is_held(runner, window, runner->place))
        take(runner, window, runner->place);
}

/* What has come as the thread of one place. Whoever comes late finds less to do, or nothing. */
static void run(void *context, uint64_t begin, uint64_t end)
{
    Race *race = context;
    Runner runner = {.race = race, .place = (uint32_t)begin};
    (void)end;
    if (race->relay->idle)
        runner.idle = atomic_load_explicit(&race->relay->idle[begin].looks, memory_order_relaxed);
    atomic_store_explicit(&race->places[begin].present, true, memory_order_relaxed);
    for (; runner.window < race->window_count && !is_over(race); runner.window++) {
        uint32_t window = runner.window;
        begin_own(&runner, window);
        bool holds = runner.place < places_of(race, window) && is_held(&runner, window, runner.place);
        if (holds && runner.drafted <= window)
            draft_all(&runner, window, runner.place);
        if (race->relay->is_read && !wait_for_turn(&runner, batches_before(race, window)))
            return;
        if (holds)
            judge(&runner, window, runner.place);
        if (race->relay->is_read)
            judge_window(&runner, window);
        admit_window(&runner, window);
    }
}

static void set_places(Race *race)
{
    for (uint32_t i = 0; i < race->relay->place_count; i++) {
        Place *place = &race->places[i];
        atomic_init(&place->taken, 0);
        atomic_init(&place->holders[0], UINT64_MAX);
        atomic_init(&place->holders[1], UINT64_MAX);
        atomic_init(&place->present, false);
        atomic_init(&place->busy, false);
    }
}

bool meso_batch_relay(MesoTeam *team, const MesoBatchRelay *relay)
{
    Race race = {.relay = relay, .window_count = (relay->batch_count + relay->place_count - 1) / relay->place_count};
    race.places = aligned_alloc(LINE, relay->place_count * sizeof *race.places);
    if (!race.places)
        return false;
    set_places(&race);
    meso_team_for(team, relay->place_count, 1, run, &race);
    free(race.places);
    return !atomic_load(&race.failed);
}
