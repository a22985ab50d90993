#define _DEFAULT_SOURCE     /* madvise() */
#include "libcore/base/kept_memory.h"

#include <stdint.h>
#include <stdlib.h>

#ifdef __GLIBC__

#include <malloc.h>
#include <sys/mman.h>

enum { MAPPED = 1 << 25, KEPT = 1 << 26, ROOM = MAPPED - (1 << 20), LARGE_PAGE = 1 << 21, MORE = 3 };

static unsigned char *take_room(void)
{
    unsigned char *room = malloc(ROOM);
#ifdef MADV_HUGEPAGE
    size_t before = (size_t)(-(uintptr_t)room & (LARGE_PAGE - 1));
    if (room)
        madvise(room + before, (ROOM - before) / LARGE_PAGE * LARGE_PAGE, MADV_HUGEPAGE);
#endif
    return room;
}

void meso_kept_memory(void)
{
    mallopt(M_MMAP_THRESHOLD, MAPPED);
    mallopt(M_TRIM_THRESHOLD, KEPT);
    mallopt(M_ARENA_MAX, 1);        /* other threads' heaps would grow page by page */
    free(take_room());
}

/* The heap grows by all that this takes, and stays so large: it has no page of that before it is written to. */
void meso_kept_memory_more(void)
{
    unsigned char *rooms[MORE];
    mallopt(M_TRIM_THRESHOLD, KEPT + MORE * ROOM);
    for (int i = 0; i < MORE; i++)
        rooms[i] = take_room();
    for (int i = MORE; i-- > 0;)
        free(rooms[i]);
}

#else

void meso_kept_memory(void)
{
}

void meso_kept_memory_more(void)
{
}

#endif
