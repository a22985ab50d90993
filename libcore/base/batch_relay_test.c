/* Stages of batches: each once and in order, by any number of threads, up to where it is over. */
#include "libcore/base/batch_relay.h"

#include <stdatomic.h>
#include <string.h>

#include "libcore/base/check.h"

enum { MOST = 700, PIECES = 3 };

/* What each stage has come to; plain numbers where the relay says that no other thread looks at them. */
typedef struct Batch {
    atomic_uint pieces, judged, admitted, written;
    uint32_t plain;                 /* by drafts, read by all that follow */
    uint32_t seen;                  /* of the total, when it was judged */
} Batch;

typedef struct Trial {
    MesoBatchRelay relay;
    Batch batches[MOST];
    uint32_t slots[2][7];           /* memory of two windows */
    uint32_t total, room;           /* what is admitted; for how much there is room */
    uint32_t stop, fail;            /* the batch that is the last, and for which there is no room; or none */
    uint32_t moves;
    atomic_int busy;                /* in draft() or judge() */
} Trial;

static uint32_t *slot_of(Trial *trial, uint32_t number)
{
    uint32_t places = trial->relay.place_count;
    return &trial->slots[number / places % 2][number % places];
}

/* Some take longer than others. */
static void linger(uint32_t number)
{
    volatile uint32_t sum = 0;
    for (uint32_t i = 0; i < number * 7919u % 3000; i++)
        sum += i;
}

static bool draft(void *context, uint32_t number)
{
    Trial *trial = context;
    Batch *batch = &trial->batches[number];
    uint32_t places = trial->relay.place_count, piece = atomic_load(&batch->pieces);
    atomic_fetch_add(&trial->busy, 1);
    CHECK(piece < PIECES && atomic_load(&batch->judged) == 0);
    for (uint32_t i = 0; number / places >= 2 && i < places; i++)
        CHECK(atomic_load(&trial->batches[(number / places - 2) * places + i].written) == 1);
    if (piece == 0)
        *slot_of(trial, number) = number;
    CHECK(*slot_of(trial, number) == number);
    batch->plain += number + 1;
    linger(number);
    atomic_store(&batch->pieces, piece + 1);
    atomic_fetch_sub(&trial->busy, 1);
    return piece + 1 == PIECES;
}

static void judge(void *context, uint32_t number)
{
    Trial *trial = context;
    Batch *batch = &trial->batches[number];
    atomic_fetch_add(&trial->busy, 1);
    CHECK(atomic_load(&batch->pieces) == PIECES && batch->plain == PIECES * (number + 1));
    CHECK(atomic_fetch_add(&batch->judged, 1) == 0 && *slot_of(trial, number) == number);
    if (trial->relay.is_read)
        batch->seen = trial->total;
    linger(number + 1);
    atomic_fetch_sub(&trial->busy, 1);
}

static bool has_room(void *context, uint32_t number)
{
    const Trial *trial = context;
    return trial->total + number + 1 <= trial->room && number != trial->fail;
}

/* Alone: those before it are written, and nobody drafts or judges. */
static bool make_room(void *context, uint32_t number)
{
    Trial *trial = context;
    for (uint32_t i = 0; i < number; i++)
        CHECK(atomic_load(&trial->batches[i].written) == 1);
    CHECK(atomic_load(&trial->busy) == 0);
    trial->room = 2 * (trial->total + number + 1);
    trial->moves++;
    return number != trial->fail;
}

static bool admit(void *context, uint32_t number)
{
    Trial *trial = context;
    Batch *batch = &trial->batches[number];
    CHECK(trial->total == number * (number + 1) / 2 && *slot_of(trial, number) == number);
    trial->total += number + 1;
    CHECK(trial->total <= trial->room);
    CHECK(atomic_load(&batch->judged) == 1 && atomic_fetch_add(&batch->admitted, 1) == 0);
    return number != trial->stop;
}

static void write(void *context, uint32_t number)
{
    Trial *trial = context;
    Batch *batch = &trial->batches[number];
    CHECK(*slot_of(trial, number) == number);
    linger(number + 2);
    CHECK(atomic_load(&batch->admitted) == 1 && atomic_fetch_add(&batch->written, 1) == 0);
}

/* What was admitted when all batches of the windows before were, and no other. */
static uint32_t total_before(uint32_t number, uint32_t places)
{
    uint32_t first = number / places * places;
    return first * (first + 1) / 2;
}

static void check_relay(MesoTeam *team, uint32_t places, uint32_t batches, bool is_read, uint32_t stop, uint32_t fail)
{
    static Trial trial;
    static MesoBatchIdle idle[7];
    memset(&trial, 0, sizeof trial);
    trial.relay = (MesoBatchRelay){&trial, places, batches, is_read, draft, judge, has_room, make_room, admit, write,
                                   is_read ? idle : NULL};
    trial.stop = stop;
    trial.fail = fail;
    bool done = meso_batch_relay(team, &trial.relay);
    uint32_t end = stop < batches ? stop + 1 : batches;
    end = fail < end ? fail : end;
    CHECK(done == !(fail < batches && fail <= stop));
    for (uint32_t i = 0; i < batches; i++) {
        const Batch *batch = &trial.batches[i];
        CHECK(batch->admitted == (i < end) && batch->written == (i < end));
        if (i < end)
            CHECK(batch->pieces == PIECES && batch->judged == 1);
        if (is_read && i < end)
            CHECK(batch->seen == total_before(i, places));
    }
    CHECK(trial.total == end * (end + 1) / 2 && (end < 2 || trial.moves > 1));
}

int main(void)
{
    static const uint32_t team_sizes[] = {1, 2, 7}, place_counts[] = {1, 2, 3, 7}, counts[] = {0, 1, 2, 13, 256};
    for (uint32_t i = 0; i < 3; i++) {
        MesoTeam *team = meso_team_begin(team_sizes[i]);
        for (uint32_t p = 0; p < 4; p++)
            for (uint32_t k = 0; k < 5; k++)
                for (uint32_t read = 0; read < 2; read++) {
                    check_relay(team, place_counts[p], counts[k], read, UINT32_MAX, UINT32_MAX);
                    check_relay(team, place_counts[p], counts[k], read, counts[k] / 2, UINT32_MAX);
                    check_relay(team, place_counts[p], counts[k], read, UINT32_MAX, counts[k] / 3);
                }
        for (uint32_t p = 0; p < 4; p++)
            check_relay(team, place_counts[p], MOST, p % 2, UINT32_MAX, UINT32_MAX);
        meso_team_end(team);
    }
    return 0;
}
