/*
 * Batches that go through stages, by several threads, which hand on to each other what must be in order. A batch stays
 * with one thread as a rule: what comes from the memory of another takes long.
 *
 *     draft    what asks for nothing that others do, piece by piece: threads that wait do a piece of their next batch
 *     judge    what may read what is admitted
 *     admit    one batch after another, in their order
 *     write    down what is admitted; all at the same time
 *
 * Batches come in windows of one for each place. Where what is admitted is read, batches are judged when all of the
 * windows before theirs are admitted, and admitted when all of their own are judged: so nothing changes meanwhile.
 * Otherwise they are judged as soon as they are drafted.
 */
#ifndef MESO_BATCH_RELAY_H
#define MESO_BATCH_RELAY_H

#include <stdatomic.h>
#include <stdbool.h>

#include "libcore/base/team.h"

/* How often the thread of a place has looked whether there is anything to do: in a line of memory of its own. */
typedef struct MesoBatchIdle {
    _Alignas(64) _Atomic uint64_t looks;
} MesoBatchIdle;

typedef struct MesoBatchRelay {
    void *context;
    uint32_t place_count;       /* batches of a window: no more than threads that can run at once */
    uint32_t batch_count;       /* of all windows; a window is full but for the last */
    bool is_read;               /* what is admitted is read by those that judge */
    bool (*draft)(void *context, uint32_t batch);   /* a piece; true with the last */
    void (*judge)(void *context, uint32_t batch);
    bool (*has_room)(void *context, uint32_t batch);    /* for what admit() and write() add */
    bool (*make_room)(void *context, uint32_t batch);   /* while nothing else is done; false: out of memory */
    bool (*admit)(void *context, uint32_t batch);   /* false: it is the last that is admitted, if only a part of it */
    void (*write)(void *context, uint32_t batch);   /* what admit() was called for, then, too */
    MesoBatchIdle *idle;        /* [place_count] is added to; may be NULL */
} MesoBatchRelay;

/*
 * Calls draft() until it is done, judge(), admit() and write() for every batch, in this order, from one thread; unless
 * admit() or make_room() says that it is over. What two windows after a batch's comes to is not begun before that is
 * written: two windows' memory does. The batch of a place in its window is one thread's as a rule; what that does not
 * come to, since the machine has other things to do, is taken over. False where memory is out.
 */
bool meso_batch_relay(MesoTeam *team, const MesoBatchRelay *relay);

#endif
