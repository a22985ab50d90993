/*
 * Radiance's pictures, plain and with runs of both sorts, in each order of rows and columns, with an exposure, cut at
 * every length, and wrong in each way; light from them and from EXR, and words about what is no light.
 */
#include "formats/image/light_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "formats/image/image_file.h"
#include "formats/image/image_read.h"
#include "libcore/base/check.h"

enum { WIDTH = 40, HEIGHT = 20 };

static MesoArena arena;
static MesoError error;

typedef enum Packing { PLAIN, OLD_RUNS, RUNS } Packing;

typedef struct Bytes {
    uint8_t data[1 << 14];
    size_t size;
} Bytes;

static void put(Bytes *b, const void *data, size_t size)
{
    CHECK(b->size + size <= sizeof b->data);
    memcpy(b->data + b->size, data, size);
    b->size += size;
}

static void put_byte(Bytes *b, uint32_t byte)
{
    put(b, &(uint8_t){(uint8_t)byte}, 1);
}

/* Runs of ten pixels, and single ones behind them. */
static void pixel_at(uint32_t x, uint32_t y, uint8_t out[4])
{
    uint32_t i = x < 30 ? x / 10 : x;
    out[0] = (uint8_t)(128 + i), out[1] = (uint8_t)(3 * y), out[2] = (uint8_t)(7 * i), out[3] = (uint8_t)(120 + y);
}

static void put_row(Bytes *b, Packing packing, uint32_t y)
{
    uint8_t row[WIDTH][4];
    for (uint32_t x = 0; x < WIDTH; x++)
        pixel_at(x, y, row[x]);
    if (packing == PLAIN)
        put(b, row, sizeof row);
    if (packing == OLD_RUNS) {
        for (uint32_t x = 0; x < WIDTH; x++) {
            put(b, row[x], 4);
            if (x < 30) {
                put(b, (uint8_t[4]){1, 1, 1, 9}, 4);
                x += 9;
            }
        }
    }
    if (packing != RUNS)
        return;
    put(b, (uint8_t[4]){2, 2, 0, WIDTH}, 4);
    for (int k = 0; k < 4; k++) {
        for (uint32_t x = 0; x < 30; x += 10) {
            put_byte(b, 128 + 10);
            put_byte(b, row[x][k]);
        }
        put_byte(b, 10);
        for (uint32_t x = 30; x < WIDTH; x++)
            put_byte(b, row[x][k]);
    }
}

static void make(Bytes *b, const char *header, const char *size, Packing packing)
{
    b->size = 0;
    put(b, header, strlen(header));
    put(b, size, strlen(size));
    for (uint32_t y = 0; y < HEIGHT; y++)
        put_row(b, packing, y);
}

static MesoStatus read_picture(MesoPicture *out, const Bytes *b, size_t size)
{
    MesoInput input;
    uint8_t *copy = malloc(size + 1);       /* its end is watched by the sanitizer's build */
    CHECK(copy);
    memcpy(copy, b->data, size);
    meso_input_wrap(&input, "some.hdr", copy, size);
    error = (MesoError){0};
    MesoStatus status = meso_image_read(out, &arena, &input, &error);
    free(copy);
    return status;
}

static const char HEADER[] = "#?RADIANCE\n# by a test\nFORMAT=32-bit_rle_rgbe\n\n";

static void check_picture(const MesoPicture *p, bool down, bool rightward, double exposure)
{
    CHECK(p->width == WIDTH && p->height == HEIGHT && p->channel_count == 3 && strcmp(p->channel_names[2], "B") == 0);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            uint8_t pixel[4];
            pixel_at(rightward ? x : WIDTH - 1 - x, down ? y : HEIGHT - 1 - y, pixel);
            for (uint32_t c = 0; c < 3; c++) {
                double expected = (pixel[c] + 0.5) * ldexp(1, pixel[3] - 136) / exposure;
                CHECK(fabs((double)p->values[(c * HEIGHT + y) * WIDTH + x] - expected) <= 1e-6 * expected);
            }
        }
}

static void test_radiance(void)
{
    static Bytes b;
    MesoPicture p;
    for (Packing packing = PLAIN; packing <= RUNS; packing++) {
        make(&b, HEADER, "-Y 20 +X 40\n", packing);
        CHECK(read_picture(&p, &b, b.size) == MESO_OK);
        check_picture(&p, true, true, 1);
        for (size_t size = 0; size < b.size; size++)
            CHECK(read_picture(&p, &b, size) == MESO_ERR_INPUT && strncmp(error.message, "some.hdr: ", 10) == 0);
    }
    make(&b, "#?RGBE\r\nEXPOSURE=2\nEXPOSURE= 4\n\n", "+Y 20 -X 40\n", RUNS);
    CHECK(read_picture(&p, &b, b.size) == MESO_OK);
    check_picture(&p, false, false, 8);
    make(&b, HEADER, "-Y 20 -X 40\n", OLD_RUNS);
    CHECK(read_picture(&p, &b, b.size) == MESO_OK);
    check_picture(&p, true, false, 1);
}

static void test_wrong(void)
{
    static Bytes b;
    static const struct {
        const char *header, *size, *words;
    } wrong[] = {
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", "-Y 20 +X 40\n",
         "a Radiance picture of the format '32-bit_rle_xyze'; 32-bit_rle_rgbe is read"},
        {"#?RADIANCE\nEXPOSURE=0\n\n", "-Y 20 +X 40\n", "broken Radiance picture: its exposure is no number over 0"},
        {HEADER, "+X 40 -Y 20\n", "broken Radiance picture: its size is not as in '-Y 512 +X 1024'"},
        {HEADER, "-Y 20 +X 40 \n", "broken Radiance picture: its size is not as in '-Y 512 +X 1024'"},
        {HEADER, "-Y 0 +X 40\n", "broken Radiance picture: its size is none"},
        {HEADER, "-Y 16384 +X 16384\n", "broken Radiance picture: the file is too short for its size"},
        {HEADER, "-Y 20 +X 39\n", "broken Radiance picture: it ends early, or its runs do not fit its rows"},
    };
    MesoPicture p;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        make(&b, wrong[i].header, wrong[i].size, RUNS);
        CHECK(read_picture(&p, &b, b.size) == MESO_ERR_INPUT);
        CHECK_TEXT(error.message + strlen("some.hdr: "), wrong[i].words);
    }
}

static MesoStatus read_light(MesoLatLong *map, const char *path, const void *data, size_t size)
{
    MesoInput input;
    error = (MesoError){0};
    if (data)
        meso_input_wrap(&input, "some.file", data, size);
    else
        CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    MesoStatus status = meso_light_read(map, &arena, &input, &error);
    if (!data)
        meso_input_close(&input);
    return status;
}

static void write_values(const char *path, uint32_t width, uint32_t height, bool exr)
{
    static float values[WIDTH * HEIGHT];
    const MesoProvenance provenance = {.tool = "test", .command_line = "test"};
    const MesoImageValues picture = {width, height, values, 0, 100};
    MesoOutput *output;
    for (uint32_t i = 0; i < width * height; i++)
        values[i] = 0.25f * (float)i;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    MesoStatus status = exr ? meso_exr_write_values(&picture, &provenance, 1, output, &error)
                            : meso_png_write_values(&picture, &provenance, output, &error);
    CHECK(meso_output_finish(output, status, &error) == MESO_OK);
}

static void test_light(void)
{
    static Bytes b;
    char path[] = "/tmp/meso-light-XXXXXX";
    MesoLatLong map;
    int file = mkstemp(path);
    CHECK(file >= 0 && close(file) == 0);
    make(&b, HEADER, "-Y 20 +X 40\n", RUNS);
    CHECK(read_light(&map, NULL, b.data, b.size) == MESO_OK && map.width == WIDTH && map.height == HEIGHT);
    CHECK(fabsf(map.rgb[0] - 128.5f / 65536) < 1e-6f && fabsf(map.rgb[1] - 0.5f / 65536) < 1e-6f);

    write_values(path, WIDTH, HEIGHT, true);
    CHECK(read_light(&map, path, NULL, 0) == MESO_OK && map.width == WIDTH);
    CHECK(map.rgb[3 * 41] == 0.25f * 41 && map.rgb[3 * 41 + 2] == 0.25f * 41);
    write_values(path, 25, 20, true);
    CHECK(read_light(&map, path, NULL, 0) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "25 x 20 pixels; a picture of all directions"));
    write_values(path, WIDTH, HEIGHT, false);
    CHECK(read_light(&map, path, NULL, 0) == MESO_ERR_INPUT && strstr(error.message, "a PNG image does not say"));
    CHECK(read_light(&map, NULL, "v 0 0 0\n", 8) == MESO_ERR_INPUT && strstr(error.message, "not a picture"));
    unlink(path);
}

int main(void)
{
    meso_arena_init(&arena);
    test_radiance();
    test_wrong();
    test_light();
    meso_arena_release(&arena);
    return 0;
}
