#include "libcore/render/raster/raster_view.h"

MesoRasterView meso_raster_view(const MesoView *view, uint32_t width, uint32_t height, float near_depth)
{
    return (MesoRasterView){
        .eye = meso_vec3_sub(view->eye, view->anchor), .right = view->right, .down = meso_vec3_scale(view->up, -1),
        .forward = view->forward, .parallel = view->parallel, .focal = (float)height / (2 * view->half_height),
        .middle_x = 0.5f * (float)width, .middle_y = 0.5f * (float)height, .near_depth = near_depth};
}

/* Around a box along the view's axes, relative to the eye. */
static MesoRasterRect rect_of(const MesoRasterView *view, const MesoBox *seen)
{
    /* A side is farthest out where it is nearest, but for one that lies across the middle. */
    float low_x = seen->low.x, high_x = seen->high.x, low_y = seen->low.y, high_y = seen->high.y;
    float near_scale = view->parallel ? view->focal : view->focal / seen->low.z;
    float far_scale = view->parallel ? view->focal : view->focal / seen->high.z;
    return (MesoRasterRect){view->middle_x + low_x * (low_x < 0 ? near_scale : far_scale) - 1,
                            view->middle_y + low_y * (low_y < 0 ? near_scale : far_scale) - 1,
                            view->middle_x + high_x * (high_x > 0 ? near_scale : far_scale) + 1,
                            view->middle_y + high_y * (high_y > 0 ? near_scale : far_scale) + 1, seen->low.z};
}

/* Corners of the box from the eye, as a middle and half extents along the view's axes. */
MesoRasterRect meso_raster_rect(const MesoRasterView *view, const MesoBox *box)
{
    MesoVec3 middle = meso_vec3_lerp(box->low, box->high, 0.5f), half = meso_vec3_sub(box->high, middle);
    MesoVec3 q = meso_raster_from_eye(view, middle);
    const MesoVec3 *axes[3] = {&view->right, &view->down, &view->forward};
    float reach[3];
    for (int a = 0; a < 3; a++)
        reach[a] = fabsf(axes[a]->x) * half.x + fabsf(axes[a]->y) * half.y + fabsf(axes[a]->z) * half.z;
    float nearest = q.z - reach[2], farthest = q.z + reach[2];
    if (view->parallel && !(farthest >= view->near_depth))
        return (MesoRasterRect){INFINITY, INFINITY, -INFINITY, -INFINITY, view->near_depth};
    if (!view->parallel && !(nearest >= view->near_depth))
        return (MesoRasterRect){-INFINITY, -INFINITY, farthest >= view->near_depth ? INFINITY : -INFINITY, INFINITY,
                                view->near_depth};
    const MesoBox seen = {{q.x - reach[0], q.y - reach[1], nearest}, {q.x + reach[0], q.y + reach[1], farthest}};
    return rect_of(view, &seen);
}

MesoRasterRect meso_raster_rect_around(const MesoRasterView *view, const MesoVec3 *points, uint32_t count, float reach)
{
    MesoBox seen = meso_box_empty();
    for (uint32_t i = 0; i < count; i++)
        meso_box_add(&seen, meso_raster_from_eye(view, points[i]));
    seen = meso_box_wider(seen, reach);
    if (!view->parallel && !(seen.low.z >= view->near_depth))
        return (MesoRasterRect){-INFINITY, -INFINITY, INFINITY, INFINITY, view->near_depth};
    return rect_of(view, &seen);
}

/* ---- many points ---- */

/* As meso_raster_from_eye() and meso_raster_vertex(), without a branch. Whether some lie before the near plane. */
__attribute__((always_inline)) static inline bool project(const MesoRasterView *view, const float *x, const float *y,
                                                          const float *z, uint32_t count, bool parallel,
                                                          int32_t corner_x, int32_t corner_y,
                                                          const MesoRasterPoints *out)
{
    const MesoRasterView v = *view;
    int32_t *restrict out_x = out->x, *restrict out_y = out->y;
    float *restrict nearness = out->nearness;
    const float unit = MESO_RASTER_UNIT, far = 1 << 28, nearest = parallel ? -INFINITY : v.near_depth;
    uint32_t before = 0;
    for (uint32_t i = 0; i < count; i++) {
        float dx = x[i] - v.eye.x, dy = y[i] - v.eye.y, dz = z[i] - v.eye.z;
        float right = dx * v.right.x + dy * v.right.y + dz * v.right.z;
        float down = dx * v.down.x + dy * v.down.y + dz * v.down.z;
        float depth = dx * v.forward.x + dy * v.forward.y + dz * v.forward.z;
        before |= (uint32_t)!(depth >= nearest);
        depth = depth > nearest ? depth : nearest;
        float inverse = parallel ? 1 : 1 / depth, scale = v.focal * inverse;
        float px = (v.middle_x + scale * right) * unit, py = (v.middle_y + scale * down) * unit;
        px = px > far ? far : px < -far ? -far : px;
        py = py > far ? far : py < -far ? -far : py;
        out_x[i] = (int32_t)rintf(px) - corner_x;
        out_y[i] = (int32_t)rintf(py) - corner_y;
        nearness[i] = parallel ? -depth : inverse;
    }
    return before;
}

__attribute__((always_inline)) static inline bool project_all(const MesoRasterView *view, const float *x,
                                                              const float *y, const float *z, uint32_t count,
                                                              float left, float top, const MesoRasterPoints *out)
{
    int32_t corner_x = (int32_t)left * MESO_RASTER_UNIT, corner_y = (int32_t)top * MESO_RASTER_UNIT;
    return !(view->parallel ? project(view, x, y, z, count, true, corner_x, corner_y, out)
                            : project(view, x, y, z, count, false, corner_x, corner_y, out));
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static bool project_avx2(const MesoRasterView *view, const float *x, const float *y,
                                                         const float *z, uint32_t count, float left, float top,
                                                         const MesoRasterPoints *out)
{
    return project_all(view, x, y, z, count, left, top, out);
}
#endif

bool meso_raster_project(const MesoRasterView *view, const float *x, const float *y, const float *z, uint32_t count,
                         float left, float top, const MesoRasterPoints *out)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2"))
        return project_avx2(view, x, y, z, count, left, top, out);
#endif
    return project_all(view, x, y, z, count, left, top, out);
}
