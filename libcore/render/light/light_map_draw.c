#include "libcore/render/light/light_map.h"

#include <stdlib.h>

#include "libcore/base/parallel.h"

/* Shapes are made a batch at a time, by ranges, and each batch is drawn into the maps that have a texel for it. */
enum { RANGE = 64, BATCH = 64, MOST = 12 };       /* shapes, ranges, shapes */

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
    float reach;                /* towards the light of what stands for a surface: the least of its shapes */
} Range;

/* What a batch is for maps of one size. */
typedef struct Part {
    MesoLightMaps *maps;
    float tolerance;
    Range ranges[BATCH];
    uint64_t *wanted;           /* [BATCH * maps] a bit for each shape of a range that reaches a texel's middle there */
} Part;

/* Parts are made and drawn together: one map alone would keep one thread busy. */
typedef struct Batch {
    const MesoShapes *shapes;
    MesoRasterLanes lanes;
    uint64_t first;             /* shape */
    uint32_t range_count;
    Part *parts;
    uint32_t part_count, map_count;
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
    range->reach = fminf(range->reach, mesh->reach);
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
static bool make_range(const Batch *batch, Part *part, uint32_t r, MesoShapeMesh *mesh)
{
    Range *range = &part->ranges[r];
    uint64_t first = batch->first + (uint64_t)r * RANGE, left = batch->shapes->count - first, any = 0;
    uint32_t count = left < RANGE ? (uint32_t)left : RANGE;
    Boxes boxes = boxes_of(batch->shapes, first, count);
    for (uint32_t m = 0; m < part->maps->count; m++)
        any |= part->wanted[r * part->maps->count + m] = wanted_of(&part->maps->maps[m].view, &boxes, count);
    range->point_count = range->corner_count[0] = range->corner_count[1] = 0;
    range->reach = INFINITY;
    for (uint32_t i = 0; i <= RANGE; i++) {
        range->pieces[i] = (Piece){range->point_count, {range->corner_count[0], range->corner_count[1]}};
        if (i < count && any >> i & 1 &&
            !(meso_shape_make(batch->shapes, (uint32_t)(first + i), part->tolerance, MESO_SHAPE_SHADOW, mesh) &&
              add_mesh(range, mesh)))
            return false;
    }
    return true;
}

static void make_ranges(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Batch *batch = context;
    for (uint64_t i = begin; i < end; i++)
        if (!make_range(batch, &batch->parts[i / batch->range_count], (uint32_t)(i % batch->range_count),
                        &batch->meshes[worker]))
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
    /* What stands for thin shapes lies within them. Light is asked for two texels and more off a surface: half a texel
     * of that makes no surface shade itself. */
    MesoRasterView nearer = *view;
    nearer.eye = meso_vec3_mad(view->eye, range->reach, view->forward);
    for (uint32_t first = 0; wanted; ) {
        uint32_t skipped = (uint32_t)__builtin_ctzll(wanted);
        first += skipped;
        wanted >>= skipped;
        uint32_t run = ~wanted ? (uint32_t)__builtin_ctzll(~wanted) : RANGE;
        draw_pieces(target, &nearer, range, first, first + run, projected);
        first += run;
        wanted = run < RANGE ? wanted >> run : 0;
    }
}

/* False where memory is out. */
static bool draw_map(Batch *batch, const Part *part, uint32_t m, uint32_t worker)
{
    const MesoLightMaps *maps = part->maps;
    int32_t cells = (int32_t)maps->size / 4;
    const MesoRasterTarget target = {&batch->lanes, cells, cells, maps->maps[m].nearness, NULL};
    for (uint32_t r = 0; r < batch->range_count; r++) {
        const Range *range = &part->ranges[r];
        if (!grow((void **)&batch->projected[worker], &batch->projected_room[worker], range->point_count,
                  sizeof **batch->projected))
            return false;
        draw_range(&target, &maps->maps[m].view, range, part->wanted[r * maps->count + m], batch->projected[worker]);
    }
    return true;
}

static void draw_maps(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Batch *batch = context;
    for (uint64_t i = begin; i < end; i++) {
        const Part *part = batch->parts;
        uint64_t m = i;
        for (; m >= part->maps->count; part++)
            m -= part->maps->count;
        if (!draw_map(batch, part, (uint32_t)m, worker))
            fail(batch);
    }
}

static void release_part(Part *part)
{
    for (uint32_t r = 0; r < BATCH; r++) {
        free(part->ranges[r].x);
        free(part->ranges[r].y);
        free(part->ranges[r].z);
        free(part->ranges[r].corners[0]);
        free(part->ranges[r].corners[1]);
    }
    free(part->wanted);
}

static void release(Batch *batch, uint32_t workers)
{
    for (uint32_t w = 0; w < workers; w++) {
        if (batch->meshes)
            meso_shape_mesh_release(&batch->meshes[w]);
        if (batch->projected)
            free(batch->projected[w]);
    }
    for (uint32_t i = 0; batch->parts && i < batch->part_count; i++)
        release_part(&batch->parts[i]);
    free(batch->parts);
    free(batch->meshes);
    free(batch->projected);
    free(batch->projected_room);
}

/* False where memory is out. */
static bool begin_batch(Batch *batch, MesoLightMaps *const *sets, uint32_t set_count, uint32_t workers)
{
    batch->lanes = meso_raster_lanes(1);
    batch->parts = calloc(set_count + 1, sizeof *batch->parts);
    batch->part_count = set_count;
    batch->meshes = calloc(workers, sizeof *batch->meshes);
    batch->projected = calloc(workers, sizeof *batch->projected);
    batch->projected_room = calloc(workers, sizeof *batch->projected_room);
    bool made = batch->parts && batch->meshes && batch->projected && batch->projected_room;
    for (uint32_t i = 0; made && i < set_count; i++) {
        MesoLightMaps *maps = sets[i];
        Part *part = &batch->parts[i];
        part->maps = maps;
        part->tolerance = 0.5f * maps->texel;
        part->wanted = calloc((size_t)BATCH * maps->count + 1, sizeof *part->wanted);
        batch->map_count += maps->count;
        made = part->wanted != NULL;
        for (size_t t = 0; t < (size_t)maps->count * maps->size * maps->size; t++)
            maps->nearness[t] = -INFINITY;
    }
    return made;
}

MesoStatus meso_light_maps_draw(MesoLightMaps *const *sets, uint32_t set_count, const MesoShapes *shapes,
                                uint32_t thread_count, MesoError *error)
{
    uint32_t workers = thread_count ? thread_count : meso_parallel_cores();
    Batch batch = {.shapes = shapes};
    batch.failed = !begin_batch(&batch, sets, set_count, workers);
    for (; batch.first < shapes->count && !batch.failed; batch.first += BATCH * RANGE) {
        uint64_t left = shapes->count - batch.first;
        batch.range_count = left < BATCH * RANGE ? (uint32_t)((left + RANGE - 1) / RANGE) : BATCH;
        meso_parallel_team(workers, (uint64_t)batch.part_count * batch.range_count, 1, make_ranges, &batch);
        if (!batch.failed)
            meso_parallel_team(workers, batch.map_count, 1, draw_maps, &batch);
    }
    release(&batch, workers);
    return batch.failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for the light") : MESO_OK;
}
