/*
 * Containers made in memory with right checksums, for fuzzers, which would
 * otherwise never get past them: a good file whose chunks the fuzzer replaces.
 */
#ifndef MESO_CONTAINER_MEMORY_H
#define MESO_CONTAINER_MEMORY_H

#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

#include "formats/file/container.h"

/* The bytes that meso_container_write() would write; freed by the caller. */
static inline uint8_t *container_to_memory(const MesoContainer *container, size_t *size)
{
    size_t table = 64, end = table + 32 * (size_t)container->chunk_count;
    *size = end;
    for (uint32_t i = 0; i < container->chunk_count; i++)
        *size = (*size + 63) / 64 * 64 + container->chunks[i].size;
    uint8_t *bytes = calloc(1, *size);
    if (!bytes)
        abort();
    for (uint32_t i = 0; i < container->chunk_count; i++) {
        const MesoChunk *chunk = &container->chunks[i];
        uint64_t entry[3] = {(end + 63) / 64 * 64, chunk->size, 0};
        if (chunk->size)
            memcpy(bytes + entry[0], chunk->data, chunk->size);
        entry[2] = XXH3_64bits(bytes + entry[0], chunk->size);
        memcpy(bytes + table + 32 * i, chunk->name, MESO_CHUNK_NAME);
        memcpy(bytes + table + 32 * i + 8, entry, sizeof entry);
        end = entry[0] + chunk->size;
    }
    const uint32_t words[4] = {0x01020304, (uint32_t)container->minor << 16 | container->major,
                               container->chunk_count, 0};
    const uint64_t sums[2] = {*size, XXH3_64bits(bytes + table, 32 * (size_t)container->chunk_count)};
    memcpy(bytes, "MESOFILE", 8);
    memcpy(bytes + 8, container->kind, 8);
    memcpy(bytes + 16, words, sizeof words);
    memcpy(bytes + 32, sums, sizeof sums);
    uint64_t seal = XXH3_64bits(bytes, 56);
    memcpy(bytes + 56, &seal, 8);
    return bytes;
}

/* Replaces chunks of `container` by pieces of the fuzzer's bytes: chunk number, length in two
 * bytes, content. The last piece may be longer than its length says. */
static inline void container_replace_chunks(MesoContainer *container, const uint8_t *data, size_t size)
{
    while (size >= 3 && container->chunk_count > 0) {
        MesoChunk *chunk = &container->chunks[data[0] % container->chunk_count];
        size_t length = data[1] | (size_t)data[2] << 8;
        data += 3;
        size -= 3;
        if (length > size)
            length = size;
        chunk->data = data;
        chunk->size = length;
        data += length;
        size -= length;
    }
}

/* A good file of `kind`, which `write` made, opened once; its bytes stay. */
static inline MesoContainer container_example(const char *kind,
                                              MesoStatus (*write)(MesoOutput *output, MesoError *error))
{
    char path[] = "/tmp/meso-fuzz-XXXXXX";
    static MesoInput input;
    MesoContainer container;
    MesoOutput *output;
    MesoError error;
    int file = mkstemp(path);
    if (file < 0 || meso_output_open(&output, path, &error) != MESO_OK ||
        write(output, &error) != MESO_OK || meso_output_commit(output, &error) != MESO_OK ||
        meso_input_open(&input, path, &error) != MESO_OK ||
        meso_container_read(&container, &input, kind, UINT16_MAX, &error) != MESO_OK)
        abort();
    close(file);
    unlink(path);
    return container;
}

#endif
