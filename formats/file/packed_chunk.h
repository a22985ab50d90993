/*
 * Packed chunks of containers: whole numbers in rows, as
 *
 *     u32 bytes a number: 2 or 4;  u32 numbers a row;  u32 1 where they are differences to the row before;  u32 0;
 *     u64 size;  a zlib stream of that size: first all lowest bytes of the first numbers of rows, then their next
 *     bytes, then those of the second numbers, and so on
 *
 * each number twice as far from 0, less 1 where it is below: -1 is 1, 1 is 2. It comes back bit for bit.
 */
#ifndef MESO_PACKED_CHUNK_H
#define MESO_PACKED_CHUNK_H

#include "formats/file/container.h"
#include "libcore/base/arena.h"

typedef struct MesoPacking {
    uint32_t number_bytes, row;
    bool differences;
} MesoPacking;

/* Adds a chunk with `data` [size] packed, in `arena`. O(size). MESO_ERR_MEMORY alone. */
MesoStatus meso_packed_add(MesoContainer *container, MesoArena *arena, const char *name, const void *data,
                           uint64_t size, MesoPacking packing, MesoError *error);

/*
 * Puts what the chunk `packed` holds in its place, as a chunk `name`, in `arena`; nothing where there is no such chunk.
 * MESO_ERR_INPUT, with the path and the chunk, where it cannot have been made by the above.
 */
MesoStatus meso_packed_open(MesoContainer *container, MesoArena *arena, const char *path, const char *packed,
                            const char *name, MesoError *error);

#endif
