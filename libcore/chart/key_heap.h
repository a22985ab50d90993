/* Numbers by ascending keys, equal ones by number: a binary heap on an arena. */
#ifndef MESO_KEY_HEAP_H
#define MESO_KEY_HEAP_H

#include <stdbool.h>

#include "libcore/base/grow.h"

typedef struct MesoHeapEntry {
    double key;
    uint32_t item;
} MesoHeapEntry;

/* Empty when zero. */
typedef struct MesoKeyHeap {
    uint32_t count, room;
    MesoHeapEntry *entries;     /* [room] */
} MesoKeyHeap;

static inline bool meso_heap_before(MesoHeapEntry a, MesoHeapEntry b)
{
    return a.key < b.key || (a.key == b.key && a.item < b.item);
}

/* An item may lie in it several times. O(log count). MESO_ERR_MEMORY alone. */
static inline MesoStatus meso_heap_push(MesoKeyHeap *heap, MesoArena *arena, double key, uint32_t item,
                                        MesoError *error)
{
    heap->entries = MESO_GROW(arena, heap->entries, heap->count, heap->room, 256, error);
    if (!heap->entries)
        return MESO_ERR_MEMORY;
    MesoHeapEntry entry = {key, item};
    uint32_t at = heap->count++;
    while (at > 0 && meso_heap_before(entry, heap->entries[(at - 1) / 2])) {
        heap->entries[at] = heap->entries[(at - 1) / 2];
        at = (at - 1) / 2;
    }
    heap->entries[at] = entry;
    return MESO_OK;
}

/* The first; the heap is not empty. O(log count). */
static inline MesoHeapEntry meso_heap_pop(MesoKeyHeap *heap)
{
    MesoHeapEntry first = heap->entries[0], last = heap->entries[--heap->count];
    uint32_t at = 0;
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child + 1 < heap->count && meso_heap_before(heap->entries[child + 1], heap->entries[child]))
            child++;
        if (child >= heap->count || !meso_heap_before(heap->entries[child], last))
            break;
        heap->entries[at] = heap->entries[child];
        at = child;
    }
    heap->entries[at] = last;
    return first;
}

#endif
