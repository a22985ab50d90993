#define _DEFAULT_SOURCE     /* madvise() */
#include "libcore/base/kept_memory.h"

#include <stdint.h>
#include <stdlib.h>

#ifdef __GLIBC__

#include <malloc.h>
#include <sys/mman.h>

enum { MAPPED = 1 << 25, KEPT = 1 << 26, ROOM = MAPPED - (1 << 20), LARGE_PAGE = 1 << 21 };

/* The heap grows once, by all that this takes, and stays so large: it has no page of that before it is written to. */
static void make_room(void)
{
    unsigned char *room = malloc(ROOM);
#ifdef MADV_HUGEPAGE
    size_t before = (size_t)(-(uintptr_t)room & (LARGE_PAGE - 1));
    if (room)
        madvise(room + before, (ROOM - before) / LARGE_PAGE * LARGE_PAGE, MADV_HUGEPAGE);
#endif
    free(room);
}

void meso_kept_memory(void)
{
    mallopt(M_MMAP_THRESHOLD, MAPPED);
    mallopt(M_TRIM_THRESHOLD, KEPT);
    mallopt(M_ARENA_MAX, 1);        /* other threads' heaps would grow page by page */
    make_room();
}

#else

void meso_kept_memory(void)
{
}

#endif
