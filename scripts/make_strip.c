/*
 * Puts PNG pictures of one size side by side, COLUMNS in a row.
 *
 *     make_strip COLUMNS OUT.png IN.png...
 */
#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void fail(const char *path, const char *why)
{
    fprintf(stderr, "make_strip: %s: %s\n", path, why);
    exit(1);
}

static uint8_t *read_picture(png_image *image, const char *path)
{
    *image = (png_image){.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(image, path))
        fail(path, image->message);
    image->format = PNG_FORMAT_RGB;
    uint8_t *pixels = malloc(PNG_IMAGE_SIZE(*image));
    if (!pixels || !png_image_finish_read(image, NULL, pixels, 0, NULL))
        fail(path, image->message);
    return pixels;
}

int main(int argc, char **argv)
{
    int columns = argc > 3 ? atoi(argv[1]) : 0, count = argc - 3;
    png_image first = {0}, image, strip = {.version = PNG_IMAGE_VERSION, .format = PNG_FORMAT_RGB};
    uint8_t *all = NULL;
    if (columns < 1) {
        fprintf(stderr, "usage: make_strip COLUMNS OUT.png IN.png...\n");
        return 2;
    }
    for (int i = 0; i < count; i++) {
        uint8_t *pixels = read_picture(&image, argv[3 + i]);
        if (i == 0) {
            first = image;
            strip.width = image.width * (uint32_t)columns;
            strip.height = image.height * (uint32_t)((count + columns - 1) / columns);
            all = calloc(strip.height, (size_t)3 * strip.width);
        }
        if (!all || image.width != first.width || image.height != first.height)
            fail(argv[3 + i], "not as large as the first one");
        for (uint32_t y = 0; y < image.height; y++) {
            size_t row = (size_t)(i / columns) * image.height + y, column = (size_t)(i % columns) * image.width;
            memcpy(all + 3 * (row * strip.width + column), pixels + (size_t)3 * y * image.width, (size_t)3 * image.width);
        }
        free(pixels);
    }
    if (!png_image_write_to_file(&strip, argv[2], 0, all, 0, NULL))
        fail(argv[2], strip.message);
    free(all);
    return 0;
}
