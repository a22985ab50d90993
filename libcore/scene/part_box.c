/* Boxes of ranges of parts, by all threads, joined in the end. */
#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/scene/parts.h"

enum { RANGE_VERTICES = 1 << 14 };

typedef struct Bounds {
    const MesoSceneParts *parts;
    uint32_t *range_begin;      /* [range_count + 1] parts */
    MesoBox *boxes;             /* [range_count] */
    uint32_t *bad_part;         /* [range_count] part of a vertex that is not finite, or MESO_NO_INDEX */
    MesoStatus *status;         /* [range_count] */
} Bounds;

static uint32_t part_of_vertex(const MesoSceneParts *parts, uint32_t part, uint64_t vertex)
{
    while (parts->vertex_begin[part + 1] <= vertex)
        part++;
    return part;
}

static void bound_range(const Bounds *bounds, uint64_t range, MesoMeshVertex *vertices, uint64_t count)
{
    const MesoSceneParts *parts = bounds->parts;
    uint32_t begin = bounds->range_begin[range];
    MesoBox box = meso_box_empty();
    meso_scene_vertices(parts, begin, bounds->range_begin[range + 1], vertices);
    for (uint64_t i = 0; i < count; i++) {
        const MesoMeshVertex *v = &vertices[i];
        if (!meso_vec3_finite(v->position) || !meso_vec3_finite(v->normal)) {
            bounds->bad_part[range] = part_of_vertex(parts, begin, parts->vertex_begin[begin] + i);
            return;
        }
        meso_box_add(&box, v->position);
    }
    bounds->boxes[range] = box;
}

static void bound_ranges(void *context, uint64_t begin, uint64_t end)
{
    const Bounds *bounds = context;
    const MesoSceneParts *parts = bounds->parts;
    for (uint64_t range = begin; range < end; range++) {
        uint64_t count = parts->vertex_begin[bounds->range_begin[range + 1]] -
                         parts->vertex_begin[bounds->range_begin[range]];
        MesoMeshVertex *vertices = calloc(count ? count : 1, sizeof *vertices);
        if (vertices)
            bound_range(bounds, range, vertices, count);
        else
            bounds->status[range] = MESO_ERR_MEMORY;
        free(vertices);
    }
}

/* Ranges of about RANGE_VERTICES; `range_begin` NULL only counts. */
static uint32_t cut_ranges(const MesoSceneParts *parts, uint32_t *range_begin)
{
    uint32_t count = 0;
    for (uint32_t part = 0; part < parts->part_count; count++) {
        uint64_t first = parts->vertex_begin[part];
        if (range_begin)
            range_begin[count] = part;
        do
            part++;
        while (part < parts->part_count && parts->vertex_begin[part + 1] - first <= RANGE_VERTICES);
        if (range_begin)
            range_begin[count + 1] = part;
    }
    return count;
}

static MesoStatus refuse_part(const MesoSceneParts *parts, uint32_t part, MesoError *error)
{
    const MesoScene *scene = parts->scene;
    bool named = scene->channel_count > 0;
    return meso_fail(error, MESO_ERR_INPUT, "%s %u: a vertex of its geometry is not finite",
                     named ? scene->channels[0].name : "part",
                     named ? meso_scene_id(scene, meso_scene_part(parts, part).ids, 0) : part);
}

static MesoStatus join_boxes(const Bounds *bounds, uint32_t count, MesoBox *box, MesoError *error)
{
    *box = meso_box_empty();
    for (uint32_t i = 0; i < count; i++) {
        if (bounds->status[i])
            return meso_fail(error, bounds->status[i], "out of memory");
        if (bounds->bad_part[i] != MESO_NO_INDEX)
            return refuse_part(bounds->parts, bounds->bad_part[i], error);
        meso_box_add(box, bounds->boxes[i].low);
        meso_box_add(box, bounds->boxes[i].high);
    }
    return MESO_OK;
}

MesoStatus meso_scene_parts_box(const MesoSceneParts *parts, uint32_t thread_count, MesoBox *box,
                                MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = MESO_ERR_MEMORY;
    uint32_t count = cut_ranges(parts, NULL);
    Bounds bounds = {
        .parts = parts,
        .range_begin = MESO_NEW(&arena, uint32_t, (size_t)count + 1, error),
        .boxes = MESO_NEW(&arena, MesoBox, count, error),
        .bad_part = MESO_NEW(&arena, uint32_t, count, error),
        .status = MESO_NEW(&arena, MesoStatus, count, error),
    };
    if (bounds.range_begin && bounds.boxes && bounds.bad_part && bounds.status) {
        cut_ranges(parts, bounds.range_begin);
        memset(bounds.bad_part, 0xff, count * sizeof *bounds.bad_part);
        meso_parallel_for(thread_count, count, 1, bound_ranges, &bounds);
        status = join_boxes(&bounds, count, box, error);
    }
    meso_arena_release(&arena);
    return status;
}
