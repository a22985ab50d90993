/* Work list of a propagation: a ring of slots, first in, first out; each stands in it once at most. */
#ifndef MESO_WORK_LIST_H
#define MESO_WORK_LIST_H

#include <stdint.h>

typedef struct MesoWorkList {
    uint32_t *slots;            /* [size] */
    uint32_t size, head, count;
} MesoWorkList;

static inline void meso_work_list_push(MesoWorkList *list, uint32_t slot)
{
    uint32_t end = list->head + list->count++;
    list->slots[end < list->size ? end : end - list->size] = slot;
}

/* There must be one. */
static inline uint32_t meso_work_list_pop(MesoWorkList *list)
{
    uint32_t slot = list->slots[list->head++];
    if (list->head == list->size)
        list->head = 0;
    if (--list->count == 0)
        list->head = 0;
    return slot;
}

#endif
