#include "libcore/render/light/light_map.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"

MesoStatus meso_light_map_init(MesoLightMap *map, MesoArena *arena, MesoVec3 toward, MesoVec3 middle, float radius,
                               uint32_t size, MesoError *error)
{
    MesoVec3 across = fabsf(toward.y) < 0.9f ? (MesoVec3){0, 1, 0} : (MesoVec3){0, 0, 1};
    MesoVec3 right = meso_vec3_unit(meso_vec3_cross(across, toward), (MesoVec3){1, 0, 0});
    float focal = (float)(size - 4) / (2 * radius);
    *map = (MesoLightMap){
        .toward = toward, .size = size, .texel = 1 / focal,
        .view = {.eye = middle, .right = right, .down = meso_vec3_cross(right, toward),
                 .forward = meso_vec3_scale(toward, -1), .parallel = true, .focal = focal,
                 .middle_x = 0.5f * (float)size, .middle_y = 0.5f * (float)size}};
    map->nearness = MESO_NEW(arena, float, (size_t)size * size, error);
    return map->nearness ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- drawing ---- */

/* Shapes are made a batch at a time, by ranges, and each batch is drawn into every map. */
enum { RANGE = 64, BATCH = 128 };       /* shapes, ranges */

typedef struct Range {
    float *x, *y, *z;
    uint32_t *corners[2];       /* of triangles that have two sides, and of closed shapes */
    uint32_t point_count, corner_count[2];
    uint64_t room[3], corner_room[2];
} Range;

typedef struct Batch {
    const MesoShapes *shapes;
    MesoLightMap *maps;
    MesoRasterLanes lanes;
    float tolerance;
    uint64_t first;             /* shape */
    uint32_t range_count;
    Range ranges[BATCH];
    MesoShapeMesh *meshes;      /* one a worker */
    MesoRasterVertex **projected;
    uint64_t *projected_room;
    bool failed;
} Batch;

static void fail(Batch *batch)
{
    __atomic_store_n(&batch->failed, true, __ATOMIC_RELAXED);
}

static bool grow(void **array, uint64_t *room, uint64_t count, size_t size)
{
    if (count <= *room)
        return true;
    void *grown = realloc(*array, 2 * count * size);
    if (!grown)
        return false;
    *array = grown;
    *room = 2 * count;
    return true;
}

static bool add_mesh(Range *range, const MesoShapeMesh *mesh)
{
    bool closed = mesh->closed;
    uint64_t points = (uint64_t)range->point_count + mesh->vertex_count, first = range->corner_count[closed];
    uint64_t corners = first + 3 * (uint64_t)mesh->triangle_count;
    if (corners > UINT32_MAX || !grow((void **)&range->x, &range->room[0], points, sizeof *range->x) ||
        !grow((void **)&range->y, &range->room[1], points, sizeof *range->y) ||
        !grow((void **)&range->z, &range->room[2], points, sizeof *range->z) ||
        !grow((void **)&range->corners[closed], &range->corner_room[closed], corners, sizeof **range->corners))
        return false;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        range->x[range->point_count + v] = mesh->vertices[v].position.x;
        range->y[range->point_count + v] = mesh->vertices[v].position.y;
        range->z[range->point_count + v] = mesh->vertices[v].position.z;
    }
    for (uint32_t c = 0; c < 3 * mesh->triangle_count; c++)
        range->corners[closed][first + c] = range->point_count + mesh->corners[c];
    range->point_count = (uint32_t)points;
    range->corner_count[closed] = (uint32_t)corners;
    return true;
}

static void make_ranges(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Batch *batch = context;
    for (uint64_t r = begin; r < end; r++) {
        Range *range = &batch->ranges[r];
        uint64_t first = batch->first + r * RANGE, last = first + RANGE;
        range->point_count = range->corner_count[0] = range->corner_count[1] = 0;
        for (uint64_t i = first; i < last && i < batch->shapes->count; i++)
            if (!meso_shape_make(batch->shapes, (uint32_t)i, batch->tolerance, false, &batch->meshes[worker]) ||
                !add_mesh(range, &batch->meshes[worker])) {
                fail(batch);
                return;
            }
    }
}

static void draw_maps(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Batch *batch = context;
    for (uint64_t m = begin; m < end; m++) {
        const MesoLightMap *map = &batch->maps[m];
        int32_t cells = (int32_t)map->size / 4;
        const MesoRasterTarget target = {&batch->lanes, cells, cells, map->nearness, NULL};
        for (uint32_t r = 0; r < batch->range_count; r++) {
            const Range *range = &batch->ranges[r];
            if (!grow((void **)&batch->projected[worker], &batch->projected_room[worker], range->point_count,
                      sizeof **batch->projected)) {
                fail(batch);
                return;
            }
            MesoRasterVertex *projected = batch->projected[worker];
            meso_raster_project(&map->view, range->x, range->y, range->z, range->point_count, 0, 0, projected);
            for (int closed = 0; closed < 2; closed++)
                meso_raster_draw(&target, projected, range->corners[closed], range->corner_count[closed] / 3, 0, closed);
        }
    }
}

static void release(Batch *batch, uint32_t workers)
{
    for (uint32_t w = 0; w < workers; w++) {
        if (batch->meshes)
            meso_shape_mesh_release(&batch->meshes[w]);
        if (batch->projected)
            free(batch->projected[w]);
    }
    for (uint32_t r = 0; r < BATCH; r++) {
        free(batch->ranges[r].x);
        free(batch->ranges[r].y);
        free(batch->ranges[r].z);
        free(batch->ranges[r].corners[0]);
        free(batch->ranges[r].corners[1]);
    }
    free(batch->meshes);
    free(batch->projected);
    free(batch->projected_room);
    free(batch);
}

MesoStatus meso_light_maps_draw(MesoLightMap *maps, uint32_t map_count, const MesoShapes *shapes, uint32_t thread_count,
                                MesoError *error)
{
    uint32_t workers = thread_count ? thread_count : meso_parallel_cores();
    Batch *batch = calloc(1, sizeof *batch);
    if (!batch)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the light");
    batch->shapes = shapes;
    batch->maps = maps;
    batch->lanes = meso_raster_lanes(1);
    batch->tolerance = INFINITY;
    batch->meshes = calloc(workers, sizeof *batch->meshes);
    batch->projected = calloc(workers, sizeof *batch->projected);
    batch->projected_room = calloc(workers, sizeof *batch->projected_room);
    batch->failed = !batch->meshes || !batch->projected || !batch->projected_room;
    for (uint32_t m = 0; m < map_count; m++) {
        int32_t cells = (int32_t)maps[m].size / 4;
        const MesoRasterTarget target = {&batch->lanes, cells, cells, maps[m].nearness, NULL};
        meso_raster_clear(&target, -INFINITY);
        batch->tolerance = fminf(batch->tolerance, 0.5f * maps[m].texel);
    }
    for (batch->first = 0; batch->first < shapes->count && !batch->failed; batch->first += BATCH * RANGE) {
        uint64_t left = shapes->count - batch->first;
        batch->range_count = left < BATCH * RANGE ? (uint32_t)((left + RANGE - 1) / RANGE) : BATCH;
        meso_parallel_team(workers, batch->range_count, 1, make_ranges, batch);
        if (!batch->failed)
            meso_parallel_team(workers, map_count, 1, draw_maps, batch);
    }
    bool failed = batch->failed;
    release(batch, workers);
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for the light") : MESO_OK;
}

/* ---- looking it up ---- */

static bool is_lit(const MesoLightMap *map, int32_t x, int32_t y, float nearness)
{
    if ((uint32_t)x >= map->size || (uint32_t)y >= map->size)
        return true;
    size_t cell = (size_t)(y >> 2) * (map->size / 4) + (size_t)(x >> 2);
    return nearness >= map->nearness[16 * cell + (size_t)((y & 3) * 4 + (x & 3))];
}

float meso_light_map_lit(const MesoLightMap *map, MesoVec3 p, float bias)
{
    const MesoRasterView *view = &map->view;
    MesoVec3 q = meso_raster_from_eye(view, p);
    float x = view->middle_x + view->focal * q.x - 0.5f, y = view->middle_y + view->focal * q.y - 0.5f;
    if (!(x > -1 && y > -1 && x < (float)map->size && y < (float)map->size))
        return 1;
    float floor_x = floorf(x), floor_y = floorf(y), share_x = x - floor_x, share_y = y - floor_y, nearness = bias - q.z;
    int32_t ix = (int32_t)floor_x, iy = (int32_t)floor_y;
    float top = (float)is_lit(map, ix, iy, nearness) * (1 - share_x) + (float)is_lit(map, ix + 1, iy, nearness) * share_x;
    float bottom = (float)is_lit(map, ix, iy + 1, nearness) * (1 - share_x) +
                   (float)is_lit(map, ix + 1, iy + 1, nearness) * share_x;
    return top * (1 - share_y) + bottom * share_y;
}
