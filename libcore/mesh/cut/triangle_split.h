/*
 * One triangle, split along segments: a triangulation of points in it that has
 * given segments as edges. Points are weights of its corners on a grid of whole
 * numbers, and what is left or right of what is decided exactly, so that it
 * does not matter whether the triangle has an area in space.
 */
#ifndef MESO_TRIANGLE_SPLIT_H
#define MESO_TRIANGLE_SPLIT_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

/* The weight 1. A float holds such weights exactly. */
#define MESO_SPLIT_ONE (1 << 24)

/* Points stand at least so far apart, by the largest difference of weights: MESO_CUT_SNAP on the grid. */
#define MESO_SPLIT_APART (1 << 16)

enum { MESO_SPLIT_CELLS = 4096 };

typedef struct MesoSplitPoint {
    int32_t x, y;   /* weights of the second and third corner */
    uint32_t out;   /* a half-edge that begins here; on the border, the one along it */
    uint32_t next_in_cell;
    uint32_t vertex;    /* the caller's */
} MesoSplitPoint;

/*
 * Half-edges as in a triangulation. Points 0 to 2 are the corners; behind them come those on the sides, in order from
 * corner 0 around, then those inside.
 */
typedef struct MesoTriangleSplit {
    MesoArena *arena;
    uint32_t point_count, point_room, border_count;
    MesoSplitPoint *points;
    uint32_t half_edge_count, half_edge_room;
    uint32_t *corners, *twins;      /* points; half-edges, or MESO_NO_INDEX along the border */
    uint8_t *lines;                 /* 1: part of a segment; on both half-edges of an edge */
    uint32_t pending_count, pending_room;
    uint32_t (*pending)[2];         /* segments to be drawn yet */
    uint32_t passed_count, passed_room;
    uint32_t *passed;               /* half-edges that a segment crosses */
    uint32_t listed_count;          /* points that are in the lists */
    uint32_t *cells;                /* [MESO_SPLIT_CELLS] first points of lists by place; filled where there are many */
    double metric[3];               /* products of the sides a, b from corner 0: aa, ab, bb */
} MesoTriangleSplit;

/* The whole triangle, with these positions. `split` is zero but for its arena, or of an earlier triangle. */
MesoStatus meso_split_begin(MesoTriangleSplit *split, const MesoVec3 corner[3], MesoError *error);

/* Puts a point on side `side` at `share` of MESO_SPLIT_ONE along it. Sides ascend, and shares along each. */
MesoStatus meso_split_add_on_side(MesoTriangleSplit *split, uint32_t side, int32_t share, MesoError *error);

/* Puts a point inside, behind those on sides, and says which it is: an earlier one inside where that stands near. */
MesoStatus meso_split_add_inside(MesoTriangleSplit *split, int32_t x, int32_t y, uint32_t *point, MesoError *error);

/* Draws the segment between two points; where it crosses others there may be more points inside. */
MesoStatus meso_split_draw(MesoTriangleSplit *split, uint32_t a, uint32_t b, MesoError *error);

/* Turns edges that are no lines until angles are as large as they can be. */
void meso_split_improve(MesoTriangleSplit *split);

/* ---- for the drawing of segments ---- */

/* Twice the area of a, b, c; positive where they turn left. */
static inline int64_t meso_split_turn(const MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t c)
{
    const MesoSplitPoint *p = &split->points[a], *q = &split->points[b], *r = &split->points[c];
    return (int64_t)(q->x - p->x) * (r->y - p->y) - (int64_t)(q->y - p->y) * (r->x - p->x);
}

/* Says of both half-edges of an edge whether it is part of a segment. */
static inline void meso_split_mark(MesoTriangleSplit *split, uint32_t h, uint8_t line)
{
    split->lines[h] = line;
    if (split->twins[h] != MESO_NO_INDEX)
        split->lines[split->twins[h]] = line;
}

/* Turns an edge within its two triangles: p-q becomes s-r, from the apex across to that of h's triangle. */
void meso_split_flip(MesoTriangleSplit *split, uint32_t h);

/* Whether the two triangles at an edge make a strictly convex quadrangle, so that it can be turned. */
bool meso_split_can_flip(const MesoTriangleSplit *split, uint32_t h);

static inline bool meso_split_stands_near(const MesoSplitPoint *p, int32_t x, int32_t y, int32_t apart)
{
    int32_t dx = p->x - x, dy = p->y - y, dz = dx + dy;
    return dx < apart && -dx < apart && dy < apart && -dy < apart && dz < apart && -dz < apart;
}

/* The first point from `first` on that stands nearer to the place than `apart`; MESO_NO_INDEX where none does. */
uint32_t meso_split_find(MesoTriangleSplit *split, uint32_t first, int32_t x, int32_t y, int32_t apart);

/* Puts a point inside, at a place where no point is. */
MesoStatus meso_split_insert(MesoTriangleSplit *split, int32_t x, int32_t y, uint32_t *point, MesoError *error);

#endif
