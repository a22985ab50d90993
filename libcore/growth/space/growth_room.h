/* Arrays of the heap that grow: what is written to as growth goes on must not be copied, or lie about, in an arena. */
#ifndef MESO_GROWTH_ROOM_H
#define MESO_GROWTH_ROOM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * Room for `count` elements of `size` bytes, and for many more where the array must move: pages that are not written to
 * cost nothing. False: out of memory, or of numbers, and nothing has changed. New elements are not set.
 */
bool meso_make_more_room(void **array, uint32_t *room, uint64_t count, size_t size);

static inline bool meso_make_room(void **array, uint32_t *room, uint64_t count, size_t size)
{
    return count <= *room || meso_make_more_room(array, room, count, size);
}

#endif
