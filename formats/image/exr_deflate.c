#include "formats/image/exr_deflate.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include <isa-l/igzip_lib.h>

/* Of levels 0 to 3 this one makes the smallest files for its time. */
enum { LEVEL = 2, LEVEL_SIZE = ISAL_DEF_LVL2_DEFAULT };

struct MesoExrPress {
    struct isal_zstream stream;
    _Alignas(64) uint8_t level[LEVEL_SIZE];
};

/* To `out`, which has room for as much. Returns how many bytes that are; 0 where they would be no fewer. */
static size_t press(struct MesoExrPress *press, unsigned char *out, unsigned char *bytes, size_t size)
{
    struct isal_zstream *stream = &press->stream;
    assert(size <= UINT32_MAX);
    isal_deflate_stateless_init(stream);
    stream->gzip_flag = IGZIP_ZLIB;
    stream->hist_bits = 0;
    stream->level = LEVEL;
    stream->level_buf = press->level;
    stream->level_buf_size = LEVEL_SIZE;
    stream->end_of_stream = 1;
    stream->next_in = bytes;
    stream->avail_in = (uint32_t)size;
    stream->next_out = out;
    stream->avail_out = (uint32_t)size;
    return isal_deflate_stateless(stream) == COMP_OK && stream->total_out < size ? stream->total_out : 0;
}

/* The first half of the result are bytes 0, 2, 4, the second 1, 3, 5: those of one worth beside each other. */
static void split_bytes(unsigned char *out, const unsigned char *in, size_t size)
{
    size_t half = (size + 1) / 2;
    for (size_t i = 0; i < size / 2; i++) {
        out[i] = in[2 * i];
        out[half + i] = in[2 * i + 1];
    }
    if (size % 2)
        out[half - 1] = in[size - 1];
}

/* Each byte but the first becomes its difference from the one before it, and 128: a block at a time, from the end. */
static void take_differences(unsigned char *bytes, size_t size)
{
    enum { BLOCK = 4096 };
    unsigned char before[BLOCK];
    for (size_t end = size; end > 1;) {
        size_t begin = end > BLOCK + 1 ? end - BLOCK : 1;
        memcpy(before, bytes + begin - 1, end - begin);
        for (size_t i = begin; i < end; i++)
            bytes[i] = (unsigned char)(bytes[i] - before[i - begin] + 128);
        end = begin;
    }
}

/* The pipeline's buffer for what is compressed, which it frees; NULL: out of memory. */
static unsigned char *make_room(exr_encode_pipeline_t *pipeline, size_t size)
{
    if (pipeline->compressed_alloc_size < size) {
        void *grown = malloc(size);
        if (!grown)
            return NULL;
        free(pipeline->compressed_buffer);
        pipeline->compressed_buffer = grown;
        pipeline->compressed_alloc_size = size;
    }
    return pipeline->compressed_buffer;
}

/* Pipelines wait for their turn to be written, with no more memory than what they have takes. */
static exr_result_t compress(exr_encode_pipeline_t *pipeline)
{
    MesoExrRoom *room = pipeline->encoding_user_data;
    size_t size = pipeline->packed_bytes;
    assert(size <= room->size);
    split_bytes(room->split, pipeline->packed_buffer, size);
    take_differences(room->split, size);
    size_t packed = press(room->press, room->stream, room->split, size);
    pipeline->compressed_bytes = packed ? packed : size;
    unsigned char *out = make_room(pipeline, pipeline->compressed_bytes);
    if (!out)
        return EXR_ERR_OUT_OF_MEMORY;
    memcpy(out, packed ? room->stream : pipeline->packed_buffer, pipeline->compressed_bytes);
    return EXR_ERR_SUCCESS;
}

bool meso_exr_room_init(MesoExrRoom *room, MesoArena *arena, size_t size)
{
    unsigned char *bytes = MESO_NEW(arena, unsigned char, 3 * size, NULL);
    *room = (MesoExrRoom){.size = size, .packed = bytes, .split = bytes ? bytes + size : NULL,
                          .stream = bytes ? bytes + 2 * size : NULL,
                          .press = MESO_NEW(arena, struct MesoExrPress, 1, NULL)};
    return bytes && room->press;
}

exr_result_t meso_exr_deflate(exr_const_context_t context, int part, exr_encode_pipeline_t *pipeline,
                              MesoExrRoom *room)
{
    pipeline->compress_fn = compress;
    pipeline->encoding_user_data = room;
    pipeline->packed_buffer = room->packed;
    pipeline->packed_alloc_size = room->size;
    exr_result_t result = exr_encoding_run(context, part, pipeline);
    /* The library, which would free it, must not have it any longer; another that it made is its own. */
    if (pipeline->packed_buffer == room->packed) {
        pipeline->packed_buffer = NULL;
        pipeline->packed_alloc_size = 0;
    }
    return result;
}
