#define _DEFAULT_SOURCE     /* madvise() */
#include "libcore/growth/space/growth_room.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/*
 * Large pages, whole ones, from this many bytes on: fewer faults, which are dear, and fewer misses of the table of
 * pages. Some fifty small pages take as long to come by as a large one. There are so many of them that few arrays ever
 * move again. From REMAPPED on, realloc() moves pages and copies nothing, but small ones: below it is better to copy.
 */
enum { LARGE_PAGE = 1 << 21, LARGE = 48 << 12, FIRST_PAGES = 16, REMAPPED = 512 * LARGE_PAGE };

static size_t whole_pages(size_t bytes)
{
    return (bytes + LARGE_PAGE - 1) & ~(size_t)(LARGE_PAGE - 1);
}

static size_t with_room(size_t bytes)
{
    return bytes < LARGE ? bytes : whole_pages(bytes < FIRST_PAGES * LARGE_PAGE ? FIRST_PAGES * LARGE_PAGE : bytes);
}

static size_t with_little_room(size_t bytes)
{
    return bytes < LARGE ? bytes : whole_pages(bytes);
}

static void ask_for_large_pages(void *array, size_t bytes)
{
#ifdef MADV_HUGEPAGE
    uintptr_t begin = ((uintptr_t)array + LARGE_PAGE - 1) & ~(uintptr_t)(LARGE_PAGE - 1);
    uintptr_t end = ((uintptr_t)array + bytes) & ~(uintptr_t)(LARGE_PAGE - 1);
    if (begin < end)
        madvise((void *)begin, end - begin, MADV_HUGEPAGE);
#else
    (void)array, (void)bytes;
#endif
}

/* Large pages are asked for before the first copy: pages that have been written to stay small. */
static void *move(void *array, size_t bytes, size_t more)
{
    if (more < LARGE)
        return realloc(array, more);
    if (bytes >= REMAPPED) {
        void *larger = realloc(array, more);
        if (larger)
            ask_for_large_pages(larger, more);
        return larger;
    }
    void *larger = aligned_alloc(LARGE_PAGE, more);
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
    size_t bytes = with_room((size_t)more * size);
    void *larger = move(*array, *room * size, bytes);
    /* where so much cannot be had, even of what is not written to */
    if (!larger && bytes > with_little_room((size_t)(count + count / 8) * size)) {
        bytes = with_little_room((size_t)(count + count / 8) * size);
        larger = move(*array, *room * size, bytes);
    }
    if (!larger)
        return false;
    *array = larger;
    *room = bytes / size < UINT32_MAX ? (uint32_t)(bytes / size) : UINT32_MAX;
    return true;
}
