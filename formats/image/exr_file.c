/*
 * Chunks of 16 rows are packed and compressed by all threads, a batch at a
 * time, and written in order, as the library wants them.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <OpenEXR/openexr.h>
#include <jansson.h>

#include "formats/image/exr_deflate.h"
#include "formats/image/image_file.h"
#include "libcore/base/parallel.h"
#include "libcore/render/projection.h"

enum { PICTURE_CHANNELS = 11, EXTRA_CHANNELS = 8, MATTES = MESO_ID_CHANNELS + 1, MATTE_CHANNELS = 2 * MESO_MATTE_RANKS,
       CHANNELS = PICTURE_CHANNELS + MESO_ID_CHANNELS + EXTRA_CHANNELS + MATTES * MATTE_CHANNELS, BATCH = 16,
       BATCH_BYTES = 20 << 20 };

/* The library removes this file after a failure, so it is one that cannot exist. */
static const char *const NO_FILE = "/dev/null/none.exr";

typedef struct Channel {
    const char *name;
    exr_pixel_type_t stored;
    exr_pixel_type_t given;
    uint32_t stride;        /* values from a pixel to the next */
    const void *values;     /* of pixel 0 */
} Channel;

/* What the library's callbacks get: our own record of failures, since it forgets them. */
typedef struct Stream {
    MesoOutput *output;
    MesoStatus status;
    MesoError error;
} Stream;

typedef struct MesoExrWriter Writer;

struct MesoExrWriter {
    const MesoImage *image;     /* a band, whose arrays are those of all bands; NULL: numbers alone, without a camera */
    uint32_t width, height;     /* of the whole picture */
    uint32_t next_row, batch;   /* rows that are written; chunks at once */
    uint32_t thread_count;
    MesoArena arena;
    Stream stream;
    exr_context_t context;
    uint32_t channel_count;
    Channel channels[CHANNELS];
    const char *names_keys[MESO_ID_CHANNELS];   /* "meso:tiles" for the channel "tile"; NULL without names */
    const char *names[MESO_ID_CHANNELS];
    char matte_names[MATTES * MATTE_CHANNELS][MESO_CHANNEL_NAME + 16];
    exr_encode_pipeline_t pipelines[BATCH];
    bool ready[BATCH];                  /* pipeline is initialised */
    exr_chunk_info_t chunks[BATCH];
    exr_result_t results[BATCH];
};

static void add_channel(Writer *writer, const char *name, exr_pixel_type_t stored, uint32_t stride, const float *values)
{
    writer->channels[writer->channel_count++] = (Channel){name, stored, EXR_PIXEL_FLOAT, stride, values};
}

static void list_extras(Writer *writer)
{
    static const char *const position[3] = {"P.X", "P.Y", "P.Z"}, *const uv[2] = {"uv.U", "uv.V"};
    static const char *const material[2] = {"roughness", "metallic"};
    const MesoImage *m = writer->image;
    for (uint32_t i = 0; m->position && i < 3; i++)
        add_channel(writer, position[i], EXR_PIXEL_FLOAT, 3, m->position + i);
    for (uint32_t i = 0; m->uv && i < 2; i++)
        add_channel(writer, uv[i], EXR_PIXEL_FLOAT, 2, m->uv + i);
    for (uint32_t i = 0; m->material && i < 2; i++)
        add_channel(writer, material[i], EXR_PIXEL_HALF, 2, m->material + i);
    if (m->openness)
        add_channel(writer, "AO", EXR_PIXEL_HALF, 1, m->openness);
}

/* Two ranks a layer: number and coverage in R and G, and in B and A. */
static void list_mattes(Writer *writer)
{
    const MesoImage *m = writer->image;
    for (uint32_t k = 0; k < m->matte_count; k++)
        for (uint32_t i = 0; i < MATTE_CHANNELS; i++) {
            char *name = writer->matte_names[k * MATTE_CHANNELS + i];
            snprintf(name, sizeof *writer->matte_names, "crypto_%s%02u.%c", m->mattes[k].name, i / 4, "RGBA"[i % 4]);
            add_channel(writer, name, EXR_PIXEL_FLOAT, MATTE_CHANNELS, m->mattes[k].ranks + i);
        }
}

static void list_channels(Writer *writer)
{
    const MesoImage *m = writer->image;
    const Channel channels[PICTURE_CHANNELS] = {
        {"R", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 4, m->color},
        {"G", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 4, m->color + 1},
        {"B", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 4, m->color + 2},
        {"A", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 4, m->color + 3},
        {"Z", EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, 1, m->depth},
        {"N.X", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 3, m->normal},
        {"N.Y", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 3, m->normal + 1},
        {"N.Z", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 3, m->normal + 2},
        {"albedo.R", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 3, m->albedo},
        {"albedo.G", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 3, m->albedo + 1},
        {"albedo.B", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 3, m->albedo + 2},
    };
    memcpy(writer->channels, channels, sizeof channels);
    writer->channel_count = PICTURE_CHANNELS;
    for (uint32_t c = 0; c < m->channel_count; c++)
        writer->channels[writer->channel_count++] =
            (Channel){m->channels[c].name, EXR_PIXEL_UINT, EXR_PIXEL_UINT, 1, m->ids[c]};
    list_extras(writer);
    list_mattes(writer);
}

/* {"name": "1a2b3c4d", ...} of the things that are on the picture, by their numbers. */
static char *manifest_of(const MesoMatte *matte)
{
    json_t *object = json_object();
    int failed = !object;
    for (uint32_t i = 0; i < matte->count && !failed; i++) {
        char text[16], hash[16];
        uint32_t bits;
        if (!(matte->seen[i / 64] >> (i % 64) & 1))
            continue;
        memcpy(&bits, &matte->hashes[i], sizeof bits);
        snprintf(hash, sizeof hash, "%08x", bits);
        failed |= json_object_set_new_nocheck(object, meso_matte_name(matte, i, text), json_string(hash)) != 0;
    }
    char *text = failed ? NULL : json_dumps(object, JSON_COMPACT);
    json_decref(object);
    return text;
}

static exr_result_t describe_matte(exr_context_t context, const MesoMatte *matte)
{
    char name[MESO_CHANNEL_NAME + 16], key[64];
    char *manifest = manifest_of(matte);
    if (!manifest)
        return EXR_ERR_OUT_OF_MEMORY;
    snprintf(name, sizeof name, "crypto_%s", matte->name);
    const char *const values[4][2] = {{"name", name}, {"hash", "MurmurHash3_32"}, {"conversion", "uint32_to_float32"},
                                      {"manifest", manifest}};
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int i = 0; i < 4 && !result; i++) {
        snprintf(key, sizeof key, "cryptomatte/%07x/%s", meso_matte_hash(name, strlen(name)) >> 4, values[i][0]);
        result = exr_attr_set_string(context, 0, key, values[i][1]);
    }
    free(manifest);
    return result;
}

static int64_t write_stream(exr_const_context_t context, void *user, const void *data, uint64_t size,
                            uint64_t offset, exr_stream_error_func_ptr_t report)
{
    Stream *stream = user;
    if (!stream->status)
        stream->status = meso_output_write_at(stream->output, offset, data, (size_t)size,
                                              &stream->error);
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

/* Column-major to the row vectors of EXR, which is a plain copy. */
static exr_result_t set_matrix(exr_context_t context, const char *name, const MesoMatrix *matrix)
{
    exr_attr_m44f_t value;
    memcpy(value.m, matrix->m, sizeof value.m);
    return exr_attr_set_m44f(context, 0, name, &value);
}

static exr_result_t set_camera(Writer *writer)
{
    MesoView view;
    const MesoImage *m = writer->image;
    if (meso_view_build(&view, &m->camera, NULL))
        return EXR_ERR_SUCCESS;
    const MesoVec3 axes[3] = {view.right, view.up, view.forward};
    MesoMatrix camera = {{0}};
    for (uint32_t a = 0; a < 3; a++) {
        camera.m[a] = axes[a].x;
        camera.m[4 + a] = axes[a].y;
        camera.m[8 + a] = axes[a].z;
        camera.m[12 + a] = -meso_vec3_dot(axes[a], view.eye);
    }
    camera.m[15] = 1;

    /* OpenEXR's NDC: (0, 0) is the upper left corner of the picture, (1, 1) the lower right one. */
    MesoMatrix ndc = meso_view_clip_from_world(&view, 1, writer->width, writer->height,
                                               (MesoWindow){0, 0, writer->width, writer->height});
    for (uint32_t column = 0; column < 4; column++)
        for (uint32_t row = 0; row < 2; row++)
            ndc.m[4 * column + row] = 0.5f * (ndc.m[4 * column + row] + ndc.m[4 * column + 3]);
    exr_result_t result = set_matrix(writer->context, "worldToCamera", &camera);
    if (!result)
        result = set_matrix(writer->context, "worldToNDC", &ndc);
    return result ? result : exr_set_screen_window_width(writer->context, 0, 2 * view.tan_half_fov *
                                                         (float)writer->width / (float)writer->height);
}

/* The names of a channel, one a line. */
static const char *join_names(const MesoIdChannel *channel, MesoArena *arena, MesoError *error)
{
    size_t size = 1;
    for (uint32_t i = 0; i < channel->count; i++)
        size += strlen(channel->names[i]) + 1;
    char *text = MESO_NEW(arena, char, size, error), *out = text;
    for (uint32_t i = 0; out && i < channel->count; i++) {
        size_t length = strlen(channel->names[i]);
        if (i > 0)
            *out++ = '\n';
        memcpy(out, channel->names[i], length);
        out += length;
    }
    return text;
}

static MesoStatus list_names(Writer *writer, MesoArena *arena, MesoError *error)
{
    for (uint32_t c = 0; c < writer->image->channel_count; c++) {
        const MesoIdChannel *channel = &writer->image->channels[c];
        if (!channel->names)
            continue;
        writer->names_keys[c] = meso_arena_print(arena, error, "meso:%ss", channel->name);
        writer->names[c] = join_names(channel, arena, error);
        if (!writer->names_keys[c] || !writer->names[c])
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

static exr_result_t describe(Writer *writer, const char *provenance)
{
    static const exr_attr_chromaticities_t rec709 = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    exr_context_t context = writer->context;
    int part;
    exr_result_t result = exr_add_part(context, "image", EXR_STORAGE_SCANLINE, &part);
    if (!result)
        result = exr_initialize_required_attr_simple(context, part, (int32_t)writer->width, (int32_t)writer->height,
                                                     EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; i < writer->channel_count && !result; i++)
        result = exr_add_channel(context, part, writer->channels[i].name, writer->channels[i].stored,
                                 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (!result && writer->image)
        result = exr_attr_set_chromaticities(context, part, "chromaticities", &rec709);
    if (!result)
        result = exr_attr_set_string(context, part, "meso:provenance", provenance);
    for (uint32_t c = 0; c < MESO_ID_CHANNELS && !result; c++)
        if (writer->names[c])
            result = exr_attr_set_string(context, part, writer->names_keys[c], writer->names[c]);
    for (uint32_t k = 0; writer->image && k < writer->image->matte_count && !result; k++)
        result = describe_matte(context, &writer->image->mattes[k]);
    if (!result && writer->image)
        result = set_camera(writer);
    return result ? result : exr_write_header(context);
}

static const Channel *find_channel(const Writer *writer, const char *name)
{
    for (uint32_t i = 0; i < writer->channel_count; i++)
        if (strcmp(writer->channels[i].name, name) == 0)
            return &writer->channels[i];
    return NULL;
}

/* `row` of the band. */
static exr_result_t connect(const Writer *writer, exr_encode_pipeline_t *pipeline, uint32_t row)
{
    size_t first = (size_t)row * writer->width;
    for (int16_t i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *info = &pipeline->channels[i];
        const Channel *channel = find_channel(writer, info->channel_name);
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

static exr_result_t encode_chunk(Writer *writer, uint32_t slot)
{
    exr_encode_pipeline_t *pipeline = &writer->pipelines[slot];
    const exr_chunk_info_t *chunk = &writer->chunks[slot];
    exr_result_t result = writer->ready[slot]
        ? exr_encoding_update(writer->context, 0, chunk, pipeline)
        : exr_encoding_initialize(writer->context, 0, chunk, pipeline);
    if (result)
        return result;
    writer->ready[slot] = true;
    result = connect(writer, pipeline, (uint32_t)chunk->start_y - writer->next_row);
    if (!result)
        result = exr_encoding_choose_default_routines(writer->context, 0, pipeline);
    pipeline->compress_fn = meso_exr_deflate;
    pipeline->yield_until_ready_fn = write_later;
    pipeline->write_fn = write_later;
    return result ? result : exr_encoding_run(writer->context, 0, pipeline);
}

static void encode_range(void *user, uint64_t begin, uint64_t end)
{
    Writer *writer = user;
    for (uint64_t i = begin; i < end; i++)
        writer->results[i] = encode_chunk(writer, (uint32_t)i);
}

/* Chunks at once: what they are packed and compressed in is to stay small beside a band. */
static exr_result_t plan_batch(Writer *writer)
{
    uint64_t bytes;
    exr_result_t result = exr_get_chunk_unpacked_size(writer->context, 0, &bytes);
    uint64_t count = result || bytes == 0 ? 1 : BATCH_BYTES / bytes;
    writer->batch = count < 1 ? 1 : count > BATCH ? BATCH : (uint32_t)count;
    return result;
}

static exr_result_t write_rows(Writer *writer, uint32_t rows)
{
    int32_t chunk_rows;
    exr_result_t result = exr_get_scanlines_per_chunk(writer->context, 0, &chunk_rows);
    uint32_t end = writer->next_row + rows;
    for (uint32_t row = writer->next_row; row < end && !result;) {
        uint32_t count = 0;
        for (; count < writer->batch && row < end && !result; row += (uint32_t)chunk_rows)
            result = exr_write_scanline_chunk_info(writer->context, 0, (int)row,
                                                   &writer->chunks[count++]);
        if (result)
            break;
        meso_parallel_for(writer->thread_count, count, 1, encode_range, writer);
        for (uint32_t i = 0; i < count && !result; i++)
            result = writer->results[i] ? writer->results[i]
                : exr_write_scanline_chunk(writer->context, 0, writer->chunks[i].start_y,
                                           writer->pipelines[i].compressed_buffer,
                                           writer->pipelines[i].compressed_bytes);
    }
    writer->next_row = end;
    return result;
}

static exr_result_t begin_file(Writer *writer, const char *provenance)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.user_data = &writer->stream;
    setup.write_fn = write_stream;
    exr_result_t result = exr_start_write(&writer->context, NO_FILE, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (result)
        return result;
    exr_set_longname_support(writer->context, 1);
    result = describe(writer, provenance);
    return result ? result : plan_batch(writer);
}

static MesoStatus status_of(const Writer *writer, exr_result_t result, MesoError *error)
{
    const Stream *stream = &writer->stream;
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

static Writer *make_writer(uint32_t width, uint32_t height, uint32_t thread_count, MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    Writer *writer = MESO_NEW(&arena, Writer, 1, error);
    if (writer)
        *writer = (Writer){.width = width, .height = height, .thread_count = thread_count, .arena = arena,
                           .stream = {.output = output}};
    return writer;
}

static MesoStatus begin(Writer *writer, const MesoProvenance *provenance, MesoError *error)
{
    const char *text = meso_provenance_text(provenance, &writer->arena, error);
    return text ? status_of(writer, begin_file(writer, text), error) : MESO_ERR_MEMORY;
}

MesoStatus meso_exr_begin(MesoExrWriter **out, const MesoImage *band, uint32_t height, const MesoProvenance *provenance,
                          uint32_t thread_count, MesoOutput *output, MesoError *error)
{
    Writer *writer = *out = make_writer(band->width, height, thread_count, output, error);
    if (!writer)
        return MESO_ERR_MEMORY;
    writer->image = band;
    list_channels(writer);
    MesoStatus status = list_names(writer, &writer->arena, error);
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
    for (uint32_t i = 0; i < BATCH; i++)
        if (writer->ready[i])
            exr_encoding_destroy(writer->context, &writer->pipelines[i]);
    exr_result_t finished = writer->context ? exr_finish(&writer->context) : EXR_ERR_SUCCESS;
    if (!status)
        status = status_of(writer, finished, error);
    MesoArena arena = writer->arena;
    meso_arena_release(&arena);
    return status;
}

MesoStatus meso_exr_write(const MesoImage *image, const MesoProvenance *provenance, uint32_t thread_count,
                          MesoOutput *output, MesoError *error)
{
    MesoExrWriter *writer;
    MesoStatus status = meso_exr_begin(&writer, image, image->height, provenance, thread_count, output, error);
    if (!status)
        status = meso_exr_band(writer, image->height, error);
    return meso_exr_end(writer, status, error);
}

/* NaN as 0, and whether a number is there. */
static bool list_values(Writer *writer, const MesoImageValues *picture, MesoArena *arena, MesoError *error)
{
    size_t count = (size_t)picture->width * picture->height;
    float *values = MESO_NEW(arena, float, count, error), *there = MESO_NEW(arena, float, count, error);
    for (size_t i = 0; values && there && i < count; i++)
        if (picture->values[i] == picture->values[i]) {
            values[i] = picture->values[i];
            there[i] = 1;
        }
    writer->channels[0] = (Channel){"Y", EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, 1, values};
    writer->channels[1] = (Channel){"A", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 1, there};
    writer->channel_count = 2;
    return values && there;
}

MesoStatus meso_exr_write_values(const MesoImageValues *values, const MesoProvenance *provenance,
                                 uint32_t thread_count, MesoOutput *output, MesoError *error)
{
    Writer *writer = make_writer(values->width, values->height, thread_count, output, error);
    if (!writer)
        return MESO_ERR_MEMORY;
    MesoStatus status = list_values(writer, values, &writer->arena, error) ? begin(writer, provenance, error)
                                                                           : MESO_ERR_MEMORY;
    if (!status)
        status = status_of(writer, write_rows(writer, values->height), error);
    return meso_exr_end(writer, status, error);
}
