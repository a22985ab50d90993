/* From the world to a raster: perspective or parallel, in units of a pixel's 256th part. */
#ifndef MESO_RASTER_VIEW_H
#define MESO_RASTER_VIEW_H

#include "libcore/math/box.h"
#include "libcore/render/projection.h"
#include "libcore/render/raster/raster_target.h"

/* All of it relative to an anchor; `right`, `down` and `forward` are orthonormal. */
typedef struct MesoRasterView {
    MesoVec3 eye, right, down, forward;
    bool parallel;
    float focal;                /* pixels of one unit at depth 1, or anywhere where it is parallel */
    float middle_x, middle_y;   /* pixels */
    float near_depth;           /* what is nearer is cut off */
} MesoRasterView;

MesoRasterView meso_raster_view(const MesoView *view, uint32_t width, uint32_t height, float near_depth);

/* Right, down and depth from the eye. */
static inline MesoVec3 meso_raster_from_eye(const MesoRasterView *view, MesoVec3 p)
{
    MesoVec3 q = meso_vec3_sub(p, view->eye);
    return (MesoVec3){meso_vec3_dot(q, view->right), meso_vec3_dot(q, view->down), meso_vec3_dot(q, view->forward)};
}

/* Of a point from the eye, not nearer than the near plane, on a target whose corner is the pixel (left, top). */
static inline MesoRasterVertex meso_raster_vertex(const MesoRasterView *view, MesoVec3 q, float left, float top)
{
    const float unit = MESO_RASTER_UNIT, far = 1 << 28;
    float inverse = view->parallel ? 1 : 1 / q.z, scale = view->focal * inverse;
    float x = (view->middle_x + scale * q.x) * unit, y = (view->middle_y + scale * q.y) * unit;
    x = x > far ? far : x < -far ? -far : x;
    y = y > far ? far : y < -far ? -far : y;
    /* Rounded before the target's corner is taken off: the same on every target. */
    return (MesoRasterVertex){(int32_t)lrintf(x) - (int32_t)left * MESO_RASTER_UNIT,
                              (int32_t)lrintf(y) - (int32_t)top * MESO_RASTER_UNIT,
                              view->parallel ? -q.z : inverse};
}

/*
 * Points by their coordinates, relative to the anchor, to vertices: the same as one by one. Points before the near
 * plane are taken for ones on it; returns whether there were none.
 */
bool meso_raster_project(const MesoRasterView *view, const float *x, const float *y, const float *z, uint32_t count,
                         float left, float top, const MesoRasterPoints *out);

/* The ray through a place of the picture, in units of depth, from depth 0. */
typedef struct MesoRasterRay {
    MesoVec3 origin, direction;
} MesoRasterRay;

static inline MesoRasterRay meso_raster_ray(const MesoRasterView *view, float x, float y)
{
    float right = (x - view->middle_x) / view->focal, down = (y - view->middle_y) / view->focal;
    MesoVec3 across = meso_vec3_add(meso_vec3_scale(view->right, right), meso_vec3_scale(view->down, down));
    if (view->parallel)
        return (MesoRasterRay){meso_vec3_add(view->eye, across), view->forward};
    return (MesoRasterRay){view->eye, meso_vec3_add(across, view->forward)};
}

/* Scene units of a pixel at that depth. */
static inline float meso_raster_pixel(const MesoRasterView *view, float depth)
{
    return view->parallel ? 1 / view->focal : depth / view->focal;
}

/* A rectangle of pixels, ends not included. */
typedef struct MesoRasterRect {
    float left, top, right, bottom;
    float depth;                /* of the nearest point; at most that of the near plane where it is cut off */
} MesoRasterRect;

/* Holds what is in the box; everything where the box reaches behind the near plane. */
MesoRasterRect meso_raster_rect(const MesoRasterView *view, const MesoBox *box);

/*
 * The same around balls of one radius about `points` [count], which is narrower; but what is behind a parallel view's
 * near plane is not left out.
 */
MesoRasterRect meso_raster_rect_around(const MesoRasterView *view, const MesoVec3 *points, uint32_t count, float reach);

/* Whether the middle of some pixel may be covered by what is in the box of such a rectangle, which is a pixel wider. */
static inline bool meso_raster_rect_has_middle(const MesoRasterRect *rect)
{
    const float slack = 2.f / MESO_RASTER_UNIT;
    return ceilf(rect->left + 0.5f - slack) <= floorf(rect->right - 1.5f + slack) &&
           ceilf(rect->top + 0.5f - slack) <= floorf(rect->bottom - 1.5f + slack);
}

#endif
