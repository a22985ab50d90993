/* Arrays that grow: twice the room where they are full; the old one stays in the arena until that goes. */
#ifndef MESO_GROW_H
#define MESO_GROW_H

#include <string.h>

#include "libcore/base/arena.h"

/* A copy of `array` [count] with `room` elements of `size` bytes; NULL with `error` filled where memory is out. */
static inline void *meso_arena_enlarge(MesoArena *arena, const void *array, size_t count, size_t room, size_t size,
                                       MesoError *error)
{
    if (room <= count) {    /* the number of elements has overflown */
        meso_fail(error, MESO_ERR_MEMORY, "out of memory: more than %zu elements", count);
        return NULL;
    }
    void *larger = meso_arena_alloc(arena, room, size, error);
    if (larger && count)
        memcpy(larger, array, count * size);
    return larger;
}

/*
 * The array with room for one more element, and `room` what there is now, at first `least`:
 *
 *     trail = MESO_GROW(arena, trail, count, room, 1024, error);
 *     if (!trail)
 *         return MESO_ERR_MEMORY;
 *     trail[count++] = ...;
 */
#define MESO_GROW(arena, array, count, room, least, error)                                        \
    ((count) < (room) ? (array)                                                                    \
                      : meso_arena_enlarge((arena), (array), (count), (room) = (room) ? 2 * (room) : (least), \
                                           sizeof *(array), (error)))

#endif
