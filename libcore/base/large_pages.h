/*
 * Memory from the system for large arrays, in its large pages where it has them: few faults, and few misses of the
 * table of pages. On x86-64 a large page has 2 MiB; Linux takes some milliseconds to hand over as much in small ones.
 */
#ifndef MESO_LARGE_PAGES_H
#define MESO_LARGE_PAGES_H

#include <stddef.h>

/*
 * At least `*size` zeroed bytes, which becomes what there is: whole large pages, where no more than a quarter of that
 * is for nothing, or as little as the system hands out. The memory begins with a large page where there is one in it.
 * It takes room once it is written to. NULL where memory is out.
 */
void *meso_large_take(size_t *size);

/*
 * Gives back for now what lies behind the first large page that begins among `size` bytes, up to the end of what
 * meso_large_take() has returned: it is zero then, and takes room again once it is written to. Only where all of it is
 * large pages. Returns how many bytes at the front stay as they were.
 */
size_t meso_large_drop(void *memory, size_t size);

/* Gives back what meso_large_take() has returned, with the size that it said; nothing where it is NULL. */
void meso_large_give(void *memory, size_t size);

#endif
