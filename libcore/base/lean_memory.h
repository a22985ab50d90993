/*
 * For programs whose threads take and give back much memory: glibc keeps what was given back, for each thread apart and
 * in pieces, half as much again as is in use. Here blocks from 384 KiB on come from the system and go back to it, and
 * all threads share what is smaller. To be called first of all. Elsewhere nothing changes.
 */
#ifndef MESO_LEAN_MEMORY_H
#define MESO_LEAN_MEMORY_H

#include <stdlib.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

static inline void meso_lean_memory(void)
{
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 3 << 17);
    mallopt(M_TRIM_THRESHOLD, 1 << 22);
    mallopt(M_ARENA_MAX, 1);
#endif
}

#endif
