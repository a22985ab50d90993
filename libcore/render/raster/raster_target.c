#include "libcore/render/raster/raster_target.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

enum { LANES = MESO_RASTER_LANES, HALF = MESO_RASTER_UNIT / 2 };

/* ---- places ---- */

/* A pixel's middle first; then places no two of which share a row or a column of sixteenths. */
static const int8_t SIXTEEN[LANES][2] = {{0, 0}, {-1, -3}, {-3, 2}, {4, -1}, {-5, -2}, {2, 5}, {5, 3}, {3, -5},
                                         {-2, 6}, {1, -7}, {-4, -6}, {-6, 4}, {-8, 1}, {7, -4}, {6, 7}, {-7, -8}};
static const int8_t FOUR[4][2] = {{0, 0}, {5, -5}, {-6, 3}, {1, 7}};

MesoRasterLanes meso_raster_lanes(uint32_t samples)
{
    MesoRasterLanes lanes = {.pixels = samples == 1 ? 4 : samples == 4 ? 2 : 1, .samples = samples};
    lanes.cell = (int32_t)lanes.pixels * MESO_RASTER_UNIT;
    for (uint32_t l = 0; l < LANES; l++) {
        uint32_t pixel = l / samples, sample = l % samples;
        const int8_t *at = samples == 16 ? SIXTEEN[sample] : FOUR[sample];
        lanes.x[l] = (int32_t)(pixel % lanes.pixels) * MESO_RASTER_UNIT + HALF + at[0] * (MESO_RASTER_UNIT / 16);
        lanes.y[l] = (int32_t)(pixel / lanes.pixels) * MESO_RASTER_UNIT + HALF + at[1] * (MESO_RASTER_UNIT / 16);
    }
    return lanes;
}

void meso_raster_clear(const MesoRasterTarget *target, float nothing)
{
    size_t count = (size_t)LANES * (size_t)target->cells_x * (size_t)target->cells_y;
    for (size_t i = 0; i < count; i++)
        target->nearness[i] = nothing;
    for (size_t i = 0; target->ids && i < count; i++)
        target->ids[i] = 0;
}

/* ---- triangles ---- */

/* An edge from a to b: (bx - ax)(y - ay) - (by - ay)(x - ax), at least 0 inside. */
typedef struct Edge {
    int64_t along_x, along_y;   /* its change a unit to the right, and down */
    int64_t at_corner;          /* its value at the corner of the first cell, less 1 where it owns no place on it */
} Edge;

typedef struct Triangle {
    Edge edges[3];
    int32_t left, top, right, bottom;   /* cells, all included */
    float nearness, along_x, along_y;   /* at the corner of the first cell, and its change a unit */
} Triangle;

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* By a power of two. */
static int32_t floor_divide(int32_t a, int32_t b)
{
    return a >> __builtin_ctz((unsigned)b);
}

static Edge make_edge(const MesoRasterVertex *a, const MesoRasterVertex *b, int64_t corner_x, int64_t corner_y)
{
    int64_t dx = (int64_t)b->x - a->x, dy = (int64_t)b->y - a->y;
    bool owns = dy < 0 || (dy == 0 && dx > 0);      /* one of two neighbours, whose edges run against each other */
    return (Edge){-dy, dx, dx * (corner_y - a->y) - dy * (corner_x - a->x) - !owns};
}

/* Vertices of a triangle, counter-clockwise where y runs up, and the box around it. */
typedef struct Outline {
    const MesoRasterVertex *a, *b, *c;
    int64_t area;               /* twice, above 0 */
    int32_t low_x, high_x, low_y, high_y;
} Outline;

/* False for one without area, or that is left out. */
static inline bool turn(Outline *o, bool one_sided)
{
    const MesoRasterVertex *a = o->a, *b = o->b, *c = o->c;
    o->area = ((int64_t)b->x - a->x) * ((int64_t)c->y - a->y) - ((int64_t)b->y - a->y) * ((int64_t)c->x - a->x);
    if (o->area == 0 || (one_sided && o->area > 0))
        return false;
    if (o->area < 0) {
        o->b = c;
        o->c = b;
        o->area = -o->area;
    }
    return true;
}

/* The change of nearness a unit to the right, and down. */
static inline void find_slope(const Outline *o, float *along_x, float *along_y)
{
    float db = o->b->nearness - o->a->nearness, dc = o->c->nearness - o->a->nearness, scale = 1 / (float)o->area;
    float bx = (float)(o->b->x - o->a->x), by = (float)(o->b->y - o->a->y);
    float cx = (float)(o->c->x - o->a->x), cy = (float)(o->c->y - o->a->y);
    *along_x = (db * cy - dc * by) * scale;
    *along_y = (dc * bx - db * cx) * scale;
}

/* False for one beside the target. */
static bool set_up(Triangle *t, const MesoRasterTarget *target, const Outline *o)
{
    int32_t cell = target->lanes->cell;
    t->left = most(floor_divide(o->low_x, cell), 0);
    t->top = most(floor_divide(o->low_y, cell), 0);
    t->right = least(floor_divide(o->high_x, cell), target->cells_x - 1);
    t->bottom = least(floor_divide(o->high_y, cell), target->cells_y - 1);
    if (t->left > t->right || t->top > t->bottom)
        return false;
    int64_t corner_x = (int64_t)t->left * cell, corner_y = (int64_t)t->top * cell;
    t->edges[0] = make_edge(o->a, o->b, corner_x, corner_y);
    t->edges[1] = make_edge(o->b, o->c, corner_x, corner_y);
    t->edges[2] = make_edge(o->c, o->a, corner_x, corner_y);
    /* A triangle that reaches far beyond the target may be much nearer there: its plane is found in double precision. */
    double db = (double)o->b->nearness - o->a->nearness, dc = (double)o->c->nearness - o->a->nearness;
    double bx = (double)o->b->x - o->a->x, by = (double)o->b->y - o->a->y, scale = 1 / (double)o->area;
    double cx = (double)o->c->x - o->a->x, cy = (double)o->c->y - o->a->y;
    double along_x = (db * cy - dc * by) * scale, along_y = (dc * bx - db * cx) * scale;
    t->along_x = (float)along_x;
    t->along_y = (float)along_y;
    t->nearness = (float)(o->a->nearness + along_x * (double)(corner_x - o->a->x) + along_y * (double)(corner_y - o->a->y));
    return true;
}

/* ---- triangles about as small as a pixel, one sample each ---- */

enum { FEW = 6 };               /* pixels whose middles are tried one by one */

/* -1 in the sign where the place is outside of the edge from a to b. */
static inline int32_t side_of(const MesoRasterVertex *a, const MesoRasterVertex *b, int32_t x, int32_t y)
{
    int32_t dx = b->x - a->x, dy = b->y - a->y;
    return dx * (y - a->y) - dy * (x - a->x) - !(dy < 0 || (dy == 0 && dx > 0));
}

static inline void put(const MesoRasterTarget *target, int32_t px, int32_t py, float nearness, uint32_t id)
{
    size_t place = (size_t)LANES * (size_t)((py >> 2) * target->cells_x + (px >> 2)) +
                   (size_t)((py & 3) * 4 + (px & 3));
    if (!(nearness > target->nearness[place]))
        return;
    target->nearness[place] = nearness;
    if (target->ids)
        target->ids[place] = id;
}

/* Middles from (first_x, first_y) to (last_x, last_y), in pixels. */
static inline void fill_few(const MesoRasterTarget *target, const Outline *o, int32_t first_x, int32_t last_x,
                            int32_t first_y, int32_t last_y, uint32_t id)
{
    float along_x, along_y;
    bool sloped = false;
    for (int32_t py = first_y; py <= last_y; py++)
        for (int32_t px = first_x; px <= last_x; px++) {
            int32_t x = px * MESO_RASTER_UNIT + HALF, y = py * MESO_RASTER_UNIT + HALF;
            if ((side_of(o->a, o->b, x, y) | side_of(o->b, o->c, x, y) | side_of(o->c, o->a, x, y)) < 0)
                continue;
            if (!sloped)
                find_slope(o, &along_x, &along_y);
            sloped = true;
            put(target, px, py, o->a->nearness + along_x * (float)(x - o->a->x) + along_y * (float)(y - o->a->y), id);
        }
}

/* Pixels of the target whose middles lie in the box around the triangle. */
typedef struct Middles {
    int32_t first_x, last_x, first_y, last_y;
} Middles;

static inline Middles middles_of(const MesoRasterTarget *target, int32_t low_x, int32_t high_x, int32_t low_y,
                                 int32_t high_y)
{
    return (Middles){most((low_x + HALF - 1) >> 8, 0), least((high_x - HALF) >> 8, 4 * target->cells_x - 1),
                     most((low_y + HALF - 1) >> 8, 0), least((high_y - HALF) >> 8, 4 * target->cells_y - 1)};
}

static inline bool is_few(const Middles *m, int32_t wide, int32_t high)
{
    return (m->last_x - m->first_x + 1) * (int64_t)(m->last_y - m->first_y + 1) <= FEW && wide < 1 << 14 &&
           high < 1 << 14;
}

/* ---- others ---- */

/* One kernel, whose width the compiler chooses; twice, for whole numbers of 32 and of 64 bits. */
#define FILL(name, whole)                                                                                              \
    __attribute__((always_inline)) static inline void name(const MesoRasterTarget *target, const Triangle *t,          \
                                                           uint32_t id)                                                \
    {                                                                                                                  \
        const MesoRasterLanes *lanes = target->lanes;                                                                  \
        whole offset[3][LANES], row[3];                                                                                \
        float deeper[LANES];                                                                                           \
        for (int e = 0; e < 3; e++) {                                                                                  \
            whole x = (whole)t->edges[e].along_x, y = (whole)t->edges[e].along_y;                                      \
            row[e] = (whole)t->edges[e].at_corner;                                                                     \
            for (int l = 0; l < LANES; l++)                                                                            \
                offset[e][l] = x * lanes->x[l] + y * lanes->y[l];                                                      \
        }                                                                                                              \
        for (int l = 0; l < LANES; l++)                                                                                \
            deeper[l] = t->along_x * (float)lanes->x[l] + t->along_y * (float)lanes->y[l];                             \
        float row_nearness = t->nearness, cell_size = (float)lanes->cell;                                              \
        for (int32_t cy = t->top; cy <= t->bottom; cy++) {                                                             \
            whole e0 = row[0], e1 = row[1], e2 = row[2];                                                               \
            float nearness = row_nearness;                                                                             \
            for (int32_t cx = t->left; cx <= t->right; cx++) {                                                         \
                size_t first = (size_t)LANES * ((size_t)cy * (size_t)target->cells_x + (size_t)cx);                    \
                float *there = target->nearness + first;                                                               \
                uint32_t passed[LANES], any = 0;                                                                       \
                for (int l = 0; l < LANES; l++) {                                                                      \
                    whole outside = (e0 + offset[0][l]) | (e1 + offset[1][l]) | (e2 + offset[2][l]);                   \
                    float mine = nearness + deeper[l];                                                                 \
                    uint32_t pass = (outside >= 0) & (mine > there[l]);                                                \
                    passed[l] = pass;                                                                                  \
                    any |= pass;                                                                                       \
                }                                                                                                      \
                if (any) {                                                                                             \
                    for (int l = 0; l < LANES; l++)                                                                    \
                        there[l] = passed[l] ? nearness + deeper[l] : there[l];                                        \
                    uint32_t *ids = target->ids ? target->ids + first : NULL;                                          \
                    for (int l = 0; ids && l < LANES; l++)                                                             \
                        ids[l] = passed[l] ? id : ids[l];                                                              \
                }                                                                                                      \
                e0 += (whole)t->edges[0].along_x * lanes->cell;                                                        \
                e1 += (whole)t->edges[1].along_x * lanes->cell;                                                        \
                e2 += (whole)t->edges[2].along_x * lanes->cell;                                                        \
                nearness += t->along_x * cell_size;                                                                    \
            }                                                                                                          \
            for (int e = 0; e < 3; e++)                                                                                \
                row[e] += (whole)t->edges[e].along_y * lanes->cell;                                                    \
            row_nearness += t->along_y * cell_size;                                                                    \
        }                                                                                                              \
    }
FILL(fill_small, int32_t)
FILL(fill_large, int64_t)

/* ---- which triangles reach a place ---- */

enum { BLOCK = 64, STEP = 16 };     /* triangles that are looked at together, at most, and at once */

typedef struct Block {
    int32_t ax[BLOCK], ay[BLOCK], bx[BLOCK], by[BLOCK], cx[BLOCK], cy[BLOCK];
    uint8_t kept[BLOCK];
} Block;

/* Fills up the last step with triangles without area, and returns the end of it. */
static inline uint32_t gather(Block *block, const MesoRasterVertex *vertices, const uint32_t *corners, uint32_t count)
{
    uint32_t end = (count + STEP - 1) / STEP * STEP;
    for (uint32_t i = 0; i < count; i++) {
        const MesoRasterVertex *a = &vertices[corners[3 * i]], *b = &vertices[corners[3 * i + 1]];
        const MesoRasterVertex *c = &vertices[corners[3 * i + 2]];
        block->ax[i] = a->x;
        block->ay[i] = a->y;
        block->bx[i] = b->x;
        block->by[i] = b->y;
        block->cx[i] = c->x;
        block->cy[i] = c->y;
    }
    for (uint32_t i = count; i < end; i++)
        block->ax[i] = block->ay[i] = block->bx[i] = block->by[i] = block->cx[i] = block->cy[i] = 0;
    return end;
}

/* What becomes of a triangle: it is left out, drawn, or drawn at the one place that it has. */
enum { LEFT_OUT, DRAWN, ONE_PLACE };

/* At least 0 inside of the edge that runs along (dx, dy), (x, y) from its beginning; anything for a large triangle. */
static inline int32_t inside_of(int32_t dx, int32_t dy, int32_t x, int32_t y)
{
    uint32_t owns = (uint32_t)((dy < 0) | ((dy == 0) & (dx > 0)));
    return (int32_t)((uint32_t)dx * (uint32_t)y - (uint32_t)dy * (uint32_t)x + owns - 1);
}

/*
 * Those that look away or have no area are left out, and, with one sample a pixel, those around no pixel's middle:
 * without a branch, so that many are looked at at once. Large ones, whose areas do not fit in 32 bits, are all drawn.
 */
__attribute__((always_inline)) static inline void sift_step(Block *block, uint32_t begin,
                                                            const MesoRasterTarget *target, bool one_sided)
{
    int32_t wide = 4 * target->cells_x - 1, high = 4 * target->cells_y - 1;
    bool single = target->lanes->samples == 1;
    for (uint32_t i = begin; i < begin + STEP; i++) {
        int32_t ax = block->ax[i], ay = block->ay[i], bx = block->bx[i], by = block->by[i], cx = block->cx[i];
        int32_t cy = block->cy[i];
        int32_t low_x = least(ax, least(bx, cx)), high_x = most(ax, most(bx, cx));
        int32_t low_y = least(ay, least(by, cy)), high_y = most(ay, most(by, cy));
        int32_t first_x = most((low_x + HALF - 1) >> 8, 0), last_x = least((high_x - HALF) >> 8, wide);
        int32_t first_y = most((low_y + HALF - 1) >> 8, 0), last_y = least((high_y - HALF) >> 8, high);
        uint32_t area = (uint32_t)(bx - ax) * (uint32_t)(cy - ay) - (uint32_t)(by - ay) * (uint32_t)(cx - ax);
        int32_t large = ((high_x - low_x) >> 14 | (high_y - low_y) >> 14) != 0, turn = (int32_t)area > 0 ? 1 : -1;
        int32_t seen = large | ((int32_t)area < 0) | (((int32_t)area > 0) & !one_sided);
        int32_t middle = (first_x <= last_x) & (first_y <= last_y);
        int32_t one = (first_x == last_x) & (first_y == last_y) & (large ^ 1);
        int32_t x = first_x * MESO_RASTER_UNIT + HALF, y = first_y * MESO_RASTER_UNIT + HALF;
        int32_t outside = inside_of(turn * (bx - ax), turn * (by - ay), x - ax, y - ay) |
                          inside_of(turn * (cx - bx), turn * (cy - by), x - bx, y - by) |
                          inside_of(turn * (ax - cx), turn * (ay - cy), x - cx, y - cy);
        int32_t drawn = single ? seen & middle & ((one ^ 1) | (outside >= 0)) : seen;
        block->kept[i] = (uint8_t)(single ? drawn << one : drawn);
    }
}

/* Draws a small one that holds the middle of the first pixel in its box, and no other. */
__attribute__((always_inline)) static inline void draw_place(const MesoRasterTarget *target, const MesoRasterVertex *a,
                                                             const MesoRasterVertex *b, const MesoRasterVertex *c,
                                                             uint32_t id)
{
    int32_t px = most((least(a->x, least(b->x, c->x)) + HALF - 1) >> 8, 0);
    int32_t py = most((least(a->y, least(b->y, c->y)) + HALF - 1) >> 8, 0);
    Outline o = {.a = a, .b = b, .c = c, .area = (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x)};
    float along_x, along_y;
    find_slope(&o, &along_x, &along_y);
    float x = (float)(px * MESO_RASTER_UNIT + HALF - a->x), y = (float)(py * MESO_RASTER_UNIT + HALF - a->y);
    put(target, px, py, a->nearness + along_x * x + along_y * y, id);
}

/* Draws one that was kept. */
__attribute__((always_inline)) static inline void draw_one(const MesoRasterTarget *target, const MesoRasterVertex *a,
                                                           const MesoRasterVertex *b, const MesoRasterVertex *c,
                                                           uint32_t id, bool one_sided)
{
    Outline o = {.a = a, .b = b, .c = c,
                 .low_x = least(a->x, least(b->x, c->x)), .high_x = most(a->x, most(b->x, c->x)),
                 .low_y = least(a->y, least(b->y, c->y)), .high_y = most(a->y, most(b->y, c->y))};
    Middles m = middles_of(target, o.low_x, o.high_x, o.low_y, o.high_y);
    Triangle t;
    if (!turn(&o, one_sided))
        return;
    if (target->lanes->samples == 1 && is_few(&m, o.high_x - o.low_x, o.high_y - o.low_y))
        fill_few(target, &o, m.first_x, m.last_x, m.first_y, m.last_y, id);
    else if (!set_up(&t, target, &o))
        return;
    else if (o.high_x - o.low_x < 1 << 14 && o.high_y - o.low_y < 1 << 14)      /* edges fit in 32 bits */
        fill_small(target, &t, id);
    else
        fill_large(target, &t, id);
}

__attribute__((always_inline)) static inline void draw_all(const MesoRasterTarget *target,
                                                           const MesoRasterVertex *vertices, const uint32_t *corners,
                                                           uint32_t triangle_count, uint32_t first_id, bool one_sided)
{
    Block block;
    for (uint32_t begin = 0; begin < triangle_count; begin += BLOCK) {
        uint32_t count = triangle_count - begin < BLOCK ? triangle_count - begin : BLOCK, kept = 0;
        const uint32_t *k = corners + 3 * (size_t)begin;
        uint8_t which[BLOCK];
        uint32_t end = gather(&block, vertices, k, count);
        for (uint32_t step = 0; step < end; step += STEP)
            sift_step(&block, step, target, one_sided);
        for (uint32_t i = 0; i < count; i++) {
            which[kept] = (uint8_t)i;
            kept += block.kept[i] != LEFT_OUT;
        }
        for (uint32_t i = 0; i < kept; i++) {
            const uint32_t *at = k + 3 * (size_t)which[i];
            const MesoRasterVertex *a = &vertices[at[0]], *b = &vertices[at[1]], *c = &vertices[at[2]];
            if (block.kept[which[i]] == ONE_PLACE)
                draw_place(target, a, b, c, first_id + begin + which[i]);
            else
                draw_one(target, a, b, c, first_id + begin + which[i], one_sided);
        }
    }
}

void meso_raster_draw_plain(const MesoRasterTarget *target, const MesoRasterVertex *vertices, const uint32_t *corners,
                            uint32_t triangle_count, uint32_t first_id, bool one_sided)
{
    draw_all(target, vertices, corners, triangle_count, first_id, one_sided);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static void draw_avx2(const MesoRasterTarget *target, const MesoRasterVertex *vertices,
                                                      const uint32_t *corners, uint32_t triangle_count,
                                                      uint32_t first_id, bool one_sided)
{
    draw_all(target, vertices, corners, triangle_count, first_id, one_sided);
}

void meso_raster_draw(const MesoRasterTarget *target, const MesoRasterVertex *vertices, const uint32_t *corners,
                      uint32_t triangle_count, uint32_t first_id, bool one_sided)
{
    if (__builtin_cpu_supports("avx2"))
        draw_avx2(target, vertices, corners, triangle_count, first_id, one_sided);
    else
        draw_all(target, vertices, corners, triangle_count, first_id, one_sided);
}
#else
void meso_raster_draw(const MesoRasterTarget *target, const MesoRasterVertex *vertices, const uint32_t *corners,
                      uint32_t triangle_count, uint32_t first_id, bool one_sided)
{
    draw_all(target, vertices, corners, triangle_count, first_id, one_sided);
}
#endif
