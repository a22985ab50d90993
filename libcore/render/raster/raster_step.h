/*
 * Sixteen triangles at once: which of them reach a place, and what it takes to fill their cells. All is written so that
 * a compiler makes wide vectors of it: without branches, and of numbers of one size. For raster_draw.c alone.
 */
#ifndef MESO_RASTER_STEP_H
#define MESO_RASTER_STEP_H

#include "libcore/render/raster/raster_fill.h"

enum { STEP = MESO_RASTER_STEP, HALF = MESO_RASTER_UNIT / 2 };
enum { FEW = 16 };              /* pixels whose middles are tried one by one */

#define MESO_RASTER_INLINE __attribute__((always_inline)) static inline

/* ---- one sample a pixel ---- */

typedef struct Middles {
    int32_t first_x[STEP], first_y[STEP], wide[STEP];       /* of the pixels whose middles are in its box */
    int32_t covered[STEP];      /* bits of those in the triangle, row by row, where they are few */
} Middles;

/* An edge of the triangles of a step. */
typedef struct EdgeLanes {
    int32_t inside[STEP];       /* at least 0 where the middle at hand is inside of it, */
    int32_t right[STEP];        /* its change to the next one, */
    int32_t back[STEP];         /* and from the last one of a row to the first of the next */
} EdgeLanes;

/* From the edge's beginning to its end, and from there to the first of so wide rows of middles; `turn` is -1 or 1. */
MESO_RASTER_INLINE void put_edge(EdgeLanes *edge, uint32_t lane, int32_t dx, int32_t dy,
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
MESO_RASTER_INLINE void cover(Middles *step, EdgeLanes edges[3], const int32_t *count)
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
 * Those that look away, have no area, or are around no pixel's middle are left out. Without a branch, so that many are
 * looked at at once. Returns bits of the others.
 */
MESO_RASTER_INLINE uint32_t sift_middles(Middles *step, const MesoRasterQueue *q)
{
    int32_t right = 4 * q->target.cells_x - 1, bottom = 4 * q->target.cells_y - 1, count[STEP], drawn[STEP];
    EdgeLanes edges[3];
    for (uint32_t l = 0; l < STEP; l++) {
        int32_t ax = q->x[0][l], ay = q->y[0][l], bx = q->x[1][l], by = q->y[1][l], cx = q->x[2][l], cy = q->y[2][l];
        int32_t low_x = least(ax, least(bx, cx)), high_x = most(ax, most(bx, cx));
        int32_t low_y = least(ay, least(by, cy)), high_y = most(ay, most(by, cy));
        int32_t first_x = most((low_x + HALF - 1) >> 8, 0), last_x = least((high_x - HALF) >> 8, right);
        int32_t first_y = most((low_y + HALF - 1) >> 8, 0), last_y = least((high_y - HALF) >> 8, bottom);
        uint32_t area = (uint32_t)(bx - ax) * (uint32_t)(cy - ay) - (uint32_t)(by - ay) * (uint32_t)(cx - ax);
        int32_t large = ((high_x - low_x) >> SMALL_BITS | (high_y - low_y) >> SMALL_BITS) != 0;
        int32_t turn = (int32_t)area > 0 ? 1 : -1;
        int32_t seen = large | ((int32_t)area < 0) | (((int32_t)area > 0) & (q->one_sided[l] ^ 1));
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
    uint32_t kept = 0;
    for (int l = 0; l < STEP; l++)
        kept |= (uint32_t)(drawn[l] | (step->covered[l] != 0)) << l;
    return kept;
}

/* ---- several ---- */

/* Triangles whose edges fit in 32 bits, as the cells of their boxes, all included, have them. */
typedef struct Cells {
    int32_t left[STEP], top[STEP], right[STEP], bottom[STEP];
    int32_t along_x[3][STEP], along_y[3][STEP];             /* changes of edges a unit to the right, and down */
    int32_t at_corner[3][STEP];     /* at the corner of the first cell, less 1 where an edge owns no place on it */
    float nearness[STEP], slope_x[STEP], slope_y[STEP];     /* there, and its change a unit */
    float nearest[STEP];            /* at most so near, as rounded, in any of the cells' places in it */
} Cells;

/* Edge e of lane l, from (ax, ay) to (bx, by). */
MESO_RASTER_INLINE void put_cell_edge(Cells *cells, int e, int l, int32_t ax, int32_t ay, int32_t bx, int32_t by,
                                      int32_t corner_x, int32_t corner_y)
{
    uint32_t dx = (uint32_t)bx - (uint32_t)ax, dy = (uint32_t)by - (uint32_t)ay;
    uint32_t owns = (uint32_t)(((int32_t)dy < 0) | ((dy == 0) & ((int32_t)dx > 0)));
    cells->along_x[e][l] = (int32_t)(0u - dy);
    cells->along_y[e][l] = (int32_t)dx;
    cells->at_corner[e][l] = (int32_t)(dx * ((uint32_t)corner_y - (uint32_t)ay) -
                                       dy * ((uint32_t)corner_x - (uint32_t)ax) + owns - 1);
}

/*
 * As set_up(). What is rounded of a nearness at a place is at most 23 times half a unit in the last place of the
 * largest that it is summed from, where no more than `MOST_CELLS` lie on the way.
 */
MESO_RASTER_INLINE void find_planes(Cells *cells, const MesoRasterQueue *q, const int32_t *turned, const int32_t *area,
                                    int32_t cell)
{
    enum { MOST_CELLS = 16 };
    for (uint32_t l = 0; l < STEP; l++) {
        float an = q->nearness[0][l], p = q->nearness[1][l], r = q->nearness[2][l];
        float bn = turned[l] ? r : p, cn = turned[l] ? p : r;
        int32_t bx_ = turned[l] ? q->x[2][l] : q->x[1][l], by_ = turned[l] ? q->y[2][l] : q->y[1][l];
        int32_t cx_ = turned[l] ? q->x[1][l] : q->x[2][l], cy_ = turned[l] ? q->y[1][l] : q->y[2][l];
        double db = (double)bn - (double)an, dc = (double)cn - (double)an;
        double bx = (double)(bx_ - q->x[0][l]), by = (double)(by_ - q->y[0][l]);
        double cx = (double)(cx_ - q->x[0][l]), cy = (double)(cy_ - q->y[0][l]), scale = 1 / (double)area[l];
        double along_x = (db * cy - dc * by) * scale, along_y = (dc * bx - db * cx) * scale;
        double to_x = (double)(cells->left[l] * cell - q->x[0][l]), to_y = (double)(cells->top[l] * cell - q->y[0][l]);
        cells->slope_x[l] = (float)along_x;
        cells->slope_y[l] = (float)along_y;
        cells->nearness[l] = (float)((double)an + along_x * to_x + along_y * to_y);
    }
    for (uint32_t l = 0; l < STEP; l++) {
        float an = q->nearness[0][l], bn = q->nearness[1][l], cn = q->nearness[2][l];
        float nearest = an > bn ? an : bn;
        nearest = nearest > cn ? nearest : cn;
        int32_t wide = cells->right[l] - cells->left[l] + 1, high = cells->bottom[l] - cells->top[l] + 1;
        float largest = __builtin_fabsf(cells->nearness[l]) +
                        __builtin_fabsf(cells->slope_x[l]) * (float)(wide * cell) +
                        __builtin_fabsf(cells->slope_y[l]) * (float)(high * cell);
        float slack = wide + high > MOST_CELLS ? __builtin_inff() : largest * 0x1p-19f;
        cells->nearest[l] = nearest + slack;
    }
}

/* Those that look away, have no area, or lie beside the target are left out. Returns bits of the others, of those too
 * large for this from bit 16 on. */
MESO_RASTER_INLINE uint32_t find_cells(Cells *cells, const MesoRasterQueue *q)
{
    int32_t cell = q->target.lanes->cell, shift = __builtin_ctz((unsigned)cell);
    int32_t last_x = q->target.cells_x - 1, last_y = q->target.cells_y - 1, turned[STEP], areas[STEP];
    uint32_t bits = 0;
    for (int l = 0; l < STEP; l++) {
        int32_t ax = q->x[0][l], ay = q->y[0][l], px = q->x[1][l], py = q->y[1][l], rx = q->x[2][l], ry = q->y[2][l];
        int32_t low_x = least(ax, least(px, rx)), high_x = most(ax, most(px, rx));
        int32_t low_y = least(ay, least(py, ry)), high_y = most(ay, most(py, ry));
        int32_t left = most(low_x >> shift, 0), right = least(high_x >> shift, last_x);
        int32_t top = most(low_y >> shift, 0), bottom = least(high_y >> shift, last_y);
        int32_t area = (int32_t)((uint32_t)(px - ax) * (uint32_t)(ry - ay) - (uint32_t)(py - ay) * (uint32_t)(rx - ax));
        int32_t large = ((high_x - low_x) >> SMALL_BITS | (high_y - low_y) >> SMALL_BITS) != 0;
        int32_t seen = large | (area < 0) | ((area > 0) & (q->one_sided[l] ^ 1));
        int32_t reached = seen & (left <= right) & (top <= bottom);
        int32_t bx = area < 0 ? rx : px, by = area < 0 ? ry : py, cx = area < 0 ? px : rx, cy = area < 0 ? py : ry;
        put_cell_edge(cells, 0, l, ax, ay, bx, by, left << shift, top << shift);
        put_cell_edge(cells, 1, l, bx, by, cx, cy, left << shift, top << shift);
        put_cell_edge(cells, 2, l, cx, cy, ax, ay, left << shift, top << shift);
        cells->left[l] = left;
        cells->right[l] = right;
        cells->top[l] = top;
        cells->bottom[l] = bottom;
        bits |= (uint32_t)reached << (large ? l + 16 : l);
        turned[l] = area < 0;
        areas[l] = area < 0 ? (int32_t)(0u - (uint32_t)area) : area;
    }
    find_planes(cells, q, turned, areas, cell);
    return bits;
}

#endif
