/* What rectangles hold. */
#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/render/raster/raster_view.h"

static float between(MesoRandom *random, float low, float high)
{
    return low + (high - low) * (float)meso_random_below(random, 1 << 20) / (1 << 20);
}

static MesoVec3 within(MesoRandom *random, float reach)
{
    float x = between(random, -reach, reach), y = between(random, -reach, reach);
    return (MesoVec3){x, y, between(random, -reach, reach)};
}

static MesoRasterView make_view(MesoRandom *random, bool parallel)
{
    MesoVec3 forward = meso_vec3_unit(within(random, 1), (MesoVec3){0, 0, 1});
    MesoVec3 right = meso_vec3_unit(meso_vec3_cross(forward, (MesoVec3){0.3f, 1, 0.2f}), (MesoVec3){1, 0, 0});
    return (MesoRasterView){.eye = meso_vec3_scale(forward, -4), .right = right,
                            .down = meso_vec3_cross(forward, right), .forward = forward, .parallel = parallel,
                            .focal = 300, .middle_x = 200, .middle_y = 150, .near_depth = 0.1f};
}

/* A pixel inside of the rectangle, which is that much wider; and not nearer. */
static void check_within(const MesoRasterView *view, const MesoRasterRect *rect, MesoVec3 p)
{
    MesoVec3 q = meso_raster_from_eye(view, p);
    float scale = view->parallel ? view->focal : view->focal / q.z, slack = 1 - 1e-3f;
    float x = view->middle_x + scale * q.x, y = view->middle_y + scale * q.y;
    CHECK(x > rect->left + slack && x < rect->right - slack && y > rect->top + slack && y < rect->bottom - slack);
    CHECK(q.z >= rect->depth - 1e-5f);
}

static void test_around(MesoRandom *random, bool parallel)
{
    MesoRasterView view = make_view(random, parallel);
    MesoVec3 points[4];
    float reach = between(random, 0, 0.3f);
    MesoBox box = meso_box_empty();
    for (uint32_t i = 0; i < 4; i++) {
        points[i] = within(random, 1.5f);
        meso_box_add_around(&box, points[i], reach);
    }
    MesoRasterRect narrow = meso_raster_rect_around(&view, points, 4, reach), wide = meso_raster_rect(&view, &box);
    for (uint32_t i = 0; i < 64; i++) {
        MesoVec3 out = meso_vec3_unit(within(random, 1), (MesoVec3){0, 0, 1});
        MesoVec3 p = meso_vec3_lerp(points[i % 4], points[i / 4 % 4], between(random, 0, 1));
        check_within(&view, &narrow, meso_vec3_mad(p, reach, out));
        check_within(&view, &wide, meso_vec3_mad(p, reach, out));
    }
}

/* Behind the near plane there is no telling. */
static void test_behind(void)
{
    const MesoRasterView view = {.right = {1, 0, 0}, .down = {0, -1, 0}, .forward = {0, 0, 1}, .focal = 100,
                                 .near_depth = 0.1f};
    const MesoVec3 points[2] = {{0, 0, 1}, {0, 0, 0.2f}};
    MesoRasterRect rect = meso_raster_rect_around(&view, points, 2, 0.15f);
    CHECK(rect.left == -INFINITY && rect.right == INFINITY && rect.top == -INFINITY && rect.bottom == INFINITY);
    CHECK(isfinite(meso_raster_rect_around(&view, points, 2, 0.05f).left));
}

int main(void)
{
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    for (uint32_t i = 0; i < 400; i++)
        test_around(&random, i % 2);
    test_behind();
    return 0;
}
