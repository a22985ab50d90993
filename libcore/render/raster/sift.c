#include "libcore/render/raster/sift.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/arena.h"
#include "libcore/base/parallel.h"
#include "libcore/base/pipeline.h"
#include "libcore/render/raster/sift_triangles.h"

enum { LANES = MESO_RASTER_LANES };

/* Batches that are held at once: two for each thread, but no more than these. */
enum { MOST_BATCHES = 32 };

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
    float nearness[MESO_SIFT_PLACES];
} Worker;

/* What may be seen in a part: a shape, or a bundle where sweeps are made; and how far away it begins. */
typedef struct Near {
    float depth;
    uint32_t item;
} Near;

typedef struct Work {
    const MesoRasterJob *job;
    MesoRasterLanes lanes;
    MesoWindow window;
    bool bundled;               /* items are bundles */
    uint32_t item_count;
    const MesoBox *bounds;      /* [item_count] */
    int32_t slack;
    uint32_t side;              /* pixels of a part */
    uint32_t parts_x, parts_y;
    MesoTileRange *ranges;      /* [item_count] parts that each may be seen in */
    float *depths;              /* [item_count] */
    uint64_t *begin;            /* [parts + 1] */
    Near *near;                 /* by part */
    Worker *workers;
    uint32_t batch_count;
    MesoSiftBatch *batches;     /* that of a part has its number's rest */
    MesoTakeBatch *take;
    void *context;
    MesoStatus status;          /* of `take` */
    MesoError *error;
    bool failed;                /* memory is out */
} Work;

/* The part that a worker has at hand. */
typedef struct Hand {
    const Work *work;
    Worker *worker;
    MesoSiftBatch *batch;
    MesoSiftPart part;
    uint32_t left, top;         /* pixels of the picture */
} Hand;

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
static bool look_at_mesh(const Hand *hand)
{
    const Work *work = hand->work;
    Worker *w = hand->worker;
    const MesoShapeMesh *mesh = &w->mesh;
    uint32_t count = mesh->vertex_count;
    float *x = w->coordinates, *y = x + count, *z = y + count;
    for (uint32_t v = 0; v < count; v++) {
        x[v] = mesh->vertices[v].position.x;
        y[v] = mesh->vertices[v].position.y;
        z[v] = mesh->vertices[v].position.z;
    }
    bool before = meso_raster_project(&work->job->view, x, y, z, count, (float)hand->left, (float)hand->top,
                                      &w->projected);
    if (before)
        return meso_sift_triangles(&hand->part, &w->projected, mesh->corners, mesh->triangle_count, w->samples);
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

/* Whether nothing in the rectangle, of the picture, is seen. */
static bool is_hidden(const Hand *hand, MesoRasterRect rect)
{
    float left = (float)hand->left, top = (float)hand->top;
    rect.left -= left;
    rect.right -= left;
    rect.top -= top;
    rect.bottom -= top;
    return meso_sift_hides(&hand->part, &rect);
}

/* Shape `i` of the worker's bundle; false where memory is out. */
static bool add_shape(const Hand *hand, uint32_t i)
{
    const MesoRasterJob *job = hand->work->job;
    Worker *w = hand->worker;
    uint32_t shape = w->bundle.shapes[i];
    float depth = meso_raster_rect(&job->view, &w->bundle.bounds[i]).depth;
    float tolerance = job->tolerance * meso_raster_pixel(&job->view, depth);
    if (!meso_shape_make_bundled(job->shapes, &w->bundle, i, tolerance, MESO_SHAPE_SEEN, &w->mesh) || !make_room(w))
        return false;
    if (!look_at_mesh(hand))
        return true;
    for (uint32_t t = 0; t < w->mesh.triangle_count; t++)
        w->seen[t] = w->samples[t] != 0;
    if (!meso_shape_make_seen(job->shapes, shape, tolerance, w->seen, &w->mesh) ||
        !make_batch_room(hand->batch, w, hand->work->lanes.samples))
        return false;
    put_mesh(hand->batch, w, shape);
    return true;
}

/* ---- a part ---- */

/* By their numbers where they are as far: the same order for any number of threads. */
static int by_depth(const void *a, const void *b)
{
    const Near *x = a, *y = b;
    if (x->depth != y->depth)
        return x->depth < y->depth ? -1 : 1;
    return x->item < y->item ? -1 : x->item > y->item;
}

/* A bundle, or one shape as one. */
static bool add_item(const Hand *hand, uint32_t item)
{
    const Work *work = hand->work;
    const MesoRasterJob *job = work->job;
    MesoShapeBundle *bundle = &hand->worker->bundle;
    if (is_hidden(hand, meso_raster_rect(&job->view, &work->bounds[item])))
        return true;
    if (!work->bundled) {
        bundle->count = 1;
        bundle->made = false;
        bundle->shapes[0] = item;
        bundle->bounds[0] = work->bounds[item];
        return add_shape(hand, 0);
    }
    meso_shape_bundle(job->shapes, item, bundle);
    for (uint32_t i = 0; i < bundle->count; i++)
        if (!is_hidden(hand, meso_shape_rect(job->shapes, bundle, i, &job->view)) && !add_shape(hand, i))
            return false;
    return true;
}

/* From the nearest to the farthest. */
static void make_part(void *context, uint32_t worker, uint64_t number)
{
    Work *work = context;
    Worker *w = &work->workers[worker];
    uint32_t x = (uint32_t)(number % work->parts_x) * work->side, y = (uint32_t)(number / work->parts_x) * work->side;
    uint32_t wide = work->window.width - x, high = work->window.height - y;
    const MesoRasterView *view = &work->job->view;
    const Hand hand = {
        .work = work, .worker = w, .batch = &work->batches[number % work->batch_count],
        .left = work->window.x + x, .top = work->window.y + y,
        .part = {.lanes = &work->lanes, .wide = (int32_t)(wide < work->side ? wide : work->side),
                 .high = (int32_t)(high < work->side ? high : work->side), .parallel = view->parallel,
                 .focal = view->focal, .cut = view->parallel ? -view->near_depth : INFINITY, .slack = work->slack,
                 .nearness = w->nearness}};
    uint64_t begin = work->begin[number], end = work->begin[number + 1];
    hand.batch->vertex_count = 0;
    memset(hand.batch->index_counts, 0, sizeof hand.batch->index_counts);
    meso_sift_clear(&hand.part);
    qsort(work->near + begin, end - begin, sizeof *work->near, by_depth);
    for (uint64_t i = begin; i < end; i++)
        if (!add_item(&hand, work->near[i].item)) {
            __atomic_store_n(&work->failed, true, __ATOMIC_RELAXED);
            break;
        }
}

static bool take_part(void *context, uint64_t number)
{
    Work *work = context;
    const MesoSiftBatch *batch = &work->batches[number % work->batch_count];
    if (__atomic_load_n(&work->failed, __ATOMIC_RELAXED))
        return false;
    if (batch->vertex_count)
        work->status = work->take(work->context, batch, work->error);
    return work->status == MESO_OK;
}

/* ---- all of them ---- */

static uint16_t part_at(float pixel, uint32_t side, uint32_t parts)
{
    float part = floorf(pixel / (float)side);
    return part > 0 ? part < (float)(parts - 1) ? (uint16_t)part : (uint16_t)(parts - 1) : 0;
}

static void find_ranges(void *context, uint64_t begin, uint64_t end)
{
    Work *work = context;
    float left = (float)work->window.x, top = (float)work->window.y;
    float width = (float)work->window.width, height = (float)work->window.height;
    for (uint64_t i = begin; i < end; i++) {
        MesoRasterRect r = meso_raster_rect(&work->job->view, &work->bounds[i]);
        work->depths[i] = r.depth;
        work->ranges[i] = (MesoTileRange){1, 0, 0, 0};
        if (r.right > left && r.bottom > top && r.left < left + width && r.top < top + height)
            work->ranges[i] = (MesoTileRange){part_at(r.left - left, work->side, work->parts_x),
                                              part_at(r.top - top, work->side, work->parts_y),
                                              part_at(r.right - left, work->side, work->parts_x),
                                              part_at(r.bottom - top, work->side, work->parts_y)};
    }
}

/* What each part may show, by its number. */
static MesoStatus sort_items(Work *work, MesoArena *arena, MesoError *error)
{
    uint32_t parts = work->parts_x * work->parts_y;
    for (uint32_t i = 0; i < work->item_count; i++)
        for (uint32_t y = work->ranges[i].top; y <= work->ranges[i].bottom; y++)
            for (uint32_t x = work->ranges[i].left; x <= work->ranges[i].right; x++)
                work->begin[y * work->parts_x + x + 1]++;
    for (uint32_t p = 0; p < parts; p++)
        work->begin[p + 1] += work->begin[p];
    work->near = MESO_NEW(arena, Near, work->begin[parts], error);
    uint64_t *next = MESO_NEW(arena, uint64_t, parts, error);
    if (!work->near || !next)
        return MESO_ERR_MEMORY;
    memcpy(next, work->begin, parts * sizeof *next);
    for (uint32_t i = 0; i < work->item_count; i++)
        for (uint32_t y = work->ranges[i].top; y <= work->ranges[i].bottom; y++)
            for (uint32_t x = work->ranges[i].left; x <= work->ranges[i].right; x++)
                work->near[next[y * work->parts_x + x]++] = (Near){work->depths[i], i};
    return MESO_OK;
}

static MesoStatus divide(Work *work, MesoArena *arena, uint32_t thread_count, MesoError *error)
{
    const MesoShapes *shapes = work->job->shapes;
    work->bundled = shapes->made > 0;
    work->item_count = work->bundled ? shapes->bundle_count : shapes->count;
    work->bounds = work->bundled ? shapes->bundle_bounds : shapes->bounds;
    work->side = meso_sift_side(work->job->samples);
    work->parts_x = (work->window.width + work->side - 1) / work->side;
    work->parts_y = (work->window.height + work->side - 1) / work->side;
    work->ranges = MESO_NEW(arena, MesoTileRange, work->item_count, error);
    work->depths = MESO_NEW(arena, float, work->item_count, error);
    work->begin = MESO_NEW(arena, uint64_t, (uint64_t)work->parts_x * work->parts_y + 1, error);
    if (!work->ranges || !work->depths || !work->begin)
        return MESO_ERR_MEMORY;
    meso_parallel_for(thread_count, work->item_count, 4096, find_ranges, work);
    return sort_items(work, arena, error);
}

static MesoStatus sift_parts(Work *work, uint32_t workers)
{
    const MesoPipeline pipeline = {(uint64_t)work->parts_x * work->parts_y, work->batch_count, work, make_part,
                                   take_part};
    meso_pipeline_run(&pipeline, workers);
    if (work->status || !work->failed)
        return work->status;
    return meso_fail(work->error, MESO_ERR_MEMORY, "out of memory for drawing");
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

/*
 * Beside what both sides round: a driver's matrix of floats puts points beside where they are by some roundings of
 * their distance from the anchor, and of the eye's, in pixels at their depth. That grows where the eye is near and the
 * scene large, up to a quarter of a pixel here.
 */
static int32_t slack_of(const MesoRasterJob *job, uint32_t bits)
{
    const float roundings = 6, most = MESO_RASTER_UNIT / 4;
    const MesoRasterView *view = &job->view;
    const MesoBox *box = &job->shapes->scene->box;
    float reach = 0;
    for (uint32_t i = 0; i < 8; i++)
        reach = fmaxf(reach, meso_vec3_length(meso_vec3_sub(meso_box_corner(box->low, box->high, i),
                                                            job->shapes->anchor)));
    float pixels = (reach + meso_vec3_length(view->eye)) * view->focal / (view->parallel ? 1 : view->near_depth);
    float more = ceilf(roundings * 0x1p-24f * MESO_RASTER_UNIT * pixels);
    return meso_sift_slack(bits) + (int32_t)(more < most ? more : most);
}

MesoStatus meso_sift(const MesoRasterJob *job, MesoWindow window, uint32_t bits, uint32_t thread_count,
                     MesoTakeBatch *take, void *context, MesoError *error)
{
    Work work = {.job = job, .lanes = meso_raster_lanes(job->samples), .window = window,
                 .slack = slack_of(job, bits), .take = take, .context = context, .error = error};
    uint32_t workers = thread_count ? thread_count : meso_parallel_cores();
    MesoArena arena;
    meso_arena_init(&arena);
    work.batch_count = 2 * (uint64_t)workers < MOST_BATCHES ? 2 * workers : MOST_BATCHES;
    workers = workers < work.batch_count ? workers : work.batch_count;
    work.workers = calloc(workers, sizeof *work.workers);
    work.batches = calloc(work.batch_count, sizeof *work.batches);
    MesoStatus status = work.workers && work.batches
        ? divide(&work, &arena, thread_count, error)
        : meso_fail(error, MESO_ERR_MEMORY, "out of memory for drawing");
    if (!status)
        status = sift_parts(&work, workers);
    for (uint32_t i = 0; work.workers && i < workers; i++)
        release_worker(&work.workers[i]);
    for (uint32_t i = 0; work.batches && i < work.batch_count; i++)
        release_batch(&work.batches[i]);
    free(work.workers);
    free(work.batches);
    meso_arena_release(&arena);
    return status;
}
