/*
 * Loaded before a tool (LD_PRELOAD), lets allocations fail:
 *
 *     FAIL_MALLOC=N            the N-th, counted from 1
 *     FAIL_MALLOC=N+           the N-th and all that follow
 *     FAIL_MALLOC_COUNT=FILE   how many there were goes there at the end
 *
 * Counting starts when all libraries have been loaded: what their constructors
 * do without memory is not the tool's. Threads share the count, so that only
 * work on one thread counts the same every time.
 */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* The GNU library's own, under names that nobody replaces. */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static atomic_bool counting;
static atomic_ulong count;
static unsigned long first = ULONG_MAX, last = ULONG_MAX;

/* Says whether this one fails. */
static bool fails(void)
{
    if (!atomic_load(&counting))
        return false;
    unsigned long number = atomic_fetch_add(&count, 1) + 1;
    if (number < first || number > last)
        return false;
    errno = ENOMEM;
    return true;
}

__attribute__((constructor)) static void begin(void)
{
    const char *wanted = getenv("FAIL_MALLOC");
    char *end;
    if (wanted && *wanted) {
        first = last = strtoul(wanted, &end, 10);
        if (*end == '+')
            last = ULONG_MAX;
    }
    atomic_store(&counting, true);
}

__attribute__((destructor)) static void tell(void)
{
    atomic_store(&counting, false);
    const char *path = getenv("FAIL_MALLOC_COUNT");
    int file = path ? open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666) : -1;
    if (file < 0)
        return;
    dprintf(file, "%lu\n", atomic_load(&count));
    close(file);
}

void *malloc(size_t size)
{
    return fails() ? NULL : __libc_malloc(size);
}

void *calloc(size_t number, size_t size)
{
    return fails() ? NULL : __libc_calloc(number, size);
}

void *realloc(void *memory, size_t size)
{
    return fails() ? NULL : __libc_realloc(memory, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return fails() ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    *memory = fails() ? NULL : __libc_memalign(alignment, size);
    return *memory ? 0 : ENOMEM;
}
