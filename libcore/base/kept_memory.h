/*
 * For programs that give back memory and soon take as much again, as pictures do from tile to tile and from band to
 * band: glibc would hand it to the system, and get it anew page by page, each a fault. Here blocks of up to 32 MiB come
 * from what has been given back, and up to 64 MiB of that stay with each of glibc's heaps. To be called first of all.
 * Elsewhere nothing changes.
 */
#ifndef MESO_KEPT_MEMORY_H
#define MESO_KEPT_MEMORY_H

#include <stdlib.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

static inline void meso_kept_memory(void)
{
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 1 << 25);
    mallopt(M_TRIM_THRESHOLD, 1 << 26);
#endif
}

#endif
