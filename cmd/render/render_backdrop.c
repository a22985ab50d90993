#include "cmd/render/render_backdrop.h"

#include <string.h>
#include <strings.h>

#include "formats/image/image_read.h"
#include "formats/product/file_kind.h"
#include "libcore/render/raster/raster_view.h"

/* A light grey that leaves room for highlights. */
static const float DEFAULT_COLOR[3] = {0.84f, 0.85f, 0.87f};

/* ---- what it is ---- */

/* R,G,B, each from 0 to 1. */
static bool parse_color(const char *text, float color[3])
{
    for (int c = 0; c < 3; c++) {
        char *end;
        color[c] = strtof(text, &end);
        if (end == text || !(color[c] >= 0 && color[c] <= 1) || *end != (c < 2 ? ',' : 0))
            return false;
        text = end + 1;
    }
    return true;
}

static bool names_picture(const char *text)
{
    static const char *const extensions[] = {".png", ".exr", ".hdr", ".pic"};
    const char *dot = strrchr(text, '.');
    for (size_t i = 0; dot && i < sizeof extensions / sizeof *extensions; i++)
        if (strcasecmp(dot, extensions[i]) == 0)
            return true;
    return false;
}

static float decode_srgb(float x)
{
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

/* A PNG stays as it is; light is shown as the picture is. */
static void show_picture(MesoRenderBackdrop *b, const float *const channels[3], float *out, bool is_png)
{
    size_t count = (size_t)b->width * b->height;
    for (size_t i = 0; i < count; i++) {
        float color[3];
        for (int c = 0; c < 3; c++)
            color[c] = is_png ? decode_srgb(channels[c][i]) : channels[c][i];
        if (!is_png)
            meso_tone(b->tone, color, color);
        for (size_t c = 0; c < 3; c++)
            out[c * count + i] = color[c];
    }
    for (size_t c = 0; c < 3; c++)
        b->channels[c] = out + c * count;
}

static MesoStatus read_picture(MesoRenderBackdrop *b, MesoRenderArguments *a, MesoError *error)
{
    MesoPicture picture;
    MesoInput input;
    const float *channels[3];
    MesoStatus status = meso_tool_open_input(&a->tool, &input, a->background_text, "background");
    if (status)
        return status;
    status = meso_image_read(&picture, &a->tool.arena, &input, error);
    if (!status && !meso_picture_colors(&picture, channels))
        status = meso_fail(error, MESO_ERR_INPUT, "%s: no channels R, G and B, or Y", input.path);
    bool is_png = meso_file_kind(&input) == MESO_FILE_PNG;
    meso_input_close(&input);
    if (status)
        return status;
    b->width = picture.width;
    b->height = picture.height;
    float *shown = MESO_NEW(&a->tool.arena, float, 3 * (size_t)b->width * b->height, error);
    if (!shown)
        return MESO_ERR_MEMORY;
    show_picture(b, channels, shown, is_png);
    return MESO_OK;
}

MesoStatus meso_render_backdrop_init(MesoRenderBackdrop *b, MesoRenderArguments *a, const MesoEnvironment *environment,
                                     MesoError *error)
{
    static const char *const tones[] = {"shoulder", "none", "neutral", "agx", "filmic"};
    const char *text = a->background_text;
    *b = (MesoRenderBackdrop){.environment = environment};
    memcpy(b->color, DEFAULT_COLOR, sizeof b->color);
    while (strcmp(tones[b->tone], a->tone) != 0)
        b->tone++;
    if (!text || parse_color(text, b->color))
        return MESO_OK;
    if (strcmp(text, "none") == 0) {
        b->kind = MESO_BACKDROP_NONE;
        return MESO_OK;
    }
    if (strcmp(text, "light") == 0 && !environment)
        return meso_fail(error, MESO_ERR_USAGE, "--background light is for --light studio, sky or FILE");
    if (strcmp(text, "light") == 0) {
        b->kind = MESO_BACKDROP_LIGHT;
        return MESO_OK;
    }
    if (!names_picture(text))
        return meso_fail(error, MESO_ERR_USAGE, "--background '%s' is neither R,G,B between 0 and 1, none, light nor a "
                         "picture (.png, .exr, .hdr)", text);
    b->kind = MESO_BACKDROP_PICTURE;
    return read_picture(b, a, error);
}

/* ---- rows of it ---- */

/* Mean of a picture's channel over a rectangle, ends not included; at least half of a pixel wide and high. */
static float mean_over(const MesoRenderBackdrop *b, int channel, double left, double top, double right, double bottom)
{
    double sum = 0, whole = 0;
    for (int64_t y = (int64_t)floor(top); (double)y < bottom; y++)
        for (int64_t x = (int64_t)floor(left); (double)x < right; x++) {
            double across = fmin((double)x + 1, right) - fmax((double)x, left);
            double down = fmin((double)y + 1, bottom) - fmax((double)y, top), weight = across * down;
            int64_t at_x = x < 0 ? 0 : x < b->width ? x : b->width - 1;
            int64_t at_y = y < 0 ? 0 : y < b->height ? y : b->height - 1;
            sum += weight * (double)b->channels[channel][at_y * b->width + at_x];
            whole += weight;
        }
    return (float)(sum / whole);
}

/* Covers the image, both middles together. A picture that is enlarged is smoothed over one of its pixels. */
static void put_picture(const MesoBackdropRows *rows, uint32_t y, float *row)
{
    const MesoRenderBackdrop *b = rows->backdrop;
    double scale = fmin((double)b->width / rows->width, (double)b->height / rows->height), reach = 0.5 * fmax(scale, 1);
    double down = 0.5 * b->height + ((double)y + 0.5 - 0.5 * rows->height) * scale;
    for (uint32_t x = 0; x < rows->width; x++) {
        double across = 0.5 * b->width + ((double)x + 0.5 - 0.5 * rows->width) * scale;
        for (int c = 0; c < 3; c++)
            row[3 * (size_t)x + (size_t)c] =
                mean_over(b, c, across - reach, down - reach, across + reach, down + reach);
    }
}

static void put_light(const MesoBackdropRows *rows, uint32_t y, float *row)
{
    const MesoEnvironment *e = rows->backdrop->environment;
    for (uint32_t x = 0; x < rows->width; x++) {
        MesoVec3 d = meso_raster_ray(&rows->raster, (float)x + 0.5f, (float)y + 0.5f).direction;
        d = meso_vec3_unit(d, rows->view.forward);
        MesoVec3 toward = {meso_vec3_dot(d, rows->axes[0]), meso_vec3_dot(d, rows->axes[1]),
                           meso_vec3_dot(d, rows->axes[2])};
        float *out = row + 3 * (size_t)x;
        meso_lat_long_at(&e->map, toward, out);
        meso_tone(rows->backdrop->tone, out, out);
    }
}

static void put_row(void *context, uint32_t y, float *row)
{
    const MesoBackdropRows *rows = context;
    if (rows->backdrop->kind == MESO_BACKDROP_PICTURE)
        put_picture(rows, y, row);
    else
        put_light(rows, y, row);
}

MesoStatus meso_render_backdrop_look(MesoPngLook *look, MesoBackdropRows *rows, const MesoRenderBackdrop *b,
                                     const MesoCamera *camera, uint32_t width, uint32_t height, MesoError *error)
{
    *rows = (MesoBackdropRows){.backdrop = b, .width = width, .height = height};
    *look = (MesoPngLook){.tone = b->tone, .transparent = b->kind == MESO_BACKDROP_NONE,
                          .background = {b->color[0], b->color[1], b->color[2]}, .context = rows};
    MesoStatus status = meso_view_build(&rows->view, camera, error);
    if (status)
        return status;
    rows->raster = meso_raster_view(&rows->view, width, height, 0);
    if (b->kind == MESO_BACKDROP_LIGHT)
        meso_environment_axes(b->environment, meso_vec3_unit(b->up, meso_vec3_unit(camera->up, rows->view.up)),
                              rows->axes);
    if (b->kind == MESO_BACKDROP_PICTURE || b->kind == MESO_BACKDROP_LIGHT)
        look->backdrop = put_row;
    return MESO_OK;
}
