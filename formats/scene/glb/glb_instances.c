#include "formats/scene/glb/glb_instances.h"

#include <math.h>

#include "libcore/base/index.h"
#include "libcore/math/quaternion.h"
#include "libcore/scene/placed.h"

/* Of a body's size, for its vertices; and of a right angle's cosine, for its axes. */
static const float MOST_OFF = 1e-3f, MOST_COSINE = 1e-3f;

/* ---- poses ---- */

static MesoVec3 corner_of(const MesoBox *box, uint32_t corner)
{
    return (MesoVec3){corner & 1 ? box->high.x : box->low.x, corner & 2 ? box->high.y : box->low.y,
                      corner & 4 ? box->high.z : box->low.z};
}

/* How far a step along an axis of the body goes, in the mean of the box's edges; 0 where the box is flat. */
static MesoVec3 axis_of(const MesoVec3 corners[8], uint32_t axis, float extent)
{
    MesoVec3 sum = {0, 0, 0};
    for (uint32_t c = 0; c < 8; c++)
        sum = meso_vec3_mad(sum, c >> axis & 1 ? 1.0f : -1.0f, corners[c]);
    return extent > 0 ? meso_vec3_scale(sum, 1 / (4 * extent)) : (MesoVec3){0, 0, 0};
}

/* Unit axes and their lengths; a flat box has its third axis from the others. */
static bool make_axes(MesoVec3 axes[3], float lengths[3])
{
    uint32_t flat = 3;
    for (uint32_t k = 0; k < 3; k++) {
        lengths[k] = meso_vec3_length(axes[k]);
        if (lengths[k] > 0)
            axes[k] = meso_vec3_scale(axes[k], 1 / lengths[k]);
        else if (flat < 3)
            return false;
        else
            flat = k;
    }
    if (flat < 3) {
        axes[flat] = meso_vec3_cross(axes[(flat + 1) % 3], axes[(flat + 2) % 3]);
        lengths[flat] = 1;
    }
    bool square = fabsf(meso_vec3_dot(axes[0], axes[1])) <= MOST_COSINE &&
                  fabsf(meso_vec3_dot(axes[1], axes[2])) <= MOST_COSINE &&
                  fabsf(meso_vec3_dot(axes[2], axes[0])) <= MOST_COSINE;
    if (!square || meso_vec3_dot(meso_vec3_cross(axes[0], axes[1]), axes[2]) <= 0)
        return false;
    axes[1] = meso_vec3_unit(meso_vec3_mad(axes[1], -meso_vec3_dot(axes[0], axes[1]), axes[0]), axes[1]);
    axes[2] = meso_vec3_cross(axes[0], axes[1]);
    return true;
}

/* What the pose makes of a point, before it moves it. */
static MesoVec3 turned(const MesoVec3 axes[3], const float lengths[3], MesoVec3 p)
{
    MesoVec3 x = meso_vec3_scale(axes[0], lengths[0] * p.x), y = meso_vec3_scale(axes[1], lengths[1] * p.y);
    return meso_vec3_add(meso_vec3_add(x, y), meso_vec3_scale(axes[2], lengths[2] * p.z));
}

bool meso_glb_pose(MesoGlbPose *pose, const MesoScene *scene, const MesoPlacedBody *placed, const MesoBox *box)
{
    MesoVec3 corners[8], axes[3], low = {0, 0, 0}, high = {0, 0, 0};
    const float extents[3] = {box->high.x - box->low.x, box->high.y - box->low.y, box->high.z - box->low.z};
    float lengths[3];
    if (meso_placed_is_mirrored(scene, placed))
        return false;
    for (uint32_t c = 0; c < 8; c++)
        corners[c] = meso_placed_point(scene, placed, corner_of(box, c));
    for (uint32_t k = 0; k < 3; k++)
        axes[k] = axis_of(corners, k, extents[k]);
    if (!make_axes(axes, lengths))
        return false;
    for (uint32_t c = 0; c < 8; c++) {
        low = meso_vec3_mad(low, 0.125f, turned(axes, lengths, corner_of(box, c)));
        high = meso_vec3_mad(high, 0.125f, corners[c]);
    }
    *pose = (MesoGlbPose){.translation = meso_vec3_sub(high, low), .scale = {lengths[0], lengths[1], lengths[2]}};
    meso_quaternion_of(axes, pose->rotation);
    float size = meso_vec3_length(meso_vec3_sub(corners[7], corners[0]));
    bool near = size > 0;
    for (uint32_t c = 0; c < 8; c++) {
        MesoVec3 p = meso_vec3_add(turned(axes, lengths, corner_of(box, c)), pose->translation);
        near = near && meso_vec3_length(meso_vec3_sub(p, corners[c])) <= MOST_OFF * size;
    }
    return near;
}

/* ---- sets ---- */

typedef struct Finder {
    const MesoScene *scene;
    MesoBox *boxes;             /* [body_count] */
    uint32_t *material;         /* [body_count] of the first place; others of the body stay what they are */
    uint32_t *counts;           /* [body_count] rigid places */
    uint32_t *set_of;           /* [body_count] or MESO_NO_INDEX */
    MesoGlbPose *poses;         /* [placed_count] */
    bool *rigid;                /* [placed_count] */
} Finder;

static MesoStatus allocate(Finder *f, MesoArena *arena, MesoError *error)
{
    const MesoScene *scene = f->scene;
    f->boxes = MESO_NEW(arena, MesoBox, scene->body_count, error);
    f->material = MESO_NEW(arena, uint32_t, scene->body_count, error);
    f->counts = MESO_NEW(arena, uint32_t, scene->body_count, error);
    f->set_of = MESO_NEW(arena, uint32_t, scene->body_count, error);
    f->poses = MESO_NEW(arena, MesoGlbPose, scene->placed_count, error);
    f->rigid = MESO_NEW(arena, bool, scene->placed_count, error);
    return f->boxes && f->material && f->counts && f->set_of && f->poses && f->rigid ? MESO_OK : MESO_ERR_MEMORY;
}

static void measure_bodies(Finder *f)
{
    for (uint32_t b = 0; b < f->scene->body_count; b++) {
        const MesoBody *body = &f->scene->bodies[b];
        f->boxes[b] = meso_box_empty();
        f->material[b] = f->set_of[b] = MESO_NO_INDEX;
        for (uint32_t v = 0; v < body->vertex_count; v++)
            meso_box_add(&f->boxes[b], body->positions[v]);
    }
}

static void find_poses(Finder *f)
{
    for (uint32_t i = 0; i < f->scene->placed_count; i++) {
        const MesoPlacedBody *placed = &f->scene->placed[i];
        uint32_t body = placed->body;
        if (f->material[body] == MESO_NO_INDEX)
            f->material[body] = placed->material;
        f->rigid[i] = placed->place != MESO_PLACED_HERE && f->material[body] == placed->material &&
                      f->scene->bodies[body].face_count > 0 &&
                      meso_glb_pose(&f->poses[i], f->scene, placed, &f->boxes[body]);
        f->counts[body] += f->rigid[i];
    }
}

static MesoStatus make_sets(Finder *f, MesoGlbInstances *out, MesoArena *arena, MesoError *error)
{
    out->sets = MESO_NEW(arena, MesoGlbInstanceSet, f->scene->body_count, error);
    if (!out->sets)
        return MESO_ERR_MEMORY;
    for (uint32_t b = 0; b < f->scene->body_count; b++) {
        if (f->counts[b] < 2)
            continue;
        f->set_of[b] = out->set_count;
        MesoGlbInstanceSet *set = &out->sets[out->set_count++];
        set->poses = MESO_NEW(arena, MesoGlbPose, f->counts[b], error);
        set->rows = MESO_NEW(arena, uint32_t, f->counts[b], error);
        if (!set->poses || !set->rows)
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

/* What is in no set, as it is; then a body for each set. */
static MesoStatus place(const Finder *f, MesoGlbInstances *out, MesoArena *arena, MesoError *error)
{
    MesoScene *scene = &out->scene;
    MesoPlacedBody *placed = MESO_NEW(arena, MesoPlacedBody, (size_t)f->scene->placed_count + out->set_count, error);
    uint32_t count = 0;
    if (!placed)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < f->scene->placed_count; i++) {
        const MesoPlacedBody *from = &f->scene->placed[i];
        uint32_t number = f->rigid[i] ? f->set_of[from->body] : MESO_NO_INDEX;
        if (number == MESO_NO_INDEX) {
            placed[count++] = *from;
            continue;
        }
        MesoGlbInstanceSet *set = &out->sets[number];
        set->poses[set->count] = f->poses[i];
        set->rows[set->count++] = from->ids;
    }
    out->first = scene->sweep_count + count;
    for (uint32_t b = 0; b < f->scene->body_count; b++)
        if (f->set_of[b] != MESO_NO_INDEX)
            placed[count + f->set_of[b]] = (MesoPlacedBody){.body = b, .material = f->material[b],
                                                            .ids = out->sets[f->set_of[b]].rows[0],
                                                            .place = MESO_PLACED_HERE};
    scene->placed = placed;
    scene->placed_count = count + out->set_count;
    return meso_scene_parts_init(&out->parts, arena, scene, error);
}

MesoStatus meso_glb_instances_find(MesoGlbInstances *instances, const MesoScene *scene, MesoArena *arena,
                                   MesoError *error)
{
    Finder f = {.scene = scene};
    *instances = (MesoGlbInstances){.scene = *scene};
    MesoStatus status = allocate(&f, arena, error);
    if (status)
        return status;
    measure_bodies(&f);
    find_poses(&f);
    status = make_sets(&f, instances, arena, error);
    return status ? status : place(&f, instances, arena, error);
}
