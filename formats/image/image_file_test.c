/*
 * EXR: every float and id that was written is read back by the library's own
 * reader; the bytes do not depend on the threads; a full disk is told. PNG:
 * known colours, alpha, no date.
 */
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <OpenEXR/openexr.h>
#include <png.h>

#include "formats/file/input.h"
#include "formats/image/image_file.h"
#include "libcore/base/check.h"
#include "libcore/base/random.h"

enum { WIDTH = 67, HEIGHT = 53, PIXELS = WIDTH * HEIGHT };

typedef struct Picture {
    float color[4 * PIXELS], depth[PIXELS], normal[3 * PIXELS], albedo[3 * PIXELS];
    uint32_t slot[PIXELS], tile[PIXELS];
    MesoImage image;
} Picture;

static Picture picture;
static const char *tile_names[2] = {"first", "second tile"};
static const MesoProvenance provenance = {.tool = "meso-render", .command_line = "meso-render x"};

/* Halves exactly, so that nothing is rounded on the way. */
static float some_half(MesoRandom *random)
{
    return ((float)meso_random_below(random, 2048) - 1024) / 512;
}

static void make_picture(void)
{
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    for (size_t i = 0; i < PIXELS; i++) {
        for (size_t c = 0; c < 4; c++)
            picture.color[4 * i + c] = fabsf(some_half(&random));
        for (size_t c = 0; c < 3; c++) {
            picture.normal[3 * i + c] = some_half(&random);
            picture.albedo[3 * i + c] = fabsf(some_half(&random));
        }
        picture.depth[i] = i % 7 ? (float)meso_random_below(&random, UINT32_MAX) / 3.0e5f : INFINITY;
        picture.slot[i] = meso_random_below(&random, UINT32_MAX);
        picture.tile[i] = meso_random_below(&random, 100);
    }
    picture.image = (MesoImage){.width = WIDTH, .height = HEIGHT, .camera = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30, 0},
                                .color = picture.color, .depth = picture.depth, .normal = picture.normal,
                                .albedo = picture.albedo, .channel_count = 2,
                                .channels = {{"slot", UINT32_MAX, NULL}, {"tile", 2, tile_names}},
                                .ids = {picture.slot, picture.tile}};
}

static MesoStatus write_exr(const char *path, uint32_t threads, MesoError *error)
{
    MesoOutput *output;
    CHECK(meso_output_open(&output, path, error) == MESO_OK);
    MesoStatus status = meso_exr_write(&picture.image, &provenance, threads, output, error);
    if (status) {
        meso_output_discard(output);
        return status;
    }
    return meso_output_commit(output, error);
}

static MesoStatus write_png(const char *path, const float *background, MesoError *error)
{
    MesoOutput *output;
    CHECK(meso_output_open(&output, path, error) == MESO_OK);
    MesoPngLook look = {.transparent = background == NULL};
    if (background)
        memcpy(look.background, background, sizeof look.background);
    MesoStatus status = meso_png_write(&picture.image, &look, &provenance, output, error);
    if (status) {
        meso_output_discard(output);
        return status;
    }
    return meso_output_commit(output, error);
}

static const void *values_of(const char *name, size_t *stride)
{
    static const char *const names[] = {"R", "G", "B", "A", "N.X", "N.Y", "N.Z", "albedo.R",
                                        "albedo.G", "albedo.B"};
    for (size_t i = 0; i < 10; i++) {
        if (strcmp(names[i], name) != 0)
            continue;
        *stride = i < 4 ? 4 : 3;
        return i < 4 ? picture.color + i : i < 7 ? picture.normal + i - 4 : picture.albedo + i - 7;
    }
    *stride = 1;
    return strcmp(name, "Z") == 0 ? (const void *)picture.depth
        : strcmp(name, "slot") == 0 ? picture.slot : picture.tile;
}

/* One chunk, decoded to 4-byte values of each channel. */
static void check_chunk(exr_context_t file, int y)
{
    static uint32_t decoded[13][16 * WIDTH];
    exr_chunk_info_t chunk;
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    CHECK(exr_read_scanline_chunk_info(file, 0, y, &chunk) == EXR_ERR_SUCCESS);
    CHECK(exr_decoding_initialize(file, 0, &chunk, &decode) == EXR_ERR_SUCCESS);
    CHECK(decode.channel_count == 13);
    for (int c = 0; c < 13; c++) {
        bool integer = decode.channels[c].data_type == EXR_PIXEL_UINT;
        decode.channels[c].user_data_type = integer ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        decode.channels[c].user_bytes_per_element = 4;
        decode.channels[c].user_pixel_stride = 4;
        decode.channels[c].user_line_stride = 4 * WIDTH;
        decode.channels[c].decode_to_ptr = (uint8_t *)decoded[c];
    }
    CHECK(exr_decoding_choose_default_routines(file, 0, &decode) == EXR_ERR_SUCCESS);
    CHECK(exr_decoding_run(file, 0, &decode) == EXR_ERR_SUCCESS);
    for (int c = 0; c < 13; c++) {
        size_t stride;
        const uint32_t *expected = values_of(decode.channels[c].channel_name, &stride);
        for (int i = 0; i < chunk.height * WIDTH; i++)
            CHECK(decoded[c][i] == expected[stride * (size_t)(y * WIDTH + i)]
                  || (decoded[c][i] << 1 == 0 && expected[stride * (size_t)(y * WIDTH + i)] << 1 == 0));
    }
    exr_decoding_destroy(file, &decode);
}

/* Where a point of the world lies in the picture, in OpenEXR's NDC. */
static void check_at(const exr_attr_m44f_t *ndc, float x, float y, double right, double down)
{
    double w = (double)ndc->m[3] * x + (double)ndc->m[7] * y + ndc->m[15];
    CHECK(fabs(((double)ndc->m[0] * x + (double)ndc->m[4] * y + ndc->m[12]) / w - right) < 1e-6);
    CHECK(fabs(((double)ndc->m[1] * x + (double)ndc->m[5] * y + ndc->m[13]) / w - down) < 1e-6);
}

/* The camera is 5 away from the plane of z = 0. */
static void check_ndc(exr_const_context_t file)
{
    const float top = 5 * tanf(15 * 3.14159265f / 180), right = top * WIDTH / HEIGHT;
    exr_attr_m44f_t ndc;
    float width;
    CHECK(exr_attr_get_m44f(file, 0, "worldToNDC", &ndc) == EXR_ERR_SUCCESS);
    check_at(&ndc, 0, 0, 0.5, 0.5);
    check_at(&ndc, -right, top, 0, 0);
    check_at(&ndc, right, -top, 1, 1);
    CHECK(exr_get_screen_window_width(file, 0, &width) == EXR_ERR_SUCCESS);
    CHECK(fabsf(width - 2 * right / 5) < 1e-6f);
}

/* Seen orthographically, 4 high: the same in any depth. */
static void test_parallel(const char *path)
{
    exr_context_t file;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_attr_m44f_t ndc;
    MesoError error;
    float width, right = 2.f * WIDTH / HEIGHT;
    picture.image.camera.height = 4;
    CHECK(write_exr(path, 0, &error) == MESO_OK);
    picture.image.camera.height = 0;
    CHECK(exr_start_read(&file, path, &setup) == EXR_ERR_SUCCESS);
    CHECK(exr_attr_get_m44f(file, 0, "worldToNDC", &ndc) == EXR_ERR_SUCCESS);
    check_at(&ndc, 0, 0, 0.5, 0.5);
    check_at(&ndc, -right, 2, 0, 0);
    check_at(&ndc, right, -2, 1, 1);
    CHECK(ndc.m[8] == 0 && ndc.m[9] == 0 && ndc.m[11] == 0 && ndc.m[15] == 1);
    CHECK(exr_get_screen_window_width(file, 0, &width) == EXR_ERR_SUCCESS && fabsf(width - 2 * right) < 1e-6f);
    exr_finish(&file);
}

static void test_exr_values(const char *path)
{
    exr_context_t file;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    MesoError error;
    int32_t length, rows;
    const char *text;
    CHECK(write_exr(path, 0, &error) == MESO_OK);
    CHECK(exr_start_read(&file, path, &setup) == EXR_ERR_SUCCESS);
    CHECK(exr_attr_get_string(file, 0, "meso:tiles", &length, &text) == EXR_ERR_SUCCESS);
    CHECK(length == 17 && memcmp(text, "first\nsecond tile", 17) == 0);
    CHECK(exr_attr_get_string(file, 0, "meso:provenance", &length, &text) == EXR_ERR_SUCCESS);
    CHECK(strstr(text, "\"meso-render x\""));
    exr_attr_m44f_t matrix;
    CHECK(exr_attr_get_m44f(file, 0, "worldToCamera", &matrix) == EXR_ERR_SUCCESS);
    CHECK(matrix.m[0] == 1 && matrix.m[5] == 1 && matrix.m[10] == -1 && matrix.m[14] == 5);
    check_ndc(file);
    CHECK(exr_get_scanlines_per_chunk(file, 0, &rows) == EXR_ERR_SUCCESS && rows == 16);
    for (int y = 0; y < HEIGHT; y += rows)
        check_chunk(file, y);
    exr_finish(&file);
}

static void test_same_bytes(const char *path, const char *other)
{
    MesoInput a, b;
    MesoError error;
    CHECK(write_exr(path, 1, &error) == MESO_OK && write_exr(other, 3, &error) == MESO_OK);
    CHECK(meso_input_open(&a, path, &error) == MESO_OK);
    CHECK(meso_input_open(&b, other, &error) == MESO_OK);
    CHECK(a.size == b.size && memcmp(a.data, b.data, a.size) == 0);
    meso_input_close(&a);
    meso_input_close(&b);
}

/* The disk is full after 4096 bytes. */
static void test_full_disk(const char *path, const char *other)
{
    static const float white[3] = {1, 1, 1};
    struct rlimit old, small;
    MesoError error;
    signal(SIGXFSZ, SIG_IGN);
    CHECK(getrlimit(RLIMIT_FSIZE, &old) == 0);
    small = old;
    small.rlim_cur = 4096;
    unlink(path);
    unlink(other);
    CHECK(setrlimit(RLIMIT_FSIZE, &small) == 0);
    CHECK(write_exr(path, 2, &error) == MESO_ERR_OUTPUT);
    CHECK(write_png(other, white, &error) == MESO_ERR_OUTPUT);
    CHECK(setrlimit(RLIMIT_FSIZE, &old) == 0);
    CHECK(access(path, F_OK) != 0 && access(other, F_OK) != 0);
}

static void read_png(const char *path, png_image *image, uint8_t *pixels)
{
    *image = (png_image){.version = PNG_IMAGE_VERSION};
    CHECK(png_image_begin_read_from_file(image, path));
    CHECK(image->width == WIDTH && image->height == HEIGHT);
    CHECK(png_image_finish_read(image, NULL, pixels, 0, NULL));
}

static void test_png(const char *path)
{
    static uint8_t pixels[4 * PIXELS];
    static const float background[3] = {0, 0.5f, 1};
    static const float colors[4][4] = {{0, 0, 0, 0}, {0.5f, 0.5f, 0.5f, 1}, {0.25f, 0, 0, 0.5f}, {40, 0, 0, 1}};
    png_image image;
    MesoError error;
    memcpy(picture.color, colors, sizeof colors);

    CHECK(write_png(path, background, &error) == MESO_OK);
    read_png(path, &image, pixels);
    CHECK(image.format == PNG_FORMAT_RGB);
    CHECK(pixels[0] == 0 && pixels[1] == 188 && pixels[2] == 255);      /* sRGB of 0.5 is 187.5 */
    CHECK(pixels[3] == 188 && pixels[4] == 188 && pixels[5] == 188);
    CHECK(pixels[6] == 137 && pixels[7] == 137 && pixels[8] == 188);    /* half of each */
    CHECK(pixels[9] == 255 && pixels[10] == 0);                         /* rolled off, not wrapped */

    CHECK(write_png(path, NULL, &error) == MESO_OK);
    read_png(path, &image, pixels);
    CHECK(image.format == PNG_FORMAT_RGBA);
    CHECK(pixels[3] == 0 && pixels[4] == 188 && pixels[7] == 255);
    CHECK(pixels[8] == 188 && pixels[9] == 0 && pixels[11] == 128);

    MesoInput input;
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    bool dated = false, described = false;
    for (size_t i = 0; i + 15 < input.size; i++) {
        dated = dated || memcmp(input.data + i, "tIME", 4) == 0;
        described = described || memcmp(input.data + i, "meso:provenance", 15) == 0;
    }
    CHECK(!dated && described);
    meso_input_close(&input);
}

int main(void)
{
    char folder[] = "/tmp/meso-image-XXXXXX", path[64], other[64];
    CHECK(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.exr", folder);
    snprintf(other, sizeof other, "%s/b.exr", folder);
    make_picture();
    test_exr_values(path);
    test_parallel(path);
    test_same_bytes(path, other);
    test_full_disk(path, other);
    test_png(path);
    unlink(path);
    CHECK(rmdir(folder) == 0);      /* nothing else was left */
    return 0;
}
