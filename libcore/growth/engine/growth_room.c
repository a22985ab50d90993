#define _DEFAULT_SOURCE     /* madvise() */
#include "libcore/growth/engine/growth_room.h"

#include <stdlib.h>
#include <sys/mman.h>

/* Large pages, from this many bytes on: fewer faults. */
enum { LARGE_PAGE = 1 << 21, LARGE = 4 * LARGE_PAGE };

static void ask_for_large_pages(void *array, size_t bytes)
{
#ifdef MADV_HUGEPAGE
    uintptr_t begin = ((uintptr_t)array + LARGE_PAGE - 1) & ~(uintptr_t)(LARGE_PAGE - 1);
    uintptr_t end = ((uintptr_t)array + bytes) & ~(uintptr_t)(LARGE_PAGE - 1);
    if (bytes >= LARGE && begin < end)
        madvise((void *)begin, end - begin, MADV_HUGEPAGE);
#else
    (void)array, (void)bytes;
#endif
}

bool meso_make_more_room(void **array, uint32_t *room, uint64_t count, size_t size)
{
    enum { MANY = 1 << 20 };
    uint64_t more = count < MANY / 16 ? 16 * count + 64 : count < MANY ? 2 * MANY : 2 * count;
    if (count > INT32_MAX)
        return false;
    void *larger = realloc(*array, (size_t)more * size);
    if (!larger)
        return false;
    ask_for_large_pages(larger, (size_t)more * size);
    *array = larger;
    *room = more < UINT32_MAX ? (uint32_t)more : UINT32_MAX;
    return true;
}
