#include "libcore/render/light/light_map.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/render/light/light_order.h"

/* Shapes are made a batch at a time, by ranges, and each batch is drawn into the maps that have a texel for it. */
enum { RANGE = MESO_SHAPE_BUNDLE, BATCH = 96, MOST = 12 };       /* shapes, ranges, shapes */

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
typedef struct Batch {
    MesoLightMaps *maps;
    Range ranges[BATCH];
    uint64_t *wanted;           /* [BATCH * maps] a bit for each shape of a range that reaches a texel's middle there */
} Batch;

typedef struct Drawing {
    const MesoShapes *shapes;
    MesoRasterLanes lanes;
    uint32_t *order;            /* of bundles, where they are made */
    uint64_t first;             /* bundle */
    uint32_t range_count, set_count, map_count;
    Batch *sets;                /* [set_count] */
    MesoShapeMesh *meshes;      /* one a worker */
    MesoRasterVertex **projected;
    uint64_t *projected_room;
    bool failed;
} Drawing;

static void fail(Drawing *d)
{
    __atomic_store_n(&d->failed, true, __ATOMIC_RELAXED);
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

static Boxes boxes_of(const MesoShapeBundle *bundle)
{
    Boxes boxes = {0};
    for (uint32_t i = 0; i < bundle->count; i++) {
        const MesoBox *box = &bundle->bounds[i];
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
    for (uint32_t i = 0; i < count; i += 8) {       /* eight bytes to bits: each is carried to the top by one factor */
        uint64_t bytes;
        memcpy(&bytes, has + i, sizeof bytes);
        wanted |= (bytes * 0x0102040810204080u >> 56) << i;
    }
    return count < RANGE ? wanted & ((1ull << count) - 1) : wanted;
}

/* ---- drawing ---- */

/* Those of the wanted that are not behind what the map has. */
static uint64_t before(const MesoShapes *shapes, const MesoLightMaps *maps, uint32_t m, const MesoShapeBundle *bundle,
                       uint64_t wanted)
{
    for (uint64_t left = wanted; left; left &= left - 1) {
        uint32_t i = (uint32_t)__builtin_ctzll(left);
        MesoRasterRect rect = meso_shape_rect(shapes, bundle, i, &maps->maps[m].view);
        if (meso_light_map_hides(&maps->maps[m], maps->size, &rect))
            wanted &= ~(1ull << i);
    }
    return wanted;
}

/* Where sweeps are made, nothing of a bundle is that all maps hide; false for such a one. */
static bool make_bundle(const Drawing *d, uint32_t r, MesoShapeBundle *bundle)
{
    uint32_t number = (uint32_t)(d->first + r);
    bool seen = !d->order;
    number = d->order ? d->order[number] : number;
    for (uint32_t s = 0; s < d->set_count && !seen; s++)
        seen = !meso_light_maps_hide(d->sets[s].maps, &d->shapes->bundle_bounds[number]);
    if (seen)
        meso_shape_bundle(d->shapes, number, bundle);
    return seen;
}

/* Returns what any map wants. */
static uint64_t look_at(const Drawing *d, Batch *batch, uint32_t r, const MesoShapeBundle *bundle, const Boxes *boxes)
{
    const MesoLightMaps *maps = batch->maps;
    uint64_t any = 0, *wanted = &batch->wanted[r * maps->count];
    for (uint32_t m = 0; m < maps->count; m++) {
        wanted[m] = wanted_of(&maps->maps[m].view, boxes, bundle->count);
        any |= wanted[m] = d->order ? before(d->shapes, maps, m, bundle, wanted[m]) : wanted[m];
    }
    return any;
}

/* Makes what some map wants of a range; false where memory is out. */
static bool make_range(const Drawing *d, Batch *batch, uint32_t r, const MesoShapeBundle *bundle, uint64_t any,
                       MesoShapeMesh *mesh)
{
    Range *range = &batch->ranges[r];
    range->point_count = range->corner_count[0] = range->corner_count[1] = 0;
    range->reach = INFINITY;
    for (uint32_t i = 0; i <= RANGE; i++) {
        range->pieces[i] = (Piece){range->point_count, {range->corner_count[0], range->corner_count[1]}};
        if (i < RANGE && any >> i & 1 &&
            !(meso_shape_make_bundled(d->shapes, bundle, i, batch->maps->tolerance, MESO_SHAPE_SHADOW, mesh) &&
              add_mesh(range, mesh)))
            return false;
    }
    return true;
}

static void want_nothing(const Drawing *d, uint32_t r)
{
    for (uint32_t s = 0; s < d->set_count; s++) {
        uint32_t count = d->sets[s].maps->count;
        memset(&d->sets[s].wanted[r * count], 0, count * sizeof *d->sets[s].wanted);
        d->sets[s].ranges[r].point_count = 0;
    }
}

static void make_ranges(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Drawing *d = context;
    MesoShapeBundle bundle;
    for (uint64_t r = begin; r < end; r++) {
        if (!make_bundle(d, (uint32_t)r, &bundle)) {
            want_nothing(d, (uint32_t)r);
            continue;
        }
        Boxes boxes = boxes_of(&bundle);
        for (uint32_t s = 0; s < d->set_count; s++) {
            uint64_t any = look_at(d, &d->sets[s], (uint32_t)r, &bundle, &boxes);
            if (!make_range(d, &d->sets[s], (uint32_t)r, &bundle, any, &d->meshes[worker]))
                fail(d);
        }
    }
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

static void draw_map(Drawing *d, uint32_t worker, const Batch *batch, uint32_t m)
{
    const MesoLightMap *map = &batch->maps->maps[m];
    int32_t cells = (int32_t)batch->maps->size / 4;
    const MesoRasterTarget target = {&d->lanes, cells, cells, map->nearness, NULL};
    for (uint32_t r = 0; r < d->range_count; r++) {
        const Range *range = &batch->ranges[r];
        if (!grow((void **)&d->projected[worker], &d->projected_room[worker], range->point_count,
                  sizeof **d->projected)) {
            fail(d);
            return;
        }
        draw_range(&target, &map->view, range, batch->wanted[r * batch->maps->count + m], d->projected[worker]);
    }
}

/* Maps of all sets are numbered through, from the last set on: nobody waits for the finest, which take longest. */
static void draw_maps(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Drawing *d = context;
    for (uint64_t i = begin; i < end; i++) {
        uint32_t set = d->set_count - 1, m = (uint32_t)i;
        while (m >= d->sets[set].maps->count)
            m -= d->sets[set--].maps->count;
        draw_map(d, worker, &d->sets[set], m);
    }
}

static void release_batch(Batch *batch)
{
    for (uint32_t r = 0; r < BATCH; r++) {
        free(batch->ranges[r].x);
        free(batch->ranges[r].y);
        free(batch->ranges[r].z);
        free(batch->ranges[r].corners[0]);
        free(batch->ranges[r].corners[1]);
    }
    free(batch->wanted);
}

static void release(Drawing *d, uint32_t workers)
{
    for (uint32_t w = 0; w < workers; w++) {
        if (d->meshes)
            meso_shape_mesh_release(&d->meshes[w]);
        if (d->projected)
            free(d->projected[w]);
    }
    for (uint32_t s = 0; d->sets && s < d->set_count; s++)
        release_batch(&d->sets[s]);
    free(d->sets);
    free(d->order);
    free(d->meshes);
    free(d->projected);
    free(d->projected_room);
}

static bool begin_batch(Batch *batch, MesoLightMaps *maps)
{
    batch->maps = maps;
    batch->wanted = calloc((size_t)BATCH * maps->count, sizeof *batch->wanted);
    for (size_t i = 0; i < (size_t)maps->count * maps->size * maps->size; i++)
        maps->nearness[i] = -INFINITY;
    return batch->wanted != NULL;
}

/* False where memory is out. */
static bool begin(Drawing *d, MesoLightMaps *const *sets)
{
    bool begun = d->sets && d->meshes && d->projected && d->projected_room;
    for (uint32_t s = 0; s < d->set_count && begun; s++) {
        begun = begin_batch(&d->sets[s], sets[s]);
        d->map_count += sets[s]->count;
    }
    return begun;
}

MesoStatus meso_light_maps_draw(MesoLightMaps *const *sets, uint32_t set_count, const MesoShapes *shapes,
                                uint32_t thread_count, MesoError *error)
{
    uint32_t workers = thread_count ? thread_count : meso_parallel_cores();
    Drawing d = {.shapes = shapes, .lanes = meso_raster_lanes(1), .set_count = set_count,
                 .sets = calloc(set_count, sizeof *d.sets), .meshes = calloc(workers, sizeof *d.meshes),
                 .projected = calloc(workers, sizeof *d.projected),
                 .projected_room = calloc(workers, sizeof *d.projected_room)};
    d.failed = !begin(&d, sets);
    if (!d.failed)              /* the last of them are the finest */
        d.order = meso_light_order(sets[set_count - 1], shapes, &d.failed);
    for (d.first = 0; d.first < shapes->bundle_count && !d.failed; d.first += BATCH) {
        uint64_t left = shapes->bundle_count - d.first;
        d.range_count = left < BATCH ? (uint32_t)left : BATCH;
        meso_parallel_team(workers, d.range_count, 1, make_ranges, &d);
        if (!d.failed)
            meso_parallel_team(workers, d.map_count, 1, draw_maps, &d);
    }
    release(&d, workers);
    return d.failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for the light") : MESO_OK;
}
