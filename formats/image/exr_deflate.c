#include "formats/image/exr_deflate.h"

#include <stdlib.h>
#include <string.h>

#include <libdeflate.h>

enum { LEVEL = 4 };

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

/* Each byte becomes its difference from the one before it, and 128. */
static void take_differences(unsigned char *out, const unsigned char *in, size_t size)
{
    out[0] = in[0];
    for (size_t i = 1; i < size; i++)
        out[i] = (unsigned char)(in[i] - in[i - 1] + 128);
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
    unsigned char *scratch = malloc(2 * size + 1);
    size_t room = compressor && scratch ? libdeflate_zlib_compress_bound(compressor, size) : 0;
    unsigned char *out = room ? make_room(pipeline, room > size ? room : size) : NULL;
    if (out) {
        split_bytes(scratch + size, pipeline->packed_buffer, size);
        take_differences(scratch, scratch + size, size);
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
