#include "libcore/render/light/light_map.h"

#include <stdlib.h>

#include "libcore/base/parallel.h"

/* Shapes are made a batch at a time, by ranges, and each batch is drawn into the maps that have a texel for it. */
enum { RANGE = 64, BATCH = 128, MOST = 12 };       /* shapes, ranges, shapes */

/* Where what a shape has begins in its range. */
typedef struct Piece {
    uint32_t point, corner[2];
} Piece;

typedef struct Range {
    Piece pieces[RANGE + 1];
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
    uint64_t *wanted;           /* [BATCH * maps] a bit for each shape of a range that reaches a texel's middle there */
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

/* ---- which shapes a map has a texel for ---- */

/* Middles and half extents. */
typedef struct Boxes {
    float middle[3][RANGE], half[3][RANGE];
} Boxes;

static Boxes boxes_of(const MesoShapes *shapes, uint64_t first, uint32_t count)
{
    Boxes boxes = {0};
    for (uint32_t i = 0; i < count; i++) {
        const MesoBox *box = &shapes->bounds[first + i];
        MesoVec3 middle = meso_vec3_lerp(box->low, box->high, 0.5f), half = meso_vec3_sub(box->high, middle);
        const float m[3] = {middle.x, middle.y, middle.z}, h[3] = {half.x, half.y, half.z};
        for (int k = 0; k < 3; k++) {
            boxes.middle[k][i] = m[k];
            boxes.half[k][i] = h[k];
        }
    }
    return boxes;
}

/* Whether there is a texel's middle within what a box covers. */
static inline uint8_t has_middle(float middle, float reach)
{
    const float slack = 2.f / MESO_RASTER_UNIT;
    return floorf(middle + reach - 0.5f + slack) >= middle - reach - 0.5f - slack;
}

__attribute__((always_inline)) static inline void look(const MesoRasterView *view, const Boxes *b, uint8_t *has)
{
    const MesoRasterView v = *view;
    const float *x = b->middle[0], *y = b->middle[1], *z = b->middle[2];
    const float *hx = b->half[0], *hy = b->half[1], *hz = b->half[2];
    float focal = v.focal, middle_x = v.middle_x, middle_y = v.middle_y;
    for (uint32_t i = 0; i < RANGE; i++) {
        float dx = x[i] - v.eye.x, dy = y[i] - v.eye.y, dz = z[i] - v.eye.z;
        float across = middle_x + focal * (dx * v.right.x + dy * v.right.y + dz * v.right.z);
        float down = middle_y + focal * (dx * v.down.x + dy * v.down.y + dz * v.down.z);
        float wide = focal * (fabsf(v.right.x) * hx[i] + fabsf(v.right.y) * hy[i] + fabsf(v.right.z) * hz[i]);
        float high = focal * (fabsf(v.down.x) * hx[i] + fabsf(v.down.y) * hy[i] + fabsf(v.down.z) * hz[i]);
        has[i] = has_middle(across, wide) & has_middle(down, high);
    }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static void look_avx2(const MesoRasterView *view, const Boxes *boxes, uint8_t *has)
{
    look(view, boxes, has);
}
#endif

static uint64_t wanted_of(const MesoRasterView *view, const Boxes *boxes, uint32_t count)
{
    uint8_t has[RANGE];
    uint64_t wanted = 0;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2"))
        look_avx2(view, boxes, has);
    else
#endif
        look(view, boxes, has);
    for (uint32_t i = 0; i < count; i++)
        wanted |= (uint64_t)has[i] << i;
    return wanted;
}

/* ---- drawing ---- */

/* Makes what some map wants of a range; false where memory is out. */
static bool make_range(Batch *batch, uint32_t r, MesoShapeMesh *mesh)
{
    Range *range = &batch->ranges[r];
    uint64_t first = batch->first + (uint64_t)r * RANGE, left = batch->shapes->count - first, any = 0;
    uint32_t count = left < RANGE ? (uint32_t)left : RANGE;
    Boxes boxes = boxes_of(batch->shapes, first, count);
    for (uint32_t m = 0; m < batch->maps->count; m++)
        any |= batch->wanted[r * batch->maps->count + m] = wanted_of(&batch->maps->maps[m].view, &boxes, count);
    range->point_count = range->corner_count[0] = range->corner_count[1] = 0;
    for (uint32_t i = 0; i <= RANGE; i++) {
        range->pieces[i] = (Piece){range->point_count, {range->corner_count[0], range->corner_count[1]}};
        if (i < count && any >> i & 1 &&
            !(meso_shape_make(batch->shapes, (uint32_t)(first + i), batch->tolerance, MESO_SHAPE_SHADOW, mesh) &&
              add_mesh(range, mesh)))
            return false;
    }
    return true;
}

static void make_ranges(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Batch *batch = context;
    for (uint64_t r = begin; r < end; r++)
        if (!make_range(batch, (uint32_t)r, &batch->meshes[worker]))
            fail(batch);
}

/* Draws shapes `first` to `last`, which is not one of them, of a range. */
static void draw_pieces(const MesoRasterTarget *target, const MesoRasterView *view, const Range *range, uint32_t first,
                        uint32_t last, MesoRasterVertex *projected)
{
    const Piece *begin = &range->pieces[first], *end = &range->pieces[last];
    uint32_t p = begin->point;
    meso_raster_project(view, range->x + p, range->y + p, range->z + p, end->point - p, 0, 0, projected + p);
    for (int closed = 0; closed < 2; closed++)
        meso_raster_draw(target, projected, range->corners[closed] + begin->corner[closed],
                         (end->corner[closed] - begin->corner[closed]) / 3, 0, closed);
}

static void draw_range(const MesoRasterTarget *target, const MesoRasterView *view, const Range *range, uint64_t wanted,
                       MesoRasterVertex *projected)
{
    if (__builtin_popcountll(wanted) > MOST)        /* rather a few for nothing than many calls */
        wanted = UINT64_MAX;
    for (uint32_t first = 0; wanted; ) {
        uint32_t skipped = (uint32_t)__builtin_ctzll(wanted);
        first += skipped;
        wanted >>= skipped;
        uint32_t run = ~wanted ? (uint32_t)__builtin_ctzll(~wanted) : RANGE;
        draw_pieces(target, view, range, first, first + run, projected);
        first += run;
        wanted = run < RANGE ? wanted >> run : 0;
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
            draw_range(&target, &map->view, range, batch->wanted[r * batch->maps->count + m], batch->projected[worker]);
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
    free(batch->wanted);
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
    batch->wanted = calloc((size_t)BATCH * maps->count, sizeof *batch->wanted);
    batch->meshes = calloc(workers, sizeof *batch->meshes);
    batch->projected = calloc(workers, sizeof *batch->projected);
    batch->projected_room = calloc(workers, sizeof *batch->projected_room);
    batch->failed = !batch->wanted || !batch->meshes || !batch->projected || !batch->projected_room;
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
