/* One triangle of any size on a target: set up and filled by itself. For raster_draw.c alone. */
#ifndef MESO_RASTER_FILL_H
#define MESO_RASTER_FILL_H

#include <stddef.h>

#include "libcore/render/raster/raster_queue.h"

enum { LANES = MESO_RASTER_LANES };

/* Edges of triangles that are less units wide and high fit in 32 bits. */
enum { SMALL_BITS = 14 };

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

static inline int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static inline int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* By a power of two. */
static inline int32_t floor_divide(int32_t a, int32_t b)
{
    return a >> __builtin_ctz((unsigned)b);
}

static inline Edge make_edge(const MesoRasterVertex *a, const MesoRasterVertex *b, int64_t corner_x, int64_t corner_y)
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
static inline bool set_up(Triangle *t, const MesoRasterTarget *target, const Outline *o)
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
    /* One that reaches far beyond the target may be much nearer there: its plane is found in double precision. */
    double db = (double)o->b->nearness - o->a->nearness, dc = (double)o->c->nearness - o->a->nearness;
    double bx = (double)o->b->x - o->a->x, by = (double)o->b->y - o->a->y, scale = 1 / (double)o->area;
    double cx = (double)o->c->x - o->a->x, cy = (double)o->c->y - o->a->y;
    double along_x = (db * cy - dc * by) * scale, along_y = (dc * bx - db * cx) * scale;
    t->along_x = (float)along_x;
    t->along_y = (float)along_y;
    double to_x = (double)(corner_x - o->a->x), to_y = (double)(corner_y - o->a->y);
    t->nearness = (float)(o->a->nearness + along_x * to_x + along_y * to_y);
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

/* Draws one. */
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
    if (o.high_x - o.low_x < 1 << SMALL_BITS && o.high_y - o.low_y < 1 << SMALL_BITS)      /* edges fit in 32 bits */
        fill_small(target, &t, id);
    else
        fill_large(target, &t, id);
}

#endif
