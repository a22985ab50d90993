#include "formats/file/packed_chunk.h"

#include <libdeflate.h>
#include <string.h>

enum { LEVEL = 9, MOST_GROWTH = 1040 };     /* deflate does not shrink by more */

typedef struct Head {
    uint32_t number_bytes, row, differences, none;
    uint64_t size;
} Head;

static uint32_t number_at(const uint8_t *data, uint64_t i, uint32_t bytes)
{
    uint32_t number = 0;
    memcpy(&number, data + i * bytes, bytes);
    return number;
}

/* Small numbers of either sign become small ones, within their bits; and back. */
static uint32_t folded(uint32_t number, uint32_t bytes)
{
    uint32_t bits = 8 * bytes, mask = (uint32_t)((1ull << bits) - 1);
    bool negative = number >> (bits - 1) & 1;
    return ((number << 1) ^ (negative ? mask : 0)) & mask;
}

static uint32_t unfolded(uint32_t number, uint32_t bytes)
{
    uint32_t mask = (uint32_t)((1ull << (8 * bytes)) - 1);
    return ((number >> 1) ^ (number & 1 ? mask : 0)) & mask;
}

/* Where byte `byte` of number i lies among the planes. */
static uint64_t plane_place(const Head *head, uint64_t i, uint32_t byte)
{
    uint64_t rows = head->size / head->number_bytes / head->row;
    return ((i % head->row) * head->number_bytes + byte) * rows + i / head->row;
}

static void split_numbers(const Head *head, const uint8_t *data, uint8_t *planes)
{
    for (uint64_t i = 0; i < head->size / head->number_bytes; i++) {
        uint32_t number = number_at(data, i, head->number_bytes);
        if (head->differences && i >= head->row)
            number -= number_at(data, i - head->row, head->number_bytes);
        number = folded(number, head->number_bytes);
        for (uint32_t k = 0; k < head->number_bytes; k++)
            planes[plane_place(head, i, k)] = (uint8_t)(number >> (8 * k));
    }
}

static void join_numbers(const Head *head, const uint8_t *planes, uint8_t *data)
{
    for (uint64_t i = 0; i < head->size / head->number_bytes; i++) {
        uint32_t number = 0;
        for (uint32_t k = 0; k < head->number_bytes; k++)
            number |= (uint32_t)planes[plane_place(head, i, k)] << (8 * k);
        number = unfolded(number, head->number_bytes);
        if (head->differences && i >= head->row)
            number += number_at(data, i - head->row, head->number_bytes);
        memcpy(data + i * head->number_bytes, &number, head->number_bytes);
    }
}

MesoStatus meso_packed_add(MesoContainer *container, MesoArena *arena, const char *name, const void *data,
                           uint64_t size, MesoPacking packing, MesoError *error)
{
    const Head head = {packing.number_bytes, packing.row, packing.differences, 0, size};
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
    size_t room = compressor ? libdeflate_zlib_compress_bound(compressor, size) : 0;
    uint8_t *planes = meso_arena_alloc(arena, size, 1, error);
    uint8_t *out = meso_arena_alloc(arena, sizeof head + room, 1, error);
    size_t packed = 0;
    if (compressor && planes && out) {
        split_numbers(&head, data, planes);
        memcpy(out, &head, sizeof head);
        packed = libdeflate_zlib_compress(compressor, planes, size, out + sizeof head, room);
    }
    libdeflate_free_compressor(compressor);
    if (packed == 0)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the chunk '%s'", name);
    meso_container_add(container, name, out, sizeof head + packed);
    return MESO_OK;
}

static bool is_possible(const Head *head, uint64_t stream)
{
    uint64_t row = (uint64_t)head->number_bytes * head->row;
    return (head->number_bytes == 2 || head->number_bytes == 4) && row > 0 && head->size % row == 0 &&
           head->differences <= 1 && head->none == 0 && head->size / MOST_GROWTH <= stream;
}

/* NULL with MESO_OK in `status`: it is broken. */
static uint8_t *unpack(MesoArena *arena, const uint8_t *chunk, uint64_t size, Head *head, MesoStatus *status,
                       MesoError *error)
{
    *status = MESO_OK;
    if (size < sizeof *head)
        return NULL;
    memcpy(head, chunk, sizeof *head);
    if (!is_possible(head, size - sizeof *head))
        return NULL;
    struct libdeflate_decompressor *decompressor = libdeflate_alloc_decompressor();
    uint8_t *planes = meso_arena_alloc(arena, head->size, 1, error);
    uint8_t *data = meso_arena_alloc(arena, head->size, 1, error);
    size_t used = 0;
    bool whole = false;
    if (!decompressor || !planes || !data)
        *status = meso_fail(error, MESO_ERR_MEMORY, "out of memory for packed chunks");
    else
        whole = libdeflate_zlib_decompress_ex(decompressor, chunk + sizeof *head, size - sizeof *head, planes,
                                              head->size, &used, NULL) == LIBDEFLATE_SUCCESS &&
                used == size - sizeof *head;
    libdeflate_free_decompressor(decompressor);
    if (whole)
        join_numbers(head, planes, data);
    return whole ? data : NULL;
}

MesoStatus meso_packed_open(MesoContainer *container, MesoArena *arena, const char *path, const char *packed,
                            const char *name, MesoError *error)
{
    for (uint32_t i = 0; i < container->chunk_count; i++) {
        MesoChunk *chunk = &container->chunks[i];
        Head head;
        MesoStatus status;
        if (strcmp(chunk->name, packed) != 0)
            continue;
        const uint8_t *data = unpack(arena, chunk->data, chunk->size, &head, &status, error);
        if (!data)
            return status ? status
                          : meso_fail(error, MESO_ERR_INPUT, "%s: chunk '%s' cannot be unpacked", path, packed);
        *chunk = (MesoChunk){.data = data, .size = head.size};
        memcpy(chunk->name, name, strlen(name) + 1);
    }
    return MESO_OK;
}
