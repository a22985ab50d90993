#include "libcore/replicate/web/edge_balance.h"

#include "libcore/replicate/web/detail_web.h"
#include "libcore/replicate/web/web_edit.h"

enum { STACK = 64, AROUND = 24 };

MesoEdgeRest meso_edge_rest(const MesoWeb *web)
{
    MesoWebEdges edges = meso_web_edges(web);
    double share = edges.mean > 0 ? edges.deviation / edges.mean : 0;
    return (MesoEdgeRest){edges.mean, share * share};
}

static void count(MesoEdgeBalance *balance, const MesoEdgeRest *rest, double length2, double sign)
{
    double over = sqrt(length2) / rest->mean - 1;
    balance->excess += sign * over;
    balance->spread += sign * (over * over - rest->variance);
}

MesoEdgeBalance meso_edge_balance(const MesoWeb *web, const MesoEdgeRest *rest, const uint8_t *left_out)
{
    MesoEdgeBalance balance = {0, 0};
    for (uint32_t h = 0; h < 3 * web->triangle_count && rest->mean > 0; h++) {
        uint32_t a = web->corners[h], b = web->corners[meso_next_corner(h)];
        if (a < web->fixed_count || b < web->fixed_count || (web->twins[h] != MESO_NO_INDEX && web->twins[h] < h)
            || (left_out && (left_out[a] || left_out[b])))
            continue;
        count(&balance, rest, meso_web_length2(web, a, b), 1);
    }
    return balance;
}

/* ---- with one more ---- */

static double length2_to(const MesoWeb *web, MesoVec3 place, MesoVec3 normal, uint32_t node)
{
    MesoVec3d d = meso_vec3d_sub(meso_vec3d(web->positions[node]), meso_vec3d(place));
    return meso_vec3d_dot(d, d) * meso_web_arc2(normal, web->normals[node]);
}

/* Whether a side of a triangle is not Delaunay between its apex and a place within, whose ends are so far from that. */
static bool goes(const MesoWeb *web, uint32_t g, double ap, double bp, double *ab)
{
    uint32_t a = web->corners[meso_next_corner(g)], b = web->corners[g], d = meso_web_apex(web, g);
    *ab = meso_web_length2(web, a, b);
    double ad = meso_web_length2(web, a, d), bd = meso_web_length2(web, b, d);
    double cot_p = ap + bp - *ab, cot_d = ad + bd - *ab;
    if (cot_p >= 0 && cot_d >= 0)
        return false;
    return cot_p * sqrt(meso_heron(*ab, ad, bd)) + cot_d * sqrt(meso_heron(*ab, ap, bp)) < 0;
}

MesoEdgeBalance meso_edge_balance_with(const MesoWeb *web, const MesoEdgeRest *rest, uint32_t triangle, MesoVec3 place,
                                       MesoVec3 normal, double *nearest2)
{
    MesoEdgeBalance change = {0, 0};
    uint32_t stack[STACK] = {3 * triangle, 3 * triangle + 1, 3 * triangle + 2}, depth = 3, opened = 0;
    *nearest2 = INFINITY;
    while (depth > 0 && rest->mean > 0) {
        uint32_t h = stack[--depth], g = web->twins[h];
        uint32_t a = web->corners[h], b = web->corners[meso_next_corner(h)];
        double ap = length2_to(web, place, normal, a), ab;
        bool looked_at = g != MESO_NO_INDEX && opened < STACK && depth + 2 <= STACK;
        if (looked_at && goes(web, g, ap, length2_to(web, place, normal, b), &ab)) {
            if (a >= web->fixed_count && b >= web->fixed_count)
                count(&change, rest, ab, -1);
            stack[depth++] = meso_next_corner(g);
            stack[depth++] = meso_previous_corner(g);
            opened++;
        } else if (a >= web->fixed_count) {     /* each of those around begins one side */
            count(&change, rest, ap, 1);
            *nearest2 = fmin(*nearest2, ap);
        }
    }
    return change;
}

/* ---- with one less ---- */

/* What is around a node, in order, in its tangent plane; the node itself is at the origin. */
typedef struct Hole {
    uint32_t count;
    uint32_t nodes[AROUND];
    double places[AROUND][2];
} Hole;

/* False at a border, or where it has no room. */
static bool open_hole(Hole *hole, const MesoWeb *web, uint32_t node)
{
    MesoVec3 n = web->normals[node], axis = fabsf(n.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(axis, n), axis), y = meso_vec3_cross(n, x);
    hole->count = 0;
    if (web->node_corner[node] == MESO_NO_INDEX)
        return false;
    MesoSpokes s = meso_spokes(web, node);
    do {
        if (s.last || s.back || hole->count == AROUND)
            return false;
        uint32_t other = hole->nodes[hole->count] = web->corners[meso_next_corner(s.now)];
        MesoVec3 d = meso_vec3_sub(web->positions[other], web->positions[node]);
        hole->places[hole->count][0] = (double)meso_vec3_dot(d, x);
        hole->places[hole->count++][1] = (double)meso_vec3_dot(d, y);
    } while (meso_spokes_next(web, &s));
    return true;
}

static double turn_of(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Over 0 where d is in the circle through a, b and c, which turn left. */
static double in_circle(const double *a, const double *b, const double *c, const double *d)
{
    double ax = a[0] - d[0], ay = a[1] - d[1], bx = b[0] - d[0], by = b[1] - d[1], cx = c[0] - d[0], cy = c[1] - d[1];
    double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
    return ax * (by * c2 - b2 * cy) - ay * (bx * c2 - b2 * cx) + a2 * (bx * cy - by * cx);
}

/* Of some that are left, in order, the corner `i` can be cut off: nothing else is in the circle through it. */
static bool is_ear(const Hole *hole, const uint32_t *left, uint32_t count, uint32_t i, double side)
{
    uint32_t before = (i + count - 1) % count, after = (i + 1) % count;
    const double *a = hole->places[left[before]], *b = hole->places[left[i]], *c = hole->places[left[after]];
    if (!(side * turn_of(a, b, c) > 0))
        return false;
    for (uint32_t k = 0; k < count; k++)
        if (k != before && k != i && k != after && side * in_circle(a, b, c, hole->places[left[k]]) > 0)
            return false;
    return true;
}

static void close_hole(const Hole *hole, const MesoWeb *web, const MesoEdgeRest *rest, MesoEdgeBalance *change)
{
    uint32_t left[AROUND], count_left = hole->count;
    double area = 0;
    for (uint32_t i = 0; i < count_left; i++) {
        const double *p = hole->places[i], *q = hole->places[(i + 1) % count_left];
        area += p[0] * q[1] - p[1] * q[0];
        left[i] = i;
    }
    while (count_left > 3) {
        uint32_t ear = 0;
        while (ear < count_left && !is_ear(hole, left, count_left, ear, area > 0 ? 1 : -1))
            ear++;
        ear = ear < count_left ? ear : 0;       /* of a hole that is no star in the plane: any */
        uint32_t a = hole->nodes[left[(ear + count_left - 1) % count_left]];
        uint32_t b = hole->nodes[left[(ear + 1) % count_left]];
        if (a >= web->fixed_count && b >= web->fixed_count)
            count(change, rest, meso_web_length2(web, a, b), 1);
        count_left--;
        for (uint32_t i = ear; i < count_left; i++)
            left[i] = left[i + 1];
    }
}

MesoEdgeBalance meso_edge_balance_without(const MesoWeb *web, const MesoEdgeRest *rest, uint32_t node)
{
    MesoEdgeBalance change = {0, 0};
    Hole hole;
    if (!(rest->mean > 0) || node < web->fixed_count || !open_hole(&hole, web, node))
        return change;
    for (uint32_t i = 0; i < hole.count; i++)
        if (hole.nodes[i] >= web->fixed_count)
            count(&change, rest, meso_web_length2(web, node, hole.nodes[i]), -1);
    close_hole(&hole, web, rest, &change);
    return change;
}
