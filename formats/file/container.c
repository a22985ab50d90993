#include "formats/file/container.h"

#include <assert.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <xxhash.h>

enum { HEADER_SIZE = 64, ENTRY_SIZE = 32, ALIGNMENT = 64 };

static const char magic[8] = {'M', 'E', 'S', 'O', 'F', 'I', 'L', 'E'};
static const uint32_t endian_tag = 0x01020304, foreign_tag = 0x04030201;

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the container is read in place, which needs a little-endian machine"
#endif

typedef struct Header {
    char magic[8], kind[8];
    uint32_t endian;
    uint16_t major, minor;
    uint32_t chunk_count, zero;
    uint64_t file_size, table_hash, zeros, header_hash;
} Header;

typedef struct Entry {
    char name[MESO_CHUNK_NAME];
    uint64_t offset, size, hash;
} Entry;

static_assert(sizeof(Header) == HEADER_SIZE && sizeof(Entry) == ENTRY_SIZE, "layout of the file");

static uint64_t align(uint64_t offset)
{
    return (offset + ALIGNMENT - 1) & ~(uint64_t)(ALIGNMENT - 1);
}

static Header make_header(const MesoContainer *container, const Entry *table, uint64_t file_size)
{
    Header header = {.endian = endian_tag, .major = container->major, .minor = container->minor,
                     .chunk_count = container->chunk_count, .file_size = file_size};
    memcpy(header.magic, magic, sizeof magic);
    memcpy(header.kind, container->kind, sizeof header.kind);
    header.table_hash = XXH3_64bits(table, container->chunk_count * sizeof *table);
    header.header_hash = XXH3_64bits(&header, offsetof(Header, header_hash));
    return header;
}

static uint64_t make_table(const MesoContainer *container, Entry *table)
{
    uint64_t end = HEADER_SIZE + (uint64_t)container->chunk_count * ENTRY_SIZE;
    for (uint32_t i = 0; i < container->chunk_count; i++) {
        const MesoChunk *chunk = &container->chunks[i];
        table[i] = (Entry){.offset = align(end), .size = chunk->size};
        table[i].hash = XXH3_64bits(chunk->size ? chunk->data : "", chunk->size);
        memcpy(table[i].name, chunk->name, MESO_CHUNK_NAME);
        end = table[i].offset + chunk->size;
    }
    return end;
}

void meso_container_add(MesoContainer *container, const char *name, const void *data, uint64_t size)
{
    assert(container->chunk_count < MESO_CONTAINER_CHUNKS && strlen(name) <= MESO_CHUNK_NAME);
    MesoChunk *chunk = &container->chunks[container->chunk_count++];
    snprintf(chunk->name, sizeof chunk->name, "%s", name);
    chunk->data = data;
    chunk->size = size;
}

MesoStatus meso_container_write(const MesoContainer *container, MesoOutput *output, MesoError *error)
{
    static const uint8_t zeros[ALIGNMENT];
    assert(container->chunk_count <= MESO_CONTAINER_CHUNKS);
    Entry table[MESO_CONTAINER_CHUNKS];
    uint64_t file_size = make_table(container, table);
    Header header = make_header(container, table, file_size);
    uint64_t end = HEADER_SIZE + (uint64_t)container->chunk_count * ENTRY_SIZE;

    MesoStatus status = meso_output_write(output, &header, sizeof header, error);
    if (!status)
        status = meso_output_write(output, table, end - HEADER_SIZE, error);
    for (uint32_t i = 0; i < container->chunk_count && !status; i++) {
        status = meso_output_write(output, zeros, table[i].offset - end, error);
        if (!status && table[i].size > 0)
            status = meso_output_write(output, container->chunks[i].data, table[i].size, error);
        end = table[i].offset + table[i].size;
    }
    return status;
}

int meso_container_recognise(const MesoInput *input)
{
    return input->size >= sizeof magic && memcmp(input->data, magic, sizeof magic) == 0;
}

/* One to eight printable characters, then zeros. */
static bool valid_name(const char name[MESO_CHUNK_NAME])
{
    size_t length = strnlen(name, MESO_CHUNK_NAME);
    for (size_t i = 0; i < MESO_CHUNK_NAME; i++)
        if (i < length ? name[i] <= ' ' || name[i] > '~' : name[i] != 0)
            return false;
    return length > 0;
}

static MesoStatus corrupt(const MesoInput *input, const char *what, MesoError *error)
{
    return meso_fail(error, MESO_ERR_INPUT, "%s: corrupt: %s", input->path, what);
}

static MesoStatus read_header(Header *header, const MesoInput *input, MesoError *error)
{
    size_t known = input->size < sizeof magic ? input->size : sizeof magic;
    if (memcmp(input->data, magic, known) != 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: is not a slots or model file of meso",
                         input->path);
    if (input->size < HEADER_SIZE)
        return meso_fail(error, MESO_ERR_INPUT, "%s: truncated: ends within its header", input->path);
    memcpy(header, input->data, sizeof *header);
    if (header->endian == foreign_tag)
        return meso_fail(error, MESO_ERR_INPUT, "%s: was written with the other byte order",
                         input->path);
    if (header->header_hash != XXH3_64bits(header, offsetof(Header, header_hash)))
        return corrupt(input, "the checksum of the header is wrong", error);
    if (header->endian != endian_tag || header->zero != 0 || header->zeros != 0 ||
        !valid_name(header->kind) || header->chunk_count > MESO_CONTAINER_CHUNKS)
        return corrupt(input, "the header holds impossible values", error);
    return MESO_OK;
}

static MesoStatus check_kind(const Header *header, const MesoInput *input, const char *kind,
                             uint16_t newest_major, MesoError *error)
{
    if (strncmp(header->kind, kind, sizeof header->kind) != 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: is a '%.8s' file; a '%s' file is needed here",
                         input->path, header->kind, kind);
    if (header->major > newest_major)
        return meso_fail(error, MESO_ERR_INPUT,
                         "%s: file version %u.%u is newer than this program reads (%u.x)",
                         input->path, header->major, header->minor, newest_major);
    if (header->major == 0)
        return corrupt(input, "the header holds impossible values", error);
    return MESO_OK;
}

static MesoStatus read_table(Entry *table, const Header *header, const MesoInput *input,
                             MesoError *error)
{
    size_t size = header->chunk_count * sizeof *table;
    if (input->size < HEADER_SIZE + size)
        return meso_fail(error, MESO_ERR_INPUT, "%s: truncated: ends within its chunk table",
                         input->path);
    memcpy(table, input->data + HEADER_SIZE, size);
    if (header->table_hash != XXH3_64bits(table, size))
        return corrupt(input, "the checksum of the chunk table is wrong", error);
    return MESO_OK;
}

/* Where every chunk must lie follows from the sizes alone. */
static MesoStatus check_table(const Entry *table, const Header *header, const MesoInput *input,
                              MesoError *error)
{
    uint64_t end = HEADER_SIZE + (uint64_t)header->chunk_count * ENTRY_SIZE;
    for (uint32_t i = 0; i < header->chunk_count; i++) {
        if (!valid_name(table[i].name))
            return corrupt(input, "a chunk has no proper name", error);
        for (uint32_t j = 0; j < i; j++)
            if (memcmp(table[i].name, table[j].name, MESO_CHUNK_NAME) == 0)
                return meso_fail(error, MESO_ERR_INPUT, "%s: corrupt: chunk '%.8s' appears twice",
                                 input->path, table[i].name);
        if (table[i].offset != align(end) || table[i].size > INT64_MAX - table[i].offset)
            return meso_fail(error, MESO_ERR_INPUT, "%s: corrupt: chunk '%.8s' lies out of place",
                             input->path, table[i].name);
        end = table[i].offset + table[i].size;
    }
    if (end != header->file_size)
        return corrupt(input, "the file size of the header is wrong", error);
    return MESO_OK;
}

static MesoStatus check_file_size(const Entry *table, const Header *header, const MesoInput *input,
                                  MesoError *error)
{
    if (input->size > header->file_size)
        return meso_fail(error, MESO_ERR_INPUT, "%s: corrupt: %" PRIu64 " bytes follow its end",
                         input->path, input->size - header->file_size);
    for (uint32_t i = 0; i < header->chunk_count; i++)
        if (table[i].offset + table[i].size > input->size)
            return meso_fail(error, MESO_ERR_INPUT,
                             "%s: truncated: %zu of %" PRIu64 " bytes, ends at chunk '%.8s'",
                             input->path, input->size, header->file_size, table[i].name);
    return MESO_OK;
}

static MesoStatus check_chunks(const Entry *table, const Header *header, const MesoInput *input,
                               MesoError *error)
{
    uint64_t end = HEADER_SIZE + (uint64_t)header->chunk_count * ENTRY_SIZE;
    for (uint32_t i = 0; i < header->chunk_count; i++) {
        for (; end < table[i].offset; end++)
            if (input->data[end] != 0)
                return meso_fail(error, MESO_ERR_INPUT,
                                 "%s: corrupt: the bytes before chunk '%.8s' are not zero",
                                 input->path, table[i].name);
        if (XXH3_64bits(input->data + end, table[i].size) != table[i].hash)
            return meso_fail(error, MESO_ERR_INPUT,
                             "%s: corrupt: the checksum of chunk '%.8s' is wrong", input->path,
                             table[i].name);
        end += table[i].size;
    }
    return MESO_OK;
}

MesoStatus meso_container_read(MesoContainer *container, const MesoInput *input, const char *kind,
                               uint16_t newest_major, MesoError *error)
{
    Header header;
    Entry table[MESO_CONTAINER_CHUNKS];
    MesoStatus status = read_header(&header, input, error);
    if (!status)
        status = check_kind(&header, input, kind, newest_major, error);
    if (!status)
        status = read_table(table, &header, input, error);
    if (!status)
        status = check_table(table, &header, input, error);
    if (!status)
        status = check_file_size(table, &header, input, error);
    if (!status)
        status = check_chunks(table, &header, input, error);
    if (status)
        return status;

    assert((uintptr_t)input->data % sizeof(uint64_t) == 0);
    *container = (MesoContainer){.major = header.major, .minor = header.minor,
                                 .chunk_count = header.chunk_count};
    memcpy(container->kind, header.kind, sizeof header.kind);
    for (uint32_t i = 0; i < header.chunk_count; i++) {
        MesoChunk *chunk = &container->chunks[i];
        memcpy(chunk->name, table[i].name, MESO_CHUNK_NAME);
        chunk->data = input->data + table[i].offset;
        chunk->size = table[i].size;
    }
    return MESO_OK;
}

const void *meso_container_peek(const MesoInput *input, const char *name, uint64_t *size)
{
    Header header;
    Entry table[MESO_CONTAINER_CHUNKS];
    if (read_header(&header, input, NULL) || read_table(table, &header, input, NULL) ||
        check_table(table, &header, input, NULL))
        return NULL;
    for (uint32_t i = 0; i < header.chunk_count; i++) {
        const uint8_t *data = input->data + table[i].offset;
        *size = table[i].size;
        if (strncmp(table[i].name, name, sizeof table[i].name) != 0)
            continue;
        bool whole = table[i].offset <= input->size && *size <= input->size - table[i].offset;
        return whole && XXH3_64bits(data, *size) == table[i].hash ? data : NULL;
    }
    return NULL;
}

const void *meso_container_find(const MesoContainer *container, const char *name, uint64_t *size)
{
    for (uint32_t i = 0; i < container->chunk_count; i++)
        if (strcmp(container->chunks[i].name, name) == 0) {
            *size = container->chunks[i].size;
            return container->chunks[i].data;
        }
    *size = 0;
    return NULL;
}

const void *meso_container_require(const MesoContainer *container, const char *path, const char *name,
                                   uint64_t count, uint64_t element_size, MesoError *error)
{
    uint64_t size, needed;
    const void *data = meso_container_find(container, name, &size);
    if (!data) {
        meso_fail(error, MESO_ERR_INPUT, "%s: chunk '%s' is missing", path, name);
        return NULL;
    }
    if (element_size > 0 && (__builtin_mul_overflow(count, element_size, &needed) || size != needed)) {
        meso_fail(error, MESO_ERR_INPUT,
                  "%s: chunk '%s' has %" PRIu64 " bytes, not %" PRIu64 " times %" PRIu64, path, name,
                  size, count, element_size);
        return NULL;
    }
    return data;
}
