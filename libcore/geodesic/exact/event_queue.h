/*
 * What happens next, by a key: a heap with four below each. Equal keys come in an order that depends on nothing else.
 */
#ifndef MESO_EVENT_QUEUE_H
#define MESO_EVENT_QUEUE_H

#include "libcore/base/grow.h"
#include "libcore/base/index.h"

typedef struct MesoEvent {
    double key;
    uint32_t item, kind;        /* the caller's */
} MesoEvent;

/* Grows in an arena; zero is empty. */
typedef struct MesoEventQueue {
    MesoEvent *events;
    uint32_t count, room;
} MesoEventQueue;

/* MESO_ERR_MEMORY alone. O(log n). */
static inline MesoStatus meso_event_push(MesoEventQueue *queue, MesoArena *arena, MesoEvent event, MesoError *error)
{
    queue->events = MESO_GROW(arena, queue->events, queue->count, queue->room, 1024, error);
    if (!queue->events)
        return MESO_ERR_MEMORY;
    uint32_t i = queue->count++;
    for (uint32_t up; i > 0 && event.key < queue->events[up = (i - 1) / 4].key; i = up)
        queue->events[i] = queue->events[up];
    queue->events[i] = event;
    return MESO_OK;
}

/* Takes the one with the least key; there must be one. O(log n). */
static inline MesoEvent meso_event_pop(MesoEventQueue *queue)
{
    MesoEvent *events = queue->events, least = events[0], last = events[--queue->count];
    uint32_t count = queue->count, i = 0;
    for (uint32_t down; (down = 4 * i + 1) < count; i = down) {
        uint32_t end = down + 4 < count ? down + 4 : count;
        for (uint32_t k = down + 1; k < end; k++)
            down = events[k].key < events[down].key ? k : down;
        if (!(events[down].key < last.key))
            break;
        events[i] = events[down];
    }
    events[i] = last;
    return least;
}

#endif
