/*
 * For programs that give back memory and soon take as much again, as pictures do from tile to tile and from band to
 * band: glibc would hand it to the system, and get it anew page by page, each a fault. Here blocks of up to 32 MiB come
 * from what has been given back, and up to 64 MiB of that stay; all threads share it, and what comes first lies in
 * large pages (large_pages.h), where the system has them. To be called first of all. Elsewhere nothing changes.
 */
#ifndef MESO_KEPT_MEMORY_H
#define MESO_KEPT_MEMORY_H

void meso_kept_memory(void);

/* More of it, some 93 MiB in large pages: for what a driver takes. */
void meso_kept_memory_more(void);

#endif
