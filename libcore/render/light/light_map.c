#include "libcore/render/light/light_map.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"

static MesoLightMap make_map(MesoVec3 toward, MesoVec3 middle, float focal, uint32_t size, float *nearness)
{
    MesoVec3 across = fabsf(toward.y) < 0.9f ? (MesoVec3){0, 1, 0} : (MesoVec3){0, 0, 1};
    MesoVec3 right = meso_vec3_unit(meso_vec3_cross(across, toward), (MesoVec3){1, 0, 0});
    return (MesoLightMap){
        .toward = toward, .nearness = nearness,
        .view = {.eye = middle, .right = right, .down = meso_vec3_cross(right, toward),
                 .forward = meso_vec3_scale(toward, -1), .parallel = true, .focal = focal,
                 .middle_x = 0.5f * (float)size, .middle_y = 0.5f * (float)size}};
}

MesoStatus meso_light_maps_init(MesoLightMaps *maps, MesoArena *arena, const MesoVec3 *towards, uint32_t count,
                                MesoVec3 middle, float radius, uint32_t size, MesoError *error)
{
    float focal = (float)(size - 4) / (2 * radius);
    *maps = (MesoLightMaps){.count = count, .size = size, .texel = 1 / focal};
    size_t texels = (size_t)size * size;
    maps->maps = MESO_NEW(arena, MesoLightMap, count, error);
    maps->nearness = MESO_NEW(arena, float, count * texels, error);
    float *rows = MESO_NEW(arena, float, 9 * (size_t)count, error);
    if (!maps->maps || !maps->nearness || !rows)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < 9; k++)
        maps->rows[k] = rows + (size_t)k * count;
    for (uint32_t i = 0; i < count; i++) {
        const MesoLightMap map = make_map(towards[i], middle, focal, size, maps->nearness + i * texels);
        const float row[9] = {map.toward.x, map.toward.y, map.toward.z, map.view.right.x, map.view.right.y,
                              map.view.right.z, map.view.down.x, map.view.down.y, map.view.down.z};
        maps->maps[i] = map;
        for (uint32_t k = 0; k < 9; k++)
            maps->rows[k][i] = row[k];
    }
    return MESO_OK;
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
    MesoLightMaps *maps;
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
            if (!meso_shape_make(batch->shapes, (uint32_t)i, batch->tolerance, MESO_SHAPE_SHADOW, &batch->meshes[worker]) ||
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
        const MesoLightMap *map = &batch->maps->maps[m];
        int32_t cells = (int32_t)batch->maps->size / 4;
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

MesoStatus meso_light_maps_draw(MesoLightMaps *maps, const MesoShapes *shapes, uint32_t thread_count, MesoError *error)
{
    uint32_t workers = thread_count ? thread_count : meso_parallel_cores();
    Batch *batch = calloc(1, sizeof *batch);
    if (!batch)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the light");
    batch->shapes = shapes;
    batch->maps = maps;
    batch->lanes = meso_raster_lanes(1);
    batch->tolerance = 0.5f * maps->texel;
    batch->meshes = calloc(workers, sizeof *batch->meshes);
    batch->projected = calloc(workers, sizeof *batch->projected);
    batch->projected_room = calloc(workers, sizeof *batch->projected_room);
    batch->failed = !batch->meshes || !batch->projected || !batch->projected_room;
    for (size_t i = 0; i < (size_t)maps->count * maps->size * maps->size; i++)
        maps->nearness[i] = -INFINITY;
    for (batch->first = 0; batch->first < shapes->count && !batch->failed; batch->first += BATCH * RANGE) {
        uint64_t left = shapes->count - batch->first;
        batch->range_count = left < BATCH * RANGE ? (uint32_t)((left + RANGE - 1) / RANGE) : BATCH;
        meso_parallel_team(workers, batch->range_count, 1, make_ranges, batch);
        if (!batch->failed)
            meso_parallel_team(workers, maps->count, 1, draw_maps, batch);
    }
    bool failed = batch->failed;
    release(batch, workers);
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for the light") : MESO_OK;
}

/* ---- looking them up ---- */

enum { LANES = 32 };            /* maps at once */

/* Where a place lies in each map: the texel at its upper left, how far it is on to the next, and how near. */
typedef struct Places {
    int32_t x[LANES], y[LANES];
    float share_x[LANES], share_y[LANES], nearness[LANES], facing[LANES];
    float lit[4][LANES];        /* 1 at those of the four texels around where nothing is nearer */
} Places;

/* Within a map of which nothing reaches the outermost two texels: beside it is as there. */
static inline float within(float x, float last)
{
    x = x > 0 ? x : 0;
    return x < last ? x : last;
}

__attribute__((always_inline)) static inline void find_places(const MesoLightMaps *maps, uint32_t begin, uint32_t count,
                                                              MesoVec3 p, MesoVec3 n, Places *out)
{
    const float *tx = maps->rows[0] + begin, *ty = maps->rows[1] + begin, *tz = maps->rows[2] + begin;
    const float *rx = maps->rows[3] + begin, *ry = maps->rows[4] + begin, *rz = maps->rows[5] + begin;
    const float *dx = maps->rows[6] + begin, *dy = maps->rows[7] + begin, *dz = maps->rows[8] + begin;
    MesoVec3 eye = maps->maps[0].view.eye;
    float middle = maps->maps[0].view.middle_x, focal = maps->maps[0].view.focal, texel = maps->texel;
    float last = (float)(maps->size - 2);
    for (uint32_t i = 0; i < count; i++) {
        float facing = n.x * tx[i] + n.y * ty[i] + n.z * tz[i], lift = texel * (1 + 2 * (1 - facing));
        float qx = p.x + lift * n.x - eye.x, qy = p.y + lift * n.y - eye.y, qz = p.z + lift * n.z - eye.z;
        float x = within(middle + focal * (qx * rx[i] + qy * ry[i] + qz * rz[i]) - 0.5f, last);
        float y = within(middle + focal * (qx * dx[i] + qy * dy[i] + qz * dz[i]) - 0.5f, last);
        out->x[i] = (int32_t)x;
        out->y[i] = (int32_t)y;
        out->share_x[i] = x - (float)out->x[i];
        out->share_y[i] = y - (float)out->y[i];
        out->nearness[i] = texel + (qx * tx[i] + qy * ty[i] + qz * tz[i]);
        out->facing[i] = facing > 0 ? facing : 0;
    }
}

static inline void look_around(const MesoLightMaps *maps, uint32_t begin, uint32_t count, Places *places)
{
    int32_t cells = (int32_t)maps->size / 4;
    for (uint32_t i = 0; i < count; i++) {
        if (places->facing[i] == 0)
            continue;
        const float *map = maps->maps[begin + i].nearness;
        int32_t x = places->x[i], y = places->y[i], right = (x >> 2 < (x + 1) >> 2 ? 16 - 3 : 1);
        int32_t down = y >> 2 < (y + 1) >> 2 ? 16 * cells - 12 : 4;
        const float *at = map + (size_t)(((y >> 2) * cells + (x >> 2)) * 16 + (y & 3) * 4 + (x & 3));
        float mine = places->nearness[i];
        places->lit[0][i] = mine >= at[0];
        places->lit[1][i] = mine >= at[right];
        places->lit[2][i] = mine >= at[down];
        places->lit[3][i] = mine >= at[right + down];
    }
}

__attribute__((always_inline)) static inline void blend(const Places *places, uint32_t count, float *facing, float *lit)
{
    for (uint32_t i = 0; i < count; i++) {
        float x = places->share_x[i], y = places->share_y[i];
        float top = places->lit[0][i] * (1 - x) + places->lit[1][i] * x;
        float bottom = places->lit[2][i] * (1 - x) + places->lit[3][i] * x;
        facing[i] = places->facing[i];
        lit[i] = facing[i] > 0 ? top * (1 - y) + bottom * y : 0;
    }
}

__attribute__((always_inline)) static inline void look_up(const MesoLightMaps *maps, MesoVec3 p, MesoVec3 n,
                                                          float *facing, float *lit)
{
    Places places;
    memset(&places.lit, 0, sizeof places.lit);
    for (uint32_t begin = 0; begin < maps->count; begin += LANES) {
        uint32_t count = maps->count - begin < LANES ? maps->count - begin : LANES;
        find_places(maps, begin, count, p, n, &places);
        look_around(maps, begin, count, &places);
        blend(&places, count, facing + begin, lit + begin);
    }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static void look_up_avx2(const MesoLightMaps *maps, MesoVec3 p, MesoVec3 n,
                                                         float *facing, float *lit)
{
    look_up(maps, p, n, facing, lit);
}
#endif

void meso_light_maps_lit(const MesoLightMaps *maps, MesoVec3 p, MesoVec3 n, float *facing, float *lit)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        look_up_avx2(maps, p, n, facing, lit);
        return;
    }
#endif
    look_up(maps, p, n, facing, lit);
}
