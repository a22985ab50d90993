#include "libcore/render/raster/raster_hidden.h"

#include <stddef.h>

/* Pixels of the window in which a rectangle may cover a sample, the last ones included. */
typedef struct Pixels {
    int32_t left, top, right, bottom;
} Pixels;

static int32_t first_pixel(float pixel, uint32_t begin, uint32_t count)
{
    float at = pixel - (float)begin;
    return at > 0 ? at < (float)count ? (int32_t)at : (int32_t)count : 0;
}

static int32_t last_pixel(float pixel, uint32_t begin, uint32_t count)
{
    float at = pixel - (float)begin;
    return at < (float)(count - 1) ? at >= 0 ? (int32_t)at : -1 : (int32_t)count - 1;
}

static Pixels pixels_of(const MesoWindow *w, bool middles, const MesoRasterRect *r)
{
    const float slack = 2.f / MESO_RASTER_UNIT;
    float left = middles ? ceilf(r->left + 0.5f - slack) : floorf(r->left + 1 - slack);
    float top = middles ? ceilf(r->top + 0.5f - slack) : floorf(r->top + 1 - slack);
    float right = middles ? floorf(r->right - 1.5f + slack) : floorf(r->right - 1 + slack);
    float bottom = middles ? floorf(r->bottom - 1.5f + slack) : floorf(r->bottom - 1 + slack);
    return (Pixels){first_pixel(left, w->x, w->width), first_pixel(top, w->y, w->height),
                    last_pixel(right, w->x, w->width), last_pixel(bottom, w->y, w->height)};
}

/* The samples of a pixel. Cells have a power of two of pixels a side, whose exponent is `shift`. */
static inline bool is_covered(const MesoRasterTarget *target, uint32_t x, uint32_t y, uint32_t shift, float nearest)
{
    const MesoRasterLanes *lanes = target->lanes;
    uint32_t mask = lanes->pixels - 1, lane = (((y & mask) << shift) + (x & mask)) * lanes->samples;
    size_t cell = (size_t)(y >> shift) * (size_t)target->cells_x + (x >> shift);
    const float *there = target->nearness + MESO_RASTER_LANES * cell + lane;
    for (uint32_t i = 0; i < lanes->samples; i++)
        if (!(there[i] > nearest))
            return false;
    return true;
}

bool meso_raster_hides(const MesoRasterTarget *target, const MesoWindow *window, const MesoRasterView *view,
                       const MesoRasterRect *rect)
{
    enum { MOST_PIXELS = 1024 };        /* of more, one is soon seen */
    Pixels p = pixels_of(window, target->lanes->samples == 1, rect);
    if (p.left > p.right || p.top > p.bottom)
        return true;
    if ((p.right - p.left + 1) * (p.bottom - p.top + 1) > MOST_PIXELS || !(rect->depth > view->near_depth))
        return false;
    /* What triangles are nearer than their corners by rounding is far less. */
    uint32_t shift = (uint32_t)__builtin_ctz(target->lanes->pixels);
    float nearest = view->parallel ? 0.01f / view->focal - rect->depth : 1.00001f / rect->depth;
    for (int32_t y = p.top; y <= p.bottom; y++)
        for (int32_t x = p.left; x <= p.right; x++)
            if (!is_covered(target, (uint32_t)x, (uint32_t)y, shift, nearest))
                return false;
    return true;
}
