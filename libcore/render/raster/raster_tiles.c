#include "libcore/render/raster/raster_tiles.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/large_pages.h"
#include "libcore/base/parallel.h"
#include "libcore/render/raster/raster_draw.h"
#include "libcore/render/raster/raster_hidden.h"
#include "libcore/render/raster/shape_points.h"

enum { LANES = MESO_RASTER_LANES, CELLS = MESO_TILE_CELLS, PLACES = LANES * CELLS * CELLS };

/* ---- a tile ---- */

/* A triangle that some place shows. */
typedef struct SeenTriangle {
    uint32_t shape, triangle;
    bool colored;
    MesoMeshColor colors[3];
    MesoMeshVertex corners[3];
} SeenTriangle;

/* A bundle, and how far away it begins. */
typedef struct BundleAt {
    float depth;
    uint32_t bundle;
} BundleAt;

struct MesoRasterTile {
    const MesoRasterBins *bins;
    MesoRasterTarget target;
    MesoRasterQueue queue;
    MesoWindow window;
    const uint32_t *shapes;     /* [shape_count] of the tile */
    uint32_t shape_count;
    MesoShapeBundle bundle;     /* where bundles are binned: the one at hand, */
    BundleAt *bundles;          /* those of the tile from the nearest to the farthest, */
    uint32_t *drawn_shapes;     /* and what is drawn of them */
    uint32_t bundle_room;
    uint32_t *first_ids;        /* [shape_count + 1] */
    float *tolerances;          /* [shape_count] that they were made with */
    uint32_t shape_room;
    uint8_t *is_seen;           /* [first_ids[shape_count]] 1: some place shows the triangle of that id, */
    uint32_t *numbers;          /* and then which of those seen it is */
    uint64_t triangle_room;
    MesoShapeMesh mesh;
    float *coordinates;         /* of all points along x, then y, then z */
    uint8_t *joined;            /* which of them have sides */
    MesoVec3 *from_eye;         /* where some lie behind the near plane */
    MesoRasterPoints projected;
    uint32_t point_room;
    SeenTriangle *seen;         /* [PLACES] */
    size_t seen_size;           /* of it, from the system */
    bool failed, drawn;
    float nearness[PLACES], farthest[CELLS * CELLS];
    uint32_t ids[PLACES];       /* of triangles, 0: none; at last the numbers of those seen, from 1 */
};

static bool grow(void **array, uint64_t count, size_t size)
{
    void *grown = count <= SIZE_MAX / size ? realloc(*array, count * size) : NULL;
    if (grown)
        *array = grown;
    return grown != NULL;
}

/* For `count` shapes, and one more. */
static bool make_room(MesoRasterTile *tile, uint32_t count)
{
    if (count + 1 <= tile->shape_room)
        return true;
    uint64_t room = 2 * (uint64_t)count + 16;
    if (room > UINT32_MAX || !grow((void **)&tile->first_ids, room, sizeof *tile->first_ids) ||
        !grow((void **)&tile->tolerances, room, sizeof *tile->tolerances) ||
        (tile->bins->bundled && !grow((void **)&tile->drawn_shapes, room, sizeof *tile->drawn_shapes)))
        return false;
    tile->shape_room = (uint32_t)room;
    return true;
}

/* Where the edge from a to b meets the near plane. */
static MesoVec3 cut(MesoVec3 a, MesoVec3 b, float near_depth)
{
    MesoVec3 p = meso_vec3_lerp(a, b, (near_depth - a.z) / (b.z - a.z));
    p.z = near_depth;
    return p;
}

/* A triangle that reaches behind the near plane: what is before it, as one or two. */
static void draw_cut(MesoRasterTile *tile, const uint32_t *corners, uint32_t id)
{
    static const uint32_t fans[6] = {0, 1, 2, 0, 2, 3};
    const MesoRasterView *view = &tile->bins->job.view;
    int32_t x[4], y[4];
    float nearness[4];
    const MesoRasterPoints points = {x, y, nearness};
    float left = (float)tile->window.x, top = (float)tile->window.y;
    uint32_t count = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 a = tile->from_eye[corners[k]], b = tile->from_eye[corners[(k + 1) % 3]];
        bool a_before = a.z >= view->near_depth, b_before = b.z >= view->near_depth;
        if (a_before)
            meso_raster_put_point(&points, count++, meso_raster_vertex(view, a, left, top));
        if (a_before != b_before)
            meso_raster_put_point(&points, count++,
                                  meso_raster_vertex(view, cut(a, b, view->near_depth), left, top));
    }
    for (uint32_t i = 0; i + 2 < count; i++)
        meso_raster_add(&tile->queue, &points, fans + 3 * i, 1, id, false);
}

/* Vertex by vertex; false where some of them lie behind the near plane. */
static bool project_each(MesoRasterTile *tile)
{
    const MesoRasterView *view = &tile->bins->job.view;
    float left = (float)tile->window.x, top = (float)tile->window.y;
    bool before = true;
    for (uint32_t v = 0; v < tile->mesh.vertex_count; v++) {
        MesoVec3 q = meso_raster_from_eye(view, tile->mesh.vertices[v].position);
        tile->from_eye[v] = q;
        if (q.z >= view->near_depth)
            meso_raster_put_point(&tile->projected, v, meso_raster_vertex(view, q, left, top));
        else
            before = false;
    }
    return before;
}

/* Triangle by triangle, as some lie behind the near plane, or may. */
static void draw_each(MesoRasterTile *tile, uint32_t first_id)
{
    const MesoShapeMesh *mesh = &tile->mesh;
    float near_depth = tile->bins->job.view.near_depth;
    if (project_each(tile)) {
        meso_raster_add(&tile->queue, &tile->projected, mesh->corners, mesh->triangle_count, first_id, false);
        return;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = mesh->corners + 3 * (size_t)t;
        bool whole = true;
        for (uint32_t k = 0; k < 3; k++)
            whole = whole && tile->from_eye[c[k]].z >= near_depth;
        if (whole)
            meso_raster_add(&tile->queue, &tile->projected, c, 1, first_id + t, false);
        else
            draw_cut(tile, c, first_id + t);
    }
}

/* How a shape is made. */
typedef struct Making {
    uint32_t shape;
    const MesoShapeBundle *bundle;      /* that has it as its number `place`; NULL: it is made by itself */
    uint32_t place;
    float tolerance;
} Making;

static bool make_shape(MesoRasterTile *tile, const Making *m, bool placed)
{
    const MesoShapes *shapes = tile->bins->job.shapes;
    if (m->bundle)
        return (placed ? meso_shape_place_bundled : meso_shape_make_bundled)(shapes, m->bundle, m->place, m->tolerance,
                                                                             MESO_SHAPE_SEEN, &tile->mesh);
    return (placed ? meso_shape_place : meso_shape_make)(shapes, m->shape, m->tolerance, MESO_SHAPE_SEEN, &tile->mesh);
}

/* False where memory is out. */
static bool draw_mesh(MesoRasterTile *tile, const Making *making, uint32_t count, uint32_t first_id)
{
    const MesoRasterView *view = &tile->bins->job.view;
    const MesoShapeMesh *mesh = &tile->mesh;
    float *x = tile->coordinates, *y = x + count, *z = y + count;
    if (!view->parallel)
        meso_shape_points(mesh, x, y, z, tile->joined);
    if (view->parallel || !meso_raster_project(view, x, y, z, count, (float)tile->window.x, (float)tile->window.y,
                                               &tile->projected)) {
        bool made = !mesh->placed || make_shape(tile, making, false);
        if (made)
            draw_each(tile, first_id);
        return made;
    }
    if (!mesh->columns) {
        meso_raster_add(&tile->queue, &tile->projected, mesh->corners, mesh->triangle_count, first_id, false);
        return true;
    }
    uint32_t width = mesh->columns->place_count;
    const MesoRasterRings rings = {(mesh->ring_count - 1) * width, width, tile->joined, mesh->columns->place_sides,
                                   mesh->columns->side_count};
    meso_raster_add_rings(&tile->queue, &tile->projected, &rings, first_id, false);
    return true;
}

/* Its triangles are in the queue. */
static bool draw_made(MesoRasterTile *tile, const Making *making, uint32_t first_id)
{
    uint64_t count = meso_shape_point_count(&tile->mesh), vertices = tile->mesh.vertex_count;
    uint64_t most = (count > vertices ? count : vertices) + MESO_RASTER_SPARE;
    if (most > UINT32_MAX / 2)
        return false;
    if (most > tile->point_room) {
        uint64_t room = 2 * most;
        if (!grow((void **)&tile->coordinates, 3 * room, sizeof *tile->coordinates) ||
            !grow((void **)&tile->joined, room, sizeof *tile->joined) ||
            !grow((void **)&tile->from_eye, room, sizeof *tile->from_eye) ||
            !grow((void **)&tile->projected.x, room, sizeof *tile->projected.x) ||
            !grow((void **)&tile->projected.y, room, sizeof *tile->projected.y) ||
            !grow((void **)&tile->projected.nearness, room, sizeof *tile->projected.nearness))
            return false;
        tile->point_room = (uint32_t)room;
    }
    return draw_mesh(tile, making, (uint32_t)count, first_id);
}

static bool draw_shape(MesoRasterTile *tile, const Making *making, uint64_t *id)
{
    if (!make_shape(tile, making, !tile->bins->job.view.parallel) || !draw_made(tile, making, (uint32_t)*id))
        return false;
    *id += tile->mesh.triangle_count;
    return *id <= UINT32_MAX;
}

static bool draw_shapes(MesoRasterTile *tile)
{
    const MesoRasterJob *job = &tile->bins->job;
    uint64_t id = 1;
    if (!make_room(tile, tile->shape_count))
        return false;
    for (uint32_t i = 0; i < tile->shape_count; i++) {
        uint32_t shape = tile->shapes[i];
        tile->first_ids[i] = (uint32_t)id;
        tile->tolerances[i] = meso_raster_tolerance(job, shape);
        const Making making = {.shape = shape, .tolerance = tile->tolerances[i]};
        if (!draw_shape(tile, &making, &id))
            return false;
    }
    tile->first_ids[tile->shape_count] = (uint32_t)id;
    return true;
}

/* ---- bundles of a tile ---- */

/* By their places in the list where they are as far: the same order for any number of threads. */
static int by_depth(const void *a, const void *b)
{
    const BundleAt *x = a, *y = b;
    if (x->depth != y->depth)
        return x->depth < y->depth ? -1 : 1;
    return x->bundle < y->bundle ? -1 : x->bundle > y->bundle;
}

static bool sort_bundles(MesoRasterTile *tile, const uint32_t *binned, uint32_t count)
{
    const MesoRasterBins *bins = tile->bins;
    if (count > tile->bundle_room) {
        if (!grow((void **)&tile->bundles, 2 * (uint64_t)count, sizeof *tile->bundles))
            return false;
        tile->bundle_room = 2 * count;
    }
    for (uint32_t i = 0; i < count; i++)
        tile->bundles[i] = (BundleAt){meso_raster_rect(&bins->job.view, &bins->bounds[binned[i]]).depth, binned[i]};
    qsort(tile->bundles, count, sizeof *tile->bundles, by_depth);
    return true;
}

static bool is_hidden(const MesoRasterTile *tile, const MesoRasterRect *rect)
{
    return meso_raster_hides(&tile->target, &tile->window, &tile->bins->job.view, rect);
}

static bool draw_bundle(MesoRasterTile *tile, uint64_t *id)
{
    const MesoRasterJob *job = &tile->bins->job;
    const MesoShapeBundle *bundle = &tile->bundle;
    for (uint32_t i = 0; i < bundle->count; i++) {
        MesoRasterRect rect = meso_shape_rect(job->shapes, bundle, i, &job->view);
        if (is_hidden(tile, &rect))
            continue;
        if (!make_room(tile, tile->shape_count + 1))
            return false;
        float depth = meso_raster_rect(&job->view, &bundle->bounds[i]).depth;
        float tolerance = job->tolerance * meso_raster_pixel(&job->view, depth);
        tile->first_ids[tile->shape_count] = (uint32_t)*id;
        tile->tolerances[tile->shape_count] = tolerance;
        tile->drawn_shapes[tile->shape_count++] = bundle->shapes[i];
        const Making making = {bundle->shapes[i], bundle, i, tolerance};
        if (!draw_shape(tile, &making, id))
            return false;
    }
    return true;
}

/* Near ones first, so that few of those behind them are made at all. */
static bool draw_bundles(MesoRasterTile *tile)
{
    const MesoRasterBins *bins = tile->bins;
    uint32_t count = tile->shape_count;
    uint64_t id = 1;
    if (!sort_bundles(tile, tile->shapes, count))
        return false;
    tile->shape_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bundle = tile->bundles[i].bundle;
        MesoRasterRect rect = meso_raster_rect(&bins->job.view, &bins->bounds[bundle]);
        if (is_hidden(tile, &rect))
            continue;
        meso_shape_bundle(bins->job.shapes, bundle, &tile->bundle);
        if (!draw_bundle(tile, &id))
            return false;
    }
    if (!make_room(tile, tile->shape_count))
        return false;
    tile->first_ids[tile->shape_count] = (uint32_t)id;
    tile->shapes = tile->drawn_shapes;
    tile->drawn = tile->shape_count > 0;
    return true;
}

/* ---- what has been seen ---- */

static void keep_triangle(MesoRasterTile *tile, uint32_t shape, uint32_t triangle, SeenTriangle *out)
{
    const MesoShapeMesh *mesh = &tile->mesh;
    const uint32_t *corners = mesh->corners + 3 * (size_t)triangle;
    out->shape = shape;
    out->triangle = triangle;
    out->colored = mesh->colors != NULL;
    for (uint32_t k = 0; k < 3; k++) {
        out->corners[k] = mesh->vertices[corners[k]];
        if (out->colored)
            out->colors[k] = mesh->colors[corners[k]];
    }
}

/* Makes shape `i` again, to be looked at, and keeps those of its triangles that are seen, the next of them `number`. */
static bool keep_shape(MesoRasterTile *tile, uint32_t i, uint32_t *number)
{
    uint32_t first = tile->first_ids[i], count = tile->first_ids[i + 1] - first, shape = tile->shapes[i];
    const uint8_t *begin = tile->is_seen + first, *end = begin + count, *at = memchr(begin, 1, count);
    if (!at)
        return true;
    if (!meso_shape_make_seen(tile->bins->job.shapes, shape, tile->tolerances[i], begin, &tile->mesh))
        return false;
    for (; at; at = memchr(at + 1, 1, (size_t)(end - at) - 1)) {
        uint32_t triangle = (uint32_t)(at - begin);
        keep_triangle(tile, shape, triangle, &tile->seen[*number]);
        tile->numbers[first + triangle] = ++*number;
    }
    return true;
}

/* False where memory is out. */
static bool find_seen(MesoRasterTile *tile, uint32_t ids)
{
    if (ids > tile->triangle_room) {
        if (!grow((void **)&tile->is_seen, 2 * (uint64_t)ids, sizeof *tile->is_seen) ||
            !grow((void **)&tile->numbers, 2 * (uint64_t)ids, sizeof *tile->numbers))
            return false;
        tile->triangle_room = 2 * (uint64_t)ids;
    }
    memset(tile->is_seen, 0, ids);
    for (uint32_t i = 0; i < PLACES; i++)
        tile->is_seen[tile->ids[i]] = 1;
    return true;
}

static bool keep_seen(MesoRasterTile *tile)
{
    uint32_t number = 0;
    if (!find_seen(tile, tile->first_ids[tile->shape_count]))
        return false;
    for (uint32_t i = 0; i < tile->shape_count; i++)
        if (!keep_shape(tile, i, &number))
            return false;
    tile->numbers[0] = 0;
    for (uint32_t i = 0; i < PLACES; i++)
        tile->ids[i] = tile->numbers[tile->ids[i]];
    return true;
}

/* False where memory is out, or a tile has more triangles than 32 bits count. */
static bool draw_tile(MesoRasterTile *tile, uint64_t number)
{
    const MesoRasterBins *bins = tile->bins;
    uint32_t pixels = (uint32_t)bins->tile_pixels, x = (uint32_t)(number % bins->tiles_x) * pixels;
    uint32_t y = (uint32_t)(number / bins->tiles_x) * pixels;
    tile->window = (MesoWindow){x, y, bins->job.width - x < pixels ? bins->job.width - x : pixels,
                                bins->job.height - y < pixels ? bins->job.height - y : pixels};
    tile->shapes = bins->binned + bins->begin[number];
    tile->shape_count = (uint32_t)(bins->begin[number + 1] - bins->begin[number]);
    tile->drawn = tile->shape_count > 0;
    if (!tile->drawn)
        return true;
    meso_raster_clear(&tile->target, bins->job.view.parallel ? -INFINITY : 0);
    meso_raster_begin(&tile->queue, &tile->target);
    if (!(bins->bundled ? draw_bundles : draw_shapes)(tile))
        return false;
    meso_raster_flush(&tile->queue);
    return keep_seen(tile);
}

/* ---- what is there ---- */

MesoWindow meso_raster_tile_window(const MesoRasterTile *tile)
{
    return tile->window;
}

bool meso_raster_tile_empty(const MesoRasterTile *tile)
{
    return !tile->drawn;
}

/* Shares of the corners where the ray meets their plane: by the volumes that it spans with each side. */
static void find_shares(const MesoVec3 p[3], const MesoRasterRay *ray, float shares[3], bool *behind)
{
    MesoVec3 q[3];
    double volume[3], sum = 0;
    for (int k = 0; k < 3; k++)
        q[k] = meso_vec3_sub(p[k], ray->origin);
    for (int k = 0; k < 3; k++) {
        MesoVec3 a = q[(k + 1) % 3], b = q[(k + 2) % 3], d = ray->direction;
        volume[k] = ((double)a.y * b.z - (double)a.z * b.y) * d.x + ((double)a.z * b.x - (double)a.x * b.z) * d.y +
                    ((double)a.x * b.y - (double)a.y * b.x) * d.z;
        sum += volume[k];
    }
    *behind = sum > 0;          /* the triangle runs clockwise, seen along the ray */
    for (int k = 0; k < 3; k++) {
        double share = sum != 0 ? volume[k] / sum : 1. / 3;
        shares[k] = (float)(share > 0 ? share < 1 ? share : 1 : 0);
    }
    float total = shares[0] + shares[1] + shares[2];
    for (int k = 0; k < 3; k++)
        shares[k] /= total;
}

static MesoVec3 blend(MesoVec3 a, MesoVec3 b, MesoVec3 c, const float shares[3])
{
    return meso_vec3_mad(meso_vec3_mad(meso_vec3_scale(a, shares[0]), shares[1], b), shares[2], c);
}

static void look_at(const MesoRasterView *view, const SeenTriangle *seen, float x, float y, MesoSurfaceSample *out)
{
    const MesoMeshVertex *v[3] = {&seen->corners[0], &seen->corners[1], &seen->corners[2]};
    const MesoVec3 corners[3] = {v[0]->position, v[1]->position, v[2]->position};
    float *shares = out->shares;
    bool behind;
    MesoRasterRay ray = meso_raster_ray(view, x, y);
    find_shares(corners, &ray, shares, &behind);
    out->position = blend(corners[0], corners[1], corners[2], shares);
    out->normal = meso_vec3_unit(blend(v[0]->normal, v[1]->normal, v[2]->normal, shares), (MesoVec3){0, 0, 1});
    if (behind)
        out->normal = meso_vec3_scale(out->normal, -1);
    out->depth = meso_vec3_dot(meso_vec3_sub(out->position, view->eye), view->forward);
    out->uv = (MesoVec2){v[0]->uv.x * shares[0] + v[1]->uv.x * shares[1] + v[2]->uv.x * shares[2],
                         v[0]->uv.y * shares[0] + v[1]->uv.y * shares[1] + v[2]->uv.y * shares[2]};
    out->along = out->uv.y;
    for (int k = 0; k < 3; k++)
        out->color[k] = 1;
    if (!seen->colored)
        return;
    out->color[0] = out->color[1] = out->color[2] = 0;
    for (int k = 0; k < 3; k++) {
        const MesoMeshColor *color = &seen->colors[k];
        out->color[0] += shares[k] * (float)color->r / 255;
        out->color[1] += shares[k] * (float)color->g / 255;
        out->color[2] += shares[k] * (float)color->b / 255;
    }
}

/* Number of the triangle that a sample shows, or 0. */
static uint32_t number_at(const MesoRasterTile *tile, uint32_t x, uint32_t y, uint32_t lane)
{
    uint32_t pixels = tile->bins->lanes.pixels;
    return tile->ids[(size_t)LANES * (y / pixels * CELLS + x / pixels) + lane];
}

static uint32_t lane_of(const MesoRasterLanes *lanes, uint32_t x, uint32_t y, uint32_t sample)
{
    return ((y % lanes->pixels) * lanes->pixels + x % lanes->pixels) * lanes->samples + sample;
}

/* Triangles that are seen beside each other are anywhere: what will be looked at is on its way before that. */
static void look_ahead(const MesoRasterTile *tile, uint32_t x, uint32_t y)
{
    enum { AHEAD = 4, LINE = 64 };
    if (x + AHEAD >= tile->window.width)
        return;
    uint32_t number = number_at(tile, x + AHEAD, y, lane_of(&tile->bins->lanes, x + AHEAD, y, 0));
    const unsigned char *seen = (const unsigned char *)&tile->seen[number ? number - 1 : 0];
    __builtin_prefetch(seen);
    __builtin_prefetch(seen + LINE);
}

bool meso_raster_tile_sample(MesoRasterTile *tile, uint32_t x, uint32_t y, uint32_t sample, MesoSurfaceSample *out)
{
    const MesoRasterLanes *lanes = &tile->bins->lanes;
    if (!tile->drawn)
        return false;
    if (sample == 0)
        look_ahead(tile, x, y);
    uint32_t lane = lane_of(lanes, x, y, sample), number = number_at(tile, x, y, lane);
    if (number == 0)
        return false;
    const SeenTriangle *seen = &tile->seen[number - 1];
    out->shape = seen->shape;
    out->triangle = seen->triangle;
    const float unit = 1.f / MESO_RASTER_UNIT, cell = (float)lanes->pixels;
    float cell_x = (float)(x / lanes->pixels), cell_y = (float)(y / lanes->pixels);
    look_at(&tile->bins->job.view, seen, (float)tile->window.x + cell_x * cell + (float)lanes->x[lane] * unit,
            (float)tile->window.y + cell_y * cell + (float)lanes->y[lane] * unit, out);
    return true;
}

/* ---- all of them ---- */

typedef struct Drawing {
    const uint32_t *order;      /* of tiles */
    MesoRasterTile **tiles;     /* one a worker */
    MesoTakeTile *take;
    void *context;
} Drawing;

static void draw_tiles(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    const Drawing *d = context;
    MesoRasterTile *tile = d->tiles[worker];
    for (uint64_t i = begin; i < end && !tile->failed; i++) {
        if (draw_tile(tile, d->order[i]))
            d->take(d->context, tile);
        else
            tile->failed = true;
    }
}

static void release(MesoRasterTile *tile)
{
    if (!tile)
        return;
    meso_shape_mesh_release(&tile->mesh);
    free(tile->bundles);
    free(tile->drawn_shapes);
    free(tile->first_ids);
    free(tile->tolerances);
    meso_large_give(tile->seen, tile->seen_size);
    free(tile->coordinates);
    free(tile->is_seen);
    free(tile->numbers);
    free(tile->joined);
    free(tile->from_eye);
    free(tile->projected.x);
    free(tile->projected.y);
    free(tile->projected.nearness);
    free(tile);
}

static MesoRasterTile *make_tile(const MesoRasterBins *bins)
{
    MesoRasterTile *tile = calloc(1, sizeof *tile);
    if (!tile)
        return NULL;
    tile->bins = bins;
    tile->seen_size = PLACES * sizeof *tile->seen;
    tile->seen = meso_large_take(&tile->seen_size);
    if (!tile->seen) {
        free(tile);
        return NULL;
    }
    tile->target = (MesoRasterTarget){&bins->lanes, CELLS, CELLS, tile->nearness, tile->ids,
                                     bins->job.samples > 1 ? tile->farthest : NULL};
    return tile;
}

MesoStatus meso_raster_rows(const MesoRasterBins *bins, uint32_t row_begin, uint32_t row_end, uint32_t thread_count,
                            MesoTakeTile *take, void *context, MesoError *error)
{
    uint32_t pixels = (uint32_t)bins->tile_pixels, first = bins->tiles_x * (row_begin / pixels);
    uint32_t count = bins->tiles_x * ((row_end + pixels - 1) / pixels) - first;
    uint32_t workers = thread_count ? thread_count : meso_parallel_cores();
    workers = workers < count ? workers : count;
    uint32_t *order = meso_raster_bins_order(bins, first, count);
    Drawing d = {order, calloc(workers + 1, sizeof *d.tiles), take, context};
    bool made = d.tiles && order;
    for (uint32_t w = 0; made && w < workers; w++)
        made = (d.tiles[w] = make_tile(bins)) != NULL;
    if (made)
        meso_parallel_team(workers, count, 1, draw_tiles, &d);
    for (uint32_t w = 0; d.tiles && w < workers; w++) {
        made = made && d.tiles[w] && !d.tiles[w]->failed;
        release(d.tiles[w]);
    }
    free(d.tiles);
    free(order);
    return made ? MESO_OK : meso_fail(error, MESO_ERR_MEMORY, "out of memory for drawing");
}
