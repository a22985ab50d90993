#include "libcore/mesh/cut/triangle_split.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/cut/triangulation.h"

/* ---- edges ---- */

/* Writes half-edge `slot`, and ties it to the one across. */
static void set_edge(MesoTriangleSplit *split, uint32_t slot, uint32_t begin, uint32_t twin, uint8_t line)
{
    split->corners[slot] = begin;
    split->twins[slot] = twin;
    split->lines[slot] = line;
    if (twin != MESO_NO_INDEX)
        split->twins[twin] = slot;
    if (twin == MESO_NO_INDEX || begin >= split->border_count)
        split->points[begin].out = slot;
}

void meso_split_flip(MesoTriangleSplit *split, uint32_t h)
{
    const uint32_t *twins = split->twins;
    const uint8_t *lines = split->lines;
    uint32_t g = twins[h];
    uint32_t hn = meso_next_corner(h), hp = meso_previous_corner(h);
    uint32_t gn = meso_next_corner(g), gp = meso_previous_corner(g);
    uint32_t p = split->corners[h], q = split->corners[g], r = split->corners[hp], s = split->corners[gp];
    uint32_t across[4] = {twins[hn], twins[hp], twins[gn], twins[gp]};
    uint8_t line[4] = {lines[hn], lines[hp], lines[gn], lines[gp]};
    set_edge(split, hn, r, across[1], line[1]);
    set_edge(split, hp, p, across[2], line[2]);
    set_edge(split, gn, s, across[3], line[3]);
    set_edge(split, gp, q, across[0], line[0]);
    split->corners[h] = s;
    split->corners[g] = r;
}

bool meso_split_can_flip(const MesoTriangleSplit *split, uint32_t h)
{
    uint32_t g = split->twins[h];
    uint32_t p = split->corners[h], q = split->corners[g];
    uint32_t r = split->corners[meso_previous_corner(h)], s = split->corners[meso_previous_corner(g)];
    return meso_split_turn(split, r, p, s) > 0 && meso_split_turn(split, s, q, r) > 0;
}

/* ---- room ---- */

static MesoStatus reserve_points(MesoTriangleSplit *split, MesoError *error)
{
    split->points = MESO_GROW(split->arena, split->points, split->point_count, split->point_room, 64, error);
    return split->points ? MESO_OK : MESO_ERR_MEMORY;
}

/* For two triangles more. */
static MesoStatus reserve_triangles(MesoTriangleSplit *split, MesoError *error)
{
    uint32_t count = split->half_edge_count, room = split->half_edge_room ? 2 * split->half_edge_room : 192;
    if (count + 6 <= split->half_edge_room)
        return MESO_OK;
    uint32_t *corners = meso_arena_enlarge(split->arena, split->corners, count, room, sizeof *corners, error);
    uint32_t *twins = meso_arena_enlarge(split->arena, split->twins, count, room, sizeof *twins, error);
    uint8_t *lines = meso_arena_enlarge(split->arena, split->lines, count, room, sizeof *lines, error);
    if (!corners || !twins || !lines)
        return MESO_ERR_MEMORY;
    split->corners = corners;
    split->twins = twins;
    split->lines = lines;
    split->half_edge_room = room;
    return MESO_OK;
}

/* ---- the whole triangle ---- */

static void measure(double metric[3], const MesoVec3 corner[3])
{
    double a[3] = {(double)corner[1].x - corner[0].x, (double)corner[1].y - corner[0].y,
                   (double)corner[1].z - corner[0].z};
    double b[3] = {(double)corner[2].x - corner[0].x, (double)corner[2].y - corner[0].y,
                   (double)corner[2].z - corner[0].z};
    metric[0] = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    metric[1] = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    metric[2] = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
}

MesoStatus meso_split_begin(MesoTriangleSplit *split, const MesoVec3 corner[3], MesoError *error)
{
    split->point_count = split->half_edge_count = split->pending_count = split->listed_count = 0;
    if (!split->cells)
        split->cells = MESO_NEW(split->arena, uint32_t, MESO_SPLIT_CELLS, error);
    if (!split->cells || reserve_points(split, error) || reserve_triangles(split, error))
        return MESO_ERR_MEMORY;
    split->points[0] = (MesoSplitPoint){.out = 0};
    split->points[1] = (MesoSplitPoint){.x = MESO_SPLIT_ONE, .out = 1};
    split->points[2] = (MesoSplitPoint){.y = MESO_SPLIT_ONE, .out = 2};
    split->point_count = split->border_count = 3;
    for (uint32_t k = 0; k < 3; k++)
        set_edge(split, k, k, MESO_NO_INDEX, 0);
    split->half_edge_count = 3;
    measure(split->metric, corner);
    return MESO_OK;
}

MesoStatus meso_split_add_on_side(MesoTriangleSplit *split, uint32_t side, int32_t share, MesoError *error)
{
    assert(side < 3 && share > 0 && share < MESO_SPLIT_ONE);
    if (reserve_points(split, error) || reserve_triangles(split, error))
        return MESO_ERR_MEMORY;
    /* what is left of the side begins at the newest point, or where there is none at its first corner */
    uint32_t h = split->points[split->point_count - 1].out;
    if (split->corners[meso_next_corner(h)] != (side + 1) % 3)
        h = split->points[side].out;
    assert(split->corners[meso_next_corner(h)] == (side + 1) % 3);

    int32_t left = MESO_SPLIT_ONE - share;
    uint32_t n = split->point_count++, b = split->half_edge_count;
    split->border_count = split->point_count;
    split->half_edge_count += 3;
    split->points[n] = (MesoSplitPoint){
        .x = side == 0 ? share : side == 1 ? left : 0, .y = side == 0 ? 0 : side == 1 ? share : left, .out = b};
    uint32_t hn = meso_next_corner(h), c = split->corners[hn], x = split->corners[meso_next_corner(hn)];
    set_edge(split, b + 1, c, split->twins[hn], split->lines[hn]);
    set_edge(split, b, n, MESO_NO_INDEX, 0);
    set_edge(split, b + 2, x, hn, 0);
    split->corners[hn] = n;
    split->twins[hn] = b + 2;
    split->lines[hn] = 0;
    return MESO_OK;
}

/* ---- angles ---- */

/* The product of c-a and c-b in space, times a square of the grid's. */
static double product(const MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t c)
{
    const MesoSplitPoint *p = split->points;
    double ax = p[a].x - p[c].x, ay = p[a].y - p[c].y, bx = p[b].x - p[c].x, by = p[b].y - p[c].y;
    return split->metric[0] * (ax * bx) + split->metric[1] * (ax * by + ay * bx) + split->metric[2] * (ay * by);
}

/*
 * Whether turning the edge makes the smallest of the six angles larger: where the two that face it are more than half
 * a turn together, by the sum of their cotangents. All areas have the same factor in space, so that areas on the grid
 * will do, and flat triangles have an answer too.
 */
static bool should_flip(const MesoTriangleSplit *split, uint32_t h)
{
    uint32_t g = split->twins[h];
    if (g == MESO_NO_INDEX || split->lines[h] || !meso_split_can_flip(split, h))
        return false;
    uint32_t p = split->corners[h], q = split->corners[g];
    uint32_t r = split->corners[meso_previous_corner(h)], s = split->corners[meso_previous_corner(g)];
    double at_r = product(split, p, q, r) * (double)meso_split_turn(split, s, q, p);
    double at_s = product(split, p, q, s) * (double)meso_split_turn(split, r, p, q);
    /* rounding must not turn an edge to and fro */
    return at_r + at_s < -1e-9 * (fabs(at_r) + fabs(at_s));
}

void meso_split_improve(MesoTriangleSplit *split)
{
    enum { ROUNDS = 64 };   /* one or two are the rule */
    bool again = true;
    for (int round = 0; again && round < ROUNDS; round++) {
        again = false;
        for (uint32_t h = 0; h < split->half_edge_count; h++)
            if (split->twins[h] > h && should_flip(split, h)) {
                meso_split_flip(split, h);
                again = true;
            }
    }
}

/* The same for the triangles around a new point inside; `triangle_count` of them, one with half-edge `out` from it. */
static void improve_around(MesoTriangleSplit *split, uint32_t out, uint32_t triangle_count)
{
    while (triangle_count > 0) {
        uint32_t facing = meso_next_corner(out);
        if (should_flip(split, facing)) {
            meso_split_flip(split, facing);     /* the point is the apex, of h's triangle: one for two */
            out = meso_next_corner(facing);
            triangle_count++;
        } else {
            out = split->twins[meso_previous_corner(out)];
            triangle_count--;
        }
    }
}

/* ---- points inside ---- */

static int64_t turn_to(const MesoTriangleSplit *split, uint32_t h, int32_t x, int32_t y)
{
    const MesoSplitPoint *p = &split->points[split->corners[h]];
    const MesoSplitPoint *q = &split->points[split->corners[meso_next_corner(h)]];
    return (int64_t)(q->x - p->x) * (y - p->y) - (int64_t)(q->y - p->y) * (x - p->x);
}

/* The first side of the triangle of h that the place is beyond; MESO_NO_INDEX where it is inside or on the rim. */
static uint32_t side_towards(const MesoTriangleSplit *split, uint32_t h, int32_t x, int32_t y)
{
    for (uint32_t k = 0; k < 3; k++, h = meso_next_corner(h))
        if (turn_to(split, h, x, y) < 0)
            return h;
    return MESO_NO_INDEX;
}

/* A triangle that has the place. A walk from the newest; it may run in circles where angles are bad. */
static uint32_t locate(const MesoTriangleSplit *split, int32_t x, int32_t y)
{
    uint32_t h = split->half_edge_count - 3, side = MESO_NO_INDEX;
    for (uint32_t step = 0; step < split->half_edge_count; step++) {
        side = side_towards(split, h, x, y);
        if (side == MESO_NO_INDEX)
            return h;
        h = split->twins[side];
        if (h == MESO_NO_INDEX)
            break;
    }
    for (h = 0; side_towards(split, h, x, y) != MESO_NO_INDEX; h += 3)
        assert(h + 3 < split->half_edge_count);
    return h;
}

/* From (a, b, c) to (a, b, n), (b, c, n) and (c, a, n). */
static void split_in_three(MesoTriangleSplit *split, uint32_t h, uint32_t n)
{
    uint32_t hn = meso_next_corner(h), hp = meso_previous_corner(h), f = split->half_edge_count;
    uint32_t a = split->corners[h], b = split->corners[hn], c = split->corners[hp];
    split->half_edge_count += 6;
    set_edge(split, f, b, split->twins[hn], split->lines[hn]);
    set_edge(split, f + 3, c, split->twins[hp], split->lines[hp]);
    set_edge(split, f + 2, n, hn, 0);
    set_edge(split, f + 4, a, hp, 0);
    set_edge(split, f + 5, n, f + 1, 0);
    set_edge(split, f + 1, c, f + 5, 0);
    set_edge(split, hn, b, f + 2, 0);
    set_edge(split, hp, n, f + 4, 0);
}

/* Where a triangle without area lies along an edge, with the newest point: turned, the edge goes through that. */
static void halve_edge(MesoTriangleSplit *split, uint32_t h)
{
    uint32_t g = split->twins[h];
    uint8_t line = split->lines[h];
    meso_split_flip(split, h);
    split->lines[h] = split->lines[g] = 0;
    meso_split_mark(split, meso_next_corner(h), line);
    meso_split_mark(split, meso_previous_corner(g), line);
}

MesoStatus meso_split_insert(MesoTriangleSplit *split, int32_t x, int32_t y, uint32_t *point, MesoError *error)
{
    if (reserve_points(split, error) || reserve_triangles(split, error))
        return MESO_ERR_MEMORY;
    uint32_t n = *point = split->point_count++, h = locate(split, x, y);
    split->points[n] = (MesoSplitPoint){.x = x, .y = y, .out = MESO_NO_INDEX};
    uint32_t on = MESO_NO_INDEX;
    for (uint32_t k = 0; k < 3; k++)
        if (turn_to(split, h - h % 3 + k, x, y) == 0)
            on = h - h % 3 + k;
    h = on == MESO_NO_INDEX ? h : on;
    split_in_three(split, h, n);
    if (on != MESO_NO_INDEX)
        halve_edge(split, h);
    improve_around(split, split->points[n].out, on == MESO_NO_INDEX ? 3 : 4);
    return MESO_OK;
}

/* ---- points near a place ---- */

/* Lists of points by cells of the grid, several cells a list; a side of a cell is MESO_SPLIT_APART. */
static uint32_t *cell_list(const MesoTriangleSplit *split, int32_t column, int32_t row)
{
    return &split->cells[((uint32_t)column * 89 + (uint32_t)row) % MESO_SPLIT_CELLS];
}

static void list_point(MesoTriangleSplit *split, uint32_t p)
{
    MesoSplitPoint *point = &split->points[p];
    uint32_t *list = cell_list(split, point->x / MESO_SPLIT_APART, point->y / MESO_SPLIT_APART);
    point->next_in_cell = *list;
    *list = p;
}

/* Lists the points that are not listed yet. */
static void list_points(MesoTriangleSplit *split)
{
    if (split->listed_count == 0)
        memset(split->cells, 0xff, MESO_SPLIT_CELLS * sizeof *split->cells);
    while (split->listed_count < split->point_count)
        list_point(split, split->listed_count++);
}

uint32_t meso_split_find(MesoTriangleSplit *split, uint32_t first, int32_t x, int32_t y, int32_t apart)
{
    enum { FEW = 24 };      /* as many are looked at sooner than lists of them are made */
    uint32_t found = MESO_NO_INDEX;
    if (split->point_count <= FEW) {
        for (uint32_t p = first; p < split->point_count && found == MESO_NO_INDEX; p++)
            found = meso_split_stands_near(&split->points[p], x, y, apart) ? p : found;
        return found;
    }
    list_points(split);
    for (int32_t column = x / MESO_SPLIT_APART - 1; column <= x / MESO_SPLIT_APART + 1; column++)
        for (int32_t row = y / MESO_SPLIT_APART - 1; row <= y / MESO_SPLIT_APART + 1; row++)
            for (uint32_t p = *cell_list(split, column, row); p != MESO_NO_INDEX; p = split->points[p].next_in_cell)
                if (p >= first && p < found && meso_split_stands_near(&split->points[p], x, y, apart))
                    found = p;
    return found;
}

MesoStatus meso_split_add_inside(MesoTriangleSplit *split, int32_t x, int32_t y, uint32_t *point, MesoError *error)
{
    *point = meso_split_find(split, split->border_count, x, y, MESO_SPLIT_APART);
    return *point != MESO_NO_INDEX ? MESO_OK : meso_split_insert(split, x, y, point, error);
}
