#define _DEFAULT_SOURCE     /* madvise() */
#include "libcore/growth/engine/growth_room.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/*
 * Large pages, from this many bytes on: fewer faults, and fewer misses of the table of pages. From REMAPPED on,
 * realloc() moves pages and copies nothing, but small ones: below it is better to copy.
 */
enum { LARGE_PAGE = 1 << 21, LARGE = LARGE_PAGE, REMAPPED = 512 * LARGE_PAGE };

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

/* Large pages are asked for before the first copy: pages that have been written to stay small. */
static void *move(void *array, size_t bytes, size_t more)
{
    if (more < LARGE || bytes >= REMAPPED) {
        void *larger = realloc(array, more);
        if (larger)
            ask_for_large_pages(larger, more);
        return larger;
    }
    void *larger = aligned_alloc(LARGE_PAGE, (more + LARGE_PAGE - 1) & ~(size_t)(LARGE_PAGE - 1));
    if (!larger)
        return NULL;
    ask_for_large_pages(larger, more);
    if (bytes)
        memcpy(larger, array, bytes);
    free(array);
    return larger;
}

bool meso_make_more_room(void **array, uint32_t *room, uint64_t count, size_t size)
{
    enum { FEW = 1 << 16, AHEAD = 16 };
    uint64_t more = count < FEW ? AHEAD * count + 64 : AHEAD * AHEAD * FEW;
    if (count > INT32_MAX)
        return false;
    more = more < AHEAD * count / 8 ? AHEAD * count / 8 : more;
    void *larger = move(*array, *room * size, (size_t)more * size);
    /* where so much cannot be had, even of what is not written to */
    if (!larger && more > count + count / 8) {
        more = count + count / 8;
        larger = move(*array, *room * size, (size_t)more * size);
    }
    if (!larger)
        return false;
    *array = larger;
    *room = more < UINT32_MAX ? (uint32_t)more : UINT32_MAX;
    return true;
}
