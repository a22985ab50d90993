#include "libcore/growth/ground/growth_maps.h"

/* ---- images ---- */

/* Where pixel `i` of `size` in a row is. */
static uint32_t wrapped(int64_t i, uint32_t size, MesoGrowthWrap wrap)
{
    int64_t n = size;
    if (wrap == MESO_GROWTH_CLAMP)
        return (uint32_t)(i < 0 ? 0 : i >= n ? n - 1 : i);
    int64_t period = wrap == MESO_GROWTH_MIRROR ? 2 * n : n, rest = i % period;
    rest = rest < 0 ? rest + period : rest;
    return (uint32_t)(rest < n ? rest : period - 1 - rest);
}

static double pixel(const MesoGrowthImage *image, int64_t column, int64_t row)
{
    uint32_t x = wrapped(column, image->width, image->wrap), y = wrapped(row, image->height, image->wrap);
    return (double)image->pixels[(size_t)(image->height - 1 - y) * image->width + x];
}

/* Rows from the bottom, in pixels; what is farther out than a whole number tells is as good as the origin. */
static double image_at(const MesoGrowthImage *image, double x, double y)
{
    if (!(fabs(x) < 0x1p52 && fabs(y) < 0x1p52))
        x = y = 0;
    if (image->nearest)
        return pixel(image, (int64_t)floor(x), (int64_t)floor(y));
    double left = floor(x - 0.5), low = floor(y - 0.5), s = x - 0.5 - left, t = y - 0.5 - low;
    int64_t c = (int64_t)left, r = (int64_t)low;
    double below = (1 - s) * pixel(image, c, r) + s * pixel(image, c + 1, r);
    double above = (1 - s) * pixel(image, c, r + 1) + s * pixel(image, c + 1, r + 1);
    return (1 - t) * below + t * above;
}

/* In pixels. */
static MesoComplex place_in_image(const MesoGrowthMap *map, uint32_t triangle, const double weight[3])
{
    MesoComplex at = {0, 0};
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec2 uv = map->uvs[3 * (size_t)triangle + k];
        at.re += weight[k] * (double)uv.x;
        at.im += weight[k] * (double)uv.y;
    }
    return (MesoComplex){at.re * map->image.width, at.im * map->image.height};
}

/* ---- values ---- */

/* The corners' values, of maps that are linear in triangles. */
static void corner_values(const MesoGrowthGround *ground, const MesoGrowthMap *map, uint32_t triangle, double out[3])
{
    for (uint32_t k = 0; k < 3; k++) {
        size_t corner = 3 * (size_t)triangle + k;
        out[k] = (double)map->values[map->domain == MESO_GROWTH_BY_VERTEX ? ground->mesh->corners[corner] : corner];
    }
}

double meso_map_value(const MesoGrowthGround *ground, const MesoGrowthMap *map, uint32_t triangle,
                      const double weight[3])
{
    double values[3];
    MesoComplex at;
    switch (map->domain) {
    case MESO_GROWTH_CONSTANT: return (double)map->values[0];
    case MESO_GROWTH_BY_TRIANGLE: return (double)map->values[triangle];
    case MESO_GROWTH_BY_IMAGE:
        at = place_in_image(map, triangle, weight);
        return image_at(&map->image, at.re, at.im);
    case MESO_GROWTH_BY_VERTEX: case MESO_GROWTH_BY_CORNER: break;
    }
    corner_values(ground, map, triangle, values);
    return weight[0] * values[0] + weight[1] * values[1] + weight[2] * values[2];
}

/* ---- gradients ---- */

/* Of what is linear in a triangle, from the values at its corners. */
static MesoComplex linear_gradient(const MesoGrowthGround *ground, uint32_t triangle, const double values[3])
{
    MesoComplex corners[3];
    meso_walk_corners(&ground->walk, triangle, corners);
    double ax = corners[1].re - corners[0].re, ay = corners[1].im - corners[0].im;
    double bx = corners[2].re - corners[0].re, by = corners[2].im - corners[0].im;
    double area = ax * by - ay * bx, a = values[1] - values[0], b = values[2] - values[0];
    /* nor where an image lies at no place */
    if (!(area > 0) || !isfinite(a) || !isfinite(b))
        return (MesoComplex){0, 0};
    return (MesoComplex){(a * by - b * ay) / area, (b * ax - a * bx) / area};
}

/* By the values across the sides, as if half-way to them on the sides; at borders the triangle's own. */
static MesoComplex stepped_gradient(const MesoGrowthGround *ground, const MesoGrowthMap *map, uint32_t triangle)
{
    const MesoWalkFace *face = &ground->walk.faces[triangle];
    MesoComplex corners[3], sum = {0, 0};
    meso_walk_corners(&ground->walk, triangle, corners);
    double ax = corners[1].re - corners[0].re, ay = corners[1].im - corners[0].im;
    double bx = corners[2].re - corners[0].re, by = corners[2].im - corners[0].im, area = 0.5 * (ax * by - ay * bx);
    for (uint32_t k = 0; k < 3 && area > 0; k++) {
        if (face->twins[k] == MESO_NO_INDEX)
            continue;
        double rise = 0.5 * ((double)map->values[face->twins[k] / 3] - (double)map->values[triangle]) / area;
        MesoComplex from = corners[k], to = corners[meso_next_side(k)];
        sum.re += rise * (to.im - from.im);     /* outward, and as long as the side */
        sum.im -= rise * (to.re - from.re);
    }
    return sum;
}

/* By a pixel to each side in the image, and how the triangle lies there. */
static MesoComplex image_gradient(const MesoGrowthGround *ground, const MesoGrowthMap *map, uint32_t triangle,
                                  const double weight[3])
{
    const MesoGrowthImage *image = &map->image;
    MesoComplex at = place_in_image(map, triangle, weight);
    double x = 0.5 * (image_at(image, at.re + 1, at.im) - image_at(image, at.re - 1, at.im));
    double y = 0.5 * (image_at(image, at.re, at.im + 1) - image_at(image, at.re, at.im - 1));
    double values[3];
    for (uint32_t k = 0; k < 3; k++) {
        const MesoVec2 uv = map->uvs[3 * (size_t)triangle + k], origin = map->uvs[3 * (size_t)triangle];
        values[k] = x * image->width * ((double)uv.x - (double)origin.x) +
                    y * image->height * ((double)uv.y - (double)origin.y);
    }
    return linear_gradient(ground, triangle, values);
}

MesoComplex meso_map_gradient(const MesoGrowthGround *ground, const MesoGrowthMap *map, uint32_t triangle,
                              const double weight[3])
{
    double values[3];
    switch (map->domain) {
    case MESO_GROWTH_CONSTANT: return (MesoComplex){0, 0};
    case MESO_GROWTH_BY_TRIANGLE: return stepped_gradient(ground, map, triangle);
    case MESO_GROWTH_BY_IMAGE: return image_gradient(ground, map, triangle, weight);
    case MESO_GROWTH_BY_VERTEX: case MESO_GROWTH_BY_CORNER: break;
    }
    corner_values(ground, map, triangle, values);
    return linear_gradient(ground, triangle, values);
}

/* ---- means ---- */

enum { MOST_SAMPLES = 64 };

static double image_mean(const MesoGrowthMap *map, uint32_t triangle, const double from[3], const double to[3])
{
    MesoComplex a = place_in_image(map, triangle, from), b = place_in_image(map, triangle, to);
    double pixels = ceil(fmax(fabs(b.re - a.re), fabs(b.im - a.im))), sum = 0;
    uint32_t count = pixels >= 1 && pixels < MOST_SAMPLES ? (uint32_t)pixels : pixels >= 1 ? MOST_SAMPLES : 1;
    for (uint32_t i = 0; i < count; i++) {
        double t = (i + 0.5) / count;
        sum += image_at(&map->image, a.re + t * (b.re - a.re), a.im + t * (b.im - a.im));
    }
    return sum / count;
}

double meso_map_mean(const MesoGrowthGround *ground, const MesoGrowthMap *map, uint32_t triangle,
                     const double from[3], const double to[3])
{
    if (map->domain == MESO_GROWTH_BY_IMAGE)
        return image_mean(map, triangle, from, to);
    return 0.5 * (meso_map_value(ground, map, triangle, from) + meso_map_value(ground, map, triangle, to));
}

double meso_map_pixels(const MesoGrowthMap *map, uint32_t triangle, const double from[3], const double to[3])
{
    if (map->domain != MESO_GROWTH_BY_IMAGE)
        return 0;
    MesoComplex a = place_in_image(map, triangle, from), b = place_in_image(map, triangle, to);
    return fmax(fabs(b.re - a.re), fabs(b.im - a.im));
}

/* ---- bounds ---- */

double meso_map_most(const MesoGrowthMap *map)
{
    double most = 0;
    if (map->domain == MESO_GROWTH_BY_IMAGE)
        for (size_t i = 0; i < (size_t)map->image.width * map->image.height; i++)
            most = (double)map->image.pixels[i] > most ? (double)map->image.pixels[i] : most;
    return most;
}

enum { MOST_PIXELS = 4096 };

static double image_bound(const MesoGrowthMap *map, uint32_t triangle, double most)
{
    static const double corners[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY, bound = -INFINITY;
    for (uint32_t k = 0; k < 3; k++) {
        MesoComplex at = place_in_image(map, triangle, corners[k]);
        low_x = fmin(low_x, floor(at.re - 0.5));
        low_y = fmin(low_y, floor(at.im - 0.5));
        high_x = fmax(high_x, floor(at.re + 0.5));
        high_y = fmax(high_y, floor(at.im + 0.5));
    }
    if (!((high_x - low_x + 1) * (high_y - low_y + 1) <= MOST_PIXELS && fabs(low_x) < 0x1p50 && fabs(low_y) < 0x1p50))
        return most;
    for (double y = low_y; y <= high_y; y++)
        for (double x = low_x; x <= high_x; x++)
            bound = fmax(bound, pixel(&map->image, (int64_t)x, (int64_t)y));
    return bound;
}

double meso_map_bound(const MesoGrowthMap *map, const MesoGrowthGround *ground, uint32_t triangle, double most)
{
    double values[3];
    static const double middle[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    if (map->domain == MESO_GROWTH_BY_IMAGE)
        return image_bound(map, triangle, most);
    if (map->domain == MESO_GROWTH_CONSTANT || map->domain == MESO_GROWTH_BY_TRIANGLE)
        return meso_map_value(ground, map, triangle, middle);
    corner_values(ground, map, triangle, values);
    return fmax(values[0], fmax(values[1], values[2]));
}
