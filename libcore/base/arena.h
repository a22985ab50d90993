/*
 * Arena: results live here until the whole arena goes. The caller of a
 * function owns the arena; the function allocates its results from it and
 * rewinds its scratch before it returns.
 */
#ifndef MESO_ARENA_H
#define MESO_ARENA_H

#include <stdbool.h>
#include <stddef.h>

#include "libcore/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct MesoArenaBlock MesoArenaBlock;

typedef struct MesoArena {
    MesoArenaBlock *head;   /* newest block */
    size_t used;            /* bytes handed out, all blocks */
    size_t most;            /* that have been at once since it was empty */
} MesoArena;

typedef struct MesoArenaMark {
    MesoArenaBlock *block;
    size_t block_used;
    size_t used;
} MesoArenaMark;

void meso_arena_init(MesoArena *arena);

/* Frees everything. `arena` may be used again as after meso_arena_init(). */
void meso_arena_release(MesoArena *arena);

/* Gives all back but one block, so large that the same again finds room in it: for scratch that comes in rounds. */
void meso_arena_clear(MesoArena *arena);

/* Gives back what it has beyond what is allocated now, as far as that is in large pages, until it is used again. */
void meso_arena_trim(MesoArena *arena);

/*
 * What is allocated next, up to `size` bytes with every allocation rounded up to 64, comes from one block in large
 * pages: several arrays of some hundred KiB, which would be in small pages each, are sooner had so. Nothing where it is
 * little, or memory is out: allocations tell that.
 */
void meso_arena_reserve(MesoArena *arena, size_t size);

/*
 * Returns `count * size` zeroed bytes, aligned to 64; for a count of 0 a
 * pointer that must not be read. Returns NULL and fills `error` with
 * MESO_ERR_MEMORY when the product overflows or memory is out. Not to be
 * called from two threads on one arena. O(count * size).
 */
void *meso_arena_alloc(MesoArena *arena, size_t count, size_t size, MesoError *error);

/* `count` zeroed elements of `type`, or NULL with `error` filled. */
#define MESO_NEW(arena, type, count, error) \
    ((type *)meso_arena_alloc((arena), (count), sizeof(type), (error)))

/* The same, but of any content: for arrays that are written to before they are read, and are large. O(1). */
void *meso_arena_alloc_bare(MesoArena *arena, size_t count, size_t size, MesoError *error);

/* `count` elements of `type` that are not set, or NULL with `error` filled. */
#define MESO_NEW_BARE(arena, type, count, error) \
    ((type *)meso_arena_alloc_bare((arena), (count), sizeof(type), (error)))

/* Copies `text` with its terminating zero; NULL on failure as above. */
char *meso_arena_copy_text(MesoArena *arena, const char *text, MesoError *error);

/* Printf into the arena; NULL on failure as above. */
char *meso_arena_print(MesoArena *arena, MesoError *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/*
 * Takes over a block of malloc(), as if it had been allocated here now. False with MESO_ERR_MEMORY in `error`, and the
 * block still the caller's, where memory is out.
 */
bool meso_arena_adopt(MesoArena *arena, void *block, MesoError *error);

/* What is allocated after `mark` is given back by the rewind to it. */
MesoArenaMark meso_arena_mark(const MesoArena *arena);
void meso_arena_rewind(MesoArena *arena, MesoArenaMark mark);

#ifdef __cplusplus
}
#endif

#endif
