/*
 * Framing. Seen along a fixed direction, the eye (x, y, z) in the axes of the
 * view must satisfy |p.x - x| <= t (z - p.z) for every point p of the object,
 * and the same for y: with A = max(p.x + t p.z) and B = max(t p.z - p.x), the
 * nearest such eye has z = (A + B) / (2 t) and x = (A - B) / 2. Seen orthographically t is 0, and A + B the width.
 */
#include "libcore/render/camera.h"
#include "libcore/render/projection.h"

#include <float.h>
#include <string.h>

#include "libcore/scene/cell.h"
#include "libcore/scene/placed.h"
#include "libcore/scene/sweep_maker.h"

/* Share of the picture that stays empty at each side. */
static const float MARGIN = 0.05f;

/* From the front, a little from the right and above; +Y is up, as in the OBJ files of modellers. */
static const MesoVec3 TOWARDS_EYE = {0.5f, 0.45f, 1.0f};

/* Support of the object in the four planes of the frustum, and across it. */
typedef struct Frame {
    MesoVec3 right, up, back;
    float tan_x, tan_y;
    float pad_x, pad_y;                                 /* of a ball, over its radius: 1 / cos */
    MesoVec3 world_up, anchor;                          /* what follows is relative to the anchor */
    float left_most, right_most, low_most, high_most;   /* A and B of both axes */
    float deepest, nearest;
} Frame;

/* TOWARDS_EYE in a world whose up is `up`: +Z stays the front as long as it can. */
static MesoVec3 towards_eye(MesoVec3 up)
{
    MesoVec3 y = meso_vec3_unit(up, (MesoVec3){0, 1, 0});
    MesoVec3 front = fabsf(y.z) < 0.9f ? (MesoVec3){0, 0, 1} : (MesoVec3){0, -1, 0};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(y, front), (MesoVec3){1, 0, 0});
    MesoVec3 z = meso_vec3_cross(x, y);
    MesoVec3 side = meso_vec3_mad(meso_vec3_scale(x, TOWARDS_EYE.x), TOWARDS_EYE.y, y);
    return meso_vec3_mad(side, TOWARDS_EYE.z, z);
}

static float pad_of(float tan)
{
    return sqrtf(1 + tan * tan);
}

/* `low` and `high`: the box that the object lies in, to be precise where it is far away. */
static Frame begin_frame(MesoVec3 low, MesoVec3 high, MesoVec3 up, float fov_degrees, float aspect)
{
    MesoCamera camera = {towards_eye(up), {0, 0, 0}, up, fov_degrees, 0};
    MesoView view;
    if (meso_view_build(&view, &camera, NULL)) {
        camera.up = (MesoVec3){0, 1, 0};
        camera.fov_degrees = 30;
        meso_view_build(&view, &camera, NULL);
    }
    float t = view.half_height * (1 - 2 * MARGIN);
    float none = -INFINITY;
    return (Frame){view.right, view.up, meso_vec3_scale(view.forward, -1), t * aspect, t, pad_of(t * aspect), pad_of(t),
                   up, meso_box_anchor(low, high), none, none, none, none, INFINITY, none};
}

/* Of two finite numbers; quicker than fmaxf(), which looks for others. */
static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

static inline void add_ball(Frame *frame, MesoVec3 center, float radius)
{
    MesoVec3 place = meso_vec3_sub(center, frame->anchor);
    float x = meso_vec3_dot(place, frame->right);
    float y = meso_vec3_dot(place, frame->up);
    float z = meso_vec3_dot(place, frame->back);
    if (!isfinite(x + y + z + radius))
        return;
    float pad_x = radius * frame->pad_x, pad_y = radius * frame->pad_y;
    frame->right_most = larger(frame->right_most, frame->tan_x * z + x + pad_x);
    frame->left_most = larger(frame->left_most, frame->tan_x * z - x + pad_x);
    frame->high_most = larger(frame->high_most, frame->tan_y * z + y + pad_y);
    frame->low_most = larger(frame->low_most, frame->tan_y * z - y + pad_y);
    frame->nearest = larger(frame->nearest, z + radius);
    frame->deepest = -larger(-frame->deepest, radius - z);
}

static MesoCamera end_frame(const Frame *frame, float fov_degrees)
{
    float x = 0, y = 0, z = 1, middle = 0;
    if (frame->nearest >= frame->deepest) {
        x = 0.5f * (frame->right_most - frame->left_most);
        y = 0.5f * (frame->high_most - frame->low_most);
        z = fmaxf(0.5f * (frame->right_most + frame->left_most) / frame->tan_x,
                  0.5f * (frame->high_most + frame->low_most) / frame->tan_y);
        middle = 0.5f * (frame->nearest + frame->deepest);
        /* What is smaller than the rounding of its place has no size to fit. */
        MesoVec3 far = frame->anchor;
        float least = 1e-5f * (fabsf(x) + fabsf(y) + fabsf(middle))
                      + FLT_EPSILON * (fabsf(far.x) + fabsf(far.y) + fabsf(far.z));
        if (!(z - frame->nearest > least))
            z = frame->nearest + fmaxf(100 * least, 1e-3f);
    }
    MesoVec3 axis = meso_vec3_mad(meso_vec3_scale(frame->right, x), y, frame->up);
    MesoVec3 eye = meso_vec3_mad(axis, z, frame->back), target = meso_vec3_mad(axis, middle, frame->back);
    return (MesoCamera){meso_vec3_add(frame->anchor, eye), meso_vec3_add(frame->anchor, target),
                        frame->world_up, fov_degrees, 0};
}

MesoCamera meso_camera_frame(MesoVec3 low, MesoVec3 high, MesoVec3 up, float fov_degrees, float aspect)
{
    Frame frame = begin_frame(low, high, up, fov_degrees, aspect);
    for (uint32_t i = 0; i < 8; i++)
        add_ball(&frame, meso_box_corner(low, high, i), 0);
    return end_frame(&frame, fov_degrees);
}

static MesoVec3 curve_point(const MesoVec3 p[4], float t)
{
    MesoVec3 a = meso_vec3_lerp(p[0], p[1], t), b = meso_vec3_lerp(p[1], p[2], t);
    MesoVec3 c = meso_vec3_lerp(p[2], p[3], t);
    return meso_vec3_lerp(meso_vec3_lerp(a, b, t), meso_vec3_lerp(b, c, t), t);
}

static float sum_of_sides(MesoVec3 a)
{
    return fabsf(a.x) + fabsf(a.y) + fabsf(a.z);
}

/*
 * Whether a ball around a sweep's first point that holds all of it reaches nowhere that nothing has reached yet, with
 * more to spare than what rounding adds: most are soon done with. Not where any number is not finite.
 */
static bool is_within(const Frame *f, const MesoSweepInstance *sweep, float radius)
{
    MesoVec3 place = meso_vec3_sub(sweep->p[0], f->anchor);
    float reach = 0, sum = 0;
    for (uint32_t k = 1; k < 4; k++) {
        float away = sum_of_sides(meso_vec3_sub(sweep->p[k], sweep->p[0]));
        reach = larger(reach, away);
        sum += away;
    }
    reach += radius;
    reach += 1e-5f * (sum_of_sides(place) + reach);
    float x = meso_vec3_dot(place, f->right), y = meso_vec3_dot(place, f->up), z = meso_vec3_dot(place, f->back);
    float wide = f->tan_x * z + f->pad_x * reach, high = f->tan_y * z + f->pad_y * reach;
    return isfinite(sum + x + y + z + radius) && wide + x <= f->right_most && wide - x <= f->left_most &&
           high + y <= f->high_most && high - y <= f->low_most && z + reach <= f->nearest && z - reach >= f->deepest;
}

/* One whose section keeps its shape. */
static void add_sweep(Frame *frame, const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                      float radius)
{
    if (kind->cap)
        add_ball(frame, sweep->p[0], fmaxf(radius, MESO_CAP_RISE * sweep->size[0] * scene->section_scale));
    else if (!is_within(frame, sweep, radius))
        for (uint32_t k = 0; k <= 4; k++)
            add_ball(frame, curve_point(sweep->p, (float)k / 4), radius);
}

static void add_kind(Frame *frame, const MesoScene *scene, const MesoSweptKind *kind)
{
    float radius = meso_scene_kind_radius(scene, kind);
    for (uint32_t i = 0; i < kind->instance_count && scene->deform == MESO_SWEEP_SHAPE; i++) {
        const MesoSweepInstance *sweep = &scene->sweeps[kind->instance_begin + i];
        float most = radius * meso_cell_stretch(&scene->cages[sweep->cage]).most;
        for (uint32_t k = 0; k <= 4; k++)
            add_ball(frame, meso_sweep_middle(scene, sweep, (float)k / 4), most);
    }
    for (uint32_t i = 0; i < kind->instance_count && scene->deform == MESO_SWEEP_CURVES; i++)
        add_sweep(frame, scene, kind, &scene->sweeps[kind->instance_begin + i], radius);
}

/* ---- sweeps that are made when they are wanted ---- */

enum { REACHES = 6 };

static void reaches_of(const Frame *frame, float reaches[REACHES])
{
    const float all[REACHES] = {frame->right_most, frame->left_most, frame->high_most,
                                frame->low_most, frame->nearest, -frame->deepest};
    memcpy(reaches, all, sizeof all);
}

/* What a bundle may reach at most. */
static void bundle_reaches(const Frame *frame, const MesoScene *scene, uint32_t bundle, float reaches[REACHES])
{
    Frame around = *frame;
    around.right_most = around.left_most = around.high_most = around.low_most = around.nearest = -INFINITY;
    around.deepest = INFINITY;
    MesoBox box = meso_scene_bundle_box(scene, bundle);
    for (uint32_t i = 0; i < 8; i++)
        add_ball(&around, meso_box_corner(box.low, box.high, i), 0);
    reaches_of(&around, reaches);
}

static void add_bundle(Frame *frame, const MesoScene *scene, uint32_t bundle)
{
    MesoMadeSweep made[MESO_BUNDLE_SWEEPS];
    uint32_t count = scene->maker->make_hulls(scene->maker->context, bundle, made);
    for (uint32_t i = 0; i < count; i++)
        add_sweep(frame, scene, &scene->kinds[made[i].kind], &made[i].instance,
                  scene->maker->kind_radii[made[i].kind]);
}

/* Few matter: those that may reach farthest, and then those that may reach farther than these do. */
static void add_made(Frame *frame, const MesoScene *scene)
{
    uint32_t farthest[REACHES] = {0}, count = scene->maker->bundle_count;
    float most[REACHES], reaches[REACHES], there[REACHES];
    for (uint32_t r = 0; r < REACHES; r++)
        most[r] = -INFINITY;
    for (uint32_t b = 0; b < count; b++) {
        bundle_reaches(frame, scene, b, reaches);
        for (uint32_t r = 0; r < REACHES; r++) {
            if (!(reaches[r] > most[r]))
                continue;
            most[r] = reaches[r];
            farthest[r] = b;
        }
    }
    for (uint32_t r = 0; r < REACHES && count > 0; r++)
        add_bundle(frame, scene, farthest[r]);
    for (uint32_t b = 0; b < count; b++) {
        bool matters = false;
        bundle_reaches(frame, scene, b, reaches);
        reaches_of(frame, there);
        for (uint32_t r = 0; r < REACHES; r++)
            matters = matters || reaches[r] > there[r];
        if (matters)
            add_bundle(frame, scene, b);
    }
}

/* Bodies lie in their cages, unless an artist's mesh sticks out. */
static void add_placed(Frame *frame, const MesoScene *scene, const MesoPlacedBody *placed)
{
    const MesoBody *body = &scene->bodies[placed->body];
    bool caged = placed->place == MESO_PLACED_IN_CAGE;
    for (uint32_t k = 0; caged && k < 8; k++)
        add_ball(frame, meso_cage_corner(&scene->cages[placed->cage], k), 0);
    for (uint32_t v = 0; !caged && v < body->vertex_count; v++)
        add_ball(frame, meso_placed_point(scene, placed, body->positions[v]), 0);
}

static void add_scene(Frame *frame, const MesoScene *scene)
{
    if (scene->maker)
        add_made(frame, scene);
    for (uint32_t k = 0; k < scene->kind_count && !scene->maker; k++)
        add_kind(frame, scene, &scene->kinds[k]);
    for (uint32_t i = 0; i < scene->placed_count; i++)
        add_placed(frame, scene, &scene->placed[i]);
}

MesoCamera meso_camera_frame_scene(const MesoScene *scene, MesoVec3 up, float fov_degrees, float aspect)
{
    Frame frame = begin_frame(scene->box.low, scene->box.high, up, fov_degrees, aspect);
    add_scene(&frame, scene);
    return end_frame(&frame, fov_degrees);
}

float meso_camera_fit_height(const MesoScene *scene, const MesoCamera *camera, float aspect)
{
    MesoView view;
    if (meso_view_build(&view, camera, NULL))
        return 1;
    float none = -INFINITY;
    Frame frame = {.right = view.right, .up = view.up, .back = meso_vec3_scale(view.forward, -1),
                   .pad_x = 1, .pad_y = 1,
                   .anchor = meso_box_anchor(scene->box.low, scene->box.high), .left_most = none, .right_most = none,
                   .low_most = none, .high_most = none, .deepest = INFINITY, .nearest = none};
    add_scene(&frame, scene);
    MesoVec3 middle = meso_vec3_sub(camera->target, frame.anchor);
    float x = meso_vec3_dot(middle, frame.right), y = meso_vec3_dot(middle, frame.up);
    float across = fmaxf(frame.right_most - x, frame.left_most + x);
    float upward = fmaxf(frame.high_most - y, frame.low_most + y);
    float half = fmaxf(upward, across / aspect) / (1 - 2 * MARGIN);
    return half > 0 && isfinite(half) ? 2 * half : 1;
}

MesoCamera meso_camera_frame_scene_parallel(const MesoScene *scene, MesoVec3 up, float aspect)
{
    const float usual_fov = 30;
    Frame frame = begin_frame(scene->box.low, scene->box.high, up, usual_fov, aspect);
    frame.tan_x = frame.tan_y = 0;
    frame.pad_x = frame.pad_y = 1;
    add_scene(&frame, scene);
    if (!(frame.nearest >= frame.deepest))      /* nothing there */
        add_ball(&frame, frame.anchor, 1);
    float width = frame.right_most + frame.left_most, height = frame.high_most + frame.low_most;
    float size = fmaxf(fmaxf(width, height), fmaxf(frame.nearest - frame.deepest, 1e-3f));
    MesoVec3 middle = meso_vec3_mad(meso_vec3_scale(frame.right, 0.5f * (frame.right_most - frame.left_most)),
                                    0.5f * (frame.high_most - frame.low_most), frame.up);
    middle = meso_vec3_mad(middle, 0.5f * (frame.nearest + frame.deepest), frame.back);
    MesoVec3 target = meso_vec3_add(frame.anchor, middle);
    MesoCamera camera = {meso_vec3_mad(target, 2 * size, frame.back), target, up, usual_fov, 0};
    camera.height = meso_camera_fit_height(scene, &camera, aspect);
    return camera;
}

float meso_camera_fov(float focal, float sensor, float aspect)
{
    return 2 * atanf(0.5f * sensor / (aspect * focal)) * (float)(180 / 3.14159265358979323846);
}
