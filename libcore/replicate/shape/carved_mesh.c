#include "libcore/replicate/shape/carved_mesh.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/index.h"

enum { TRIANGLES_MOST = 1 << 28, STEPS_MOST = 1 << 14 };

/* Of a detail's size: how far around its middle it is made finer. A hole pushes aside what is nearer than its size. */
static const float BUMP_REACH = 0.6f, HOLE_REACH = 0.9f;

/* Of a hole's size: what is nearer to its middle is cut out, and its rim so finely divided. */
static const float HOLE_CORE = 0.1f, HOLE_FINENESS = 0.045f, HOLE_GRADING = 0.3f;

/* ---- arrays ---- */

static void *larger(void *array, size_t count, size_t size, MesoError *error)
{
    void *moved = realloc(array, count * size);
    if (!moved)
        meso_fail(error, MESO_ERR_MEMORY, "out of memory: %zu bytes", count * size);
    return moved;
}

/* Room for what one bisection adds. */
static MesoStatus reserve(MesoCarvedMesh *c, MesoError *error)
{
    if (c->triangle_count + 2 > TRIANGLES_MOST)
        return meso_fail(error, MESO_ERR_LIMIT, "over %d triangles around the details", TRIANGLES_MOST);
    if (c->vertex_count + 1 > c->vertex_room) {
        uint32_t room = 2 * c->vertex_room + 64;
        MesoCarvedVertex *vertices = larger(c->vertices, room, sizeof *vertices, error);
        if (!vertices)
            return MESO_ERR_MEMORY;
        c->vertices = vertices;
        c->vertex_room = room;
    }
    if (c->triangle_count + 2 > c->triangle_room) {
        uint32_t room = 2 * c->triangle_room + 64;
        MesoCarvedTriangle *triangles = larger(c->triangles, room, sizeof *triangles, error);
        c->triangles = triangles ? triangles : c->triangles;
        uint32_t *stamps = triangles ? larger(c->stamps, room, sizeof *stamps, error) : NULL;
        if (!stamps)
            return MESO_ERR_MEMORY;
        memset(stamps + c->triangle_room, 0, (room - c->triangle_room) * sizeof *stamps);
        c->stamps = stamps;
        c->triangle_room = room;
    }
    return MESO_OK;
}

MesoStatus meso_carved_init(MesoCarvedMesh *c, const MesoTriangulation *mesh, MesoError *error)
{
    *c = (MesoCarvedMesh){.mesh = mesh};
    c->vertex_room = mesh->vertex_count;
    c->triangle_room = mesh->triangle_count;
    c->vertices = larger(NULL, c->vertex_room, sizeof *c->vertices, error);
    c->triangles = c->vertices ? larger(NULL, c->triangle_room, sizeof *c->triangles, error) : NULL;
    c->stamps = c->triangles ? calloc(c->triangle_room, sizeof *c->stamps) : NULL;
    if (!c->stamps)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for %u triangles", mesh->triangle_count);
    c->vertex_count = mesh->vertex_count;
    c->triangle_count = mesh->triangle_count;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        c->vertices[v] = (MesoCarvedVertex){.rest = mesh->positions[v], .rim = MESO_NO_INDEX};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        MesoCarvedTriangle *triangle = &c->triangles[t];
        *triangle = (MesoCarvedTriangle){.root = t, .weights = {{0, 0}, {1, 0}, {0, 1}}, .hole = MESO_NO_INDEX};
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t vertex = triangle->corners[k] = mesh->corners[3 * t + k];
            triangle->twins[k] = mesh->twins[3 * t + k];
            c->vertices[vertex].point = (MesoMeshPoint){t, {k == 0, k == 1, k == 2}};
        }
    }
    return MESO_OK;
}

void meso_carved_release(MesoCarvedMesh *c)
{
    free(c->vertices);
    free(c->triangles);
    free(c->stamps);
    free(c->queue);
    *c = (MesoCarvedMesh){0};
}

/* ---- bisection ---- */

static uint32_t next(uint32_t k) { return k == 2 ? 0 : k + 1; }

/* An order of edges in which no two are equal, the same from both sides. */
typedef struct Edge {
    float length;       /* squared */
    uint32_t low, high;
} Edge;

static Edge edge_of(const MesoCarvedMesh *c, uint32_t triangle, uint32_t k)
{
    const uint32_t *corners = c->triangles[triangle].corners;
    uint32_t a = corners[k], b = corners[next(k)], low = a < b ? a : b, high = a < b ? b : a;
    MesoVec3 along = meso_vec3_sub(c->vertices[high].rest, c->vertices[low].rest);
    return (Edge){meso_vec3_dot(along, along), low, high};
}

static bool is_longer(Edge a, Edge b)
{
    if (a.length != b.length)
        return a.length > b.length;
    return a.low != b.low ? a.low > b.low : a.high > b.high;
}

static uint32_t longest_of(const MesoCarvedMesh *c, uint32_t triangle)
{
    uint32_t best = 0;
    for (uint32_t k = 1; k < 3; k++)
        best = is_longer(edge_of(c, triangle, k), edge_of(c, triangle, best)) ? k : best;
    return best;
}

static void join(MesoCarvedMesh *c, uint32_t half_edge, uint32_t twin)
{
    c->triangles[half_edge / 3].twins[half_edge % 3] = twin;
    if (twin != MESO_NO_INDEX)
        c->triangles[twin / 3].twins[twin % 3] = half_edge;
}

/*
 * Cuts a triangle from the middle `vertex` of its side k to the corner across: a b c becomes a m c, in its place, and
 * m b c, behind all others. The halves of the side are joined later.
 */
static uint32_t cut(MesoCarvedMesh *c, uint32_t triangle, uint32_t k, uint32_t vertex)
{
    uint32_t added = c->triangle_count++, after = next(k);
    MesoCarvedTriangle *t = &c->triangles[triangle], *half = &c->triangles[added];
    uint32_t across = t->twins[after];
    *half = *t;
    c->stamps[added] = 0;
    for (uint32_t i = 0; i < 2; i++)
        half->weights[k][i] = t->weights[after][i] = 0.5f * (t->weights[k][i] + t->weights[after][i]);
    half->corners[k] = t->corners[after] = vertex;
    join(c, 3 * added + after, across);
    join(c, 3 * triangle + after, 3 * added + next(after));
    return added;
}

/* Both triangles at an edge, which is the longest of both. */
static MesoStatus bisect(MesoCarvedMesh *c, uint32_t triangle, uint32_t k, MesoError *error)
{
    MesoStatus status = reserve(c, error);
    if (status)
        return status;
    uint32_t vertex = c->vertex_count++, twin = c->triangles[triangle].twins[k];
    Edge edge = edge_of(c, triangle, k);
    uint32_t added = cut(c, triangle, k, vertex), first = c->triangles[triangle].corners[k];
    const MesoCarvedTriangle *t = &c->triangles[triangle];
    float v = t->weights[next(k)][0], w = t->weights[next(k)][1];
    MesoVec3 sum = meso_vec3_add(c->vertices[edge.low].rest, c->vertices[edge.high].rest);
    uint32_t rim = MESO_NO_INDEX;
    if (twin != MESO_NO_INDEX) {
        const MesoCarvedTriangle *other = &c->triangles[twin / 3];
        rim = t->hole == other->hole ? MESO_NO_INDEX : t->hole == MESO_NO_INDEX ? other->hole : t->hole;
    }
    c->vertices[vertex] = (MesoCarvedVertex){{t->root, {1 - v - w, v, w}}, meso_vec3_scale(sum, 0.5f), rim};
    if (twin == MESO_NO_INDEX) {
        join(c, 3 * triangle + k, MESO_NO_INDEX);
        join(c, 3 * added + k, MESO_NO_INDEX);
        return MESO_OK;
    }
    uint32_t other = twin / 3, side = twin % 3, more = cut(c, other, side, vertex);
    bool alike = c->triangles[other].corners[side] != first;    /* wound as ours, it begins at the other end */
    join(c, 3 * triangle + k, 3 * (alike ? more : other) + side);
    join(c, 3 * added + k, 3 * (alike ? other : more) + side);
    return MESO_OK;
}

/* Bisects at a triangle's longest edge, after those beyond it whose longest edge is another. */
static MesoStatus refine(MesoCarvedMesh *c, uint32_t triangle, MesoError *error)
{
    MesoStatus status = MESO_OK;
    uint32_t before = c->triangle_count;
    Edge wanted = edge_of(c, triangle, longest_of(c, triangle));
    while (!status) {
        uint32_t at = triangle, k = longest_of(c, at);
        Edge longest = edge_of(c, at, k);
        if (c->triangle_count > before && (longest.low != wanted.low || longest.high != wanted.high))
            return MESO_OK;
        for (;;) {
            uint32_t twin = c->triangles[at].twins[k];
            uint32_t side = twin == MESO_NO_INDEX ? 0 : longest_of(c, twin / 3);
            if (twin == MESO_NO_INDEX || side == twin % 3)
                break;
            at = twin / 3;
            k = side;
        }
        status = bisect(c, at, k, error);
    }
    return status;
}

/* ---- searches ---- */

static MesoStatus push(MesoCarvedMesh *c, uint32_t *count, uint32_t triangle, MesoError *error)
{
    if (*count == c->queue_room) {
        uint32_t room = 2 * c->queue_room + 256;
        uint32_t *queue = larger(c->queue, room, sizeof *queue, error);
        if (!queue)
            return MESO_ERR_MEMORY;
        c->queue = queue;
        c->queue_room = room;
    }
    c->queue[(*count)++] = triangle;
    return MESO_OK;
}

/* Of the weights: twice the area of the corners and the point on a side; not negative on the inner side. */
static double side_of(const MesoCarvedTriangle *t, uint32_t k, const float point[3])
{
    const float *a = t->weights[k], *b = t->weights[next(k)];
    return ((double)b[0] - (double)a[0]) * ((double)point[2] - (double)a[1]) -
           ((double)b[1] - (double)a[1]) * ((double)point[1] - (double)a[0]);
}

static bool holds(const MesoCarvedTriangle *t, const float point[3])
{
    return side_of(t, 0, point) >= 0 && side_of(t, 1, point) >= 0 && side_of(t, 2, point) >= 0;
}

/* The part of a triangle at rest that has a point: by walking towards it, or else by looking at all of them. */
static uint32_t locate(const MesoCarvedMesh *c, const MesoMeshPoint *point)
{
    uint32_t at = point->triangle;
    for (uint32_t step = 0; step < STEPS_MOST; step++) {
        const MesoCarvedTriangle *t = &c->triangles[at];
        uint32_t to = MESO_NO_INDEX;
        for (uint32_t i = 0; i < 3; i++) {
            uint32_t k = (i + step) % 3, twin = t->twins[k];
            if (side_of(t, k, point->weight) < 0 && twin != MESO_NO_INDEX && c->triangles[twin / 3].root == t->root)
                to = twin / 3;
        }
        if (to == MESO_NO_INDEX)
            return at;
        at = to;
    }
    for (uint32_t t = 0; t < c->triangle_count; t++)
        if (c->triangles[t].root == point->triangle && holds(&c->triangles[t], point->weight))
            return t;
    return point->triangle;
}

/* A place is at its distance from a segment. */
static float segment_distance(MesoVec3 p, MesoVec3 a, MesoVec3 b)
{
    MesoVec3 along = meso_vec3_sub(b, a), from = meso_vec3_sub(p, a);
    float length = meso_vec3_dot(along, along), s = length > 0 ? meso_vec3_dot(along, from) / length : 0;
    return meso_vec3_length(meso_vec3_sub(from, meso_vec3_scale(along, fminf(fmaxf(s, 0), 1))));
}

/* ---- details ---- */

typedef struct Spot {
    const MesoDetail *detail;
    MesoCarving carving;
    MesoVec3 middle;
    float size, fineness;
    uint32_t number;
} Spot;

static float distance_to(const MesoCarvedMesh *c, const Spot *s, uint32_t triangle)
{
    const MesoCarvedTriangle *t = &c->triangles[triangle];
    float least = INFINITY;
    if (t->root == s->detail->point.triangle && holds(t, s->detail->point.weight))
        return 0;
    for (uint32_t k = 0; k < 3; k++)
        least = fminf(least, segment_distance(s->middle, c->vertices[t->corners[k]].rest,
                                              c->vertices[t->corners[next(k)]].rest));
    return least;
}

/* How long edges may be at a distance from its middle; INFINITY beyond its reach. */
static float edge_limit(const Spot *s, float distance)
{
    if (s->carving == MESO_CARVE_BUMP)
        return distance < BUMP_REACH * s->size ? s->fineness * s->size : INFINITY;
    return distance < HOLE_REACH * s->size ? fmaxf(HOLE_FINENESS * s->size, HOLE_GRADING * distance) : INFINITY;
}

static MesoStatus refine_around(MesoCarvedMesh *c, const Spot *s, MesoError *error)
{
    uint32_t count = 0, start = locate(c, &s->detail->point);
    MesoStatus status = push(c, &count, start, error);
    c->stamp++;
    while (count > 0 && !status) {
        uint32_t t = c->queue[--count];
        if (c->stamps[t] == c->stamp)
            continue;
        for (;;) {
            float limit = edge_limit(s, distance_to(c, s, t));
            if (limit == INFINITY)
                break;
            if (sqrtf(edge_of(c, t, longest_of(c, t)).length) <= limit) {
                c->stamps[t] = c->stamp;
                break;
            }
            if ((status = refine(c, t, error)))
                return status;
        }
        for (uint32_t k = 0; k < 3 && !status; k++) {
            uint32_t twin = c->triangles[t].twins[k];
            bool inside = c->stamps[t] == c->stamp && twin != MESO_NO_INDEX && c->stamps[twin / 3] != c->stamp;
            if (inside && edge_limit(s, distance_to(c, s, twin / 3)) < INFINITY)
                status = push(c, &count, twin / 3, error);
        }
    }
    return status;
}

static bool has_corner_within(const MesoCarvedMesh *c, uint32_t triangle, MesoVec3 middle, float radius)
{
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 corner = c->vertices[c->triangles[triangle].corners[k]].rest;
        if (meso_vec3_length(meso_vec3_sub(corner, middle)) < radius)
            return true;
    }
    return false;
}

/* Sides beyond which the search has been. */
static uint32_t sides_taken(const MesoCarvedMesh *c, uint32_t triangle)
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t twin = c->triangles[triangle].twins[k];
        count += twin != MESO_NO_INDEX && c->stamps[twin / 3] == c->stamp;
    }
    return count;
}

/*
 * The triangles with a corner nearer to the middle than `radius`, joined to it, to the queue; and those between two of
 * them, which would have all corners on the rim.
 */
static MesoStatus gather(MesoCarvedMesh *c, const Spot *s, float radius, uint32_t *count, MesoError *error)
{
    uint32_t start = locate(c, &s->detail->point);
    *count = 0;
    c->stamp++;
    c->stamps[start] = c->stamp;
    MesoStatus status = push(c, count, start, error);
    for (uint32_t i = 0; i < *count && !status; i++)
        for (uint32_t k = 0; k < 3 && !status; k++) {
            uint32_t twin = c->triangles[c->queue[i]].twins[k];
            if (twin == MESO_NO_INDEX || c->stamps[twin / 3] == c->stamp)
                continue;
            if (!has_corner_within(c, twin / 3, s->middle, radius) && sides_taken(c, twin / 3) < 2)
                continue;
            c->stamps[twin / 3] = c->stamp;
            status = push(c, count, twin / 3, error);
        }
    return status;
}

/* Whether what is in the queue can be cut out: free of borders and other holes, and round, with one rim. */
static bool can_open(const MesoCarvedMesh *c, uint32_t count)
{
    uint32_t sides = 0, rim_begin = MESO_NO_INDEX;
    for (uint32_t i = 0; i < count; i++) {
        const MesoCarvedTriangle *t = &c->triangles[c->queue[i]];
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t twin = t->twins[k];
            if (twin == MESO_NO_INDEX || t->hole != MESO_NO_INDEX || c->vertices[t->corners[k]].rim != MESO_NO_INDEX)
                return false;
            if (c->stamps[twin / 3] == c->stamp)
                continue;
            sides++;
            rim_begin = 3 * c->queue[i] + k;
        }
    }
    if (rim_begin == MESO_NO_INDEX)
        return false;
    uint32_t h = rim_begin, met = 0;
    do {        /* along the rim: at each vertex around, within the queue, to the next side of it */
        uint32_t at = 3 * (h / 3) + next(h % 3);
        while (c->stamps[c->triangles[at / 3].twins[at % 3] / 3] == c->stamp) {
            uint32_t twin = c->triangles[at / 3].twins[at % 3];
            if (c->triangles[twin / 3].corners[twin % 3] == c->triangles[at / 3].corners[at % 3])
                return false;       /* wound against each other */
            at = 3 * (twin / 3) + next(twin % 3);
        }
        h = at;
        met++;
    } while (h != rim_begin && met <= sides);
    return met == sides;
}

static void open_hole(MesoCarvedMesh *c, const Spot *s, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        MesoCarvedTriangle *t = &c->triangles[c->queue[i]];
        t->hole = s->number;
        for (uint32_t k = 0; k < 3; k++)
            if (c->stamps[t->twins[k] / 3] != c->stamp)
                c->vertices[t->corners[k]].rim = c->vertices[t->corners[next(k)]].rim = s->number;
    }
}

MesoStatus meso_carve(MesoCarvedMesh *c, const MesoDetail *detail, MesoCarving carving, float fineness,
                      MesoError *error)
{
    Spot s = {detail, carving, meso_detail_position(c->mesh, c->mesh->positions, &detail->point),
              fmaxf(detail->size, detail->width), fineness, c->carved_count++};
    uint32_t count = 0;
    if (carving == MESO_CARVE_NOTHING)
        return MESO_OK;
    MesoStatus status = refine_around(c, &s, error);
    if (!status && carving == MESO_CARVE_HOLE)
        status = gather(c, &s, HOLE_CORE * fminf(detail->size, detail->width), &count, error);
    if (status || carving != MESO_CARVE_HOLE)
        return status;
    if (can_open(c, count))
        open_hole(c, &s, count);
    else
        c->uncut_count++;
    return MESO_OK;
}

/* ---- checks ---- */

static bool is_joined(const MesoCarvedMesh *c, uint32_t t, uint32_t k)
{
    uint32_t twin = c->triangles[t].twins[k];
    if (twin == MESO_NO_INDEX)
        return true;
    if (twin / 3 >= c->triangle_count || c->triangles[twin / 3].twins[twin % 3] != 3 * t + k)
        return false;
    const uint32_t *own = c->triangles[t].corners, *other = c->triangles[twin / 3].corners;
    uint32_t a = own[k], b = own[next(k)], x = other[twin % 3], y = other[next(twin % 3)];
    return (a == x && b == y) || (a == y && b == x);
}

MesoStatus meso_carved_check(const MesoCarvedMesh *c, MesoError *error)
{
    for (uint32_t t = 0; t < c->triangle_count; t++) {
        const MesoCarvedTriangle *triangle = &c->triangles[t];
        for (uint32_t k = 0; k < 3; k++) {
            const float *w = triangle->weights[k];
            if (!is_joined(c, t, k))
                return meso_fail(error, MESO_ERR_INTERNAL, "side %u of triangle %u is not joined", k, t);
            if (triangle->corners[k] == triangle->corners[next(k)])
                return meso_fail(error, MESO_ERR_INTERNAL, "triangle %u has vertex %u twice", t, triangle->corners[k]);
            MesoMeshPoint point = {triangle->root, {1 - w[0] - w[1], w[0], w[1]}};
            MesoVec3 off = meso_vec3_sub(meso_detail_position(c->mesh, c->mesh->positions, &point),
                                         c->vertices[triangle->corners[k]].rest);
            if (!(w[0] >= 0 && w[1] >= 0 && w[0] + w[1] <= 1) || !(meso_vec3_length(off) < 1e-4f))
                return meso_fail(error, MESO_ERR_INTERNAL, "corner %u of triangle %u is not in its root", k, t);
        }
    }
    return MESO_OK;
}
