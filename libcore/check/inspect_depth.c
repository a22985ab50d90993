/*
 * How deep two things are in each other: from where they cut through each other the triangles of one are followed into
 * the other, the deepest first.
 */
#include "libcore/check/inspect_work.h"

enum { MOST_REACHED = 128, PATIENCE = 8, TABLE = 512 };

/* Distances that differ by less are those of one point, of an edge or a corner, from several triangles. */
#define SAME_DISTANCE 1e-9

/* Below a surface the way to it is straight; where it is not, the point is beyond a rim, neither above nor below. */
#define STRAIGHT_COSINE 0.7

/* What points are measured against: all of a thing, or, where it cuts through itself, the part that it runs into. */
typedef struct Against {
    const MesoInspectWork *work;
    uint32_t thing, part;           /* part: MESO_NO_INDEX for all */
    MesoVec3d point;
    double square, steepness;       /* of the nearest triangle: how straight the way to it leaves its plane */
    bool behind;
} Against;

static double segment_parameter(MesoVec3d a, MesoVec3d b, MesoVec3d p)
{
    MesoVec3d along = meso_vec3d_sub(b, a);
    double length = meso_vec3d_dot(along, along);
    double t = length > 0 ? meso_vec3d_dot(meso_vec3d_sub(p, a), along) / length : 0;
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* The way from the nearest point of a triangle to p. */
static MesoVec3d way_from(const MesoInspectTriangle *t, MesoVec3d p)
{
    bool inside = true;
    MesoVec3d best = {0, 0, 0};
    double least = INFINITY;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3d a = t->p[k], b = t->p[(k + 1) % 3];
        inside = inside && meso_vec3d_det(t->normal, meso_vec3d_sub(b, a), meso_vec3d_sub(p, a)) >= 0;
        MesoVec3d on = meso_vec3d_mad(a, segment_parameter(a, b, p), meso_vec3d_sub(b, a));
        MesoVec3d way = meso_vec3d_sub(p, on);
        if (meso_vec3d_dot(way, way) < least) {
            least = meso_vec3d_dot(way, way);
            best = way;
        }
    }
    if (inside && meso_vec3d_dot(t->normal, t->normal) > 0)
        return meso_vec3d_scale(t->normal, meso_vec3d_dot(t->normal, meso_vec3d_sub(p, t->p[0])));
    return best;
}

/* Whether the box around a triangle is further away than the nearest one so far: cheap, and most are. */
static bool is_far(const Against *against, uint32_t item)
{
    const MesoInspectedMesh *mesh = against->work->mesh;
    MesoVec3 a = meso_inspect_corner(mesh, 3 * item), b = meso_inspect_corner(mesh, 3 * item + 1);
    MesoVec3 c = meso_inspect_corner(mesh, 3 * item + 2);
    const double p[3] = {against->point.x, against->point.y, against->point.z};
    const float corners[3][3] = {{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}};
    double square = 0;
    for (int axis = 0; axis < 3; axis++) {
        const float *x = corners[axis];
        double low = (double)(x[0] < x[1] ? x[0] : x[1]), high = (double)(x[0] > x[1] ? x[0] : x[1]);
        low = (double)x[2] < low ? (double)x[2] : low;
        high = (double)x[2] > high ? (double)x[2] : high;
        double away = p[axis] < low ? low - p[axis] : p[axis] > high ? p[axis] - high : 0;
        square += away * away;
    }
    return square > against->square * (1 + SAME_DISTANCE);
}

/* Of triangles that are as near, the one whose plane the way leaves most straightly says on which side the point is
 * (Thuermer and Wuethrich 1998 weigh normals by angles for the same end). */
static double distance_to(void *context, uint32_t item)
{
    Against *against = context;
    const MesoInspectWork *work = against->work;
    if (work->things[item] != against->thing ||
        (against->part != MESO_NO_INDEX && work->parts[item] != against->part))
        return INFINITY;
    if (is_far(against, item))
        return INFINITY;
    MesoInspectTriangle t = meso_inspect_triangle(work->mesh, item);
    MesoVec3d way = way_from(&t, against->point);
    double square = meso_vec3d_dot(way, way), height = meso_vec3d_dot(way, t.normal);
    double steepness = square > 0 ? fabs(height) / sqrt(square) : 0;
    bool nearer = square < against->square * (1 - SAME_DISTANCE);
    bool same = square <= against->square * (1 + SAME_DISTANCE);
    if (nearer || (same && steepness > against->steepness)) {
        against->square = nearer ? square : against->square;
        against->steepness = steepness;
        against->behind = height < 0;
    }
    return square;
}

/* How far below the surface a point is; 0 above it. */
static double depth_at(Against *against, MesoVec3d point)
{
    MesoInspectAsking asking = {point, against->thing, MESO_NO_INDEX, 0};
    double square = INFINITY;
    against->point = point;
    against->square = INFINITY;
    against->steepness = 0;
    against->behind = false;
    meso_inspect_tree_nearest(&against->work->tree, &asking, &square, distance_to, against);
    return against->behind && against->steepness > STRAIGHT_COSINE ? sqrt(square) : 0;
}

/* ---- the way in ---- */

/* Triangles that were reached, and whether their neighbours were too. */
typedef struct Reached {
    uint32_t triangle;
    double depth;
    bool followed;
} Reached;

typedef struct Flood {
    Against against;
    uint32_t count;
    Reached reached[MOST_REACHED];
    uint32_t places[TABLE];         /* hash table of places + 1 and their depths */
    double depths[TABLE];
    uint32_t place_count;
} Flood;

static double depth_of_place(Flood *flood, uint32_t place, MesoVec3d point)
{
    uint32_t at = (place * UINT32_C(2654435761)) >> 23;
    while (flood->places[at] && flood->places[at] != place + 1)
        at = (at + 1) % TABLE;
    if (flood->places[at])
        return flood->depths[at];
    double depth = depth_at(&flood->against, point);
    if (flood->place_count < TABLE / 2) {
        flood->place_count++;
        flood->places[at] = place + 1;
        flood->depths[at] = depth;
    }
    return depth;
}

/* Where one of its corners is inside. */
static void reach(Flood *flood, uint32_t triangle)
{
    const MesoInspectWork *work = flood->against.work;
    if (flood->count == MOST_REACHED || !meso_inspect_is_finite(work->mesh, triangle) ||
        (flood->against.part != MESO_NO_INDEX && work->parts[triangle] == flood->against.part))
        return;
    for (uint32_t i = 0; i < flood->count; i++)
        if (flood->reached[i].triangle == triangle)
            return;
    double deepest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t corner = 3 * triangle + k;
        deepest = fmax(deepest, depth_of_place(flood, work->places[corner],
                                               meso_vec3d(meso_inspect_corner(work->mesh, corner))));
    }
    if (deepest > 0)
        flood->reached[flood->count++] = (Reached){triangle, deepest, false};
}

static Reached *deepest_to_follow(Flood *flood)
{
    Reached *best = NULL;
    for (uint32_t i = 0; i < flood->count; i++)
        if (!flood->reached[i].followed && (!best || flood->reached[i].depth > best->depth))
            best = &flood->reached[i];
    return best;
}

/* Until it has long gone no deeper. */
static double follow(Flood *flood, uint32_t most)
{
    double deepest = 0;
    uint32_t since = 0;
    for (uint32_t i = 0; i < most && since < PATIENCE; i++, since++) {
        Reached *next = deepest_to_follow(flood);
        if (!next)
            break;
        next->followed = true;
        if (next->depth > deepest) {
            deepest = next->depth;
            since = 0;
        }
        uint32_t triangle = next->triangle;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t mate = flood->against.work->mates[3 * triangle + k];
            if (mate < MESO_MATE_OUT)
                reach(flood, mate / 3);
        }
    }
    return deepest;
}

/* ---- sides that go in, for triangles that are long beside what they cut through ---- */

typedef struct Exit {
    const Against *against;
    uint32_t entry;             /* triangle */
    MesoVec3d origin, direction;
} Exit;

static double exit_at(void *context, uint32_t item)
{
    const Exit *leaving = context;
    const MesoInspectWork *work = leaving->against->work;
    MesoInspectHole hole;
    if (item == leaving->entry || work->things[item] != leaving->against->thing ||
        (leaving->against->part != MESO_NO_INDEX && work->parts[item] != leaving->against->part))
        return INFINITY;
    MesoInspectTriangle t = meso_inspect_triangle(work->mesh, item);
    if (!meso_inspect_pierces(&t, leaving->origin, meso_vec3d_add(leaving->origin, leaving->direction), 0, &hole))
        return INFINITY;
    MesoVec3d way = meso_vec3d_sub(hole.at, leaving->origin);
    return sqrt(meso_vec3d_dot(way, way) / meso_vec3d_dot(leaving->direction, leaving->direction));
}

/* In the middle of the part of a side of `s` that is inside, where it goes in through `t`. */
static double depth_of_sides(Against *against, uint32_t s, uint32_t t)
{
    const MesoInspectWork *work = against->work;
    MesoInspectTriangle from = meso_inspect_triangle(work->mesh, s), into = meso_inspect_triangle(work->mesh, t);
    double deepest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoInspectHole hole;
        if (!meso_inspect_pierces(&into, from.p[k], from.p[(k + 1) % 3], work->rounding, &hole))
            continue;
        Exit leaving = {against, t, hole.at, meso_vec3d_sub(hole.inner, hole.at)};
        double way = 1;
        meso_inspect_tree_ray(&work->tree, leaving.origin, leaving.direction, against->thing, &way, exit_at, &leaving);
        deepest = fmax(deepest, depth_at(against, meso_vec3d_mad(leaving.origin, 0.5 * way, leaving.direction)));
    }
    return deepest;
}

/* One of the two into the other. */
static double depth_one_way(const MesoInspectWork *work, const MesoInspectCut *cuts, uint32_t count, uint32_t most,
                            bool backwards)
{
    uint32_t first = backwards ? cuts[0].s : cuts[0].t;
    bool within = cuts[0].a == cuts[0].b;
    Flood flood = {.against = {.work = work, .thing = work->things[first],
                               .part = within ? work->parts[first] : MESO_NO_INDEX}};
    if (within && work->parts[cuts[0].s] == work->parts[cuts[0].t])
        return 0;       /* what is inside of what cannot be told */
    double deepest = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t s = backwards ? cuts[i].t : cuts[i].s, t = backwards ? cuts[i].s : cuts[i].t;
        if (within && work->parts[t] != flood.against.part)
            continue;
        reach(&flood, s);
        deepest = fmax(deepest, depth_of_sides(&flood.against, s, t));
    }
    return fmax(deepest, follow(&flood, most));
}

double meso_inspect_depth(const MesoInspectWork *work, const MesoInspectCut *cuts, uint32_t count, uint32_t most)
{
    return fmax(depth_one_way(work, cuts, count, most, false), depth_one_way(work, cuts, count, most, true));
}
