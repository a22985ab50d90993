/*
 * PNG of each depth and colour, interlaced or not; EXR of the writer, and tiles and lines of each compression; every
 * file cut at every length; words about what is no picture.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <OpenEXR/openexr.h>
#include <png.h>

#include "formats/image/image_file.h"
#include "formats/image/image_read.h"
#include "libcore/base/check.h"

enum { WIDTH = 38, HEIGHT = 29, PIXELS = WIDTH * HEIGHT };

static MesoError error;

static MesoStatus read_bytes(MesoPicture *out, MesoArena *arena, const void *data, size_t size)
{
    MesoInput input;
    meso_input_wrap(&input, "some.file", data, size);
    error = (MesoError){0};
    return meso_image_read(out, arena, &input, &error);
}

/* A file that ends too early is refused, or is whole: what is behind the pixels of an EXR is nothing. */
static void check_cuts(const uint8_t *data, size_t size, size_t step)
{
    for (size_t length = 0; length < size; length += length < 64 ? 1 : step) {
        MesoArena arena;
        MesoPicture picture;
        uint8_t *copy = malloc(length + 1);     /* its end is watched by the sanitizer's build */
        CHECK(copy);
        memcpy(copy, data, length);
        meso_arena_init(&arena);
        CHECK(read_bytes(&picture, &arena, copy, length) == MESO_ERR_INPUT);
        CHECK(strncmp(error.message, "some.file: ", 11) == 0);
        meso_arena_release(&arena);
        free(copy);
    }
}

/* ---- PNG ---- */

typedef struct Memory {
    uint8_t bytes[1 << 16];
    size_t size;
} Memory;

static Memory memory;

static void write_memory(png_structp png, png_bytep data, png_size_t size)
{
    (void)png;
    CHECK(memory.size + size <= sizeof memory.bytes);
    memcpy(memory.bytes + memory.size, data, size);
    memory.size += size;
}

static void flush_memory(png_structp png)
{
    (void)png;
}

typedef struct Kind {
    int color, depth;
    bool is_clear;          /* a colour, or all of a palette's, has an alpha in a table */
} Kind;

static uint32_t sample_of(const Kind *kind, uint32_t x, uint32_t y, uint32_t channel)
{
    return (uint32_t)((x * 2654435761u + y * 40503u + channel * 977u) >> 3) & ((1u << kind->depth) - 1);
}

static uint32_t samples_of(const Kind *kind)
{
    return kind->color == PNG_COLOR_TYPE_GRAY || kind->color == PNG_COLOR_TYPE_PALETTE ? 1
         : kind->color == PNG_COLOR_TYPE_GRAY_ALPHA ? 2 : kind->color == PNG_COLOR_TYPE_RGB ? 3 : 4;
}

/* Colour i of the palette. */
static png_color color_at(uint32_t i)
{
    return (png_color){(png_byte)i, (png_byte)(255 - i), (png_byte)(7 * i)};
}

static void set_tables(png_structp png, png_infop info, const Kind *kind)
{
    png_color palette[256];
    png_byte alphas[256];
    int count = kind->depth < 16 ? 1 << kind->depth : 0;
    png_color_16 clear = {0};
    for (uint32_t i = 0; i < (uint32_t)count; i++) {
        palette[i] = color_at(i);
        alphas[i] = (png_byte)(255 - i);
    }
    if (kind->color == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(png, info, palette, count);
    clear.gray = (png_uint_16)sample_of(kind, 3, 2, 0);
    if (kind->is_clear)
        png_set_tRNS(png, info, alphas, count, &clear);
    /* a colour space that is to change nothing */
    png_set_gAMA(png, info, 0.5);
}

static void make_png(const Kind *kind, bool interlaced, uint32_t width, uint32_t height)
{
    uint8_t rows[HEIGHT][8 * WIDTH] = {{0}}, *pointers[HEIGHT];
    uint32_t samples = samples_of(kind);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    memory.size = 0;
    CHECK(width <= WIDTH && height <= HEIGHT);
    for (uint32_t y = 0; y < height; y++) {
        pointers[y] = rows[y];
        for (uint32_t i = 0; i < width * samples; i++) {
            uint32_t value = sample_of(kind, i / samples, y, i % samples);
            if (kind->depth == 16) {
                rows[y][2 * i] = (uint8_t)(value >> 8);
                rows[y][2 * i + 1] = (uint8_t)value;
            } else {
                rows[y][i] = (uint8_t)value;
            }
        }
    }
    png_set_write_fn(png, NULL, write_memory, flush_memory);
    png_set_IHDR(png, info, width, height, kind->depth, kind->color,
                 interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    set_tables(png, info, kind);
    png_write_info(png, info);
    png_set_packing(png);
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
}

static float expected_of(const Kind *kind, uint32_t x, uint32_t y, uint32_t channel)
{
    uint32_t value = sample_of(kind, x, y, channel);
    float largest = (float)((1u << kind->depth) - 1);
    if (kind->color == PNG_COLOR_TYPE_PALETTE) {
        uint32_t i = sample_of(kind, x, y, 0);
        png_color color = color_at(i);
        const float values[4] = {color.red, color.green, color.blue, 255 - (float)i};
        return values[channel] / 255;
    }
    if (kind->is_clear && channel == 1)
        return sample_of(kind, x, y, 0) == sample_of(kind, 3, 2, 0) ? 0 : 1;
    return (float)value / largest;
}

static void check_png(const Kind *kind, bool interlaced)
{
    MesoArena arena;
    MesoPicture p;
    make_png(kind, interlaced, WIDTH, HEIGHT);
    meso_arena_init(&arena);
    CHECK(read_bytes(&p, &arena, memory.bytes, memory.size) == MESO_OK);
    uint32_t channels = (kind->color == PNG_COLOR_TYPE_PALETTE ? 3 : samples_of(kind)) + kind->is_clear;
    CHECK(p.width == WIDTH && p.height == HEIGHT && p.channel_count == channels);
    for (uint32_t c = 0; c < channels; c++) {
        CHECK_TEXT(p.channel_names[c], (channels < 3 ? (const char *[]){"Y", "A"}
                                                     : (const char *[]){"R", "G", "B", "A"})[c]);
        for (uint32_t i = 0; i < PIXELS; i++)
            CHECK(fabsf(p.values[c * PIXELS + i] - expected_of(kind, i % WIDTH, i / WIDTH, c)) < 1e-7f);
    }
    meso_arena_release(&arena);
    if (kind->depth == 8)
        check_cuts(memory.bytes, memory.size, 97);
}

static void test_png(void)
{
    static const Kind kinds[] = {
        {PNG_COLOR_TYPE_GRAY, 1, false}, {PNG_COLOR_TYPE_GRAY, 2, false}, {PNG_COLOR_TYPE_GRAY, 4, true},
        {PNG_COLOR_TYPE_GRAY, 8, false}, {PNG_COLOR_TYPE_GRAY, 16, true}, {PNG_COLOR_TYPE_GRAY_ALPHA, 8, false},
        {PNG_COLOR_TYPE_GRAY_ALPHA, 16, false}, {PNG_COLOR_TYPE_RGB, 8, false}, {PNG_COLOR_TYPE_RGB, 16, false},
        {PNG_COLOR_TYPE_RGB_ALPHA, 8, false}, {PNG_COLOR_TYPE_RGB_ALPHA, 16, false},
        {PNG_COLOR_TYPE_PALETTE, 1, false}, {PNG_COLOR_TYPE_PALETTE, 4, true}, {PNG_COLOR_TYPE_PALETTE, 8, true},
        {PNG_COLOR_TYPE_PALETTE, 8, false},
    };
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int interlaced = 0; interlaced < 2; interlaced++)
            check_png(&kinds[k], interlaced);
}

/* Sums of chunks are right, and the size is not. */
static void set_size(uint32_t width, uint32_t height)
{
    uint8_t *header = memory.bytes + 16;
    for (int i = 0; i < 4; i++) {
        header[i] = (uint8_t)(width >> (24 - 8 * i));
        header[4 + i] = (uint8_t)(height >> (24 - 8 * i));
    }
    uint32_t sum = 0xffffffff;
    for (int i = 12; i < 29; i++) {
        sum ^= memory.bytes[i];
        for (int bit = 0; bit < 8; bit++)
            sum = sum & 1 ? sum >> 1 ^ 0xedb88320 : sum >> 1;
    }
    for (int i = 0; i < 4; i++)
        memory.bytes[29 + i] = (uint8_t)(~sum >> (24 - 8 * i));
}

static void test_bad_png(void)
{
    static const Kind kind = {PNG_COLOR_TYPE_RGB, 8, false};
    MesoArena arena;
    MesoPicture p;
    meso_arena_init(&arena);
    make_png(&kind, false, 5, 4);
    set_size(5, 4);
    CHECK(read_bytes(&p, &arena, memory.bytes, memory.size) == MESO_OK);
    set_size(5, 5);
    CHECK(read_bytes(&p, &arena, memory.bytes, memory.size) == MESO_ERR_INPUT);
    set_size(30000, 30000);
    CHECK(read_bytes(&p, &arena, memory.bytes, memory.size) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "some.file: broken PNG: the file is too short for its size");
    set_size(0, 5);
    CHECK(read_bytes(&p, &arena, memory.bytes, memory.size) == MESO_ERR_INPUT);
    make_png(&kind, false, 5, 4);
    memory.bytes[memory.size - 14] ^= 1;     /* of the sum of the pixels */
    CHECK(read_bytes(&p, &arena, memory.bytes, memory.size) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "CRC"));
    meso_arena_release(&arena);
}

/* ---- EXR ---- */

/* The writer's, of float, half and integers, with layers. */
static void test_written(const char *path)
{
    static float color[4 * PIXELS], depth[PIXELS], normal[3 * PIXELS], albedo[3 * PIXELS];
    static uint32_t slot[PIXELS];
    static const char *const names[] = {"A", "B", "G", "N.X", "N.Y", "N.Z", "R", "Z", "albedo.B", "albedo.G",
                                        "albedo.R", "slot"};
    MesoImage image = {.width = WIDTH, .height = HEIGHT, .camera = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30},
                       .color = color, .depth = depth, .normal = normal, .albedo = albedo, .channel_count = 1,
                       .channels = {{"slot", UINT32_MAX, NULL}}, .ids = {slot}};
    const MesoProvenance provenance = {.tool = "meso-render", .command_line = "meso-render x"};
    MesoOutput *output;
    MesoArena arena;
    MesoInput input;
    MesoPicture p;
    for (uint32_t i = 0; i < PIXELS; i++) {
        color[4 * i] = (float)i / 1024;
        depth[i] = i % 3 ? (float)i / 7 : INFINITY;
        albedo[3 * i + 2] = 2;
        slot[i] = 1000 * i;
    }
    meso_arena_init(&arena);
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_exr_write(&image, &provenance, 1, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_image_read(&p, &arena, &input, &error) == MESO_OK);
    CHECK(p.width == WIDTH && p.height == HEIGHT && p.channel_count == 12);
    for (uint32_t c = 0; c < 12; c++)
        CHECK_TEXT(p.channel_names[c], names[c]);
    for (uint32_t i = 0; i < PIXELS; i++) {
        CHECK(p.values[6 * PIXELS + i] == (float)i / 1024 && p.values[i] == 0);
        CHECK(p.values[7 * PIXELS + i] == depth[i] && p.values[8 * PIXELS + i] == 2);
        CHECK(p.values[11 * PIXELS + i] == (float)slot[i]);
    }
    check_cuts(input.data, input.size, 211);
    meso_input_close(&input);
    meso_arena_release(&arena);
}

/* Numbers come back as they were, and what is none as 0 that is not there. */
static void test_exr_values(const char *path)
{
    float values[PIXELS];
    const MesoImageValues picture = {WIDTH, HEIGHT, values, 0, 1};
    const MesoProvenance provenance = {.tool = "meso-grow", .command_line = "meso-grow x"};
    MesoOutput *output;
    MesoArena arena;
    MesoInput input;
    MesoPicture p;
    for (uint32_t i = 0; i < PIXELS; i++)
        values[i] = i % 5 == 1 ? NAN : 0.1f * (float)i - 3;
    meso_arena_init(&arena);
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_exr_write_values(&picture, &provenance, 2, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_image_read(&p, &arena, &input, &error) == MESO_OK);
    CHECK(p.width == WIDTH && p.height == HEIGHT && p.channel_count == 2);
    CHECK_TEXT(p.channel_names[0], "A");
    CHECK_TEXT(p.channel_names[1], "Y");
    for (uint32_t i = 0; i < PIXELS; i++) {
        CHECK(p.values[i] == (i % 5 == 1 ? 0 : 1));
        CHECK(p.values[PIXELS + i] == (i % 5 == 1 ? 0 : values[i]));
    }
    meso_input_close(&input);
    meso_arena_release(&arena);
}

typedef struct ExrKind {
    exr_compression_t compression;
    bool is_tiled;
} ExrKind;

static float number_at(uint32_t x, uint32_t y, uint32_t channel)
{
    return channel == 2 ? (float)(y * 100 + x) : (float)(x * (channel + 1)) / 64 - (float)y / 32;
}

static const char *const exr_names[3] = {"float", "half", "uint"};

static void encode(exr_context_t file, const exr_chunk_info_t *chunk, int x, int y)
{
    static float values[3][PIXELS];
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    CHECK(exr_encoding_initialize(file, 0, chunk, &pipeline) == EXR_ERR_SUCCESS);
    for (int c = 0; c < 3; c++) {
        exr_coding_channel_info_t *info = &pipeline.channels[c];
        CHECK_TEXT(info->channel_name, exr_names[c]);
        for (uint32_t i = 0; i < (uint32_t)(chunk->width * chunk->height); i++) {
            float value = number_at((uint32_t)x + i % (uint32_t)chunk->width, (uint32_t)y + i / (uint32_t)chunk->width,
                                    (uint32_t)c);
            uint32_t integer = (uint32_t)value;
            values[c][i] = value;
            if (c == 2)
                memcpy(&values[c][i], &integer, 4);
        }
        info->user_data_type = c == 2 ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        info->user_bytes_per_element = 4;
        info->user_pixel_stride = 4;
        info->user_line_stride = 4 * chunk->width;
        info->encode_from_ptr = (const uint8_t *)values[c];
    }
    CHECK(exr_encoding_choose_default_routines(file, 0, &pipeline) == EXR_ERR_SUCCESS);
    CHECK(exr_encoding_run(file, 0, &pipeline) == EXR_ERR_SUCCESS);
    exr_encoding_destroy(file, &pipeline);
}

/* A data window that does not begin at 0, and tiles that do not fill it. */
static void make_exr(const char *path, const ExrKind *kind)
{
    exr_context_t file;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_attr_box2i_t window = {.min = {.x = -6, .y = 7}, .max = {.x = WIDTH - 7, .y = HEIGHT + 6}};
    exr_chunk_info_t chunk;
    int32_t rows = 0;
    int part;
    CHECK(exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, &setup) == EXR_ERR_SUCCESS);
    CHECK(!exr_add_part(file, "image", kind->is_tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part));
    CHECK(!exr_initialize_required_attr_simple(file, 0, WIDTH, HEIGHT, kind->compression));
    CHECK(!exr_set_data_window(file, 0, &window));
    if (kind->is_tiled)
        CHECK(!exr_set_tile_descriptor(file, 0, 16, 8, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN));
    for (int c = 0; c < 3; c++)
        CHECK(!exr_add_channel(file, 0, exr_names[c], c == 0 ? EXR_PIXEL_FLOAT : c == 1 ? EXR_PIXEL_HALF
                               : EXR_PIXEL_UINT, EXR_PERCEPTUALLY_LINEAR, 1, 1));
    CHECK(!exr_write_header(file));
    if (kind->is_tiled)
        for (int y = 0; 8 * y < HEIGHT; y++)
            for (int x = 0; 16 * x < WIDTH; x++) {
                CHECK(!exr_write_tile_chunk_info(file, 0, x, y, 0, 0, &chunk));
                encode(file, &chunk, 16 * x, 8 * y);
            }
    else {
        CHECK(!exr_get_scanlines_per_chunk(file, 0, &rows));
        for (int y = 0; y < HEIGHT; y += rows) {
            CHECK(!exr_write_scanline_chunk_info(file, 0, 7 + y, &chunk));
            encode(file, &chunk, 0, y);
        }
    }
    exr_finish(&file);
}

/* PXR24 leaves 24 bits of a float; B44 leaves floats and integers, and 1/64 of its block's range of halves. */
static float error_of(const ExrKind *kind, uint32_t channel)
{
    if (kind->compression == EXR_COMPRESSION_PXR24 && channel == 0)
        return 1e-4f;
    bool is_b44 = kind->compression == EXR_COMPRESSION_B44 || kind->compression == EXR_COMPRESSION_B44A;
    return is_b44 && channel == 1 ? 0.05f : 0;
}

static void check_exr(const char *path, const ExrKind *kind)
{
    MesoArena arena;
    MesoInput input;
    MesoPicture p;
    make_exr(path, kind);
    meso_arena_init(&arena);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_image_read(&p, &arena, &input, &error) == MESO_OK);
    CHECK(p.width == WIDTH && p.height == HEIGHT && p.channel_count == 3);
    for (uint32_t c = 0; c < 3; c++) {
        CHECK_TEXT(p.channel_names[c], exr_names[c]);
        for (uint32_t i = 0; i < PIXELS; i++)
            CHECK(fabsf(p.values[c * PIXELS + i] - number_at(i % WIDTH, i / WIDTH, c)) <= error_of(kind, c));
    }
    check_cuts(input.data, input.size, 53);
    meso_input_close(&input);
    meso_arena_release(&arena);
}

static void test_exr(const char *path)
{
    for (int compression = EXR_COMPRESSION_NONE; compression <= EXR_COMPRESSION_B44A; compression++)
        /* tiles of B44 that the library cuts off at the rim are longer than its own reader takes */
        for (int tiled = 0; tiled < 2 - (compression >= EXR_COMPRESSION_B44); tiled++)
            check_exr(path, &(ExrKind){(exr_compression_t)compression, tiled});
}

/* One of the three channels has every other column. */
static void test_sampling(const char *path)
{
    static const char channel[] = "float\0\2\0\0\0\1\0\0\0\1\0\0\0\1";
    MesoArena arena;
    MesoInput input;
    MesoPicture p;
    bool found = false;
    make_exr(path, &(ExrKind){EXR_COMPRESSION_ZIP, false});
    meso_arena_init(&arena);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK && input.size < sizeof memory.bytes);
    memcpy(memory.bytes, input.data, input.size);
    for (size_t i = 0; i + sizeof channel < input.size && !found; i++)
        if ((found = memcmp(memory.bytes + i, channel, sizeof channel - 1) == 0))
            memory.bytes[i + 14] = 2;
    CHECK(found && read_bytes(&p, &arena, memory.bytes, input.size) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "some.file: channel 'float' has fewer pixels than the picture");
    meso_input_close(&input);
    meso_arena_release(&arena);
}

static void test_words(void)
{
    static const char mesh[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    MesoArena arena;
    MesoPicture p;
    meso_arena_init(&arena);
    CHECK(read_bytes(&p, &arena, "some words", 10) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "some.file: not a picture; PNG, OpenEXR and Radiance are read");
    CHECK(read_bytes(&p, &arena, mesh, sizeof mesh - 1) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, "some.file: an OBJ mesh, not a picture; PNG, OpenEXR and Radiance are read");
    meso_arena_release(&arena);
}

/* Numbers that are written as PNG are read as their shares, to 16 bits. */
static void test_values(const char *path)
{
    static const MesoProvenance provenance = {.tool = "meso-try", .command_line = "meso-try"};
    const float numbers[6] = {-2, 0, 1, 3.5f, NAN, 6};
    const double shares[6] = {0, 0, 0.25, 0.875, 0, 1};
    MesoArena arena;
    MesoInput input;
    MesoOutput *output;
    MesoPicture picture;
    meso_arena_init(&arena);
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    MesoStatus status = meso_png_write_values(&(MesoImageValues){3, 2, numbers, 0, 4}, &provenance, output, &error);
    CHECK(meso_output_finish(output, status, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_image_read(&picture, &arena, &input, &error) == MESO_OK);
    CHECK(picture.width == 3 && picture.height == 2 && picture.channel_count == 2);
    CHECK(strcmp(picture.channel_names[0], "Y") == 0 && strcmp(picture.channel_names[1], "A") == 0);
    for (uint32_t i = 0; i < 6; i++)
        CHECK(fabs((double)picture.values[i] - shares[i]) < 1e-5 && picture.values[6 + i] == (i != 4));
    meso_input_close(&input);
    meso_arena_release(&arena);
}

int main(void)
{
    char folder[] = "/tmp/meso-image-read-XXXXXX", path[64];
    CHECK(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.exr", folder);
    test_png();
    test_bad_png();
    test_written(path);
    test_exr_values(path);
    test_exr(path);
    test_sampling(path);
    test_values(path);
    test_words();
    unlink(path);
    CHECK(rmdir(folder) == 0);
    return 0;
}
