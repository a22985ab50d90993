/*
 * Radiance's pictures, as its reference manual has them (Ward, "File Formats", 1997): lines of text, then rows of four
 * bytes a pixel, plain, with runs of pixels, or with runs of each byte.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/image/image_kinds.h"

/* The least that bytes can be of a picture: runs of each byte hold 127. Older ones may be longer, and are not so
 * long. */
enum { MOST_PIXELS_A_BYTE = 1024, LEAST_RUNS = 8, MOST_RUNS = 32767 };

typedef struct Reader {
    const MesoInput *input;
    size_t at;
    float exposure;             /* what radiance was multiplied by */
    bool down, rightward;       /* order of rows and columns */
    uint32_t width, height;
    MesoPicture *picture;
    MesoError *error;
} Reader;

static MesoStatus broken(const Reader *r, const char *why)
{
    return meso_fail(r->error, MESO_ERR_INPUT, "%s: broken Radiance picture: %s", r->input->path, why);
}

/* ---- the header ---- */

/* A line without its end; false where the file or the room ends first. */
static bool read_line(Reader *r, char *line, size_t room)
{
    size_t length = 0;
    while (r->at < r->input->size && r->input->data[r->at] != '\n') {
        if (length + 1 >= room)
            return false;
        line[length++] = (char)r->input->data[r->at++];
    }
    if (r->at == r->input->size)
        return false;
    r->at++;
    line[length > 0 && line[length - 1] == '\r' ? length - 1 : length] = 0;
    return true;
}

static MesoStatus read_variable(Reader *r, const char *line)
{
    if (strncmp(line, "FORMAT=", 7) == 0 && strcmp(line + 7, "32-bit_rle_rgbe") != 0)
        return meso_fail(r->error, MESO_ERR_INPUT, "%s: a Radiance picture of the format '%.40s'; 32-bit_rle_rgbe is "
                                                   "read",
                         r->input->path, line + 7);
    if (strncmp(line, "EXPOSURE=", 9) != 0)
        return MESO_OK;
    r->exposure *= strtof(line + 9, NULL);
    return r->exposure > 0 && isfinite(r->exposure) ? MESO_OK : broken(r, "its exposure is no number over 0");
}

static MesoStatus read_size(Reader *r, const char *line)
{
    char y_sign, x_sign;
    unsigned long height, width;
    int end = 0;
    if (sscanf(line, "%cY %lu %cX %lu%n", &y_sign, &height, &x_sign, &width, &end) < 4 || line[end] ||
        !strchr("-+", y_sign) || !strchr("-+", x_sign))
        return broken(r, "its size is not as in '-Y 512 +X 1024'");
    if (width == 0 || height == 0 || width > MESO_PICTURE_VALUES || height > MESO_PICTURE_VALUES)
        return broken(r, "its size is none");
    r->width = (uint32_t)width;
    r->height = (uint32_t)height;
    r->down = y_sign == '-';
    r->rightward = x_sign == '+';
    if ((uint64_t)width * height / MOST_PIXELS_A_BYTE > r->input->size - r->at)
        return broken(r, "the file is too short for its size");
    return MESO_OK;
}

static MesoStatus read_header(Reader *r)
{
    char line[2048];
    MesoStatus status = MESO_OK;
    r->exposure = 1;
    if (!read_line(r, line, sizeof line) || strncmp(line, "#?", 2) != 0)
        return broken(r, "its first line does not end");
    do {
        if (!read_line(r, line, sizeof line))
            return broken(r, "it ends in its header");
        status = read_variable(r, line);
    } while (!status && line[0]);
    if (!status && !read_line(r, line, sizeof line))
        return broken(r, "it ends in its header");
    return status ? status : read_size(r, line);
}

/* ---- rows ---- */

static bool take(Reader *r, uint8_t *out, size_t count)
{
    if (count > r->input->size - r->at)
        return false;
    memcpy(out, r->input->data + r->at, count);
    r->at += count;
    return true;
}

/* Of each of the four bytes of all pixels, runs: over 128 of one value, else of that many. */
static bool read_byte_runs(Reader *r, uint8_t *row)
{
    for (uint32_t k = 0; k < 4; k++)
        for (uint32_t x = 0; x < r->width;) {
            uint8_t count, value = 0;
            if (!take(r, &count, 1))
                return false;
            bool run = count > 128;
            uint32_t length = run ? count - 128u : count;
            if (length == 0 || length > r->width - x || (run && !take(r, &value, 1)))
                return false;
            for (uint32_t i = 0; i < length; i++, x++) {
                if (!run && !take(r, &value, 1))
                    return false;
                row[4 * (size_t)x + k] = value;
            }
        }
    return true;
}

/* Pixels; 1, 1, 1 and a count are the last one again, and after such a one 256 times as often. */
static bool read_pixels(Reader *r, uint8_t *row)
{
    uint32_t shift = 0;
    for (uint32_t x = 0; x < r->width;) {
        uint8_t *pixel = row + 4 * (size_t)x;
        if (!take(r, pixel, 4))
            return false;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            shift = 0;
            x++;
            continue;
        }
        uint64_t length = (uint64_t)pixel[3] << shift;
        if (x == 0 || length > r->width - x || shift > 16)
            return false;
        for (uint64_t i = 0; i < length; i++)
            memcpy(pixel + 4 * i, row + 4 * (size_t)(x - 1), 4);
        x += (uint32_t)length;
        shift += 8;
    }
    return true;
}

static bool read_row(Reader *r, uint8_t *row)
{
    const uint8_t *next = r->input->data + r->at;
    bool runs = r->width >= LEAST_RUNS && r->width <= MOST_RUNS && r->input->size - r->at >= 4 && next[0] == 2 &&
                next[1] == 2 && (uint32_t)(next[2] << 8 | next[3]) == r->width;
    if (!runs)
        return read_pixels(r, row);
    r->at += 4;
    return read_byte_runs(r, row);
}

static void put_row(const Reader *r, const uint8_t *row, uint32_t y)
{
    size_t count = (size_t)r->width * r->height;
    float *out = r->picture->values + (size_t)(r->down ? y : r->height - 1 - y) * r->width;
    for (uint32_t x = 0; x < r->width; x++) {
        const uint8_t *pixel = row + 4 * (size_t)(r->rightward ? x : r->width - 1 - x);
        float unit = pixel[3] ? ldexpf(1, pixel[3] - 136) / r->exposure : 0;
        for (size_t c = 0; c < 3; c++)
            out[c * count + x] = ((float)pixel[c] + 0.5f) * unit;
    }
}

MesoStatus meso_hdr_read(MesoPicture *out, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    static const char *const names[3] = {"R", "G", "B"};
    Reader reader = {.input = input, .picture = out, .error = error};
    MesoStatus status = read_header(&reader);
    if (!status)
        status = meso_picture_alloc(out, arena, input, reader.width, reader.height, 3, error);
    if (status)
        return status;
    for (int c = 0; c < 3; c++)
        out->channel_names[c] = names[c];
    uint8_t *row = malloc(4 * (size_t)reader.width);
    if (!row)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: Radiance picture");
    for (uint32_t y = 0; y < reader.height && !status; y++) {
        if (read_row(&reader, row))
            put_row(&reader, row, y);
        else
            status = broken(&reader, "it ends early, or its runs do not fit its rows");
    }
    free(row);
    return status;
}
