#include "libcore/geodesic/exact/strip.h"

#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/geodesic/exact/unfold.h"

/* ---- the plane ---- */

static MesoStripPoint subtract(MesoStripPoint a, MesoStripPoint b)
{
    return (MesoStripPoint){a.x - b.x, a.y - b.y};
}

static double cross(MesoStripPoint a, MesoStripPoint b)
{
    return a.x * b.y - a.y * b.x;
}

/* Positive where c lies to the left of the way from a to b. */
static double side_of(MesoStripPoint a, MesoStripPoint b, MesoStripPoint c)
{
    return cross(subtract(b, a), subtract(c, a));
}

static double distance(MesoStripPoint a, MesoStripPoint b)
{
    MesoStripPoint d = subtract(b, a);
    return sqrt(d.x * d.x + d.y * d.y);
}

static double angle_between(MesoStripPoint at, MesoStripPoint a, MesoStripPoint b)
{
    a = subtract(a, at);
    b = subtract(b, at);
    return atan2(fabs(cross(a, b)), a.x * b.x + a.y * b.y);
}

static bool is_same(MesoStripPoint a, MesoStripPoint b)
{
    return a.x == b.x && a.y == b.y;
}

/* ---- triangles and nodes ---- */

static bool is_inside(const MesoStrip *strip, uint32_t triangle)
{
    return !strip->domain || meso_domain_has(strip->domain, strip->mesh, triangle);
}

/* Of the triangle that has the vertex. */
static uint32_t corner_at(const MesoTriangulation *mesh, uint32_t triangle, uint32_t vertex)
{
    uint32_t corner = 3 * triangle;
    while (mesh->corners[corner] != vertex && corner < 3 * triangle + 2)
        corner++;
    return corner;
}

bool meso_strip_touches(const MesoTriangulation *mesh, uint32_t triangle, const MesoCutNode *node)
{
    if (node->kind == MESO_AT_VERTEX)
        return mesh->corners[corner_at(mesh, triangle, node->element)] == node->element;
    if (node->kind == MESO_IN_TRIANGLE)
        return node->element == triangle;
    uint32_t twin = mesh->twins[node->element];
    return node->element / 3 == triangle || (twin != MESO_NO_INDEX && twin / 3 == triangle);
}

static bool side_has(const MesoTriangulation *mesh, uint32_t side, const MesoCutNode *node)
{
    if (node->kind == MESO_AT_VERTEX)
        return mesh->corners[side] == node->element || mesh->corners[meso_next_corner(side)] == node->element;
    return node->kind == MESO_ON_EDGE && (node->element == side || node->element == mesh->twins[side]);
}

/* Where a node of a triangle lies, whose corners lie at `at`. */
static MesoStripPoint place_node(const MesoTriangulation *mesh, uint32_t triangle, const MesoStripPoint at[3],
                                 const MesoCutNode *node)
{
    double weight[3] = {0, 0, 0};
    MesoStripPoint p = {0, 0};
    if (node->kind == MESO_AT_VERTEX) {
        weight[corner_at(mesh, triangle, node->element) % 3] = 1;
    } else if (node->kind == MESO_ON_EDGE) {
        uint32_t end = mesh->corners[meso_next_corner(node->element)];
        weight[corner_at(mesh, triangle, mesh->corners[node->element]) % 3] = 1 - (double)node->share[0];
        weight[corner_at(mesh, triangle, end) % 3] = node->share[0];
    } else {
        weight[0] = 1 - (double)node->share[0] - node->share[1];
        weight[1] = node->share[0];
        weight[2] = node->share[1];
    }
    for (uint32_t k = 0; k < 3; k++)
        p = (MesoStripPoint){p.x + weight[k] * at[k].x, p.y + weight[k] * at[k].y};
    return p;
}

/* ---- the strip ---- */

MesoStatus meso_strip_add(MesoStrip *strip, uint32_t side, MesoError *error)
{
    if (strip->side_count > 0 && strip->sides[strip->side_count - 1] == strip->mesh->twins[side]) {
        strip->side_count--;
        return MESO_OK;
    }
    strip->sides = MESO_GROW(strip->arena, strip->sides, strip->side_count, strip->side_room, 64, error);
    if (!strip->sides)
        return MESO_ERR_MEMORY;
    strip->sides[strip->side_count++] = side;
    return MESO_OK;
}

/*
 * Around the vertex of `fan` as far as a triangle that has `node`, and the angle between: adds the sides where `add`
 * says so. MESO_NO_INDEX where the way leads out of the domain, or around.
 */
static uint32_t walk_fan(MesoStrip *strip, MesoFan fan, const MesoCutNode *node, bool add, double *angle,
                         MesoStatus *status, MesoError *error)
{
    const MesoTriangulation *mesh = strip->mesh;
    uint32_t first = fan.corner;
    *angle = 0;
    while (!*status) {
        uint32_t exit = meso_fan_exit(fan);
        if (!meso_fan_next(mesh, &fan) || fan.corner == first || !is_inside(strip, fan.corner / 3))
            return MESO_NO_INDEX;
        if (add)
            *status = meso_strip_add(strip, exit, error);
        if (meso_strip_touches(mesh, fan.corner / 3, node))
            return fan.corner / 3;
        MesoSideShape shape = meso_side_shape(mesh, mesh->positions, fan.corner);
        *angle += atan2(shape.y, shape.x);
    }
    return MESO_NO_INDEX;
}

MesoStatus meso_strip_turn(MesoStrip *strip, uint32_t triangle, uint32_t vertex, const MesoCutNode *node,
                           uint32_t *reached, MesoError *error)
{
    MesoStatus status = MESO_OK;
    double angle[2];
    MesoFan fan[2];
    *reached = triangle;
    if (meso_strip_touches(strip->mesh, triangle, node))
        return MESO_OK;
    for (uint32_t k = 0; k < 2; k++) {
        fan[k] = (MesoFan){corner_at(strip->mesh, triangle, vertex), k == 1};
        if (walk_fan(strip, fan[k], node, false, &angle[k], &status, error) == MESO_NO_INDEX)
            angle[k] = INFINITY;
    }
    if (!(fmin(angle[0], angle[1]) < INFINITY))
        return meso_fail(error, MESO_ERR_NO, "no way around vertex %u in the region", vertex);
    *reached = walk_fan(strip, fan[angle[1] < angle[0]], node, true, &angle[0], &status, error);
    return status;
}

/* The ends need no sides that they lie on. */
static void trim_ends(MesoStrip *strip)
{
    const MesoTriangulation *mesh = strip->mesh;
    uint32_t begin = 0, end = strip->side_count;
    while (begin < end && side_has(mesh, strip->sides[begin], &strip->from))
        begin++;
    while (end > begin && side_has(mesh, strip->sides[end - 1], &strip->to))
        end--;
    if (begin > 0)
        strip->first = mesh->twins[strip->sides[begin - 1]] / 3;
    strip->side_count = end - begin;
    if (begin > 0 && strip->side_count > 0)
        memmove(strip->sides, strip->sides + begin, strip->side_count * sizeof *strip->sides);
}

/* ---- unfolding ---- */

/* A triangle in the plane, perhaps turned over. */
typedef struct Placed {
    MesoStripPoint at[3];
    bool turned;
} Placed;

static Placed place_first(const MesoTriangulation *mesh, uint32_t triangle)
{
    MesoSideShape shape = meso_side_shape(mesh, mesh->positions, 3 * triangle);
    return (Placed){{{0, 0}, {shape.length, 0}, {shape.x, shape.y}}, false};
}

/* The triangle across a side of one that is placed. */
static Placed place_next(const MesoTriangulation *mesh, const Placed *placed, uint32_t side)
{
    uint32_t twin = mesh->twins[side];
    bool alike = mesh->corners[twin] == mesh->corners[side];
    MesoStripPoint a = placed->at[side % 3], b = placed->at[(side + 1) % 3];
    MesoStripPoint p = alike ? a : b, q = alike ? b : a;
    MesoSideShape shape = meso_side_shape(mesh, mesh->positions, twin);
    double length = distance(p, q);
    MesoStripPoint e = length > 0 ? (MesoStripPoint){(q.x - p.x) / length, (q.y - p.y) / length}
                                  : (MesoStripPoint){1, 0};
    Placed next = {.turned = placed->turned != alike};
    double up = next.turned ? -shape.y : shape.y;
    next.at[twin % 3] = p;
    next.at[(twin + 1) % 3] = q;
    next.at[(twin + 2) % 3] = (MesoStripPoint){p.x + shape.x * e.x - up * e.y, p.y + shape.x * e.y + up * e.x};
    return next;
}

static MesoStatus unfold(MesoStrip *strip, MesoError *error)
{
    const MesoTriangulation *mesh = strip->mesh;
    if (strip->side_count > strip->portal_room) {
        strip->portal_room = strip->side_count + strip->side_count / 2;
        strip->portals = MESO_NEW(strip->arena, MesoPortal, strip->portal_room, error);
        if (!strip->portals)
            return MESO_ERR_MEMORY;
    }
    Placed placed = place_first(mesh, strip->first);
    uint32_t triangle = strip->first;
    strip->begin = place_node(mesh, triangle, placed.at, &strip->from);
    for (uint32_t i = 0; i < strip->side_count; i++) {
        uint32_t side = strip->sides[i], twin = mesh->twins[side], right = side, left = meso_next_corner(side);
        if (placed.turned) {
            right = left;
            left = side;
        }
        Placed next = place_next(mesh, &placed, side);
        strip->portals[i] = (MesoPortal){
            placed.at[left % 3], placed.at[right % 3], placed.at[(side + 2) % 3], next.at[(twin + 2) % 3],
            mesh->corners[left], mesh->corners[right],
        };
        placed = next;
        triangle = twin / 3;
    }
    strip->end = place_node(mesh, triangle, placed.at, &strip->to);
    return MESO_OK;
}

/* ---- the funnel ---- */

/* What is seen from the path's last point: between a vertex on the left and one on the right. */
typedef struct Funnel {
    MesoStripPoint tip, edge[2];
    uint32_t portal[2];     /* that the edges come from; MESO_NO_INDEX where there is none yet */
    uint32_t vertex[2];     /* at the tip: two where a side without length is there */
} Funnel;

/* Looks on from a vertex of a portal, 0 the left one, which the path bends around. */
static MesoStatus bend_at(MesoStrip *strip, Funnel *funnel, uint32_t portal, uint32_t k, MesoError *error)
{
    const MesoPortal *p = &strip->portals[portal];
    MesoStripBend bend = {k == 0 ? p->left : p->right, k == 0 ? p->left_vertex : p->right_vertex, portal, k == 0};
    bool both = is_same(p->left, p->right);
    strip->bends = MESO_GROW(strip->arena, strip->bends, strip->bend_count, strip->bend_room, 64, error);
    if (!strip->bends)
        return MESO_ERR_MEMORY;
    strip->bends[strip->bend_count++] = bend;
    strip->length += distance(funnel->tip, bend.at);
    *funnel = (Funnel){bend.at, {bend.at, bend.at}, {MESO_NO_INDEX, MESO_NO_INDEX},
                       {both ? p->left_vertex : bend.vertex, both ? p->right_vertex : bend.vertex}};
    return MESO_OK;
}

/* Narrows one edge of the funnel; says whether it would cross the other, around which the path bends then. */
static bool narrow(Funnel *funnel, uint32_t k, MesoStripPoint p, uint32_t i)
{
    double sign = k == 0 ? -1 : 1;      /* an edge on the right moves to the left */
    bool open = funnel->portal[k] == MESO_NO_INDEX, other_open = funnel->portal[1 - k] == MESO_NO_INDEX;
    if (!open && sign * side_of(funnel->tip, funnel->edge[k], p) < 0)
        return false;
    if (!open && !other_open && sign * side_of(funnel->tip, funnel->edge[1 - k], p) > 0)
        return true;
    funnel->edge[k] = p;
    funnel->portal[k] = i;
    return false;
}

static bool is_tip(const Funnel *funnel, MesoStripPoint p, uint32_t vertex)
{
    return is_same(funnel->tip, p) && (vertex == funnel->vertex[0] || vertex == funnel->vertex[1]);
}

/* The path may wait at its last point for as long as portals have that: the funnel begins behind them. */
static bool waits(const MesoPortal *portal, uint32_t i, Funnel *funnel)
{
    bool left = is_tip(funnel, portal->left, portal->left_vertex);
    bool right = is_tip(funnel, portal->right, portal->right_vertex);
    if (!left && !right)
        return false;
    funnel->edge[0] = portal->left;
    funnel->edge[1] = portal->right;
    funnel->portal[0] = left ? MESO_NO_INDEX : i;
    funnel->portal[1] = right ? MESO_NO_INDEX : i;
    return true;
}

/* A side without length is a hinge: the path bends there, whatever the plane says. */
static MesoStatus pull_string(MesoStrip *strip, MesoError *error)
{
    Funnel funnel = {strip->begin, {strip->begin, strip->begin}, {MESO_NO_INDEX, MESO_NO_INDEX},
                     {MESO_NO_INDEX, MESO_NO_INDEX}};
    MesoStatus status = MESO_OK;
    strip->bend_count = 0;
    strip->length = 0;
    for (uint32_t i = 0; i <= strip->side_count && !status; i++) {
        bool last = i == strip->side_count;
        const MesoPortal *portal = last ? NULL : &strip->portals[i];
        if (!last && waits(portal, i, &funnel))
            continue;
        for (uint32_t k = 0; k < 2; k++)
            if (narrow(&funnel, k, last ? strip->end : k == 0 ? portal->left : portal->right, i)) {
                i = funnel.portal[1 - k];
                status = bend_at(strip, &funnel, i, 1 - k, error);
                last = true;
                break;
            }
        if (!last && is_same(portal->left, portal->right))
            status = bend_at(strip, &funnel, i, 0, error);
    }
    strip->length += distance(funnel.tip, strip->end);
    return status;
}

/* ---- around the other side ---- */

static uint32_t pivot(const MesoStrip *strip, uint32_t portal, bool left)
{
    return left ? strip->portals[portal].left_vertex : strip->portals[portal].right_vertex;
}

/* Rounds that win less than rounding in a row; sides without length could go on for ever. */
enum { IDLE_ROUNDS = 16 };

/* Less than half a turn, by more than rounding: what is left gains no more than 1e-13 of the length. */
static const double HALF_TURN = MESO_PI - 1e-6;

/* A bend of a strip, and the strip's sides that have its vertex. */
typedef struct Around {
    const MesoStripBend *bend;
    uint32_t begin, end;
    MesoFan fan;            /* the other way around */
    MesoCutNode goal;
} Around;

static Around around_bend(const MesoStrip *strip, uint32_t b)
{
    const MesoTriangulation *mesh = strip->mesh;
    const MesoStripBend *bend = &strip->bends[b];
    uint32_t begin = bend->portal, end = bend->portal + 1;
    while (begin > 0 && pivot(strip, begin - 1, bend->left) == bend->vertex)
        begin--;
    while (end < strip->side_count && pivot(strip, end, bend->left) == bend->vertex)
        end++;
    uint32_t entry = corner_at(mesh, strip->sides[begin] / 3, bend->vertex);
    return (Around){bend, begin, end, {entry, strip->sides[begin] != entry},
                    {MESO_IN_TRIANGLE, mesh->twins[strip->sides[end - 1]] / 3, {0, 0}}};
}

/* Whether the other way around is inside the domain and has less than half a turn. */
static bool is_shorter(MesoStrip *strip, uint32_t b, const Around *around)
{
    MesoStripPoint at = around->bend->at, before = b > 0 ? around->bend[-1].at : strip->begin;
    MesoStripPoint after = b + 1 < strip->bend_count ? around->bend[1].at : strip->end;
    MesoStatus status = MESO_OK;
    double angle;
    if (walk_fan(strip, around->fan, &around->goal, false, &angle, &status, NULL) == MESO_NO_INDEX)
        return false;
    angle += angle_between(at, before, strip->portals[around->begin].behind);
    angle += angle_between(at, after, strip->portals[around->end - 1].beyond);
    return angle < HALF_TURN;
}

/* One round: all bends that can be led around their other side, but those that share sides with one before. */
static MesoStatus improve(MesoStrip *strip, MesoStrip *spare, bool *improved, MesoError *error)
{
    MesoStatus status = MESO_OK;
    uint32_t done = 0;
    *improved = false;
    spare->side_count = 0;
    for (uint32_t b = 0; b < strip->bend_count && !status; b++) {
        Around around = around_bend(strip, b);
        if (around.begin < done || !is_shorter(strip, b, &around))
            continue;
        double angle;
        for (uint32_t i = done; i < around.begin && !status; i++)
            status = meso_strip_add(spare, strip->sides[i], error);
        walk_fan(spare, around.fan, &around.goal, true, &angle, &status, error);
        done = around.end;
        *improved = true;
    }
    for (uint32_t i = done; i < strip->side_count && !status; i++)
        status = meso_strip_add(spare, strip->sides[i], error);
    return status;
}

static void swap_sides(MesoStrip *a, MesoStrip *b)
{
    uint32_t *sides = a->sides, count = a->side_count, room = a->side_room;
    a->sides = b->sides;
    a->side_count = b->side_count;
    a->side_room = b->side_room;
    b->sides = sides;
    b->side_count = count;
    b->side_room = room;
}

MesoStatus meso_strip_straighten(MesoStrip *strip, uint32_t rounds, bool *straight, MesoError *error)
{
    MesoStrip spare = {.mesh = strip->mesh, .domain = strip->domain, .arena = strip->arena};
    MesoStatus status = MESO_OK;
    double least = INFINITY;
    uint32_t idle = 0;
    *straight = false;
    for (uint32_t round = 0; !status && !*straight; round++) {
        bool improved = false;
        trim_ends(strip);
        status = unfold(strip, error);
        if (!status)
            status = pull_string(strip, error);
        idle = strip->length < least ? 0 : idle + 1;
        least = fmin(strip->length, least);
        if (status || round == rounds || idle == IDLE_ROUNDS)
            break;
        status = improve(strip, &spare, &improved, error);
        *straight = !improved;
        if (improved)
            swap_sides(strip, &spare);
    }
    return status;
}

double meso_strip_crossing(const MesoStrip *strip, uint32_t portal, MesoStripPoint begin, MesoStripPoint end)
{
    const MesoPortal *p = &strip->portals[portal];
    MesoStripPoint along = subtract(p->left, p->right);
    double left = fabs(side_of(begin, end, p->left)), right = fabs(side_of(begin, end, p->right));
    double share = right / (right + left), square = along.x * along.x + along.y * along.y;    /* from right to left */
    /* where it runs along the side, areas are rounding: the point of the side that is nearest to the beginning */
    if (!(right + left > 1e-12 * distance(begin, end) * sqrt(square))) {
        MesoStripPoint d = subtract(begin, p->right);
        share = square > 0 ? fmin(fmax((d.x * along.x + d.y * along.y) / square, 0), 1) : 0;
    }
    return strip->mesh->corners[strip->sides[portal]] == p->right_vertex ? share : 1 - share;
}
