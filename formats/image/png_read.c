#include <setjmp.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "formats/image/image_kinds.h"

typedef struct Reader {
    const MesoInput *input;
    size_t at;
    MesoPicture *picture;
    MesoArena *arena, *scratch;
    MesoStatus status;          /* why libpng was left */
    MesoError *error;
} Reader;

static void read_stream(png_structp png, png_bytep data, png_size_t size)
{
    Reader *r = png_get_io_ptr(png);
    if (size > r->input->size - r->at)
        png_error(png, "the file ends within");
    memcpy(data, r->input->data + r->at, size);
    r->at += size;
}

/* libpng would say it in words alone. */
static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    void *memory = malloc(size);
    Reader *r = png_get_mem_ptr(png);
    if (!memory && !r->status)
        r->status = meso_fail(r->error, MESO_ERR_MEMORY, "out of memory: PNG");
    return memory;
}

static void release(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

static void on_error(png_structp png, png_const_charp message)
{
    Reader *r = png_get_error_ptr(png);
    if (!r->status)
        r->status = meso_fail(r->error, MESO_ERR_INPUT, "%s: broken PNG: %s", r->input->path, message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

static void leave(png_structp png, MesoStatus status)
{
    Reader *r = png_get_error_ptr(png);
    r->status = status;
    png_longjmp(png, 1);
}

static void name_channels(MesoPicture *picture)
{
    static const char *const grey[] = {"Y", "A"}, *const color[] = {"R", "G", "B", "A"};
    for (uint32_t c = 0; c < picture->channel_count; c++)
        picture->channel_names[c] = picture->channel_count < 3 ? grey[c] : color[c];
}

/* Deflate makes at most 1032 bytes of one: what claims to be larger is not even begun. */
static void check_size(png_structp png, png_infop info, const Reader *r)
{
    uint64_t least = (uint64_t)png_get_rowbytes(png, info) * png_get_image_height(png, info) / 1032;
    if (least > r->input->size)
        png_error(png, "the file is too short for its size");
}

/* Returns how many times over the rows come. */
static int read_header(png_structp png, png_infop info, Reader *r)
{
    /* what libpng would hold of other chunks is of no use here */
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png, info);
    check_size(png, info, r);
    int pass_count = png_set_interlace_handling(png);
    png_set_expand(png);        /* palettes, fewer than 8 bits, a transparent colour */
    png_read_update_info(png, info);
    MesoStatus status = meso_picture_alloc(r->picture, r->arena, r->input, png_get_image_width(png, info),
                                           png_get_image_height(png, info), png_get_channels(png, info), r->error);
    if (status)
        leave(png, status);
    name_channels(r->picture);
    return pass_count;
}

static void take_row(const Reader *r, const uint8_t *row, uint32_t y, bool is_wide)
{
    const MesoPicture *p = r->picture;
    for (uint32_t c = 0; c < p->channel_count; c++) {
        float *out = p->values + ((size_t)c * p->height + y) * p->width;
        for (size_t x = 0; x < p->width; x++) {
            size_t i = x * p->channel_count + c;
            out[x] = is_wide ? (float)(row[2 * i] << 8 | row[2 * i + 1]) / 65535 : (float)row[i] / 255;
        }
    }
}

/* Interlaced rows are complete after the last pass alone, and are all held until then. */
static void read_rows(png_structp png, png_infop info, Reader *r, int pass_count)
{
    uint32_t height = r->picture->height;
    size_t size = png_get_rowbytes(png, info), stride = pass_count > 1 ? size : 0;
    bool is_wide = png_get_bit_depth(png, info) == 16;
    uint8_t *rows = MESO_NEW(r->scratch, uint8_t, pass_count > 1 ? height * size : size, r->error);
    if (!rows)
        leave(png, MESO_ERR_MEMORY);
    for (int pass = 0; pass < pass_count; pass++)
        for (uint32_t y = 0; y < height; y++) {
            png_read_row(png, rows + y * stride, NULL);
            if (pass == pass_count - 1)
                take_row(r, rows + y * stride, y, is_wide);
        }
    png_read_end(png, NULL);
}

/* libpng leaves by a jump: what it would clobber lives in the caller. */
static MesoStatus read_or_fail(png_structp png, png_infop info, Reader *r)
{
    if (setjmp(png_jmpbuf(png)))
        return r->status;
    png_set_read_fn(png, r, read_stream);
    read_rows(png, info, r, read_header(png, info, r));
    return MESO_OK;
}

MesoStatus meso_png_read(MesoPicture *out, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoArena scratch;
    Reader reader = {.input = input, .picture = out, .arena = arena, .scratch = &scratch, .error = error};
    png_structp png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning, &reader, allocate,
                                               release);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    MesoStatus status;
    meso_arena_init(&scratch);
    if (info)
        status = read_or_fail(png, info, &reader);
    else
        status = meso_fail(error, MESO_ERR_MEMORY, "out of memory: PNG");
    png_destroy_read_struct(&png, &info, NULL);
    meso_arena_release(&scratch);
    return status;
}
