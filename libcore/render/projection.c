#include "libcore/render/projection.h"

/* Any direction that is not parallel to `axis`. */
static MesoVec3 across(MesoVec3 axis)
{
    return fabsf(axis.y) < 0.9f ? (MesoVec3){0, 1, 0} : (MesoVec3){0, 0, 1};
}

static void build_basis(MesoVec3 forward, MesoVec3 up, MesoVec3 *right, MesoVec3 *true_up)
{
    MesoVec3 side = meso_vec3_cross(forward, up);
    if (!(meso_vec3_length(side) > 1e-4f * meso_vec3_length(up)))
        side = meso_vec3_cross(forward, across(forward));
    *right = meso_vec3_unit(side, (MesoVec3){1, 0, 0});
    *true_up = meso_vec3_cross(*right, forward);
}

MesoStatus meso_view_build(MesoView *view, const MesoCamera *camera, MesoError *error)
{
    MesoVec3 forward = meso_vec3_sub(camera->target, camera->eye);
    float distance = meso_vec3_length(forward);
    if (!meso_vec3_finite(camera->eye) || !meso_vec3_finite(camera->target)
        || !meso_vec3_finite(camera->up) || !isfinite(distance))
        return meso_fail(error, MESO_ERR_USAGE, "camera is not finite");
    if (!(distance > 0))
        return meso_fail(error, MESO_ERR_USAGE, "camera's eye and target are the same point");
    if (!(camera->fov_degrees > 0 && camera->fov_degrees < 180))
        return meso_fail(error, MESO_ERR_USAGE, "field of view of %g degrees is not between 0 and 180",
                         (double)camera->fov_degrees);
    if (!(camera->height >= 0 && isfinite(camera->height)))
        return meso_fail(error, MESO_ERR_USAGE, "an orthographic view cannot be %g high", (double)camera->height);

    view->eye = camera->eye;
    view->anchor = (MesoVec3){0, 0, 0};
    view->forward = meso_vec3_scale(forward, 1 / distance);
    build_basis(view->forward, camera->up, &view->right, &view->up);
    view->parallel = camera->height > 0;
    view->half_height = view->parallel ? 0.5f * camera->height
                                       : tanf(camera->fov_degrees * (float)(3.14159265358979323846 / 360));
    return MESO_OK;
}

/* The multiple of a power of two, `step`, next to `x`. */
static float coarse(float x, float step)
{
    return step * rintf(x / step);
}

MesoVec3 meso_box_anchor(MesoVec3 low, MesoVec3 high)
{
    int exponent;
    float size = meso_vec3_length(meso_vec3_sub(high, low));
    (void)frexpf(size, &exponent);
    float step = ldexpf(1, exponent + 4);   /* 16 to 32 sizes */
    MesoVec3 middle = meso_vec3_lerp(low, high, 0.5f);
    MesoVec3 anchor = {coarse(middle.x, step), coarse(middle.y, step), coarse(middle.z, step)};
    return isfinite(size) && meso_vec3_finite(anchor) ? anchor : (MesoVec3){0, 0, 0};
}

static void set_row(MesoMatrix *matrix, uint32_t row, MesoVec3 axis, float offset)
{
    matrix->m[row] = axis.x;
    matrix->m[row + 4] = axis.y;
    matrix->m[row + 8] = axis.z;
    matrix->m[row + 12] = offset;
}

/* Rows x and y, on NDC of the whole image, become those of the window, by X' = s X + o w. */
MesoMatrix meso_view_clip_from_world(const MesoView *view, float end_depth, uint32_t width,
                                     uint32_t height, MesoWindow window)
{
    float full_x = (float)width, full_y = (float)height;
    float part_x = (float)window.width, part_y = (float)window.height;
    float scale_x = full_x / part_x, offset_x = (full_x - 2 * (float)window.x) / part_x - 1;
    float scale_y = -full_y / part_y, offset_y = (full_y - 2 * (float)window.y) / part_y - 1;
    float focal_y = 1 / view->half_height, focal_x = focal_y * full_y / full_x;

    MesoVec3 x = meso_vec3_scale(view->right, focal_x * scale_x), y = meso_vec3_scale(view->up, focal_y * scale_y);
    MesoVec3 eye = meso_vec3_sub(view->eye, view->anchor);
    MesoMatrix matrix;
    if (view->parallel) {
        MesoVec3 z = meso_vec3_scale(view->forward, -1 / end_depth);
        set_row(&matrix, 0, x, offset_x - meso_vec3_dot(x, eye));
        set_row(&matrix, 1, y, offset_y - meso_vec3_dot(y, eye));
        set_row(&matrix, 2, z, 1 - meso_vec3_dot(z, eye));
        set_row(&matrix, 3, (MesoVec3){0, 0, 0}, 1);
        return matrix;
    }
    x = meso_vec3_add(x, meso_vec3_scale(view->forward, offset_x));
    y = meso_vec3_add(y, meso_vec3_scale(view->forward, offset_y));
    set_row(&matrix, 0, x, -meso_vec3_dot(x, eye));
    set_row(&matrix, 1, y, -meso_vec3_dot(y, eye));
    set_row(&matrix, 2, (MesoVec3){0, 0, 0}, end_depth);
    set_row(&matrix, 3, view->forward, -meso_vec3_dot(view->forward, eye));
    return matrix;
}
