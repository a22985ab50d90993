#include "libcore/render/picture/motion.h"

#include <string.h>

static bool same_bytes(const void *a, const void *b, size_t size)
{
    return a == b || memcmp(a, b, size) == 0;
}

static bool kinds_alike(const MesoSweptKind *a, const MesoSweptKind *b)
{
    return a->column_begin == b->column_begin && a->column_count == b->column_count &&
           a->joint_count == b->joint_count && a->instance_begin == b->instance_begin &&
           a->instance_count == b->instance_count && a->cap == b->cap;
}

static bool columns_alike(const MesoSweepColumn *a, const MesoSweepColumn *b)
{
    return a->joins_next == b->joins_next && a->u == b->u;
}

static bool bodies_alike(const MesoBody *a, const MesoBody *b)
{
    return a->vertex_count == b->vertex_count && a->face_count == b->face_count && a->face_width == b->face_width &&
           same_bytes(a->corners, b->corners, sizeof *a->corners * a->face_width * a->face_count);
}

bool meso_motion_alike(const MesoScene *a, const MesoScene *b)
{
    bool alike = a->deform == b->deform && a->kind_count == b->kind_count && a->column_count == b->column_count &&
                 a->sweep_count == b->sweep_count && a->body_count == b->body_count &&
                 a->placed_count == b->placed_count;
    for (uint32_t i = 0; alike && i < a->kind_count; i++)
        alike = kinds_alike(&a->kinds[i], &b->kinds[i]);
    for (uint32_t i = 0; alike && i < a->column_count; i++)
        alike = columns_alike(&a->columns[i], &b->columns[i]);
    for (uint32_t i = 0; alike && i < a->body_count; i++)
        alike = bodies_alike(&a->bodies[i], &b->bodies[i]);
    for (uint32_t i = 0; alike && i < a->placed_count; i++)
        alike = a->placed[i].body == b->placed[i].body;
    return alike;
}

MesoStatus meso_motion_init(MesoMotion *motion, MesoArena *arena, const MesoRasterJob *job,
                            const MesoRenderOptions *options, uint32_t thread_count, MesoError *error)
{
    MesoView view;
    MesoVec3 anchor = job->shapes->anchor;
    MesoStatus status = meso_view_build(&view, &options->next_camera, error);
    if (status)
        return status;
    view.anchor = anchor;
    *motion = (MesoMotion){.job = job, .to = meso_raster_view(&view, job->width, job->height, job->view.near_depth),
                           .still = options->next_scene == NULL};
    return motion->still ? MESO_OK
                         : meso_shapes_init(&motion->next, arena, options->next_scene, anchor, thread_count, error);
}

/* How far the place has gone: as far as the same shares of the same corners. */
static MesoVec3 way_of(const MesoMotion *motion, const MesoSurfaceSample *sample)
{
    const MesoShapes *now = motion->job->shapes;
    MesoShapeCorner corners[3];
    MesoVec3 way = {0, 0, 0};
    meso_shape_corners(now, sample->shape, meso_raster_tolerance(motion->job, sample->shape), sample->triangle,
                       corners);
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 from = meso_shape_corner_at(now, sample->shape, &corners[k]);
        MesoVec3 to = meso_shape_corner_at(&motion->next, sample->shape, &corners[k]);
        way = meso_vec3_mad(way, sample->shares[k], meso_vec3_sub(to, from));
    }
    return way;
}

/* False behind the camera. */
static bool project(const MesoRasterView *view, MesoVec3 p, float place[2])
{
    MesoVec3 q = meso_raster_from_eye(view, p);
    if (!view->parallel && !(q.z > 0))
        return false;
    float scale = view->parallel ? view->focal : view->focal / q.z;
    place[0] = view->middle_x + scale * q.x;
    place[1] = view->middle_y + scale * q.y;
    return true;
}

void meso_motion_at(const MesoMotion *motion, const MesoSurfaceSample *sample, float pixels[2])
{
    float from[2], to[2];
    MesoVec3 then = motion->still ? sample->position : meso_vec3_add(sample->position, way_of(motion, sample));
    bool seen = project(&motion->job->view, sample->position, from) && project(&motion->to, then, to);
    pixels[0] = seen ? to[0] - from[0] : 0;
    pixels[1] = seen ? from[1] - to[1] : 0;
}
