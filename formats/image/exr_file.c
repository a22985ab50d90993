/*
 * Chunks of 16 rows are packed and compressed by all threads, a batch at a
 * time, and written in order, as the library wants them. Those of several
 * parts come band by band, which the library does not know: it writes the
 * headers, and chunks and the tables of where they are come from here.
 */
#include <stdlib.h>
#include <string.h>

#include "formats/image/exr_writer.h"
#include "libcore/base/parallel.h"

enum { BATCH = MESO_EXR_BATCH, BATCH_BYTES = 20 << 20, CHUNK_ROWS = 16, CHUNK_HEAD = 12 };

/* The library removes this file after a failure, so it is one that cannot exist. */
static const char *const NO_FILE = "/dev/null/none.exr";

/* ---- the library's output ---- */

static int64_t write_stream(exr_const_context_t context, void *user, const void *data, uint64_t size,
                            uint64_t offset, exr_stream_error_func_ptr_t report)
{
    MesoExrStream *stream = user;
    if (!stream->status)
        stream->status = meso_output_write_at(stream->output, offset, data, (size_t)size,
                                              &stream->error);
    stream->end = offset + size > stream->end ? offset + size : stream->end;
    if (!stream->status)
        return (int64_t)size;
    report(context, EXR_ERR_WRITE_IO, "%s", stream->error.message);
    return -1;
}

/* Failures are told by their codes; nothing is printed. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

/* ---- chunks ---- */

static const MesoExrChannel *find_channel(const MesoExrWriter *writer, const MesoExrPart *part, const char *name)
{
    const MesoExrChannel *channels = writer->channels + part->channel_begin;
    for (uint32_t i = 0; i < part->channel_count; i++)
        if (strcmp(channels[i].name, name) == 0)
            return &channels[i];
    return NULL;
}

/* `row` of the band. */
static exr_result_t connect(const MesoExrWriter *writer, const MesoExrPart *part, exr_encode_pipeline_t *pipeline,
                            uint32_t row)
{
    size_t first = (size_t)row * writer->width + writer->window.x;
    for (int16_t i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *info = &pipeline->channels[i];
        const MesoExrChannel *channel = find_channel(writer, part, info->channel_name);
        if (!channel)
            return EXR_ERR_INVALID_ARGUMENT;
        info->user_data_type = (uint16_t)channel->given;
        info->user_bytes_per_element = 4;
        info->user_pixel_stride = (int32_t)(4 * channel->stride);
        info->user_line_stride = (int32_t)(4 * channel->stride * writer->width);
        info->encode_from_ptr = (const uint8_t *)channel->values + 4 * channel->stride * first;
    }
    return EXR_ERR_SUCCESS;
}

/* The batch writes its chunks itself, in order. */
static exr_result_t write_later(exr_encode_pipeline_t *pipeline)
{
    (void)pipeline;
    return EXR_ERR_SUCCESS;
}

static void drop_pipeline(MesoExrWriter *writer, uint32_t slot)
{
    if (writer->ready[slot])
        exr_encoding_destroy(writer->context, &writer->pipelines[slot]);
    writer->ready[slot] = false;
}

static exr_result_t encode_chunk(MesoExrWriter *writer, MesoExrRoom *room, uint32_t slot)
{
    exr_encode_pipeline_t *pipeline = &writer->pipelines[slot];
    const exr_chunk_info_t *chunk = &writer->chunks[slot];
    int part = (int)writer->part_of[slot];
    exr_result_t result = writer->ready[slot]
        ? exr_encoding_update(writer->context, part, chunk, pipeline)
        : exr_encoding_initialize(writer->context, part, chunk, pipeline);
    if (result)
        return result;
    writer->ready[slot] = true;
    result = connect(writer, &writer->parts[part], pipeline, (uint32_t)chunk->start_y - writer->next_row);
    if (!result)
        result = exr_encoding_choose_default_routines(writer->context, part, pipeline);
    pipeline->yield_until_ready_fn = write_later;
    pipeline->write_fn = write_later;
    return result ? result : meso_exr_deflate(writer->context, part, pipeline, room);
}

static void encode_range(void *user, uint32_t worker, uint64_t begin, uint64_t end)
{
    MesoExrWriter *writer = user;
    for (uint64_t i = begin; i < end; i++)
        writer->results[i] = encode_chunk(writer, &writer->rooms[worker], (uint32_t)i);
}

/* Pipelines are of one part. */
static exr_result_t take_slot(MesoExrWriter *writer, uint32_t slot, uint32_t part, uint32_t row)
{
    if (writer->part_of[slot] != part)
        drop_pipeline(writer, slot);
    writer->part_of[slot] = part;
    return exr_write_scanline_chunk_info(writer->context, (int)part, (int)row, &writer->chunks[slot]);
}

static void put_int(uint8_t *bytes, uint64_t value, uint32_t size)
{
    for (uint32_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)(value >> (8 * i));
}

static exr_result_t write_bytes(MesoExrWriter *writer, uint64_t offset, const void *bytes, size_t size)
{
    MesoExrStream *stream = &writer->stream;
    if (!stream->status)
        stream->status = meso_output_write_at(stream->output, offset, bytes, size, &stream->error);
    return stream->status ? EXR_ERR_WRITE_IO : EXR_ERR_SUCCESS;
}

/* A chunk of one of several parts: the numbers of its part and its first row, its size, and its bytes. */
static exr_result_t append_chunk(MesoExrWriter *writer, uint32_t part, const exr_chunk_info_t *chunk,
                                 const exr_encode_pipeline_t *pipeline)
{
    uint8_t head[CHUNK_HEAD];
    uint64_t at = writer->stream.end;
    put_int(head, part, 4);
    put_int(head + 4, (uint32_t)chunk->start_y, 4);
    put_int(head + 8, pipeline->compressed_bytes, 4);
    writer->parts[part].offsets[((uint32_t)chunk->start_y - writer->window.y) / CHUNK_ROWS] = at;
    writer->stream.end = at + CHUNK_HEAD + pipeline->compressed_bytes;
    exr_result_t result = write_bytes(writer, at, head, sizeof head);
    return result ? result
                  : write_bytes(writer, at + CHUNK_HEAD, pipeline->compressed_buffer, pipeline->compressed_bytes);
}

static exr_result_t write_chunk(MesoExrWriter *writer, uint32_t slot)
{
    const exr_encode_pipeline_t *pipeline = &writer->pipelines[slot];
    if (writer->options.multipart)
        return append_chunk(writer, writer->part_of[slot], &writer->chunks[slot], pipeline);
    return exr_write_scanline_chunk(writer->context, 0, writer->chunks[slot].start_y, pipeline->compressed_buffer,
                                    pipeline->compressed_bytes);
}

static exr_result_t write_batch(MesoExrWriter *writer, uint32_t count)
{
    exr_result_t result = EXR_ERR_SUCCESS;
    meso_parallel_team(writer->room_count, count, 1, encode_range, writer);
    for (uint32_t i = 0; i < count && !result; i++)
        result = writer->results[i] ? writer->results[i] : write_chunk(writer, i);
    return result;
}

/* Chunks come row by row, and those of a row part by part, however high the bands are. */
static exr_result_t write_rows(MesoExrWriter *writer, uint32_t rows)
{
    const MesoWindow *w = &writer->window;
    uint32_t begin = writer->next_row > w->y ? writer->next_row : w->y, end = writer->next_row + rows, count = 0;
    end = end < w->y + w->height ? end : w->y + w->height;
    exr_result_t result = EXR_ERR_SUCCESS;
    for (uint32_t row = begin; row < end; row += CHUNK_ROWS)
        for (uint32_t part = 0; part < writer->part_count && !result; part++) {
            result = take_slot(writer, count++, part, row);
            if (!result && count == writer->batch) {
                result = write_batch(writer, count);
                count = 0;
            }
        }
    if (!result && count > 0)
        result = write_batch(writer, count);
    writer->next_row += rows;
    return result;
}

/* ---- files ---- */

static exr_result_t make_rooms(MesoExrWriter *writer, size_t size)
{
    uint32_t threads = writer->thread_count ? writer->thread_count : meso_parallel_cores();
    uint32_t count = threads < writer->batch ? threads : writer->batch;
    for (uint32_t i = 0; i < count; i++, writer->room_count++)
        if (!meso_exr_room_init(&writer->rooms[i], &writer->arena, size))
            return EXR_ERR_OUT_OF_MEMORY;
    return EXR_ERR_SUCCESS;
}

/* Chunks at once: what they are packed and compressed in is to stay small beside a band. */
static exr_result_t plan_batch(MesoExrWriter *writer)
{
    uint64_t most = 1;
    exr_result_t result = EXR_ERR_SUCCESS;
    for (uint32_t i = 0; i < writer->part_count && !result; i++) {
        uint64_t bytes;
        result = exr_get_chunk_unpacked_size(writer->context, (int)i, &bytes);
        most = !result && bytes > most ? bytes : most;
    }
    uint64_t count = BATCH_BYTES / most;
    writer->batch = count < 1 ? 1 : count > BATCH ? BATCH : (uint32_t)count;
    return result ? result : make_rooms(writer, (size_t)most);
}

static uint32_t chunk_count(const MesoExrWriter *writer)
{
    return (writer->window.height + CHUNK_ROWS - 1) / CHUNK_ROWS;
}

/* Behind the headers are the tables, which are written at last. */
static exr_result_t begin_tables(MesoExrWriter *writer, uint64_t *tables)
{
    *tables = writer->stream.end;
    for (uint32_t i = 0; i < writer->part_count; i++) {
        writer->parts[i].offsets = MESO_NEW(&writer->arena, uint64_t, chunk_count(writer), NULL);
        if (!writer->parts[i].offsets)
            return EXR_ERR_OUT_OF_MEMORY;
        writer->stream.end += 8 * (uint64_t)chunk_count(writer);
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t write_tables(MesoExrWriter *writer)
{
    exr_result_t result = EXR_ERR_SUCCESS;
    uint64_t at = writer->tables;
    for (uint32_t i = 0; i < writer->part_count && !result; i++)
        for (uint32_t k = 0; k < chunk_count(writer) && !result; k++, at += 8) {
            uint8_t bytes[8];
            put_int(bytes, writer->parts[i].offsets[k], 8);
            result = write_bytes(writer, at, bytes, sizeof bytes);
        }
    return result;
}

static exr_result_t begin_file(MesoExrWriter *writer, const char *provenance)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.user_data = &writer->stream;
    setup.write_fn = write_stream;
    exr_result_t result = exr_start_write(&writer->context, NO_FILE, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (result)
        return result;
    exr_set_longname_support(writer->context, 1);
    result = meso_exr_describe(writer, provenance);
    if (!result && writer->options.multipart)
        result = begin_tables(writer, &writer->tables);
    return result ? result : plan_batch(writer);
}

static MesoStatus status_of(const MesoExrWriter *writer, exr_result_t result, MesoError *error)
{
    const MesoExrStream *stream = &writer->stream;
    if (stream->status) {
        if (error)
            *error = stream->error;
        return stream->status;
    }
    if (result == EXR_ERR_OUT_OF_MEMORY)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: EXR");
    if (result)
        return meso_fail(error, MESO_ERR_INTERNAL, "OpenEXR failed: %s",
                         exr_get_default_error_message(result));
    return MESO_OK;
}

static MesoExrWriter *make_writer(const MesoExrOptions *options, uint32_t width, uint32_t height, uint32_t thread_count,
                                  MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoExrWriter *writer = MESO_NEW(&arena, MesoExrWriter, 1, error);
    if (!writer)
        return NULL;
    *writer = (MesoExrWriter){.width = width, .height = height, .window = {0, 0, width, height},
                              .thread_count = thread_count, .arena = arena, .stream = {.output = output}};
    if (!options)
        return writer;
    writer->options = *options;
    if (options->window.width && options->window.height) {
        /* Chunks begin where those of the whole picture would. */
        uint32_t above = options->window.y % CHUNK_ROWS;
        writer->window = options->window;
        writer->window.y -= above;
        writer->window.height += above;
    }
    return writer;
}

static MesoStatus begin(MesoExrWriter *writer, const MesoProvenance *provenance, MesoError *error)
{
    const char *text = meso_provenance_text(provenance, &writer->arena, error);
    return text ? status_of(writer, begin_file(writer, text), error) : MESO_ERR_MEMORY;
}

MesoStatus meso_exr_begin(MesoExrWriter **out, const MesoImage *band, uint32_t height, const MesoExrOptions *options,
                          const MesoProvenance *provenance, uint32_t thread_count, MesoOutput *output, MesoError *error)
{
    MesoExrWriter *writer = *out = make_writer(options, band->width, height, thread_count, output, error);
    if (!writer)
        return MESO_ERR_MEMORY;
    writer->image = band;
    MesoStatus status = meso_exr_list(writer, error);
    return status ? status : begin(writer, provenance, error);
}

MesoStatus meso_exr_band(MesoExrWriter *writer, uint32_t rows, MesoError *error)
{
    return status_of(writer, write_rows(writer, rows), error);
}

MesoStatus meso_exr_end(MesoExrWriter *writer, MesoStatus status, MesoError *error)
{
    if (!writer)
        return status;
    bool own = writer->options.multipart;
    if (!status && own)
        status = status_of(writer, write_tables(writer), error);
    for (uint32_t i = 0; i < BATCH; i++)
        drop_pipeline(writer, i);
    /* The library does not know of chunks that it did not write, and takes the file for broken. */
    exr_result_t finished = writer->context ? exr_finish(&writer->context) : EXR_ERR_SUCCESS;
    if (!status && !own)
        status = status_of(writer, finished, error);
    MesoArena arena = writer->arena;
    meso_arena_release(&arena);
    return status;
}

MesoStatus meso_exr_write(const MesoImage *image, const MesoProvenance *provenance, uint32_t thread_count,
                          MesoOutput *output, MesoError *error)
{
    MesoExrWriter *writer;
    MesoStatus status = meso_exr_begin(&writer, image, image->height, NULL, provenance, thread_count, output, error);
    if (!status)
        status = meso_exr_band(writer, image->height, error);
    return meso_exr_end(writer, status, error);
}

/* NaN as 0, and whether a number is there. */
static bool list_values(MesoExrWriter *writer, const MesoImageValues *picture, MesoArena *arena, MesoError *error)
{
    size_t count = (size_t)picture->width * picture->height;
    float *values = MESO_NEW(arena, float, count, error), *there = MESO_NEW(arena, float, count, error);
    for (size_t i = 0; values && there && i < count; i++)
        if (picture->values[i] == picture->values[i]) {
            values[i] = picture->values[i];
            there[i] = 1;
        }
    meso_exr_add_part(writer, "image");
    meso_exr_add_channel(writer, "Y", EXR_PIXEL_FLOAT, 1, values);
    meso_exr_add_channel(writer, "A", EXR_PIXEL_HALF, 1, there);
    return values && there;
}

MesoStatus meso_exr_write_values(const MesoImageValues *values, const MesoProvenance *provenance,
                                 uint32_t thread_count, MesoOutput *output, MesoError *error)
{
    MesoExrWriter *writer = make_writer(NULL, values->width, values->height, thread_count, output, error);
    if (!writer)
        return MESO_ERR_MEMORY;
    MesoStatus status = list_values(writer, values, &writer->arena, error) ? begin(writer, provenance, error)
                                                                           : MESO_ERR_MEMORY;
    if (!status)
        status = status_of(writer, write_rows(writer, values->height), error);
    return meso_exr_end(writer, status, error);
}
