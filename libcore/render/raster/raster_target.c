#include "libcore/render/raster/raster_target.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

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

/* ---- filling cells ---- */

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

enum { STEP = 16 };     /* triangles that are looked at at once */
enum { FEW = 16 };       /* pixels whose middles are tried one by one */

/* What becomes of a triangle: it is left out, drawn, or drawn at those of few middles that are known to be in it. */
enum { LEFT_OUT, DRAWN, AT_MIDDLES };

typedef struct Step {
    int32_t ax[STEP], ay[STEP], bx[STEP], by[STEP], cx[STEP], cy[STEP];
    int32_t first_x[STEP], first_y[STEP], wide[STEP];       /* of the pixels whose middles are in its box */
    int32_t covered[STEP];      /* bits of those in the triangle, row by row */
    uint8_t kept[STEP];
} Step;

/* Up to as many triangles as a step has; the others have no area. */
static inline void gather(Step *step, const MesoRasterVertex *vertices, const uint32_t *corners, uint32_t count)
{
    for (uint32_t l = 0; l < count; l++) {
        const MesoRasterVertex *a = &vertices[corners[3 * l]], *b = &vertices[corners[3 * l + 1]];
        const MesoRasterVertex *c = &vertices[corners[3 * l + 2]];
        step->ax[l] = a->x;
        step->ay[l] = a->y;
        step->bx[l] = b->x;
        step->by[l] = b->y;
        step->cx[l] = c->x;
        step->cy[l] = c->y;
    }
    for (uint32_t l = count; l < STEP; l++)
        step->ax[l] = step->ay[l] = step->bx[l] = step->by[l] = step->cx[l] = step->cy[l] = 0;
}

/* Those that look away or have no area are left out; large ones, whose areas do not fit in 32 bits, are drawn. */
__attribute__((always_inline)) static inline void sift(Step *step, bool one_sided)
{
    for (uint32_t l = 0; l < STEP; l++) {
        int32_t ax = step->ax[l], ay = step->ay[l], bx = step->bx[l], by = step->by[l], cx = step->cx[l];
        int32_t cy = step->cy[l];
        int32_t wide = most(ax, most(bx, cx)) - least(ax, least(bx, cx));
        int32_t high = most(ay, most(by, cy)) - least(ay, least(by, cy));
        uint32_t area = (uint32_t)(bx - ax) * (uint32_t)(cy - ay) - (uint32_t)(by - ay) * (uint32_t)(cx - ax);
        int32_t large = (wide >> 14 | high >> 14) != 0;
        step->kept[l] = (uint8_t)(large | ((int32_t)area < 0) | (((int32_t)area > 0) & !one_sided));
    }
}

/* An edge of the triangles of a step. */
typedef struct EdgeLanes {
    int32_t inside[STEP];       /* at least 0 where the middle at hand is inside of it, */
    int32_t right[STEP];        /* its change to the next one, */
    int32_t back[STEP];         /* and from the last one of a row to the first of the next */
} EdgeLanes;

/* From the edge's beginning to its end, and from there to the first of so wide rows of middles; `turn` is -1 or 1. */
__attribute__((always_inline)) static inline void put_edge(EdgeLanes *edge, uint32_t lane, int32_t dx, int32_t dy,
                                                           int32_t x, int32_t y, int32_t turn, int32_t wide)
{
    dx *= turn;
    dy *= turn;
    uint32_t owns = (uint32_t)((dy < 0) | ((dy == 0) & (dx > 0)));
    uint32_t right = 0u - (uint32_t)dy * MESO_RASTER_UNIT, down = (uint32_t)dx * MESO_RASTER_UNIT;
    edge->inside[lane] = (int32_t)((uint32_t)dx * (uint32_t)y - (uint32_t)dy * (uint32_t)x + owns - 1);
    edge->right[lane] = (int32_t)right;
    edge->back[lane] = (int32_t)(down - (uint32_t)(wide - 1) * right);
}

/* Which of the middles, of which each triangle has `count`, are in it. */
__attribute__((always_inline)) static inline void cover(Step *step, EdgeLanes edges[3], const int32_t *count)
{
    int32_t most_middles = 0, column[STEP];
    for (uint32_t l = 0; l < STEP; l++) {
        most_middles = most(most_middles, count[l]);
        column[l] = step->covered[l] = 0;
    }
    for (int32_t k = 0; k < most_middles; k++)
        for (uint32_t l = 0; l < STEP; l++) {
            int32_t outside = edges[0].inside[l] | edges[1].inside[l] | edges[2].inside[l];
            step->covered[l] |= ((outside >= 0) & (k < count[l])) << k;
            int32_t next = column[l] + 1, last = next == step->wide[l];
            column[l] = last ? 0 : next;
            for (int e = 0; e < 3; e++)     /* of those that are too large, anything */
                edges[e].inside[l] = (int32_t)((uint32_t)edges[e].inside[l] +
                                               (uint32_t)(last ? edges[e].back[l] : edges[e].right[l]));
        }
}

/*
 * The same with one sample a pixel: those around no pixel's middle are left out too. Without a branch, so that many are
 * looked at at once.
 */
__attribute__((always_inline)) static inline void sift_middles(Step *step, const MesoRasterTarget *target,
                                                               bool one_sided)
{
    int32_t right = 4 * target->cells_x - 1, bottom = 4 * target->cells_y - 1, count[STEP], drawn[STEP];
    EdgeLanes edges[3];
    for (uint32_t l = 0; l < STEP; l++) {
        int32_t ax = step->ax[l], ay = step->ay[l], bx = step->bx[l], by = step->by[l], cx = step->cx[l];
        int32_t cy = step->cy[l];
        int32_t low_x = least(ax, least(bx, cx)), high_x = most(ax, most(bx, cx));
        int32_t low_y = least(ay, least(by, cy)), high_y = most(ay, most(by, cy));
        int32_t first_x = most((low_x + HALF - 1) >> 8, 0), last_x = least((high_x - HALF) >> 8, right);
        int32_t first_y = most((low_y + HALF - 1) >> 8, 0), last_y = least((high_y - HALF) >> 8, bottom);
        uint32_t area = (uint32_t)(bx - ax) * (uint32_t)(cy - ay) - (uint32_t)(by - ay) * (uint32_t)(cx - ax);
        int32_t large = ((high_x - low_x) >> 14 | (high_y - low_y) >> 14) != 0, turn = (int32_t)area > 0 ? 1 : -1;
        int32_t seen = large | ((int32_t)area < 0) | (((int32_t)area > 0) & !one_sided);
        int32_t wide = most(last_x - first_x + 1, 0), high = most(last_y - first_y + 1, 0), middles = wide * high;
        int32_t few = (middles <= FEW) & (large ^ 1), kept = seen & (middles > 0);
        int32_t x = first_x * MESO_RASTER_UNIT + HALF, y = first_y * MESO_RASTER_UNIT + HALF;
        put_edge(&edges[0], l, bx - ax, by - ay, x - ax, y - ay, turn, wide);
        put_edge(&edges[1], l, cx - bx, cy - by, x - bx, y - by, turn, wide);
        put_edge(&edges[2], l, ax - cx, ay - cy, x - cx, y - cy, turn, wide);
        step->first_x[l] = first_x;
        step->first_y[l] = first_y;
        step->wide[l] = wide;
        count[l] = kept & few ? middles : 0;
        drawn[l] = kept & (few ^ 1);
    }
    cover(step, edges, count);
    for (uint32_t l = 0; l < STEP; l++)
        step->kept[l] = (uint8_t)(drawn[l] | ((step->covered[l] != 0) << 1));
}

/* ---- drawing those ---- */

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

/* Draws triangle `l` of a step at the middles that it covers. */
__attribute__((always_inline)) static inline void draw_middles(const MesoRasterTarget *target, const Step *step,
                                                               uint32_t l, const MesoRasterVertex *a,
                                                               const MesoRasterVertex *b, const MesoRasterVertex *c,
                                                               uint32_t id)
{
    Outline o = {.a = a, .b = b, .c = c, .area = (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x)};
    float along_x, along_y;
    find_slope(&o, &along_x, &along_y);
    uint32_t wide = (uint32_t)step->wide[l];
    for (uint32_t left = (uint32_t)step->covered[l]; left; left &= left - 1) {
        uint32_t k = (uint32_t)__builtin_ctz(left), row = k / wide;
        int32_t px = step->first_x[l] + (int32_t)(k - row * wide), py = step->first_y[l] + (int32_t)row;
        float x = (float)(px * MESO_RASTER_UNIT + HALF - a->x), y = (float)(py * MESO_RASTER_UNIT + HALF - a->y);
        put(target, px, py, a->nearness + along_x * x + along_y * y, id);
    }
}

/* The first at `l` or after it that was kept, or STEP. */
static inline uint32_t next_kept(const Step *step, uint32_t l)
{
    while (l < STEP) {
        uint64_t word;
        memcpy(&word, step->kept + (l & 8), sizeof word);
        word >>= 8 * (l & 7);
        if (word)
            return l + (uint32_t)__builtin_ctzll(word) / 8;
        l = (l | 7) + 1;
    }
    return STEP;
}

/* Draws one that was kept. */
__attribute__((always_inline)) static inline void draw_one(const MesoRasterTarget *target, const MesoRasterVertex *a,
                                                           const MesoRasterVertex *b, const MesoRasterVertex *c,
                                                           uint32_t id, bool one_sided)
{
    Outline o = {.a = a, .b = b, .c = c,
                 .low_x = least(a->x, least(b->x, c->x)), .high_x = most(a->x, most(b->x, c->x)),
                 .low_y = least(a->y, least(b->y, c->y)), .high_y = most(a->y, most(b->y, c->y))};
    Triangle t;
    if (!turn(&o, one_sided) || !set_up(&t, target, &o))
        return;
    if (o.high_x - o.low_x < 1 << 14 && o.high_y - o.low_y < 1 << 14)      /* edges fit in 32 bits */
        fill_small(target, &t, id);
    else
        fill_large(target, &t, id);
}

__attribute__((always_inline)) static inline void draw_all(const MesoRasterTarget *target,
                                                           const MesoRasterVertex *vertices, const uint32_t *corners,
                                                           uint32_t triangle_count, uint32_t first_id, bool one_sided)
{
    Step step;
    bool single = target->lanes->samples == 1;
    for (uint32_t begin = 0; begin < triangle_count; begin += STEP) {
        const uint32_t *k = corners + 3 * (size_t)begin;
        gather(&step, vertices, k, triangle_count - begin < STEP ? triangle_count - begin : STEP);
        if (single)
            sift_middles(&step, target, one_sided);
        else
            sift(&step, one_sided);
        for (uint32_t l = 0; (l = next_kept(&step, l)) < STEP; l++) {
            const MesoRasterVertex *a = &vertices[k[3 * l]], *b = &vertices[k[3 * l + 1]], *c = &vertices[k[3 * l + 2]];
            if (step.kept[l] == AT_MIDDLES)
                draw_middles(target, &step, l, a, b, c, first_id + begin + l);
            else
                draw_one(target, a, b, c, first_id + begin + l, one_sided);
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
