#include <math.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "formats/image/image_file.h"

typedef struct Stream {
    MesoOutput *output;
    MesoStatus status;
    MesoError error;
} Stream;

static uint8_t to_byte(float x)
{
    return (uint8_t)(fminf(fmaxf(x, 0), 1) * 255 + 0.5f);
}

static uint8_t encode_srgb(float linear)
{
    float x = fminf(fmaxf(linear, 0), 1);
    return to_byte(x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f);
}

/* Without its alpha, as the screen shows it; black where there is nothing. */
static void show(MesoTone tone, const float *color, float alpha, float out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = alpha > 0 ? color[c] / alpha : 0;
    meso_tone(tone, out, out);
}

/* What is behind stays as given. */
static void over_background(MesoTone tone, const float *color, const float *background, uint8_t *out)
{
    float alpha = fminf(fmaxf(color[3], 0), 1), shown[3];
    show(tone, color, alpha, shown);
    for (int c = 0; c < 3; c++) {
        float own = alpha > 0 ? alpha * shown[c] : 0;
        out[c] = encode_srgb(own + (1 - alpha) * background[c]);
    }
}

static void with_alpha(MesoTone tone, const float *color, uint8_t *out)
{
    float alpha = fminf(fmaxf(color[3], 0), 1), shown[3];
    show(tone, color, alpha, shown);
    for (int c = 0; c < 3; c++)
        out[c] = alpha > 0 ? encode_srgb(shown[c]) : 0;
    out[3] = to_byte(alpha);
}

static void write_stream(png_structp png, png_bytep data, png_size_t size)
{
    Stream *stream = png_get_io_ptr(png);
    stream->status = meso_output_write(stream->output, data, size, &stream->error);
    if (stream->status)
        png_error(png, "write");
}

static void flush_stream(png_structp png)
{
    (void)png;
}

/* libpng would say it in words alone. */
static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    void *memory = malloc(size);
    Stream *stream = png_get_mem_ptr(png);
    if (!memory && !stream->status)
        stream->status = meso_fail(&stream->error, MESO_ERR_MEMORY, "out of memory: PNG");
    return memory;
}

static void release(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

static void on_error(png_structp png, png_const_charp message)
{
    Stream *stream = png_get_error_ptr(png);
    if (!stream->status)
        stream->status = meso_fail(&stream->error, MESO_ERR_INTERNAL, "libpng failed: %s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

/* What is written, row by row from the top. */
typedef struct Rows {
    uint32_t width, height;     /* of the whole */
    int depth, color_type;
    bool is_srgb;
    void (*fill)(const struct Rows *rows, size_t y, uint8_t *row);
    const MesoImage *image;
    const MesoPngLook *look;
    float *behind;              /* [3 * width] scratch, where there is a backdrop */
    uint32_t first_row;         /* of the band in the whole */
    const float *values;        /* [width * height] numbers as they are, from `low` to `high` */
    float low, high;
} Rows;

static void fill_picture(const Rows *rows, size_t y, uint8_t *row)
{
    const MesoPngLook *look = rows->look;
    const float *color = rows->image->color + 4 * y * rows->width;
    if (look->backdrop && !look->transparent)
        look->backdrop(look->context, rows->first_row + (uint32_t)y, rows->behind);
    for (size_t x = 0; x < rows->width; x++)
        if (look->transparent)
            with_alpha(look->tone, color + 4 * x, row + 4 * x);
        else
            over_background(look->tone, color + 4 * x, look->backdrop ? rows->behind + 3 * x : look->background,
                            row + 3 * x);
}

/* Grey and alpha, of 16 bits, the high byte first. */
static void fill_values(const Rows *rows, size_t y, uint8_t *row)
{
    const float *values = rows->values + y * rows->width;
    for (size_t x = 0; x < rows->width; x++) {
        float share = (values[x] - rows->low) / (rows->high - rows->low);
        uint32_t grey = isnan(share) ? 0 : (uint32_t)(fminf(fmaxf(share, 0), 1) * 65535 + 0.5f);
        row[4 * x] = (uint8_t)(grey >> 8);
        row[4 * x + 1] = (uint8_t)grey;
        row[4 * x + 2] = row[4 * x + 3] = isnan(values[x]) ? 0 : 255;
    }
}

struct MesoPngWriter {
    Rows rows;
    png_structp png;
    png_infop info;
    uint8_t *row;
    MesoArena arena;
    Stream stream;
};

static void write_info(MesoPngWriter *w, char *provenance)
{
    const Rows *rows = &w->rows;
    png_set_IHDR(w->png, w->info, rows->width, rows->height, rows->depth, rows->color_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (rows->is_srgb)
        png_set_sRGB(w->png, w->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_text text = {.compression = PNG_ITXT_COMPRESSION_NONE, .key = (png_charp)"meso:provenance",
                     .text = provenance};
    png_set_text(w->png, w->info, &text, 1);
    png_set_compression_level(w->png, 6);
    png_write_info(w->png, w->info);
}

static void write_rows(MesoPngWriter *w, uint32_t count)
{
    for (size_t y = 0; y < count; y++) {
        w->rows.fill(&w->rows, y, w->row);
        png_write_row(w->png, w->row);
    }
    w->rows.first_row += count;
}

static MesoStatus failure_of(const MesoPngWriter *w, MesoError *error)
{
    if (w->stream.status && error)
        *error = w->stream.error;
    return w->stream.status;
}

/* libpng leaves by jumps, to whoever called it last. */
static MesoStatus start(MesoPngWriter *w, char *provenance, MesoError *error)
{
    w->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &w->stream, on_error, on_warning, &w->stream, allocate,
                                       release);
    w->info = w->png ? png_create_info_struct(w->png) : NULL;
    if (!w->info)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: PNG");
    if (setjmp(png_jmpbuf(w->png)))
        return failure_of(w, error);
    png_set_write_fn(w->png, &w->stream, write_stream, flush_stream);
    write_info(w, provenance);
    return MESO_OK;
}

static MesoStatus begin(MesoPngWriter **out, const Rows *rows, const MesoProvenance *provenance, MesoOutput *output,
                        MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoPngWriter *w = *out = MESO_NEW(&arena, MesoPngWriter, 1, error);
    if (!w)
        return MESO_ERR_MEMORY;
    *w = (MesoPngWriter){.rows = *rows, .arena = arena, .stream = {.output = output}};
    const char *text = meso_provenance_text(provenance, &w->arena, error);
    char *copy = text ? meso_arena_copy_text(&w->arena, text, error) : NULL;
    w->row = copy ? MESO_NEW(&w->arena, uint8_t, 4 * (size_t)rows->width, error) : NULL;
    bool backdrop = rows->look && rows->look->backdrop;
    if (w->row && backdrop)
        w->rows.behind = MESO_NEW(&w->arena, float, 3 * (size_t)rows->width, error);
    return w->row && (!backdrop || w->rows.behind) ? start(w, copy, error) : MESO_ERR_MEMORY;
}

MesoStatus meso_png_band(MesoPngWriter *w, uint32_t rows, MesoError *error)
{
    if (setjmp(png_jmpbuf(w->png)))
        return failure_of(w, error);
    write_rows(w, rows);
    return MESO_OK;
}

static MesoStatus finish(MesoPngWriter *w, MesoError *error)
{
    if (setjmp(png_jmpbuf(w->png)))
        return failure_of(w, error);
    png_write_end(w->png, w->info);
    return MESO_OK;
}

MesoStatus meso_png_end(MesoPngWriter *w, MesoStatus status, MesoError *error)
{
    if (!w)
        return status;
    if (!status)
        status = finish(w, error);
    png_destroy_write_struct(&w->png, &w->info);
    MesoArena arena = w->arena;
    meso_arena_release(&arena);
    return status;
}

static MesoStatus write_with(const Rows *rows, const MesoProvenance *provenance, MesoOutput *output, MesoError *error)
{
    MesoPngWriter *writer;
    MesoStatus status = begin(&writer, rows, provenance, output, error);
    if (!status)
        status = meso_png_band(writer, rows->height, error);
    return meso_png_end(writer, status, error);
}

static Rows picture_rows(const MesoImage *image, uint32_t height, const MesoPngLook *look)
{
    return (Rows){
        .width = image->width, .height = height, .depth = 8, .is_srgb = true, .fill = fill_picture,
        .color_type = look->transparent ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, .image = image, .look = look,
    };
}

MesoStatus meso_png_begin(MesoPngWriter **writer, const MesoImage *band, uint32_t height, const MesoPngLook *look,
                          const MesoProvenance *provenance, MesoOutput *output, MesoError *error)
{
    const Rows rows = picture_rows(band, height, look);
    return begin(writer, &rows, provenance, output, error);
}

MesoStatus meso_png_write(const MesoImage *image, const MesoPngLook *look, const MesoProvenance *provenance,
                          MesoOutput *output, MesoError *error)
{
    const Rows rows = picture_rows(image, image->height, look);
    return write_with(&rows, provenance, output, error);
}

MesoStatus meso_png_write_values(const MesoImageValues *values, const MesoProvenance *provenance, MesoOutput *output,
                                 MesoError *error)
{
    const Rows rows = {
        .width = values->width, .height = values->height, .depth = 16, .color_type = PNG_COLOR_TYPE_GRAY_ALPHA,
        .fill = fill_values, .values = values->values, .low = values->low, .high = values->high,
    };
    return write_with(&rows, provenance, output, error);
}
