#include "libcore/render/raster/raster_view.h"

MesoRasterView meso_raster_view(const MesoView *view, uint32_t width, uint32_t height, float near_depth)
{
    return (MesoRasterView){
        .eye = meso_vec3_sub(view->eye, view->anchor), .right = view->right, .down = meso_vec3_scale(view->up, -1),
        .forward = view->forward, .focal = (float)height / (2 * view->tan_half_fov), .middle_x = 0.5f * (float)width,
        .middle_y = 0.5f * (float)height, .near_depth = near_depth};
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
    if (!view->parallel && !(nearest >= view->near_depth))
        return (MesoRasterRect){-INFINITY, -INFINITY, farthest >= view->near_depth ? INFINITY : -INFINITY, INFINITY,
                                view->near_depth};
    /* A side is farthest out where it is nearest, but for one that lies across the middle. */
    float low_x = q.x - reach[0], high_x = q.x + reach[0], low_y = q.y - reach[1], high_y = q.y + reach[1];
    float near_scale = view->parallel ? view->focal : view->focal / nearest;
    float far_scale = view->parallel ? view->focal : view->focal / farthest;
    return (MesoRasterRect){view->middle_x + low_x * (low_x < 0 ? near_scale : far_scale) - 1,
                            view->middle_y + low_y * (low_y < 0 ? near_scale : far_scale) - 1,
                            view->middle_x + high_x * (high_x > 0 ? near_scale : far_scale) + 1,
                            view->middle_y + high_y * (high_y > 0 ? near_scale : far_scale) + 1, nearest};
}
