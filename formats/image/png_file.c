#include <math.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "formats/image/image_file.h"

typedef struct Stream {
    MesoOutput *output;
    MesoStatus status;
    MesoError *error;
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
    stream->status = meso_output_write(stream->output, data, size, stream->error);
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
        stream->status = meso_fail(stream->error, MESO_ERR_MEMORY, "out of memory: PNG");
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
        stream->status = meso_fail(stream->error, MESO_ERR_INTERNAL, "libpng failed: %s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

/* What is written, row by row from the top. */
typedef struct Rows {
    uint32_t width, height;
    int depth, color_type;
    bool is_srgb;
    void (*fill)(const struct Rows *rows, size_t y, uint8_t *row);
    const MesoImage *image;
    const MesoPngLook *look;
    float *behind;              /* [3 * width] scratch, where there is a backdrop */
    const float *values;        /* [width * height] numbers as they are, from `low` to `high` */
    float low, high;
} Rows;

static void fill_picture(const Rows *rows, size_t y, uint8_t *row)
{
    const MesoPngLook *look = rows->look;
    const float *color = rows->image->color + 4 * y * rows->width;
    if (look->backdrop && !look->transparent)
        look->backdrop(look->context, (uint32_t)y, rows->behind);
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

static void write_rows(png_structp png, png_infop info, const Rows *rows, char *provenance, uint8_t *row)
{
    png_set_IHDR(png, info, rows->width, rows->height, rows->depth, rows->color_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (rows->is_srgb)
        png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_text text = {.compression = PNG_ITXT_COMPRESSION_NONE, .key = (png_charp)"meso:provenance",
                     .text = provenance};
    png_set_text(png, info, &text, 1);
    png_set_compression_level(png, 6);
    png_write_info(png, info);
    for (size_t y = 0; y < rows->height; y++) {
        rows->fill(rows, y, row);
        png_write_row(png, row);
    }
    png_write_end(png, info);
}

/* libpng leaves by a jump: what it would clobber lives in the caller. */
static MesoStatus write_or_fail(png_structp png, png_infop info, Stream *stream, const Rows *rows, char *provenance,
                                uint8_t *row)
{
    if (setjmp(png_jmpbuf(png)))
        return stream->status;
    write_rows(png, info, rows, provenance, row);
    return MESO_OK;
}

static MesoStatus write_png(Stream *stream, const Rows *rows, char *provenance, uint8_t *row)
{
    png_structp png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, stream, on_error, on_warning, stream, allocate,
                                                release);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    MesoStatus status;
    if (info) {
        png_set_write_fn(png, stream, write_stream, flush_stream);
        status = write_or_fail(png, info, stream, rows, provenance, row);
    } else {
        status = meso_fail(stream->error, MESO_ERR_MEMORY, "out of memory: PNG");
    }
    png_destroy_write_struct(&png, &info);
    return status;
}

static MesoStatus write_with(Rows *rows, const MesoProvenance *provenance, MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    Stream stream = {output, MESO_OK, error};
    MesoStatus status = MESO_ERR_MEMORY;
    const char *text = meso_provenance_text(provenance, &arena, error);
    char *copy = text ? meso_arena_copy_text(&arena, text, error) : NULL;
    uint8_t *row = copy ? MESO_NEW(&arena, uint8_t, 4 * (size_t)rows->width, error) : NULL;
    if (row && rows->look && rows->look->backdrop)
        rows->behind = MESO_NEW(&arena, float, 3 * (size_t)rows->width, error);
    if (row && (rows->behind || !rows->look || !rows->look->backdrop))
        status = write_png(&stream, rows, copy, row);
    meso_arena_release(&arena);
    return status;
}

MesoStatus meso_png_write(const MesoImage *image, const MesoPngLook *look, const MesoProvenance *provenance,
                          MesoOutput *output, MesoError *error)
{
    Rows rows = {
        .width = image->width, .height = image->height, .depth = 8, .is_srgb = true, .fill = fill_picture,
        .color_type = look->transparent ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, .image = image, .look = look,
    };
    return write_with(&rows, provenance, output, error);
}

MesoStatus meso_png_write_values(const MesoImageValues *values, const MesoProvenance *provenance, MesoOutput *output,
                                 MesoError *error)
{
    Rows rows = {
        .width = values->width, .height = values->height, .depth = 16, .color_type = PNG_COLOR_TYPE_GRAY_ALPHA,
        .fill = fill_values, .values = values->values, .low = values->low, .high = values->high,
    };
    return write_with(&rows, provenance, output, error);
}
