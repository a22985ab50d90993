/*
 * Container of .slots and .meso files, little-endian:
 *
 *     header   64 bytes: magic "MESOFILE", kind[8] ("slots", "model"), u32 endian tag
 *              0x01020304, u16 major, u16 minor, u32 chunk count, u32 0, u64 file size,
 *              u64 XXH3-64 of the chunk table, 8 bytes 0, u64 XXH3-64 of bytes 0..55
 *     table    per chunk 32 bytes: name[8], u64 offset, u64 length, u64 XXH3-64 of the data
 *     chunks   each at the first multiple of 64 after the one before, zero bytes between
 *
 * Every byte is covered: by a checksum, or by the rule that it is zero.
 */
#ifndef MESO_CONTAINER_H
#define MESO_CONTAINER_H

#include "formats/file/input.h"
#include "formats/file/output.h"

enum { MESO_CONTAINER_CHUNKS = 64, MESO_CHUNK_NAME = 8 };

typedef struct MesoChunk {
    char name[MESO_CHUNK_NAME + 1];
    const void *data;   /* 64-byte aligned within the file */
    uint64_t size;
} MesoChunk;

typedef struct MesoContainer {
    char kind[9];
    uint16_t major, minor;
    uint32_t chunk_count;
    MesoChunk chunks[MESO_CONTAINER_CHUNKS];
} MesoContainer;

/* Appends a chunk; `data` must outlive the container. A name has 1 to 8 characters. */
void meso_container_add(MesoContainer *container, const char *name, const void *data, uint64_t size);

/* Writes `container` to `output`, chunks in the given order. */
MesoStatus meso_container_write(const MesoContainer *container, MesoOutput *output, MesoError *error);

/*
 * Opens `input` without copying: chunks point into it, and its data must be
 * aligned to 8 bytes, as mapped files are. Checks every checksum, offset and
 * padding byte; `kind` must match and `major` not exceed
 * `newest_major`. MESO_ERR_INPUT tells truncation, corruption (by chunk
 * name), wrong kind and newer version apart. O(size).
 */
MesoStatus meso_container_read(MesoContainer *container, const MesoInput *input, const char *kind,
                               uint16_t newest_major, MesoError *error);

/*
 * Chunk `name`, or NULL. For the second a missing chunk is an error, and so is,
 * with `element_size` > 0, a size that is not `count * element_size`: then NULL
 * with `error` filled.
 */
const void *meso_container_find(const MesoContainer *container, const char *name, uint64_t *size);
const void *meso_container_require(const MesoContainer *container, const char *path, const char *name,
                                   uint64_t count, uint64_t element_size, MesoError *error);

/*
 * Chunk `name` of a container of any kind and version, without looking at the other
 * chunks; NULL where it is not there whole. O(size of the chunk).
 */
const void *meso_container_peek(const MesoInput *input, const char *name, uint64_t *size);

/* True if the bytes begin like a container of any kind. */
int meso_container_recognise(const MesoInput *input);

#endif
