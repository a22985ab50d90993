/* Framing: everything inside, touching the margin on two sides. And matrices. */
#include <math.h>

#include "libcore/base/check.h"
#include "libcore/render/camera.h"
#include "libcore/render/projection.h"
#include "libcore/scene/placed.h"

/* Position on the picture, -1 to 1 on both axes, y down. */
static MesoVec2 project(const MesoMatrix *m, MesoVec3 p)
{
    float c[4];
    for (int row = 0; row < 4; row++)
        c[row] = m->m[row] * p.x + m->m[4 + row] * p.y + m->m[8 + row] * p.z + m->m[12 + row];
    CHECK(c[3] > 0);
    return (MesoVec2){c[0] / c[3], c[1] / c[3]};
}

static MesoMatrix matrix_of(const MesoCamera *camera, uint32_t width, uint32_t height, MesoWindow window)
{
    MesoView view;
    MesoError error;
    CHECK(meso_view_build(&view, camera, &error) == MESO_OK);
    return meso_view_clip_from_world(&view, 0.1f, width, height, window);
}

/* The box fills 0.9 of the picture in one direction, both sides alike. */
static void test_frame(MesoVec3 low, MesoVec3 high, MesoVec3 up, uint32_t width, uint32_t height)
{
    MesoCamera camera = meso_camera_frame(low, high, up, 30, (float)width / (float)height);
    MesoMatrix m = matrix_of(&camera, width, height, (MesoWindow){0, 0, width, height});
    MesoVec2 least = {2, 2}, most = {-2, -2};
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec2 p = project(&m, meso_box_corner(low, high, i));
        least = (MesoVec2){fminf(least.x, p.x), fminf(least.y, p.y)};
        most = (MesoVec2){fmaxf(most.x, p.x), fmaxf(most.y, p.y)};
    }
    CHECK(least.x > -0.9001f && most.x < 0.9001f && least.y > -0.9001f && most.y < 0.9001f);
    bool fits_x = fabsf(least.x + 0.9f) < 1e-3f && fabsf(most.x - 0.9f) < 1e-3f;
    bool fits_y = fabsf(least.y + 0.9f) < 1e-3f && fabsf(most.y - 0.9f) < 1e-3f;
    CHECK(fits_x || fits_y);
    CHECK(fabsf(project(&m, camera.target).x) < 1e-5f && fabsf(project(&m, camera.target).y) < 1e-5f);
    MesoVec3 above = meso_vec3_mad(camera.target, 0.1f, up);
    CHECK(project(&m, above).y < 0);
    CHECK(meso_vec3_dot(meso_vec3_sub(camera.eye, camera.target), up) > 0);
}

/* Far away the camera is as near to the box as at the origin, within the rounding of that place. */
static void test_far(MesoVec3 place)
{
    MesoVec3 low = {-1, -1, -1}, high = {1, 1, 1}, up = {0, 1, 0};
    MesoVec3 far_low = meso_vec3_add(low, place), far_high = meso_vec3_add(high, place);
    MesoVec3 anchor = meso_box_anchor(far_low, far_high);
    MesoCamera near = meso_camera_frame(low, high, up, 30, 1.5f);
    MesoCamera far = meso_camera_frame(far_low, far_high, up, 30, 1.5f);
    CHECK(meso_vec3_length(meso_vec3_sub(meso_vec3_sub(far.eye, place), near.eye)) < 0.07f);
    CHECK(meso_vec3_length(meso_vec3_sub(meso_vec3_sub(far.target, place), near.target)) < 0.07f);

    MesoView view;
    CHECK(meso_view_build(&view, &far, NULL) == MESO_OK);
    view.anchor = anchor;
    MesoMatrix m = meso_view_clip_from_world(&view, 0.1f, 300, 200, (MesoWindow){0, 0, 300, 200});
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec3 corner = meso_box_corner(far_low, far_high, i);
        MesoVec3 to_corner = meso_vec3_sub(corner, far.eye);
        MesoVec2 p = project(&m, meso_vec3_sub(corner, anchor));
        float depth = meso_vec3_dot(to_corner, view.forward) * view.half_height;
        CHECK(fabsf(p.x - meso_vec3_dot(to_corner, view.right) / (1.5f * depth)) < 1e-5f);
        CHECK(fabsf(p.y + meso_vec3_dot(to_corner, view.up) / depth) < 1e-5f);
        CHECK(fabsf(p.x) < 0.95f && fabsf(p.y) < 0.95f);
    }
}

static void test_anchor(void)
{
    MesoVec3 one = {1, 1, 1}, low = {-6, 0, 1e6f}, far = {1e6f, -1e6f, 3e6f};
    MesoVec3 a = meso_box_anchor(low, meso_vec3_add(low, one));
    CHECK(a.x == 0 && a.y == 0 && fabsf(a.z - 1e6f) <= 16);
    a = meso_box_anchor(far, meso_vec3_add(far, one));
    MesoVec3 back = meso_vec3_add(a, meso_vec3_sub(far, a));
    CHECK(back.x == far.x && back.y == far.y && back.z == far.z);
    const MesoVec3 ends[] = {{INFINITY, 0, 0}, {3e38f, 3e38f, 3e38f}, {1e38f, 0, 0}, {NAN, 0, 0}, {0, 0, 0}};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        a = meso_box_anchor(meso_vec3_scale(ends[i], -1), ends[i]);
        CHECK(a.x == 0 && a.y == 0 && a.z == 0);
    }
}

static void test_degenerate(void)
{
    MesoView view;
    MesoVec3 point = {3, 4, 5};
    MesoCamera camera = meso_camera_frame(point, point, (MesoVec3){0, 1, 0}, 30, 1);
    CHECK(meso_view_build(&view, &camera, NULL) == MESO_OK);
    MesoVec3 none = {INFINITY, INFINITY, INFINITY}, nothing = {-INFINITY, -INFINITY, -INFINITY};
    camera = meso_camera_frame(none, nothing, (MesoVec3){0, 0, 0}, 30, 1);
    CHECK(meso_vec3_finite(camera.eye) && meso_view_build(&view, &camera, NULL) == MESO_OK);

    camera = (MesoCamera){{0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 30, 0};     /* up along the view */
    CHECK(meso_view_build(&view, &camera, NULL) == MESO_OK);
    CHECK(fabsf(meso_vec3_length(view.right) - 1) < 1e-6f && fabsf(meso_vec3_length(view.up) - 1) < 1e-6f);
    camera.fov_degrees = 180;
    CHECK(meso_view_build(&view, &camera, NULL) == MESO_ERR_USAGE);
    camera = (MesoCamera){{0, 5, 0}, {0, 5, 0}, {0, 1, 0}, 30, 0};
    CHECK(meso_view_build(&view, &camera, NULL) == MESO_ERR_USAGE);
}

/* The pixel of a point is the same through every window. */
static void test_windows(void)
{
    MesoCamera camera = {{1, 2, 8}, {0, 0.2f, 0}, {0, 1, 0}, 40, 0};
    MesoVec3 p = {0.7f, -0.4f, 0.3f};
    MesoMatrix whole = matrix_of(&camera, 640, 360, (MesoWindow){0, 0, 640, 360});
    MesoMatrix part = matrix_of(&camera, 640, 360, (MesoWindow){200, 100, 300, 200});
    MesoVec2 a = project(&whole, p), b = project(&part, p);
    CHECK(fabsf((a.x + 1) * 320 - (200 + (b.x + 1) * 150)) < 1e-3f);
    CHECK(fabsf((a.y + 1) * 180 - (100 + (b.y + 1) * 100)) < 1e-3f);
}

/* As perspective, and the box fills 0.9 of the height or the width, with all of it before the eye. */
static void test_parallel(MesoVec3 low, MesoVec3 high, MesoVec3 up, uint32_t width, uint32_t height)
{
    MesoScene scene = {.box = {low, high}};
    MesoBody body = {.vertex_count = 8};
    MesoVec3 corners[8];
    for (uint32_t i = 0; i < 8; i++)
        corners[i] = meso_box_corner(low, high, i);
    const MesoPlacedBody placed = {.place = MESO_PLACED_HERE};
    body.positions = corners;
    scene.bodies = &body;
    scene.placed = (MesoPlacedBody *)&placed;
    scene.body_count = scene.placed_count = 1;
    MesoCamera camera = meso_camera_frame_scene_parallel(&scene, up, (float)width / (float)height);
    MesoView view;
    CHECK(camera.height > 0 && meso_view_build(&view, &camera, NULL) == MESO_OK && view.parallel);
    float far = 4 * meso_vec3_length(meso_vec3_sub(high, low)), most = 0;
    view.anchor = meso_box_anchor(low, high);
    MesoMatrix m = meso_view_clip_from_world(&view, far, width, height, (MesoWindow){0, 0, width, height});
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec3 corner = meso_vec3_sub(corners[i], view.anchor), from = meso_vec3_sub(corners[i], view.eye);
        MesoVec2 p = project(&m, corner);
        float z = m.m[2] * corner.x + m.m[6] * corner.y + m.m[10] * corner.z + m.m[14];
        CHECK(fabsf(p.y + meso_vec3_dot(from, view.up) / (0.5f * camera.height)) < 1e-3f);
        float half_width = 0.5f * camera.height * (float)width / (float)height;
        CHECK(fabsf(p.x - meso_vec3_dot(from, view.right) / half_width) < 1e-3f);
        CHECK(fabsf(z - 1 + meso_vec3_dot(from, view.forward) / far) < 1e-3f && z > 0 && z < 1);
        most = fmaxf(most, fmaxf(fabsf(p.x), fabsf(p.y)));
    }
    CHECK(fabsf(most - 0.9f) < 1e-2f);
    camera.target = meso_vec3_mad(camera.target, 0.5f * camera.height, view.up);      /* off the middle it takes more */
    camera.eye = meso_vec3_mad(camera.eye, 0.5f * camera.height, view.up);
    CHECK(meso_camera_fit_height(&scene, &camera, (float)width / (float)height) > 1.2f * camera.height);
}

/* The same camera to the last bit, in whatever order sweeps come: those that are passed over reach nowhere new. */
static void test_order_of_sweeps(float stretch)
{
    enum { COUNT = 500 };
    static MesoSweepInstance sweeps[COUNT], backwards[COUNT];
    MesoSweptKind kind = {.instance_count = COUNT};
    MesoScene scene = {.section_scale = 1, .kind_count = 1, .kinds = &kind, .sweep_count = COUNT, .sweeps = sweeps};
    uint32_t state = 7;
    for (uint32_t i = 0; i < COUNT; i++) {
        float at[3];
        for (uint32_t k = 0; k < 12; k++) {
            state = state * 1664525u + 1013904223u;
            float along = (float)(state >> 8) / 16777216 - 0.5f;
            at[k % 3] = k < 3 ? 100 * along : at[k % 3] + stretch * along;
            (&sweeps[i].p[k / 3].x)[k % 3] = at[k % 3];
        }
        sweeps[i].p[3].y = i == 250 ? NAN : sweeps[i].p[3].y;
        backwards[COUNT - 1 - i] = sweeps[i];
    }
    scene.box = (MesoBox){{-60, -60, -60}, {60, 60, 60}};
    MesoCamera camera = meso_camera_frame_scene(&scene, (MesoVec3){0, 1, 0}, 30, 1.5f);
    MesoCamera level = meso_camera_frame_scene_parallel(&scene, (MesoVec3){0, 1, 0}, 1.5f);
    scene.sweeps = backwards;
    MesoCamera again = meso_camera_frame_scene(&scene, (MesoVec3){0, 1, 0}, 30, 1.5f);
    MesoCamera level_again = meso_camera_frame_scene_parallel(&scene, (MesoVec3){0, 1, 0}, 1.5f);
    CHECK(meso_vec3_length(meso_vec3_sub(camera.eye, again.eye)) == 0 && camera.eye.z > 100);
    CHECK(meso_vec3_length(meso_vec3_sub(camera.target, again.target)) == 0);
    CHECK(level.height == level_again.height && level.height > 100);
}

static void test_lenses(void)
{
    CHECK(fabsf(meso_camera_fov(50, 36, 1.5f) - 26.991f) < 1e-2f);     /* 35 mm film: 24 mm high */
    CHECK(fabsf(meso_camera_fov(12, 24, 1) - 90) < 1e-4f);
}

int main(void)
{
    MesoVec3 y = {0, 1, 0}, z = {0, 0, 1};
    test_frame((MesoVec3){-1, -1, -1}, (MesoVec3){1, 1, 1}, y, 1280, 720);
    test_frame((MesoVec3){10, 0, 5}, (MesoVec3){12, 9, 6}, y, 720, 1280);
    test_frame((MesoVec3){0, 0, 0}, (MesoVec3){1, 1e-3f, 1}, y, 500, 500);
    test_frame((MesoVec3){-3, -2, 0}, (MesoVec3){1, 1, 2}, z, 1280, 720);
    test_far((MesoVec3){1e6f, 0, 0});
    test_far((MesoVec3){-3e5f, 1e6f, 5e5f});
    test_anchor();
    test_degenerate();
    test_windows();
    test_parallel((MesoVec3){-1, -1, -1}, (MesoVec3){1, 1, 1}, y, 1280, 720);
    test_parallel((MesoVec3){10, 0, 5}, (MesoVec3){12, 9, 6}, y, 720, 1280);
    test_parallel((MesoVec3){1e5f, -2e5f, 0}, (MesoVec3){1e5f + 4, -2e5f + 3, 2}, z, 500, 500);
    test_order_of_sweeps(1);
    test_order_of_sweeps(20);
    test_order_of_sweeps(300);
    test_lenses();
    return 0;
}
