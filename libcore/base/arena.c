#include "libcore/base/arena.h"

#include <assert.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/large_pages.h"

/*
 * The first block of an arena is of the least size, and each other as large as all before it, up to the most: many
 * arenas are little, and zeroing a large block for each took longer than their work. The address sanitizer gets each
 * larger block from the system, and gives it back: tests took twenty times as long.
 */
enum { BLOCK_LEAST = 1 << 14 };
#ifdef __SANITIZE_ADDRESS__
enum { BLOCK_MOST = 1 << 15 };
#else
enum { BLOCK_MOST = 1 << 18 };
#endif

enum { ALIGNMENT = 64 };

/*
 * Blocks of that size come from the system, and go back to it: malloc() would keep what it once had, in pieces that
 * nothing else fits into.
 */
enum { MAPPED_SIZE = 3 << 19 };

/* From this size on a large page is sooner had than small ones. */
enum { RESERVED_SIZE = 48 << 12 };

struct MesoArenaBlock {
    MesoArenaBlock *previous;
    unsigned char *data;    /* aligned, inside the allocation */
    size_t size;
    size_t used;
    size_t dirty;           /* bytes that were handed out once: not zero now */
    void *adopted;          /* from elsewhere; the block has no room then */
    size_t mapped;          /* bytes from the system; 0: by malloc() */
};

static size_t round_up(size_t size)
{
    return (size + ALIGNMENT - 1) & ~(size_t)(ALIGNMENT - 1);
}

/* Zero; by calloc(), or in fresh pages. */
static MesoArenaBlock *take_room(size_t size)
{
    if (size < MAPPED_SIZE)
        return calloc(1, size);
    MesoArenaBlock *block = meso_large_take(&size);
    if (block)
        block->mapped = size;
    return block;
}

static MesoArenaBlock *new_block(size_t size)
{
    size_t header = round_up(sizeof(MesoArenaBlock));
    if (size > SIZE_MAX - header - ALIGNMENT)
        return NULL;
    MesoArenaBlock *block = take_room(header + size + ALIGNMENT);
    if (!block)
        return NULL;
    block->data = (unsigned char *)round_up((uintptr_t)block + header);
    block->size = block->mapped ? block->mapped - header - ALIGNMENT : size;
    return block;
}

static void free_block(MesoArenaBlock *block)
{
    free(block->adopted);
    if (block->mapped)
        meso_large_give(block, block->mapped);
    else
        free(block);
}

void meso_arena_init(MesoArena *arena)
{
    *arena = (MesoArena){0};
}

void meso_arena_release(MesoArena *arena)
{
    meso_arena_rewind(arena, (MesoArenaMark){0});
    arena->most = 0;
}

void meso_arena_clear(MesoArena *arena)
{
    size_t most = arena->most;
    MesoArenaBlock *block = arena->head;
    if (block && !block->previous && !block->adopted && block->size >= most)
        meso_arena_rewind(arena, (MesoArenaMark){block, 0, 0});
    else
        meso_arena_release(arena);
    if (!arena->head && most)
        arena->head = new_block(most + most / 8);   /* no more than a wish */
    arena->most = 0;
}

void meso_arena_trim(MesoArena *arena)
{
    MesoArenaBlock *block = arena->head;
    if (!block || !block->mapped || block->dirty <= block->used)
        return;
    size_t behind = (size_t)((unsigned char *)block + block->mapped - (block->data + block->used));
    size_t kept = block->used + meso_large_drop(block->data + block->used, behind);
    block->dirty = kept < block->dirty ? kept : block->dirty;
}

/* Of any content; `stale`: bytes at the front that may not be zero. */
static unsigned char *take(MesoArena *arena, size_t count, size_t size, size_t *stale, MesoError *error)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > SIZE_MAX / 2) {
        meso_fail(error, MESO_ERR_MEMORY, "out of memory: %zu items of %zu bytes", count, size);
        return NULL;
    }
    bytes = round_up(bytes ? bytes : 1);

    MesoArenaBlock *block = arena->head;
    if (!block || block->size - block->used < bytes) {
        size_t usual = arena->used < BLOCK_LEAST ? BLOCK_LEAST : arena->used > BLOCK_MOST ? BLOCK_MOST : arena->used;
        block = new_block(bytes > usual ? bytes : usual);
        if (!block) {
            meso_fail(error, MESO_ERR_MEMORY, "out of memory: %zu bytes", bytes);
            return NULL;
        }
        block->previous = arena->head;
        arena->head = block;
    }

    unsigned char *data = block->data + block->used;
    size_t dirty = block->used < block->dirty ? block->dirty - block->used : 0;
    *stale = dirty < bytes ? dirty : bytes;
    block->used += bytes;
    if (block->used > block->dirty)
        block->dirty = block->used;
    arena->used += bytes;
    arena->most = arena->used > arena->most ? arena->used : arena->most;
    return data;
}

void *meso_arena_alloc(MesoArena *arena, size_t count, size_t size, MesoError *error)
{
    size_t stale;
    unsigned char *data = take(arena, count, size, &stale, error);
    if (data && stale)
        memset(data, 0, stale);
    return data;
}

void *meso_arena_alloc_bare(MesoArena *arena, size_t count, size_t size, MesoError *error)
{
    size_t stale;
    unsigned char *data = take(arena, count, size, &stale, error);
#ifdef __SANITIZE_ADDRESS__
    if (data)
        memset(data, 0xa5, count * size);   /* so that tests fail where it is read too early */
#endif
    return data;
}

void meso_arena_reserve(MesoArena *arena, size_t size)
{
    MesoArenaBlock *block = arena->head;
    if (size < RESERVED_SIZE || (block && block->size - block->used >= size) || size > SIZE_MAX / 2)
        return;
    size_t large = size < MAPPED_SIZE ? MAPPED_SIZE : size;
    block = new_block(large);
    if (!block)
        return;
    block->previous = arena->head;
    arena->head = block;
}

bool meso_arena_adopt(MesoArena *arena, void *adopted, MesoError *error)
{
    MesoArenaBlock *block = calloc(1, sizeof *block);
    if (!block) {
        meso_fail(error, MESO_ERR_MEMORY, "out of memory: %zu bytes", sizeof *block);
        return false;
    }
    block->adopted = adopted;
    block->previous = arena->head;
    arena->head = block;
    return true;
}

char *meso_arena_copy_text(MesoArena *arena, const char *text, MesoError *error)
{
    size_t size = strlen(text) + 1;
    char *copy = MESO_NEW(arena, char, size, error);
    return copy ? memcpy(copy, text, size) : NULL;
}

char *meso_arena_print(MesoArena *arena, MesoError *error, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    assert(length >= 0);
    char *text = MESO_NEW(arena, char, (size_t)length + 1, error);
    if (text)
        vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    return text;
}

MesoArenaMark meso_arena_mark(const MesoArena *arena)
{
    return (MesoArenaMark){arena->head, arena->head ? arena->head->used : 0, arena->used};
}

void meso_arena_rewind(MesoArena *arena, MesoArenaMark mark)
{
    while (arena->head != mark.block) {
        MesoArenaBlock *block = arena->head;
        assert(block);
        arena->head = block->previous;
        free_block(block);
    }
    if (arena->head)
        arena->head->used = mark.block_used;
    arena->used = mark.used;
}
