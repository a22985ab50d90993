/* Arrays of the heap that grow: what is written to as growth goes on must not be copied, or lie about, in an arena. */
#ifndef MESO_GROWTH_ROOM_H
#define MESO_GROWTH_ROOM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* Room for `count` elements of `size` bytes, and for half as many again where it must move; false: out of memory, or
 * of numbers, and nothing has changed. New elements are not set. */
static inline bool meso_make_room(void **array, uint32_t *room, uint64_t count, size_t size)
{
    if (count <= *room)
        return true;
    uint64_t more = count + count / 2 + 64;
    if (count >= INT32_MAX)
        return false;
    void *larger = realloc(*array, (size_t)more * size);
    if (!larger)
        return false;
    *array = larger;
    *room = (uint32_t)more;
    return true;
}

#endif
