#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <OpenEXR/openexr.h>

#include "formats/image/image_kinds.h"

typedef struct Reader {
    const MesoInput *input;
    MesoPicture *picture;
    MesoArena *arena;
    exr_context_t context;
    exr_attr_box2i_t window;
    const exr_attr_chlist_t *channels;
    exr_decode_pipeline_t pipeline;
    bool ready;                 /* pipeline is initialised */
    MesoError *error;
} Reader;

/* The library says that memory is out where numbers of a file do not fit each other, too; and hands on no context. */
static _Thread_local bool out_of_memory;

static void *allocate(size_t size)
{
    void *memory = malloc(size);
    out_of_memory = out_of_memory || !memory;
    return memory;
}

static MesoStatus fail(const Reader *r, exr_result_t result)
{
    if (out_of_memory)
        return meso_fail(r->error, MESO_ERR_MEMORY, "out of memory: EXR");
    return meso_fail(r->error, MESO_ERR_INPUT, "%s: broken OpenEXR: %s", r->input->path,
                     result == EXR_ERR_OUT_OF_MEMORY ? "pixels do not fit their room"
                                                     : exr_get_default_error_message(result));
}

/* ---- the file ---- */

static int64_t read_stream(exr_const_context_t context, void *user, void *buffer, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t report)
{
    const MesoInput *input = ((const Reader *)user)->input;
    (void)context, (void)report;
    if (offset >= input->size)
        return 0;
    if (size > input->size - offset)
        size = input->size - offset;
    memcpy(buffer, input->data + offset, size);
    return (int64_t)size;
}

static int64_t stream_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const Reader *)user)->input->size;
}

/* Failures are told by their codes; nothing is printed. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

/* ---- the header ---- */

static MesoStatus check_channels(const Reader *r)
{
    for (int c = 0; c < r->channels->num_channels; c++) {
        const exr_attr_chlist_entry_t *channel = &r->channels->entries[c];
        if (channel->x_sampling != 1 || channel->y_sampling != 1)
            return meso_fail(r->error, MESO_ERR_INPUT, "%s: channel '%s' has fewer pixels than the picture",
                             r->input->path, channel->name.str);
    }
    return MESO_OK;
}

static MesoStatus read_header(Reader *r)
{
    exr_storage_t storage;
    exr_result_t result = exr_get_storage(r->context, 0, &storage);
    if (!result && storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return meso_fail(r->error, MESO_ERR_INPUT, "%s: deep pictures are not read", r->input->path);
    if (!result)
        result = exr_get_data_window(r->context, 0, &r->window);
    if (!result)
        result = exr_attr_get_channels(r->context, 0, "channels", &r->channels);
    if (result)
        return fail(r, result);
    int64_t width = (int64_t)r->window.max.x - r->window.min.x + 1;
    int64_t height = (int64_t)r->window.max.y - r->window.min.y + 1;
    MesoStatus status = check_channels(r);
    if (!status)
        status = meso_picture_alloc(r->picture, r->arena, r->input, width > 0 ? (uint64_t)width : 0,
                                    height > 0 ? (uint64_t)height : 0, (uint32_t)r->channels->num_channels, r->error);
    for (uint32_t c = 0; !status && c < r->picture->channel_count; c++)
        if (!(r->picture->channel_names[c] = meso_arena_copy_text(r->arena, r->channels->entries[c].name.str,
                                                                  r->error)))
            status = MESO_ERR_MEMORY;
    return status;
}

/* ---- pixels ---- */

/* Decodes a chunk to its place in the picture, given by its first column and row. */
static exr_result_t decode_chunk(Reader *r, const exr_chunk_info_t *chunk, uint64_t x, uint64_t y)
{
    const MesoPicture *p = r->picture;
    exr_decode_pipeline_t *pipeline = &r->pipeline;
    exr_result_t result = r->ready ? exr_decoding_update(r->context, 0, chunk, pipeline)
                                   : exr_decoding_initialize(r->context, 0, chunk, pipeline);
    if (result)
        return result;
    r->ready = true;
    if (chunk->width < 0 || chunk->height < 0 || x + (uint64_t)chunk->width > p->width ||
        y + (uint64_t)chunk->height > p->height || pipeline->channel_count != r->channels->num_channels)
        return EXR_ERR_BAD_CHUNK_LEADER;
    for (uint32_t c = 0; c < p->channel_count; c++) {
        exr_coding_channel_info_t *info = &pipeline->channels[c];
        /* integers come as they are, and are rounded when all of them are there */
        info->user_data_type = info->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        info->user_bytes_per_element = 4;
        info->user_pixel_stride = 4;
        info->user_line_stride = (int32_t)(4 * p->width);
        info->decode_to_ptr = (uint8_t *)(p->values + ((uint64_t)c * p->height + y) * p->width + x);
    }
    result = exr_decoding_choose_default_routines(r->context, 0, pipeline);
    return result ? result : exr_decoding_run(r->context, 0, pipeline);
}

static exr_result_t decode_lines(Reader *r)
{
    int32_t rows;
    exr_result_t result = exr_get_scanlines_per_chunk(r->context, 0, &rows);
    for (uint32_t y = 0; !result && y < r->picture->height; y += (uint32_t)rows) {
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(r->context, 0, (int)(r->window.min.y + (int64_t)y), &chunk);
        if (!result)
            result = decode_chunk(r, &chunk, 0, y);
    }
    return result;
}

static exr_result_t decode_tiles(Reader *r)
{
    int32_t width, height;
    exr_result_t result = exr_get_tile_sizes(r->context, 0, 0, 0, &width, &height);
    if (!result && (width <= 0 || height <= 0))
        return EXR_ERR_INVALID_ATTR;
    for (uint32_t y = 0; !result && y < r->picture->height; y += (uint32_t)height)
        for (uint32_t x = 0; !result && x < r->picture->width; x += (uint32_t)width) {
            exr_chunk_info_t chunk;
            result = exr_read_tile_chunk_info(r->context, 0, (int)(x / (uint32_t)width), (int)(y / (uint32_t)height),
                                              0, 0, &chunk);
            if (!result)
                result = decode_chunk(r, &chunk, x, y);
        }
    return result;
}

static void round_integers(const Reader *r)
{
    uint64_t count = (uint64_t)r->picture->width * r->picture->height;
    for (uint32_t c = 0; c < r->picture->channel_count; c++) {
        float *values = r->picture->values + c * count;
        for (uint64_t i = 0; r->channels->entries[c].pixel_type == EXR_PIXEL_UINT && i < count; i++) {
            uint32_t integer;
            memcpy(&integer, &values[i], sizeof integer);
            values[i] = (float)integer;
        }
    }
}

static MesoStatus read_pixels(Reader *r)
{
    exr_storage_t storage;
    exr_result_t result = exr_get_storage(r->context, 0, &storage);
    if (!result)
        result = storage == EXR_STORAGE_TILED ? decode_tiles(r) : decode_lines(r);
    if (r->ready)
        exr_decoding_destroy(r->context, &r->pipeline);
    if (result)
        return fail(r, result);
    round_integers(r);
    return MESO_OK;
}

MesoStatus meso_exr_read(MesoPicture *out, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    Reader reader = {.input = input, .picture = out, .arena = arena, .error = error};
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.alloc_fn = allocate;
    setup.free_fn = free;
    setup.user_data = &reader;
    setup.read_fn = read_stream;
    setup.size_fn = stream_size;
    /* offsets that are missing are not guessed: such a file is cut short */
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    out_of_memory = false;
    exr_result_t result = exr_start_read(&reader.context, input->path, &setup);
    if (result)
        return fail(&reader, result);
    MesoStatus status = read_header(&reader);
    if (!status)
        status = read_pixels(&reader);
    exr_finish(&reader.context);
    return status;
}
