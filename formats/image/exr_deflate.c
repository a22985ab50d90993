#include "formats/image/exr_deflate.h"

#include <stdlib.h>
#include <string.h>

#include <libdeflate.h>

/* Levels 2 to 4 take two thirds longer, and make pictures no smaller. */
enum { LEVEL = 1 };

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
        void *grown = realloc(pipeline->compressed_buffer, size);
        if (!grown)
            return NULL;
        pipeline->compressed_buffer = grown;
        pipeline->compressed_alloc_size = size;
    }
    return pipeline->compressed_buffer;
}

exr_result_t meso_exr_deflate(exr_encode_pipeline_t *pipeline)
{
    size_t size = pipeline->packed_bytes;
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
    unsigned char *scratch = malloc(size + 1);
    size_t room = compressor && scratch ? libdeflate_zlib_compress_bound(compressor, size) : 0;
    unsigned char *out = room ? make_room(pipeline, room > size ? room : size) : NULL;
    if (out) {
        split_bytes(scratch, pipeline->packed_buffer, size);
        take_differences(scratch, size);
        size_t packed = libdeflate_zlib_compress(compressor, scratch, size, out, room);
        if (packed == 0 || packed >= size) {
            memcpy(out, pipeline->packed_buffer, size);
            packed = size;
        }
        pipeline->compressed_bytes = packed;
    }
    free(scratch);
    libdeflate_free_compressor(compressor);
    return out ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
}
