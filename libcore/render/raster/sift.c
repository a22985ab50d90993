/*
 * Leaves out small triangles, as in "Optimizing the Graphics Pipeline with Compute" (Wihlidal, GDC 2016), but by their
 * edges, and apart for each sample.
 */
#include "libcore/render/raster/sift.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"

enum { LANES = MESO_RASTER_LANES };

/*
 * Units by which a driver's vertices may lie beside ours along each axis: it rounds to a 16th of a pixel or less, and
 * we to one. So may each point of its triangle lie beside one of ours, whichever way either runs.
 */
enum { SLACK = MESO_RASTER_UNIT / 32 + 2 };

/* Triangles of more cells, or pixels, or as many units, are kept for all samples: edges of others fit in 32 bits. */
enum { MOST_CELLS = 4, MOST_PIXELS = 8, MOST_UNITS = 1 << 13 };

/* ---- a triangle ---- */

static inline int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static inline int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* The window. */
typedef struct Frame {
    const MesoRasterLanes *lanes;
    int32_t wide, high;         /* pixels */
    int32_t cells_x, cells_y;
    int32_t shift;              /* of a cell's units */
} Frame;

/* The box around a triangle, as wide as it may be drawn. */
typedef struct Reach {
    int32_t low_x, high_x, low_y, high_y;
} Reach;

/* (bx - ax)(y - ay) - (by - ay)(x - ax) + slack, at least 0 inside: as a sum of x and y times these, and a constant. */
typedef struct Side {
    int32_t along_x, along_y, constant;
} Side;

static inline Side make_side(const MesoRasterVertex *a, const MesoRasterVertex *b, int32_t turn)
{
    int32_t dx = turn * (b->x - a->x), dy = turn * (b->y - a->y);
    return (Side){-dy, dx, SLACK * (abs(dx) + abs(dy))};
}

/* Its value at (x, y), where it begins at `a`. */
static inline int32_t value_at(const Side *side, const MesoRasterVertex *a, int32_t x, int32_t y)
{
    return side->constant + side->along_x * (x - a->x) + side->along_y * (y - a->y);
}

/* Bits of the places in the cell whose corner is (x, y). */
__attribute__((always_inline)) static inline uint32_t places_in(const MesoRasterLanes *lanes, const Side sides[3],
                                                                const MesoRasterVertex *const v[3], int32_t x,
                                                                int32_t y)
{
    uint32_t bits = 0;
    int32_t e0 = value_at(&sides[0], v[0], x, y), e1 = value_at(&sides[1], v[1], x, y);
    int32_t e2 = value_at(&sides[2], v[2], x, y);
    for (int32_t l = 0; l < LANES; l++) {
        int32_t px = lanes->x[l], py = lanes->y[l];
        int32_t outside = (e0 + sides[0].along_x * px + sides[0].along_y * py) |
                          (e1 + sides[1].along_x * px + sides[1].along_y * py) |
                          (e2 + sides[2].along_x * px + sides[2].along_y * py);
        bits |= (uint32_t)(outside >= 0) << l;
    }
    return bits;
}

/* Samples whose places are among those bits. */
static inline uint32_t fold(uint32_t bits, uint32_t samples)
{
    if (samples == 16)
        return bits;
    bits |= bits >> 8;
    bits |= bits >> 4;
    return samples == 4 ? bits & 15 : (bits | bits >> 1 | bits >> 2 | bits >> 3) & 1;
}

static inline Reach reach_of(const MesoRasterVertex *a, const MesoRasterVertex *b, const MesoRasterVertex *c)
{
    return (Reach){least(a->x, least(b->x, c->x)) - SLACK, most(a->x, most(b->x, c->x)) + SLACK,
                   least(a->y, least(b->y, c->y)) - SLACK, most(a->y, most(b->y, c->y)) + SLACK};
}

static inline bool is_large(const Reach *r)
{
    return r->high_x - r->low_x >= MOST_UNITS || r->high_y - r->low_y >= MOST_UNITS;
}

/* 1 or -1, as a triangle that is not large runs. */
static inline int32_t turn_of(const MesoRasterVertex *a, const MesoRasterVertex *b, const MesoRasterVertex *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x) > 0 ? 1 : -1;
}

/* Cells, or pixels, all included. */
typedef struct Range {
    int32_t left, right, top, bottom;
} Range;

static inline int32_t count_of(const Range *r)
{
    return r->left > r->right || r->top > r->bottom ? 0 : (r->right - r->left + 1) * (r->bottom - r->top + 1);
}

/* With one sample a pixel: pixel by pixel, which are mostly none or one. */
static inline uint32_t middle_of(const Frame *frame, const MesoRasterVertex *a, const MesoRasterVertex *b,
                                 const MesoRasterVertex *c)
{
    enum { HALF = MESO_RASTER_UNIT / 2, UNIT = MESO_RASTER_UNIT };
    Reach reach = reach_of(a, b, c);
    const Range r = {most((reach.low_x + HALF - 1) >> 8, 0), least((reach.high_x - HALF) >> 8, frame->wide - 1),
                     most((reach.low_y + HALF - 1) >> 8, 0), least((reach.high_y - HALF) >> 8, frame->high - 1)};
    if (r.left > r.right || r.top > r.bottom)
        return 0;
    if (is_large(&reach) || count_of(&r) > MOST_PIXELS)
        return 1;
    int32_t turn = turn_of(a, b, c);
    const Side ab = make_side(a, b, turn), bc = make_side(b, c, turn), ca = make_side(c, a, turn);
    for (int32_t y = UNIT * r.top + HALF; y <= UNIT * r.bottom + HALF; y += UNIT)
        for (int32_t x = UNIT * r.left + HALF; x <= UNIT * r.right + HALF; x += UNIT)
            if ((value_at(&ab, a, x, y) | value_at(&bc, b, x, y) | value_at(&ca, c, x, y)) >= 0)
                return 1;
    return 0;
}

/* Bits of the samples that may see the triangle, of several a pixel. */
__attribute__((always_inline)) static inline uint32_t samples_of(const Frame *frame, const MesoRasterVertex *a,
                                                                 const MesoRasterVertex *b, const MesoRasterVertex *c)
{
    const MesoRasterLanes *lanes = frame->lanes;
    const MesoRasterVertex *const v[3] = {a, b, c};
    uint32_t bits = 0;
    Reach reach = reach_of(a, b, c);
    const Range r = {most(reach.low_x >> frame->shift, 0), least(reach.high_x >> frame->shift, frame->cells_x - 1),
                     most(reach.low_y >> frame->shift, 0), least(reach.high_y >> frame->shift, frame->cells_y - 1)};
    if (r.left > r.right || r.top > r.bottom)
        return 0;
    if (is_large(&reach) || count_of(&r) > MOST_CELLS)
        return (1u << lanes->samples) - 1;
    int32_t turn = turn_of(a, b, c);
    const Side sides[3] = {make_side(a, b, turn), make_side(b, c, turn), make_side(c, a, turn)};
    for (int32_t y = r.top; y <= r.bottom; y++)
        for (int32_t x = r.left; x <= r.right; x++)
            bits |= places_in(lanes, sides, v, x << frame->shift, y << frame->shift);
    return fold(bits, lanes->samples);
}

/* Of each triangle; returns whether any is seen at all. */
__attribute__((always_inline)) static inline bool sift_all(const Frame *frame, const MesoRasterPoints *points,
                                                           const uint32_t *corners, uint32_t count, uint16_t *samples)
{
    uint32_t any = 0;
    bool single = frame->lanes->samples == 1;
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t *k = corners + 3 * (size_t)t;
        MesoRasterVertex a = meso_raster_point(points, k[0]), b = meso_raster_point(points, k[1]);
        MesoRasterVertex c = meso_raster_point(points, k[2]);
        uint32_t seen = single ? middle_of(frame, &a, &b, &c) : samples_of(frame, &a, &b, &c);
        samples[t] = (uint16_t)seen;
        any |= seen;
    }
    return any;
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static bool sift_avx2(const Frame *frame, const MesoRasterPoints *points,
                                                      const uint32_t *corners, uint32_t count, uint16_t *samples)
{
    return sift_all(frame, points, corners, count, samples);
}
#endif

static bool sift_triangles(const Frame *frame, const MesoRasterPoints *points, const uint32_t *corners,
                           uint32_t count, uint16_t *samples)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2"))
        return sift_avx2(frame, points, corners, count, samples);
#endif
    return sift_all(frame, points, corners, count, samples);
}

/* ---- a shape ---- */

/* Of one thread. */
typedef struct Worker {
    MesoShapeBundle bundle;
    MesoShapeMesh mesh;
    uint32_t vertex_room, triangle_room, number_room;
    float *coordinates;         /* of all vertices along x, then y, then z */
    MesoRasterPoints projected;
    uint32_t *numbers;          /* [number_room] of vertices in the batch, + 1; 0: not there yet */
    uint16_t *samples;          /* [triangle_room] */
    uint8_t *seen;              /* [triangle_room] */
} Worker;

typedef struct Work {
    const MesoRasterJob *job;
    MesoRasterLanes lanes;
    Frame frame;
    MesoWindow window;
    Worker *workers;
    MesoSiftBatch *batches;     /* of a round */
    uint32_t first_bundle;      /* of the round */
    bool failed;
} Work;

static bool grow(void **array, uint64_t count, size_t size)
{
    void *grown = count <= SIZE_MAX / size ? realloc(*array, count * size) : NULL;
    if (grown)
        *array = grown;
    return grown != NULL;
}

static bool make_room(Worker *w)
{
    if (w->mesh.vertex_count > w->vertex_room) {
        uint64_t room = 2 * (uint64_t)w->mesh.vertex_count;
        if (!grow((void **)&w->coordinates, 3 * room, sizeof *w->coordinates) ||
            !grow((void **)&w->projected.x, room, sizeof *w->projected.x) ||
            !grow((void **)&w->projected.y, room, sizeof *w->projected.y) ||
            !grow((void **)&w->projected.nearness, room, sizeof *w->projected.nearness))
            return false;
        w->vertex_room = (uint32_t)room;
    }
    if (w->mesh.triangle_count > w->triangle_room) {
        uint64_t room = 2 * (uint64_t)w->mesh.triangle_count;
        if (!grow((void **)&w->samples, room, sizeof *w->samples) ||
            !grow((void **)&w->seen, room, sizeof *w->seen))
            return false;
        w->triangle_room = (uint32_t)room;
    }
    return true;
}

/* Which samples see each triangle of the mesh: all, where some of it lies behind the near plane. */
static bool look_at_mesh(const Work *work, Worker *w)
{
    const MesoShapeMesh *mesh = &w->mesh;
    uint32_t count = mesh->vertex_count;
    float *x = w->coordinates, *y = x + count, *z = y + count;
    for (uint32_t v = 0; v < count; v++) {
        x[v] = mesh->vertices[v].position.x;
        y[v] = mesh->vertices[v].position.y;
        z[v] = mesh->vertices[v].position.z;
    }
    bool before = meso_raster_project(&work->job->view, x, y, z, count, (float)work->window.x, (float)work->window.y,
                                      &w->projected);
    if (before)
        return sift_triangles(&work->frame, &w->projected, mesh->corners, mesh->triangle_count, w->samples);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        w->samples[t] = (uint16_t)((1u << work->lanes.samples) - 1);
    return true;
}

/* For all of the mesh. */
static bool make_batch_room(MesoSiftBatch *batch, Worker *w, uint32_t samples)
{
    uint64_t count = (uint64_t)batch->vertex_count + w->mesh.vertex_count;
    if (w->mesh.vertex_count > w->number_room) {
        uint64_t room = 2 * (uint64_t)w->mesh.vertex_count;
        if (!grow((void **)&w->numbers, room, sizeof *w->numbers))
            return false;
        w->number_room = (uint32_t)room;
    }
    if (count > batch->vertex_room) {
        if (2 * count > UINT32_MAX || !grow((void **)&batch->vertices, 2 * count, sizeof *batch->vertices))
            return false;
        batch->vertex_room = (uint32_t)(2 * count);
    }
    for (uint32_t i = 0; i < samples; i++) {
        count = (uint64_t)batch->index_counts[i] + 3 * (uint64_t)w->mesh.triangle_count;
        if (count <= batch->index_rooms[i])
            continue;
        if (2 * count > UINT32_MAX || !grow((void **)&batch->indices[i], 2 * count, sizeof *batch->indices[i]))
            return false;
        batch->index_rooms[i] = (uint32_t)(2 * count);
    }
    return true;
}

static MesoSiftVertex make_vertex(const MesoShapeMesh *mesh, uint32_t v, uint32_t shape)
{
    const MesoMeshVertex *from = &mesh->vertices[v];
    MesoMeshColor color = mesh->colors ? mesh->colors[v] : (MesoMeshColor){255, 255, 255};
    return (MesoSiftVertex){from->position, from->normal, shape, {color.r, color.g, color.b, 255}, from->uv};
}

/* Takes the triangles that are seen over into the batch. */
static void put_mesh(MesoSiftBatch *batch, Worker *w, uint32_t shape)
{
    const MesoShapeMesh *mesh = &w->mesh;
    memset(w->numbers, 0, mesh->vertex_count * sizeof *w->numbers);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!w->samples[t])
            continue;
        uint32_t corners[3];
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = mesh->corners[3 * (size_t)t + k];
            if (w->numbers[v] == 0) {
                batch->vertices[batch->vertex_count++] = make_vertex(mesh, v, shape);
                w->numbers[v] = batch->vertex_count;
            }
            corners[k] = w->numbers[v] - 1;
        }
        for (uint32_t left = w->samples[t]; left; left &= left - 1) {
            uint32_t sample = (uint32_t)__builtin_ctz(left);
            memcpy(batch->indices[sample] + batch->index_counts[sample], corners, sizeof corners);
            batch->index_counts[sample] += 3;
        }
    }
}

/* False where memory is out. */
static bool add_shape(const Work *work, Worker *w, MesoSiftBatch *batch, uint32_t i)
{
    const MesoRasterJob *job = work->job;
    uint32_t shape = w->bundle.shapes[i];
    float depth = meso_raster_rect(&job->view, &w->bundle.bounds[i]).depth;
    float tolerance = job->tolerance * meso_raster_pixel(&job->view, depth);
    if (!meso_shape_make_bundled(job->shapes, &w->bundle, i, tolerance, MESO_SHAPE_SEEN, &w->mesh) || !make_room(w))
        return false;
    if (!look_at_mesh(work, w))
        return true;
    for (uint32_t t = 0; t < w->mesh.triangle_count; t++)
        w->seen[t] = w->samples[t] != 0;
    if (!meso_shape_make_seen(job->shapes, shape, tolerance, w->seen, &w->mesh) ||
        !make_batch_room(batch, w, work->lanes.samples))
        return false;
    put_mesh(batch, w, shape);
    return true;
}

/* ---- all of them ---- */

/* Bundles of a batch, and batches that are held at once: two for each thread, but no more than these. */
enum { BATCH_BUNDLES = 16, MOST_BATCHES = 32 };

/* Whether some sample of the window may lie in the rectangle. */
static bool reaches(const Work *work, const MesoRasterRect *r)
{
    const MesoWindow *w = &work->window;
    return r->right > (float)w->x && r->bottom > (float)w->y && r->left < (float)(w->x + w->width) &&
           r->top < (float)(w->y + w->height);
}

static bool add_bundle(const Work *work, Worker *w, MesoSiftBatch *batch, uint32_t bundle)
{
    const MesoShapes *shapes = work->job->shapes;
    const MesoRasterView *view = &work->job->view;
    if (shapes->bundle_bounds) {
        MesoRasterRect rect = meso_raster_rect(view, &shapes->bundle_bounds[bundle]);
        if (!reaches(work, &rect))
            return true;
    }
    meso_shape_bundle(shapes, bundle, &w->bundle);
    for (uint32_t i = 0; i < w->bundle.count; i++) {
        MesoRasterRect rect = meso_shape_rect(shapes, &w->bundle, i, view);
        if (reaches(work, &rect) && !add_shape(work, w, batch, i))
            return false;
    }
    return true;
}

static void fill_batches(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Work *work = context;
    for (uint64_t k = begin; k < end; k++) {
        MesoSiftBatch *batch = &work->batches[k];
        uint64_t first = work->first_bundle + k * BATCH_BUNDLES, count = work->job->shapes->bundle_count;
        batch->vertex_count = 0;
        memset(batch->index_counts, 0, sizeof batch->index_counts);
        for (uint64_t b = first; b < first + BATCH_BUNDLES && b < count; b++)
            if (!add_bundle(work, &work->workers[worker], batch, (uint32_t)b))
                __atomic_store_n(&work->failed, true, __ATOMIC_RELAXED);
    }
}

static MesoStatus sift_rounds(Work *work, uint32_t workers, uint32_t batches, MesoTakeBatch *take, void *context,
                              MesoError *error)
{
    MesoStatus status = MESO_OK;
    uint64_t bundles = work->job->shapes->bundle_count, round = (uint64_t)batches * BATCH_BUNDLES;
    for (uint64_t first = 0; first < bundles && !status; first += round) {
        uint64_t left = (bundles - first + BATCH_BUNDLES - 1) / BATCH_BUNDLES;
        uint32_t count = left < batches ? (uint32_t)left : batches;
        work->first_bundle = (uint32_t)first;
        meso_parallel_team(workers, count, 1, fill_batches, work);
        if (work->failed)
            return meso_fail(error, MESO_ERR_MEMORY, "out of memory for drawing");
        for (uint32_t k = 0; k < count && !status; k++)
            if (work->batches[k].vertex_count)
                status = take(context, &work->batches[k], error);
    }
    return status;
}

static void release_worker(Worker *w)
{
    meso_shape_mesh_release(&w->mesh);
    free(w->coordinates);
    free(w->projected.x);
    free(w->projected.y);
    free(w->projected.nearness);
    free(w->numbers);
    free(w->samples);
    free(w->seen);
}

static void release_batch(MesoSiftBatch *batch)
{
    free(batch->vertices);
    for (uint32_t i = 0; i < LANES; i++)
        free(batch->indices[i]);
}

MesoStatus meso_sift(const MesoRasterJob *job, MesoWindow window, uint32_t thread_count, MesoTakeBatch *take,
                     void *context, MesoError *error)
{
    Work work = {.job = job, .lanes = meso_raster_lanes(job->samples), .window = window};
    int32_t pixels = (int32_t)work.lanes.pixels;
    int32_t wide = (int32_t)window.width, high = (int32_t)window.height;
    work.frame = (Frame){&work.lanes, wide, high, (wide + pixels - 1) / pixels, (high + pixels - 1) / pixels,
                         __builtin_ctz((unsigned)work.lanes.cell)};
    uint32_t workers = thread_count ? thread_count : meso_parallel_cores();
    uint32_t batches = 2 * (uint64_t)workers < MOST_BATCHES ? 2 * workers : MOST_BATCHES;
    workers = workers < batches ? workers : batches;
    work.workers = calloc(workers, sizeof *work.workers);
    work.batches = calloc(batches, sizeof *work.batches);
    MesoStatus status = work.workers && work.batches
        ? sift_rounds(&work, workers, batches, take, context, error)
        : meso_fail(error, MESO_ERR_MEMORY, "out of memory for drawing");
    for (uint32_t i = 0; work.workers && i < workers; i++)
        release_worker(&work.workers[i]);
    for (uint32_t i = 0; work.batches && i < batches; i++)
        release_batch(&work.batches[i]);
    free(work.workers);
    free(work.batches);
    return status;
}
