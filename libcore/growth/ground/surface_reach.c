#include "libcore/growth/ground/surface_reach.h"

#include "libcore/base/grow.h"
#include "libcore/base/parallel.h"

/* As many views as a triangle has hardly ever, and where triangles have no area may have without an end. */
enum { VIEWS_A_TRIANGLE = 32, VIEWS_AT_LEAST = 4096, VIEW_LIMIT = 1 << 24 };

struct MesoReach {
    const MesoTriangulation *mesh;
    const MesoWalkGround *ground;
    double *angles;             /* [vertex_count] of all triangles there; INFINITY at borders */
    double *known;              /* [vertex_count] the least length of a path so far, where `met` says so */
    uint32_t *met;              /* [vertex_count] number of the reach that met it */
    uint32_t number;
    MesoArena *arena;
    MesoReachView *queue;       /* [count] views to come, first in first out */
    uint32_t first, count, room, limit;
    double distance;
    void (*view)(void *context, const MesoReachView *view);
    void *context;
    MesoError *error;
};

/* A side in the frame that begins with it: its length, and where the third corner is. */
typedef struct Side {
    double length, x, y;
} Side;

static Side side_of(const MesoWalkGround *ground, uint32_t half_edge)
{
    const MesoWalkFace *face = &ground->faces[half_edge / 3];
    uint32_t k = half_edge % 3, base = meso_walk_base(face);
    MesoComplex apex = face->apexes[base];
    double length = ground->lengths[half_edge / 3];
    if (k == meso_next_side(base))
        length *= sqrt((1 - apex.re) * (1 - apex.re) + apex.im * apex.im);
    else if (k != base)
        length *= sqrt(apex.re * apex.re + apex.im * apex.im);
    return (Side){length, length * face->apexes[k].re, length * face->apexes[k].im};
}

/* ---- distances ---- */

static double norm(double x, double y)
{
    return sqrt(x * x + y * y);
}

double meso_view_distance(const MesoWalkGround *ground, const MesoReachView *view, const double weight[3])
{
    if (view->side == 3) {
        MesoComplex corners[3];
        meso_walk_corners(ground, view->triangle, corners);
        MesoComplex at = meso_walk_point(corners, weight);
        return view->base + norm(at.re - view->x, at.im - view->y);
    }
    Side side = side_of(ground, 3 * view->triangle + view->side);
    double far = weight[meso_previous_side(view->side)];
    double x = weight[meso_next_side(view->side)] * side.length + far * side.x, y = far * side.y;
    double t = y + view->y > 0 ? view->x + (x - view->x) * (view->y / (y + view->y)) : x;
    if (t >= view->begin && t <= view->end)
        return view->base + norm(x - view->x, y + view->y);
    t = t < view->begin ? view->begin : view->end;
    return view->base + norm(t - view->x, view->y) + norm(x - t, y);
}

static double value_at(const MesoReachView *view, double t)
{
    return view->base + norm(t - view->x, view->y);
}

static double least_of(const MesoReachView *view)
{
    double t = view->x < view->begin ? view->begin : view->x > view->end ? view->end : view->x;
    return value_at(view, t);
}

/* ---- vertices ---- */

static double known_at(const MesoReach *reach, uint32_t vertex)
{
    return reach->met[vertex] == reach->number ? reach->known[vertex] : INFINITY;
}

/* Whether it is news. */
static bool meet(MesoReach *reach, uint32_t vertex, double distance)
{
    if (!(distance < known_at(reach, vertex) * (1 - 1e-12)) || distance > reach->distance)
        return false;
    reach->met[vertex] = reach->number;
    reach->known[vertex] = distance;
    return true;
}

/* Whether paths along the side from its ends are shorter than all through the window. */
static bool comes_too_late(const MesoReach *reach, const MesoReachView *view, double length)
{
    const uint32_t *corners = &reach->mesh->corners[3 * (size_t)view->triangle];
    double d0 = known_at(reach, corners[view->side]), d1 = known_at(reach, corners[meso_next_side(view->side)]);
    double least = least_of(view), slack = 1 + 1e-12;
    return least > reach->distance || least > 0.5 * (d0 + d1 + length) * slack ||
           (d0 + view->end) * slack < value_at(view, view->end) ||
           (d1 + length - view->begin) * slack < value_at(view, view->begin);
}

/* ---- windows ---- */

/* What is seen of a half-edge from within its triangle, to go on beyond it. */
static MesoStatus see_side(MesoReach *reach, uint32_t h, double length, MesoReachView view)
{
    const MesoWalkFace *face = &reach->ground->faces[h / 3];
    uint32_t twin = face->twins[h % 3];
    if (twin == MESO_NO_INDEX || !(view.end - view.begin > 1e-12 * length) || reach->count >= reach->limit)
        return MESO_OK;
    view.triangle = twin / 3;
    view.side = twin % 3;
    view.y = view.y > 0 ? view.y : 0;
    if (!meso_walk_turns(face, h % 3)) {
        double begin = view.begin;
        view.begin = length - view.end;
        view.end = length - begin;
        view.x = length - view.x;
    }
    if (comes_too_late(reach, &view, length))
        return MESO_OK;
    reach->queue = MESO_GROW(reach->arena, reach->queue, reach->count, reach->room, 1024, reach->error);
    if (!reach->queue)
        return MESO_ERR_MEMORY;
    reach->queue[reach->count++] = view;
    return MESO_OK;
}

static double corner_angle(const MesoReach *reach, uint32_t corner)
{
    Side side = side_of(reach->ground, corner);
    return atan2(side.y, side.x);
}

/* A part of the fan around a vertex that lies in the shadow: angles from the ray that comes to it, one way around. */
typedef struct Shadow {
    double distance, low, high;
} Shadow;

static MesoStatus see_vertex(MesoReach *reach, uint32_t corner, double distance, double inward);

/* Where the ray leaves that goes at an angle from one of a triangle's spokes, as a length from the spoke's end. */
static double leave_at(double spoke, double angle_there, double angle)
{
    double s = sin(angle + angle_there);
    return s > 0 ? spoke * sin(angle) / s : INFINITY;
}

/* From a vertex through one of its triangles: what lies between two angles from the spoke that the fan comes in by. */
static MesoStatus light_triangle(MesoReach *reach, MesoFan fan, double distance, double low, double high, bool all)
{
    uint32_t opposite = meso_next_corner(fan.corner), first = fan.corner;
    Side out = side_of(reach->ground, opposite), spoke = side_of(reach->ground, first);
    Side back = side_of(reach->ground, meso_previous_corner(fan.corner));
    MesoReachView view = {.x = out.x, .y = out.y, .begin = 0, .end = out.length, .base = distance};
    double length = fan.turned ? back.length : spoke.length;
    double there = corner_angle(reach, fan.turned ? meso_previous_corner(fan.corner) : opposite);
    double a = low > 0 ? fmin(leave_at(length, there, low), out.length) : 0;
    double b = all ? out.length : fmin(leave_at(length, there, high), out.length);
    view.begin = fan.turned ? out.length - b : a;
    view.end = fan.turned ? out.length - a : b;
    return see_side(reach, opposite, out.length, view);
}

/* A vertex sees all of the triangles around it. */
static void tell_around(const MesoReach *reach, uint32_t corner, double distance)
{
    MesoComplex corners[3];
    meso_walk_corners(reach->ground, corner / 3, corners);
    reach->view(reach->context, &(MesoReachView){.triangle = corner / 3, .side = 3, .x = corners[corner % 3].re,
                                                 .y = corners[corner % 3].im, .base = distance});
}

/* Goes around, from the fan's triangle on, whose far spoke lies at the angle `at` from the ray that comes in. */
static MesoStatus light_fan(MesoReach *reach, MesoFan fan, double at, const Shadow *shadow)
{
    uint32_t first = fan.corner;
    MesoStatus status = MESO_OK;
    while (!status && at <= shadow->high && meso_fan_next(reach->mesh, &fan) && fan.corner != first) {
        double angle = corner_angle(reach, fan.corner);
        uint32_t near = fan.turned ? meso_previous_corner(fan.corner) : meso_next_corner(fan.corner);
        uint32_t far = fan.turned ? meso_next_corner(fan.corner) : meso_previous_corner(fan.corner);
        if (at >= shadow->low) {
            Side spoke = side_of(reach->ground, fan.turned ? meso_previous_corner(fan.corner) : fan.corner);
            double inward = fan.turned ? 0 : corner_angle(reach, near);
            status = see_vertex(reach, near, shadow->distance + spoke.length, inward);
        }
        if (!status && at + angle >= shadow->low && at + angle <= shadow->high) {
            Side spoke = side_of(reach->ground, fan.turned ? fan.corner : meso_previous_corner(fan.corner));
            double inward = fan.turned ? corner_angle(reach, far) : 0;
            status = see_vertex(reach, far, shadow->distance + spoke.length, inward);
        }
        if (!status && at + angle > shadow->low)
            tell_around(reach, fan.corner, shadow->distance);
        if (!status && at + angle > shadow->low)
            status = light_triangle(reach, fan, shadow->distance, shadow->low - at, shadow->high - at,
                                    at + angle <= shadow->high);
        at += angle;
    }
    return status;
}

/*
 * A path comes to the vertex of a corner, from within the corner's triangle: `inward` is the angle from the side that
 * begins at the corner to the way back. Behind a saddle or a border paths go on where no straight one gets to.
 */
static MesoStatus see_vertex(MesoReach *reach, uint32_t corner, double distance, double inward)
{
    uint32_t vertex = reach->mesh->corners[corner];
    double all = reach->angles[vertex];
    if (!meet(reach, vertex, distance) || !(all > 2 * MESO_PI + 1e-9))
        return MESO_OK;
    Shadow shadow = {distance, MESO_PI, all < INFINITY ? all - MESO_PI : INFINITY};
    double left = corner_angle(reach, corner) - inward;
    MesoStatus status = light_fan(reach, (MesoFan){corner, false}, left, &shadow);
    if (!status && !(all < INFINITY))
        status = light_fan(reach, (MesoFan){corner, true}, inward, &shadow);
    return status;
}

/* ---- triangles ---- */

/* A ray through (t,0): its direction, and how far to its left the third corner lies. */
typedef struct Ray {
    double y, left;
} Ray;

static Ray ray_through(const MesoReachView *view, double t, const Side *side)
{
    return (Ray){view->y, (t - view->x) * side->y + view->y * (t - side->x)};
}

/* The part a / (a + b) of a length. */
static double part_of(double a, double b, double length)
{
    double share = a / (a + b);
    return share > 0 ? fmin(share, 1) * length : 0;
}

/* The source as it lies to a side that begins at (ox,oy) and has the direction (ex,ey). */
static MesoReachView turn_view(const MesoReachView *view, double ox, double oy, double ex, double ey)
{
    MesoReachView turned = *view;
    double x = view->x - ox, y = -view->y - oy;
    turned.x = ex * x + ey * y;
    turned.y = fmax(ex * y - ey * x, 0);
    return turned;
}

static MesoStatus see_corner(MesoReach *reach, uint32_t g, const MesoReachView *view, const Side *side)
{
    double dx = view->x - side->x, dy = -view->y - side->y;
    /* from the way to the half-edge's begin, counter-clockwise */
    double inward = atan2(-side->x * dy + side->y * dx, -side->x * dx - side->y * dy);
    return see_vertex(reach, meso_previous_corner(g), view->base + norm(dx, dy), fmax(inward, 0));
}

static MesoStatus cross_triangle(MesoReach *reach, const MesoReachView *view)
{
    uint32_t g = 3 * view->triangle + view->side, next = meso_next_corner(g), previous = meso_previous_corner(g);
    Side side = side_of(reach->ground, g);
    double right = side_of(reach->ground, next).length, left = side_of(reach->ground, previous).length;
    Ray first = ray_through(view, view->begin, &side), last = ray_through(view, view->end, &side);
    MesoStatus status = MESO_OK;
    if (first.left <= 0 && last.left >= 0)
        status = see_corner(reach, g, view, &side);
    if (!status && last.left > 0 && right > 0) {
        MesoReachView turned = turn_view(view, side.length, 0, (side.x - side.length) / right, side.y / right);
        turned.begin = part_of(last.y * (side.length - view->end), last.left, right);
        turned.end = first.left > 0 ? part_of(first.y * (side.length - view->begin), first.left, right) : right;
        status = see_side(reach, next, right, turned);
    }
    if (!status && first.left < 0 && left > 0) {
        MesoReachView turned = turn_view(view, side.x, side.y, -side.x / left, -side.y / left);
        turned.begin = last.left < 0 ? part_of(-last.left, last.y * view->end, left) : 0;
        turned.end = part_of(-first.left, first.y * view->begin, left);
        status = see_side(reach, previous, left, turned);
    }
    return status;
}

/* ---- the first triangle ---- */

static void move_inside(const MesoSurfacePlace *place, double weight[3])
{
    const double least = 1e-9;
    double sum = 0;
    for (uint32_t k = 0; k < 3; k++)
        sum += weight[k] = fmax(place->weight[k], least);
    for (uint32_t k = 0; k < 3; k++)
        weight[k] /= sum;
}

static MesoStatus begin_at(MesoReach *reach, const MesoSurfacePlace *place)
{
    double weight[3];
    MesoComplex corners[3];
    move_inside(place, weight);
    meso_walk_corners(reach->ground, place->triangle, corners);
    MesoComplex at = meso_walk_point(corners, weight);
    MesoReachView view = {.triangle = place->triangle, .side = 3, .x = at.re, .y = at.im};
    reach->view(reach->context, &view);
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 3 && !status; k++) {
        uint32_t h = 3 * place->triangle + k, far = meso_previous_side(k);
        Side side = side_of(reach->ground, h);
        double x = weight[meso_next_side(k)] * side.length + weight[far] * side.x, y = weight[far] * side.y;
        status = see_vertex(reach, h, norm(x, y), fmax(atan2(y, x), 0));
        if (!status)
            status = see_side(reach, h, side.length,
                              (MesoReachView){.x = x, .y = y, .begin = 0, .end = side.length, .base = 0});
    }
    return status;
}

MesoStatus meso_reach_tell(MesoReach *reach, const MesoSurfacePlace *place, double distance,
                           void (*view)(void *context, const MesoReachView *view), void *context, MesoError *error)
{
    reach->number++;
    reach->first = reach->count = 0;
    reach->distance = distance;
    reach->view = view;
    reach->context = context;
    reach->error = error;
    MesoStatus status = begin_at(reach, place);
    while (!status && reach->first < reach->count) {
        MesoReachView next = reach->queue[reach->first++];
        if (comes_too_late(reach, &next, side_of(reach->ground, 3 * next.triangle + next.side).length))
            continue;
        view(context, &next);
        status = cross_triangle(reach, &next);
    }
    return status;
}

/* ---- beginning ---- */

static void find_angles(void *context, uint64_t begin, uint64_t end)
{
    MesoReach *reach = context;
    for (uint64_t v = begin; v < end; v++) {
        if (reach->mesh->vertex_corner[v] == MESO_NO_INDEX)
            continue;
        MesoFan fan = meso_fan_first(reach->mesh, (uint32_t)v);
        uint32_t first = fan.corner;
        bool more;
        do {
            reach->angles[v] += corner_angle(reach, fan.corner);
            more = meso_fan_next(reach->mesh, &fan);
        } while (more && fan.corner != first);
        if (!more)
            reach->angles[v] = INFINITY;
    }
}

MesoStatus meso_reach_init(MesoReach **out, MesoArena *arena, const MesoTriangulation *mesh,
                           const MesoWalkGround *ground, uint32_t thread_count, MesoError *error)
{
    MesoReach *reach = *out = MESO_NEW(arena, MesoReach, 1, error);
    if (!reach)
        return MESO_ERR_MEMORY;
    *reach = (MesoReach){.mesh = mesh, .ground = ground, .arena = arena};
    uint64_t limit = VIEWS_AT_LEAST + (uint64_t)VIEWS_A_TRIANGLE * mesh->triangle_count;
    reach->limit = limit < VIEW_LIMIT ? (uint32_t)limit : VIEW_LIMIT;
    reach->angles = MESO_NEW(arena, double, mesh->vertex_count, error);
    reach->known = MESO_NEW(arena, double, mesh->vertex_count, error);
    reach->met = MESO_NEW(arena, uint32_t, mesh->vertex_count, error);
    if (!reach->angles || !reach->known || !reach->met)
        return MESO_ERR_MEMORY;
    meso_parallel_for(thread_count, mesh->vertex_count, 4096, find_angles, reach);
    return MESO_OK;
}
