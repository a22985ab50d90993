#include "libcore/render/raster/raster_tiles.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"

enum { LANES = MESO_RASTER_LANES, CELLS = MESO_TILE_CELLS, PLACES = LANES * CELLS * CELLS };

/* ---- shapes by tiles ---- */

/* Tiles that a shape may reach; none where left is over right. */
typedef struct TileRange {
    uint16_t left, top, right, bottom;
} TileRange;

struct MesoRasterBins {
    MesoRasterJob job;
    MesoRasterLanes lanes;
    float tile_pixels;
    uint32_t tiles_x, tiles_y;
    TileRange *ranges;          /* [shapes] */
    uint64_t *begin;            /* [tiles + 1] */
    uint32_t *shapes;           /* by tile, ascending */
};

static uint16_t tile_at(float pixel, float tile_pixels, uint32_t tiles)
{
    float tile = floorf(pixel / tile_pixels);
    return tile > 0 ? tile < (float)(tiles - 1) ? (uint16_t)tile : (uint16_t)(tiles - 1) : 0;
}

static void find_ranges(void *context, uint64_t begin, uint64_t end)
{
    MesoRasterBins *bins = context;
    float width = (float)bins->job.width, height = (float)bins->job.height;
    for (uint64_t i = begin; i < end; i++) {
        MesoRasterRect r = meso_raster_rect(&bins->job.view, &bins->job.shapes->bounds[i]);
        bins->ranges[i] = (TileRange){1, 0, 0, 0};
        if (!(r.right > 0 && r.bottom > 0 && r.left < width && r.top < height) ||
            (bins->job.samples == 1 && !meso_raster_rect_has_middle(&r)))
            continue;
        bins->ranges[i] = (TileRange){tile_at(r.left, bins->tile_pixels, bins->tiles_x),
                                      tile_at(r.top, bins->tile_pixels, bins->tiles_y),
                                      tile_at(r.right, bins->tile_pixels, bins->tiles_x),
                                      tile_at(r.bottom, bins->tile_pixels, bins->tiles_y)};
    }
}

static MesoStatus sort_shapes(MesoRasterBins *bins, MesoArena *arena, MesoError *error)
{
    uint32_t count = bins->job.shapes->count;
    uint64_t tiles = (uint64_t)bins->tiles_x * bins->tiles_y;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t y = bins->ranges[i].top; y <= bins->ranges[i].bottom; y++)
            for (uint32_t x = bins->ranges[i].left; x <= bins->ranges[i].right; x++)
                bins->begin[y * bins->tiles_x + x + 1]++;
    for (uint64_t t = 0; t < tiles; t++)
        bins->begin[t + 1] += bins->begin[t];
    bins->shapes = MESO_NEW(arena, uint32_t, bins->begin[tiles], error);
    uint64_t *next = MESO_NEW(arena, uint64_t, tiles, error);
    if (!bins->shapes || !next)
        return MESO_ERR_MEMORY;
    memcpy(next, bins->begin, tiles * sizeof *next);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t y = bins->ranges[i].top; y <= bins->ranges[i].bottom; y++)
            for (uint32_t x = bins->ranges[i].left; x <= bins->ranges[i].right; x++)
                bins->shapes[next[y * bins->tiles_x + x]++] = i;
    return MESO_OK;
}

MesoStatus meso_raster_bins_init(MesoRasterBins **out, MesoArena *arena, const MesoRasterJob *job,
                                 uint32_t thread_count, MesoError *error)
{
    MesoRasterBins *bins = *out = MESO_NEW(arena, MesoRasterBins, 1, error);
    if (!bins)
        return MESO_ERR_MEMORY;
    *bins = (MesoRasterBins){.job = *job, .lanes = meso_raster_lanes(job->samples)};
    uint32_t pixels = CELLS * bins->lanes.pixels;
    bins->tile_pixels = (float)pixels;
    bins->tiles_x = (job->width + pixels - 1) / pixels;
    bins->tiles_y = (job->height + pixels - 1) / pixels;
    bins->ranges = MESO_NEW(arena, TileRange, job->shapes->count, error);
    bins->begin = MESO_NEW(arena, uint64_t, (uint64_t)bins->tiles_x * bins->tiles_y + 1, error);
    if (!bins->ranges || !bins->begin)
        return MESO_ERR_MEMORY;
    meso_parallel_for(thread_count, job->shapes->count, 4096, find_ranges, bins);
    return sort_shapes(bins, arena, error);
}

uint32_t meso_raster_tile_rows(uint32_t samples)
{
    return CELLS * meso_raster_lanes(samples).pixels;
}

/* ---- a tile ---- */

/* A shape of the tile whose triangles have been seen. */
typedef struct SeenShape {
    uint64_t vertex_begin;      /* of the tile's vertices, + 1; 0: not made yet */
    uint64_t corner_begin;
    bool colored;
} SeenShape;

struct MesoRasterTile {
    const MesoRasterBins *bins;
    MesoRasterTarget target;
    MesoWindow window;
    const uint32_t *shapes;     /* [shape_count] of the tile */
    uint32_t shape_count;
    uint32_t *first_ids;        /* [shape_count + 1] */
    SeenShape *seen;            /* [shape_count] */
    uint32_t shape_room;
    uint8_t *seen_triangles;    /* [first_ids[shape_count]] 1: some place shows the triangle of that id */
    uint64_t triangle_room;
    MesoShapeMesh mesh;
    MesoVec3 *from_eye;
    MesoRasterVertex *projected;
    uint32_t vertex_room;
    MesoMeshVertex *vertices;   /* of the shapes that have been seen */
    MesoMeshColor *colors;
    uint32_t *corners;
    uint64_t vertices_used, vertices_room, corners_used, corners_room;
    uint32_t last;              /* shape that was asked for last, in `shapes` */
    bool failed, drawn;
    float nearness[PLACES];
    uint32_t ids[PLACES];
};

static bool grow(void **array, uint64_t count, size_t size)
{
    void *grown = count <= SIZE_MAX / size ? realloc(*array, count * size) : NULL;
    if (grown)
        *array = grown;
    return grown != NULL;
}

static bool make_room(MesoRasterTile *tile)
{
    if (tile->shape_count + 1 > tile->shape_room) {
        uint32_t room = 2 * tile->shape_count + 16;
        if (!grow((void **)&tile->first_ids, room, sizeof *tile->first_ids) ||
            !grow((void **)&tile->seen, room, sizeof *tile->seen))
            return false;
        tile->shape_room = room;
    }
    memset(tile->seen, 0, (tile->shape_count + 1) * sizeof *tile->seen);
    return true;
}

float meso_raster_tolerance(const MesoRasterJob *job, uint32_t shape)
{
    MesoRasterRect rect = meso_raster_rect(&job->view, &job->shapes->bounds[shape]);
    return job->tolerance * meso_raster_pixel(&job->view, rect.depth);
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
    MesoRasterVertex vertices[4];
    uint32_t count = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 a = tile->from_eye[corners[k]], b = tile->from_eye[corners[(k + 1) % 3]];
        bool a_before = a.z >= view->near_depth, b_before = b.z >= view->near_depth;
        if (a_before)
            vertices[count++] = meso_raster_vertex(view, a, (float)tile->window.x, (float)tile->window.y);
        if (a_before != b_before)
            vertices[count++] = meso_raster_vertex(view, cut(a, b, view->near_depth), (float)tile->window.x,
                                                   (float)tile->window.y);
    }
    for (uint32_t i = 0; i + 2 < count; i++)
        meso_raster_draw(&tile->target, vertices, fans + 3 * i, 1, id, false);
}

/* Projects the mesh; false where some of it lies behind the near plane. */
static bool project(MesoRasterTile *tile)
{
    const MesoRasterView *view = &tile->bins->job.view;
    float left = (float)tile->window.x, top = (float)tile->window.y;
    bool before = true;
    for (uint32_t v = 0; v < tile->mesh.vertex_count; v++) {
        MesoVec3 q = meso_raster_from_eye(view, tile->mesh.vertices[v].position);
        tile->from_eye[v] = q;
        if (q.z >= view->near_depth)
            tile->projected[v] = meso_raster_vertex(view, q, left, top);
        else
            before = false;
    }
    return before;
}

static void draw_mesh(MesoRasterTile *tile, uint32_t first_id)
{
    const MesoShapeMesh *mesh = &tile->mesh;
    float near_depth = tile->bins->job.view.near_depth;
    if (project(tile)) {
        meso_raster_draw(&tile->target, tile->projected, mesh->corners, mesh->triangle_count, first_id, false);
        return;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = mesh->corners + 3 * (size_t)t;
        bool whole = true;
        for (uint32_t k = 0; k < 3; k++)
            whole = whole && tile->from_eye[c[k]].z >= near_depth;
        if (whole)
            meso_raster_draw(&tile->target, tile->projected, c, 1, first_id + t, false);
        else
            draw_cut(tile, c, first_id + t);
    }
}

static bool draw_shape(MesoRasterTile *tile, uint32_t shape, uint32_t first_id)
{
    const MesoRasterJob *job = &tile->bins->job;
    if (!meso_shape_make(job->shapes, shape, meso_raster_tolerance(job, shape), MESO_SHAPE_SEEN, &tile->mesh))
        return false;
    if (tile->mesh.vertex_count > tile->vertex_room) {
        uint64_t room = 2 * (uint64_t)tile->mesh.vertex_count;
        if (!grow((void **)&tile->from_eye, room, sizeof *tile->from_eye) ||
            !grow((void **)&tile->projected, room, sizeof *tile->projected))
            return false;
        tile->vertex_room = (uint32_t)room;
    }
    draw_mesh(tile, first_id);
    return true;
}

/* False where memory is out. */
static bool find_seen(MesoRasterTile *tile, uint32_t ids)
{
    if (ids > tile->triangle_room) {
        if (!grow((void **)&tile->seen_triangles, 2 * (uint64_t)ids, sizeof *tile->seen_triangles))
            return false;
        tile->triangle_room = 2 * (uint64_t)ids;
    }
    memset(tile->seen_triangles, 0, ids);
    for (uint32_t i = 0; i < PLACES; i++)
        tile->seen_triangles[tile->ids[i]] = 1;
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
    tile->shapes = bins->shapes + bins->begin[number];
    tile->shape_count = (uint32_t)(bins->begin[number + 1] - bins->begin[number]);
    tile->vertices_used = tile->corners_used = 0;
    tile->last = 0;
    tile->drawn = tile->shape_count > 0;
    if (!tile->drawn)
        return true;
    if (!make_room(tile))
        return false;
    meso_raster_clear(&tile->target, bins->job.view.parallel ? -INFINITY : 0);
    uint64_t id = 1;
    for (uint32_t i = 0; i < tile->shape_count; i++) {
        tile->first_ids[i] = (uint32_t)id;
        if (!draw_shape(tile, tile->shapes[i], (uint32_t)id))
            return false;
        id += tile->mesh.triangle_count;
        if (id > UINT32_MAX)
            return false;
    }
    tile->first_ids[tile->shape_count] = (uint32_t)id;
    return find_seen(tile, (uint32_t)id);
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

static uint32_t find_shape(MesoRasterTile *tile, uint32_t id)
{
    if (id >= tile->first_ids[tile->last] && id < tile->first_ids[tile->last + 1])
        return tile->last;
    uint32_t low = 0, high = tile->shape_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (tile->first_ids[middle] <= id)
            low = middle;
        else
            high = middle;
    }
    return tile->last = low;
}

/* Makes the shape again, and keeps it while the tile lasts. */
static bool keep_shape(MesoRasterTile *tile, uint32_t i)
{
    const MesoRasterJob *job = &tile->bins->job;
    MesoShapeMesh *mesh = &tile->mesh;
    SeenShape *seen = &tile->seen[i];
    float tolerance = meso_raster_tolerance(job, tile->shapes[i]);
    if (!meso_shape_make_seen(job->shapes, tile->shapes[i], tolerance, tile->seen_triangles + tile->first_ids[i], mesh))
        return false;
    uint64_t vertices = tile->vertices_used + mesh->vertex_count;
    uint64_t corners = tile->corners_used + 3 * (uint64_t)mesh->triangle_count;
    if (vertices > tile->vertices_room) {
        if (!grow((void **)&tile->vertices, 2 * vertices, sizeof *tile->vertices) ||
            !grow((void **)&tile->colors, 2 * vertices, sizeof *tile->colors))
            return false;
        tile->vertices_room = 2 * vertices;
    }
    if (corners > tile->corners_room) {
        if (!grow((void **)&tile->corners, 2 * corners, sizeof *tile->corners))
            return false;
        tile->corners_room = 2 * corners;
    }
    memcpy(tile->vertices + tile->vertices_used, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices);
    if (mesh->colors)
        memcpy(tile->colors + tile->vertices_used, mesh->colors, mesh->vertex_count * sizeof *mesh->colors);
    memcpy(tile->corners + tile->corners_used, mesh->corners, 3 * (size_t)mesh->triangle_count * sizeof *mesh->corners);
    *seen = (SeenShape){tile->vertices_used + 1, tile->corners_used, mesh->colors != NULL};
    tile->vertices_used = vertices;
    tile->corners_used = corners;
    return true;
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

static void look_at(const MesoRasterTile *tile, uint32_t i, float x, float y, MesoSurfaceSample *out)
{
    const SeenShape *seen = &tile->seen[i];
    const MesoRasterView *view = &tile->bins->job.view;
    const uint32_t *c = tile->corners + seen->corner_begin + 3 * (uint64_t)out->triangle;
    uint64_t begin = seen->vertex_begin - 1, at[3] = {begin + c[0], begin + c[1], begin + c[2]};
    const MesoMeshVertex *v[3] = {&tile->vertices[at[0]], &tile->vertices[at[1]], &tile->vertices[at[2]]};
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
        const MesoMeshColor *color = &tile->colors[at[k]];
        out->color[0] += shares[k] * (float)color->r / 255;
        out->color[1] += shares[k] * (float)color->g / 255;
        out->color[2] += shares[k] * (float)color->b / 255;
    }
}

bool meso_raster_tile_sample(MesoRasterTile *tile, uint32_t x, uint32_t y, uint32_t sample, MesoSurfaceSample *out)
{
    const MesoRasterLanes *lanes = &tile->bins->lanes;
    uint32_t cx = x / lanes->pixels, cy = y / lanes->pixels;
    uint32_t lane = ((y % lanes->pixels) * lanes->pixels + x % lanes->pixels) * lanes->samples + sample;
    uint32_t id = tile->drawn ? tile->ids[(size_t)LANES * (cy * CELLS + cx) + lane] : 0;
    if (id == 0)
        return false;
    uint32_t i = find_shape(tile, id);
    if (tile->seen[i].vertex_begin == 0 && !keep_shape(tile, i)) {
        tile->failed = true;
        return false;
    }
    out->shape = tile->shapes[i];
    out->triangle = id - tile->first_ids[i];
    const float unit = 1.f / MESO_RASTER_UNIT, cell = (float)lanes->pixels;
    look_at(tile, i, (float)tile->window.x + (float)cx * cell + (float)lanes->x[lane] * unit,
            (float)tile->window.y + (float)cy * cell + (float)lanes->y[lane] * unit, out);
    return true;
}

/* ---- all of them ---- */

typedef struct Drawing {
    uint64_t first;             /* tile */
    MesoRasterTile **tiles;     /* one a worker */
    MesoTakeTile *take;
    void *context;
} Drawing;

static void draw_tiles(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    const Drawing *d = context;
    MesoRasterTile *tile = d->tiles[worker];
    for (uint64_t number = begin; number < end && !tile->failed; number++) {
        if (draw_tile(tile, d->first + number))
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
    free(tile->first_ids);
    free(tile->seen);
    free(tile->seen_triangles);
    free(tile->from_eye);
    free(tile->projected);
    free(tile->vertices);
    free(tile->colors);
    free(tile->corners);
    free(tile);
}

static MesoRasterTile *make_tile(const MesoRasterBins *bins)
{
    MesoRasterTile *tile = calloc(1, sizeof *tile);
    if (tile) {
        tile->bins = bins;
        tile->target = (MesoRasterTarget){&bins->lanes, CELLS, CELLS, tile->nearness, tile->ids};
    }
    return tile;
}

MesoStatus meso_raster_rows(const MesoRasterBins *bins, uint32_t row_begin, uint32_t row_end, uint32_t thread_count,
                            MesoTakeTile *take, void *context, MesoError *error)
{
    uint32_t pixels = (uint32_t)bins->tile_pixels;
    uint64_t first = (uint64_t)bins->tiles_x * (row_begin / pixels);
    uint64_t count = (uint64_t)bins->tiles_x * ((row_end + pixels - 1) / pixels) - first;
    uint32_t workers = thread_count ? thread_count : meso_parallel_cores();
    workers = workers < count ? workers : (uint32_t)count;
    Drawing d = {first, calloc(workers + 1, sizeof *d.tiles), take, context};
    bool made = d.tiles != NULL;
    for (uint32_t w = 0; made && w < workers; w++)
        made = (d.tiles[w] = make_tile(bins)) != NULL;
    if (made)
        meso_parallel_team(workers, count, 1, draw_tiles, &d);
    for (uint32_t w = 0; d.tiles && w < workers; w++) {
        made = made && d.tiles[w] && !d.tiles[w]->failed;
        release(d.tiles[w]);
    }
    free(d.tiles);
    return made ? MESO_OK : meso_fail(error, MESO_ERR_MEMORY, "out of memory for drawing");
}
