#define _DEFAULT_SOURCE     /* madvise() */
#include "libcore/base/large_pages.h"

#include <stdint.h>
#include <sys/mman.h>

enum { LARGE_PAGE = 1 << 21, PAGE = 1 << 12 };

static size_t round_up(size_t size, size_t unit)
{
    return (size + unit - 1) & ~(unit - 1);
}

static unsigned char *map(size_t size)
{
    void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return memory == MAP_FAILED ? NULL : memory;
}

/* From more than that, what begins with a large page. */
static unsigned char *map_along_pages(size_t size)
{
    unsigned char *all = map(size + LARGE_PAGE);
    if (!all)
        return NULL;
    size_t before = (size_t)(-(uintptr_t)all & (LARGE_PAGE - 1)), behind = LARGE_PAGE - before;
    if (before)
        munmap(all, before);
    if (behind)
        munmap(all + before + size, behind);
    return all + before;
}

/* Where the system has none, nothing changes. */
static void ask_for_large_pages(void *memory, size_t size)
{
#ifdef MADV_HUGEPAGE
    madvise(memory, size / LARGE_PAGE * LARGE_PAGE, MADV_HUGEPAGE);
#else
    (void)memory;
    (void)size;
#endif
}

void *meso_large_take(size_t *size)
{
    if (*size > SIZE_MAX / 2)
        return NULL;
    size_t whole = round_up(*size, LARGE_PAGE), wanted = (whole - *size) <= whole / 4 ? whole : round_up(*size, PAGE);
    unsigned char *memory = wanted >= LARGE_PAGE ? map_along_pages(wanted) : NULL;
    if (memory)
        ask_for_large_pages(memory, wanted);
    else
        memory = map(wanted);
    *size = wanted;
    return memory;
}

size_t meso_large_drop(void *memory, size_t size)
{
    size_t before = (size_t)(-(uintptr_t)memory & (LARGE_PAGE - 1));
    if (size <= before || (size - before) % LARGE_PAGE)
        return size;
    return madvise((unsigned char *)memory + before, size - before, MADV_DONTNEED) == 0 ? before : size;
}

void meso_large_give(void *memory, size_t size)
{
    if (memory)
        munmap(memory, size);
}
