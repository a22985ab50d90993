#include "libcore/growth/ground/map_picture.h"

typedef struct Canvas {
    const MesoGrowthGround *ground;
    const MesoGrowthMap *map;
    float *values;
    uint8_t *near;              /* [width * height] 1 more than how far from a triangle the value is; 0: none */
    uint32_t width, height;
} Canvas;

/* A triangle in pixels from the lower left corner. */
typedef struct Patch {
    uint32_t triangle;
    double x[3], y[3], area;
} Patch;

static uint32_t within(int64_t i, uint32_t size)
{
    int64_t rest = i % (int64_t)size;
    return (uint32_t)(rest < 0 ? rest + size : rest);
}

/* Of a pixel's middle; how far it lies outside, in pixels. */
static double weigh(const Patch *patch, double x, double y, double weight[3])
{
    double outside = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t a = (k + 1) % 3, b = (k + 2) % 3;
        double dx = patch->x[b] - patch->x[a], dy = patch->y[b] - patch->y[a];
        double twice = dx * (y - patch->y[a]) - dy * (x - patch->x[a]);
        weight[k] = twice / patch->area;
        outside = fmax(outside, -(patch->area > 0 ? twice : -twice) / sqrt(dx * dx + dy * dy));
    }
    return outside;
}

/* The value at the nearest place of the triangle, about. */
static float value_at(const Canvas *canvas, uint32_t triangle, const double weight[3])
{
    double inside[3], sum = 0;
    for (uint32_t k = 0; k < 3; k++)
        sum += inside[k] = fmax(weight[k], 0);
    for (uint32_t k = 0; k < 3; k++)
        inside[k] /= sum;
    return (float)meso_map_value(canvas->ground, canvas->map, triangle, inside);
}

static void draw_pixel(const Canvas *canvas, const Patch *patch, int64_t column, int64_t row)
{
    double weight[3], outside = weigh(patch, (double)column + 0.5, (double)row + 0.5, weight);
    if (!(outside <= MESO_MAP_GUTTER))
        return;
    size_t at = (size_t)(canvas->height - 1 - within(row, canvas->height)) * canvas->width +
                within(column, canvas->width);
    uint8_t near = (uint8_t)(1 + (uint32_t)ceil(outside));
    if (canvas->near[at] && canvas->near[at] < near)
        return;
    canvas->near[at] = near;
    canvas->values[at] = value_at(canvas, patch->triangle, weight);
}

static void draw_triangle(const Canvas *canvas, uint32_t triangle, const MesoVec2 *uvs)
{
    Patch patch = {.triangle = triangle};
    double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec2 uv = uvs[3 * (size_t)triangle + k];
        patch.x[k] = (double)uv.x * canvas->width;
        patch.y[k] = (double)uv.y * canvas->height;
        low_x = fmin(low_x, patch.x[k]);
        low_y = fmin(low_y, patch.y[k]);
        high_x = fmax(high_x, patch.x[k]);
        high_y = fmax(high_y, patch.y[k]);
    }
    patch.area = (patch.x[1] - patch.x[0]) * (patch.y[2] - patch.y[0]) -
                 (patch.y[1] - patch.y[0]) * (patch.x[2] - patch.x[0]);
    /* nor what would go around the picture many times */
    if (!(fabs(patch.area) > 0) || !(high_x - low_x < 4.0 * canvas->width && high_y - low_y < 4.0 * canvas->height) ||
        !(fabs(low_x) < 0x1p50 && fabs(low_y) < 0x1p50))
        return;
    for (int64_t r = (int64_t)floor(low_y) - MESO_MAP_GUTTER; r <= (int64_t)floor(high_y) + MESO_MAP_GUTTER; r++)
        for (int64_t c = (int64_t)floor(low_x) - MESO_MAP_GUTTER; c <= (int64_t)floor(high_x) + MESO_MAP_GUTTER; c++)
            draw_pixel(canvas, &patch, c, r);
}

MesoStatus meso_map_picture(float *values, uint32_t width, uint32_t height, const MesoGrowthGround *ground,
                            const MesoGrowthMap *map, const MesoVec2 *uvs, MesoArena *scratch, MesoError *error)
{
    size_t count = (size_t)width * height;
    MesoArenaMark mark = meso_arena_mark(scratch);
    Canvas canvas = {ground, map, values, MESO_NEW(scratch, uint8_t, count, error), width, height};
    if (!canvas.near)
        return MESO_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        values[i] = NAN;
    for (uint32_t t = 0; t < ground->mesh->triangle_count; t++)
        draw_triangle(&canvas, t, uvs);
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
