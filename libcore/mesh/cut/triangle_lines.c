/* Segments drawn into a split triangle. */
#include <assert.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/cut/triangle_split.h"
#include "libcore/mesh/cut/triangulation.h"

/* ---- what a segment meets ---- */

/*
 * Distances as in a triangle with equal sides, so that no corner is preferred. A segment goes through a point that it
 * passes nearer than MESO_SPLIT_APART, by weight, and then is bent by less than a quarter turn: the squares of both
 * parts' lengths are together less than its own, and so the going through points and crossings comes to an end.
 */
static bool inside_circle(const MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t w)
{
    const MesoSplitPoint *p = split->points;
    int64_t ax = p[a].x - p[w].x, ay = p[a].y - p[w].y, bx = p[b].x - p[w].x, by = p[b].y - p[w].y;
    return ax * bx + ay * by + (ax + ay) * (bx + by) < 0;
}

static bool passes_near(const MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t w)
{
    if (w == a || w == b || !inside_circle(split, a, b, w))
        return false;
    /* a whole side must not become part of a segment here: the other triangle at it may not be looked at */
    if (w < 3 && (a < 3 || b < 3))
        return false;
    const MesoSplitPoint *p = split->points;
    double x = p[b].x - p[a].x, y = p[b].y - p[a].y, area = (double)meso_split_turn(split, a, b, w);
    double length2 = x * x + y * y + (x + y) * (x + y);
    return 2 * area * area < (double)MESO_SPLIT_APART * MESO_SPLIT_APART * length2;
}

typedef enum Meeting { MEETS_NOTHING, IS_EDGE, MEETS_POINT, MEETS_EDGE } Meeting;

/*
 * The first triangle around `a` into which the segment goes: `at` becomes the edge that it leaves by, on this side of
 * it; or the edge that is the segment; or a point on the way.
 */
static Meeting set_out(const MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t *at)
{
    uint32_t first = split->points[a].out, out = first;
    Meeting meeting = MEETS_NOTHING;
    do {
        uint32_t facing = meso_next_corner(out), back = meso_previous_corner(out);
        uint32_t p = split->corners[facing], q = split->corners[back];
        if (p == b || q == b) {
            *at = p == b ? out : back;
            return IS_EDGE;
        }
        if (passes_near(split, a, b, p) || passes_near(split, a, b, q)) {
            *at = passes_near(split, a, b, p) ? p : q;
            meeting = MEETS_POINT;
        } else if (meeting == MEETS_NOTHING && meso_split_turn(split, a, b, p) < 0 &&
                   meso_split_turn(split, a, b, q) > 0) {
            *at = facing;
            meeting = MEETS_EDGE;
        }
        out = split->twins[back];
    } while (out != MESO_NO_INDEX && out != first);
    return meeting;
}

/* Beyond edge `h` that the segment crosses: the edge that it leaves the triangle by, on this side of it. */
static uint32_t next_crossed(const MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t h)
{
    uint32_t g = split->twins[h], apex = split->corners[meso_previous_corner(g)];
    return meso_split_turn(split, a, b, apex) < 0 ? meso_previous_corner(g) : meso_next_corner(g);
}

/* Goes from the edge `at` on: stops at a line or a point that is near; IS_EDGE where there is neither. */
static Meeting look_ahead(const MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t *at)
{
    for (uint32_t h = *at;; h = next_crossed(split, a, b, h)) {
        if (split->lines[h]) {
            *at = h;
            return MEETS_EDGE;
        }
        uint32_t apex = split->corners[meso_previous_corner(split->twins[h])];
        if (apex == b)
            return IS_EDGE;
        if (passes_near(split, a, b, apex)) {
            *at = apex;
            return MEETS_POINT;
        }
    }
}

/* ---- turning edges out of the way ---- */

static bool crosses(const MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    if (c == a || c == b || d == a || d == b)
        return false;
    return (meso_split_turn(split, a, b, c) < 0) != (meso_split_turn(split, a, b, d) < 0);
}

/*
 * Once no single turn takes an edge out of the way: the point farthest from the segment has an edge across it that can
 * be turned, and each such turn leaves it fewer. Were none to be turned, the points that those edges go to would bulge
 * towards it from between its neighbours, and those are on its own side.
 */
static void turn_at_farthest(MesoTriangleSplit *split, uint32_t a, uint32_t b)
{
    const MesoSplitPoint *points = split->points;
    uint32_t farthest = MESO_NO_INDEX, h = MESO_NO_INDEX;
    int64_t distance = 0, along = 0;
    for (uint32_t i = 0; i < 2 * split->passed_count; i++) {
        uint32_t edge = split->passed[i / 2], p = split->corners[i % 2 ? meso_next_corner(edge) : edge];
        int64_t d = meso_split_turn(split, a, b, p);
        int64_t s = (int64_t)(points[b].x - points[a].x) * points[p].x +
                    (int64_t)(points[b].y - points[a].y) * points[p].y;
        d = d < 0 ? -d : d;
        if (d > distance || (d == distance && s < along)) {
            farthest = p;
            distance = d;
            along = s;
        }
    }
    for (uint32_t i = 0; i < split->passed_count && h == MESO_NO_INDEX; i++) {
        uint32_t edge = split->passed[i];
        bool has = split->corners[edge] == farthest || split->corners[meso_next_corner(edge)] == farthest;
        if (has && meso_split_can_flip(split, edge))
            h = edge;
    }
    assert(h != MESO_NO_INDEX);
    meso_split_flip(split, h);
}

static MesoStatus remember_passed(MesoTriangleSplit *split, uint32_t h, MesoError *error)
{
    split->passed = MESO_GROW(split->arena, split->passed, split->passed_count, split->passed_room, 64, error);
    if (!split->passed)
        return MESO_ERR_MEMORY;
    split->passed[split->passed_count++] = h;
    return MESO_OK;
}

/*
 * From edge `h` on, the first across the segment: turns each edge that would not be across it then, and goes back to
 * the one before, which may be free to turn now. Those that are left are in `passed`; each by the half-edge towards
 * `a`, which does not change when edges beyond it turn.
 */
static MesoStatus turn_away(MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t h, MesoError *error)
{
    split->passed_count = 0;
    for (;;) {
        uint32_t g = split->twins[h];
        uint32_t near = split->corners[meso_previous_corner(h)], far = split->corners[meso_previous_corner(g)];
        if (!crosses(split, a, b, near, far) && meso_split_can_flip(split, h)) {
            meso_split_flip(split, h);
            if (split->passed_count > 0)
                h = split->passed[--split->passed_count];
            else if (set_out(split, a, b, &h) != MEETS_EDGE)
                return MESO_OK;
            continue;
        }
        if (remember_passed(split, h, error))
            return MESO_ERR_MEMORY;
        if (far == b)
            return MESO_OK;
        h = next_crossed(split, a, b, h);
    }
}

/* ---- drawing ---- */

static MesoStatus draw_later(MesoTriangleSplit *split, uint32_t a, uint32_t b, MesoError *error)
{
    split->pending = MESO_GROW(split->arena, split->pending, split->pending_count, split->pending_room, 64, error);
    if (!split->pending)
        return MESO_ERR_MEMORY;
    split->pending[split->pending_count][0] = a;
    split->pending[split->pending_count++][1] = b;
    return MESO_OK;
}

static MesoStatus draw_through(MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t w, MesoError *error)
{
    return draw_later(split, w, b, error) || draw_later(split, a, w, error) ? MESO_ERR_MEMORY : MESO_OK;
}

/* Where a-b and u-v cross, rounded to the grid; inside the triangle. */
static void find_crossing(const MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t u, uint32_t v,
                          int32_t at[2])
{
    const MesoSplitPoint *p = &split->points[a], *q = &split->points[b];
    double to_a = (double)meso_split_turn(split, u, v, a), to_b = (double)meso_split_turn(split, u, v, b);
    double t = to_a / (to_a - to_b);
    int32_t x = (int32_t)lrint(p->x + t * (q->x - p->x)), y = (int32_t)lrint(p->y + t * (q->y - p->y));
    x = x < 1 ? 1 : x > MESO_SPLIT_ONE - 2 ? MESO_SPLIT_ONE - 2 : x;
    y = y < 1 ? 1 : y > MESO_SPLIT_ONE - 1 - x ? MESO_SPLIT_ONE - 1 - x : y;
    at[0] = x;
    at[1] = y;
}

/* Whether both segments may go through w, or have it as an end. */
static bool may_meet_in(const MesoTriangleSplit *split, const uint32_t ends[4], uint32_t w)
{
    for (uint32_t i = 0; i < 4; i += 2)
        if (w != ends[i] && w != ends[i + 1] && !inside_circle(split, ends[i], ends[i + 1], w))
            return false;
    return true;
}

/* The point in which two segments that cross are to meet: one that stands near, rather an end, or a new one. */
static MesoStatus find_meeting(MesoTriangleSplit *split, const uint32_t ends[4], uint32_t *w, MesoError *error)
{
    int32_t at[2];
    find_crossing(split, ends[0], ends[1], ends[2], ends[3], at);
    uint32_t near = meso_split_find(split, 0, at[0], at[1], MESO_SPLIT_APART);
    for (uint32_t i = 0; i < 4 && near != MESO_NO_INDEX; i++) {
        *w = ends[i];
        if (meso_split_stands_near(&split->points[*w], at[0], at[1], MESO_SPLIT_APART) && may_meet_in(split, ends, *w))
            return MESO_OK;
    }
    *w = near;
    if (near != MESO_NO_INDEX && may_meet_in(split, ends, near))
        return MESO_OK;
    if (meso_split_find(split, 0, at[0], at[1], 1) != MESO_NO_INDEX)
        return meso_fail(error, MESO_ERR_INTERNAL, "segments cross in a point that they cannot meet in");
    return meso_split_insert(split, at[0], at[1], w, error);
}

/* Makes a-b and the line h, which crosses it, meet in a point. */
static MesoStatus draw_across(MesoTriangleSplit *split, uint32_t a, uint32_t b, uint32_t h, MesoError *error)
{
    const uint32_t ends[4] = {a, b, split->corners[h], split->corners[meso_next_corner(h)]};
    uint32_t w;
    meso_split_mark(split, h, 0);
    MesoStatus status = find_meeting(split, ends, &w, error);
    for (uint32_t i = 0; i < 4 && !status; i += 2)
        status = w == ends[i] || w == ends[i + 1] ? draw_later(split, ends[i], ends[i + 1], error)
                                                  : draw_through(split, ends[i], ends[i + 1], w, error);
    return status;
}

static MesoStatus draw_next(MesoTriangleSplit *split, MesoError *error)
{
    uint32_t a = split->pending[split->pending_count - 1][0], b = split->pending[split->pending_count - 1][1];
    split->pending_count--;
    for (;;) {
        uint32_t first, at;
        Meeting meeting = set_out(split, a, b, &first);
        at = first;
        if (meeting == IS_EDGE) {
            meso_split_mark(split, at, 1);
            return MESO_OK;
        }
        if (meeting == MEETS_EDGE)
            meeting = look_ahead(split, a, b, &at);
        if (meeting == MEETS_POINT)
            return draw_through(split, a, b, at, error);
        if (meeting == MEETS_EDGE)
            return draw_across(split, a, b, at, error);
        assert(meeting == IS_EDGE);
        if (turn_away(split, a, b, first, error))
            return MESO_ERR_MEMORY;
        if (split->passed_count > 0)
            turn_at_farthest(split, a, b);
    }
}

MesoStatus meso_split_draw(MesoTriangleSplit *split, uint32_t a, uint32_t b, MesoError *error)
{
    if (a == b)
        return MESO_OK;
    MesoStatus status = draw_later(split, a, b, error);
    while (!status && split->pending_count > 0)
        status = draw_next(split, error);
    return status;
}
