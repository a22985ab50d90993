#include "libcore/growth/ground/growth_snap.h"

#include <stdlib.h>

#include "libcore/base/parallel.h"
#include "libcore/mesh/point/surface_point.h"
#include "libcore/shell/box_tree.h"

/* Points times triangles: below this all triangles are looked at, which needs no tree. */
static const double FEW = 4e6;

/* A box that holds more than so many triangles is looked at in full: no list of them. */
enum { NEAR_ROOM = 4096 };

typedef struct Snap {
    const MesoTriangulation *mesh;
    MesoDomain all;
    MesoBoxTree tree;
    bool has_tree;
    float step;                 /* about as large as triangles are */
    const MesoVec3 *points;
    MesoMeshPoint *out;
} Snap;

typedef struct Near {
    uint32_t triangles[NEAR_ROOM];
    uint32_t count;             /* more than NEAR_ROOM: too many */
} Near;

static void add_near(void *context, uint32_t triangle)
{
    Near *near = context;
    if (near->count < NEAR_ROOM)
        near->triangles[near->count] = triangle;
    near->count++;
}

/* Triangles whose boxes come as near as that, ascending; false where they are too many. */
static bool find_near(const Snap *snap, MesoVec3 p, float radius, Near *near)
{
    MesoBox box = meso_box_empty();
    meso_box_add_around(&box, p, radius);
    near->count = 0;
    meso_box_tree_query(&snap->tree, box, add_near, near);
    if (near->count > NEAR_ROOM)
        return false;
    qsort(near->triangles, near->count, sizeof *near->triangles, meso_by_number);
    return true;
}

static float distance_to(const MesoTriangulation *mesh, const MesoMeshPoint *point, MesoVec3 p)
{
    const uint32_t *c = &mesh->corners[3 * (size_t)point->triangle];
    MesoVec3 at = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        at = meso_vec3_mad(at, point->weight[k], mesh->positions[c[k]]);
    return meso_vec3_length(meso_vec3_sub(at, p));
}

/* First any triangle, in boxes that double; then all that are no farther than that one. */
static MesoMeshPoint snap_by_tree(const Snap *snap, MesoVec3 p)
{
    Near near;
    float radius = snap->step;
    bool few = find_near(snap, p, radius, &near);
    for (uint32_t i = 0; few && near.count == 0 && i < 64; i++)
        few = find_near(snap, p, radius *= 2, &near);
    if (!few || near.count == 0)
        return meso_surface_point(snap->mesh, &snap->all, p);
    MesoDomain part = {.triangle_count = near.count, .triangles = near.triangles};
    MesoMeshPoint point = meso_surface_point(snap->mesh, &part, p);
    float distance = distance_to(snap->mesh, &point, p);
    if (distance <= radius)
        return point;
    if (!find_near(snap, p, distance * 1.0001f, &near))
        return meso_surface_point(snap->mesh, &snap->all, p);
    part.triangle_count = near.count;
    return meso_surface_point(snap->mesh, &part, p);
}

static void snap_points(void *context, uint64_t begin, uint64_t end)
{
    const Snap *snap = context;
    for (uint64_t i = begin; i < end; i++)
        snap->out[i] = snap->has_tree ? snap_by_tree(snap, snap->points[i])
                                      : meso_surface_point(snap->mesh, &snap->all, snap->points[i]);
}

static MesoStatus build_tree(Snap *snap, MesoArena *scratch, MesoError *error)
{
    const MesoTriangulation *mesh = snap->mesh;
    MesoBox *boxes = MESO_NEW(scratch, MesoBox, mesh->triangle_count, error);
    double size = 0;
    if (!boxes)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        boxes[t] = meso_box_empty();
        for (uint32_t k = 0; k < 3; k++)
            meso_box_add(&boxes[t], mesh->positions[mesh->corners[3 * (size_t)t + k]]);
        size += (double)meso_vec3_length(meso_vec3_sub(boxes[t].high, boxes[t].low));
    }
    snap->step = (float)(0.5 * size / mesh->triangle_count);
    snap->has_tree = snap->step > 0;
    return meso_box_tree_build(&snap->tree, scratch, boxes, mesh->triangle_count, error);
}

MesoStatus meso_growth_snap(const MesoTriangulation *mesh, MesoArena *scratch, const MesoVec3 *points, uint32_t count,
                            MesoMeshPoint *out, uint32_t thread_count, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    uint32_t *triangles = MESO_NEW(scratch, uint32_t, mesh->triangle_count, error);
    MesoStatus status = triangles ? MESO_OK : MESO_ERR_MEMORY;
    Snap snap = {.mesh = mesh, .all = {.triangle_count = mesh->triangle_count, .triangles = triangles},
                 .points = points, .out = out};
    for (uint32_t t = 0; t < mesh->triangle_count && !status; t++)
        triangles[t] = t;
    if (!status && (double)count * mesh->triangle_count > FEW)
        status = build_tree(&snap, scratch, error);
    if (!status)
        meso_parallel_for(thread_count, count, 16, snap_points, &snap);
    meso_arena_rewind(scratch, mark);
    return status;
}
