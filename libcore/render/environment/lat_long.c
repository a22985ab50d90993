#include "libcore/render/environment/lat_long.h"

static const float PI = 3.14159265f;

MesoStatus meso_lat_long_init(MesoLatLong *map, MesoArena *arena, uint32_t width, uint32_t height, MesoError *error)
{
    *map = (MesoLatLong){width, height, MESO_NEW(arena, float, 3 * (size_t)width * height, error)};
    return map->rgb ? MESO_OK : MESO_ERR_MEMORY;
}

MesoVec3 meso_lat_long_direction(const MesoLatLong *map, uint32_t x, uint32_t y)
{
    float latitude = PI * (0.5f - ((float)y + 0.5f) / (float)map->height);
    float longitude = PI * (1 - 2 * ((float)x + 0.5f) / (float)map->width), across = cosf(latitude);
    return (MesoVec3){across * sinf(longitude), sinf(latitude), across * cosf(longitude)};
}

float meso_lat_long_solid_angle(const MesoLatLong *map, uint32_t y)
{
    double step = 3.14159265358979 / map->height, top = 1.57079632679490 - step * y;
    return (float)((sin(top) - sin(top - step)) * 2 * 3.14159265358979 / map->width);
}

static float clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

void meso_lat_long_at(const MesoLatLong *map, MesoVec3 d, float out[3])
{
    float u = 0.5f - atan2f(d.x, d.z) / (2 * PI), v = 0.5f - asinf(clamp(d.y, -1, 1)) / PI;
    float x = u * (float)map->width - 0.5f, y = clamp(v * (float)map->height - 0.5f, 0, (float)(map->height - 1));
    float left = floorf(x), top = floorf(y), share_x = x - left, share_y = y - top;
    size_t width = map->width, y0 = (size_t)top, y1 = y0 + 1 < map->height ? y0 + 1 : y0;
    size_t x0 = left < 0 ? width - 1 : (size_t)left % width, x1 = (x0 + 1) % width;
    for (size_t c = 0; c < 3; c++) {
        float a = map->rgb[3 * (y0 * width + x0) + c], b = map->rgb[3 * (y0 * width + x1) + c];
        float e = map->rgb[3 * (y1 * width + x0) + c], f = map->rgb[3 * (y1 * width + x1) + c];
        out[c] = (a * (1 - share_x) + b * share_x) * (1 - share_y) + (e * (1 - share_x) + f * share_x) * share_y;
    }
}

/* The share of source cell i that lies in cell `of` of `count`, where there are `sources`. */
static double overlap(uint32_t i, uint32_t sources, uint32_t of, uint32_t count)
{
    double low = fmax((double)i, (double)of * sources / count);
    double high = fmin((double)i + 1, (double)(of + 1) * sources / count);
    return fmax(high - low, 0);
}

static void resample_texel(const MesoLatLong *map, MesoLatLong *out, uint32_t x, uint32_t y)
{
    uint32_t first_x = (uint32_t)((uint64_t)x * map->width / out->width);
    uint32_t first_y = (uint32_t)((uint64_t)y * map->height / out->height);
    double sum[3] = {0}, whole = 0;
    for (uint32_t j = first_y; j < map->height; j++) {
        double row = overlap(j, map->height, y, out->height) * (double)meso_lat_long_solid_angle(map, j);
        if (row == 0)
            break;
        for (uint32_t i = first_x; i < map->width; i++) {
            double weight = row * overlap(i, map->width, x, out->width);
            if (weight == 0)
                break;
            const float *texel = &map->rgb[3 * ((size_t)j * map->width + i)];
            for (int c = 0; c < 3; c++)
                sum[c] += weight * (double)texel[c];
            whole += weight;
        }
    }
    for (size_t c = 0; c < 3; c++)
        out->rgb[3 * ((size_t)y * out->width + x) + c] = (float)(sum[c] / whole);
}

void meso_lat_long_resample(const MesoLatLong *map, MesoLatLong *out)
{
    for (uint32_t y = 0; y < out->height; y++)
        for (uint32_t x = 0; x < out->width; x++)
            resample_texel(map, out, x, y);
}
