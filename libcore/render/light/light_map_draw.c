#include "libcore/render/light/light_map.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/team.h"
#include "libcore/render/light/light_order.h"
#include "libcore/render/raster/raster_draw.h"
#include "libcore/render/raster/shape_points.h"

/*
 * Shapes are made a batch at a time, by ranges, and each batch is drawn into the maps that have a texel for it. Where
 * nothing is left out for what has been drawn before, the next batch is made while one is drawn: who has done with the
 * maps, of which some take long, makes ranges.
 */
enum { RANGE = MESO_SHAPE_BUNDLE, BATCH = 20, MOST = 12 };       /* shapes, ranges, shapes */

/* Elements that an array begins with: all that half of the ranges have. */
enum { LEAST_ROOM = 4096 };

/* What a shape has in its range. */
typedef struct Piece {
    uint32_t point, corner;     /* where its points begin, and the corners of its triangles, if it is no sweep */
    uint32_t width;             /* of a sweep's rings; of others 0 */
    bool closed;
} Piece;

typedef struct Range {
    Piece pieces[RANGE + 1];
    float *x, *y, *z;
    uint8_t *joined;            /* which points have sides (shapes.h) */
    uint32_t *corners;          /* of a shape's triangles, from its first point on */
    uint32_t point_count, corner_count;
    uint64_t room[4], corner_room;
    float reach;                /* towards the light of what stands for a surface: the least of its shapes */
} Range;

/* What a batch is for maps of one size. */
typedef struct Batch {
    MesoLightMaps *maps;
    Range ranges[BATCH];
    uint64_t *wanted;           /* [BATCH * maps] a bit for each shape of a range that reaches a texel's middle there */
} Batch;

/* What is drawn, or made, at once. */
typedef struct Turn {
    uint64_t first;             /* bundle */
    uint32_t range_count;
    Batch *sets;                /* [set_count] */
} Turn;

/* Points in a map. */
typedef struct Projected {
    MesoRasterPoints points;
    uint64_t room[3];
} Projected;

typedef struct Drawing {
    const MesoShapes *shapes;
    MesoRasterLanes lanes;
    uint32_t *order;            /* of bundles, where they are made */
    uint32_t set_count, map_count;
    Turn turns[2];              /* the one that is drawn, and the next one; where there is an order, one alone */
    uint32_t now;               /* which of them is drawn */
    MesoTeam *team;
    MesoShapeMesh *meshes;      /* one a worker */
    Projected *projected;       /* one a worker */
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
    uint64_t wanted = 2 * count > LEAST_ROOM ? 2 * count : LEAST_ROOM;
    void *grown = realloc(*array, wanted * size);
    if (!grown)
        return false;
    *array = grown;
    *room = wanted;
    return true;
}

static bool add_mesh(Range *range, const MesoShapeMesh *mesh, Piece *piece)
{
    const MesoShapeColumns *columns = mesh->columns;
    uint64_t points = range->point_count + meso_shape_point_count(mesh);
    uint64_t corners = range->corner_count + (columns ? 0 : 3 * (uint64_t)mesh->triangle_count);
    if (points > UINT32_MAX - MESO_RASTER_SPARE || corners > UINT32_MAX ||
        !grow((void **)&range->x, &range->room[0], points, sizeof *range->x) ||
        !grow((void **)&range->y, &range->room[1], points, sizeof *range->y) ||
        !grow((void **)&range->z, &range->room[2], points, sizeof *range->z) ||
        !grow((void **)&range->joined, &range->room[3], points + MESO_RASTER_SPARE, sizeof *range->joined) ||
        !grow((void **)&range->corners, &range->corner_room, corners, sizeof *range->corners))
        return false;
    uint32_t first = range->point_count;
    meso_shape_points(mesh, range->x + first, range->y + first, range->z + first, range->joined + first);
    piece->closed = mesh->closed;
    piece->width = columns ? columns->place_count : 0;
    if (corners > range->corner_count)
        memcpy(range->corners + range->corner_count, mesh->corners,
               (corners - range->corner_count) * sizeof *mesh->corners);
    range->reach = fminf(range->reach, mesh->reach);
    range->point_count = (uint32_t)points;
    range->corner_count = (uint32_t)corners;
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
static bool make_bundle(const Drawing *d, const Turn *turn, uint32_t r, MesoShapeBundle *bundle)
{
    uint32_t number = (uint32_t)(turn->first + r);
    bool seen = !d->order;
    number = d->order ? d->order[number] : number;
    for (uint32_t s = 0; s < d->set_count && !seen; s++)
        seen = !meso_light_maps_hide(turn->sets[s].maps, &d->shapes->bundle_bounds[number]);
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
    range->point_count = range->corner_count = 0;
    range->reach = INFINITY;
    for (uint32_t i = 0; i <= RANGE; i++) {
        range->pieces[i] = (Piece){.point = range->point_count, .corner = range->corner_count};
        if (i < RANGE && any >> i & 1 &&
            !(meso_shape_place_bundled(d->shapes, bundle, i, batch->maps->tolerance, MESO_SHAPE_SHADOW, mesh) &&
              add_mesh(range, mesh, &range->pieces[i])))
            return false;
    }
    return true;
}

static void want_nothing(const Drawing *d, const Turn *turn, uint32_t r)
{
    for (uint32_t s = 0; s < d->set_count; s++) {
        Batch *batch = &turn->sets[s];
        memset(&batch->wanted[r * batch->maps->count], 0, batch->maps->count * sizeof *batch->wanted);
        batch->ranges[r].point_count = 0;
    }
}

static void make_ranges(Drawing *d, uint32_t worker, const Turn *turn, uint32_t r)
{
    MesoShapeBundle bundle;
    if (!make_bundle(d, turn, r, &bundle)) {
        want_nothing(d, turn, r);
        return;
    }
    Boxes boxes = boxes_of(&bundle);
    for (uint32_t s = 0; s < d->set_count; s++) {
        uint64_t any = look_at(d, &turn->sets[s], r, &bundle, &boxes);
        if (!make_range(d, &turn->sets[s], r, &bundle, any, &d->meshes[worker]))
            fail(d);
    }
}

/* Draws one shape, or, of sweeps alike, all that follow up to `last`; returns the next one. */
static const Piece *draw_alike(MesoRasterQueue *queue, const Range *range, const Piece *begin, const Piece *last,
                               const MesoRasterPoints *projected)
{
    const Piece *end = begin + 1;
    MesoRasterPoints points = meso_raster_points_from(projected, begin->point);
    if (!begin->width) {
        meso_raster_add(queue, &points, range->corners + begin->corner, (end->corner - begin->corner) / 3, 0,
                        begin->closed);
        return end;
    }
    while (end < last && end->width == begin->width && end->closed == begin->closed)
        end++;
    const MesoRasterRings rings = {.count = end->point - begin->point - begin->width, .width = begin->width,
                                   .joined = range->joined + begin->point};
    meso_raster_add_rings(queue, &points, &rings, 0, begin->closed);
    return end;
}

/* Draws shapes `first` to `last`, which is not one of them, of a range. */
static void draw_pieces(MesoRasterQueue *queue, const MesoRasterView *view, const Range *range, uint32_t first,
                        uint32_t last, const MesoRasterPoints *projected)
{
    const Piece *begin = &range->pieces[first], *end = &range->pieces[last];
    uint32_t p = begin->point;
    MesoRasterPoints points = meso_raster_points_from(projected, p);
    meso_raster_project(view, range->x + p, range->y + p, range->z + p, end->point - p, 0, 0, &points);
    while (begin < end)
        begin = draw_alike(queue, range, begin, end, projected);
}

static void draw_range(MesoRasterQueue *queue, const MesoRasterView *view, const Range *range, uint64_t wanted,
                       const MesoRasterPoints *projected)
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
        draw_pieces(queue, &nearer, range, first, first + run, projected);
        first += run;
        wanted = run < RANGE ? wanted >> run : 0;
    }
}

static void draw_map(Drawing *d, uint32_t worker, const Batch *batch, uint32_t range_count, uint32_t m)
{
    const MesoLightMap *map = &batch->maps->maps[m];
    int32_t cells = (int32_t)batch->maps->size / 4;
    const MesoRasterTarget target = {&d->lanes, cells, cells, map->nearness, NULL, NULL};
    Projected *projected = &d->projected[worker];
    MesoRasterPoints *points = &projected->points;
    MesoRasterQueue queue;
    meso_raster_begin(&queue, &target);
    for (uint32_t r = 0; r < range_count; r++) {
        const Range *range = &batch->ranges[r];
        uint64_t count = (uint64_t)range->point_count + MESO_RASTER_SPARE;
        if (!grow((void **)&points->x, &projected->room[0], count, sizeof *points->x) ||
            !grow((void **)&points->y, &projected->room[1], count, sizeof *points->y) ||
            !grow((void **)&points->nearness, &projected->room[2], count, sizeof *points->nearness)) {
            fail(d);
            return;
        }
        draw_range(&queue, &map->view, range, batch->wanted[r * batch->maps->count + m], points);
    }
    meso_raster_flush(&queue);
}

/* Maps of all sets are numbered through, from the last set on: nobody waits for the finest, which take longest. */
static void draw_one(Drawing *d, uint32_t worker, const Turn *turn, uint32_t m)
{
    uint32_t set = d->set_count - 1;
    while (m >= turn->sets[set].maps->count)
        m -= turn->sets[set--].maps->count;
    draw_map(d, worker, &turn->sets[set], turn->range_count, m);
}

/* The maps of one batch, then the ranges of the next one. */
static void work(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Drawing *d = context;
    const Turn *drawn = &d->turns[d->now], *made = &d->turns[!d->now];
    uint32_t maps = drawn->range_count ? d->map_count : 0;
    for (uint64_t i = begin; i < end; i++)
        if (i < maps)
            draw_one(d, worker, drawn, (uint32_t)i);
        else
            make_ranges(d, worker, made, (uint32_t)(i - maps));
}

/* Draws what has been made, and makes the batch that begins with bundle `first`. */
static void take_turn(Drawing *d, uint64_t first)
{
    Turn *drawn = &d->turns[d->now], *made = &d->turns[!d->now];
    uint64_t left = d->shapes->bundle_count - first;
    made->first = first;
    made->range_count = left < BATCH ? (uint32_t)left : BATCH;
    meso_team_work(d->team, (drawn->range_count ? d->map_count : 0) + made->range_count, 1, work, d);
    drawn->range_count = 0;
    d->now = !d->now;
}

static void release_batch(Batch *batch)
{
    for (uint32_t r = 0; r < BATCH; r++) {
        free(batch->ranges[r].x);
        free(batch->ranges[r].y);
        free(batch->ranges[r].z);
        free(batch->ranges[r].joined);
        free(batch->ranges[r].corners);
    }
    free(batch->wanted);
}

static void release(Drawing *d)
{
    for (uint32_t w = 0; w < meso_team_size(d->team); w++) {
        if (d->meshes)
            meso_shape_mesh_release(&d->meshes[w]);
        if (!d->projected)
            continue;
        free(d->projected[w].points.x);
        free(d->projected[w].points.y);
        free(d->projected[w].points.nearness);
    }
    for (int b = 0; b < 2; b++) {
        for (uint32_t s = 0; d->turns[b].sets && s < d->set_count; s++)
            release_batch(&d->turns[b].sets[s]);
        free(d->turns[b].sets);
    }
    free(d->order);
    free(d->meshes);
    free(d->projected);
    meso_team_end(d->team);
}

static bool begin_turn(Turn *turn, MesoLightMaps *const *sets, uint32_t set_count)
{
    turn->sets = calloc(set_count, sizeof *turn->sets);
    bool begun = turn->sets != NULL;
    for (uint32_t s = 0; s < set_count && begun; s++) {
        turn->sets[s].maps = sets[s];
        turn->sets[s].wanted = calloc((size_t)BATCH * sets[s]->count, sizeof *turn->sets[s].wanted);
        begun = turn->sets[s].wanted != NULL;
    }
    return begun;
}

static void clear(MesoLightMaps *maps)
{
    for (size_t i = 0; i < (size_t)maps->count * maps->size * maps->size; i++)
        maps->nearness[i] = -INFINITY;
}

/* False where memory is out. */
static bool begin(Drawing *d, MesoLightMaps *const *sets)
{
    uint32_t workers = meso_team_size(d->team);
    bool failed = false;
    d->meshes = calloc(workers, sizeof *d->meshes);
    d->projected = calloc(workers, sizeof *d->projected);
    for (uint32_t s = 0; s < d->set_count; s++) {
        d->map_count += sets[s]->count;
        clear(sets[s]);
    }
    d->order = meso_light_order(sets[d->set_count - 1], d->shapes, &failed);    /* the last of them are the finest */
    bool begun = !failed && d->meshes && d->projected;
    for (int b = 0; b < 2 && begun; b++)
        begun = begin_turn(&d->turns[b], sets, d->set_count);
    return begun;
}

MesoStatus meso_light_maps_draw(MesoLightMaps *const *sets, uint32_t set_count, const MesoShapes *shapes,
                                uint32_t thread_count, MesoError *error)
{
    Drawing d = {.shapes = shapes, .lanes = meso_raster_lanes(1), .set_count = set_count,
                 .team = meso_team_begin(thread_count)};
    d.failed = !begin(&d, sets);
    for (uint64_t first = 0; first < shapes->bundle_count && !d.failed; first += BATCH) {
        take_turn(&d, first);
        if (d.order && !d.failed)
            take_turn(&d, shapes->bundle_count);
    }
    if (!d.failed)
        take_turn(&d, shapes->bundle_count);
    release(&d);
    return d.failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for the light") : MESO_OK;
}
